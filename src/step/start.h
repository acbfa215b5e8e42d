/* The penny-shaped fracture laid on the mesh. */
#ifndef ILSAI_START_H
#define ILSAI_START_H

#include "step/solver.h"
#include "tip/penny.h"

/* Whether it can be laid, and room for it. ILSA_ERR_VALUE, ILSA_MESH_EDGE, ILSA_ERR_MEMORY. */
ilsa_status ilsai_start_check(ilsa_solver *s, const penny_solution *solution);

/* Replaces the state of the solver by the penny-shaped fracture; after a successful check. */
void ilsai_start_lay(ilsa_solver *s, const penny_solution *solution);

#endif
