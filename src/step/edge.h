/* What an advance does where the fracture has come to the edge of its mesh. */
#ifndef ILSAI_EDGE_H
#define ILSAI_EDGE_H

#include "step/solver.h"

/*
 * Makes room for the fracture: coarsens where enough cells stay across it, otherwise adds cells as
 * far as cells_max allows, otherwise coarsens a direction that is full. Counts in the report, and
 * in the totals of the solver, what was done. ILSA_MESH_EDGE with a message that says where the
 * fracture is and what to try, where nothing is left; ILSA_ERR_MEMORY. The solver is then as it
 * was.
 */
ilsa_status ilsai_edge_pass(ilsa_solver *s, ilsa_report *report);

#endif
