#include "step/start.h"

#include "base/tuning.h"
#include "step/step.h"
#include "tip/penny.h"
#include <math.h>

/* The fracture that is being laid on the mesh. */
typedef struct laid_penny {
    const penny_solution *solution;
    double x, y; /* centre */
} laid_penny;

/* The front in cell (i, j), as the march would see it. */
static front_cell front_in(const ilsa_solver *s, const laid_penny *p, int i, int j) {
    double x = ilsai_mesh_x(&s->mesh, i) - p->x, y = ilsai_mesh_y(&s->mesh, j) - p->y;
    double r = hypot(x, y);
    front_cell c = {.cell = j * s->mesh.nx + i, .T = r - p->solution->R, .V = p->solution->V};
    c.cos_a = r > 0 ? fabs(x) / r : 1;
    c.sin_a = r > 0 ? fabs(y) / r : 0;
    c.ell = 0.5 * (s->mesh.dx * c.cos_a + s->mesh.dy * c.sin_a) - c.T;
    return c;
}

/* Mean width of a full cell: Simpson's rule in both directions. */
static double mean_width(const ilsa_solver *s, const laid_penny *p, int i, int j) {
    static const double weight[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
    double sum = 0;
    for (int b = 0; b < 3; b++) {
        for (int a = 0; a < 3; a++) {
            double x = ilsai_mesh_x(&s->mesh, i) + 0.5 * (a - 1) * s->mesh.dx - p->x;
            double y = ilsai_mesh_y(&s->mesh, j) + 0.5 * (b - 1) * s->mesh.dy - p->y;
            double rho = hypot(x, y) / p->solution->R;
            sum += weight[a] * weight[b] * ilsai_penny_width(p->solution, rho);
        }
    }
    return sum;
}

/* Leak-off so far of a cell, and what later leak-off needs to know. */
static void lay_leakoff(ilsa_solver *s, const laid_penny *p, const front_cell *c) {
    double rho = (c->T + p->solution->R) / p->solution->R, t = p->solution->t;
    int cell = c->cell;
    s->field.trigger[cell] = rho < 1 ? ilsai_penny_arrival(p->solution, rho) : INFINITY;
    double half = 0.5 * (s->mesh.dx * c->cos_a + s->mesh.dy * c->sin_a) / p->solution->R;
    tip_cell_front at = {c->ell, c->cos_a, c->sin_a, s->mesh.dx, s->mesh.dy};
    if (s->field.kind[cell] == ILSA_CELL_CHANNEL) {
        double took = ilsai_penny_arrival(p->solution, fmin(rho + half, 1)) -
                      ilsai_penny_arrival(p->solution, fmax(rho - half, 0));
        s->field.spread[cell] = ilsai_tip_cell_spread(&at, took);
        s->field.leaked[cell] = ilsai_tip_cell_full_leakoff(
            s->material.C_prime, t - s->field.trigger[cell], s->field.spread[cell]);
        return;
    }
    double corner = (p->solution->R - c->ell) / p->solution->R;
    tip_record *record = &s->tips.at[s->tips.count++];
    record->cell = cell;
    ilsai_tip_cell_enter(&record->history, ilsai_penny_arrival(p->solution, corner));
    ilsai_tip_cell_record(&record->history, t, c->ell);
    s->field.leaked[cell] = ilsai_tip_cell_leakoff(s->material.C_prime, &at, &record->history) /
                            (s->mesh.dx * s->mesh.dy);
}

static void lay_cell(ilsa_solver *s, const laid_penny *p, int i, int j) {
    front_cell c = front_in(s, p, i, j);
    double full = s->mesh.dx * c.cos_a + s->mesh.dy * c.sin_a;
    tip_cell_front at = {c.ell, c.cos_a, c.sin_a, s->mesh.dx, s->mesh.dy};
    s->field.level[c.cell] = c.T;
    s->field.speed[c.cell] = c.V;
    if (c.ell <= ILSAI_WET_MIN * fmin(s->mesh.dx, s->mesh.dy)) {
        return;
    }
    double rho = (c.T + p->solution->R) / p->solution->R;
    int tip = c.ell < full;
    s->field.kind[c.cell] = tip ? ILSA_CELL_TIP : ILSA_CELL_CHANNEL;
    s->field.width[c.cell] =
        tip ? ilsai_tip_cell_volume(&s->material, c.V, 0, &at) / (s->mesh.dx * s->mesh.dy)
            : mean_width(s, p, i, j);
    s->field.pressure[c.cell] = s->sigma[c.cell] + ilsai_penny_pressure(p->solution, rho);
    ilsai_box_add(&s->now.footprint, i, j);
    if (ilsai_has_leakoff(s)) {
        lay_leakoff(s, p, &c);
    }
}

/* Channel widths scaled so that the volume is the solution's; what is left has leaked. */
static void balance(ilsa_solver *s, const penny_solution *solution) {
    double channel = 0, tip = 0, area = s->mesh.dx * s->mesh.dy;
    const box *b = &s->now.footprint;
    s->now.injected = solution->Q * solution->t;
    /* What the solution leaves open of its volume must not become a negative leaked one. */
    s->now.fracture =
        ilsai_has_leakoff(s) ? fmin(solution->efficiency, 1) * s->now.injected : s->now.injected;
    s->now.leaked = s->now.injected - s->now.fracture;
    for (int pass = 0; pass < 2; pass++) {
        double factor = pass ? (s->now.fracture - tip) / channel : 1;
        for (int j = b->y0; j <= b->y1; j++) {
            for (int i = b->x0; i <= b->x1; i++) {
                int cell = j * s->mesh.nx + i, wet = s->field.kind[cell] >= ILSA_CELL_SURVEY;
                s->field.width[cell] *= wet ? factor : 1;
                s->now.width_most = fmax(s->now.width_most, s->field.width[cell]);
                *(wet ? &channel : &tip) += pass ? 0 : s->field.width[cell] * area;
            }
        }
    }
}

/* The cells within reach of the laid_penny and the band around it; empty if off the mesh. */
static box reach(const ilsa_solver *s, const laid_penny *p, double distance) {
    double u0 = (p->x - distance) / s->mesh.dx + 0.5 * (s->mesh.nx - 1);
    double u1 = (p->x + distance) / s->mesh.dx + 0.5 * (s->mesh.nx - 1);
    double v0 = (p->y - distance) / s->mesh.dy + 0.5 * (s->mesh.ny - 1);
    double v1 = (p->y + distance) / s->mesh.dy + 0.5 * (s->mesh.ny - 1);
    box b = {(int)fmax(u0, 0), (int)fmin(u1 + 1, s->mesh.nx - 1), (int)fmax(v0, 0),
             (int)fmin(v1 + 1, s->mesh.ny - 1)};
    return b;
}

static int fits(const ilsa_solver *s, const laid_penny *p) {
    double reach_x = 0.5 * (s->mesh.nx - 3) * s->mesh.dx,
           reach_y = 0.5 * (s->mesh.ny - 3) * s->mesh.dy;
    double R = p->solution->R;
    return p->x - R > -reach_x && p->x + R < reach_x && p->y - R > -reach_y && p->y + R < reach_y;
}

static int moderate(double value) {
    return value >= ILSAI_MAGNITUDE_LEAST && value <= ILSAI_MAGNITUDE_MOST;
}

ilsa_status ilsai_start_check(ilsa_solver *s, const penny_solution *solution) {
    laid_penny p = {solution, s->sources[0].def.x, s->sources[0].def.y};
    double least = ILSAI_START_CELLS * fmax(s->mesh.dx, s->mesh.dy);
    if (!(solution->R >= least)) {
        return ilsai_fail(&s->error, ILSA_ERR_VALUE,
                          "the radius %g at time %g is under %g cells: must be at least %g",
                          solution->R, solution->t, ILSAI_START_CELLS, least);
    }
    if (!fits(s, &p)) {
        return ilsai_fail(&s->error, ILSA_MESH_EDGE,
                          "a fracture of radius %g at (%g, %g) does not fit in the mesh",
                          solution->R, p.x, p.y);
    }
    if (!moderate(solution->t) || !moderate(solution->V) ||
        !moderate(ilsai_penny_width(solution, 0))) {
        return ilsai_fail(&s->error, ILSA_ERR_VALUE,
                          "a fracture of radius %g at time %g, width %g: must all be %g .. %g",
                          solution->R, solution->t, ilsai_penny_width(solution, 0),
                          ILSAI_MAGNITUDE_LEAST, ILSAI_MAGNITUDE_MOST);
    }
    double cells = 8 * (solution->R / s->mesh.dx + solution->R / s->mesh.dy) + 64;
    if (ilsai_has_leakoff(s) && ilsai_asymptote_records_reserve(&s->tips, (int)cells) != ILSA_OK) {
        return ilsai_fail(&s->error, ILSA_ERR_MEMORY, "no memory for the tip cells");
    }
    return ILSA_OK;
}

void ilsai_start_lay(ilsa_solver *s, const penny_solution *solution) {
    laid_penny p = {solution, s->sources[0].def.x, s->sources[0].def.y};
    state fresh = {.started = 1, .time = solution->t, .dt_limit = INFINITY};
    fresh.footprint = (box){s->mesh.nx, -1, s->mesh.ny, -1};
    fresh.mirror_x = p.x == 0;
    fresh.mirror_y = p.y == 0;
    if (s->now.started) {
        box old = ilsai_solver_region(s, &s->now.footprint);
        ilsai_fields_clear_box(&s->field, &s->mesh, &old);
    }
    s->now = fresh;
    ilsai_solver_set_viscosity(s, solution->scaled.mu_prime);
    s->tips.count = 0;
    box all = reach(s, &p, solution->R + ilsai_solver_band(s));
    for (int j = all.y0; j <= all.y1; j++) {
        for (int i = all.x0; i <= all.x1; i++) {
            lay_cell(s, &p, i, j);
        }
    }
    balance(s, solution);
    grid flat = ilsai_grid(&s->mesh, 0, 0);
    ilsai_step_classify(&flat, &s->now.footprint, s->field.kind);
}
