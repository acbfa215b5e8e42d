#include "solve/coupled.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/tuning.h"
#include "solve/gmres.h"
#include "solve/jacobian.h"
#include <math.h>
#include <stdbool.h>

/* The numbers that a Newton step changes in a cell, and what its unknown is. */
enum {
    KEPT_WIDTH,
    KEPT_PRESSURE,
    KEPT_SOURCE,
    KEPT_LIFT,
    KEPT_GIVEN,
    KEPT_FILL,
    KEPT_UNKNOWN,
    KEPT
};

struct coupled {
    unknowns cells;
    lubrication lubrication;
    jacobian matrix;
    gmres *krylov;
    double *rhs, *step;
    /* Per numbered cell, changes in this solve by the sensitivities: of the source term, and of the
     * pressure at a given width. */
    double *source_change, *pressure_change;
    double *given_width; /* of a channel cell: the least width; of a tip cell: the asymptote's */
    double *openness, *openness_slope; /* see flow/contact.h */
    double *kept;    /* KEPT per numbered cell: what it was before the last Newton step */
    size_t capacity; /* numbered cells that the arrays over them have room for */
    int closed;      /* channel cells that are closed or drain */
    int bounded;     /* tip cells whose pressure is at a bound */
    int unreached;   /* tip cells that no fluid reaches */
    bool settled;    /* whether the last solve has ended with sensitivities that hold */
    double residual; /* of the last linear solve, relative */
};

coupled *ilsai_coupled_create(const ilsa_mesh_def *mesh) {
    coupled *c = ilsai_allocate_zeroed(1, sizeof *c);
    if (!c) {
        return NULL;
    }
    size_t mesh_cells = (size_t)mesh->nx * (size_t)mesh->ny;
    c->krylov = ilsai_gmres_create(ILSAI_GMRES_RESTART);
    c->matrix.width = ilsai_allocate_zeroed(mesh_cells, sizeof(double));
    c->matrix.pressure = ilsai_allocate_zeroed(mesh_cells, sizeof(double));
    if (ilsai_unknowns_create(&c->cells, mesh) != ILSA_OK || !c->krylov || !c->matrix.width ||
        !c->matrix.pressure) {
        ilsai_coupled_destroy(&c);
    }
    return c;
}

void ilsai_coupled_destroy(coupled **c) {
    if (*c) {
        ilsai_unknowns_destroy(&(*c)->cells);
        ilsai_lubrication_destroy(&(*c)->lubrication);
        ilsai_jacobian_destroy(&(*c)->matrix);
        ilsai_gmres_destroy(&(*c)->krylov);
        ilsai_release((*c)->rhs);
        ilsai_release((*c)->step);
        ilsai_release((*c)->source_change);
        ilsai_release((*c)->pressure_change);
        ilsai_release((*c)->given_width);
        ilsai_release((*c)->openness);
        ilsai_release((*c)->openness_slope);
        ilsai_release((*c)->kept);
        ilsai_release(*c);
        *c = NULL;
    }
}

bool ilsai_coupled_is_settled(const coupled *c) {
    return c->settled;
}

int ilsai_coupled_unknowns(const coupled *c) {
    return c->cells.count;
}

static ilsa_status reserve(coupled *c, int count) {
    const grown_array arrays[] = {ILSAI_GROWN(c->rhs),
                                  ILSAI_GROWN(c->step),
                                  ILSAI_GROWN(c->source_change),
                                  ILSAI_GROWN(c->pressure_change),
                                  ILSAI_GROWN(c->given_width),
                                  ILSAI_GROWN(c->openness),
                                  ILSAI_GROWN(c->openness_slope),
                                  {&c->kept, KEPT * sizeof *c->kept},
                                  ILSAI_GROWN(c->matrix.fill),
                                  ILSAI_GROWN(c->matrix.leakoff_by_fill),
                                  ILSAI_GROWN(c->matrix.self_correction),
                                  ILSAI_GROWN(c->matrix.sensitivity_of)};
    ILSAI_TRY(ilsai_lubrication_reserve(&c->lubrication, count));
    ILSAI_TRY(ilsai_gmres_reserve(c->krylov, (size_t)count));
    return ilsai_grow((size_t)count, &c->capacity, arrays, sizeof arrays / sizeof *arrays);
}

