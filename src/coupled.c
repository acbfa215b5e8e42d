#include "coupled.h"

#include "clock.h"
#include "gmres.h"
#include "jacobian.h"
#include "tuning.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct coupled {
    active cells;
    flow fluid;
    jacobian matrix;
    gmres *krylov;
    double *rhs, *step;
    double *shift; /* change of the source terms at the front in this solve */
    double *lift;  /* change of the pressures there for the front's move in this solve */
    int capacity;
    int response_capacity;
    double residual; /* of the last linear solve, relative */
};

coupled *ilsai_coupled_create(const ilsa_mesh_def *mesh) {
    coupled *c = calloc(1, sizeof *c);
    if (!c) {
        return NULL;
    }
    size_t mesh_cells = (size_t)mesh->nx * (size_t)mesh->ny;
    c->krylov = ilsai_gmres_create(ILSAI_GMRES_RESTART);
    c->matrix.width = calloc(mesh_cells, sizeof(double));
    c->matrix.pressure = calloc(mesh_cells, sizeof(double));
    if (ilsai_active_create(&c->cells, mesh) != ILSA_OK || !c->krylov || !c->matrix.width ||
        !c->matrix.pressure) {
        ilsai_coupled_destroy(&c);
    }
    return c;
}

void ilsai_coupled_destroy(coupled **c) {
    if (*c) {
        ilsai_active_destroy(&(*c)->cells);
        ilsai_flow_destroy(&(*c)->fluid);
        ilsai_jacobian_destroy(&(*c)->matrix);
        ilsai_gmres_destroy(&(*c)->krylov);
        free((*c)->rhs);
        free((*c)->step);
        free((*c)->shift);
        free((*c)->lift);
        free(*c);
        *c = NULL;
    }
}

int ilsai_coupled_unknowns(const coupled *c) {
    return c->cells.count;
}

