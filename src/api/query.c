/* What a host reads off a solver: fields without a copy, and numbers for the whole fracture. */
#include "flow/contact.h"
#include "model/mesh.h"
#include "step/solver.h"

#include <math.h>
#include <string.h>

/* The checks that every reading starts with. */
static ilsa_status readable(const ilsa_solver *s, const void *out, const char *name) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "solver", s);
    status = status ? status : ilsai_check_pointer(error, name, out);
    status = status ? status : ilsai_fracture_check(&s->fracture, error);
    return ilsai_fail_reading(status);
}

ilsa_status ilsa_get_time(const ilsa_solver *solver, double *time) {
    ILSAI_TRY(readable(solver, time, "time"));
    *time = solver->fracture.time;
    return ILSA_OK;
}

static ilsa_status get_field(const ilsa_solver *s, const double *field, const char *name,
                             const double **out) {
    ILSAI_TRY(readable(s, out, name));
    *out = field;
    return ILSA_OK;
}

ilsa_status ilsa_get_width(const ilsa_solver *solver, const double **width) {
    return get_field(solver, solver ? solver->fracture.cells.width : NULL, "width", width);
}

ilsa_status ilsa_get_pressure(const ilsa_solver *solver, const double **pressure) {
    return get_field(solver, solver ? solver->fracture.cells.pressure : NULL, "pressure", pressure);
}

ilsa_status ilsa_get_stress(const ilsa_solver *solver, const double **stress) {
    return get_field(solver, solver ? solver->model.sigma : NULL, "stress", stress);
}

ilsa_status ilsa_get_trigger_time(const ilsa_solver *solver, const double **trigger) {
    return get_field(solver, solver ? solver->fracture.cells.trigger : NULL, "trigger", trigger);
}

ilsa_status ilsa_get_cell_kinds(const ilsa_solver *solver, const unsigned char **kind) {
    ILSAI_TRY(readable(solver, kind, "kind"));
    const fracture *f = &solver->fracture;
    const box *b = &f->footprint;
    double closure = ilsai_fracture_closure_width(f, &solver->model);
    unsigned char *out = solver->handed_out.kind;
    memcpy(out, f->cells.kind, ilsai_mesh_cells(&solver->model.mesh));
    for (int j = b->y0; j <= b->y1; j++) {
        for (int i = b->x0; i <= b->x1; i++) {
            int cell = j * solver->model.mesh.nx + i;
            if (ilsai_is_channel(out[cell]) &&
                ilsai_contact_closed(f->cells.width[cell], closure)) {
                out[cell] = ILSA_CELL_CLOSED;
            }
        }
    }
    *kind = out;
    return ILSA_OK;
}

/*
 * How far inside the zero of the level lies between a cell inside and its neighbour outside, as a
 * distance from the cell's centre of d at most.
 */
static double crossing(double inside, double outside, double d) {
    double distance = isfinite(outside) ? d * -inside / (outside - inside) : -inside;
    return distance < d ? distance : d;
}

/* Distance along one direction from cell (i, j), inside, to where the front crosses the line. */
static double front_along(const ilsa_solver *s, int i, int j, int di, int dj) {
    double d = di ? s->model.mesh.dx : s->model.mesh.dy, distance = 0;
    const double *level = s->fracture.cells.level;
    for (;;) {
        int ni = i + di, nj = j + dj;
        double here = level[j * s->model.mesh.nx + i];
        if (ni < 0 || ni >= s->model.mesh.nx || nj < 0 || nj >= s->model.mesh.ny) {
            return distance;
        }
        if (level[nj * s->model.mesh.nx + ni] > 0) {
            return distance + crossing(here, level[nj * s->model.mesh.nx + ni], d);
        }
        distance += d;
        i = ni;
        j = nj;
    }
}

/* The paper's half-length and height: mean over the source's cells, in case it feeds several. */
static void set_lines(const ilsa_solver *s, ilsa_summary *out) {
    const point_source *from = &s->model.sources.at[0];
    for (int c = 0; c < from->count; c++) {
        int i = from->cell[c] % s->model.mesh.nx, j = from->cell[c] / s->model.mesh.nx;
        double x = ilsai_mesh_x(&s->model.mesh, i), y = ilsai_mesh_y(&s->model.mesh, j),
               part = from->part[c];
        if (!ilsai_is_channel(s->fracture.cells.kind[from->cell[c]])) {
            continue;
        }
        out->x_min += part * (x - front_along(s, i, j, -1, 0));
        out->x_max += part * (x + front_along(s, i, j, 1, 0));
        out->y_min += part * (y - front_along(s, i, j, 0, -1));
        out->y_max += part * (y + front_along(s, i, j, 0, 1));
        out->width_source += part * s->fracture.cells.width[from->cell[c]];
        out->pressure_source += part * s->fracture.cells.pressure[from->cell[c]];
    }
}

