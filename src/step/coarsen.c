/*
 * The fracture moved to cells twice as large along x, y or both, the same number of them (end of
 * section 5.1).
 *
 * With an odd count a new cell covers one old cell and the halves of its two neighbours, with an
 * even count two old cells, along each axis that is coarsened. Along the other it covers one.
 */
#include "base/memory.h"
#include "base/tuning.h"
#include "model/mesh.h"
#include "step/solver.h"

#include <math.h>
#include <stdlib.h>

/* The old cells along one axis that a new one covers, and the part of each; the one or two of them
 * that its centre lies in or between. */
typedef struct cover {
    int first, count;
    double part[3];
    int centre, centres;
} cover;

static cover covered(int n, int factor, int i) {
    if (factor == 1) {
        return (cover){i, 1, {1}, i, 1};
    }
    if (n % 2 == 0) {
        int first = 2 * i - n / 2;
        return (cover){first, 2, {1, 1}, first, 2};
    }
    int middle = 2 * i - (n - 1) / 2;
    return (cover){middle - 1, 3, {0.5, 1, 0.5}, middle, 1};
}

/* The new fracture while it is being made. */
typedef struct coarse {
    const model *m;         /* the old model */
    const fracture *f;      /* the old fracture */
    int factor_x, factor_y; /* 1 or 2: how much larger the new cells are */
    /* The old level and velocity as the whole channel has them, and trigger times and their spread
     * as they are or will be; of its kinds those that the inward march reaches are empty. */
    fields known;
    ilsa_mesh_def mesh;
    fields field;
    tip_paths paths;
    box footprint;
    cell_field stress;
    elasticity *elastic;
} coarse;

static cover columns_under(const coarse *c, int i) {
    return covered(c->mesh.nx, c->factor_x, i);
}

static cover rows_under(const coarse *c, int j) {
    return covered(c->mesh.ny, c->factor_y, j);
}

static bool on_mesh(const ilsa_mesh_def *m, int i, int j) {
    return i >= 0 && i < m->nx && j >= 0 && j < m->ny;
}

/* The k-th of the covered cells to be summed: both ends first, so that the sums of cells that
 * mirror each other are equal. */
static int outside_in(const cover *c, int k) {
    return k == 0 ? 0 : k == 1 ? c->count - 1 : 1;
}

/* Area-weighted sum of an old field, or the area for NULL, over the wet cells under the new cell
 * (i, j), in old cells. */
static double sum_wet(const coarse *c, const double *field, int i, int j) {
    const ilsa_mesh_def *old = &c->m->mesh;
    cover across = columns_under(c, i), up = rows_under(c, j);
    double sum = 0;
    for (int k = 0; k < up.count; k++) {
        double row = 0;
        int b = outside_in(&up, k), oj = up.first + b;
        for (int m = 0; m < across.count; m++) {
            int a = outside_in(&across, m), oi = across.first + a, at = oj * old->nx + oi;
            if (on_mesh(old, oi, oj) && c->f->cells.kind[at] != ILSA_CELL_EMPTY) {
                row += across.part[a] * (field ? field[at] : 1);
            }
        }
        sum += up.part[b] * row;
    }
    return sum;
}

static double on_old(const coarse *c, const double *field, int i, int j) {
    return on_mesh(&c->m->mesh, i, j) ? field[j * c->m->mesh.nx + i] : INFINITY;
}

/* Beyond the last level kept, and off the mesh, it is a cell more than beside it. */
static double old_level(const coarse *c, int i, int j) {
    const double *level = c->known.level;
    double dx = c->m->mesh.dx, dy = c->m->mesh.dy, here = on_old(c, level, i, j);
    double x = fmin(on_old(c, level, i - 1, j), on_old(c, level, i + 1, j)) + dx;
    double y = fmin(on_old(c, level, i, j - 1), on_old(c, level, i, j + 1)) + dy;
    return isfinite(here) ? here : fmin(x, y);
}

/* What is known of a field in the old cell (i, j), which may be off the mesh; infinite where
 * nothing is. */
