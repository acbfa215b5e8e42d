/*
 * The coupled system of elasticity and lubrication in one step (4.4) to (4.8): Newton's method on
 * the widths of the channel cells and the pressures of the tip cells, the tip widths given.
 */
#ifndef ILSAI_COUPLED_H
#define ILSAI_COUPLED_H

#include "base/grid.h"
#include "elastic/elasticity.h"
#include "flow/contact.h"
#include "solve/jacobian.h"

typedef struct coupled coupled;

/* Room for a mesh of nx by ny cells. NULL on failure. */
coupled *ilsai_coupled_create(const ilsa_mesh_def *mesh);
void ilsai_coupled_destroy(coupled **c);

/* All arrays are over the mesh; only representative cells are read and written. */
typedef struct coupled_problem {
    const grid *g;
    elasticity *elastic;
    const fluid *fluid;
    const ilsa_material_def *material; /* that the fluid has its parameters from */
    box footprint;                     /* the numbered cells and their images */
    const unsigned char *kind;         /* ILSA_CELL_EMPTY cells take no part */
    const double *sigma;               /* far-field stress */
    const double *width_old;           /* at the start of the step */
    const double *source_term;         /* S of (4.4): injected less leaked in the step, per area */
    const double *self_correction;  /* what the self term lacks in channel cells; NULL: nothing */
    const sensitivity *sensitivity; /* of cells at the front to the widths, NULL: none */
    int sensitivity_count;
    contact_fields contact; /* where cells may close */
    double *width;          /* in: first guess, and the tip widths; out: solution */
    double *pressure;       /* in: first guess in tip cells; out: solution */
    double dt;
    ilsa_linear_solver linear;
    double tolerance;     /* of the error in width, relative to the largest */
    thread_pool *threads; /* that share the loops, NULL: none */
} coupled_problem;

typedef struct coupled_counts {
    long newton, krylov, products;
    double seconds_product, seconds_preconditioner;
} coupled_counts;

/*
 * Solves the problem; the pressures of the channel are those before the last change of width, see
 * ilsai_coupled_pressure. counts are added to. ILSA_STEP_REJECTED when Newton's method does not
 * converge, ILSA_ERR_MEMORY, ILSA_ERR_NUMERIC.
 */
ilsa_status ilsai_coupled_solve(coupled *c, const coupled_problem *problem, coupled_counts *counts);

/* Unknowns of the last solve. */
int ilsai_coupled_unknowns(const coupled *c);

/*
 * pressure = sigma + C width in the channel cells (4.7), with the self terms as they are beside the
 * front, for the widths of the last solve.
 */
void ilsai_coupled_pressure(coupled *c, const coupled_problem *problem, coupled_counts *counts);

#endif