/* Extents from the zeros of the level along the rows and columns around cell (i, j), inside. */
static void extend(const ilsa_solver *s, int i, int j, ilsa_summary *out) {
    int nx = s->model.mesh.nx, cell = j * nx + i;
    const double *level = s->fracture.cells.level;
    double x = ilsai_mesh_x(&s->model.mesh, i), y = ilsai_mesh_y(&s->model.mesh, j),
           here = level[cell];
    double left = level[cell - 1], right = level[cell + 1];
    double down = level[cell - nx], up = level[cell + nx];
    if (left > 0) {
        out->extent_x_min = fmin(out->extent_x_min, x - crossing(here, left, s->model.mesh.dx));
    }
    if (right > 0) {
        out->extent_x_max = fmax(out->extent_x_max, x + crossing(here, right, s->model.mesh.dx));
    }
    if (down > 0) {
        out->extent_y_min = fmin(out->extent_y_min, y - crossing(here, down, s->model.mesh.dy));
    }
    if (up > 0) {
        out->extent_y_max = fmax(out->extent_y_max, y + crossing(here, up, s->model.mesh.dy));
    }
}

static void set_cells(const ilsa_solver *s, ilsa_summary *out) {
    const box *b = &s->fracture.footprint;
    out->closed_cells = ilsai_fracture_closed_cells(&s->fracture, &s->model);
    out->closure_width = ilsai_fracture_closure_width(&s->fracture, &s->model);
    out->extent_x_min = out->extent_y_min = INFINITY;
    out->extent_x_max = out->extent_y_max = -INFINITY;
    for (int j = b->y0; j <= b->y1; j++) {
        for (int i = b->x0; i <= b->x1; i++) {
            int cell = j * s->model.mesh.nx + i, kind = s->fracture.cells.kind[cell];
            out->cells += kind != ILSA_CELL_EMPTY;
            out->tip_cells += kind == ILSA_CELL_TIP;
            if (kind == ILSA_CELL_SURVEY) {
                out->survey_cells++;
                out->arrested_cells += !(s->fracture.cells.speed[cell] > 0);
                out->V_max = fmax(out->V_max, s->fracture.cells.speed[cell]);
            }
            if (kind != ILSA_CELL_EMPTY && s->fracture.cells.level[cell] <= 0) {
                extend(s, i, j, out);
            }
        }
    }
}

ilsa_status ilsa_get_summary(const ilsa_solver *solver, ilsa_summary *summary) {
    ILSAI_TRY(readable(solver, summary, "summary"));
    ilsa_summary out = {.time = solver->fracture.time};
    set_lines(solver, &out);
    set_cells(solver, &out);
    out.volume_injected = solver->fracture.injected;
    out.volume_fracture = solver->fracture.volume;
    out.volume_leaked = solver->fracture.leaked;
    out.efficiency = out.volume_injected > 0 ? out.volume_fracture / out.volume_injected : 1;
    out.unknowns = solver->fracture.unknowns;
    out.total = solver->total;
    out.total.time = solver->fracture.time;
    *summary = out;
    return ILSA_OK;
}

ilsa_status ilsa_get_model(const ilsa_solver *solver, ilsa_model *out) {
    ILSAI_TRY(readable(solver, out, "model"));
    const model *m = &solver->model;
    const fracture *f = &solver->fracture;
    grid g = ilsai_model_grid(m, f->mirror_x, f->mirror_y);
    *out = (ilsa_model){.leak_off = ilsai_model_leaks(m),
                        .toughness = m->material.K_prime > 0,
                        .stress_varies = !m->sigma_is_uniform,
                        .tip = m->options.tip,
                        .symmetry = g.mirror_x && g.mirror_y ? ILSA_SYMMETRY_XY
                                    : g.mirror_x             ? ILSA_SYMMETRY_X
                                    : g.mirror_y             ? ILSA_SYMMETRY_Y
                                                             : ILSA_SYMMETRY_NONE,
                        .product = solver->numerics.elastic->product,
                        .level = m->options.level,
                        .threads = m->options.threads > 1 ? m->options.threads : 1,
                        .step_cells = solver->numerics.step_cells,
                        .tolerance = solver->numerics.tolerance};
    return ILSA_OK;
}

ilsa_status ilsa_get_profile(const ilsa_solver *solver, ilsa_profile *profile) {
    ILSAI_TRY(readable(solver, profile, "profile"));
    *profile = solver->profile;
    return ILSA_OK;
}

ilsa_status ilsa_get_mesh_def(const ilsa_solver *solver, ilsa_mesh_def *def) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "solver", solver);
    ILSAI_TRY(ilsai_fail_reading(status ? status : ilsai_check_pointer(error, "def", def)));
    *def = solver->model.mesh;
    return ILSA_OK;
}
