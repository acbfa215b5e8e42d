#include "front/tip_cells.h"

#include "base/memory.h"
#include "base/tuning.h"
#include "flow/contact.h"
#include "flow/leakoff.h"
#include "tip/asymptote.h"
#include <math.h>

void ilsai_tip_cells_destroy(tip_cells *t) {
    ilsai_tip_paths_destroy(&t->paths);
    ilsai_release(t->width_slopes);
    ilsai_release(t->sensitivities);
    *t = (tip_cells){0};
}

/* Replaces the leak-off of a cell in this step, in its source term too. */
static void set_leakoff(const front_pass *p, int cell, double leak) {
    p->trial->source_term[cell] += p->trial->leakoff[cell] - leak;
    p->trial->leakoff[cell] = leak;
}

/* Empties the cells that the pass before has wetted and the march no longer reaches. */
static ilsa_status drop_unreached(const front_pass *p) {
    box part = ilsai_box_fold(p->g, &p->region);
    for (int j = part.y0; j <= part.y1; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(p->g, i, j);
            if (isfinite(p->trial->level[cell]) || p->trial->kind[cell] == ILSA_CELL_EMPTY ||
                p->old->kind[cell] >= ILSA_CELL_SURVEY) {
                continue;
            }
            if (p->old->kind[cell] == ILSA_CELL_TIP) {
                return ILSA_STEP_REJECTED; /* a tip cell that the front no longer reaches */
            }
            p->trial->kind[cell] = ILSA_CELL_EMPTY;
            p->trial->width[cell] = 0;
            set_leakoff(p, cell, 0);
        }
    }
    return ILSA_OK;
}

/* The kind of a cell that the march has reached. Cells that were tip cells when the step began stay
 * wet. */
static unsigned char classify(const front_pass *p, const front_cell *c, bool hold) {
    double full = ilsai_march_full(p->g, c->cos_a, c->sin_a);
    unsigned char was = p->trial->kind[c->cell];
    if (hold && was != ILSA_CELL_EMPTY && fabs(c->ell - full) < ILSAI_HOLD * full) {
        return was;
    }
    if (c->ell >= full) {
        return ILSA_CELL_CHANNEL;
    }
    bool wet = c->ell > ILSAI_WET_MIN * ilsai_grid_h(p->g);
    return wet || p->old->kind[c->cell] == ILSA_CELL_TIP ? ILSA_CELL_TIP : ILSA_CELL_EMPTY;
}

/*
 * The path of the front in the cell up to the end of the step. The front at its start is where this
 * step's own march has it, so that what leaks in the step goes to nothing with the step.
 */
static tip_cell_history path_in_cell(const front_pass *p, const front_cell *c) {
    double t = p->time + p->dt;
    const tip_path *path = ilsai_tip_paths_find(p->old_paths, c->cell);
    tip_cell_history history;
    if (path) {
        double ell = fmax(c->ell, 0);
        history = path->history;
        ilsai_tip_cell_amend(&history, ell - fmax(c->V, 0) * p->dt, ell);
    } else {
        double since = c->V > 0 ? c->ell / c->V : p->dt;
        since = since > p->dt ? p->dt : since;
        since = since < 1e-6 * p->dt ? 1e-6 * p->dt : since;
        ilsai_tip_cell_enter(&history, t - since);
    }
    ilsai_tip_cell_record(&history, t, c->ell > 0 ? c->ell : 0);
    return history;
}

/* Leak-off (4.25) in the step, per area, if the front were where c has it, and its path. */
double ilsai_tip_cells_leakoff(const front_pass *p, const front_cell *c,
                               tip_cell_history *history) {
    tip_cell_front at = {c->ell, c->cos_a, c->sin_a, p->g->dx, p->g->dy};
    *history = path_in_cell(p, c);
    return ilsai_leakoff_tip(p->material->C_prime, p->velocity, &at, history).volume;
}

/* Whether c is a tip cell that no fluid comes to: all survey cells that place the front in it are
 * closed, and the front rests. */
static bool is_cut_off(const front_pass *p, const front_cell *c) {
    bool reached = p->trial->kind[c->cell] != ILSA_CELL_TIP;
    for (int k = 0; k < c->from.count; k++) {
        const survey_cell *survey = &p->survey_cells[c->from.survey[k]];
        reached |= p->trial->contact[survey->cell] == CONTACT_OPEN || survey->s > survey->s0;
    }
    return !reached;
}

/* Sets the leak-off of a cell and the path in it. A tip cell that is cut off leaks what it has over
 * the closure width. */
static void leak_at_front(const front_pass *p, const front_cell *c, tip_path *path) {
    path->cell = c->cell;
    double leak = ilsai_tip_cells_leakoff(p, c, &path->history);
    if (p->trial->contact[c->cell] == CONTACT_CUT_OFF) {
        leak = fmin(leak, fmax(p->old->width[c->cell] - p->closure_width, 0));
        p->trial->width[c->cell] = p->old->width[c->cell] - leak;
    }
    set_leakoff(p, c->cell, leak);
}

