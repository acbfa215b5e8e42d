/*
 * The geometry of the front at the survey cells, from the fracture that a step starts from: normal,
 * curvature, the cell further inside, and the steps of the far-field stress on the normal.
 */
#ifndef ILSAI_GEOMETRY_H
#define ILSAI_GEOMETRY_H

#include "base/grid.h"
#include "front/survey_cell.h"

/* The fields over the mesh that tell the geometry; both halves of a folded mesh are read. */
typedef struct front_view {
    const grid *g;
    const unsigned char *kind;
    const double *level;
    const double *sigma; /* NULL where the stress is uniform */
    double E_prime;
} front_view;

/* Size along the normal of survey cell (i, j): of the faces that lead out of the channel. */
double ilsai_geometry_size(const grid *g, const unsigned char *kind, int i, int j);

/* Sets normal, curvature, inner cell, depth and stress steps of survey cells with cell, s0 and h.
 */
void ilsai_geometry_set(const front_view *v, survey_cell *survey_cells, int count);

#endif
