#include "step/step.h"

#include "base/clock.h"
#include "base/tuning.h"
#include "front/geometry.h"
#include "front/survey.h"
#include "front/tip_cells.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int is_channel(unsigned char kind) {
    return kind >= ILSA_CELL_SURVEY;
}

static ilsa_status reserve_survey(ilsa_solver *s, int count) {
    if (count <= s->survey_cell_capacity) {
        return ILSA_OK;
    }
    size_t capacity = (size_t)count + (size_t)count / 2 + 16;
    survey_cell *survey_cells = realloc(s->survey_cells, capacity * sizeof *survey_cells);
    s->survey_cells = survey_cells ? survey_cells : s->survey_cells;
    double *distance = realloc(s->distance, capacity * sizeof *distance);
    s->distance = distance ? distance : s->distance;
    double *next = realloc(s->next_distance, capacity * sizeof *next);
    s->next_distance = next ? next : s->next_distance;
    if (!survey_cells || !distance || !next) {
        return ILSA_ERR_MEMORY;
    }
    s->survey_cell_capacity = (int)capacity;
    return ILSA_OK;
}

/* The survey cells as the last step left them. */
static ilsa_status find_survey(ilsa_solver *s) {
    box part = ilsai_box_fold(&s->g, &s->now.footprint);
    s->survey_count = 0;
    for (int j = part.y0; j <= part.y1; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&s->g, i, j);
            if (s->field.kind[cell] != ILSA_CELL_SURVEY) {
                continue;
            }
            if (reserve_survey(s, s->survey_count + 1) != ILSA_OK) {
                return ILSA_ERR_MEMORY;
            }
            survey_cell survey = {.cell = cell, .s0 = -s->field.level[cell]};
            survey.h = ilsai_survey_size(s, &s->g, i, j);
            survey.V = s->field.speed[cell];
            survey.w = s->field.width[cell];
            s->survey_cells[s->survey_count++] = survey;
        }
    }
    return ILSA_OK;
}

static void copy_rows(const ilsa_solver *s, const box *b, void *to, const void *from, size_t size) {
    size_t length = (size_t)(b->x1 - b->x0 + 1) * size;
    for (int j = b->y0; j <= b->y1; j++) {
        size_t at = (size_t)ilsai_grid_cell(&s->g, b->x0, j) * size;
        memcpy((char *)to + at, (const char *)from + at, length);
    }
}

static void copy_fields(const ilsa_solver *s, const box *b, fields *to, const fields *from) {
    copy_rows(s, b, to->width, from->width, sizeof *to->width);
    copy_rows(s, b, to->pressure, from->pressure, sizeof *to->pressure);
    copy_rows(s, b, to->level, from->level, sizeof *to->level);
    copy_rows(s, b, to->speed, from->speed, sizeof *to->speed);
    copy_rows(s, b, to->kind, from->kind, sizeof *to->kind);
}

/* A loop over the survey cells of a step of dt. */
typedef struct survey_loop {
    ilsa_solver *s;
    double dt;
} survey_loop;

static void share_survey(pool_function *function, ilsa_solver *s, double dt) {
    survey_loop l = {s, dt};
    ilsai_thread_pool_run(s->threads, function, &l, s->survey_count, ILSAI_SHARE_FRONT);
}

static void set_shapes(void *context, int first, int end) {
    ilsa_solver *s = ((const survey_loop *)context)->s;
    ilsai_geometry_set(s, s->survey_cells + first, end - first);
}

