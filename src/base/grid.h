/*
 * The cells a step works on: the mesh, folded where the scene is symmetric.
 *
 * With mirror symmetry about x = 0 only the columns i >= lo_x are solved for; the cell beyond the
 * axis is the image of the one before it. Loops run over such representative cells, of which
 * ilsai_grid_images lists the images; the elasticity product knows the axes.
 */
#ifndef ILSAI_GRID_H
#define ILSAI_GRID_H

#include "base/mirror.h"
#include <ilsa/mesh.h>
#include <stddef.h>

typedef struct grid {
    int nx, ny;
    double dx, dy;
    int mirror_x, mirror_y; /* 1: folded about x = 0, about y = 0 */
    int lo_x, lo_y;         /* first representative column and row */
} grid;

/* A box of cells, both ends included; empty if x1 < x0. */
typedef struct box {
    int x0, x1, y0, y1;
} box;

enum { GRID_LEFT, GRID_RIGHT, GRID_DOWN, GRID_UP, GRID_FACES };

static inline grid ilsai_grid(const ilsa_mesh_def *mesh, int mirror_x, int mirror_y) {
    grid g = {mesh->nx, mesh->ny, mesh->dx, mesh->dy, mirror_x, mirror_y, 0, 0};
    g.lo_x = mirror_x ? g.nx / 2 : 0;
    g.lo_y = mirror_y ? g.ny / 2 : 0;
    return g;
}

/* Where the axes lie, seen from the first representative column and row. */
static inline mirror_axis ilsai_grid_about_x(const grid *g) {
    return !g->mirror_x ? MIRROR_NONE : g->nx % 2 ? MIRROR_CENTRE : MIRROR_EDGE;
}

static inline mirror_axis ilsai_grid_about_y(const grid *g) {
    return !g->mirror_y ? MIRROR_NONE : g->ny % 2 ? MIRROR_CENTRE : MIRROR_EDGE;
}

static inline int ilsai_grid_cell(const grid *g, int i, int j) {
    return j * g->nx + i;
}

/* The representative of cell (i, j). */
static inline int ilsai_grid_fold(const grid *g, int i, int j) {
    if (i < g->lo_x) {
        i = g->nx - 1 - i;
    }
    if (j < g->lo_y) {
        j = g->ny - 1 - j;
    }
    return ilsai_grid_cell(g, i, j);
}

/* The representative cell across a face of (i, j), -1 at the mesh edge. */
static inline int ilsai_grid_neighbour(const grid *g, int i, int j, int face) {
    i += face == GRID_RIGHT ? 1 : face == GRID_LEFT ? -1 : 0;
    j += face == GRID_UP ? 1 : face == GRID_DOWN ? -1 : 0;
    if (i < 0 || i >= g->nx || j < 0 || j >= g->ny) {
        return -1;
    }
    return ilsai_grid_fold(g, i, j);
}

/* The cells that (i, j) stands for, itself first; returns how many: 1, 2 or 4. */
static inline int ilsai_grid_images(const grid *g, int i, int j, int image[4]) {
    int count = 0;
    int mi = g->nx - 1 - i, mj = g->ny - 1 - j;
    int fold_x = g->mirror_x && mi != i, fold_y = g->mirror_y && mj != j;
    image[count++] = ilsai_grid_cell(g, i, j);
    if (fold_x) {
        image[count++] = ilsai_grid_cell(g, mi, j);
    }
    if (fold_y) {
        image[count++] = ilsai_grid_cell(g, i, mj);
    }
    if (fold_x && fold_y) {
        image[count++] = ilsai_grid_cell(g, mi, mj);
    }
    return count;
}

static inline double ilsai_grid_x(const grid *g, int i) {
    return (i - 0.5 * (g->nx - 1)) * g->dx;
}

static inline double ilsai_grid_y(const grid *g, int j) {
    return (j - 0.5 * (g->ny - 1)) * g->dy;
}

/* The smallest distance that counts as a cell. */
static inline double ilsai_grid_h(const grid *g) {
    return g->dx < g->dy ? g->dx : g->dy;
}

/* Columns and rows of a box; 0 where it is empty. */
static inline size_t ilsai_box_columns(const box *b) {
    return b->x1 < b->x0 ? 0 : (size_t)b->x1 + 1 - (size_t)b->x0;
}

static inline size_t ilsai_box_rows(const box *b) {
    return b->y1 < b->y0 ? 0 : (size_t)b->y1 + 1 - (size_t)b->y0;
}

static inline void ilsai_box_add(box *b, int i, int j) {
    b->x0 = i < b->x0 ? i : b->x0;
    b->x1 = i > b->x1 ? i : b->x1;
    b->y0 = j < b->y0 ? j : b->y0;
    b->y1 = j > b->y1 ? j : b->y1;
}

/* The box widened by mx and my cells on each side, within the mesh. */
static inline box ilsai_box_widen(const grid *g, const box *b, int mx, int my) {
    box wide = {b->x0 - mx, b->x1 + mx, b->y0 - my, b->y1 + my};
    wide.x0 = wide.x0 < 0 ? 0 : wide.x0;
    wide.y0 = wide.y0 < 0 ? 0 : wide.y0;
    wide.x1 = wide.x1 >= g->nx ? g->nx - 1 : wide.x1;
    wide.y1 = wide.y1 >= g->ny ? g->ny - 1 : wide.y1;
    return wide;
}

/* The representative part of a box. */
static inline box ilsai_box_fold(const grid *g, const box *b) {
    box part = *b;
    part.x0 = part.x0 < g->lo_x ? g->lo_x : part.x0;
    part.y0 = part.y0 < g->lo_y ? g->lo_y : part.y0;
    return part;
}

#endif