/* A loop over the numbered cells. */
typedef struct loop {
    coupled *c;
    const coupled_problem *problem;
} loop;

static void share_cells(pool_function *function, coupled *c, const coupled_problem *problem) {
    loop l = {c, problem};
    ilsai_thread_pool_run(problem->threads, function, &l, c->cells.count, ILSAI_SHARE_CELLS);
}

static void add_pressures(void *context, int first, int end) {
    coupled *c = ((const loop *)context)->c;
    const coupled_problem *problem = ((const loop *)context)->problem;
    for (int k = first; k < end; k++) {
        int cell = c->cells.cell[k];
        if (c->cells.unknown[k] == UNKNOWN_WIDTH || c->cells.unknown[k] == UNKNOWN_NONE) {
            problem->pressure[cell] = problem->sigma[cell] + c->matrix.pressure[cell] +
                                      c->matrix.self_correction[k] * problem->width[cell] +
                                      c->pressure_change[k];
        }
    }
}

void ilsai_coupled_pressure(coupled *c, const coupled_problem *problem, coupled_counts *counts) {
    box part = ilsai_box_fold(problem->g, &c->cells.footprint);
    double start = ilsai_clock();
    size_t corner = (size_t)ilsai_grid_cell(problem->g, part.x0, part.y0);
    ilsai_elasticity_multiply(problem->elastic, problem->width + corner,
                              c->matrix.pressure + corner, (size_t)problem->g->nx);
    counts->seconds_product += ilsai_clock() - start;
    counts->products++;
    share_cells(add_pressures, c, problem);
}

/* ---- Closed cells, and tip cells at a bound of their pressure ---------------------------------
 */

/* The width up to which a cell carries no weight for the others. */
static double nearly_closed(const coupled_problem *problem) {
    return ILSAI_NEARLY_CLOSED * problem->contact.closure_width;
}

/* What leaks in the step from numbered cell k at the full rate, per area. */
static double full_leakoff(const coupled *c, const coupled_problem *problem, int k) {
    const double *leakoff = problem->contact.leakoff;
    return leakoff ? fmax(leakoff[c->cells.cell[k]] - c->source_change[k], 0) : 0;
}

static void set_retained(const coupled_problem *problem, int cell, double retained) {
    if (problem->contact.retained) {
        problem->contact.retained[cell] = retained;
    }
}

/*
 * Puts the pressure of tip cell k on a bound that it has passed, and finds its width instead; once
 * the width passes the asymptote's it is put on that, and the pressure is found again. Returns
 * whether the cell has passed one.
 */
static bool bound_tip(const coupled *c, const coupled_problem *problem, int k) {
    int cell = c->cells.cell[k];
    const tip_pressures *of = &problem->tip_pressures;
    double *p = &problem->pressure[cell], *width = &problem->width[cell];
    double low = fmin(of->low, problem->sigma[cell]) - of->reach;
    double high = fmax(of->high, problem->sigma[cell]) + of->reach;
    if (!(of->reach > 0)) {
        return false;
    }
    if (c->cells.unknown[k] == UNKNOWN_PRESSURE && (*p < low || *p > high)) {
        *p = *p < low ? low : high;
        c->given_width[k] = fmax(c->given_width[k], ILSAI_CLOSURE * problem->contact.closure_width);
        *width = c->given_width[k];
        c->cells.unknown[k] = UNKNOWN_FILL;
        return true;
    }
    bool lacks_fluid = *p<0.5 * (low + high), more = *width> c->given_width[k];
    if (c->cells.unknown[k] == UNKNOWN_FILL && lacks_fluid == more) {
        *width = c->given_width[k];
        c->cells.unknown[k] = UNKNOWN_PRESSURE;
        return true;
    }
    return false;
}

