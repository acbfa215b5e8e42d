/*
 * Widths from pressures by the near field of the elasticity alone, which is C cut to its 3 x 3
 * stencil. It is well conditioned on any set of cells, so that a few steps of Chebyshev's iteration
 * all but invert it. The arrays have the layout of those in multigrid.h.
 */
#ifndef ILSAI_NEAR_FIELD_H
#define ILSAI_NEAR_FIELD_H

#include "base/mirror.h"
#include "base/thread_pool.h"
#include <ilsa/status.h>
#include <stddef.h>

typedef struct near_field {
    int nx, ny, stride;
    mirror_axis about_x, about_y;       /* where the first column and row lie against the axes */
    double self, beside, above, corner; /* entries of C with the cell itself and its neighbours */
    double *extra;                      /* per cell, added to self */
    double *open;                       /* 1 in the cells that take part, 0 elsewhere */
    double *x, *y;                      /* out: widths; in: pressures, which are overwritten */
    double *step;
    size_t capacity;      /* cells, the border included, that there is room for */
    thread_pool *threads; /* that share the loops, or NULL */
} near_field;

void ilsai_near_field_destroy(near_field *f);

/* Makes room for nx by ny cells and sets all arrays to zero. ILSA_ERR_MEMORY. */
ilsa_status ilsai_near_field_shape(near_field *f, int nx, int ny);

/* Sets x from y. x is linear in y. */
void ilsai_near_field_solve(near_field *f);

#endif