static ilsa_status begin(ilsa_solver *s, double dt) {
    s->g = ilsai_solver_grid(s);
    s->region = ilsai_solver_region(s, &s->now.footprint);
    copy_fields(s, &s->region, &s->trial, &s->field);
    s->trial_tips.count = 0;
    if (find_survey(s) != ILSA_OK ||
        ilsai_anderson_begin(s->acceleration, s->survey_count) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    share_survey(set_shapes, s, dt);
    return ilsai_tip_cells_begin(s, dt);
}

/* Distances within what the step allows: never back, no further than a step may go. */
static double bounded(const survey_cell *survey, double distance) {
    double limit = survey->s0 + ILSAI_ADVANCE_MAX * survey->h;
    distance = distance > survey->s0 ? distance : survey->s0;
    return distance < limit ? distance : limit;
}

static int is_nested(const ilsa_solver *s) {
    return s->def.loop == ILSA_LOOP_NESTED;
}

static int is_open(const ilsa_solver *s, const survey_cell *survey) {
    return s->contact[survey->cell] == CONTACT_OPEN;
}

/*
 * How far a front may be predicted to go: the width that steps of the stress add on the way is
 * fluid that a barrier would take out of the cells behind it, until nothing were left of them.
 */
static double before_barrier(const survey_cell *survey, double distance) {
    double low = survey->s0, high = distance;
    survey_cell at = *survey;
    at.s = low;
    double most = ilsai_survey_step_width(&at, low) + ILSAI_STRESS_STEP_PREDICTED * survey->w;
    for (int k = 0; k < ILSAI_STRESS_STEP_BISECTIONS; k++) {
        at.s = k > 0 ? 0.5 * (low + high) : high;
        *(ilsai_survey_step_width(&at, at.s) > most ? &high : &low) = at.s;
    }
    return low;
}

/* The front moves on as it did in the last step. */
static void predict(ilsa_solver *s, double dt) {
    for (int k = 0; k < s->survey_count; k++) {
        survey_cell *survey = &s->survey_cells[k];
        double advance = is_nested(s) || !is_open(s, survey) ? 0 : survey->V * dt;
        double distance = bounded(survey, survey->s0 + advance);
        s->distance[k] = survey->step_count > 0 ? before_barrier(survey, distance) : distance;
    }
}

static void place_survey(void *context, int first, int end) {
    ilsa_solver *s = ((const survey_loop *)context)->s;
    double dt = ((const survey_loop *)context)->dt;
    for (int k = first; k < end; k++) {
        survey_cell *survey = &s->survey_cells[k];
        survey->s = s->distance[k];
        survey->V = (survey->s - survey->s0) / dt;
        ilsai_survey_settle(s, survey);
        survey->w = survey->V > 0 ? survey->w_asymptote : ilsai_survey_width(s, survey);
    }
}

/* Survey, tip and channel cells for the front where it is now. */
static ilsa_status march_front(ilsa_solver *s, double dt, int hold) {
    share_survey(place_survey, s, dt);
    ilsa_status status =
        ilsai_march_run(s->march, &s->g, &s->region, s->field.kind, s->survey_cells,
                        s->survey_count, ilsai_solver_band(s), s->trial.level);
    return status == ILSA_OK ? ilsai_tip_cells_update(s, dt, hold) : status;
}

/* Advance of the front in cells; a front at its bound has been held back by it. */
static double advance(const ilsa_solver *s) {
    double largest = 0;
    for (int k = 0; k < s->survey_count; k++) {
        double cells = (s->survey_cells[k].s - s->survey_cells[k].s0) / s->survey_cells[k].h;
        largest = cells > largest ? cells : largest;
    }
    return largest;
}

/*
 * Tolerance of the front in cells. It shrinks with a step that moves the front less than the usual,
 * so that the velocity is found as well, but for one that is as good as none.
 */
static double tolerance_now(const ilsa_solver *s, int pass) {
    double usual = pass < ILSAI_SETTLE_PASS ? s->tolerance : fmax(s->tolerance, ILSAI_SETTLE);
    double part = fmin(1, advance(s) / s->step_cells);
    part = part > 0 ? fmax(part, ILSAI_TOLERANCE_PART) : 1;
    return fmax(usual * part, ILSAI_TOLERANCE_LEAST);
}

static coupled_problem pose(ilsa_solver *s, double dt, double change) {
    coupled_problem problem = {
        .g = &s->g,
        .e = s->elastic,
        .footprint = s->trial_footprint,
        .kind = s->trial.kind,
        .sigma = s->sigma,
        .width_old = s->field.width,
        .source_term = s->source_term,
        .self_correction = s->self_correction,
        .width = s->trial.width,
        .pressure = s->trial.pressure,
        .dt = dt,
        .mu_prime = s->material.mu_prime,
        .linear = s->def.linear,
        .contact = {ilsai_closure_width(s), s->contact, s->leak, s->retained},
        .sensitivity = s->sensitivities,
        .sensitivity_count = s->sensitivity_count,
        .threads = s->threads};
    double share = fmin(ILSAI_PASS_SHARE, ILSAI_PASS_SHARP * s->tolerance);
    double aim = is_nested(s) ? s->tolerance : fmax(share * change, tolerance_now(s, 0));
    problem.tolerance = ILSAI_WIDTH_TOLERANCE * fmin(aim, 0.1);
    return problem;
}

static void invert_survey(void *context, int first, int end) {
    ilsa_solver *s = ((const survey_loop *)context)->s;
    double dt = ((const survey_loop *)context)->dt;
    for (int k = first; k < end; k++) {
        survey_cell *survey = &s->survey_cells[k];
        if (is_open(s, survey)) {
            s->next_distance[k] = bounded(survey, ilsai_survey_distance(s, survey, dt));
        } else {
            s->next_distance[k] = survey->s0;
            survey->ds_dw = survey->ds_inner = 0;
        }
    }
}

/* Where the widths want the front, which rests before closed cells; returns the largest difference
 * to where it is, in cells. */
static double survey(ilsa_solver *s, double dt) {
    double largest = 0;
    share_survey(invert_survey, s, dt);
    for (int k = 0; k < s->survey_count; k++) {
        double change = fabs(s->next_distance[k] - s->distance[k]) / s->survey_cells[k].h;
        largest = change > largest || isnan(change) ? change : largest;
    }
    return largest;
}

/*
 * The next distances. While the cells at the front answer within the Newton system the widths have
 * already foreseen the front's move; afterwards the iteration is a fixed point to be accelerated.
 */
static void move_front(ilsa_solver *s, int pass) {
    if (is_nested(s) || pass + 1 < ILSAI_SENSITIVITY_PASSES) {
        memcpy(s->distance, s->next_distance, (size_t)s->survey_count * sizeof *s->distance);
        return;
    }
    ilsai_anderson_next(s->acceleration, s->next_distance, s->distance);
    for (int k = 0; k < s->survey_count; k++) {
        s->distance[k] = bounded(&s->survey_cells[k], s->distance[k]);
    }
}

/* Per area in the step: nothing comes back, whatever a late solve has let go, see contact.h. */
static double leaked_from(const ilsa_solver *s, int cell) {
    double retained = s->retained ? s->retained[cell] : 0;
    return s->leak[cell] - fmax(fmin(retained, s->leak[cell]), 0);
}

typedef struct volumes {
    double open, held, leaked; /* in open channel cells, in the others */
} volumes;

static int is_open_channel(const ilsa_solver *s, int cell) {
    return is_channel(s->trial.kind[cell]) && s->contact[cell] == CONTACT_OPEN;
}

static volumes sum_volumes(const ilsa_solver *s) {
    volumes v = {0, 0, 0};
    box part = ilsai_box_fold(&s->g, &s->trial_footprint);
    int image[4];
    for (int j = part.y0; j <= part.y1; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&s->g, i, j);
            double area = ilsai_grid_images(&s->g, i, j, image) * s->g.dx * s->g.dy;
            if (s->trial.kind[cell] != ILSA_CELL_EMPTY) {
                *(is_open_channel(s, cell) ? &v.open : &v.held) += s->trial.width[cell] * area;
                v.leaked += leaked_from(s, cell) * area;
            }
        }
    }
    return v;
}