/* A tip cell that is filled in part leaks in part. */
static void set_fill(coupled *c, const coupled_problem *problem, int k) {
    int cell = c->cells.cell[k];
    double leakoff = full_leakoff(c, problem, k), whole = c->given_width[k];
    double fill = problem->width[cell] / whole;
    set_retained(problem, cell, leakoff * fmax(1 - fill, 0));
    c->matrix.fill[k] = fill;
    c->matrix.leakoff_by_fill[k] = fill <= 1 ? leakoff / whole : 0;
    c->bounded++;
}

/* Sets the openness of channel cell k, and what of its leak-off it retains. */
static void set_openness(coupled *c, const coupled_problem *problem, int k) {
    int cell = c->cells.cell[k];
    double closure = problem->contact.closure_width;
    double m = problem->contact.state
                   ? ilsai_contact_openness(problem->width[cell], c->given_width[k], closure)
                   : 1;
    c->openness[k] = m;
    c->openness_slope[k] = m < 1 ? 1 / ilsai_contact_band(closure) : 0;
    c->closed += m < 1;
    set_retained(problem, cell, (1 - m) * full_leakoff(c, problem, k));
}

/* Sets what follows from the widths for cells that are closed, drain, or are at the front. */
static void set_states(coupled *c, const coupled_problem *problem) {
    c->closed = c->bounded = c->unreached = 0;
    for (int k = 0; k < c->cells.count; k++) {
        c->openness[k] = 1;
        c->openness_slope[k] = 0;
        switch (c->cells.unknown[k]) {
        case UNKNOWN_WIDTH:
            set_openness(c, problem, k);
            break;
        case UNKNOWN_PRESSURE:
            c->matrix.fill[k] = 1;
            set_retained(problem, c->cells.cell[k], 0);
            break;
        case UNKNOWN_FILL:
            set_fill(c, problem, k);
            break;
        default:
            c->unreached++;
        }
    }
}

/*
 * Opens the closed and draining cells that gain fluid even if they let out and leak in full: the
 * width that they find lies beyond that at which they drain. All of them are found before any is
 * opened, so that their order does not count.
 */
static void open_cells(coupled *c, const coupled_problem *problem) {
    for (int k = 0; k < c->cells.count; k++) {
        int cell = c->cells.cell[k];
        if (c->openness[k] < 1) {
            double gain = ilsai_contact_gain(&c->lubrication, &c->cells, c->openness, k) +
                          problem->source_term[cell] + c->source_change[k];
            bool opens = gain > problem->width[cell] - problem->width_old[cell];
            c->openness_slope[k] *= !opens;
        }
    }
    for (int k = 0; k < c->cells.count; k++) {
        if (c->openness[k] < 1 && c->openness_slope[k] == 0) {
            c->openness[k] = 1;
            c->closed--;
            set_retained(problem, c->cells.cell[k], 0);
        }
    }
}

/*
 * Lets no cell that is nearly closed, and no tip cell at a bound of its pressure, turn Newton's
 * step around. Elasticity does not answer to the width of the latter.
 */
static void calm_cells(coupled *c, const coupled_problem *problem) {
    for (int k = 0; k < c->cells.count; k++) {
        int cell = c->cells.cell[k], nx = problem->g->nx;
        bool fills = c->cells.unknown[k] == UNKNOWN_FILL;
        bool nearly =
            c->cells.unknown[k] == UNKNOWN_WIDTH && problem->width[cell] <= nearly_closed(problem);
        if (nearly || fills) {
            double self = ilsai_elasticity_self_entry(problem->elastic, cell % nx, cell / nx);
            ilsai_contact_calm(&c->lubrication, &c->cells, k, fills ? 0 : self);
        }
    }
}

