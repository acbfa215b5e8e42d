#include "base/clock.h"
#include "base/tuning.h"
#include "front/survey.h"
#include "step/step.h"
#include <math.h>

/* Front speed in cells per time, the fastest of the survey cells; 0 for a front at rest. */
static double front_rate(const ilsa_solver *s) {
    grid g = ilsai_grid(&s->mesh, 0, 0);
    const box *b = &s->now.footprint;
    double largest = 0;
    for (int j = b->y0; j <= b->y1; j++) {
        for (int i = b->x0; i <= b->x1; i++) {
            int cell = ilsai_grid_cell(&g, i, j);
            if (s->field.kind[cell] == ILSA_CELL_SURVEY) {
                largest = fmax(largest, s->field.speed[cell] / ilsai_survey_size(s, &g, i, j));
            }
        }
    }
    return largest;
}

/*
 * The time in which a fracture that empties loses a part of its volume, or one that opens again
 * gains as much as it has. Else volume is no measure: what is injected and what leaks may both be
 * many times of it.
 */
static double until_changed(const ilsa_solver *s) {
    double injected = ilsai_injection_rate(s), leaked = s->now.leak_rate;
    int empties = injected < ILSAI_EMPTIES * leaked;
    if (!empties && ilsai_closed_cells(s) == 0) {
        return INFINITY;
    }
    double rate = fabs(injected - leaked), part = empties ? ILSAI_DT_LOSS : 1;
    return rate > 0 ? part * s->now.fracture / rate : INFINITY;
}

static double suggestion(const ilsa_solver *s) {
    double rate = front_rate(s), resting = ILSAI_DT_RESTING * s->now.time;
    double dt = rate * resting > s->step_cells ? s->step_cells / rate : resting;
    dt = fmin(fmin(dt, until_changed(s)), s->now.dt_limit);
    return s->def.dt_max > 0 ? fmin(dt, s->def.dt_max) : dt;
}

ilsa_status ilsa_suggest_dt(const ilsa_solver *solver, double *dt) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "solver", solver);
    status = status ? status : ilsai_check_pointer(error, "dt", dt);
    status = status ? status : ilsai_check_started(solver, error);
    if (status == ILSA_OK) {
        *dt = suggestion(solver);
    }
    return status;
}

static void finish_report(ilsa_solver *s, ilsa_report *report, double start) {
    report->time = s->now.time;
    report->dt = s->now.dt;
    report->front_change = s->now.front_change;
    report->front_advance = s->now.front_advance;
    report->seconds = ilsai_clock() - start;
}

/* Adds the work of one report to another; time, dt and the like become the later one's. */
static void add_report(ilsa_report *sum, const ilsa_report *r) {
    ilsa_report total = *r;
    total.steps += sum->steps;
    total.rejected += sum->rejected;
    total.front_iterations += sum->front_iterations;
    total.newton_iterations += sum->newton_iterations;
    total.krylov_iterations += sum->krylov_iterations;
    total.elasticity_products += sum->elasticity_products;
    total.coarsened += sum->coarsened;
    total.seconds += sum->seconds;
    *sum = total;
}

static const char *reason(ilsa_status status) {
    return status == ILSA_STEP_REJECTED    ? "no solution was found"
           : status == ILSA_STEP_TOO_LARGE ? "the front would move more than the cells one step may"
           : status == ILSA_ERR_MEMORY     ? "no memory"
                                           : NULL;
}

/* Refused attempts since the clock was at nine tenths of what it is. */
static void count_refusals(ilsa_solver *s, ilsa_status status) {
    double now = s->now.time;
    if (now < s->crawl_time || now > ILSAI_CRAWL_TIME * s->crawl_time) {
        s->crawl_time = now;
        s->crawl_refused = 0;
    }
    s->crawl_refused += status != ILSA_OK;
}

/* One attempt, with its message and counters. */
static ilsa_status attempt(ilsa_solver *s, double dt, ilsa_report *report) {
    double start = ilsai_clock();
    *report = (ilsa_report){0};
    ilsa_status status = ilsai_step(s, dt, report);
    report->steps = status == ILSA_OK;
    report->rejected = status != ILSA_OK;
    s->now.dt_limit *= status == ILSA_OK ? ILSAI_DT_GROWTH : 1;
    count_refusals(s, status);
    if (reason(status)) {
        ilsai_fail(&s->error, status, "step of dt = %g at time %g: %s", dt, s->now.time,
                   reason(status));
    }
    finish_report(s, report, start);
    add_report(&s->total, report);
    s->profile.rest =
        s->total.seconds - s->profile.product - s->profile.preconditioner - s->profile.front;
    return status;
}

