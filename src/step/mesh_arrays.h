/*
 * What a solver keeps for each cell of the mesh, but for the stress, which is the model's. A mesh
 * of other counts needs other arrays.
 */
#ifndef ILSAI_MESH_ARRAYS_H
#define ILSAI_MESH_ARRAYS_H

#include "step/solver.h"

typedef struct mesh_arrays {
    fields fracture, trial;
    coupled *coupled;
    unsigned char *kind; /* as handed out */
} mesh_arrays;

/* Arrays for a mesh, all cells empty. ILSA_ERR_MEMORY; *a is to be destroyed in any case. */
ilsa_status ilsai_mesh_arrays_create(mesh_arrays *a, const ilsa_mesh_def *mesh, bool leaks);
void ilsai_mesh_arrays_destroy(mesh_arrays *a);

/* Gives a solver these arrays, and takes those that it had. */
void ilsai_mesh_arrays_exchange(mesh_arrays *a, ilsa_solver *s);

#endif
