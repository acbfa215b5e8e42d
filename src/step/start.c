#include "step/start.h"

#include "base/tuning.h"
#include "model/mesh.h"
#include "tip/penny.h"
#include <math.h>

/* The fracture that is being laid on the mesh. */
typedef struct laid_penny {
    const penny_solution *solution;
    double x, y; /* centre */
} laid_penny;

/* The front in cell (i, j), as the march would see it. */
static front_cell front_in(const ilsa_solver *s, const laid_penny *p, int i, int j) {
    double x = ilsai_mesh_x(&s->model.mesh, i) - p->x, y = ilsai_mesh_y(&s->model.mesh, j) - p->y;
    double r = hypot(x, y);
    front_cell c = {.cell = j * s->model.mesh.nx + i, .T = r - p->solution->R, .V = p->solution->V};
    c.cos_a = r > 0 ? fabs(x) / r : 1;
    c.sin_a = r > 0 ? fabs(y) / r : 0;
    c.ell = 0.5 * (s->model.mesh.dx * c.cos_a + s->model.mesh.dy * c.sin_a) - c.T;
    return c;
}

/* Mean width of a full cell: Simpson's rule in both directions. */
static double mean_width(const ilsa_solver *s, const laid_penny *p, int i, int j) {
    static const double weight[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
    double sum = 0;
    for (int b = 0; b < 3; b++) {
        for (int a = 0; a < 3; a++) {
            double x = ilsai_mesh_x(&s->model.mesh, i) + 0.5 * (a - 1) * s->model.mesh.dx - p->x;
            double y = ilsai_mesh_y(&s->model.mesh, j) + 0.5 * (b - 1) * s->model.mesh.dy - p->y;
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
    s->fracture.cells.trigger[cell] = rho < 1 ? ilsai_penny_arrival(p->solution, rho) : INFINITY;
    double half =
        0.5 * (s->model.mesh.dx * c->cos_a + s->model.mesh.dy * c->sin_a) / p->solution->R;
    tip_cell_front at = {c->ell, c->cos_a, c->sin_a, s->model.mesh.dx, s->model.mesh.dy};
    if (s->fracture.cells.kind[cell] == ILSA_CELL_CHANNEL) {
        double took = ilsai_penny_arrival(p->solution, fmin(rho + half, 1)) -
                      ilsai_penny_arrival(p->solution, fmax(rho - half, 0));
        s->fracture.cells.spread[cell] = ilsai_tip_cell_spread(&at, took);
        s->fracture.cells.leaked[cell] = ilsai_tip_cell_full_leakoff(
            s->model.material.C_prime, t - s->fracture.cells.trigger[cell],
            s->fracture.cells.spread[cell]);
        return;
    }
    double corner = (p->solution->R - c->ell) / p->solution->R;
    tip_path *path = &s->fracture.paths.at[s->fracture.paths.count++];
    path->cell = cell;
    ilsai_tip_cell_enter(&path->history, ilsai_penny_arrival(p->solution, corner));
    ilsai_tip_cell_record(&path->history, t, c->ell);
    s->fracture.cells.leaked[cell] =
        ilsai_tip_cell_leakoff(s->model.material.C_prime, &at, &path->history) /
        (s->model.mesh.dx * s->model.mesh.dy);
}

static void lay_cell(ilsa_solver *s, const laid_penny *p, int i, int j) {
    front_cell c = front_in(s, p, i, j);
    double full = s->model.mesh.dx * c.cos_a + s->model.mesh.dy * c.sin_a;
    tip_cell_front at = {c.ell, c.cos_a, c.sin_a, s->model.mesh.dx, s->model.mesh.dy};
    s->fracture.cells.level[c.cell] = c.T;
    s->fracture.cells.speed[c.cell] = c.V;
    if (c.ell <= ILSAI_WET_MIN * fmin(s->model.mesh.dx, s->model.mesh.dy)) {
        return;
    }
    double rho = (c.T + p->solution->R) / p->solution->R;
    bool tip = c.ell < full;
    s->fracture.cells.kind[c.cell] = tip ? ILSA_CELL_TIP : ILSA_CELL_CHANNEL;
    s->fracture.cells.width[c.cell] = tip ? ilsai_tip_cell_volume(&s->model.material, c.V, 0, &at) /
                                                (s->model.mesh.dx * s->model.mesh.dy)
                                          : mean_width(s, p, i, j);
    s->fracture.cells.pressure[c.cell] =
        s->model.sigma[c.cell] + ilsai_penny_pressure(p->solution, rho);
    ilsai_box_add(&s->fracture.footprint, i, j);
    if (ilsai_model_leaks(&s->model)) {
        lay_leakoff(s, p, &c);
    }
}

/* Channel widths scaled so that the volume is the solution's; what is left has leaked. */
static void balance(ilsa_solver *s, const penny_solution *solution) {
    double channel = 0, tip = 0, area = s->model.mesh.dx * s->model.mesh.dy;
    const box *b = &s->fracture.footprint;
    s->fracture.injected = solution->Q * solution->t;
    /* What the solution leaves open of its volume must not become a negative leaked one. */
    s->fracture.volume = ilsai_model_leaks(&s->model)
                             ? fmin(solution->efficiency, 1) * s->fracture.injected
                             : s->fracture.injected;
    s->fracture.leaked = s->fracture.injected - s->fracture.volume;
    for (int pass = 0; pass < 2; pass++) {
        double factor = pass ? (s->fracture.volume - tip) / channel : 1;
        for (int j = b->y0; j <= b->y1; j++) {
            for (int i = b->x0; i <= b->x1; i++) {
                int cell = j * s->model.mesh.nx + i;
                bool wet = ilsai_is_channel(s->fracture.cells.kind[cell]);
                s->fracture.cells.width[cell] *= wet ? factor : 1;
                s->fracture.width_most =
                    fmax(s->fracture.width_most, s->fracture.cells.width[cell]);
                *(wet ? &channel : &tip) += pass ? 0 : s->fracture.cells.width[cell] * area;
            }
        }
    }
}

/* The cells within reach of the laid_penny and the band around it; empty if off the mesh. */
static box reach(const ilsa_solver *s, const laid_penny *p, double distance) {
    double u0 = (p->x - distance) / s->model.mesh.dx + 0.5 * (s->model.mesh.nx - 1);
    double u1 = (p->x + distance) / s->model.mesh.dx + 0.5 * (s->model.mesh.nx - 1);
    double v0 = (p->y - distance) / s->model.mesh.dy + 0.5 * (s->model.mesh.ny - 1);
    double v1 = (p->y + distance) / s->model.mesh.dy + 0.5 * (s->model.mesh.ny - 1);
    box b = {(int)fmax(u0, 0), (int)fmin(u1 + 1, s->model.mesh.nx - 1), (int)fmax(v0, 0),
             (int)fmin(v1 + 1, s->model.mesh.ny - 1)};
    return b;
}

static bool fits(const ilsa_solver *s, const laid_penny *p) {
    double reach_x = 0.5 * (s->model.mesh.nx - 3) * s->model.mesh.dx,
           reach_y = 0.5 * (s->model.mesh.ny - 3) * s->model.mesh.dy;
    double R = p->solution->R;
    return p->x - R > -reach_x && p->x + R < reach_x && p->y - R > -reach_y && p->y + R < reach_y;
}

static bool moderate(double value) {
    return value >= ILSAI_MAGNITUDE_LEAST && value <= ILSAI_MAGNITUDE_MOST;
}

ilsa_status ilsai_start_check(ilsa_solver *s, const penny_solution *solution) {
    laid_penny p = {solution, s->model.sources.at[0].def.x, s->model.sources.at[0].def.y};
    double least = ILSAI_START_CELLS * fmax(s->model.mesh.dx, s->model.mesh.dy);
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
    double cells = 8 * (solution->R / s->model.mesh.dx + solution->R / s->model.mesh.dy) + 64;
    if (ilsai_model_leaks(&s->model) &&
        ilsai_tip_paths_reserve(&s->fracture.paths, (int)cells) != ILSA_OK) {
        return ilsai_fail(&s->error, ILSA_ERR_MEMORY, "no memory for the tip cells");
    }
    return ILSA_OK;
}

void ilsai_start_lay(ilsa_solver *s, const penny_solution *solution) {
    const ilsa_mesh_def *mesh = &s->model.mesh;
    fracture *f = &s->fracture;
    laid_penny p = {solution, s->model.sources.at[0].def.x, s->model.sources.at[0].def.y};
    ilsai_fracture_clear(f, mesh);
    *f = (fracture){.started = true,
                    .mirror_x = p.x == 0,
                    .mirror_y = p.y == 0,
                    .mu_prime = solution->scaled.mu_prime,
                    .time = solution->t,
                    .footprint = {mesh->nx, -1, mesh->ny, -1},
                    .cells = f->cells,
                    .paths = {f->paths.at, 0, f->paths.capacity}};
    s->pace.dt_limit = INFINITY;
    ilsai_model_set_viscosity(&s->model, f->mu_prime);
    box all = reach(s, &p, solution->R + ilsai_fracture_band(mesh));
    for (int j = all.y0; j <= all.y1; j++) {
        for (int i = all.x0; i <= all.x1; i++) {
            lay_cell(s, &p, i, j);
        }
    }
    balance(s, solution);
    grid flat = ilsai_grid(mesh, 0, 0);
    ilsai_fracture_find_survey(&flat, &f->footprint, f->cells.kind);
}
