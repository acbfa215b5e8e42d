#include "step/step.h"

#include "base/clock.h"
#include "front/tip_cells.h"
#include "front/geometry.h"
#include "front/survey.h"
#include "base/tuning.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int is_channel(unsigned char kind) {
    return kind >= ILSA_CELL_SURVEY;
}

static ilsa_status reserve_seeds(ilsa_solver *s, int count) {
    if (count <= s->seed_capacity) {
        return ILSA_OK;
    }
    size_t capacity = (size_t)count + (size_t)count / 2 + 16;
    front_seed *seeds = realloc(s->seeds, capacity * sizeof *seeds);
    s->seeds = seeds ? seeds : s->seeds;
    double *distance = realloc(s->distance, capacity * sizeof *distance);
    s->distance = distance ? distance : s->distance;
    double *next = realloc(s->next_distance, capacity * sizeof *next);
    s->next_distance = next ? next : s->next_distance;
    if (!seeds || !distance || !next) {
        return ILSA_ERR_MEMORY;
    }
    s->seed_capacity = (int)capacity;
    return ILSA_OK;
}

/* The survey cells as the last step left them. */
static ilsa_status find_seeds(ilsa_solver *s) {
    box part = ilsai_box_fold(&s->g, &s->now.footprint);
    s->seed_count = 0;
    for (int j = part.y0; j <= part.y1; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&s->g, i, j);
            if (s->field.kind[cell] != ILSA_CELL_SURVEY) {
                continue;
            }
            if (reserve_seeds(s, s->seed_count + 1) != ILSA_OK) {
                return ILSA_ERR_MEMORY;
            }
            front_seed seed = {.cell = cell, .s0 = -s->field.level[cell]};
            seed.h = ilsai_survey_size(s, &s->g, i, j);
            seed.V = s->field.speed[cell];
            seed.w = s->field.width[cell];
            s->seeds[s->seed_count++] = seed;
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
typedef struct seed_loop {
    ilsa_solver *s;
    double dt;
} seed_loop;

static void share_seeds(team_function *function, ilsa_solver *s, double dt) {
    seed_loop l = {s, dt};
    ilsai_team_run(s->threads, function, &l, s->seed_count, ILSAI_SHARE_FRONT);
}

static void set_shapes(void *context, int first, int end) {
    ilsa_solver *s = ((const seed_loop *)context)->s;
    ilsai_shape_set(s, s->seeds + first, end - first);
}

static ilsa_status begin(ilsa_solver *s, double dt) {
    s->g = ilsai_solver_grid(s);
    s->region = ilsai_solver_region(s, &s->now.footprint);
    copy_fields(s, &s->region, &s->trial, &s->field);
    s->trial_tips.count = 0;
    if (find_seeds(s) != ILSA_OK || ilsai_anderson_begin(s->mixer, s->seed_count) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    share_seeds(set_shapes, s, dt);
    return ilsai_rim_begin(s, dt);
}

/* Distances within what the step allows: never back, no further than a step may go. */
static double bounded(const front_seed *seed, double distance) {
    double limit = seed->s0 + ILSAI_ADVANCE_MAX * seed->h;
    distance = distance > seed->s0 ? distance : seed->s0;
    return distance < limit ? distance : limit;
}

static int is_nested(const ilsa_solver *s) {
    return s->def.loop == ILSA_LOOP_NESTED;
}

static int is_open(const ilsa_solver *s, const front_seed *seed) {
    return s->contact[seed->cell] == CONTACT_OPEN;
}

/*
 * How far a front may be predicted to go: the width that steps of the stress add on the way is
 * fluid that a barrier would take out of the cells behind it, until nothing were left of them.
 */
static double before_barrier(const front_seed *seed, double distance) {
    double low = seed->s0, high = distance;
    front_seed at = *seed;
    at.s = low;
    double most = ilsai_survey_jump_width(&at, low) + ILSAI_JUMP_PREDICTED * seed->w;
    for (int k = 0; k < ILSAI_JUMP_BISECTIONS; k++) {
        at.s = k > 0 ? 0.5 * (low + high) : high;
        *(ilsai_survey_jump_width(&at, at.s) > most ? &high : &low) = at.s;
    }
    return low;
}

/* The front moves on as it did in the last step. */
static void predict(ilsa_solver *s, double dt) {
    for (int k = 0; k < s->seed_count; k++) {
        front_seed *seed = &s->seeds[k];
        double advance = is_nested(s) || !is_open(s, seed) ? 0 : seed->V * dt;
        double distance = bounded(seed, seed->s0 + advance);
        s->distance[k] = seed->jumps > 0 ? before_barrier(seed, distance) : distance;
    }
}

static void place_seeds(void *context, int first, int end) {
    ilsa_solver *s = ((const seed_loop *)context)->s;
    double dt = ((const seed_loop *)context)->dt;
    for (int k = first; k < end; k++) {
        front_seed *seed = &s->seeds[k];
        seed->s = s->distance[k];
        seed->V = (seed->s - seed->s0) / dt;
        ilsai_survey_settle(s, seed);
        seed->w = seed->V > 0 ? seed->asymptote : ilsai_survey_width(s, seed);
    }
}

/* Survey, tip and channel cells for the front where it is now. */
static ilsa_status march(ilsa_solver *s, double dt, int hold) {
    share_seeds(place_seeds, s, dt);
    ilsa_status status = ilsai_front_march(s->march, &s->g, &s->region, s->field.kind, s->seeds,
                                           s->seed_count, ilsai_solver_band(s), s->trial.level);
    return status == ILSA_OK ? ilsai_rim_set(s, dt, hold) : status;
}

/* Advance of the front in cells; a front at its bound has been held back by it. */
static double advance(const ilsa_solver *s) {
    double largest = 0;
    for (int k = 0; k < s->seed_count; k++) {
        double cells = (s->seeds[k].s - s->seeds[k].s0) / s->seeds[k].h;
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
    coupled_problem problem = {.g = &s->g,
                               .e = s->elastic,
                               .footprint = s->trial_footprint,
                               .kind = s->trial.kind,
                               .sigma = s->sigma,
                               .width_old = s->field.width,
                               .gain = s->gain,
                               .edge = s->edge,
                               .width = s->trial.width,
                               .pressure = s->trial.pressure,
                               .dt = dt,
                               .mu_prime = s->material.mu_prime,
                               .linear = s->def.linear,
                               .contact = {ilsai_closure_width(s), s->contact, s->leak, s->relief},
                               .response = s->responses,
                               .response_count = s->response_count,
                               .threads = s->threads};
    double share = fmin(ILSAI_PASS_SHARE, ILSAI_PASS_SHARP * s->tolerance);
    double aim = is_nested(s) ? s->tolerance : fmax(share * change, tolerance_now(s, 0));
    problem.tolerance = ILSAI_WIDTH_TOLERANCE * fmin(aim, 0.1);
    return problem;
}

static void survey_seeds(void *context, int first, int end) {
    ilsa_solver *s = ((const seed_loop *)context)->s;
    double dt = ((const seed_loop *)context)->dt;
    for (int k = first; k < end; k++) {
        front_seed *seed = &s->seeds[k];
        if (is_open(s, seed)) {
            s->next_distance[k] = bounded(seed, ilsai_survey_distance(s, seed, dt));
        } else {
            s->next_distance[k] = seed->s0;
            seed->ds_dw = seed->ds_inner = 0;
        }
    }
}

/* Where the widths want the front, which rests before closed cells; returns the largest difference
 * to where it is, in cells. */
static double survey(ilsa_solver *s, double dt) {
    double largest = 0;
    share_seeds(survey_seeds, s, dt);
    for (int k = 0; k < s->seed_count; k++) {
        double change = fabs(s->next_distance[k] - s->distance[k]) / s->seeds[k].h;
        largest = change > largest || isnan(change) ? change : largest;
    }
    return largest;
}

/*
 * The next distances. While the cells at the front answer within the Newton system the widths have
 * already foreseen the front's move; afterwards the iteration is a fixed point to be accelerated.
 */
static void move_front(ilsa_solver *s, int pass) {
    if (is_nested(s) || pass + 1 < ILSAI_RESPONSE_PASSES) {
        memcpy(s->distance, s->next_distance, (size_t)s->seed_count * sizeof *s->distance);
        return;
    }
    ilsai_anderson_next(s->mixer, s->next_distance, s->distance);
    for (int k = 0; k < s->seed_count; k++) {
        s->distance[k] = bounded(&s->seeds[k], s->distance[k]);
    }
}

/* Per area in the step: nothing comes back, whatever a late solve has let go, see contact.h. */
static double leaked_from(const ilsa_solver *s, int cell) {
    double relief = s->relief ? s->relief[cell] : 0;
    return s->leak[cell] - fmax(fmin(relief, s->leak[cell]), 0);
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
    ilsa_status status = march(s, dt, pass >= ILSAI_HOLD_PASS);
    int answers = pass > 0;
    s->response_count = 0;
    if (status == ILSA_OK && pass == 0 && leaks_fast(s)) {
        survey(s, dt); /* for the derivatives */
        answers = 1;
    }
    if (status == ILSA_OK && answers && !is_nested(s) && pass < ILSAI_RESPONSE_PASSES) {
        ilsai_rim_respond(s, dt);
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
        status = status ? status : ilsai_coupled_solve(s->flow, &problem, counts);
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
            ilsai_coupled_pressure(s->flow, &problem, counts);
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
    const front_cell *cells = ilsai_front_cells(s->march, &count);
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
    const front_cell *cells = ilsai_front_cells(s->march, &count);
    for (int k = 0, r = 0; k < count && r < s->trial_tips.count; k++) {
        const front_cell *c = &cells[k];
        if (s->trial_tips.at[r].cell != c->cell) {
            continue;
        }
        const tip_record *record = &s->trial_tips.at[r++];
        if (s->trial.kind[c->cell] != ILSA_CELL_TIP) {
            tipcell_front at = {c->ell, c->cos_a, c->sin_a, s->g.dx, s->g.dy};
            double over = c->ell - ilsai_front_full(&s->g, c->cos_a, c->sin_a);
            double since = c->V > 0 ? fmin(fmax(over, 0) / c->V, dt) : 0;
            double filled = s->now.time + dt - since;
            double spread = ilsai_tipcell_spread(&at, filled - record->history.t[0]);
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
    ilsai_tip_records_sort(&s->trial_tips);
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
    for (int k = 0; k < s->seed_count; k++) {
        s->trial.speed[s->seeds[k].cell] = s->seeds[k].V;
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
    s->now.unknowns = ilsai_coupled_unknowns(s->flow);
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
