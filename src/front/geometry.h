/*
 * The shape of the front at the survey cells, from the state that a step starts from: its curvature
 * and which cell behind each tells how the width departs from the tip asymptote.
 */
#ifndef ILSAI_GEOMETRY_H
#define ILSAI_GEOMETRY_H

#include "step/state.h"

/* Sets normal, curvature, inner cell, depth and stress jumps of every survey. */
void ilsai_geometry_set(const ilsa_solver *s, survey_cell *survey_cells, int count);

#endif
