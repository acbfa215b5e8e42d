/*
 * The state moved to cells twice as large, the same number of them (end of section 5.1).
 *
 * With an odd count a new cell covers one old cell and the halves of its two neighbours, with an
 * even count two old cells, along each axis.
 */
#include "base/tuning.h"
#include "step/state.h"
#include "step/step.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The old cells along one axis that a new one covers, and the part of each. */
typedef struct cover {
    int first, count;
    double part[3];
} cover;

static cover covered(int n, int i) {
    cover c = {.first = 2 * i - (n - 1) / 2 - 1, .count = 3, .part = {0.5, 1, 0.5}};
    if (n % 2 == 0) {
        c = (cover){.first = 2 * i - n / 2, .count = 2, .part = {1, 1}};
    }
    return c;
}

/* The new state while it is being made. */
typedef struct coarse {
    const ilsa_solver *s; /* the old one; its trial has the levels all through the channel, its
                             leak when the front has passed each centre, or will */
    ilsa_mesh_def mesh;
    fields field;
    tip_records tips;
    box footprint;
    ilsa_stress *stress;
    elasticity *elastic;
} coarse;

/* What happens to each old cell (its index, and the part of it) under a new one. */
typedef struct sums {
    double width, leaked, pressure, wet;
} sums;

static int on_mesh(const ilsa_mesh_def *m, int i, int j) {
    return i >= 0 && i < m->nx && j >= 0 && j < m->ny;
}

static void add(sums *to, double part, sums from) {
    to->width += part * from.width;
    to->leaked += part * from.leaked;
    to->pressure += part * from.pressure;
    to->wet += part * from.wet;
}

/* The k-th of the covered cells to be summed: both ends first, so that the sums of cells that
 * mirror each other are equal. */
static int outside_in(const cover *c, int k) {
    return k == 0 ? 0 : k == 1 ? c->count - 1 : 1;
}

/* Area-weighted sums of the old fields over the new cell (i, j), in old cells. */
static sums gather(const coarse *c, int i, int j) {
    const ilsa_mesh_def *old = &c->s->mesh;
    const fields *f = &c->s->field;
    cover across = covered(old->nx, i), up = covered(old->ny, j);
    sums sum = {0, 0, 0, 0};
    for (int k = 0; k < up.count; k++) {
        sums row = {0, 0, 0, 0};
        int b = outside_in(&up, k), oj = up.first + b;
        for (int m = 0; m < across.count; m++) {
            int a = outside_in(&across, m), oi = across.first + a, at = oj * old->nx + oi;
            if (on_mesh(old, oi, oj) && f->kind[at] != ILSA_CELL_EMPTY) {
                double leaked = f->leaked ? f->leaked[at] : 0;
                add(&row, across.part[a], (sums){f->width[at], leaked, f->pressure[at], 1});
            }
        }
        add(&sum, up.part[b], row);
    }
    return sum;
}

/* What is known of the old cell (i, j), which may be off the mesh; infinite where nothing is. */
typedef double old_value(const coarse *c, int i, int j);

static double on_old(const coarse *c, const double *field, int i, int j) {
    return on_mesh(&c->s->mesh, i, j) ? field[j * c->s->mesh.nx + i] : INFINITY;
}

/* Beyond the last level kept, and off the mesh, it is a cell more than beside it. */
static double old_level(const coarse *c, int i, int j) {
    const double *level = c->s->trial.level;
    double dx = c->s->mesh.dx, dy = c->s->mesh.dy, here = on_old(c, level, i, j);
    double x = fmin(on_old(c, level, i - 1, j), on_old(c, level, i + 1, j)) + dx;
    double y = fmin(on_old(c, level, i, j - 1), on_old(c, level, i, j + 1)) + dy;
    return isfinite(here) ? here : fmin(x, y);
}

static double old_speed(const coarse *c, int i, int j) {
    return on_old(c, c->s->trial.speed, i, j);
}

static double old_passing(const coarse *c, int i, int j) {
    return on_old(c, c->s->leak, i, j);
}

static double old_spread(const coarse *c, int i, int j) {
    return on_old(c, c->s->self_correction, i, j);
}

/* Mean of the finite values in the old cells around the new centre. */
static double at_centre(const coarse *c, old_value *value, int i, int j) {
    const ilsa_mesh_def *old = &c->s->mesh;
    int odd_x = old->nx % 2, odd_y = old->ny % 2, found = 0;
    int first_x = covered(old->nx, i).first + odd_x, first_y = covered(old->ny, j).first + odd_y;
    double sum = 0;
    for (int b = first_y; b < first_y + 2 - odd_y; b++) {
        double row = 0;
        for (int a = first_x; a < first_x + 2 - odd_x; a++) {
            double here = value(c, a, b);
            row += isfinite(here) ? here : 0;
            found += isfinite(here);
        }
        sum += row;
    }
    return found > 0 ? sum / found : INFINITY;
}