/*
 * Whether so much leaks in the step that the predicted front cannot be held while the widths
 * settle: misplaced by little, it takes more fluid than the fracture has.
 */
static int leaks_fast(const ilsa_solver *s) {
    return ilsai_has_leakoff(s) && sum_volumes(s).leaked > ILSAI_LEAK_FAST * s->now.fracture;
}

/* The front where it is now: cells, tip widths, leak-off; and how they answer to the widths. */
static ilsa_status set_front(ilsa_solver *s, double dt, int pass) {
    double start = ilsai_clock();
    ilsa_status status = march_front(s, dt, pass >= ILSAI_HOLD_PASS);
    int answers = pass > 0;
    s->sensitivity_count = 0;
    if (status == ILSA_OK && pass == 0 && leaks_fast(s)) {
        survey(s, dt); /* for the derivatives */
        answers = 1;
    }
    if (status == ILSA_OK && answers && !is_nested(s) && pass < ILSAI_SENSITIVITY_PASSES) {
        ilsai_tip_cells_sensitivities(s, dt);
    }
    s->profile.front += ilsai_clock() - start;
    return status;
}

/*
 * Passes of the front loop until front and widths agree. In the first pass the predicted front is
 * held, as a rule, then the front moves with the widths.
 */
static ilsa_status iterate(ilsa_solver *s, double dt, coupled_counts *counts, ilsa_report *report,
                           double *change) {
    *change = 1;
    int most = is_nested(s) ? ILSAI_NESTED_PASSES_MAX : ILSAI_FRONT_PASSES_MAX;
    for (int pass = 0; pass < most; pass++) {
        report->front_iterations++;
        ilsa_status status = set_front(s, dt, pass);
        coupled_problem problem = pose(s, dt, *change);
        status = status ? status : ilsai_coupled_solve(s->coupled, &problem, counts);
        if (status != ILSA_OK) {
            return status;
        }
        double start = ilsai_clock();
        *change = survey(s, dt);
        s->profile.front += ilsai_clock() - start;
        if (isnan(*change)) {
            return ILSA_STEP_REJECTED;
        }
        int sharp = problem.tolerance <= s->tolerance; /* not the first guess of a front at rest */
        if (sharp && *change <= tolerance_now(s, pass)) {
            ilsai_coupled_pressure(s->coupled, &problem, counts);
            return ILSA_OK;
        }
        move_front(s, pass);
    }
    return ILSA_STEP_REJECTED;
}

