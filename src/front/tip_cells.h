/*
 * The cells at the front in one pass of a step: after the march, which are wet, their widths (4.18)
 * and leak-off (4.25), and the source terms of the channel (4.8).
 */
#ifndef ILSAI_TIP_CELLS_H
#define ILSAI_TIP_CELLS_H

#include "step/state.h"

/* Source terms of the cells that were channel when the step began: they hold for all passes. */
ilsa_status ilsai_tip_cells_begin(ilsa_solver *s, double dt);

/*
 * Kinds, tip widths, leak-off and footprint for the front as marched. hold: a cell that the front
 * is about to fill keeps the kind it had in the pass before. ILSA_MESH_EDGE, ILSA_ERR_MEMORY,
 * ILSA_STEP_REJECTED (a wet cell is out of the front's reach).
 */
ilsa_status ilsai_tip_cells_update(ilsa_solver *s, double dt, int hold);

/*
 * How widths and leak-off of the cells at the front, as they are set, answer to the widths of the
 * survey cells: the derivatives of (4.18) and (4.25) through (4.9) and (4.12).
 */
void ilsai_tip_cells_sensitivities(ilsa_solver *s, double dt);

#endif