static ilsa_status check_solver(ilsa_solver *s) {
    return s ? ilsai_check_started(s, &s->error)
             : ilsai_check_pointer(ilsai_thread_error(), "solver", s);
}

ilsa_status ilsa_step(ilsa_solver *solver, double dt, ilsa_report *report) {
    ilsa_report own = {0}, *out = report ? report : &own;
    ilsa_status status = check_solver(solver);
    if (!solver) {
        return status;
    }
    status = status ? status : ilsai_check_positive(&solver->error, "dt", dt);
    if (status == ILSA_OK && !(solver->now.time + dt > solver->now.time)) {
        status =
            ilsai_fail(&solver->error, ILSA_ERR_VALUE,
                       "dt = %g: too small to move the clock on from %g", dt, solver->now.time);
    }
    if (status != ILSA_OK) {
        *out = (ilsa_report){.time = solver->now.time};
        return status;
    }
    return attempt(solver, dt, out);
}

static int try_again(ilsa_status status) {
    return status == ILSA_STEP_REJECTED || status == ILSA_STEP_TOO_LARGE;
}

/*
 * Steps shrink after a refusal and may grow again step by step. Giving up leaves the solver as it
 * was, so that another call tries in full again.
 */
static ilsa_status step_until_accepted(ilsa_solver *s, double t_limit, ilsa_report *report) {
    const double limit = s->now.dt_limit;
    for (;;) {
        double left = t_limit - s->now.time, dt = suggestion(s);
        dt = dt >= left ? left : dt > 0.5 * left ? 0.5 * left : dt;
        ilsa_report one;
        ilsa_status status = attempt(s, dt, &one);
        add_report(report, &one);
        if (status == ILSA_OK) {
            s->now.time = dt == left ? t_limit : s->now.time;
            report->time = s->now.time;
            return ILSA_OK;
        }
        s->now.dt_limit = ILSAI_DT_CUT * dt;
        int stalled = s->now.dt_limit < ILSAI_DT_SMALLEST * s->now.time ||
                      s->crawl_refused >= ILSAI_CRAWL_REFUSED;
        if (!try_again(status) || stalled) {
            s->now.dt_limit = limit;
            s->crawl_refused = 0;
            return try_again(status) ? ILSA_STALLED : status;
        }
    }
}

static ilsa_status advance_one(ilsa_solver *s, double t_limit, ilsa_report *report) {
    ilsa_status status = step_until_accepted(s, t_limit, report);
    if (status == ILSA_MESH_EDGE && s->def.coarsen) {
        status = ilsa_coarsen(s);
        report->coarsened += status == ILSA_OK;
        s->total.coarsened += status == ILSA_OK;
        status = status ? status : step_until_accepted(s, t_limit, report);
    }
    return status;
}

static ilsa_status check_limit(ilsa_solver *s, const char *name, double t) {
    ilsa_status status = check_solver(s);
    if (status == ILSA_OK && !(t > s->now.time && isfinite(t))) {
        status = ilsai_fail(&s->error, ILSA_ERR_VALUE,
                            "%s = %g: must be finite and later than the time now, %g", name, t,
                            s->now.time);
    }
    return status;
}

ilsa_status ilsa_wait(ilsa_solver *solver, double t) {
    ilsa_status status = check_limit(solver, "t", t);
    if (status != ILSA_OK) {
        return status;
    }
    int open = ilsai_open_cells(solver);
    if (open > 0 || ilsai_injection_rate(solver) > 0) {
        return ilsai_fail(&solver->error, ILSA_ERR_STATE,
                          "%d cells are open and %g is injected: only a step moves the clock", open,
                          ilsai_injection_rate(solver));
    }
    solver->now.time = t;
    return ILSA_OK;
}

ilsa_status ilsa_advance_one(ilsa_solver *solver, double t_limit, ilsa_report *report) {
    ilsa_report own = {0}, *out = report ? report : &own;
    ilsa_status status = check_limit(solver, "t_limit", t_limit);
    if (solver) {
        *out = (ilsa_report){.time = solver->now.time};
    }
    return status ? status : advance_one(solver, t_limit, out);
}

ilsa_status ilsa_advance(ilsa_solver *solver, double t_end, ilsa_report *report) {
    ilsa_report own = {0}, *out = report ? report : &own;
    ilsa_status status = check_limit(solver, "t_end", t_end);
    if (solver) {
        *out = (ilsa_report){.time = solver->now.time};
    }
    while (status == ILSA_OK && solver->now.time < t_end) {
        status = advance_one(solver, t_end, out);
    }
    return status;
}
