#include "front/tip_cells.h"

#include "base/tuning.h"
#include "front/survey.h"
#include <math.h>
#include <stdlib.h>

/* Volume leaked per area from a channel cell in the step, (4.8) with the mean over the cell. */
static double channel_leak(const ilsa_solver *s, int cell, double dt) {
    double age = s->now.time - s->field.trigger[cell], spread = s->field.spread[cell];
    age = age > 0 ? age : 0;
    return ilsai_tip_cell_full_leakoff_step(s->material.C_prime, age, dt, spread);
}

static void add_sources(ilsa_solver *s, double dt) {
    for (int k = 0; k < s->def.source_count; k++) {
        const point_source *from = &s->sources[k];
        for (int c = 0; c < from->count; c++) {
            s->source_term[from->cell[c]] +=
                from->def.rate * from->part[c] * dt / (s->mesh.dx * s->mesh.dy);
        }
    }
}

static ilsa_status check_sources(ilsa_solver *s) {
    for (int k = 0; k < s->def.source_count; k++) {
        const point_source *from = &s->sources[k];
        for (int c = 0; c < from->count; c++) {
            if (from->def.rate > 0 && s->field.kind[from->cell[c]] == ILSA_CELL_EMPTY) {
                return ilsai_fail(&s->error, ILSA_ERR_STATE,
                                  "source %d at (%g, %g) injects outside the fracture", k,
                                  from->def.x, from->def.y);
            }
        }
    }
    return ILSA_OK;
}

/*
 * A step so short that rounding moved its front leaves pressures in the tip cells that are of no
 * use as a first guess: those beyond any measure are forgotten.
 */
static void forget_wild_pressures(ilsa_solver *s, const box *part) {
    double largest = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int j = part->y0; j <= part->y1; j++) {
            for (int i = part->x0; i <= part->x1; i++) {
                int cell = ilsai_grid_cell(&s->g, i, j);
                double net = fabs(s->field.pressure[cell] - s->sigma[cell]);
                if (pass == 0 && s->field.kind[cell] >= ILSA_CELL_SURVEY) {
                    largest = fmax(largest, net);
                } else if (pass == 1 && s->field.kind[cell] == ILSA_CELL_TIP &&
                           net > ILSAI_PRESSURE_WILD * largest) {
                    s->trial.pressure[cell] = 0;
                }
            }
        }
    }
}

/* A loop over what a pass of a step of dt sets at the front. */
typedef struct loop {
    ilsa_solver *s;
    const front_cell *cells; /* that the march reached */
    double dt;
    int hold;
} loop;

/* Rows of the region. */
static void begin_rows(void *context, int first, int end) {
    ilsa_solver *s = ((const loop *)context)->s;
    double dt = ((const loop *)context)->dt;
    double closure = ilsai_closure_width(s);
    box part = ilsai_box_fold(&s->g, &s->region);
    for (int j = part.y0 + first; j < part.y0 + end; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&s->g, i, j);
            int channel = s->field.kind[cell] >= ILSA_CELL_SURVEY;
            s->leak[cell] = channel && ilsai_has_leakoff(s) ? channel_leak(s, cell, dt) : 0;
            s->source_term[cell] = -s->leak[cell];
            s->self_correction[cell] = 0;
            s->contact[cell] = channel && ilsai_contact_closed(s->field.width[cell], closure)
                                   ? CONTACT_CLOSED
                                   : CONTACT_OPEN;
        }
    }
}

ilsa_status ilsai_tip_cells_begin(ilsa_solver *s, double dt) {
    box part = ilsai_box_fold(&s->g, &s->region);
    loop l = {s, NULL, dt, 0};
    int columns = (int)ilsai_box_columns(&part), rows = (int)ilsai_box_rows(&part);
    ilsai_thread_pool_run(s->threads, begin_rows, &l, rows, 1 + ILSAI_SHARE_CELLS / (columns + 1));
    ilsai_elasticity_make_self_terms(s->elastic);
    forget_wild_pressures(s, &part);
    ilsa_status status = check_sources(s);
    if (status == ILSA_OK) {
        add_sources(s, dt);
    }
    return status;
}

