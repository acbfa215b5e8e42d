#include "solve/coupled.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/tuning.h"
#include "solve/gmres.h"
#include "solve/jacobian.h"
#include <math.h>
#include <stdbool.h>

struct coupled {
    unknowns cells;
    lubrication lubrication;
    jacobian matrix;
    gmres *krylov;
    double *rhs, *step;
    /* Per numbered cell, changes in this solve by the sensitivities: of the source term, and of the
     * pressure at a given width. */
    double *source_change, *pressure_change;
    double *closing_pressure; /* of a closed cell: the pressure when it closed or the solve began */
    double *stress;  /* of a channel cell: sigma + C w, the pressure that holds its width */
    size_t capacity; /* numbered cells that the arrays over them have room for */
    int closed;      /* cells that are closed or drain */
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
        ilsai_release((*c)->stress);
        ilsai_release((*c)->closing_pressure);
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
                                  ILSAI_GROWN(c->stress),
                                  ILSAI_GROWN(c->closing_pressure),
                                  ILSAI_GROWN(c->matrix.self_correction),
                                  ILSAI_GROWN(c->matrix.sensitivity_of)};
    ILSAI_TRY(ilsai_lubrication_reserve(&c->lubrication, count));
    ILSAI_TRY(ilsai_gmres_reserve(c->krylov, (size_t)count));
    return ilsai_grow((size_t)count, &c->capacity, arrays, sizeof arrays / sizeof *arrays);
}

