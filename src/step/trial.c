#include "step/trial.h"

#include "base/memory.h"
#include "base/tuning.h"
#include "flow/contact.h"
#include "flow/leakoff.h"
#include "front/geometry.h"
#include "model/mesh.h"
#include <math.h>

ilsa_status ilsai_trial_create(trial *t, const model *m) {
    *t = (trial){0};
    return ilsai_fields_create(&t->cells, ilsai_mesh_cells(&m->mesh), FIELD_TRIAL,
                               ilsai_model_leaks(m));
}

void ilsai_trial_destroy(trial *t) {
    ilsai_fields_destroy(&t->cells);
    ilsai_tip_cells_destroy(&t->tips);
    ilsai_release(t->survey_cells);
    ilsai_release(t->distance);
    ilsai_release(t->next_distance);
}

/* ---- Survey cells ------------------------------------------------------------------------- */

static ilsa_status reserve_survey(trial *t, int count) {
    const grown_array arrays[] = {ILSAI_GROWN(t->survey_cells), ILSAI_GROWN(t->distance),
                                  ILSAI_GROWN(t->next_distance)};
    return ilsai_grow((size_t)count, &t->survey_capacity, arrays, 3);
}

/* Lists the survey cells as the last step left them. */
static ilsa_status find_survey(trial *t, const fracture *f) {
    box part = ilsai_box_fold(&t->g, &f->footprint);
    t->survey_count = 0;
    for (int j = part.y0; j <= part.y1; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&t->g, i, j);
            if (f->cells.kind[cell] != ILSA_CELL_SURVEY) {
                continue;
            }
            ILSAI_TRY(reserve_survey(t, t->survey_count + 1));
            t->survey_cells[t->survey_count++] =
                (survey_cell){.cell = cell,
                              .s0 = -f->cells.level[cell],
                              .h = ilsai_geometry_size(&t->g, f->cells.kind, i, j),
                              .V = f->cells.speed[cell],
                              .w = f->cells.width[cell]};
        }
    }
    return ILSA_OK;
}

typedef struct geometry_loop {
    const front_view *view;
    survey_cell *survey_cells;
} geometry_loop;

static void set_geometry(void *context, int first, int end) {
    const geometry_loop *l = context;
    ilsai_geometry_set(l->view, l->survey_cells + first, end - first);
}

/* ---- Channel cells ------------------------------------------------------------------------ */

/* A loop over the rows of the region. */
typedef struct row_loop {
    trial *t;
    const model *m;
    const fracture *f;
} row_loop;

/* Volume leaked per area from a channel cell in the step. */
static double channel_leakoff(const row_loop *l, int cell) {
    return ilsai_leakoff_channel(l->m->material.C_prime, l->f->time, l->t->dt,
                                 l->f->cells.trigger[cell], l->f->cells.spread[cell])
        .volume;
}

static void begin_rows(void *context, int first, int end) {
    const row_loop *l = context;
    fields *cells = &l->t->cells;
    const fields *old = &l->f->cells;
    box part = ilsai_box_fold(&l->t->g, &l->t->region);
    for (int j = part.y0 + first; j < part.y0 + end; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&l->t->g, i, j);
            bool channel = ilsai_is_channel(old->kind[cell]);
            cells->leakoff[cell] = channel && old->trigger ? channel_leakoff(l, cell) : 0;
            cells->source_term[cell] = -cells->leakoff[cell];
            cells->self_correction[cell] = 0;
            cells->contact[cell] =
                channel && ilsai_contact_closed(old->width[cell], l->t->closure_width)
                    ? CONTACT_CLOSED
                    : CONTACT_OPEN;
        }
    }
}

/*
 * A step so short that rounding moved its front leaves pressures in the tip cells that are of no
 * use as a first guess: those beyond any measure are forgotten.
 */