/* Holds back what flows out of cells that are closed or drain, and what leaks from them. */
static void restrain(coupled *c, const coupled_problem *problem) {
    ilsai_contact_restrain(&c->lubrication, &c->cells, c->openness, c->openness_slope);
    for (int k = 0; k < c->cells.count; k++) {
        c->lubrication.by_own_width[k] -= c->openness_slope[k] * full_leakoff(c, problem, k);
    }
}

/* ---- A Newton step ------------------------------------------------------------------------ */

static void balance_volumes(void *context, int first, int end) {
    const coupled *c = ((const loop *)context)->c;
    const coupled_problem *problem = ((const loop *)context)->problem;
    for (int k = first; k < end; k++) {
        int cell = c->cells.cell[k];
        double inflow = ilsai_lubrication_inflow(&c->lubrication, k);
        double source = problem->source_term[cell] + c->source_change[k];
        source += problem->contact.retained ? problem->contact.retained[cell] : 0;
        c->rhs[k] = inflow + (source - (problem->width[cell] - problem->width_old[cell]));
        c->rhs[k] = c->cells.unknown[k] == UNKNOWN_NONE ? 0 : c->rhs[k];
    }
}

/* rhs = -(w - w_old - dt A(w) p - S), (4.4). */
static void set_rhs(coupled *c, const coupled_problem *problem) {
    flow_state state = {.g = problem->g,
                        .cells = &c->cells,
                        .material = problem->material,
                        .dt = problem->dt,
                        .width = problem->width,
                        .width_old = problem->width_old,
                        .pressure = problem->pressure,
                        .threads = problem->threads};
    problem->fluid->set_fluxes(&c->lubrication, &state);
    c->lubrication.restrained = false;
    if (problem->contact.state) {
        open_cells(c, problem);
        calm_cells(c, problem);
    }
    if (c->closed > 0 || c->unreached > 0) {
        restrain(c, problem);
    }
    share_cells(balance_volumes, c, problem);
}

static ilsa_status solve_iterative(coupled *c, coupled_counts *counts) {
    ILSAI_TRY(ilsai_jacobian_set_preconditioner(&c->matrix));
    gmres_result result =
        ilsai_gmres_solve(c->krylov, (size_t)c->cells.count, ilsai_jacobian_multiply,
                          ilsai_jacobian_precondition, &c->matrix, c->rhs, c->step,
                          c->closed > ILSAI_GMRES_CLOSED * c->cells.count ? ILSAI_GMRES_CONTACT
                                                                          : ILSAI_GMRES_TOLERANCE,
                          ILSAI_GMRES_ITERATIONS);
    counts->krylov += result.iterations;
    c->residual = result.residual;
    return result.converged ? ILSA_OK : ILSA_STEP_REJECTED;
}

/*
 * The largest part of the Newton step, at most 1, that leaves every width positive and takes no
 * front further than its sensitivities hold. The cells that are nearly closed have contact to see
 * to their widths.
 */
static double step_length(const coupled *c, const coupled_problem *problem) {
    double length = 1, nearly = nearly_closed(problem);
    for (int k = 0; k < c->cells.count; k++) {
        double w = problem->width[c->cells.cell[k]];
        if (c->cells.unknown[k] == UNKNOWN_WIDTH && w > nearly &&
            -c->step[k] * length > ILSAI_WIDTH_DROP * w) {
            length = ILSAI_WIDTH_DROP * w / -c->step[k];
        }
        double advance = fabs(ilsai_jacobian_advance(&c->matrix, k, c->step));
        if (advance * length > ILSAI_NEWTON_ADVANCE) {
            length = ILSAI_NEWTON_ADVANCE / advance;
        }
    }
    return length;
}

/* Changes the asymptote's width of tip cell k by its sensitivity. Returns false where it would be
 * left with next to nothing: the sensitivity does not hold so far. */
