/*
 * The shape of the front at the survey cells, from the state that a step starts from: its curvature
 * and which cell behind each tells how the width departs from the tip asymptote.
 */
#ifndef ILSAI_GEOMETRY_H
#define ILSAI_GEOMETRY_H

#include "step/state.h"

/* Sets normal, curvature, inner cell, depth and stress jumps of every seed. */
void ilsai_shape_set(const ilsa_solver *s, front_seed *seeds, int count);

#endif
