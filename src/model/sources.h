/* Point sources: the cells that each feeds, what they inject together, their symmetry. */
#ifndef ILSAI_SOURCES_H
#define ILSAI_SOURCES_H

#include "base/error.h"
#include <ilsa/mesh.h>
#include <ilsa/solver.h>
#include <stdbool.h>

/* A point source on an edge between cells feeds the cells on both sides alike. */
typedef struct point_source {
    ilsa_source_def def;
    int count; /* cells it feeds: 1, 2 or 4 */
    int cell[4];
    double part[4]; /* of its rate that each takes; their sum is 1 */
} point_source;

typedef struct sources {
    point_source *at;
    int count;
} sources;

/* ILSA_OK, or ILSA_ERR_VALUE for a source off the mesh or a rate out of its range. */
ilsa_status ilsai_source_check(const ilsa_mesh_def *mesh, const ilsa_source_def *def,
                               error_text *error);

/* Copies the definitions of the sources. ILSA_ERR_MEMORY. */
ilsa_status ilsai_sources_create(sources *s, const ilsa_source_def *defs, int count);
void ilsai_sources_destroy(sources *s);

/* Finds the cells that each source feeds on a mesh. */
void ilsai_sources_place(sources *s, const ilsa_mesh_def *mesh);

/* Volume per time that all sources inject. */
double ilsai_sources_rate(const sources *s);

/* Whether every source has an image of its rate about x = 0 or about y = 0. */
bool ilsai_sources_mirror(const sources *s, bool about_x);

#endif