static bool move_given_width(const coupled *c, const coupled_problem *problem, int k,
                             double length) {
    double *width = &c->given_width[k];
    double change = ilsai_jacobian_width_change(&c->matrix, k, c->step) / c->matrix.fill[k];
    double delta = length * change;
    bool holds = -delta <= ILSAI_WIDTH_DROP * *width || *width <= nearly_closed(problem);
    *width = fmax(*width + delta, (1 - ILSAI_WIDTH_DROP) * *width);
    return holds;
}

/*
 * Changes the unknown of numbered cell k, and what its sensitivity ties to other unknowns. Returns
 * whether the sensitivity holds so far.
 */
static bool move_cell(const coupled *c, const coupled_problem *problem, int k, double length) {
    bool holds = true;
    int cell = c->cells.cell[k];
    double delta = length * c->step[k], *width = &problem->width[cell];
    double fill = c->matrix.fill[k];
    switch (c->cells.unknown[k]) {
    case UNKNOWN_WIDTH:
        *width += delta;
        c->pressure_change[k] += length * ilsai_jacobian_pressure_change(&c->matrix, k, c->step);
        break;
    case UNKNOWN_PRESSURE:
        problem->pressure[cell] += delta;
        holds = move_given_width(c, problem, k, length);
        *width = c->given_width[k];
        break;
    case UNKNOWN_FILL:
        fill = fmax(fill + delta / c->given_width[k], (1 - ILSAI_WIDTH_DROP) * fill);
        holds = move_given_width(c, problem, k, length);
        *width = fill * c->given_width[k];
        break;
    default:
        return true;
    }
    c->source_change[k] +=
        length * ilsai_jacobian_source_change(&c->matrix, k, c->step) / c->matrix.fill[k];
    return holds;
}

/* Keeps channel cell k at its least width or above. Returns whether it has closed or opened. */
static bool bound_channel(const coupled *c, const coupled_problem *problem, int k) {
    double *width = &problem->width[c->cells.cell[k]];
    *width = fmax(*width, c->given_width[k]);
    double m = ilsai_contact_openness(*width, c->given_width[k], problem->contact.closure_width);
    return (m < 1) != (c->openness[k] < 1);
}

/* What a Newton step has done. */
typedef struct progress {
    double change; /* the largest of a width over the largest width; NaN where the step is no
                      number */
    int switched;  /* cells that have closed or opened, or come to a bound or from it */
    bool holds;    /* whether all sensitivities do */
} progress;

static progress take_step(const coupled *c, const coupled_problem *problem, double length) {
    double change = 0, largest = 0, sum = 0;
    int switched = 0;
    bool holds = true;
    for (int k = 0; k < c->cells.count; k++) {
        double delta = length * c->step[k], *width = &problem->width[c->cells.cell[k]];
        unsigned char unknown = c->cells.unknown[k];
        sum += delta;
        holds &= move_cell(c, problem, k, length);
        if (unknown == UNKNOWN_WIDTH || unknown == UNKNOWN_FILL) {
            change = fabs(delta) > change ? fabs(delta) : change;
        }
        if (unknown == UNKNOWN_WIDTH) {
            switched += problem->contact.state && bound_channel(c, problem, k);
            largest = *width > largest ? *width : largest;
        } else {
            switched += bound_tip(c, problem, k);
        }
    }
    return (progress){isfinite(sum) && largest > 0 ? change / largest : NAN, switched, holds};
}

static bool choose_dense(const coupled *c, const coupled_problem *problem) {
    return problem->linear == ILSA_LINEAR_DENSE ||
           (problem->linear == ILSA_LINEAR_AUTO && c->cells.count <= ILSAI_DENSE_UNKNOWNS);
}

