/* One step of the solver. */
#ifndef ILSAI_STEP_H
#define ILSAI_STEP_H

#include "step/solver.h"

/*
 * Takes the fracture from its time to time_after, dt later. ILSA_OK; any other status leaves the
 * fracture as it was: ILSA_STEP_REJECTED, ILSA_STEP_TOO_LARGE, ILSA_MESH_EDGE, ILSA_CLOSED,
 * ILSA_ERR_STATE, ILSA_ERR_MEMORY. The work is in s->trial.work in either case.
 */
ilsa_status ilsai_step(ilsa_solver *s, double dt, double time_after);

#endif