static double old_value(const coarse *c, int row, int i, int j) {
    return row == FIELD_level ? old_level(c, i, j) : on_old(c, ilsai_field(&c->known, row), i, j);
}

/* Mean of the finite values in the old cells around the new centre. */
static double at_centre(const coarse *c, int row, int i, int j) {
    cover across = columns_under(c, i), up = rows_under(c, j);
    int found = 0;
    double sum = 0;
    for (int b = up.centre; b < up.centre + up.centres; b++) {
        double line = 0;
        for (int a = across.centre; a < across.centre + across.centres; a++) {
            double here = old_value(c, row, a, b);
            line += isfinite(here) ? here : 0;
            found += isfinite(here);
        }
        sum += line;
    }
    return found > 0 ? sum / found : INFINITY;
}

/* How far into the channel distances are measured anew. */
static double depth(const coarse *c) {
    return ILSAI_COARSEN_REACH * hypot(c->mesh.dx, c->mesh.dy);
}

/*
 * Distances and velocities in the channel behind the survey cells: the march turned inwards. The
 * new survey cells lie up to three old cells further back than the old ones.
 */
static ilsa_status measure_inwards(coarse *c, march *inwards) {
    const ilsa_mesh_def *mesh = &c->m->mesh;
    grid g = ilsai_grid(mesh, 0, 0);
    box region = ilsai_fracture_region(mesh, &c->f->footprint);
    survey_cell *survey_cells = ilsai_allocate(ilsai_mesh_cells(mesh), sizeof *survey_cells);
    if (!survey_cells) {
        return ILSA_ERR_MEMORY;
    }
    int count = 0;
    for (int j = region.y0; j <= region.y1; j++) {
        for (int i = region.x0; i <= region.x1; i++) {
            int cell = ilsai_grid_cell(&g, i, j), kind = c->f->cells.kind[cell];
            c->known.kind[cell] = kind == ILSA_CELL_CHANNEL ? ILSA_CELL_EMPTY : ILSA_CELL_CHANNEL;
            if (kind == ILSA_CELL_SURVEY) {
                survey_cells[count++] = (survey_cell){.cell = cell,
                                                      .s = c->f->cells.level[cell],
                                                      .V = c->f->cells.speed[cell],
                                                      .w = 1};
            }
        }
    }
    ilsa_status status = ilsai_march_run(inwards, &g, &region, c->known.kind, survey_cells, count,
                                         depth(c), c->known.level);
    ilsai_release(survey_cells);
    return status;
}

/* When the front has passed the centre of a cell, or will at its present velocity. */
static double passing(const coarse *c, size_t cell) {
    const fields *old = &c->f->cells;
    double level = old->level[cell], V = old->speed[cell];
    return isfinite(old->trigger[cell]) ? old->trigger[cell]
           : level > 0 && V > 0         ? c->f->time + level / V
                                        : INFINITY;
}

/* Spread of the trigger time over a cell that is full, or as it will be at its present velocity. */
static double spreading(const coarse *c, size_t cell) {
    const fields *old = &c->f->cells;
    double V = old->speed[cell];
    return ilsai_is_channel(old->kind[cell]) ? old->spread[cell]
           : V > 0 ? fmin(0.25 * (c->m->mesh.dx + c->m->mesh.dy) / V, c->f->time)
                   : INFINITY;
}

/*
 * Levels and velocities with the inward march in place of what the channel's last were, which are
 * of any age; cells that it did not reach lie deep in the channel.
 */
static void level_all(coarse *c, const march *inwards) {
    int count;
    const front_cell *cells = ilsai_march_cells(inwards, &count);
    const fields *old = &c->f->cells;
    size_t all = ilsai_mesh_cells(&c->m->mesh);
    for (size_t k = 0; k < all; k++) {
        bool channel = old->kind[k] == ILSA_CELL_CHANNEL;
        c->known.level[k] = channel ? -depth(c) : old->level[k];
        c->known.speed[k] = old->speed[k];
        if (old->trigger) {
            c->known.trigger[k] = passing(c, k);
            c->known.spread[k] = spreading(c, k);
        }
    }
    for (int k = 0; k < count; k++) {
        c->known.level[cells[k].cell] = -cells[k].T;
        c->known.speed[cells[k].cell] = cells[k].V;
    }
}