/* Estimate of the error left in the widths after a full Newton step of relative size `change`. */
static double error_left(const coupled *c, double change) {
    return change * (ILSAI_NEWTON_CURVATURE * change + ILSAI_NEWTON_RESIDUAL * c->residual);
}

/* The influence matrix is made anew where cells have changed their unknowns since the last solve.
 */
static ilsa_status solve_linear(coupled *c, bool dense, bool changed, coupled_counts *counts) {
    if (dense && changed) {
        ILSAI_TRY(ilsai_jacobian_set_influence(&c->matrix));
    }
    counts->newton++;
    return dense ? ilsai_jacobian_solve_full(&c->matrix, c->rhs, c->step)
                 : solve_iterative(c, counts);
}

/* Keeps what a Newton step is about to change. */
static void keep(const coupled *c, const coupled_problem *problem) {
    for (int k = 0; k < c->cells.count; k++) {
        double *kept = c->kept + (size_t)KEPT * (size_t)k;
        kept[KEPT_WIDTH] = problem->width[c->cells.cell[k]];
        kept[KEPT_PRESSURE] = problem->pressure[c->cells.cell[k]];
        kept[KEPT_SOURCE] = c->source_change[k];
        kept[KEPT_LIFT] = c->pressure_change[k];
        kept[KEPT_GIVEN] = c->given_width[k];
        kept[KEPT_FILL] = c->matrix.fill[k];
        kept[KEPT_UNKNOWN] = c->cells.unknown[k];
    }
}

static void put_back(const coupled *c, const coupled_problem *problem) {
    for (int k = 0; k < c->cells.count; k++) {
        const double *kept = c->kept + (size_t)KEPT * (size_t)k;
        problem->width[c->cells.cell[k]] = kept[KEPT_WIDTH];
        problem->pressure[c->cells.cell[k]] = kept[KEPT_PRESSURE];
        c->source_change[k] = kept[KEPT_SOURCE];
        c->pressure_change[k] = kept[KEPT_LIFT];
        c->given_width[k] = kept[KEPT_GIVEN];
        c->matrix.fill[k] = kept[KEPT_FILL];
        c->cells.unknown[k] = (unsigned char)kept[KEPT_UNKNOWN];
    }
}

/* Sets states, pressures, fluxes and balances for the widths as they are. Returns the volume that
 * is unaccounted for, over the area of a cell. */
static double evaluate(coupled *c, const coupled_problem *problem, coupled_counts *counts) {
    double sum = 0;
    set_states(c, problem);
    ilsai_coupled_pressure(c, problem, counts);
    set_rhs(c, problem);
    for (int k = 0; k < c->cells.count; k++) {
        sum += fabs(c->rhs[k]);
    }
    return sum;
}

/* Cuts the last Newton step, of this length, until no more is unaccounted for than was before it,
 * `least`. Returns what is unaccounted for at the end. */
static double cut_step(coupled *c, const coupled_problem *problem, double length, double least,
                       progress *made, coupled_counts *counts) {
    double now = evaluate(c, problem, counts);
    for (int cut = 0; cut < ILSAI_NEWTON_CUTS && now > least; cut++) {
        length *= ILSAI_NEWTON_CUT;
        put_back(c, problem);
        set_states(c, problem);
        *made = take_step(c, problem, length);
        now = evaluate(c, problem, counts);
    }
    return now;
}

/*
 * Newton's method, which is semi-smooth where cells close or open: it ends with an iteration in
 * which none has.
 */
