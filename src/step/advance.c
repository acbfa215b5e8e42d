#include "base/clock.h"
#include "base/tuning.h"
#include "front/geometry.h"
#include "step/accept.h"
#include "step/edge.h"
#include "step/step.h"
#include <math.h>

/* Front speed in cells per time, the fastest of the survey cells; 0 for a front at rest. */
static double front_rate(const ilsa_solver *s) {
    grid g = ilsai_grid(&s->model.mesh, 0, 0);
    const box *b = &s->fracture.footprint;
    double largest = 0;
    for (int j = b->y0; j <= b->y1; j++) {
        for (int i = b->x0; i <= b->x1; i++) {
            int cell = ilsai_grid_cell(&g, i, j);
            if (s->fracture.cells.kind[cell] == ILSA_CELL_SURVEY) {
                largest = fmax(largest, s->fracture.cells.speed[cell] /
                                            ilsai_geometry_size(&g, s->fracture.cells.kind, i, j));
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
    double injected = ilsai_sources_rate(&s->model.sources), leaked = s->fracture.leak_rate;
    bool empties = injected < ILSAI_EMPTIES * leaked;
    if (!empties && ilsai_fracture_closed_cells(&s->fracture, &s->model) == 0) {
        return INFINITY;
    }
    double rate = fabs(injected - leaked), part = empties ? ILSAI_DT_LOSS : 1;
    return rate > 0 ? part * s->fracture.volume / rate : INFINITY;
}

static double suggestion(const ilsa_solver *s) {
    double rate = front_rate(s), resting = ILSAI_DT_RESTING * s->fracture.time;
    double dt = rate * resting > s->numerics.step_cells ? s->numerics.step_cells / rate : resting;
    dt = fmin(fmin(dt, until_changed(s)), s->pace.dt_limit);
    return s->model.options.dt_max > 0 ? fmin(dt, s->model.options.dt_max) : dt;
}

ilsa_status ilsa_suggest_dt(const ilsa_solver *solver, double *dt) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "solver", solver);
    status = status ? status : ilsai_check_pointer(error, "dt", dt);
    ILSAI_TRY(ilsai_fail_reading(status ? status : ilsai_fracture_check(&solver->fracture, error)));
    *dt = suggestion(solver);
    return ILSA_OK;
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
    total.coarsened_x += sum->coarsened_x;
    total.coarsened_y += sum->coarsened_y;
    total.grown += sum->grown;
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
    double now = s->fracture.time;
    if (now < s->pace.since || now > ILSAI_CRAWL_TIME * s->pace.since) {
        s->pace.since = now;
        s->pace.refused = 0;
    }
    s->pace.refused += status != ILSA_OK;
}

/* Adds the work of an attempt to its report, and to the totals of the solver. */
static void count_work(ilsa_solver *s, ilsa_report *report, double seconds) {
    const trial_work *work = &s->trial.work;
    report->time = s->fracture.time;
    report->dt = s->fracture.dt;
    report->front_change = s->fracture.front_change;
    report->front_advance = s->fracture.front_advance;
    report->front_iterations = work->passes;
    report->newton_iterations = work->coupled.newton;
    report->krylov_iterations = work->coupled.krylov;
    report->elasticity_products = work->coupled.products;
    report->seconds = seconds;
    add_report(&s->total, report);
    s->profile.product += work->coupled.seconds_product;
    s->profile.preconditioner += work->coupled.seconds_preconditioner;
    s->profile.front += work->seconds_front;
    s->profile.rest =
        s->total.seconds - s->profile.product - s->profile.preconditioner - s->profile.front;
}

/* One attempt at a step to time_after, with its message and counters. */
static ilsa_status attempt(ilsa_solver *s, double dt, double time_after, ilsa_report *report) {
    double start = ilsai_clock();
    ilsa_status status = ilsai_step(s, dt, time_after);
    bool refused = status != ILSA_OK && status != ILSA_CLOSED;
    *report = (ilsa_report){.steps = status == ILSA_OK, .rejected = refused};
    s->pace.dt_limit *= status == ILSA_OK ? ILSAI_DT_GROWTH : 1;
    count_refusals(s, status);
    if (reason(status)) {
        ilsai_fail(&s->error, status, "step of dt = %g at time %g: %s", dt, s->fracture.time,
                   reason(status));
    }
    count_work(s, report, ilsai_clock() - start);
    return status;
}

static ilsa_status check_solver(ilsa_solver *s) {
    return s ? ilsai_fracture_check(&s->fracture, &s->error)
             : ilsai_check_pointer(ilsai_thread_error(), "solver", s);
}

ilsa_status ilsa_step(ilsa_solver *solver, double dt, ilsa_report *report) {
    ilsa_report own = {0}, *out = report ? report : &own;
    ilsa_status status = check_solver(solver);
    if (!solver) {
        return status;
    }
    status = status ? status : ilsai_check_positive(&solver->error, "dt", dt);
    if (status == ILSA_OK && !(solver->fracture.time + dt > solver->fracture.time)) {
        status = ilsai_fail(&solver->error, ILSA_ERR_VALUE,
                            "dt = %g: too small to move the clock on from %g", dt,
                            solver->fracture.time);
    }
    if (status != ILSA_OK) {
        *out = (ilsa_report){.time = solver->fracture.time};
        return status;
    }
    return attempt(solver, dt, solver->fracture.time + dt, out);
}

static bool try_again(ilsa_status status) {
    return status == ILSA_STEP_REJECTED || status == ILSA_STEP_TOO_LARGE;
}

/*
 * Steps shrink after a refusal and may grow again step by step. Giving up leaves the solver as it
 * was, so that another call tries in full again.
 */
static ilsa_status step_until_accepted(ilsa_solver *s, double t_limit, ilsa_report *report) {
    const double limit = s->pace.dt_limit;
    for (;;) {
        double left = t_limit - s->fracture.time, dt = suggestion(s);
        dt = dt >= left ? left : dt > 0.5 * left ? 0.5 * left : dt;
        ilsa_report one;
        double time_after = dt == left ? t_limit : s->fracture.time + dt;
        ilsa_status status = attempt(s, dt, time_after, &one);
        add_report(report, &one);
        if (status == ILSA_OK) {
            return ILSA_OK;
        }
        s->pace.dt_limit = ILSAI_DT_CUT * dt;
        bool stalled = s->pace.dt_limit < ILSAI_DT_SMALLEST * s->fracture.time ||
                       s->pace.refused >= ILSAI_CRAWL_REFUSED;
        if (!try_again(status) || stalled) {
            s->pace.dt_limit = limit;
            s->pace.refused = 0;
            return try_again(status) ? ILSA_STALLED : status;
        }
    }
}

static ilsa_status advance_one(ilsa_solver *s, double t_limit, ilsa_report *report) {
    ilsa_status status = step_until_accepted(s, t_limit, report);
    while (status == ILSA_MESH_EDGE) {
        ILSAI_TRY(ilsai_edge_pass(s, report));
        status = step_until_accepted(s, t_limit, report);
    }
    return status;
}

static ilsa_status check_limit(ilsa_solver *s, const char *name, double t) {
    ilsa_status status = check_solver(s);
    if (status == ILSA_OK && !(t > s->fracture.time && isfinite(t))) {
        status = ilsai_fail(&s->error, ILSA_ERR_VALUE,
                            "%s = %g: must be finite and later than the time now, %g", name, t,
                            s->fracture.time);
    }
    return status;
}

ilsa_status ilsa_wait(ilsa_solver *solver, double t) {
    ilsa_status status = check_limit(solver, "t", t);
    if (status != ILSA_OK) {
        return status;
    }
    int open = ilsai_fracture_open_cells(&solver->fracture, &solver->model);
    if (open > 0 || ilsai_sources_rate(&solver->model.sources) > 0) {
        return ilsai_fail(&solver->error, ILSA_ERR_STATE,
                          "%d cells are open and %g is injected: only a step moves the clock", open,
                          ilsai_sources_rate(&solver->model.sources));
    }
    ilsai_accept_wait(&solver->fracture, t);
    return ILSA_OK;
}

ilsa_status ilsa_advance_one(ilsa_solver *solver, double t_limit, ilsa_report *report) {
    ilsa_report own = {0}, *out = report ? report : &own;
    ilsa_status status = check_limit(solver, "t_limit", t_limit);
    if (solver) {
        *out = (ilsa_report){.time = solver->fracture.time};
    }
    return status ? status : advance_one(solver, t_limit, out);
}

ilsa_status ilsa_advance(ilsa_solver *solver, double t_end, ilsa_report *report) {
    ilsa_report own = {0}, *out = report ? report : &own;
    ilsa_status status = check_limit(solver, "t_end", t_end);
    if (solver) {
        *out = (ilsa_report){.time = solver->fracture.time};
    }
    while (status == ILSA_OK && solver->fracture.time < t_end) {
        status = advance_one(solver, t_end, out);
    }
    return status;
}
