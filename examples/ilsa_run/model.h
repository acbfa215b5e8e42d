/* A scene in the library's terms. */
#ifndef ILSA_RUN_MODEL_H
#define ILSA_RUN_MODEL_H

#include "scene.h"

/* How the program ends. */
enum { EXIT_DONE = 0, EXIT_RUN_FAILED = 1, EXIT_BAD_SCENE = 2 };

/*
 * Makes the solver of a scene and its initial fracture. EXIT_DONE, or another status with a
 * message on stderr and *solver NULL.
 */
int model_start(const scene *sc, ilsa_solver **solver);

/* Sets the rates of all sources for time t. */
ilsa_status model_set_rates(const scene *sc, ilsa_solver *solver, double t);

#endif
