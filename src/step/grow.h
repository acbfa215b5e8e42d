/* The mesh of a solver with another number of cells. */
#ifndef ILSAI_GROW_H
#define ILSAI_GROW_H

#include "step/solver.h"

/*
 * Adds columns on either side and rows below and above, or takes some away that hold nothing where
 * they are negative: the footprint must stay a cell off the edge, sources on the mesh, and a stress
 * per cell as large as it was. The mesh must be one that ilsai_mesh_check takes. ILSA_ERR_MEMORY
 * with a message, the solver is then as it was.
 */
ilsa_status ilsai_grow_mesh(ilsa_solver *s, int columns, int rows);

#endif