static void scale_widths(ilsa_solver *s, double factor) {
    box part = ilsai_box_fold(&s->g, &s->trial_footprint);
    for (int j = part.y0; j <= part.y1; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&s->g, i, j);
            s->trial.width[cell] *= is_open_channel(s, cell) ? factor : 1;
            s->now.width_most = fmax(s->now.width_most, s->trial.width[cell]);
        }
    }
}

/*
 * The volume that the iteration's tolerance has left unaccounted for goes into the widths of the
 * open channel in proportion, so that injected = fracture + leaked holds to rounding at every step.
 * Where all is closed it has leaked.
 */
static ilsa_status balance_volume(ilsa_solver *s, double dt) {
    volumes v = sum_volumes(s);
    double injected = s->now.injected + ilsai_injection_rate(s) * dt,
           leaked = s->now.leaked + v.leaked;
    double fracture = v.open > 0 ? injected - leaked : v.held;
    double off = fabs(injected - leaked - v.held - v.open);
    if (!(off < ILSAI_BALANCE_MAX * (v.open > 0 ? v.open : v.held))) {
        return ILSA_STEP_REJECTED;
    }
    scale_widths(s, v.open > 0 ? (fracture - v.held) / v.open : 1);
    s->now.leak_rate = (injected - fracture - s->now.leaked) / dt;
    s->now.injected = injected;
    s->now.leaked = injected - fracture;
    s->now.fracture = fracture;
    return ILSA_OK;
}