/* How far into the channel distances are measured anew. */
static double depth(const ilsa_solver *s) {
    return 2 * ILSAI_COARSEN_REACH * hypot(s->mesh.dx, s->mesh.dy);
}

/*
 * Distances and velocities in the channel behind the survey cells: the march turned inwards. The
 * new survey cells lie up to three old cells further back than the old ones.
 */
static ilsa_status measure_inwards(ilsa_solver *s) {
    grid g = ilsai_grid(&s->mesh, 0, 0);
    box region = ilsai_solver_region(s, &s->now.footprint);
    survey_cell *survey_cells = malloc(ilsai_mesh_cells(&s->mesh) * sizeof *survey_cells);
    if (!survey_cells) {
        return ILSA_ERR_MEMORY;
    }
    int count = 0;
    for (int j = region.y0; j <= region.y1; j++) {
        for (int i = region.x0; i <= region.x1; i++) {
            int cell = ilsai_grid_cell(&g, i, j), kind = s->field.kind[cell];
            s->trial.kind[cell] = kind == ILSA_CELL_CHANNEL ? ILSA_CELL_EMPTY : ILSA_CELL_CHANNEL;
            if (kind == ILSA_CELL_SURVEY) {
                survey_cell survey = {.cell = cell, .s = s->field.level[cell], .w = 1};
                survey.V = s->field.speed[cell];
                survey_cells[count++] = survey;
            }
        }
    }
    ilsa_status status = ilsai_march_run(s->march, &g, &region, s->trial.kind, survey_cells, count,
                                         depth(s), s->source_term);
    free(survey_cells);
    return status;
}

/* When the front has passed the centre of a cell, or will at its present speed. */
static double passing(const ilsa_solver *s, size_t cell) {
    double level = s->field.level[cell], V = s->field.speed[cell];
    return isfinite(s->field.trigger[cell]) ? s->field.trigger[cell]
           : level > 0 && V > 0             ? s->now.time + level / V
                                            : INFINITY;
}

/* Spread of the trigger time over a cell that is full, or as it will be at its present speed. */
static double spreading(const ilsa_solver *s, size_t cell) {
    double V = s->field.speed[cell];
    return s->field.kind[cell] >= ILSA_CELL_SURVEY ? s->field.spread[cell]
           : V > 0 ? fmin(0.25 * (s->mesh.dx + s->mesh.dy) / V, s->now.time)
                   : INFINITY;
}

/*
 * Levels and speeds with the inward march in place of what the channel's last were, which are of
 * any age; cells that it did not reach lie deep in the channel.
 */
static void level_all(ilsa_solver *s) {
    int count;
    const front_cell *cells = ilsai_march_cells(s->march, &count);
    size_t all = ilsai_mesh_cells(&s->mesh);
    memcpy(s->trial.speed, s->field.speed, all * sizeof(double));
    for (size_t k = 0; k < all; k++) {
        int channel = s->field.kind[k] == ILSA_CELL_CHANNEL;
        s->trial.level[k] = channel ? -depth(s) : s->field.level[k];
        s->leak[k] = ilsai_has_leakoff(s) ? passing(s, k) : 0;
        s->self_correction[k] = ilsai_has_leakoff(s) ? spreading(s, k) : 0;
    }
    for (int k = 0; k < count; k++) {
        s->trial.level[cells[k].cell] = -cells[k].T;
        s->trial.speed[cells[k].cell] = cells[k].V;
    }
}

static double level_at(const coarse *c, int i, int j) {
    return on_mesh(&c->mesh, i, j) ? c->field.level[j * c->mesh.nx + i] : INFINITY;
}

/* Difference of the new level along one axis, central where both sides are known. */
static double slope(const coarse *c, int i, int j, int di, int dj) {
    double here = level_at(c, i, j), ahead = level_at(c, i + di, j + dj);
    double behind = level_at(c, i - di, j - dj), d = di ? c->mesh.dx : c->mesh.dy;
    if (isfinite(ahead) && isfinite(behind)) {
        return fabs(ahead - behind) / (2 * d);
    }
    return isfinite(ahead)    ? fabs(ahead - here) / d
           : isfinite(behind) ? fabs(here - behind) / d
                              : 0;
}

