/*
 * The Newton matrix D - dt A [C_cc, I] of the coupled system: its product through the elasticity
 * product, its preconditioner, and its full form.
 *
 * Columns: the width of a channel cell, the pressure of a tip cell. Rows: the volume balance.
 */
#ifndef ILSAI_JACOBIAN_H
#define ILSAI_JACOBIAN_H

#include "base/sensitivity.h"
#include "base/unknowns.h"
#include "elastic/elasticity.h"
#include "flow/lubrication.h"
#include "solve/multigrid.h"
#include "solve/near_field.h"

typedef struct jacobian {
    const grid *g;
    const unknowns *cells;
    const lubrication *lubrication;
    elasticity *elastic;
    double *width, *pressure; /* work over the mesh; width is zero outside the channel cells */
    double *full;             /* LAPACK storage of the transpose, factored */
    double *self_correction;  /* per numbered cell: what its self term of C lacks at the front */
    const sensitivity *sensitivity;
    int *sensitivity_of; /* per numbered cell: its sensitivity, or -1 */
    double *influence;   /* folded C between numbered cells, one row a cell */
    int *pivots;
    size_t full_capacity, pivot_capacity, place_capacity;
    multigrid multigrid; /* the preconditioner, on the rectangle of the representative cells */
    near_field near_field;
    size_t *place;        /* of each numbered cell in it */
    double *weight;       /* the part of each that lies in the fold */
    thread_pool *threads; /* that share the loops, or NULL */
    long products;
    double seconds_product, seconds_preconditioner;
} jacobian;

/* y = M x, and y = P^-1 x with the preconditioner as it is set: gmres_operator on a jacobian. */
void ilsai_jacobian_multiply(void *context, const double *x, double *y);
void ilsai_jacobian_precondition(void *context, const double *x, double *y);

/* Changes of the width and of the source term of numbered cell k for changes x of the unknowns. */
double ilsai_jacobian_tip_width(const jacobian *m, int k, const double *x);
double ilsai_jacobian_tip_source(const jacobian *m, int k, const double *x);
/*
 * What the unknown of numbered cell k, a tip or closed cell, adds to its own row: 0; or what does
 * not leak; or a spring that holds the pressure of a closed cell, which else were anything where
 * hardly any fluid can leave.
 */
double ilsai_jacobian_without_width(const jacobian *m, int k);
/* Change of the pressure in active channel cell k as the front moves and its width stays. */
double ilsai_jacobian_front_pressure(const jacobian *m, int k, const double *x);

/* Makes the preconditioner for the flow as it is set. ILSA_ERR_MEMORY. */
ilsa_status ilsai_jacobian_set_preconditioner(jacobian *m);

/* The influence matrix of the numbered cells, for ilsai_jacobian_solve_full. ILSA_ERR_MEMORY. */
ilsa_status ilsai_jacobian_set_influence(jacobian *m);

/* Solves M x = b by dense LU. ILSA_ERR_NUMERIC if singular. */
ilsa_status ilsai_jacobian_solve_full(jacobian *m, const double *b, double *x);

void ilsai_jacobian_destroy(jacobian *m);

#endif
