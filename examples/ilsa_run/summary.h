/* summary.txt: what was run, what it modelled, what it took. */
#ifndef ILSA_RUN_SUMMARY_H
#define ILSA_RUN_SUMMARY_H

#include "scene.h"

/* ended: how the run came to its end. 1, or 0 with a message on stderr. */
int summary_write(const char *directory, const scene *sc, const ilsa_solver *solver,
                  const char *ended, double wall_s);

#endif