void ilsai_step_classify(const grid *g, const box *part, unsigned char *kind) {
    for (int j = part->y0; j <= part->y1; j++) {
        for (int i = part->x0; i <= part->x1; i++) {
            int cell = ilsai_grid_cell(g, i, j), rim = 0;
            if (!is_channel(kind[cell])) {
                continue;
            }
            for (int face = 0; face < GRID_FACES; face++) {
                int other = ilsai_grid_neighbour(g, i, j, face);
                rim |= other < 0 || !is_channel(kind[other]);
            }
            kind[cell] = rim ? ILSA_CELL_SURVEY : ILSA_CELL_CHANNEL;
        }
    }
}

/* Trigger times of the cells whose centres the front has passed in the step. */
static void set_triggers(ilsa_solver *s, double dt) {
    int count;
    const front_cell *cells = ilsai_march_cells(s->march, &count);
    for (int k = 0; k < count; k++) {
        double *trigger = &s->field.trigger[cells[k].cell];
        if (cells[k].T <= 0 && !isfinite(*trigger)) {
            double since = cells[k].V > 0 ? -cells[k].T / cells[k].V : 0;
            *trigger = s->now.time + (since < dt ? dt - since : 0);
        }
    }
}

static void add_leaked(ilsa_solver *s) {
    box part = ilsai_box_fold(&s->g, &s->trial_footprint);
    for (int j = part.y0; j <= part.y1; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&s->g, i, j);
            s->field.leaked[cell] += leaked_from(s, cell);
        }
    }
}

/* How unevenly in time the front has passed the cells that it has filled in the step. */
static void set_spreads(ilsa_solver *s, double dt) {
    int count;
    const front_cell *cells = ilsai_march_cells(s->march, &count);
    for (int k = 0, r = 0; k < count && r < s->trial_tips.count; k++) {
        const front_cell *c = &cells[k];
        if (s->trial_tips.at[r].cell != c->cell) {
            continue;
        }
        const tip_record *record = &s->trial_tips.at[r++];
        if (s->trial.kind[c->cell] != ILSA_CELL_TIP) {
            tip_cell_front at = {c->ell, c->cos_a, c->sin_a, s->g.dx, s->g.dy};
            double over = c->ell - ilsai_march_full(&s->g, c->cos_a, c->sin_a);
            double since = c->V > 0 ? fmin(fmax(over, 0) / c->V, dt) : 0;
            double filled = s->now.time + dt - since;
            double spread = ilsai_tip_cell_spread(&at, filled - record->history.t[0]);
            double age = filled - s->field.trigger[c->cell];
            s->field.spread[c->cell] = fmax(fmin(spread, age), 0);
        }
    }
}

/* Gives the images of the first count records the same path. */
static void unfold_tips(const ilsa_solver *s, tip_records *tips) {
    int image[4], count = tips->count;
    for (int k = 0; k < count; k++) {
        int cell = tips->at[k].cell;
        int images = ilsai_grid_images(&s->g, cell % s->g.nx, cell / s->g.nx, image);
        for (int m = 1; m < images; m++) {
            tips->at[tips->count] = tips->at[k];
            tips->at[tips->count++].cell = image[m];
        }
    }
}

/* Keeps the paths of the cells that are still tip cells. */
static void keep_tips(ilsa_solver *s) {
    tip_records old = s->tips;
    int kept = 0;
    for (int k = 0; k < s->trial_tips.count; k++) {
        if (s->trial.kind[s->trial_tips.at[k].cell] == ILSA_CELL_TIP) {
            s->trial_tips.at[kept++] = s->trial_tips.at[k];
        }
    }
    s->trial_tips.count = kept;
    unfold_tips(s, &s->trial_tips);
    ilsai_asymptote_records_sort(&s->trial_tips);
    s->tips = s->trial_tips;
    s->trial_tips = old;
}

