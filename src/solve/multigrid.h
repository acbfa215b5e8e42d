/*
 * One multigrid cycle for d y - div(c grad y) = b on a rectangle of cells: the pressures that the
 * flow of a step calls for, were elasticity a spring in every cell. Faces without conductance have
 * no flux; cells without anything have y = 0. Cost and memory in proportion to the cells. Mirroring
 * the rectangle or exchanging its axes changes nothing but rounding.
 */
#ifndef ILSAI_MULTIGRID_H
#define ILSAI_MULTIGRID_H

#include "base/thread_pool.h"
#include <ilsa/status.h>
#include <stdbool.h>
#include <stddef.h>

/*
 * Arrays over nx by ny cells with a border of one cell: cell (i, j) at (j + 1) * stride + i + 1,
 * stride = nx + 2. The border holds zeros.
 */
typedef struct multigrid_level {
    int nx, ny, stride;
    bool half_x, half_y; /* whether the next level has half the cells along x, along y */
    double *right, *up;  /* conductance of the face to the next cell along x, along y */
    double *spring;      /* d */
    double *inverse;     /* of the diagonal; 0 where there is nothing */
    double *y, *b, *work;
    double *wide_x, *wide_y; /* how many cells of level 0 a column, a row is wide */
    int *into_x, *into_y;    /* the cell of the next level that a column, a row belongs to */
} multigrid_level;

enum { MULTIGRID_LEVELS = 40 };
typedef struct multigrid {
    multigrid_level level[MULTIGRID_LEVELS];
    int levels;
    double *pool;
    int *maps;
    size_t pool_capacity, maps_capacity;
    thread_pool *threads; /* that share the loops, or NULL */
} multigrid;

void ilsai_multigrid_destroy(multigrid *m);

/* Room for nx by ny cells, all arrays zero. ILSA_ERR_MEMORY. */
ilsa_status ilsai_multigrid_shape(multigrid *m, int nx, int ny);

/* Makes the coarse levels from right, up and spring of level 0. */
void ilsai_multigrid_build(multigrid *m);

/* y of level 0 from b of level 0, which is overwritten. Linear in b. */
void ilsai_multigrid_cycle(multigrid *m);

#endif
