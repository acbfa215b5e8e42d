/*
 * The Newton matrix of the coupled system: its product with a vector, its preconditioner, and its
 * full form for few unknowns. See docs/theory.md, section 8.
 *
 * The rows are the volume balances of the numbered cells, Dontsov and Peirce 2017, (4.4). The
 * columns are the unknowns, see base/unknowns.h: the width of a channel cell, the pressure of a tip
 * cell or, where that is at a bound, its width. The matrix is D - dt A [C, I], where D is the
 * derivative of the balance by the widths at given pressures, A the lubrication operator, C the
 * elasticity and I the pressures of tip cells.
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
    /* What the matrix is made of; the caller's. */
    const grid *g;
    const unknowns *cells;
    const lubrication *lubrication;
    elasticity *elastic;
    const sensitivity *sensitivity; /* of cells at the front; NULL: there are none */
    thread_pool *threads;           /* that share the loops, or NULL */

    /* Per numbered cell, set by the caller and released here. */
    double *self_correction; /* what its self term of C lacks beside the front */
    int *sensitivity_of;     /* index of its sensitivity, or -1 */
    double *fill;            /* of UNKNOWN_FILL: its width over the asymptote's; 1 for others */
    double *leakoff_by_fill; /* of UNKNOWN_FILL: the derivative of its leak-off by its width */

    /* Work over the mesh: changes of widths and of pressures. The widths are zero between calls. */
    double *width, *pressure;

    /* The preconditioner, on the rectangle of the representative cells of the footprint. */
    multigrid multigrid;
    near_field near_field;
    size_t *place;  /* of each numbered cell in the arrays of both */
    double *weight; /* the part of each numbered cell on the solved side of the axes */
    size_t place_capacity;

    /* The full form. */
    double *influence; /* pressures by the unknowns, a row a numbered cell */
    double *full;      /* the transpose of the matrix as LAPACK stores it, then its factors */
    int *pivots;
    size_t full_capacity, pivot_capacity;

    long products; /* counts and seconds, which the caller sets to zero */
    double seconds_product, seconds_preconditioner;
} jacobian;

void ilsai_jacobian_destroy(jacobian *m);

/* Sets y to the matrix times x. A gmres_operator, whose context is a jacobian. */
void ilsai_jacobian_multiply(void *context, const double *x, double *y);

/* Makes the preconditioner for the lubrication as it is set. ILSA_ERR_MEMORY. */
ilsa_status ilsai_jacobian_set_preconditioner(jacobian *m);

/* Sets y to the preconditioner's solution for x. A gmres_operator, whose context is a jacobian. */
void ilsai_jacobian_precondition(void *context, const double *x, double *y);

/* Sets the influence matrix of the numbered cells, for ilsai_jacobian_solve_full. ILSA_ERR_MEMORY.
 */
ilsa_status ilsai_jacobian_set_influence(jacobian *m);

/* Solves M x = b by dense LU. ILSA_STEP_REJECTED if the matrix is singular. */
ilsa_status ilsai_jacobian_solve_full(jacobian *m, const double *b, double *x);

/*
 * The changes of numbered cell k, by its sensitivity, for changes x of the unknowns: of the width
 * of a tip cell, of the source term, and of the pressure in a channel cell by what its self term
 * lacks, at a width that stays. A tip cell has them in proportion to its fill. Zero for a cell
 * without a sensitivity. The last one is that of the front of a survey cell, in cells.
 */
double ilsai_jacobian_width_change(const jacobian *m, int k, const double *x);
double ilsai_jacobian_source_change(const jacobian *m, int k, const double *x);
double ilsai_jacobian_pressure_change(const jacobian *m, int k, const double *x);
double ilsai_jacobian_advance(const jacobian *m, int k, const double *x);

#endif