/* Injection alone: what the source terms of a cell are before any leak-off of this pass. */
static void set_leak(ilsa_solver *s, int cell, double leak) {
    s->source_term[cell] += s->leak[cell] - leak;
    s->leak[cell] = leak;
}

/* Cells of the pass before that the march no longer reaches. */
static ilsa_status drop_unreached(ilsa_solver *s) {
    box part = ilsai_box_fold(&s->g, &s->region);
    for (int j = part.y0; j <= part.y1; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&s->g, i, j);
            if (isfinite(s->trial.level[cell]) || s->trial.kind[cell] == ILSA_CELL_EMPTY ||
                s->field.kind[cell] >= ILSA_CELL_SURVEY) {
                continue;
            }
            if (s->field.kind[cell] == ILSA_CELL_TIP) {
                return ilsai_fail(&s->error, ILSA_STEP_REJECTED,
                                  "tip cell (%d, %d) is out of the front's reach", i, j);
            }
            s->trial.kind[cell] = ILSA_CELL_EMPTY;
            s->trial.width[cell] = 0;
            set_leak(s, cell, 0);
        }
    }
    return ILSA_OK;
}

static unsigned char classify(const ilsa_solver *s, const front_cell *c, int hold) {
    double full = ilsai_march_full(&s->g, c->cos_a, c->sin_a);
    unsigned char was = s->trial.kind[c->cell];
    if (hold && was != ILSA_CELL_EMPTY && fabs(c->ell - full) < ILSAI_HOLD * full) {
        return was;
    }
    if (c->ell >= full) {
        return ILSA_CELL_CHANNEL;
    }
    int wet = c->ell > ILSAI_WET_MIN * ilsai_grid_h(&s->g);
    return wet || s->field.kind[c->cell] == ILSA_CELL_TIP ? ILSA_CELL_TIP : ILSA_CELL_EMPTY;
}

/*
 * The path of the front in the cell up to the end of the step. The front at its start is where this
 * step's own march has it, so that what leaks in the step goes to nothing with the step.
 */
static tip_cell_history path_in_cell(const ilsa_solver *s, const front_cell *c, double dt) {
    double t = s->now.time + dt;
    const tip_record *record = ilsai_asymptote_records_find(&s->tips, c->cell);
    tip_cell_history history;
    if (record) {
        double ell = fmax(c->ell, 0);
        history = record->history;
        ilsai_tip_cell_amend(&history, ell - fmax(c->V, 0) * dt, ell);
    } else {
        double since = c->V > 0 ? c->ell / c->V : dt;
        since = since > dt ? dt : since;
        since = since < 1e-6 * dt ? 1e-6 * dt : since;
        ilsai_tip_cell_enter(&history, t - since);
    }
    ilsai_tip_cell_record(&history, t, c->ell > 0 ? c->ell : 0);
    return history;
}

/* Leak-off (4.25) in the step, per area, if the front were where c has it, and its path. */
static double leak_for(const ilsa_solver *s, const front_cell *c, double dt,
                       tip_cell_history *history) {
    tip_cell_front at = {c->ell, c->cos_a, c->sin_a, s->g.dx, s->g.dy};
    *history = path_in_cell(s, c, dt);
    return ilsai_tip_cell_leakoff_last(s->material.C_prime, s->velocity, &at, history) /
           (s->g.dx * s->g.dy);
}

/* Whether the cells that place the front in c are closed, which brings it no fluid. */
static int is_cut_off(const ilsa_solver *s, const front_cell *c) {
    int open = 0;
    for (int p = 0; p < c->from.count; p++) {
        open |= s->contact[s->survey_cells[c->from.survey[p]].cell] == CONTACT_OPEN;
    }
    return !open;
}

