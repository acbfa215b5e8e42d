/*
 * The coupled system of elasticity and lubrication in one pass of a step, Dontsov and Peirce 2017,
 * (4.4) to (4.8). Newton's method finds the widths of the channel cells and the pressures of the
 * tip cells. The widths of the tip cells are given by the front; they and the leak-off at the front
 * may follow the widths of the survey cells through sensitivities.
 */
#ifndef ILSAI_COUPLED_H
#define ILSAI_COUPLED_H

#include "base/grid.h"
#include "elastic/elasticity.h"
#include "flow/contact.h"
#include "solve/jacobian.h"

typedef struct coupled coupled;

/*
 * What the pressures of tip cells are bounded by. The pressure of a tip cell is what brings the
 * fluid that the asymptote's width asks for. Where hardly any can pass it would be anything. It is
 * kept within `reach` of the pressures of the channel, low to high, and of the cell's stress. At a
 * bound the part of the asymptote's width that the fluid fills is found instead.
 */
typedef struct tip_pressures {
    double low, high;
    double reach; /* 0: there are no bounds */
} tip_pressures;

/* Makes room for a mesh of mesh->nx by mesh->ny cells. NULL on failure. */
coupled *ilsai_coupled_create(const ilsa_mesh_def *mesh);
void ilsai_coupled_destroy(coupled **c);

/* All arrays are over the mesh. Only representative cells are read and written. */
typedef struct coupled_problem {
    const grid *g;
    elasticity *elastic;
    const fluid *fluid;
    const ilsa_material_def *material; /* that the fluid has its parameters from */
    double dt;
    box footprint;                  /* the bounding box of the wet cells and their images */
    const unsigned char *kind;      /* ILSA_CELL_EMPTY cells take no part */
    const double *sigma;            /* far-field stress */
    const double *width_old;        /* at the start of the step */
    const double *source_term;      /* S of (4.4): injected less leaked in the step, per area */
    const double *self_correction;  /* what the self terms of channel cells lack; NULL: nothing */
    const sensitivity *sensitivity; /* of cells at the front; NULL: none */
    int sensitivity_count;
    contact_fields contact; /* where cells may close */
    tip_pressures tip_pressures;
    double *width;    /* in: first guess, and the tip widths; out: the solution */
    double *pressure; /* in: first guess in tip cells; out: the solution */
    ilsa_linear_solver linear;
    double tolerance;     /* of the error in width, relative to the largest width */
    thread_pool *threads; /* that share the loops, or NULL */
} coupled_problem;

typedef struct coupled_counts {
    long newton, krylov, products;
    double seconds_product, seconds_preconditioner;
} coupled_counts;

/*
 * Solves the problem and adds to the counts. The pressures of the channel are those before the last
 * change of the widths; ilsai_coupled_pressure brings them up to date. ILSA_STEP_REJECTED when
 * Newton's method does not converge; ILSA_ERR_MEMORY.
 */
ilsa_status ilsai_coupled_solve(coupled *c, const coupled_problem *problem, coupled_counts *counts);

/*
 * Whether the last solve has ended with the widths of the problem. It has not where it ended early,
 * further from where the sensitivities were made than they hold: the front is then to be set again.
 */
bool ilsai_coupled_is_settled(const coupled *c);

/* Number of unknowns of the last solve. */
int ilsai_coupled_unknowns(const coupled *c);

/*
 * Sets the pressures of the channel cells to sigma + C w, Dontsov and Peirce 2017, (4.7), for
 * the widths of the last solve, with the self terms corrected beside the front.
 */
void ilsai_coupled_pressure(coupled *c, const coupled_problem *problem, coupled_counts *counts);

#endif