/*
 * Mean width (4.18), and its derivative: of a moving front by an advance within the step, which is
 * one of the velocity too; of one at rest by the logarithm of its stress intensity. In a cell that
 * has just filled it is the first guess of the coupled solve.
 */
typedef struct tip_width {
    double value;
    width_slopes slopes;
} tip_width;

/*
 * The part of the widths of its stress steps that a front is believed: in its survey cell they
 * cannot be more than all there is. A high barrier lets a front in by less than distances are known
 * to.
 */
static double step_belief(const front_pass *p, const survey_cell *survey) {
    double most = p->old->width[survey->cell];
    return survey->step_width > most ? most / survey->step_width : 1;
}

/*
 * Mean over the cell of what the steps of the stress behind its front add, as the survey cells see
 * them, and its derivatives: a front that has just passed a high step moves its width by its
 * distance to the step alone.
 */
static tip_width stress_step_width(const front_pass *p, const front_cell *c,
                                   const tip_cell_nodes *nodes) {
    tip_width sum = {0};
    for (int k = 0; k < c->from.count; k++) {
        const survey_cell *survey = &p->survey_cells[c->from.survey[k]];
        double belief = survey->step_count > 0 ? step_belief(p, survey) : 0;
        double given = belief * survey->step_share * c->from.weight[k] / (p->g->dx * p->g->dy);
        for (int m = 0; m < survey->step_count; m++) {
            step_depth d = ilsai_survey_step_depth(survey, m);
            tip_cell_step one = ilsai_tip_cell_step(d.value, nodes);
            double deeper = belief == 1 ? d.by_s * one.by_d : 0;
            sum.value += given * survey->step[m].height * one.volume;
            sum.slopes.advance += given * survey->step[m].height * one.by_ell;
            sum.slopes.past_steps[k] += given * survey->step[m].height * deeper;
        }
    }
    return sum;
}

static tip_width mean_width(const front_pass *p, const front_cell *c) {
    tip_cell_front at = {c->ell, c->cos_a, c->sin_a, p->g->dx, p->g->dy};
    double K_I = p->material->E_prime * c->K_num / c->K_den, V = c->V > 0 ? c->V : 0;
    double area = p->g->dx * p->g->dy;
    tip_cell_nodes nodes = ilsai_tip_cell_nodes(&at);
    tip_cell_growth growth = ilsai_tip_cell_growth(p->widths.tip_material, V, K_I, &nodes);
    tip_width w = {.value = growth.volume / area, .slopes = {.advance = growth.volume / area}};
    tip_width added = stress_step_width(p, c, &nodes);
    if (V > 0) {
        w.slopes = added.slopes;
        w.slopes.advance += growth.by_ell / area + growth.by_log_V / (area * V * p->dt);
    }
    w.value = fmax(w.value + added.value, ILSAI_STRESS_STEP_LEFT * w.value);
    return w;
}

/* A loop over what the march reached. */
typedef struct loop {
    tip_cells *t;
    const front_pass *p;
    const front_cell *reached;
    bool hold;
} loop;

/* Sets kind, velocity, width and leak-off of the k-th cell that the march reached, and its path. */
static void set_cell(tip_cells *t, const front_pass *p, const front_cell *c, bool hold, int k) {
    unsigned char was = p->trial->kind[c->cell], kind = classify(p, c, hold);
    p->trial->kind[c->cell] = kind;
    p->trial->speed[c->cell] = c->V;
    if (kind == ILSA_CELL_EMPTY) {
        p->trial->width[c->cell] = 0;
        set_leakoff(p, c->cell, 0);
        return;
    }
    if (kind == ILSA_CELL_TIP || was != ILSA_CELL_CHANNEL) {
        tip_width w = mean_width(p, c);
        bool cut_off = is_cut_off(p, c);
        p->trial->contact[c->cell] = cut_off ? CONTACT_CUT_OFF : CONTACT_OPEN;
        p->trial->width[c->cell] = cut_off ? p->old->width[c->cell] : w.value;
        t->width_slopes[k] = w.slopes;
    }
    if (p->material->C_prime > 0) {
        leak_at_front(p, c, &t->paths.at[k]);
    }
}

static void set_cells(void *context, int first, int end) {
    const loop *l = context;
    for (int k = first; k < end; k++) {
        set_cell(l->t, l->p, &l->reached[k], l->hold, k);
    }
}

/* What the self term of a cell that has filled in the step lacks. */
self_term ilsai_tip_cells_self_term(const front_pass *p, const front_cell *c) {
    double at = -c->T, V = c->V > 0 ? c->V : 0;
    double w = V > 0 ? ilsai_asymptote_width(p->widths.tip_material, V, at) : 1;
    self_term_front seen = {at, c->cos_a, c->sin_a,
                            ilsai_asymptote_exponent(p->widths.tip_material, V, at, w)};
    return ilsai_elasticity_self_term(p->elastic, c->cell % p->g->nx, c->cell / p->g->nx, &seen);
}

self_term ilsai_survey_self_term(const front_pass *p, const survey_cell *survey) {
    self_term_front seen = ilsai_survey_front(survey);
    return ilsai_elasticity_self_term(p->elastic, survey->cell % p->g->nx, survey->cell / p->g->nx,
                                      &seen);
}

