#include "base/tuning.h"
#include "front/tip_cells.h"
#include <math.h>

/* Derivatives of the width, the source term and the pressure of a cell, and of the distance from a
 * survey cell to the front in cells. */
typedef struct derivative {
    double width, source_term, pressure, advance;
} derivative;

/* By an advance of the front within the step. */
static derivative differentiate(const front_pass *p, const front_cell *c, double width_slope) {
    double small = ILSAI_DIFFERENCE * ilsai_grid_h(p->g);
    front_cell moved = *c;
    moved.ell += small;
    moved.T -= small;
    moved.V += small / p->dt;
    derivative a = {0};
    if (p->trial->kind[c->cell] == ILSA_CELL_TIP) {
        a.width = width_slope;
    } else {
        a.pressure = ilsai_tip_cells_self_term(p, c).slope * p->trial->width[c->cell];
    }
    if (p->material->C_prime > 0) {
        tip_cell_history path;
        a.source_term =
            (p->trial->leakoff[c->cell] - ilsai_tip_cells_leakoff(p, &moved, &path)) / small;
    }
    return a;
}

/* Adds a cell on whose width the sensitivity depends, and the derivatives times a weight. */
static void depend_on(sensitivity *r, int cell, const derivative *a, double weight) {
    r->from[r->count] = cell;
    r->width[r->count] = weight * a->width;
    r->source_term[r->count] = weight * a->source_term;
    r->advance[r->count] = weight * a->advance;
    r->pressure[r->count++] = weight * a->pressure;
}

/* By the widths that place the front of a survey cell. */
static void depend_on_survey(sensitivity *r, const survey_cell *survey, const derivative *a) {
    depend_on(r, survey->cell, a, survey->ds_dw);
    if (survey->inner >= 0) {
        depend_on(r, survey->inner, a, survey->ds_inner);
    }
}

/* A front at rest changes its stress intensity, (4.19); a moving one moves. */
static sensitivity sensitivity_of_cell(const front_pass *p, const front_cell *c,
                                       const width_slopes *slopes) {
    sensitivity r = {.cell = c->cell};
    bool tip = p->trial->kind[c->cell] == ILSA_CELL_TIP;
    derivative moving = differentiate(p, c, slopes->advance), resting = {.width = slopes->advance};
    for (int k = 0; k < c->from.count; k++) {
        const survey_cell *survey = &p->survey_cells[c->from.survey[k]];
        if (c->V > 0) {
            double weight = c->from.weight[k];
            derivative by_s = {weight * moving.width + (tip ? slopes->past_steps[k] : 0),
                               weight * moving.source_term, weight * moving.pressure, 0};
            depend_on_survey(&r, survey, &by_s);
        } else if (tip && c->K_num > 0) {
            double part = ilsai_survey_smooth_slope(&p->widths, survey);
            depend_on(&r, survey->cell, &resting, part * sqrt(survey->s) / c->K_num);
        }
    }
    return r;
}

/*
 * The self term of a survey cell changes as the front moves away from it: nearly all of it where
 * toughness rules and the cell has just filled. Newton's matrix has to keep the most of it.
 */
static sensitivity sensitivity_of_survey(const front_pass *p, const survey_cell *survey) {
    sensitivity r = {.cell = survey->cell};
    double self =
        ilsai_elasticity_self_entry(p->elastic, survey->cell % p->g->nx, survey->cell / p->g->nx);
    double slope = ilsai_survey_self_term(p, survey).slope * p->trial->width[survey->cell];
    derivative a = {.advance = 1 / survey->h,
                    .pressure = fmax(slope * survey->ds_dw, -ILSAI_SELF_TERM_GIVES * self)};
    if (survey->ds_dw > 0) {
        a.pressure /= survey->ds_dw;
    }
    depend_on_survey(&r, survey, &a);
    return r;
}

/* A loop over the survey cells, or over what the march reached. */
typedef struct loop {
    tip_cells *t;
    const front_pass *p;
    const front_cell *reached;
} loop;

static void set_of_survey_cells(void *context, int first, int end) {
    const loop *l = context;
    for (int k = first; k < end; k++) {
        l->t->sensitivities[k] = sensitivity_of_survey(l->p, &l->p->survey_cells[k]);
    }
}

/* A cell that is not wet depends on nothing. */
static void set_of_reached_cells(void *context, int first, int end) {
    const loop *l = context;
    for (int k = first; k < end; k++) {
        const front_cell *c = &l->reached[k];
        bool wet = l->p->trial->kind[c->cell] != ILSA_CELL_EMPTY;
        l->t->sensitivities[l->p->survey_count + k] =
            wet ? sensitivity_of_cell(l->p, c, &l->t->width_slopes[k])
                : (sensitivity){.cell = c->cell};
    }
}

void ilsai_tip_cells_sensitivities(tip_cells *t, const front_pass *p) {
    int count;
    loop l = {t, p, ilsai_march_cells(p->marched, &count)};
    t->sensitivity_count = p->survey_count + count;
    ilsai_thread_pool_run(p->threads, set_of_survey_cells, &l, p->survey_count, ILSAI_SHARE_FRONT);
    ilsai_thread_pool_run(p->threads, set_of_reached_cells, &l, count, ILSAI_SHARE_FRONT);
}
