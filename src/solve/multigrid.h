/*
 * One multigrid cycle for d y - div(c grad y) = b on a rectangle of cells. Its y are the pressures
 * that the flow of a step calls for if elasticity is a spring in every cell.
 *
 * A face with c = 0 has no flux, and a cell without spring and conductance has y = 0. Cost and
 * memory are in proportion to the cells. A mirrored rectangle, or one with its axes exchanged,
 * gives the mirrored or exchanged result but for rounding.
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
    bool half_x, half_y; /* whether the next level has half as many cells along x, along y */
    double *right, *up;  /* c: conductance of the face to the next cell along x, along y */
    double *spring;      /* d */
    double *inverse;     /* of the diagonal of the system; 0 in a cell without spring and faces */
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

/* Makes level 0 one of nx by ny cells with all arrays zero. ILSA_ERR_MEMORY. */
ilsa_status ilsai_multigrid_shape(multigrid *m, int nx, int ny);

/* Makes the coarse levels from right, up and spring of level 0. */
void ilsai_multigrid_build(multigrid *m);

/* Sets y of level 0 from b of level 0, which is overwritten. y is linear in b. */
void ilsai_multigrid_cycle(multigrid *m);

#endif
