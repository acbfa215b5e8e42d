/*
 * The tip cells in one pass of a step: after the march, which cells are wet, their widths (4.18)
 * and leak-off (4.25), and how both change with the widths of the survey cells.
 */
#ifndef ILSAI_TIP_CELLS_H
#define ILSAI_TIP_CELLS_H

#include "base/error.h"
#include "base/fields.h"
#include "base/sensitivity.h"
#include "base/thread_pool.h"
#include "elastic/elasticity.h"
#include "front/march.h"
#include "front/survey.h"
#include "tip/tip_paths.h"

/* What the tip cells of a pass are found from. */
typedef struct front_pass {
    const grid *g;
    box region; /* cells that the step may touch */
    const ilsa_material_def *material;
    const elasticity *elastic;
    tip_cell_velocity velocity; /* of the front that leak-off counts with */
    double time, dt;            /* at the start of the step, and its length */
    double closure_width;       /* of closed cells, see flow/contact.h */
    /* The fracture at the start of the step. */
    const fields *old;
    const tip_paths *old_paths;
    box old_footprint;
    fields *trial; /* of the step: kinds, widths, leak-off and the like are written here */
    /* The front of this pass. */
    survey_widths widths;
    const survey_cell *survey_cells;
    int survey_count;
    const march *marched;
    thread_pool *threads; /* that share the loops, NULL: none */
} front_pass;

/*
 * Derivatives of the width of a cell: by an advance of its front in the step, of a front at rest by
 * the logarithm of its stress intensity; and by the distances of the survey cells that the front
 * comes from, as these pass the steps of the stress that each of them sees.
 */
typedef struct width_slopes {
    double advance;
    double past_steps[FRONT_PARENTS];
} width_slopes;

/* What a pass has found, beside the fields of the trial; zero to begin with. */
typedef struct tip_cells {
    box footprint;              /* of the wet cells and their images */
    tip_paths paths;            /* through the wet cells that the march reached, in its order */
    width_slopes *width_slopes; /* per cell that the march reached */
    sensitivity *sensitivities; /* of the survey cells, then of the cells that the march reached */
    int sensitivity_count;
    size_t capacity;
} tip_cells;

void ilsai_tip_cells_destroy(tip_cells *t);

/*
 * Sets kind, speed, width, leak-off and self terms of the trial's cells for the front as marched.
 * hold: a cell that the front is about to fill keeps the kind it had in the pass before.
 * ILSA_MESH_EDGE with a message, ILSA_ERR_MEMORY, ILSA_STEP_REJECTED (a wet cell is out of the
 * front's reach).
 */
ilsa_status ilsai_tip_cells_update(tip_cells *t, const front_pass *p, bool hold, error_text *error);

/*
 * Sets the sensitivities of widths, leak-off and self terms at the front to the widths of the
 * survey cells: the derivatives of (4.18) and (4.25) through (4.9) and (4.12).
 */
void ilsai_tip_cells_sensitivities(tip_cells *t, const front_pass *p);

/*
 * For front/sensitivities.c. Volume leaked per area in the step (4.25) if the front were where c
 * has it, and the path of the front; and the self term beside the front that c, or a survey cell,
 * sees.
 */
double ilsai_tip_cells_leakoff(const front_pass *p, const front_cell *c, tip_cell_history *path);
self_term ilsai_tip_cells_self_term(const front_pass *p, const front_cell *c);
self_term ilsai_survey_self_term(const front_pass *p, const survey_cell *survey);

#endif