/* A tip cell that is cut off leaks no more than it loses in width, and gains none. */
static void leak_at_front(ilsa_solver *s, const front_cell *c, double dt, tip_record *record) {
    record->cell = c->cell;
    double leak = leak_for(s, c, dt, &record->history);
    if (s->trial.kind[c->cell] == ILSA_CELL_TIP && is_cut_off(s, c)) {
        leak = fmin(leak, fmax(s->field.width[c->cell] - s->trial.width[c->cell], 0));
    }
    set_leak(s, c->cell, leak);
}

/*
 * The part of the widths of its jumps that a front is believed: in its survey cell they cannot be
 * more than all there is. A high barrier lets a front in by less than distances are known to.
 */
static double step_share(const ilsa_solver *s, const survey_cell *survey) {
    double w = ilsai_survey_step_width(survey, survey->s), most = s->field.width[survey->cell];
    return w > most ? most / w : 1;
}

/* What jump k adds to a cell; by_ell with the distance to it, which grows with ell: a front that
 * has just passed a high one answers by that alone. */
static tip_cell_growth one_step(const survey_cell *survey, int k, const tip_cell_front *at,
                                double share) {
    step_depth d = ilsai_survey_step_depth(survey, k);
    double more = ILSAI_DIFFERENCE * d.value;
    tip_cell_growth one = ilsai_tip_cell_step_growth(d.value, at);
    if (more > 0 && share == 1) {
        double deeper = ilsai_tip_cell_step_growth(d.value + more, at).volume;
        one.by_ell += d.by_s * (deeper - one.volume) / more;
    }
    return one;
}

/* Mean over the cell of what the jumps of the stress behind its front add, from the survey_cells'
 * sides.
 */
static tip_cell_growth stress_step_width(const ilsa_solver *s, const front_cell *c,
                                         const tip_cell_front *at) {
    tip_cell_growth sum = {0, 0, 0};
    for (int p = 0; p < c->from.count; p++) {
        const survey_cell *survey = &s->survey_cells[c->from.survey[p]];
        double share = survey->step_count > 0 ? step_share(s, survey) : 0;
        for (int k = 0; k < survey->step_count; k++) {
            double part = share * c->from.weight[p] * survey->step[k].height / (s->g.dx * s->g.dy);
            tip_cell_growth one = one_step(survey, k, at, share);
            sum.volume += part * one.volume;
            sum.by_ell += part * one.by_ell;
        }
    }
    return sum;
}

/*
 * Mean width (4.18), and its derivative: of a moving front by an advance within the step, which is
 * one of the velocity too; of one at rest by the logarithm of its stress intensity. In a cell that
 * has just filled it is the first guess of the coupled solve.
 */
typedef struct tip_width {
    double value, slope;
} tip_width;

static tip_width mean_width(const ilsa_solver *s, const front_cell *c, double dt) {
    tip_cell_front at = {c->ell, c->cos_a, c->sin_a, s->g.dx, s->g.dy};
    double K_I = s->material.E_prime * c->K_num / c->K_den, V = c->V > 0 ? c->V : 0;
    double area = s->g.dx * s->g.dy;
    tip_cell_growth growth = ilsai_tip_cell_growth(&s->tip_material, V, K_I, &at);
    tip_width w = {growth.volume / area, V > 0 ? growth.by_ell / area : growth.volume / area};
    if (V > 0) {
        w.slope += growth.by_log_V / (area * V * dt);
    }
    tip_cell_growth added = stress_step_width(s, c, &at);
    w.slope += V > 0 ? added.by_ell : 0;
    w.value = fmax(w.value + added.volume, ILSAI_STRESS_STEP_LEFT * w.value);
    return w;
}

