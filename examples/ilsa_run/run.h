/* The time loop of a scene. */
#ifndef ILSA_RUN_RUN_H
#define ILSA_RUN_RUN_H

#include "scene.h"

/*
 * Runs a scene and writes its results into a directory. The exit status of the program: 0 done,
 * 1 failed (what was reached is written), 2 refused before the first step, 128 + n: ended by
 * signal n after the step it arrived in.
 */
int run_scene(const scene *sc, const char *directory, int quiet);

#endif