static void forget_wild_pressures(trial *t, const model *m, const fracture *f, const box *part) {
    double largest = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int j = part->y0; j <= part->y1; j++) {
            for (int i = part->x0; i <= part->x1; i++) {
                int cell = ilsai_grid_cell(&t->g, i, j);
                double net = fabs(f->cells.pressure[cell] - m->sigma[cell]);
                if (pass == 0 && ilsai_is_channel(f->cells.kind[cell])) {
                    largest = fmax(largest, net);
                } else if (pass == 1 && f->cells.kind[cell] == ILSA_CELL_TIP &&
                           net > ILSAI_PRESSURE_WILD * largest) {
                    t->cells.pressure[cell] = 0;
                }
            }
        }
    }
}

/* Bounds the pressures of tip cells by those of the channel as the last step left them. */
static void bound_tip_pressures(trial *t, const fracture *f, const numerics *n, const box *part) {
    double self = ilsai_elasticity_self_entry(n->elastic, part->x0, part->y0);
    t->tip_pressures = (tip_pressures){INFINITY, -INFINITY, ILSAI_TIP_REACH * f->width_most * self};
    for (int j = part->y0; j <= part->y1; j++) {
        for (int i = part->x0; i <= part->x1; i++) {
            int cell = ilsai_grid_cell(&t->g, i, j);
            if (ilsai_is_channel(f->cells.kind[cell])) {
                t->tip_pressures.low = fmin(t->tip_pressures.low, f->cells.pressure[cell]);
                t->tip_pressures.high = fmax(t->tip_pressures.high, f->cells.pressure[cell]);
            }
        }
    }
}

/* Adds what the sources inject in the step, each into the cells that it feeds. */
static ilsa_status add_sources(trial *t, const model *m, const fracture *f, error_text *error) {
    for (int k = 0; k < m->sources.count; k++) {
        const point_source *from = &m->sources.at[k];
        for (int c = 0; c < from->count; c++) {
            int cell = from->cell[c];
            if (from->def.rate > 0 && f->cells.kind[cell] == ILSA_CELL_EMPTY) {
                return ilsai_fail(error, ILSA_ERR_STATE,
                                  "source %d at (%g, %g) injects outside the fracture", k,
                                  from->def.x, from->def.y);
            }
            t->cells.source_term[cell] +=
                from->def.rate * from->part[c] * t->dt / (m->mesh.dx * m->mesh.dy);
        }
    }
    return ILSA_OK;
}

ilsa_status ilsai_trial_begin(trial *t, const model *m, const fracture *f, numerics *n, double dt,
                              error_text *error) {
    t->dt = dt;
    t->g = ilsai_model_grid(m, f->mirror_x, f->mirror_y);
    t->region = ilsai_fracture_region(&m->mesh, &f->footprint);
    t->closure_width = ilsai_fracture_closure_width(f, m);
    t->tips.paths.count = 0;
    t->tips.sensitivity_count = 0;
    ilsai_fields_copy(&t->cells, &f->cells, t->g.nx, &t->region);
    ILSAI_TRY(find_survey(t, f));
    ILSAI_TRY(ilsai_anderson_begin(n->acceleration, t->survey_count));
    const front_view view = {&t->g, f->cells.kind, f->cells.level,
                             m->sigma_is_uniform ? NULL : m->sigma, m->material.E_prime};
    geometry_loop survey = {&view, t->survey_cells};
    ilsai_thread_pool_run(n->threads, set_geometry, &survey, t->survey_count, ILSAI_SHARE_FRONT);
    box part = ilsai_box_fold(&t->g, &t->region);
    int columns = (int)ilsai_box_columns(&part), rows = (int)ilsai_box_rows(&part);
    row_loop channel = {t, m, f};
    ilsai_thread_pool_run(n->threads, begin_rows, &channel, rows,
                          1 + ILSAI_SHARE_CELLS / (columns + 1));
    ilsai_elasticity_make_self_terms(n->elastic);
    forget_wild_pressures(t, m, f, &part);
    bound_tip_pressures(t, f, n, &part);
    return add_sources(t, m, f, error);
}