/* The front in the new cell (i, j). */
static front_cell front_in(const coarse *c, int i, int j) {
    front_cell f = {.cell = j * c->mesh.nx + i, .T = level_at(c, i, j)};
    double x = slope(c, i, j, 1, 0), y = slope(c, i, j, 0, 1), norm = hypot(x, y);
    f.cos_a = norm > 0 ? x / norm : 1;
    f.sin_a = norm > 0 ? y / norm : 0;
    f.ell = 0.5 * (c->mesh.dx * f.cos_a + c->mesh.dy * f.sin_a) - f.T;
    f.V = c->field.speed[f.cell];
    return f;
}

/* A place on the path of the front through a cell. */
typedef struct knot {
    double t, ell;
} knot;

static int by_time(const void *a, const void *b) {
    double p = ((const knot *)a)->t, q = ((const knot *)b)->t;
    return (p > q) - (p < q);
}

/*
 * Where the front was when it passed the centres of the old cells under a new tip cell: a centre
 * that is now at level T had the front -T further back than it is now. Returns how many.
 */
static int passed_centres(const coarse *c, const front_cell *f, int i, int j, knot knots[9]) {
    const ilsa_mesh_def *old = &c->s->mesh;
    cover across = covered(old->nx, i), up = covered(old->ny, j);
    int count = 0;
    for (int b = up.first; b < up.first + up.count; b++) {
        for (int a = across.first; a < across.first + across.count; a++) {
            int at = b * old->nx + a;
            if (!on_mesh(old, a, b) || !(c->s->field.trigger[at] < c->s->now.time)) {
                continue;
            }
            knot k = {c->s->field.trigger[at], f->ell + c->s->trial.level[at]};
            if (k.ell > 0 && k.ell < f->ell) {
                knots[count++] = k;
            }
        }
    }
    qsort(knots, (size_t)count, sizeof *knots, by_time);
    return count;
}

/* The velocity history of a new tip cell. */
static void lay_path(coarse *c, const front_cell *f, int i, int j) {
    knot knots[9];
    double now = c->s->now.time, ell = f->ell > 0 ? f->ell : 0;
    int count = passed_centres(c, f, i, j, knots);
    knot first = count > 0 ? knots[0] : (knot){now, ell};
    double since = f->V > 0 ? first.ell / f->V : now;
    double entered = first.t - fmax(since, ILSAI_DT_SMALLEST * now);
    tip_record *record = &c->tips.at[c->tips.count++];
    record->cell = f->cell;
    ilsai_tip_cell_enter(&record->history, entered > 0 ? entered : 0);
    for (int k = 0; k < count; k++) {
        if (knots[k].t > record->history.t[record->history.count - 1]) {
            ilsai_tip_cell_record(&record->history, knots[k].t, knots[k].ell);
        }
    }
    ilsai_tip_cell_record(&record->history, now, ell);
}

/* Level, velocity and trigger time at the new centres, of the cells the front can be near. */
static void sample(coarse *c, const box *b) {
    for (int j = b->y0; j <= b->y1; j++) {
        for (int i = b->x0; i <= b->x1; i++) {
            int cell = j * c->mesh.nx + i;
            c->field.level[cell] = at_centre(c, old_level, i, j);
            double V = at_centre(c, old_speed, i, j);
            c->field.speed[cell] = isfinite(V) ? V : 0; /* beyond the old mesh */
            if (c->field.trigger) {
                double t = fmin(at_centre(c, old_passing, i, j), c->s->now.time);
                c->field.trigger[cell] = c->field.level[cell] <= 0 ? t : INFINITY;
                double spread = 2 * at_centre(c, old_spread, i, j);
                c->field.spread[cell] =
                    isfinite(spread) ? fmax(fmin(spread, c->s->now.time - t), 0) : 0;
            }
        }
    }
}

/* What the cell holds: volumes are the sums over the old cells, so nothing is lost. */
static ilsa_status lay_cell(coarse *c, int i, int j) {
    sums sum = gather(c, i, j);
    if (sum.wet <= 0) {
        return ILSA_OK;
    }
    front_cell f = front_in(c, i, j);
    int cell = f.cell;
    int full = f.ell >= c->mesh.dx * f.cos_a + c->mesh.dy * f.sin_a;
    c->field.kind[cell] = full ? ILSA_CELL_CHANNEL : ILSA_CELL_TIP;
    c->field.width[cell] = 0.25 * sum.width;
    c->field.pressure[cell] = sum.pressure / sum.wet;
    ilsai_box_add(&c->footprint, i, j);
    if (c->field.leaked) {
        c->field.leaked[cell] = 0.25 * sum.leaked;
        if (!full) {
            if (ilsai_asymptote_records_reserve(&c->tips, c->tips.count + 1) != ILSA_OK) {
                return ILSA_ERR_MEMORY;
            }
            lay_path(c, &f, i, j);
        }
        int passed = full && !isfinite(c->field.trigger[cell]);
        c->field.trigger[cell] = passed ? c->s->now.time : c->field.trigger[cell];
    }
    return ILSA_OK;
}

