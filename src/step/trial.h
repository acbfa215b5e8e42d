/*
 * The trial: one attempt at a step. It begins as a copy of the fracture around the footprint, and
 * the passes of the step write here alone, so that a refused step leaves the fracture as it was.
 *
 * Written by step/trial.c and step/step.c, and through them by front/tip_cells.c and
 * solve/coupled.c. Nothing of it outlives the step but memory.
 */
#ifndef ILSAI_TRIAL_H
#define ILSAI_TRIAL_H

#include "front/tip_cells.h"
#include "solve/coupled.h"
#include "step/fracture.h"
#include "step/numerics.h"

/* Volumes of a trial: of the open channel cells, of all other wet cells, and leaked in the step. */
typedef struct trial_volumes {
    double open, held, leaked;
} trial_volumes;

/* Work done in the step, whether it is accepted or not. */
typedef struct trial_work {
    int passes;
    coupled_counts coupled;
    double seconds_front;
} trial_work;

typedef struct trial {
    double dt;
    grid g;       /* the mesh as it is folded in this step */
    box region;   /* cells that the step may touch */
    fields cells; /* with source terms, leak-off and contact beside the fields of the fracture */

    /* The survey cells, found when the step begins. */
    survey_cell *survey_cells;
    double *distance;      /* of each to the front, in this pass */
    double *next_distance; /* where its width wants the front */
    int survey_count;
    size_t survey_capacity;

    tip_cells tips;              /* what the last pass has found at the front; footprint included */
    tip_pressures tip_pressures; /* what bounds those of tip cells */
    double closure_width;        /* of closed cells */

    /* Set once front and widths agree. */
    double change;     /* of the front in the last pass, in cells */
    double width_most; /* the largest width so far */
    double injected, leaked, volume;

    trial_work work;
} trial;

/* Room for the fields. ILSA_ERR_MEMORY. */
ilsa_status ilsai_trial_create(trial *t, const model *m);
void ilsai_trial_destroy(trial *t);

/*
 * Makes ready for a step of dt: folds the mesh, copies the fracture, finds the survey cells and
 * their geometry, and sets source terms, leak-off and contact of the cells that are channel
 * already, which hold for all passes. ILSA_ERR_MEMORY; ILSA_ERR_STATE with a message for a source
 * that injects outside the fracture.
 */
ilsa_status ilsai_trial_begin(trial *t, const model *m, const fracture *f, numerics *n, double dt,
                              error_text *error);

/* The pass that the tip cells are found in. */
front_pass ilsai_trial_pass(trial *t, const model *m, const fracture *f, const numerics *n);

/* The widths that the survey cells are inverted from. */
survey_widths ilsai_trial_widths(const trial *t, const model *m, const numerics *n);

/* Advance of the front so far, in cells: the largest of the survey cells'. */
double ilsai_trial_advance(const trial *t);

/* Whether survey cell k is open as the widths are now; the front before a closed one rests. */
bool ilsai_trial_is_open(const trial *t, int k);

trial_volumes ilsai_trial_volumes(const trial *t);

/*
 * Puts the volume that the iteration's tolerance has left unaccounted for into the widths of the
 * open channel in proportion, so that injected = volume + leaked holds to rounding at every step.
 * Where all is closed it has leaked. ILSA_STEP_REJECTED where it is too much.
 */
ilsa_status ilsai_trial_balance(trial *t, const model *m, const fracture *f);

/* Volume per area that leaks from a cell in the step. */
double ilsai_trial_leaked_from(const trial *t, int cell);

#endif
