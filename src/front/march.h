/*
 * The level-set front: distances of the survey cells are extended outwards by fast marching,
 * Dontsov and Peirce 2017, (4.10) to (4.12), which also gives the front in each cell that is
 * reached, (4.13).
 */
#ifndef ILSAI_MARCH_H
#define ILSAI_MARCH_H

#include "base/grid.h"
#include "front/survey_cell.h"

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
 * Marches from the survey cells into the representative cells of a region whose kind is neither
 * channel nor survey, until T exceeds limit. level takes -s at the survey cells, T at the cells
 * that the march has reached, and infinity at the other cells of the region outside the channel.
 * ILSA_ERR_MEMORY.
 */
ilsa_status ilsai_march_run(march *f, const grid *g, const box *region, const unsigned char *kind,
                            const survey_cell *survey_cells, int survey_count, double limit,
                            double *level);

/* The cells that the last march has reached, in the order of distance. */
const front_cell *ilsai_march_cells(const march *f, int *count);

/* The ell at which a cell is full: dx cos a + dy sin a. */
static inline double ilsai_march_full(const grid *g, double cos_a, double sin_a) {
    return g->dx * cos_a + g->dy * sin_a;
}

#endif