/* ---- What a pass reads -------------------------------------------------------------------- */

survey_widths ilsai_trial_widths(const trial *t, const model *m, const numerics *n) {
    return (survey_widths){&m->tip_material, t->g.dx, t->g.dy, t->cells.width, n->tolerance};
}

front_pass ilsai_trial_pass(trial *t, const model *m, const fracture *f, const numerics *n) {
    return (front_pass){.g = &t->g,
                        .region = t->region,
                        .material = &m->material,
                        .elastic = n->elastic,
                        .velocity = n->velocity,
                        .time = f->time,
                        .dt = t->dt,
                        .closure_width = t->closure_width,
                        .old = &f->cells,
                        .old_paths = &f->paths,
                        .old_footprint = f->footprint,
                        .trial = &t->cells,
                        .widths = ilsai_trial_widths(t, m, n),
                        .survey_cells = t->survey_cells,
                        .survey_count = t->survey_count,
                        .marched = n->march,
                        .threads = n->threads};
}

bool ilsai_trial_is_open(const trial *t, int k) {
    return !ilsai_contact_closed(t->cells.width[t->survey_cells[k].cell], t->closure_width);
}

double ilsai_trial_advance(const trial *t) {
    double largest = 0;
    for (int k = 0; k < t->survey_count; k++) {
        double cells = (t->survey_cells[k].s - t->survey_cells[k].s0) / t->survey_cells[k].h;
        largest = cells > largest ? cells : largest;
    }
    return largest;
}

/* ---- Volumes ------------------------------------------------------------------------------ */

double ilsai_trial_leaked_from(const trial *t, int cell) {
    double retained = t->cells.retained ? t->cells.retained[cell] : 0;
    return t->cells.leakoff[cell] - fmin(retained, t->cells.leakoff[cell]);
}

static bool is_open_channel(const trial *t, int cell) {
    return ilsai_is_channel(t->cells.kind[cell]) &&
           !ilsai_contact_closed(t->cells.width[cell], t->closure_width);
}

trial_volumes ilsai_trial_volumes(const trial *t) {
    trial_volumes v = {0, 0, 0};
    box part = ilsai_box_fold(&t->g, &t->tips.footprint);
    int image[4];
    for (int j = part.y0; j <= part.y1; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&t->g, i, j);
            double area = ilsai_grid_images(&t->g, i, j, image) * t->g.dx * t->g.dy;
            if (t->cells.kind[cell] != ILSA_CELL_EMPTY) {
                *(is_open_channel(t, cell) ? &v.open : &v.held) += t->cells.width[cell] * area;
                v.leaked += ilsai_trial_leaked_from(t, cell) * area;
            }
        }
    }
    return v;
}

ilsa_status ilsai_trial_balance(trial *t, const model *m, const fracture *f) {
    trial_volumes v = ilsai_trial_volumes(t);
    double injected = f->injected + ilsai_sources_rate(&m->sources) * t->dt;
    double leaked = f->leaked + v.leaked;
    double volume = v.open > 0 ? injected - leaked : v.held;
    double off = fabs(injected - leaked - v.held - v.open);
    if (!(off < ILSAI_BALANCE_MAX * (v.open > 0 ? v.open : v.held))) {
        return ILSA_STEP_REJECTED;
    }
    double factor = v.open > 0 ? (volume - v.held) / v.open : 1;
    box part = ilsai_box_fold(&t->g, &t->tips.footprint);
    t->width_most = f->width_most;
    for (int j = part.y0; j <= part.y1; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&t->g, i, j);
            t->cells.width[cell] *= is_open_channel(t, cell) ? factor : 1;
            t->width_most = fmax(t->width_most, t->cells.width[cell]);
        }
    }
    t->injected = injected;
    t->leaked = injected - volume;
    t->volume = volume;
    return ILSA_OK;
}
