/* One time step: predict the front, iterate, accept. */
#ifndef ILSAI_STEP_H
#define ILSAI_STEP_H

#include "step/state.h"

/*
 * Takes a step of dt > 0 on a started solver whose step data are allocated; report's counts are
 * added to. Any status but ILSA_OK leaves s->now, s->field and s->tips as they were.
 */
ilsa_status ilsai_step(ilsa_solver *s, double dt, ilsa_report *report);

/* Makes survey cells of the channel cells of a box at the rim, channel cells of the others. */
void ilsai_step_classify(const grid *g, const box *part, unsigned char *kind);

#endif
