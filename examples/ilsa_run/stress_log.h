/* The stress log of a scene, as layers that give every cell of its mesh the log's mean. */
#ifndef ILSA_RUN_STRESS_LOG_H
#define ILSA_RUN_STRESS_LOG_H

#include "scene.h"

/*
 * Reads the log that a scene names, if it names one, and fills in its interfaces and sigma. Between
 * the rows of the log the stress runs straight, beyond the ends it stays. A layer is half a cell
 * high and has the mean of the log over it: cell means are the log's on this mesh, on every one
 * that it is coarsened to, and where cells are added. What is wrong goes to errors; the result is
 * then 0.
 */
int stress_log_take(scene *sc, FILE *errors);

#endif
