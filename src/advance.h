/* Steps of the solver's own choice. */
#ifndef ILSAI_ADVANCE_H
#define ILSAI_ADVANCE_H

#include "state.h"

/* Front speed in cells per time, the fastest of the survey cells; 0 for a front at rest. */
double ilsai_front_rate(const ilsa_solver *s);

#endif
