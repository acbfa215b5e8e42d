/* The end of a step: the trial becomes the fracture. */
#ifndef ILSAI_ACCEPT_H
#define ILSAI_ACCEPT_H

#include "step/trial.h"

/* Takes the trial over. It cannot fail. */
void ilsai_accept(fracture *f, trial *t, const model *m, const numerics *n, double time_after);

/* Lets the clock of a fracture in which nothing happens go to a later time. */
void ilsai_accept_wait(fracture *f, double time);

#endif
