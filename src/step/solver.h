/*
 * The solver: the model that the host has given, the fracture, the trial of a step, the numerics.
 *
 * api/ and step/ alone know this structure; the rooms above are handed the parts that they use.
 */
#ifndef ILSAI_SOLVER_H
#define ILSAI_SOLVER_H

#include "base/error.h"
#include "model/model.h"
#include "step/fracture.h"
#include "step/numerics.h"
#include "step/trial.h"
#include <ilsa/ilsa.h>

/* How the steps of an advance go; written by step/advance.c, start, coarsening and restore. */
typedef struct pace {
    double dt_limit; /* the longest step that the last refusal still allows */
    double since;    /* time since when refusals are counted */
    long refused;    /* refusals since then */
} pace;

/* What getters hand out, which the next call on the solver may replace; written by api/. */
typedef struct handed_out {
    ilsa_front_point *front;
    size_t front_capacity;
    ilsa_survey_point *survey;
    unsigned char *kind; /* over the mesh: the fracture's, with closed cells told from others */
    size_t survey_capacity;
} handed_out;

struct ilsa_solver {
    model model;
    fracture fracture;
    trial trial;
    numerics numerics;
    pace pace;
    ilsa_report total;    /* work done with this handle, accepted or not: no part of the fracture */
    ilsa_profile profile; /* the same as wall time by phase */
    handed_out handed_out;
    error_text error;
};

#endif