/* Kind, velocity, width and leak-off of the k-th cell that the march reached, and its record. */
static void set_cell(ilsa_solver *s, const front_cell *c, double dt, int hold, int k) {
    unsigned char was = s->trial.kind[c->cell], kind = classify(s, c, hold);
    s->trial.kind[c->cell] = kind;
    s->trial.speed[c->cell] = c->V;
    if (kind == ILSA_CELL_EMPTY) {
        s->trial.width[c->cell] = 0;
        set_leak(s, c->cell, 0);
        return;
    }
    if (kind == ILSA_CELL_TIP || was != ILSA_CELL_CHANNEL) {
        tip_width w = mean_width(s, c, dt);
        double most = is_cut_off(s, c) ? s->field.width[c->cell] : w.value;
        s->trial.width[c->cell] = fmin(w.value, most);
        s->width_slope[k] = w.slope;
    }
    if (ilsai_has_leakoff(s)) {
        leak_at_front(s, c, dt, &s->trial_tips.at[k]);
    }
}

static void set_cells(void *context, int first, int end) {
    const loop *l = context;
    for (int k = first; k < end; k++) {
        set_cell(l->s, &l->cells[k], l->dt, l->hold, k);
    }
}

/* What the self terms of the survey cells and of cells that have filled in the step lack. */
static self_term self_term_of(const ilsa_solver *s, const front_cell *c) {
    double at = -c->T, V = c->V > 0 ? c->V : 0;
    double w = V > 0 ? ilsai_asymptote_width(&s->tip_material, V, at) : 1;
    self_term_front seen = {at, c->cos_a, c->sin_a,
                            ilsai_asymptote_exponent(&s->tip_material, V, at, w)};
    return ilsai_elasticity_self_term(s->elastic, c->cell % s->g.nx, c->cell / s->g.nx, &seen);
}

static self_term self_term_of_survey(const ilsa_solver *s, const survey_cell *survey) {
    self_term_front seen = ilsai_survey_front(survey);
    return ilsai_elasticity_self_term(s->elastic, survey->cell % s->g.nx, survey->cell / s->g.nx,
                                      &seen);
}

static void set_survey_self_terms(void *context, int first, int end) {
    ilsa_solver *s = ((const loop *)context)->s;
    for (int k = first; k < end; k++) {
        s->self_correction[s->survey_cells[k].cell] =
            self_term_of_survey(s, &s->survey_cells[k]).value;
    }
}

static void set_filled_self_terms(void *context, int first, int end) {
    const loop *l = context;
    for (int k = first; k < end; k++) {
        const front_cell *c = &l->cells[k];
        int full = l->s->trial.kind[c->cell] >= ILSA_CELL_SURVEY;
        l->s->self_correction[c->cell] = full ? self_term_of(l->s, c).value : 0;
    }
}

/*
 * A tip cell without a pressure, as one wetted in this step, starts from its wet neighbours' that
 * are nearer to the channel, weighed as by the march: by the slope of the level over the distance.
 */
static void guess_pressure(ilsa_solver *s, const front_cell *c) {
    double sum = 0, weights = 0;
    for (int face = 0; face < GRID_FACES && s->trial.pressure[c->cell] == 0; face++) {
        int cell = ilsai_grid_neighbour(&s->g, c->cell % s->g.nx, c->cell / s->g.nx, face);
        if (cell >= 0 && s->trial.kind[cell] != ILSA_CELL_EMPTY && s->trial.pressure[cell] != 0) {
            double d = face == GRID_LEFT || face == GRID_RIGHT ? s->g.dx : s->g.dy;
            double weight = fmax(c->T - s->trial.level[cell], 0) / (d * d);
            sum += weight * s->trial.pressure[cell];
            weights += weight;
        }
    }
    if (weights > 0) {
        s->trial.pressure[c->cell] = sum / weights;
    }
}

/* The footprint with the cell and its images; 0 if it touches the edge of the mesh. */
static int grow_footprint(ilsa_solver *s, int cell) {
    int image[4];
    int count = ilsai_grid_images(&s->g, cell % s->g.nx, cell / s->g.nx, image);
    for (int k = 0; k < count; k++) {
        ilsai_box_add(&s->trial_footprint, image[k] % s->g.nx, image[k] / s->g.nx);
    }
    const box *b = &s->trial_footprint;
    return b->x0 > 0 && b->y0 > 0 && b->x1 < s->g.nx - 1 && b->y1 < s->g.ny - 1;
}

