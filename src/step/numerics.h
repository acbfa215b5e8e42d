/*
 * The numerics of a solver: the machines that a step works with, and how exactly. They remember
 * work arrays and plans, and nothing of the fracture.
 */
#ifndef ILSAI_NUMERICS_H
#define ILSAI_NUMERICS_H

#include "base/thread_pool.h"
#include "elastic/elasticity.h"
#include "front/march.h"
#include "model/model.h"
#include "solve/anderson.h"
#include "solve/coupled.h"
#include "tip/tip_cell.h"

typedef struct numerics {
    double step_cells;          /* advance of the front in a suggested step, in cells */
    double tolerance;           /* of the front, in cells */
    tip_cell_velocity velocity; /* of the front that leak-off at it counts with */
    march *march;
    coupled *coupled;
    elasticity *elastic;
    anderson *acceleration; /* of the front's late passes */
    thread_pool *threads;   /* that share the loops; NULL: the caller's own alone */
} numerics;

/* ILSA_ERR_MEMORY, ILSA_ERR_MISMATCH, with a message. *n is to be destroyed in any case. */
ilsa_status ilsai_numerics_create(numerics *n, const model *m, error_text *error);
void ilsai_numerics_destroy(numerics *n);

#endif