static contact contact_of(coupled *c, const coupled_problem *problem, bool late) {
    return (contact){.field = problem->contact,
                     .cells = &c->cells,
                     .width_old = problem->width_old,
                     .source_change = c->source_change,
                     .stress = c->stress,
                     .closing_pressure = c->closing_pressure,
                     .width = problem->width,
                     .pressure = problem->pressure,
                     .late = late};
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
        if (c->cells.unknown[k] != UNKNOWN_PRESSURE) {
            c->stress[k] = problem->sigma[cell] + c->matrix.pressure[cell] +
                           c->matrix.self_correction[k] * problem->width[cell] +
                           c->pressure_change[k];
        }
        if (c->cells.unknown[k] < UNKNOWN_PRESSURE) {
            problem->pressure[cell] = c->stress[k];
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

static void balance_volumes(void *context, int first, int end) {
    const coupled *c = ((const loop *)context)->c;
    const coupled_problem *problem = ((const loop *)context)->problem;
    for (int k = first; k < end; k++) {
        int cell = c->cells.cell[k];
        double inflow = ilsai_lubrication_inflow(&c->lubrication, k);
        double source = problem->source_term[cell] + c->source_change[k];
        source += problem->contact.retained ? problem->contact.retained[cell] : 0;
        c->rhs[k] = inflow + (source - (problem->width[cell] - problem->width_old[cell]));
        if (c->cells.unknown[k] == UNKNOWN_CONTACT) {
            c->rhs[k] -= ilsai_jacobian_extra_diagonal(&c->matrix, k) *
                         (problem->pressure[cell] - c->closing_pressure[k]);
        }
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
    share_cells(balance_volumes, c, problem);
}

static ilsa_status solve_iterative(coupled *c, coupled_counts *counts) {
    ILSAI_TRY(ilsai_jacobian_set_preconditioner(&c->matrix));
    gmres_result result = ilsai_gmres_solve(
        c->krylov, (size_t)c->cells.count, ilsai_jacobian_multiply, ilsai_jacobian_precondition,
        &c->matrix, c->rhs, c->step, c->closed > 0 ? ILSAI_GMRES_CONTACT : ILSAI_GMRES_TOLERANCE,
        ILSAI_GMRES_ITERATIONS);
    counts->krylov += result.iterations;
    c->residual = result.residual;
    return result.converged ? ILSA_OK : ILSA_STEP_REJECTED;
}

/* The width up to which a cell carries no weight for the others. */
static double nearly_closed(const coupled_problem *problem) {
    return ILSAI_NEARLY_CLOSED * problem->contact.closure_width;
}

/*
 * The largest part of the Newton step, at most 1, that leaves every width positive; the cells that
 * are nearly closed have contact to see to that.
 */
static double step_length(const coupled *c, const coupled_problem *problem) {
    double length = 1, nearly = nearly_closed(problem);
    for (int k = 0; k < c->cells.count; k++) {
        double w = problem->width[c->cells.cell[k]];
        if (c->cells.unknown[k] == UNKNOWN_WIDTH && w > nearly &&
            -c->step[k] * length > ILSAI_WIDTH_DROP * w) {
            length = ILSAI_WIDTH_DROP * w / -c->step[k];
        }
    }
    return length;
}

/*
 * Changes the unknown of numbered cell k, and what its sensitivity ties to other unknowns. Returns
 * false where a tip cell would be left with next to no width: its sensitivity does not hold so far.
 */
static bool move_cell(const coupled *c, const coupled_problem *problem, int k, double length) {
    bool holds = true;
    int cell = c->cells.cell[k];
    double delta = length * c->step[k], *width = &problem->width[cell];
    switch (c->cells.unknown[k]) {
    case UNKNOWN_WIDTH:
        *width += delta;
        c->pressure_change[k] += length * ilsai_jacobian_pressure_change(&c->matrix, k, c->step);
        break;
    case UNKNOWN_RETAINED:
        problem->contact.retained[cell] += delta;
        break;
    default:
        problem->pressure[cell] += delta;
        delta = length * ilsai_jacobian_width_change(&c->matrix, k, c->step);
        holds = -delta <= ILSAI_WIDTH_DROP * *width || *width <= nearly_closed(problem);
        *width = fmax(*width + delta, (1 - ILSAI_WIDTH_DROP) * *width);
    }
    c->source_change[k] += length * ilsai_jacobian_source_change(&c->matrix, k, c->step);
    return holds;
}

/* What a Newton step has done. */
typedef struct progress {
    double change; /* the largest of a width, or of a retained leak-off, over the largest width; NaN
                      where the step is no number */
    int switched;  /* cells that have closed or opened */
    bool holds;    /* whether all sensitivities do */
} progress;

/*
 * Whether a late solve has gone too far. It has where the leak-off of a draining cell is beyond its
 * bounds by too much of the largest width, or the pressure in a closed cell beyond the closure
 * stress by too much of the largest net pressure.
 */
static bool is_forced(coupled *c, const coupled_problem *problem) {
    contact faces = contact_of(c, problem, true);
    double net = 0, width = 0, excess = 0, violation = 0;
    for (int k = 0; k < c->cells.count; k++) {
        int cell = c->cells.cell[k];
        violation = fmax(violation, ilsai_contact_violation(&faces, k));
        if (c->cells.unknown[k] == UNKNOWN_WIDTH) {
            net = fmax(net, fabs(problem->pressure[cell] - problem->sigma[cell]));
            width = fmax(width, problem->width[cell]);
        } else if (c->cells.unknown[k] == UNKNOWN_CONTACT) {
            excess = fmax(excess, problem->pressure[cell] - c->stress[k]);
        }
    }
    return excess > ILSAI_CONTACT_FORCED * net || violation > ILSAI_CONTACT_FORCED * width;
}

static progress take_step(coupled *c, const coupled_problem *problem, double length, bool late) {
    contact faces = contact_of(c, problem, late);
    double change = 0, largest = 0, sum = 0;
    int switched = 0;
    bool holds = true;
    for (int k = 0; k < c->cells.count; k++) {
        double delta = length * c->step[k], *width = &problem->width[c->cells.cell[k]];
        sum += delta;
        holds &= move_cell(c, problem, k, length);
        if (c->cells.unknown[k] != UNKNOWN_PRESSURE) {
            largest = *width > largest ? *width : largest;
        }
        if (c->cells.unknown[k] < UNKNOWN_PRESSURE) {
            change = fabs(delta) > change ? fabs(delta) : change;
            switched += faces.field.state && ilsai_contact_bound(&faces, k);
        } else if (c->cells.unknown[k] == UNKNOWN_CONTACT) {
            switched += ilsai_contact_opens(&faces, k);
        }
    }
    return (progress){isfinite(sum) && largest > 0 ? change / largest : NAN, switched, holds};
}

/*
 * The flow into a cell that opens is large for its width until the pressures on both sides have
 * met. Its derivative by the width would turn Newton's step around, so that the first iteration
 * goes without that derivative.
 */
static void drop_width_derivatives(const coupled *c, int k) {
    for (int face = 0; face < GRID_FACES; face++) {
        int at = GRID_FACES * k + face, other = c->cells.neighbour[at];
        c->lubrication.by_width[at] = 0;
        for (int back = 0; other >= 0 && back < GRID_FACES; back++) {
            int from = GRID_FACES * other + back;
            c->lubrication.by_width[from] *= c->cells.neighbour[from] != k;
        }
    }
}

static void calm_opening_cells(const coupled *c, const coupled_problem *problem) {
    for (int k = 0; k < c->cells.count; k++) {
        if (problem->contact.state[c->cells.cell[k]] == CONTACT_OPENING) {
            drop_width_derivatives(c, k);
        }
    }
}

/* Opens the closed cells whose pressure calls for it at the widths as they are, and counts the
 * cells that are closed or drain after that. Returns how many were opened. */
static int reopen(coupled *c, const coupled_problem *problem, bool late) {
    contact faces = contact_of(c, problem, late);
    int opened = 0;
    c->closed = 0;
    for (int k = 0; k < c->cells.count; k++) {
        const unsigned char *unknown = &c->cells.unknown[k];
        if (*unknown == UNKNOWN_CONTACT && ilsai_contact_opens(&faces, k)) {
            ilsai_contact_reopen(&faces, k);
            opened++;
        }
        c->closed += *unknown == UNKNOWN_RETAINED || *unknown == UNKNOWN_CONTACT;
    }
    return opened;
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

/*
 * Newton's method, which is semi-smooth where cells close or open: each iteration solves for the
 * unknowns that the states of contact call for, and leaves the states that its solution calls for.
 */
static ilsa_status newton(coupled *c, const coupled_problem *problem, coupled_counts *counts) {
    bool dense = choose_dense(c, problem);
    int left = ILSAI_NEWTON_MAX;
    progress made = {0, 1, true};
    c->residual = 0;
    for (int k = 0; k < ILSAI_CONTACT_MAX && left > 0; k++) {
        bool late = k >= ILSAI_CONTACT_LATE;
        ilsai_coupled_pressure(c, problem, counts);
        made.switched += reopen(c, problem, late);
        set_rhs(c, problem);
        if (made.switched > 0 && problem->contact.state) {
            calm_opening_cells(c, problem);
        }
        ILSAI_TRY(solve_linear(c, dense, made.switched > 0, counts));
        double length = step_length(c, problem);
        made = take_step(c, problem, length, late);
        if (isnan(made.change)) {
            return ILSA_STEP_REJECTED;
        }
        c->settled = made.holds;
        if (!made.holds) {
            return ILSA_OK;
        }
        if (length == 1 && !made.switched && error_left(c, made.change) <= problem->tolerance) {
            return late && is_forced(c, problem) ? ILSA_STEP_REJECTED : ILSA_OK;
        }
        left -= !made.switched;
    }
    return ILSA_STEP_REJECTED;
}

/* Sets what a solve begins with in each numbered cell, its sensitivity included. */
static void begin_cells(coupled *c, const coupled_problem *problem) {
    for (int k = 0; k < c->cells.count; k++) {
        c->matrix.sensitivity_of[k] = -1;
        c->source_change[k] = c->pressure_change[k] = 0;
        c->matrix.self_correction[k] =
            problem->self_correction ? problem->self_correction[c->cells.cell[k]] : 0;
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
    if (problem->contact.state) {
        contact faces = contact_of(c, problem, false);
        ilsai_contact_begin(&faces);
    }
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
