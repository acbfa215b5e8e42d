/* summary.txt: what was run, what it modelled, what it took. */
#ifndef ILSA_RUN_SUMMARY_H
#define ILSA_RUN_SUMMARY_H

#include "scene.h"

/* How a run came to its end, and the lines that say more of it or NULL. */
typedef struct ending {
    const char *words, *reason;
} ending;

/* 1, or 0 with a message on stderr. */
int summary_write(const char *directory, const scene *sc, const ilsa_solver *solver, ending ended,
                  double wall_s);

#endif