static double on_new(const coarse *c, const double *field, int i, int j) {
    return on_mesh(&c->mesh, i, j) ? field[j * c->mesh.nx + i] : INFINITY;
}

/* Slope of a field of the new cells along one axis, central where both sides are known. */
static double slope(const coarse *c, const double *field, int i, int j, int di, int dj) {
    double here = on_new(c, field, i, j), ahead = on_new(c, field, i + di, j + dj);
    double behind = on_new(c, field, i - di, j - dj), d = di ? c->mesh.dx : c->mesh.dy;
    if (isfinite(ahead) && isfinite(behind)) {
        return fabs(ahead - behind) / (2 * d);
    }
    return isfinite(ahead)    ? fabs(ahead - here) / d
           : isfinite(behind) ? fabs(here - behind) / d
                              : 0;
}

/* The front in the new cell (i, j). */
static front_cell front_in(const coarse *c, int i, int j) {
    const double *level = c->field.level;
    front_cell f = {.cell = j * c->mesh.nx + i, .T = on_new(c, level, i, j)};
    double x = slope(c, level, i, j, 1, 0), y = slope(c, level, i, j, 0, 1), norm = hypot(x, y);
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
    const ilsa_mesh_def *old = &c->m->mesh;
    cover across = columns_under(c, i), up = rows_under(c, j);
    int count = 0;
    for (int b = up.first; b < up.first + up.count; b++) {
        for (int a = across.first; a < across.first + across.count; a++) {
            int at = b * old->nx + a;
            if (!on_mesh(old, a, b) || !(c->f->cells.trigger[at] < c->f->time)) {
                continue;
            }
            knot k = {c->f->cells.trigger[at], f->ell + c->known.level[at]};
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
    double now = c->f->time, ell = f->ell > 0 ? f->ell : 0;
    int count = passed_centres(c, f, i, j, knots);
    knot first = count > 0 ? knots[0] : (knot){now, ell};
    double since = f->V > 0 ? first.ell / f->V : now;
    double entered = first.t - fmax(since, ILSAI_DT_SMALLEST * now);
    tip_path *path = &c->paths.at[c->paths.count++];
    path->cell = f->cell;
    ilsai_tip_cell_enter(&path->history, entered > 0 ? entered : 0);
    for (int k = 0; k < count; k++) {
        if (knots[k].t > path->history.t[path->history.count - 1]) {
            ilsai_tip_cell_record(&path->history, knots[k].t, knots[k].ell);
        }
    }
    ilsai_tip_cell_record(&path->history, now, ell);
}

/* Samples the fields that a new cell takes at its centre: level, velocity, trigger time, spread. */
static void sample(coarse *c, int i, int j) {
    size_t cell = (size_t)j * (size_t)c->mesh.nx + (size_t)i;
    const fields *f = &c->field;
    for (int row = 0; row < FIELD_COUNT; row++) {
        double *values = ilsai_field(f, row);
        if (values && ilsai_field_rows[row].coarsened == COARSEN_CENTRE) {
            values[cell] = at_centre(c, row, i, j);
        }
    }
    f->speed[cell] = isfinite(f->speed[cell]) ? f->speed[cell] : 0; /* beyond the old mesh */
    if (f->trigger) {
        double t = fmin(f->trigger[cell], c->f->time);
        f->trigger[cell] = f->level[cell] <= 0 ? t : INFINITY;
    }
}

/* The trigger time is spread over a larger cell: along the axes on which it is, as far as the front
 * went along them. */
static void widen_spread(coarse *c, int i, int j) {
    const fields *f = &c->field;
    size_t cell = (size_t)j * (size_t)c->mesh.nx + (size_t)i;
    double x = c->mesh.dx * slope(c, f->trigger, i, j, 1, 0);
    double y = c->mesh.dy * slope(c, f->trigger, i, j, 0, 1);
    double before = hypot(x / c->factor_x, y / c->factor_y);
    double factor = before > 0 ? hypot(x, y) / before : 2;
    double spread = factor * f->spread[cell];
    double age = c->f->time - fmin(f->trigger[cell], c->f->time);
    f->spread[cell] = isfinite(spread) ? fmax(fmin(spread, age), 0) : 0;
}

/* Gives a new cell what the old cells under it hold: volumes are sums, so nothing is lost. */
static ilsa_status lay_cell(coarse *c, int i, int j) {
    double wet = sum_wet(c, NULL, i, j);
    if (wet <= 0) {
        return ILSA_OK;
    }
    front_cell front = front_in(c, i, j);
    int cell = front.cell;
    bool full = front.ell >= c->mesh.dx * front.cos_a + c->mesh.dy * front.sin_a;
    for (int row = 0; row < FIELD_COUNT; row++) {
        double *values = ilsai_field(&c->field, row);
        const double *old = ilsai_field(&c->f->cells, row);
        if (values && ilsai_field_rows[row].coarsened == COARSEN_SUM) {
            values[cell] = sum_wet(c, old, i, j) / (c->factor_x * c->factor_y);
        } else if (values && ilsai_field_rows[row].coarsened == COARSEN_WET_MEAN) {
            values[cell] = sum_wet(c, old, i, j) / wet;
        }
    }
    c->field.kind[cell] = full ? ILSA_CELL_CHANNEL : ILSA_CELL_TIP;
    ilsai_box_add(&c->footprint, i, j);
    if (c->field.trigger && !full) {
        ILSAI_TRY(ilsai_tip_paths_reserve(&c->paths, c->paths.count + 1));
        lay_path(c, &front, i, j);
    }
    if (c->field.trigger && full && !isfinite(c->field.trigger[cell])) {
        c->field.trigger[cell] = c->f->time;
    }
    return ILSA_OK;
}

/* The new cells that the old region's cells fall into. */
static box covering(const coarse *c) {
    box old = ilsai_fracture_region(&c->m->mesh, &c->f->footprint);
    int nx = c->mesh.nx, ny = c->mesh.ny;
    grid flat = ilsai_grid(&c->mesh, 0, 0);
    box b = old;
    if (c->factor_x == 2) {
        b.x0 = (old.x0 + (nx - 1) / 2) / 2 - 1;
        b.x1 = (old.x1 + nx / 2) / 2 + 1;
    }
    if (c->factor_y == 2) {
        b.y0 = (old.y0 + (ny - 1) / 2) / 2 - 1;
        b.y1 = (old.y1 + ny / 2) / 2 + 1;
    }
    return ilsai_box_widen(&flat, &b, 0, 0);
}

static ilsa_status lay(coarse *c) {
    grid flat = ilsai_grid(&c->mesh, 0, 0);
    box b = covering(c);
    for (int j = b.y0; j <= b.y1; j++) {
        for (int i = b.x0; i <= b.x1; i++) {
            sample(c, i, j);
        }
    }
    for (int j = b.y0; c->field.trigger && j <= b.y1; j++) {
        for (int i = b.x0; i <= b.x1; i++) {
            widen_spread(c, i, j);
        }
    }
    for (int j = b.y0; j <= b.y1; j++) {
        for (int i = b.x0; i <= b.x1; i++) {
            ILSAI_TRY(lay_cell(c, i, j));
        }
    }
    ilsai_fracture_find_survey(&flat, &c->footprint, c->field.kind);
    return ILSA_OK;
}

static void release(coarse *c) {
    ilsai_fields_destroy(&c->known);
    ilsai_fields_destroy(&c->field);
    ilsai_tip_paths_destroy(&c->paths);
    ilsai_cell_field_clear(&c->stress);
    ilsai_elasticity_destroy(&c->elastic);
}

static ilsa_status allocate(coarse *c) {
    size_t cells = ilsai_mesh_cells(&c->mesh);
    bool leaks = ilsai_model_leaks(c->m);
    ILSAI_TRY(ilsai_fields_create(&c->known, cells, FIELD_FRACTURE, leaks));
    ILSAI_TRY(ilsai_fields_create(&c->field, cells, FIELD_FRACTURE, leaks));
    ILSAI_TRY(ilsai_cell_field_copy(&c->m->stress, &c->stress));
    ILSAI_TRY(ilsai_cell_field_coarsen(&c->stress, c->factor_x, c->factor_y));
    return ilsai_elasticity_create(c->m->material.E_prime, c->mesh.dx, c->mesh.dy,
                                   c->m->options.product, &c->elastic);
}

static ilsa_status make(coarse *c, march *inwards) {
    ILSAI_TRY(allocate(c));
    ILSAI_TRY(measure_inwards(c, inwards));
    level_all(c, inwards);
    return lay(c);
}

/* The new fracture takes the old one's place, which is left in c to be released. */
static void exchange(ilsa_solver *s, coarse *c) {
    fracture *f = &s->fracture;
    coarse old = {.known = c->known,
                  .field = f->cells,
                  .paths = f->paths,
                  .stress = s->model.stress,
                  .elastic = s->numerics.elastic};
    s->model.mesh = c->mesh;
    s->model.stress = c->stress;
    s->numerics.elastic = c->elastic;
    f->cells = c->field;
    f->paths = c->paths;
    f->footprint = c->footprint;
    s->pace.dt_limit = INFINITY;
    ilsai_sources_place(&s->model.sources, &s->model.mesh);
    *c = old;
}

/* The cells of the footprint along the axis of those to be coarsened that has the fewest. */
static int fewest_across(const box *b, int directions) {
    int columns = b->x1 - b->x0 + 1, rows = b->y1 - b->y0 + 1;
    return directions == ILSA_ALONG_X   ? columns
           : directions == ILSA_ALONG_Y ? rows
           : columns < rows             ? columns
                                        : rows;
}

static ilsa_mesh_def coarser(const ilsa_mesh_def *mesh, int directions) {
    return (ilsa_mesh_def){mesh->nx, mesh->ny, mesh->dx * (directions & ILSA_ALONG_X ? 2 : 1),
                           mesh->dy * (directions & ILSA_ALONG_Y ? 2 : 1)};
}

static ilsa_status check(ilsa_solver *s, int directions) {
    ILSAI_TRY(ilsai_fracture_check(&s->fracture, &s->error));
    if (directions < ILSA_ALONG_X || directions > (ILSA_ALONG_X | ILSA_ALONG_Y)) {
        return ilsai_fail(&s->error, ILSA_ERR_VALUE,
                          "directions = %d: must be ILSA_ALONG_X, ILSA_ALONG_Y or both",
                          directions);
    }
    int across = fewest_across(&s->fracture.footprint, directions);
    if (across < 2 * ILSAI_COARSEN_LEAST) {
        return ilsai_fail(&s->error, ILSA_ERR_VALUE,
                          "the footprint is %d cells across: must be at least %d to coarsen",
                          across, 2 * ILSAI_COARSEN_LEAST);
    }
    ilsa_mesh_def mesh = coarser(&s->model.mesh, directions);
    return ilsai_mesh_check(&mesh, &s->error);
}

ilsa_status ilsa_coarsen_along(ilsa_solver *solver, int directions) {
    if (!solver) {
        return ilsai_check_pointer(ilsai_thread_error(), "solver", solver);
    }
    ILSAI_TRY(check(solver, directions));
    const ilsa_mesh_def *mesh = &solver->model.mesh;
    coarse c = {.m = &solver->model,
                .f = &solver->fracture,
                .factor_x = directions & ILSA_ALONG_X ? 2 : 1,
                .factor_y = directions & ILSA_ALONG_Y ? 2 : 1,
                .mesh = coarser(mesh, directions),
                .footprint = {mesh->nx, -1, mesh->ny, -1}};
    ilsa_status status = make(&c, solver->numerics.march);
    if (status == ILSA_OK) {
        exchange(solver, &c);
        status = ilsai_model_fill_stress(&solver->model);
    }
    release(&c);
    return status == ILSA_OK ? ILSA_OK
                             : ilsai_fail(&solver->error, status, "no memory to coarsen the mesh");
}

ilsa_status ilsa_coarsen(ilsa_solver *solver) {
    return ilsa_coarsen_along(solver, ILSA_ALONG_X | ILSA_ALONG_Y);
}