static void set_survey_self_terms(void *context, int first, int end) {
    const front_pass *p = ((const loop *)context)->p;
    for (int k = first; k < end; k++) {
        p->trial->self_correction[p->survey_cells[k].cell] =
            ilsai_survey_self_term(p, &p->survey_cells[k]).value;
    }
}

static void set_filled_self_terms(void *context, int first, int end) {
    const loop *l = context;
    for (int k = first; k < end; k++) {
        const front_cell *c = &l->reached[k];
        int full = l->p->trial->kind[c->cell] >= ILSA_CELL_SURVEY;
        l->p->trial->self_correction[c->cell] = full ? ilsai_tip_cells_self_term(l->p, c).value : 0;
    }
}

/*
 * A tip cell without a pressure, as one wetted in this step, starts from its wet neighbours' that
 * are nearer to the channel, weighed as by the march: by the slope of the level over the distance.
 */
static void guess_pressure(const front_pass *p, const front_cell *c) {
    double sum = 0, weights = 0;
    for (int face = 0; face < GRID_FACES && p->trial->pressure[c->cell] == 0; face++) {
        int cell = ilsai_grid_neighbour(p->g, c->cell % p->g->nx, c->cell / p->g->nx, face);
        if (cell >= 0 && p->trial->kind[cell] != ILSA_CELL_EMPTY && p->trial->pressure[cell] != 0) {
            double d = face == GRID_LEFT || face == GRID_RIGHT ? p->g->dx : p->g->dy;
            double weight = fmax(c->T - p->trial->level[cell], 0) / (d * d);
            sum += weight * p->trial->pressure[cell];
            weights += weight;
        }
    }
    if (weights > 0) {
        p->trial->pressure[c->cell] = sum / weights;
    }
}

/* Adds the cell and its images to the footprint; false if that touches the edge of the mesh. */
static bool grow_footprint(tip_cells *t, const grid *g, int cell) {
    int image[4], count = ilsai_grid_images(g, cell % g->nx, cell / g->nx, image);
    for (int k = 0; k < count; k++) {
        ilsai_box_add(&t->footprint, image[k] % g->nx, image[k] / g->nx);
    }
    const box *b = &t->footprint;
    return b->x0 > 0 && b->y0 > 0 && b->x1 < g->nx - 1 && b->y1 < g->ny - 1;
}

/* Sets what depends on all of the cells: the footprint, and first guesses of pressure. */
static ilsa_status wet_cells(tip_cells *t, const front_pass *p, const front_cell *reached,
                             int count, error_text *error) {
    t->footprint = p->old_footprint;
    for (int k = 0; k < count; k++) {
        if (p->trial->kind[reached[k].cell] != ILSA_CELL_EMPTY) {
            guess_pressure(p, &reached[k]);
            if (!grow_footprint(t, p->g, reached[k].cell)) {
                return ilsai_fail(error, ILSA_MESH_EDGE,
                                  "the footprint reaches the edge of the mesh of %d x %d cells",
                                  p->g->nx, p->g->ny);
            }
        }
    }
    return ILSA_OK;
}

/* Keeps the paths through the cells that are wet. */
static void pack_paths(tip_paths *paths, const front_pass *p, const front_cell *reached,
                       int count) {
    paths->count = 0;
    for (int k = 0; k < count; k++) {
        if (p->trial->kind[reached[k].cell] != ILSA_CELL_EMPTY) {
            paths->at[paths->count++] = paths->at[k];
        }
    }
}

/* Makes room for the cells of a march, the survey cells, and the paths with their images. */
static ilsa_status reserve(tip_cells *t, const front_pass *p, int count) {
    const grown_array arrays[] = {ILSAI_GROWN(t->sensitivities), ILSAI_GROWN(t->width_slopes)};
    ILSAI_TRY(ilsai_grow((size_t)count + (size_t)p->survey_count, &t->capacity, arrays, 2));
    int images = count << (p->g->mirror_x + p->g->mirror_y);
    return p->material->C_prime > 0 ? ilsai_tip_paths_reserve(&t->paths, images) : ILSA_OK;
}

ilsa_status ilsai_tip_cells_update(tip_cells *t, const front_pass *p, bool hold,
                                   error_text *error) {
    int count;
    const front_cell *reached = ilsai_march_cells(p->marched, &count);
    ILSAI_TRY(reserve(t, p, count));
    ILSAI_TRY(drop_unreached(p));
    loop l = {t, p, reached, hold};
    t->sensitivity_count = 0;
    ilsai_thread_pool_run(p->threads, set_cells, &l, count, ILSAI_SHARE_FRONT);
    if (p->material->C_prime > 0) {
        pack_paths(&t->paths, p, reached, count);
    }
    ilsai_thread_pool_run(p->threads, set_survey_self_terms, &l, p->survey_count,
                          ILSAI_SHARE_FRONT);
    ilsai_thread_pool_run(p->threads, set_filled_self_terms, &l, count, ILSAI_SHARE_FRONT);
    return wet_cells(t, p, reached, count, error);
}
