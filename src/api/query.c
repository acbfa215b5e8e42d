/* What a host reads off a solver: fields without a copy, and numbers for the whole fracture. */
#include "step/state.h"

#include <math.h>

/* The checks that every reading starts with. */
static ilsa_status readable(const ilsa_solver *s, const void *out, const char *name) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "solver", s);
    status = status ? status : ilsai_check_pointer(error, name, out);
    return status ? status : ilsai_check_started(s, error);
}

ilsa_status ilsa_get_time(const ilsa_solver *solver, double *time) {
    ilsa_status status = readable(solver, time, "time");
    if (status == ILSA_OK) {
        *time = solver->now.time;
    }
    return status;
}

static ilsa_status get_field(const ilsa_solver *s, const double *field, const char *name,
                             const double **out) {
    ilsa_status status = readable(s, out, name);
    if (status == ILSA_OK) {
        *out = field;
    }
    return status;
}

ilsa_status ilsa_get_width(const ilsa_solver *solver, const double **width) {
    return get_field(solver, solver ? solver->field.width : NULL, "width", width);
}

ilsa_status ilsa_get_pressure(const ilsa_solver *solver, const double **pressure) {
    return get_field(solver, solver ? solver->field.pressure : NULL, "pressure", pressure);
}

ilsa_status ilsa_get_stress(const ilsa_solver *solver, const double **stress) {
    return get_field(solver, solver ? solver->sigma : NULL, "stress", stress);
}

ilsa_status ilsa_get_trigger_time(const ilsa_solver *solver, const double **trigger) {
    return get_field(solver, solver ? solver->field.trigger : NULL, "trigger", trigger);
}

ilsa_status ilsa_get_cell_kinds(const ilsa_solver *solver, const unsigned char **kind) {
    ilsa_status status = readable(solver, kind, "kind");
    if (status == ILSA_OK) {
        *kind = solver->field.kind;
    }
    return status;
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
    double d = di ? s->mesh.dx : s->mesh.dy, distance = 0;
    const double *level = s->field.level;
    for (;;) {
        int ni = i + di, nj = j + dj;
        double here = level[j * s->mesh.nx + i];
        if (ni < 0 || ni >= s->mesh.nx || nj < 0 || nj >= s->mesh.ny) {
            return distance;
        }
        if (level[nj * s->mesh.nx + ni] > 0) {
            return distance + crossing(here, level[nj * s->mesh.nx + ni], d);
        }
        distance += d;
        i = ni;
        j = nj;
    }
}

/* The paper's half-length and height: mean over the source's cells, in case it feeds several. */
static void set_lines(const ilsa_solver *s, ilsa_summary *out) {
    const point_source *from = &s->sources[0];
    for (int c = 0; c < from->count; c++) {
        int i = from->cell[c] % s->mesh.nx, j = from->cell[c] / s->mesh.nx;
        double x = ilsai_mesh_x(&s->mesh, i), y = ilsai_mesh_y(&s->mesh, j), part = from->part[c];
        if (s->field.kind[from->cell[c]] < ILSA_CELL_SURVEY) {
            continue;
        }
        out->x_min += part * (x - front_along(s, i, j, -1, 0));
        out->x_max += part * (x + front_along(s, i, j, 1, 0));
        out->y_min += part * (y - front_along(s, i, j, 0, -1));
        out->y_max += part * (y + front_along(s, i, j, 0, 1));
        out->width_source += part * s->field.width[from->cell[c]];
        out->pressure_source += part * s->field.pressure[from->cell[c]];
    }
}