/* The new cells that the old region's cells fall into. */
static box covering(const coarse *c) {
    box old = ilsai_solver_region(c->s, &c->s->now.footprint);
    int nx = c->mesh.nx, ny = c->mesh.ny;
    box b = {(old.x0 + (nx - 1) / 2) / 2 - 1, (old.x1 + nx / 2) / 2 + 1,
             (old.y0 + (ny - 1) / 2) / 2 - 1, (old.y1 + ny / 2) / 2 + 1};
    grid flat = ilsai_grid(&c->mesh, 0, 0);
    return ilsai_box_widen(&flat, &b, 0, 0);
}

static ilsa_status lay(coarse *c) {
    grid flat = ilsai_grid(&c->mesh, 0, 0);
    box b = covering(c);
    sample(c, &b);
    for (int j = b.y0; j <= b.y1; j++) {
        for (int i = b.x0; i <= b.x1; i++) {
            ilsa_status status = lay_cell(c, i, j);
            if (status != ILSA_OK) {
                return status;
            }
        }
    }
    ilsai_step_classify(&flat, &c->footprint, c->field.kind);
    return ILSA_OK;
}

static void release(coarse *c) {
    ilsai_fields_destroy(&c->field);
    free(c->tips.at);
    ilsa_stress_destroy(&c->stress);
    ilsai_elasticity_destroy(&c->elastic);
}

static ilsa_status allocate(coarse *c) {
    const ilsa_solver *s = c->s;
    ilsa_status status = ilsai_fields_create(&c->field, &c->mesh, ilsai_has_leakoff(s));
    status = status ? status : ilsai_stress_copy(s->stress, &c->stress);
    status = status ? status : ilsai_stress_coarsen(c->stress);
    return status ? status
                  : ilsai_elasticity_create(s->material.E_prime, c->mesh.dx, c->mesh.dy,
                                            s->def.product, &c->elastic);
}

/* The new state takes the old one's place, which is left in c to be released. */
static void exchange(ilsa_solver *s, coarse *c) {
    coarse old = *c;
    old.field = s->field;
    old.tips = s->tips;
    old.stress = s->stress;
    old.elastic = s->elastic;
    s->mesh = c->mesh;
    s->field = c->field;
    s->tips = c->tips;
    s->stress = c->stress;
    s->elastic = c->elastic;
    s->now.footprint = c->footprint;
    s->now.dt_limit = INFINITY;
    ilsai_sources_place(s);
    *c = old;
}

static ilsa_status check(ilsa_solver *s) {
    ilsa_status status = ilsai_check_started(s, &s->error);
    if (status != ILSA_OK) {
        return status;
    }
    const box *b = &s->now.footprint;
    int across = b->x1 - b->x0 < b->y1 - b->y0 ? b->x1 - b->x0 + 1 : b->y1 - b->y0 + 1;
    if (across < 2 * ILSAI_COARSEN_LEAST) {
        return ilsai_fail(&s->error, ILSA_ERR_VALUE,
                          "the footprint is %d cells across: must be at least %d to coarsen",
                          across, 2 * ILSAI_COARSEN_LEAST);
    }
    return ILSA_OK;
}

ilsa_status ilsa_coarsen(ilsa_solver *solver) {
    if (!solver) {
        return ilsai_check_pointer(ilsai_thread_error(), "solver", solver);
    }
    ilsa_status status = check(solver);
    if (status != ILSA_OK) {
        return status;
    }
    coarse c = {.s = solver, .mesh = solver->mesh};
    c.mesh.dx *= 2;
    c.mesh.dy *= 2;
    c.footprint = (box){c.mesh.nx, -1, c.mesh.ny, -1};
    status = allocate(&c);
    status = status ? status : measure_inwards(solver);
    if (status == ILSA_OK) {
        level_all(solver);
        status = lay(&c);
    }
    if (status == ILSA_OK) {
        exchange(solver, &c);
        status = ilsai_solver_fill_stress(solver);
    }
    release(&c);
    return status == ILSA_OK ? ILSA_OK
                             : ilsai_fail(&solver->error, status, "no memory to coarsen the mesh");
}