static ilsa_status newton(coupled *c, const coupled_problem *problem, coupled_counts *counts) {
    bool dense = choose_dense(c, problem);
    int left = ILSAI_NEWTON_MAX;
    progress made = {0, 1, true};
    double length = 1, unaccounted = INFINITY;
    c->residual = 0;
    for (int k = 0; k < ILSAI_CONTACT_MAX && left > 0; k++) {
        double least = k > ILSAI_NEWTON_GUARDED ? unaccounted : INFINITY;
        unaccounted = cut_step(c, problem, length, least, &made, counts);
        if (k >= ILSAI_NEWTON_GUARDED) {
            keep(c, problem);
        }
        ILSAI_TRY(solve_linear(c, dense, made.switched > 0 || c->bounded > 0, counts));
        length = step_length(c, problem);
        made = take_step(c, problem, length);
        if (isnan(made.change)) {
            return ILSA_STEP_REJECTED;
        }
        c->settled = made.holds;
        if (!made.holds ||
            (length == 1 && !made.switched && error_left(c, made.change) <= problem->tolerance)) {
            set_states(c, problem);
            return ILSA_OK;
        }
        left -= !made.switched;
    }
    return ILSA_STEP_REJECTED;
}

/* Sets what a solve begins with in numbered cell k: what its unknown is, and what bounds it. */
static void begin_cell(coupled *c, const coupled_problem *problem, int k) {
    int cell = c->cells.cell[k];
    const contact_fields *contact = &problem->contact;
    double old = problem->width_old[cell], *width = &problem->width[cell];
    c->given_width[k] = *width;
    c->matrix.fill[k] = 1;
    c->matrix.leakoff_by_fill[k] = 0;
    set_retained(problem, cell, 0);
    if (!contact->state) {
        return;
    }
    if (c->cells.unknown[k] == UNKNOWN_WIDTH) {
        c->given_width[k] = ilsai_contact_least(old, contact->closure_width);
        *width = fmax(*width, c->given_width[k]);
    } else if (contact->state[cell] == CONTACT_CUT_OFF || (*width == 0 && old == 0)) {
        c->cells.unknown[k] = UNKNOWN_NONE;
    } else {
        bound_tip(c, problem, k);
    }
}

/* Sets what a solve begins with in each numbered cell, its sensitivity included. */
static void begin_cells(coupled *c, const coupled_problem *problem) {
    for (int k = 0; k < c->cells.count; k++) {
        c->matrix.sensitivity_of[k] = -1;
        c->source_change[k] = c->pressure_change[k] = 0;
        c->matrix.self_correction[k] =
            problem->self_correction ? problem->self_correction[c->cells.cell[k]] : 0;
        begin_cell(c, problem, k);
    }
    for (int r = 0; r < problem->sensitivity_count; r++) {
        int k = c->cells.number[problem->sensitivity[r].cell];
        if (k >= 0) {
            c->matrix.sensitivity_of[k] = r;
        }
    }
}

static ilsa_status set_box(const coupled_problem *problem) {
    const grid *g = problem->g;
    box part = ilsai_box_fold(g, &problem->footprint);
    return ilsai_elasticity_set_box(problem->elastic, &part, ilsai_grid_about_x(g),
                                    ilsai_grid_about_y(g));
}

ilsa_status ilsai_coupled_solve(coupled *c, const coupled_problem *problem,
                                coupled_counts *counts) {
    ILSAI_TRY(ilsai_unknowns_set(&c->cells, problem->g, &problem->footprint, problem->kind));
    ILSAI_TRY(reserve(c, c->cells.count));
    ILSAI_TRY(set_box(problem));
    c->matrix.g = problem->g;
    c->matrix.cells = &c->cells;
    c->matrix.lubrication = &c->lubrication;
    c->matrix.elastic = problem->elastic;
    c->matrix.sensitivity = problem->sensitivity_count > 0 ? problem->sensitivity : NULL;
    begin_cells(c, problem);
    c->matrix.threads = problem->threads;
    problem->elastic->threads = problem->threads;
    c->matrix.products = 0;
    c->matrix.seconds_product = c->matrix.seconds_preconditioner = 0;
    ilsa_status status = newton(c, problem, counts);
    counts->products += c->matrix.products;
    counts->seconds_product += c->matrix.seconds_product;
    counts->seconds_preconditioner += c->matrix.seconds_preconditioner;
    return status;
}