/* Extents from the zeros of the level along the rows and columns around cell (i, j), inside. */
static void extend(const ilsa_solver *s, int i, int j, ilsa_summary *out) {
    int nx = s->mesh.nx, cell = j * nx + i;
    const double *level = s->field.level;
    double x = ilsai_mesh_x(&s->mesh, i), y = ilsai_mesh_y(&s->mesh, j), here = level[cell];
    double left = level[cell - 1], right = level[cell + 1];
    double down = level[cell - nx], up = level[cell + nx];
    if (left > 0) {
        out->extent_x_min = fmin(out->extent_x_min, x - crossing(here, left, s->mesh.dx));
    }
    if (right > 0) {
        out->extent_x_max = fmax(out->extent_x_max, x + crossing(here, right, s->mesh.dx));
    }
    if (down > 0) {
        out->extent_y_min = fmin(out->extent_y_min, y - crossing(here, down, s->mesh.dy));
    }
    if (up > 0) {
        out->extent_y_max = fmax(out->extent_y_max, y + crossing(here, up, s->mesh.dy));
    }
}

static void set_cells(const ilsa_solver *s, ilsa_summary *out) {
    const box *b = &s->now.footprint;
    out->closed_cells = ilsai_closed_cells(s);
    out->closure_width = ilsai_closure_width(s);
    out->extent_x_min = out->extent_y_min = INFINITY;
    out->extent_x_max = out->extent_y_max = -INFINITY;
    for (int j = b->y0; j <= b->y1; j++) {
        for (int i = b->x0; i <= b->x1; i++) {
            int cell = j * s->mesh.nx + i, kind = s->field.kind[cell];
            out->cells += kind != ILSA_CELL_EMPTY;
            out->tip_cells += kind == ILSA_CELL_TIP;
            if (kind == ILSA_CELL_SURVEY) {
                out->survey_cells++;
                out->arrested_cells += !(s->field.speed[cell] > 0);
                out->V_max = fmax(out->V_max, s->field.speed[cell]);
            }
            if (kind != ILSA_CELL_EMPTY && s->field.level[cell] <= 0) {
                extend(s, i, j, out);
            }
        }
    }
}

ilsa_status ilsa_get_summary(const ilsa_solver *solver, ilsa_summary *summary) {
    ilsa_status status = readable(solver, summary, "summary");
    if (status != ILSA_OK) {
        return status;
    }
    ilsa_summary out = {.time = solver->now.time};
    set_lines(solver, &out);
    set_cells(solver, &out);
    out.volume_injected = solver->now.injected;
    out.volume_fracture = solver->now.fracture;
    out.volume_leaked = solver->now.leaked;
    out.efficiency = out.volume_injected > 0 ? out.volume_fracture / out.volume_injected : 1;
    out.unknowns = solver->now.unknowns;
    out.total = solver->total;
    out.total.time = solver->now.time;
    *summary = out;
    return ILSA_OK;
}

ilsa_status ilsa_get_model(const ilsa_solver *solver, ilsa_model *model) {
    ilsa_status status = readable(solver, model, "model");
    if (status != ILSA_OK) {
        return status;
    }
    grid g = ilsai_solver_grid(solver);
    ilsa_model out = {.leak_off = ilsai_has_leakoff(solver),
                      .toughness = solver->material.K_prime > 0,
                      .tip = solver->def.tip,
                      .stress_varies = ilsai_stress_varies(solver->stress),
                      .level = solver->def.level,
                      .threads = solver->def.threads > 1 ? solver->def.threads : 1,
                      .step_cells = solver->step_cells,
                      .tolerance = solver->tolerance};
    out.symmetry = g.mirror_x && g.mirror_y ? ILSA_SYMMETRY_XY
                   : g.mirror_x             ? ILSA_SYMMETRY_X
                   : g.mirror_y             ? ILSA_SYMMETRY_Y
                                            : ILSA_SYMMETRY_NONE;
    out.product = solver->elastic->product;
    *model = out;
    return ILSA_OK;
}

ilsa_status ilsa_get_profile(const ilsa_solver *solver, ilsa_profile *profile) {
    ilsa_status status = readable(solver, profile, "profile");
    if (status == ILSA_OK) {
        *profile = solver->profile;
    }
    return status;
}
