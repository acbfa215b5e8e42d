/* Where a run has stalled and what to try, in two lines. */
#ifndef ILSA_RUN_STALL_H
#define ILSA_RUN_STALL_H

#include "scene.h"

/* last: what the step that stalled reports. */
void stall_write(const scene *sc, const ilsa_solver *solver, const ilsa_report *last, FILE *out);

#endif