static ilsa_status reserve(coupled *c, int count) {
    if (ilsai_flow_reserve(&c->fluid, count) != ILSA_OK ||
        ilsai_gmres_reserve(c->krylov, (size_t)count) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    if (count > c->capacity) {
        size_t capacity = (size_t)count + (size_t)count / 2 + 64;
        double *rhs = realloc(c->rhs, capacity * sizeof *rhs);
        c->rhs = rhs ? rhs : c->rhs;
        double *step = realloc(c->step, capacity * sizeof *step);
        c->step = step ? step : c->step;
        double *shift = realloc(c->shift, capacity * sizeof *shift);
        c->shift = shift ? shift : c->shift;
        double *lift = realloc(c->lift, capacity * sizeof *lift);
        c->lift = lift ? lift : c->lift;
        double *edge = realloc(c->matrix.edge, capacity * sizeof *edge);
        c->matrix.edge = edge ? edge : c->matrix.edge;
        if (!rhs || !step || !shift || !lift || !edge) {
            return ILSA_ERR_MEMORY;
        }
        c->capacity = (int)capacity;
    }
    return ILSA_OK;
}

/* A loop over the active cells. */
typedef struct loop {
    coupled *c;
    const coupled_problem *problem;
} loop;

static void share_cells(team_function *function, coupled *c, const coupled_problem *problem) {
    loop l = {c, problem};
    ilsai_team_run(problem->threads, function, &l, c->cells.count, ILSAI_SHARE_CELLS);
}

static void set_images(void *context, int first, int end) {
    const loop *l = context;
    const grid *g = l->problem->g;
    double *width = l->problem->width;
    int image[4];
    for (int k = first; k < end; k++) {
        int cell = l->c->cells.cell[k];
        int count = ilsai_grid_images(g, cell % g->nx, cell / g->nx, image);
        for (int m = 1; m < count; m++) {
            width[image[m]] = width[cell];
        }
    }
}

static void add_pressures(void *context, int first, int end) {
    const coupled *c = ((const loop *)context)->c;
    const coupled_problem *problem = ((const loop *)context)->problem;
    for (int k = first; k < end; k++) {
        int cell = c->cells.cell[k];
        if (!c->cells.tip[k]) {
            problem->pressure[cell] = problem->sigma[cell] + c->matrix.pressure[cell] +
                                      c->matrix.edge[k] * problem->width[cell] + c->lift[k];
        }
    }
}

void ilsai_coupled_pressure(coupled *c, const coupled_problem *problem, coupled_counts *counts) {
    const box *b = &c->cells.footprint;
    double start = ilsai_clock();
    size_t corner = (size_t)ilsai_grid_cell(problem->g, b->x0, b->y0);
    ilsai_elasticity_multiply(problem->e, problem->width + corner, c->matrix.pressure + corner,
                              (size_t)problem->g->nx);
    counts->seconds_product += ilsai_clock() - start;
    counts->products++;
    share_cells(add_pressures, c, problem);
}

static void balance_volumes(void *context, int first, int end) {
    const coupled *c = ((const loop *)context)->c;
    const coupled_problem *problem = ((const loop *)context)->problem;
    for (int k = first; k < end; k++) {
        int cell = c->cells.cell[k];
        double gain = ilsai_flow_gain_of(&c->fluid, &c->cells, problem->pressure, k);
        c->rhs[k] = gain + (problem->gain[cell] + c->shift[k] -
                            (problem->width[cell] - problem->width_old[cell]));
    }
}

/* rhs = -(w - w_old - dt A(w) p - S), (4.4). */
static void set_rhs(coupled *c, const coupled_problem *problem) {
    ilsai_flow_set(&c->fluid, &c->cells, problem->g, problem->width, problem->width_old,
                   problem->pressure, problem->dt / problem->mu_prime);
    share_cells(balance_volumes, c, problem);
}

static ilsa_status solve_iterative(coupled *c, coupled_counts *counts) {
    ilsa_status status = ilsai_jacobian_set_preconditioner(&c->matrix);
    if (status != ILSA_OK) {
        return status;
    }
    gmres_result result = ilsai_gmres_solve(
        c->krylov, (size_t)c->cells.count, ilsai_jacobian_multiply, ilsai_jacobian_precondition,
        &c->matrix, c->rhs, c->step, ILSAI_GMRES_TOLERANCE, ILSAI_GMRES_ITERATIONS);
    counts->krylov += result.iterations;
    c->residual = result.residual;
    return result.converged ? ILSA_OK : ILSA_STEP_REJECTED;
}

/* The largest part of the Newton step, at most 1, that leaves every width positive. */
static double step_length(const coupled *c, const coupled_problem *problem) {
    double length = 1;
    for (int k = 0; k < c->cells.count; k++) {
        double w = problem->width[c->cells.cell[k]];
        if (!c->cells.tip[k] && -c->step[k] * length > ILSAI_WIDTH_DROP * w) {
            length = ILSAI_WIDTH_DROP * w / -c->step[k];
        }
    }
    return length;
}

/* Takes the step; returns the largest change of width over the largest width, NaN if not finite. */
static double take_step(const coupled *c, const coupled_problem *problem, double length) {
    double change = 0, largest = 0, sum = 0;
    for (int k = 0; k < c->cells.count; k++) {
        int cell = c->cells.cell[k];
        double delta = length * c->step[k];
        sum += delta;
        c->shift[k] += length * ilsai_jacobian_tip_gain(&c->matrix, k, c->step);
        if (c->cells.tip[k]) {
            double w = problem->width[cell];
            double answer = length * ilsai_jacobian_tip_width(&c->matrix, k, c->step);
            problem->width[cell] = fmax(w + answer, (1 - ILSAI_WIDTH_DROP) * w);
            problem->pressure[cell] += delta;
        } else {
            problem->width[cell] += delta;
            c->lift[k] += length * ilsai_jacobian_edge_pressure(&c->matrix, k, c->step);
            change = fabs(delta) > change ? fabs(delta) : change;
            largest = problem->width[cell] > largest ? problem->width[cell] : largest;
        }
    }
    return isfinite(sum) && largest > 0 ? change / largest : NAN;
}

static int choose_dense(const coupled *c, const coupled_problem *problem) {
    return problem->linear == ILSA_LINEAR_DENSE ||
           (problem->linear == ILSA_LINEAR_AUTO && c->cells.count <= ILSAI_DENSE_UNKNOWNS);
}

/* Error left in the widths after a full Newton step of relative size change. */
static double error_left(const coupled *c, double change) {
    return change * (ILSAI_NEWTON_CURVATURE * change + ILSAI_NEWTON_RESIDUAL * c->residual);
}

static ilsa_status newton(coupled *c, const coupled_problem *problem, coupled_counts *counts) {
    int dense = choose_dense(c, problem);
    ilsa_status status = dense ? ilsai_jacobian_set_influence(&c->matrix) : ILSA_OK;
    double length = 1;
    c->residual = 0;
    for (int iteration = 0; iteration < ILSAI_NEWTON_MAX && status == ILSA_OK; iteration++) {
        ilsai_coupled_pressure(c, problem, counts);
        set_rhs(c, problem);
        counts->newton++;
        status = dense ? ilsai_jacobian_solve_full(&c->matrix, c->rhs, c->step)
                       : solve_iterative(c, counts);
        if (status != ILSA_OK) {
            return status == ILSA_ERR_NUMERIC ? ILSA_STEP_REJECTED : status;
        }
        length = step_length(c, problem);
        double change = take_step(c, problem, length);
        share_cells(set_images, c, problem);
        if (isnan(change)) {
            return ILSA_STEP_REJECTED;
        }
        if (length == 1 && error_left(c, change) <= problem->tolerance) {
            return ILSA_OK;
        }
    }
    return status != ILSA_OK ? status : length < 1 ? ILSA_CLOSED : ILSA_STEP_REJECTED;
}

/* Which active cell has which response. */
static ilsa_status find_responses(coupled *c, const coupled_problem *problem) {
    if (c->cells.count > c->response_capacity) {
        size_t capacity = (size_t)c->cells.count + (size_t)c->cells.count / 2 + 64;
        int *fresh = realloc(c->matrix.response_of, capacity * sizeof *fresh);
        if (!fresh) {
            return ILSA_ERR_MEMORY;
        }
        c->matrix.response_of = fresh;
        c->response_capacity = (int)capacity;
    }
    for (int k = 0; k < c->cells.count; k++) {
        c->matrix.response_of[k] = -1;
        c->shift[k] = c->lift[k] = 0;
        c->matrix.edge[k] = problem->edge ? problem->edge[c->cells.cell[k]] : 0;
    }
    for (int r = 0; r < problem->response_count; r++) {
        int k = c->cells.slot[problem->response[r].cell];
        if (k >= 0) {
            c->matrix.response_of[k] = r;
        }
    }
    return ILSA_OK;
}

ilsa_status ilsai_coupled_solve(coupled *c, const coupled_problem *problem,
                                coupled_counts *counts) {
    ilsa_status status =
        ilsai_active_set(&c->cells, problem->g, &problem->footprint, problem->kind);
    if (status != ILSA_OK || reserve(c, c->cells.count) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    int bx = problem->footprint.x1 - problem->footprint.x0 + 1;
    int by = problem->footprint.y1 - problem->footprint.y0 + 1;
    if (ilsai_elasticity_set_box(problem->e, bx, by) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    share_cells(set_images, c, problem);
    c->matrix.g = problem->g;
    c->matrix.a = &c->cells;
    c->matrix.f = &c->fluid;
    c->matrix.e = problem->e;
    c->matrix.response = problem->response_count > 0 ? problem->response : NULL;
    if (find_responses(c, problem) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    c->matrix.threads = c->fluid.threads = problem->threads;
    ilsai_elasticity_share(problem->e, problem->threads);
    c->matrix.products = 0;
    c->matrix.seconds_product = c->matrix.seconds_preconditioner = 0;
    status = newton(c, problem, counts);
    counts->products += c->matrix.products;
    counts->seconds_product += c->matrix.seconds_product;
    counts->seconds_preconditioner += c->matrix.seconds_preconditioner;
    return status;
}