/* Writes the images of the representative cells of the region. */
static void unfold(ilsa_solver *s) {
    for (int j = s->region.y0; j <= s->region.y1; j++) {
        for (int i = s->region.x0; i <= s->region.x1; i++) {
            int cell = ilsai_grid_cell(&s->g, i, j), from = ilsai_grid_fold(&s->g, i, j);
            if (cell == from) {
                continue;
            }
            s->trial.width[cell] = s->trial.width[from];
            s->trial.pressure[cell] = s->trial.pressure[from];
            s->trial.level[cell] = s->trial.level[from];
            s->trial.speed[cell] = s->trial.speed[from];
            s->trial.kind[cell] = s->trial.kind[from];
            if (ilsai_has_leakoff(s)) {
                s->field.trigger[cell] = s->field.trigger[from];
                s->field.spread[cell] = s->field.spread[from];
                s->field.leaked[cell] = s->field.leaked[from];
            }
        }
    }
}

/* Cells that a pass has wetted and a later one has not keep no pressure. */
static void clear_dry(ilsa_solver *s, const box *part) {
    for (int j = part->y0; j <= part->y1; j++) {
        for (int i = part->x0; i <= part->x1; i++) {
            int cell = ilsai_grid_cell(&s->g, i, j);
            if (s->trial.kind[cell] == ILSA_CELL_EMPTY) {
                s->trial.pressure[cell] = 0;
            }
        }
    }
}

static void accept(ilsa_solver *s, double dt, double change) {
    box part = ilsai_box_fold(&s->g, &s->region);
    clear_dry(s, &part);
    for (int k = 0; k < s->survey_count; k++) {
        s->trial.speed[s->survey_cells[k].cell] = s->survey_cells[k].V;
    }
    ilsai_step_classify(&s->g, &part, s->trial.kind);
    if (ilsai_has_leakoff(s)) {
        set_triggers(s, dt);
        set_spreads(s, dt);
        add_leaked(s);
        keep_tips(s);
    }
    unfold(s);
    copy_fields(s, &s->region, &s->field, &s->trial);
    s->now.footprint = s->trial_footprint;
    s->now.mirror_x = s->now.mirror_x && s->g.mirror_x;
    s->now.mirror_y = s->now.mirror_y && s->g.mirror_y;
    s->now.unknowns = ilsai_coupled_unknowns(s->coupled);
    s->now.front_advance = advance(s);
    s->now.front_change = change;
    s->now.dt = dt;
    s->now.time += dt;
}

/* Nothing would move. */
static ilsa_status check_closed(ilsa_solver *s) {
    if (ilsai_injection_rate(s) > 0 || ilsai_open_cells(s) > 0) {
        return ILSA_OK;
    }
    return ilsai_fail(&s->error, ILSA_CLOSED,
                      "time %g: every cell is closed and nothing is injected", s->now.time);
}

ilsa_status ilsai_step(ilsa_solver *s, double dt, ilsa_report *report) {
    coupled_counts counts = {0};
    double change = 0;
    ilsa_status status = check_closed(s);
    status = status ? status : begin(s, dt);
    if (status == ILSA_OK) {
        predict(s, dt);
        status = iterate(s, dt, &counts, report, &change);
    }
    if (status == ILSA_OK && advance(s) >= ILSAI_ADVANCE_MAX) {
        status = ILSA_STEP_TOO_LARGE;
    }
    if (status == ILSA_OK) {
        status = balance_volume(s, dt);
    }
    if (status == ILSA_OK) {
        accept(s, dt, change);
    }
    report->newton_iterations += counts.newton;
    report->krylov_iterations += counts.krylov;
    report->elasticity_products += counts.products;
    s->profile.product += counts.seconds_product;
    s->profile.preconditioner += counts.seconds_preconditioner;
    return status;
}
