#include "step/step.h"

#include "base/clock.h"
#include "base/tuning.h"
#include "flow/contact.h"
#include "flow/newtonian.h"
#include "step/accept.h"
#include <math.h>
#include <string.h>

static bool is_nested(const ilsa_solver *s) {
    return s->model.options.loop == ILSA_LOOP_NESTED;
}

/* A distance within what the step allows: never back, no further than a step may go. */
static double bounded(const survey_cell *survey, double distance) {
    double limit = survey->s0 + ILSAI_ADVANCE_MAX * survey->h;
    distance = distance > survey->s0 ? distance : survey->s0;
    return distance < limit ? distance : limit;
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

/* The front moves on as it did in the last step; before closed cells it rests. */
static void predict_front(ilsa_solver *s) {
    trial *t = &s->trial;
    for (int k = 0; k < t->survey_count; k++) {
        const survey_cell *survey = &t->survey_cells[k];
        double advance = is_nested(s) || !ilsai_trial_is_open(t, k) ? 0 : survey->V * t->dt;
        double distance = bounded(survey, survey->s0 + advance);
        t->distance[k] = survey->step_count > 0 ? before_barrier(survey, distance) : distance;
    }
}

/* A loop over the survey cells of the trial. */
typedef struct survey_loop {
    trial *t;
    survey_widths widths;
} survey_loop;

static void share_survey(pool_function *function, ilsa_solver *s) {
    survey_loop l = {&s->trial, ilsai_trial_widths(&s->trial, &s->model, &s->numerics)};
    ilsai_thread_pool_run(s->numerics.threads, function, &l, s->trial.survey_count,
                          ILSAI_SHARE_FRONT);
}

static void place_survey(void *context, int first, int end) {
    const survey_loop *l = context;
    for (int k = first; k < end; k++) {
        survey_cell *survey = &l->t->survey_cells[k];
        survey->s = l->t->distance[k];
        survey->V = (survey->s - survey->s0) / l->t->dt;
        ilsai_survey_settle(&l->widths, survey);
        survey->w = survey->V > 0 ? survey->w_asymptote : ilsai_survey_width(&l->widths, survey);
    }
}

static void find_distances(void *context, int first, int end) {
    const survey_loop *l = context;
    for (int k = first; k < end; k++) {
        survey_cell *survey = &l->t->survey_cells[k];
        if (ilsai_trial_is_open(l->t, k)) {
            double distance = ilsai_survey_distance(&l->widths, survey, l->t->dt);
            l->t->next_distance[k] = bounded(survey, distance);
        } else {
            l->t->next_distance[k] = survey->s0;
            survey->ds_dw = survey->ds_inner = 0;
        }
    }
}

/* Inverts the widths of the survey cells, (4.9); returns the largest change of a distance that they
 * ask for, in cells, NaN if one is. */
static double invert_survey(ilsa_solver *s) {
    const trial *t = &s->trial;
    double largest = 0;
    share_survey(find_distances, s);
    for (int k = 0; k < t->survey_count; k++) {
        double change = fabs(t->next_distance[k] - t->distance[k]) / t->survey_cells[k].h;
        largest = change > largest || isnan(change) ? change : largest;
    }
    return largest;
}

/* Distances of the cells outside the channel, for the front as the survey cells have it now. */
static ilsa_status march_front(ilsa_solver *s) {
    trial *t = &s->trial;
    share_survey(place_survey, s);
    return ilsai_march_run(s->numerics.march, &t->g, &t->region, s->fracture.cells.kind,
                           t->survey_cells, t->survey_count, ilsai_fracture_band(&s->model.mesh),
                           t->cells.level);
}

/*
 * Whether the front moves with the widths in Newton's iteration of this pass. The first pass holds
 * the predicted front; but where so much leaks in the step that a front misplaced by little takes
 * more fluid than the fracture has, it cannot be held while the widths settle. Late passes hold the
 * front too: a step that has not converged by then goes to and fro.
 */
static bool moves_with_widths(ilsa_solver *s, int pass) {
    if (pass == 0 && ilsai_model_leaks(&s->model) &&
        ilsai_trial_volumes(&s->trial).leaked > ILSAI_LEAK_FAST * s->fracture.volume) {
        invert_survey(s); /* for the derivatives */
        return !is_nested(s);
    }
    return pass > 0 && pass < ILSAI_SENSITIVITY_PASSES && !is_nested(s);
}

/*
 * Tolerance of the front in cells. It shrinks with a step that moves the front less than the usual,
 * so that the velocity is found as well, but for one that is as good as none.
 */
static double tolerance_now(const ilsa_solver *s, int pass) {
    const numerics *n = &s->numerics;
    double usual = pass < ILSAI_SETTLE_PASS ? n->tolerance : fmax(n->tolerance, ILSAI_SETTLE);
    double part = fmin(1, ilsai_trial_advance(&s->trial) / n->step_cells);
    part = part > 0 ? fmax(part, ILSAI_TOLERANCE_PART) : 1;
    return fmax(usual * part, ILSAI_TOLERANCE_LEAST);
}

static coupled_problem pose(ilsa_solver *s) {
    trial *t = &s->trial;
    const numerics *n = &s->numerics;
    double share = fmin(ILSAI_PASS_SHARE, ILSAI_PASS_SHARP * n->tolerance);
    double aim = is_nested(s) ? n->tolerance : fmax(share * t->change, tolerance_now(s, 0));
    return (coupled_problem){
        .g = &t->g,
        .elastic = n->elastic,
        .fluid = &ilsai_newtonian,
        .material = &s->model.material,
        .footprint = t->tips.footprint,
        .kind = t->cells.kind,
        .sigma = s->model.sigma,
        .width_old = s->fracture.cells.width,
        .source_term = t->cells.source_term,
        .self_correction = t->cells.self_correction,
        .width = t->cells.width,
        .pressure = t->cells.pressure,
        .dt = t->dt,
        .linear = s->model.options.linear,
        .contact = {t->closure_width, t->cells.contact, t->cells.leakoff, t->cells.retained},
        .tip_pressures = t->tip_pressures,
        .sensitivity = t->tips.sensitivities,
        .sensitivity_count = t->tips.sensitivity_count,
        .threads = n->threads,
        .tolerance = ILSAI_WIDTH_TOLERANCE * fmin(aim, 0.1)};
}

/*
 * The distances of the next pass. While the front moves with the widths they have already foreseen
 * its move; afterwards the iteration is a fixed point to be accelerated.
 */
static void move_front(ilsa_solver *s, int pass) {
    trial *t = &s->trial;
    if (is_nested(s) || pass + 1 < ILSAI_SENSITIVITY_PASSES) {
        memcpy(t->distance, t->next_distance, (size_t)t->survey_count * sizeof *t->distance);
        return;
    }
    ilsai_anderson_next(s->numerics.acceleration, t->next_distance, t->distance);
    for (int k = 0; k < t->survey_count; k++) {
        t->distance[k] = bounded(&t->survey_cells[k], t->distance[k]);
    }
}

/* Nothing would move. */
static ilsa_status check_closed(ilsa_solver *s) {
    if (ilsai_sources_rate(&s->model.sources) > 0 ||
        ilsai_fracture_open_cells(&s->fracture, &s->model) > 0) {
        return ILSA_OK;
    }
    return ilsai_fail(&s->error, ILSA_CLOSED,
                      "time %g: every cell is closed and nothing is injected", s->fracture.time);
}

ilsa_status ilsai_step(ilsa_solver *s, double dt, double time_after) {
    const model *m = &s->model;
    fracture *f = &s->fracture;
    trial *t = &s->trial;
    numerics *n = &s->numerics;
    coupled_problem problem;
    bool agreed = false;

    /* ---- Begin: survey cells and source terms from the fracture, the front predicted ---- */
    t->work = (trial_work){0};
    t->change = 1;
    ILSAI_TRY(check_closed(s));
    ILSAI_TRY(ilsai_trial_begin(t, m, f, n, dt, &s->error));
    predict_front(s);

    const int most = is_nested(s) ? ILSAI_NESTED_PASSES_MAX : ILSAI_FRONT_PASSES_MAX;
    for (int pass = 0; pass < most && !agreed; pass++) {
        t->work.passes++;

        /* ---- Front: march (4.10) to (4.12), then tip cells (4.18), (4.25) ---- */
        double start = ilsai_clock();
        ILSAI_TRY(march_front(s));
        front_pass front = ilsai_trial_pass(t, m, f, n);
        ILSAI_TRY(ilsai_tip_cells_update(&t->tips, &front, pass >= ILSAI_HOLD_PASS, &s->error));
        if (moves_with_widths(s, pass)) {
            ilsai_tip_cells_sensitivities(&t->tips, &front);
        }
        t->work.seconds_front += ilsai_clock() - start;

        /* ---- Widths and pressures: elasticity and lubrication (4.4) to (4.8) ---- */
        problem = pose(s);
        ILSAI_TRY(ilsai_coupled_solve(n->coupled, &problem, &t->work.coupled));

        /* ---- Survey cells: where the widths want the front (4.9) ---- */
        start = ilsai_clock();
        t->change = invert_survey(s);
        t->work.seconds_front += ilsai_clock() - start;
        if (isnan(t->change)) {
            return ILSA_STEP_REJECTED;
        }
        bool sharp = problem.tolerance <= n->tolerance && /* not a first guess of a front at rest */
                     ilsai_coupled_is_settled(n->coupled);
        agreed = sharp && t->change <= tolerance_now(s, pass);
        if (!agreed) {
            move_front(s, pass);
        }
    }
    if (!agreed) {
        return ILSA_STEP_REJECTED;
    }
    ilsai_coupled_pressure(n->coupled, &problem, &t->work.coupled);

    /* ---- End: bounds, volumes, acceptance ---- */
    if (ilsai_trial_advance(t) >= ILSAI_ADVANCE_MAX) {
        return ILSA_STEP_TOO_LARGE;
    }
    ILSAI_TRY(ilsai_trial_balance(t, m, f));
    ilsai_accept(f, t, m, n, time_after);
    return ILSA_OK;
}
