/* The penny-shaped fracture laid on the mesh. */
#ifndef ILSAI_START_H
#define ILSAI_START_H

#include "tip/penny.h"
#include "step/state.h"

/* Whether it can be laid, and room for it. ILSA_ERR_VALUE, ILSA_MESH_EDGE, ILSA_ERR_MEMORY. */
ilsa_status ilsai_start_check(ilsa_solver *s, const radial_solution *solution);

/* Replaces the state of the solver by the penny-shaped fracture; after a successful check. */
void ilsai_start_lay(ilsa_solver *s, const radial_solution *solution);

#endif
