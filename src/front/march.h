/*
 * The level-set front: distances of the survey cells extended outwards by fast marching (4.10) to
 * (4.12), and what the front is in each cell that it reaches (4.13).
 */
#ifndef ILSAI_MARCH_H
#define ILSAI_MARCH_H

#include "base/grid.h"
#include "tip/asymptote.h"
#include "tip/stress_step.h"

enum { SURVEY_STEPS = 4 };

/* A survey cell: where the marching starts. */
typedef struct survey_cell {
    int cell;
    double s0;                    /* distance to the front at the start of the step */
    double h;                     /* cell size along the normal */
    double cos_a, sin_a;          /* normal of the front as the last step left it, in 0 .. pi/2 */
    double s;                     /* distance now */
    double V;                     /* (s - s0) / dt */
    double w_asymptote, exponent; /* width of the asymptote at s, and d ln w / d ln s of it */
    double w_asymptote_inner;     /* width of the asymptote where the inner cell is */
    double w;                     /* width that s and V answer to */
    double ds_dw;                 /* derivative of s by the width of the cell */
    double ds_inner;              /* and by that of the inner cell */
    double slope;                 /* of (4.9) with the second term at s, as last seen: next to s */
    int inner;    /* cell behind it that tells how the width departs from the asymptote, -1: none */
    double depth; /* how much deeper that lies */
    int step_count; /* of the stress on the normal around the cell */
    stress_step step[SURVEY_STEPS];
    double curvature; /* of the front, positive where it is convex; 0: not known */
} survey_cell;

/* The survey cells that a cell's level comes from, and the derivatives -dT / ds of it. */
enum { FRONT_PARENTS = 4 };
typedef struct front_parents {
    int count;
    int survey[FRONT_PARENTS];
    double weight[FRONT_PARENTS]; /* positive, sum 1 */
} front_parents;

/* A cell outside the channel that the marching reached, in the order of distance. */
typedef struct front_cell {
    int cell;
    double T;            /* signed distance of its centre: negative inside, (4.11) */
    double cos_a, sin_a; /* normal of the front, reflected into 0 .. pi/2 */
    double ell;          /* distance of the front from the farthest interior corner, (4.13) */
    double V;            /* velocity of the front, from the survey cells upwind */
    front_parents from;
    double K_num, K_den; /* sums of w s^(1/2) and s over them: E' times their ratio is (4.19) */
} front_cell;

typedef struct march march;

march *ilsai_march_create(void);
void ilsai_march_destroy(march **f);

/*
 * Marches from the survey_cells into the cells of `region` (representative cells) whose kind is not
 * channel or survey, until T exceeds limit. level[] takes the survey_cells' -s and each reached T;
 * the other non-channel cells of the region take infinity. ILSA_ERR_MEMORY.
 */
ilsa_status ilsai_march_run(march *f, const grid *g, const box *region, const unsigned char *kind,
                            const survey_cell *survey_cells, int survey_count, double limit,
                            double *level);

/* What the last march reached. */
const front_cell *ilsai_march_cells(const march *f, int *count);

/* dx cos a + dy sin a: the ell at which a cell is full. */
static inline double ilsai_march_full(const grid *g, double cos_a, double sin_a) {
    return g->dx * cos_a + g->dy * sin_a;
}

#endif