/* Room for what the cells of a march and the survey cells answer. */
static ilsa_status reserve(ilsa_solver *s, int count) {
    if (count + s->survey_count <= s->sensitivity_capacity) {
        return ILSA_OK;
    }
    size_t most = (size_t)count + (size_t)s->survey_count, capacity = most + most / 2 + 16;
    sensitivity *sensitivities = realloc(s->sensitivities, capacity * sizeof *sensitivities);
    s->sensitivities = sensitivities ? sensitivities : s->sensitivities;
    double *width_slope = realloc(s->width_slope, capacity * sizeof *width_slope);
    s->width_slope = width_slope ? width_slope : s->width_slope;
    if (!sensitivities || !width_slope) {
        return ILSA_ERR_MEMORY;
    }
    s->sensitivity_capacity = (int)capacity;
    return ILSA_OK;
}

/* The records of the cells that are wet, without gaps. */
static void pack_records(ilsa_solver *s, const front_cell *cells, int count) {
    tip_records *r = &s->trial_tips;
    r->count = 0;
    for (int k = 0; k < count; k++) {
        if (s->trial.kind[cells[k].cell] != ILSA_CELL_EMPTY) {
            r->at[r->count++] = r->at[k];
        }
    }
}

/* What depends on the cells set before: the footprint and first guesses of pressure. */
static ilsa_status wet_cells(ilsa_solver *s, const front_cell *cells, int count) {
    s->trial_footprint = s->now.footprint;
    for (int k = 0; k < count; k++) {
        if (s->trial.kind[cells[k].cell] != ILSA_CELL_EMPTY) {
            guess_pressure(s, &cells[k]);
            if (!grow_footprint(s, cells[k].cell)) {
                return ilsai_fail(&s->error, ILSA_MESH_EDGE,
                                  "the footprint reaches the edge of the mesh of %d x %d cells",
                                  s->g.nx, s->g.ny);
            }
        }
    }
    return ILSA_OK;
}

ilsa_status ilsai_tip_cells_update(ilsa_solver *s, double dt, int hold) {
    int count;
    const front_cell *cells = ilsai_march_cells(s->march, &count);
    if (reserve(s, count) != ILSA_OK ||
        (ilsai_has_leakoff(s) &&
         ilsai_asymptote_records_reserve(&s->trial_tips,
                                         count << (s->g.mirror_x + s->g.mirror_y)) != ILSA_OK)) {
        return ILSA_ERR_MEMORY;
    }
    ilsa_status status = drop_unreached(s);
    if (status != ILSA_OK) {
        return status;
    }
    loop l = {s, cells, dt, hold};
    ilsai_thread_pool_run(s->threads, set_cells, &l, count, ILSAI_SHARE_FRONT);
    if (ilsai_has_leakoff(s)) {
        pack_records(s, cells, count);
    }
    ilsai_thread_pool_run(s->threads, set_survey_self_terms, &l, s->survey_count,
                          ILSAI_SHARE_FRONT);
    ilsai_thread_pool_run(s->threads, set_filled_self_terms, &l, count, ILSAI_SHARE_FRONT);
    return wet_cells(s, cells, count);
}

/* What of a cell answers, and how, to an advance of the front or to a width. */
typedef struct answer {
    double width, source_term, pressure;
} answer;

/* Derivatives by an advance of the front within the step. */
static answer differentiate(const ilsa_solver *s, const front_cell *c, double dt,
                            double width_slope) {
    double small = ILSAI_DIFFERENCE * ilsai_grid_h(&s->g);
    front_cell moved = *c;
    moved.ell += small;
    moved.T -= small;
    moved.V += small / dt;
    answer a = {0, 0, 0};
    if (s->trial.kind[c->cell] == ILSA_CELL_TIP) {
        a.width = width_slope;
    } else {
        a.pressure = self_term_of(s, c).slope * s->trial.width[c->cell];
    }
    if (ilsai_has_leakoff(s)) {
        tip_cell_history path;
        a.source_term = (s->leak[c->cell] - leak_for(s, &moved, dt, &path)) / small;
    }
    return a;
}

