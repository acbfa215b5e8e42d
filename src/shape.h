/*
 * The shape of the front at the survey cells, from the state that a step starts from, and how the
 * width behind it departs from the tip asymptote.
 */
#ifndef ILSAI_SHAPE_H
#define ILSAI_SHAPE_H

#include "state.h"

/* Sets curvature, inner cell and depth of every seed. */
void ilsai_shape_set(const ilsa_solver *s, front_seed *seeds, int count);

/*
 * The width that the asymptote alone would have at a survey cell. Behind a front the width is
 * w_a(s) (1 + b s + ...): w_a is the semi-infinite solution, b comes from the size and shape of the
 * fracture (-1/(4 R) for a penny under uniform pressure). The ratio of the trial widths of the cell
 * and of the one behind it gives b, at the distance and velocity that the seed has now.
 */
double ilsai_shape_first_term(const ilsa_solver *s, const front_seed *seed);

#endif
