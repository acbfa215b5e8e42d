/* The mesh as the library sees it: where cells lie and which cell holds a point. */
#ifndef ILSAI_MESH_H
#define ILSAI_MESH_H

#include "base/error.h"
#include <ilsa/mesh.h>
#include <stddef.h>

struct ilsa_mesh {
    ilsa_mesh_def def;
};

/* ILSA_OK, or ILSA_ERR_VALUE and a message. */
ilsa_status ilsai_mesh_check(const ilsa_mesh_def *def, error_text *error);

/* The most columns, or rows, that a mesh may have. */
#define ILSAI_MESH_COUNT_MOST 1000000

/* The mesh with columns more on either side and rows more below and above. */
static inline ilsa_mesh_def ilsai_mesh_grown(const ilsa_mesh_def *def, int columns, int rows) {
    return (ilsa_mesh_def){def->nx + 2 * columns, def->ny + 2 * rows, def->dx, def->dy};
}

/* Whether two definitions mean the same cells. */
static inline int ilsai_mesh_same(const ilsa_mesh_def *a, const ilsa_mesh_def *b) {
    return a->nx == b->nx && a->ny == b->ny && a->dx == b->dx && a->dy == b->dy;
}

static inline size_t ilsai_mesh_cells(const ilsa_mesh_def *def) {
    return (size_t)def->nx * (size_t)def->ny;
}

/*
 * Lower edge of cell i of n cells of size d around the origin, 0 <= i <= n (n: upper edge of the
 * last). Exactly odd about the origin, as centres are.
 */
static inline double ilsai_mesh_edge(int n, double d, int i) {
    return (i - 0.5 * n) * d;
}

/* Centre of cell (i, j). */
static inline double ilsai_mesh_x(const ilsa_mesh_def *def, int i) {
    return (i - 0.5 * (def->nx - 1)) * def->dx;
}

static inline double ilsai_mesh_y(const ilsa_mesh_def *def, int j) {
    return (j - 0.5 * (def->ny - 1)) * def->dy;
}

/*
 * Which of n cells of size d around the origin holds x; -1 for none. A point on the edge between
 * two cells belongs to the upper one, a point on an outer edge to the outermost cell.
 */
static inline int ilsai_mesh_locate(int n, double d, double x) {
    if (!(x >= ilsai_mesh_edge(n, d, 0) && x <= ilsai_mesh_edge(n, d, n)))
        return -1;
    int i = (int)(x / d + 0.5 * n);
    i = i < 0 ? 0 : i > n - 1 ? n - 1 : i;
    /* The quotient is rounded: decide at the edges themselves. */
    if (x < ilsai_mesh_edge(n, d, i))
        i--;
    else if (i < n - 1 && x >= ilsai_mesh_edge(n, d, i + 1))
        i++;
    return i;
}

#endif