/* Adds a cell that a sensitivity answers to. */
static void depend_on(sensitivity *r, int cell, const answer *a, double weight) {
    r->from[r->count] = cell;
    r->width[r->count] = weight * a->width;
    r->source_term[r->count] = weight * a->source_term;
    r->pressure[r->count++] = weight * a->pressure;
}

/* To the front that a survey cell places. */
static void depend_on_survey(sensitivity *r, const survey_cell *survey, const answer *a,
                             double weight) {
    depend_on(r, survey->cell, a, weight * survey->ds_dw);
    if (survey->inner >= 0) {
        depend_on(r, survey->inner, a, weight * survey->ds_inner);
    }
}

/* A front at rest answers with its stress intensity, (4.19); a moving one by moving. */
static sensitivity sensitivity_in(const ilsa_solver *s, const front_cell *c, double dt,
                                  double width_slope) {
    sensitivity r = {.cell = c->cell};
    answer moving = differentiate(s, c, dt, width_slope), resting = {width_slope, 0, 0};
    for (int p = 0; p < c->from.count; p++) {
        const survey_cell *survey = &s->survey_cells[c->from.survey[p]];
        if (c->V > 0) {
            depend_on_survey(&r, survey, &moving, c->from.weight[p]);
        } else if (s->trial.kind[c->cell] == ILSA_CELL_TIP && c->K_num > 0) {
            double part = ilsai_survey_smooth_slope(s, survey);
            depend_on(&r, survey->cell, &resting, part * sqrt(survey->s) / c->K_num);
        }
    }
    return r;
}

/*
 * The self term of a survey cell changes as the front moves away from it: nearly all of it where
 * toughness rules and the cell has just filled. Newton's matrix has to keep the most of it.
 */
static sensitivity sensitivity_of_survey(const ilsa_solver *s, const survey_cell *survey) {
    sensitivity r = {.cell = survey->cell};
    double self =
        ilsai_elasticity_self_entry(s->elastic, survey->cell % s->g.nx, survey->cell / s->g.nx);
    double slope = self_term_of_survey(s, survey).slope * s->trial.width[survey->cell];
    answer a = {.pressure = fmax(slope * survey->ds_dw, -ILSAI_SELF_TERM_GIVES * self)};
    if (survey->ds_dw > 0) {
        a.pressure /= survey->ds_dw;
    }
    depend_on_survey(&r, survey, &a, 1);
    return r;
}

static void set_survey_sensitivities(void *context, int first, int end) {
    ilsa_solver *s = ((const loop *)context)->s;
    for (int k = first; k < end; k++) {
        s->sensitivities[k] = sensitivity_of_survey(s, &s->survey_cells[k]);
    }
}

/* A cell that is not wet answers to nothing. */
static void set_cell_sensitivities(void *context, int first, int end) {
    const loop *l = context;
    ilsa_solver *s = l->s;
    for (int k = first; k < end; k++) {
        const front_cell *c = &l->cells[k];
        int wet = s->trial.kind[c->cell] != ILSA_CELL_EMPTY;
        s->sensitivities[s->survey_count + k] =
            wet ? sensitivity_in(s, c, l->dt, s->width_slope[k]) : (sensitivity){.cell = c->cell};
    }
}

void ilsai_tip_cells_sensitivities(ilsa_solver *s, double dt) {
    int count;
    const front_cell *cells = ilsai_march_cells(s->march, &count);
    loop l = {s, cells, dt, 0};
    s->sensitivity_count = s->survey_count + count;
    ilsai_thread_pool_run(s->threads, set_survey_sensitivities, &l, s->survey_count,
                          ILSAI_SHARE_FRONT);
    ilsai_thread_pool_run(s->threads, set_cell_sensitivities, &l, count, ILSAI_SHARE_FRONT);
}
