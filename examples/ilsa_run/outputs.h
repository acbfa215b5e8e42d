/* What is written at each output time, and the two files that list it all. */
#ifndef ILSA_RUN_OUTPUTS_H
#define ILSA_RUN_OUTPUTS_H

#include "scene.h"

typedef struct output {
    double time;
    ilsa_mesh_def mesh; /* it may be coarsened on the way */
    int loops;          /* closed curves of the front */
} output;

typedef struct outputs {
    output *list;
    int count;
} outputs;

/*
 * Writes the state as output number count + 1, from 001 on: front, survey cells, lines and fields;
 * then run.pvd (for ParaView) and plot.gp (for figures.sh) anew. 1, or 0 with a message on stderr.
 */
int outputs_write(outputs *o, const char *directory, const scene *sc, ilsa_solver *solver);

void outputs_free(outputs *o);

#endif
