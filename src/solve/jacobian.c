#include "solve/jacobian.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/tuning.h"
#include <cblas.h>
#include <ilsa/solver.h>
#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

/*
 * In the preconditioner elasticity is a spring in every cell, of this many times 1 / C_0, where C_0
 * is the entry of a cell with itself. That is the mean of C^-1 over the waves of pressure that the
 * flow of a step does not level out.
 */
#define JACOBIAN_SPRING 3.0
/* The part of that spring which damps the change of the pressure of a tip cell in an iteration
 * while cells are closed. Where closed cells let no fluid out to it that pressure is undetermined.
 */
#define JACOBIAN_SOFT 1e-6
/* In the preconditioner the spring of a cell whose pressure no flow changes is this many times the
 * sum of its other springs and of the conductances around it. */
#define JACOBIAN_STIFF 1e6

void ilsai_jacobian_destroy(jacobian *m) {
    ilsai_release(m->width);
    ilsai_release(m->pressure);
    ilsai_release(m->full);
    ilsai_release(m->influence);
    ilsai_release(m->pivots);
    ilsai_release(m->sensitivity_of);
    ilsai_release(m->self_correction);
    ilsai_release(m->fill);
    ilsai_release(m->leakoff_by_fill);
    ilsai_release(m->place);
    ilsai_release(m->weight);
    ilsai_multigrid_destroy(&m->multigrid);
    ilsai_near_field_destroy(&m->near_field);
    memset(m, 0, sizeof *m);
}

/* The sensitivity of numbered cell k. NULL: it has none, as a cell that no fluid reaches. */
static const sensitivity *sensitivity_of(const jacobian *m, int k) {
    bool reached = m->cells->unknown[k] != UNKNOWN_NONE;
    return m->sensitivity && reached && m->sensitivity_of[k] >= 0
               ? &m->sensitivity[m->sensitivity_of[k]]
               : NULL;
}

/* Whether the width of numbered cell k is an unknown. */
static bool is_free(const jacobian *m, int k) {
    return m->cells->unknown[k] == UNKNOWN_WIDTH || m->cells->unknown[k] == UNKNOWN_FILL;
}

/* Whether its pressure follows from the widths and is part of the flow. */
static bool is_elastic(const jacobian *m, int k) {
    return m->cells->unknown[k] == UNKNOWN_WIDTH;
}

/* Whether its pressure is an unknown. */
static bool has_pressure(const jacobian *m, int k) {
    return m->cells->unknown[k] == UNKNOWN_PRESSURE;
}

/* The entry of C between a cell and itself, that of the first numbered cell for all. */
static double self_entry(const jacobian *m) {
    return ilsai_elasticity_self_entry(m->elastic, m->cells->cell[0] % m->g->nx,
                                       m->cells->cell[0] / m->g->nx);
}

/* Width that a unit of pressure brings where elasticity is a spring, see JACOBIAN_SPRING. */
static double spring_of(const jacobian *m) {
    return JACOBIAN_SPRING / self_entry(m);
}

/* What the unknown of numbered cell k adds to the diagonal of its own row beside its width. */
static double extra_diagonal(const jacobian *m, int k) {
    switch (m->cells->unknown[k]) {
    case UNKNOWN_WIDTH:
        return m->lubrication->restrained ? -m->lubrication->by_own_width[k] : 0;
    case UNKNOWN_PRESSURE:
        return m->lubrication->restrained ? JACOBIAN_SOFT * spring_of(m) : 0;
    case UNKNOWN_FILL:
        return m->leakoff_by_fill[k];
    default:
        return 1;
    }
}

/* The change for changes x of the unknowns, given the derivatives of a sensitivity. */
static double change_by(const jacobian *m, const sensitivity *r, const double *derivative,
                        const double *x) {
    double sum = 0;
    for (int p = 0; p < r->count; p++) {
        int number = m->cells->number[r->from[p]];
        sum += is_free(m, number) ? derivative[p] * x[number] : 0;
    }
    return sum;
}

double ilsai_jacobian_width_change(const jacobian *m, int k, const double *x) {
    const sensitivity *r = sensitivity_of(m, k);
    return r ? m->fill[k] * change_by(m, r, r->width, x) : 0;
}

double ilsai_jacobian_source_change(const jacobian *m, int k, const double *x) {
    const sensitivity *r = sensitivity_of(m, k);
    return r ? m->fill[k] * change_by(m, r, r->source_term, x) : 0;
}

double ilsai_jacobian_pressure_change(const jacobian *m, int k, const double *x) {
    const sensitivity *r = sensitivity_of(m, k);
    return r ? change_by(m, r, r->pressure, x) : 0;
}

double ilsai_jacobian_advance(const jacobian *m, int k, const double *x) {
    const sensitivity *r = sensitivity_of(m, k);
    return r ? change_by(m, r, r->advance, x) : 0;
}

/* A loop over the numbered cells, which reads the vector x or writes y. */
typedef struct loop {
    jacobian *m;
    const double *x;
    double *y;
} loop;

static void share_cells(pool_function *function, jacobian *m, const double *x, double *y) {
    loop l = {m, x, y};
    ilsai_thread_pool_run(m->threads, function, &l, m->cells->count, ILSAI_SHARE_CELLS);
}

static void set_widths(void *context, int first, int end) {
    const loop *l = context;
    const jacobian *m = l->m;
    for (int k = first; k < end; k++) {
        double own = is_free(m, k) ? l->x[k] : 0;
        own += is_elastic(m, k) ? 0 : ilsai_jacobian_width_change(m, k, l->x);
        m->width[m->cells->cell[k]] = own;
    }
}

static void complete_pressures(void *context, int first, int end) {
    const loop *l = context;
    const jacobian *m = l->m;
    for (int k = first; k < end; k++) {
        double *pressure = &m->pressure[m->cells->cell[k]];
        if (is_elastic(m, k)) {
            *pressure +=
                m->self_correction[k] * l->x[k] + ilsai_jacobian_pressure_change(m, k, l->x);
        } else {
            *pressure = has_pressure(m, k) ? l->x[k] : 0;
        }
    }
}

/* Sets m->width and m->pressure to the changes of widths and pressures for changes x of the
 * unknowns. */
static void apply_elasticity(jacobian *m, const double *x) {
    share_cells(set_widths, m, x, NULL);
    double start = ilsai_clock();
    box part = ilsai_box_fold(m->g, &m->cells->footprint);
    size_t corner = (size_t)ilsai_grid_cell(m->g, part.x0, part.y0);
    ilsai_elasticity_multiply(m->elastic, m->width + corner, m->pressure + corner,
                              (size_t)m->g->nx);
    m->seconds_product += ilsai_clock() - start;
    m->products++;
    share_cells(complete_pressures, m, x, NULL);
}

static void clear_widths(void *context, int first, int end) {
    const loop *l = context;
    for (int k = first; k < end; k++) {
        l->m->width[l->m->cells->cell[k]] = 0;
    }
}

/* What a face brings for the change of the width across, beside by_width. */
static double across_alone(const jacobian *m, int at) {
    return m->lubrication->restrained ? m->lubrication->by_width_across[at] : 0;
}

static void balance_volumes(void *context, int first, int end) {
    const loop *l = context;
    const jacobian *m = l->m;
    const unknowns *cells = m->cells;
    for (int k = first; k < end; k++) {
        double w = m->width[cells->cell[k]], from_width = 0;
        double from_pressure =
            ilsai_lubrication_inflow_change(m->lubrication, cells, m->pressure, k);
        for (int face = 0; face < GRID_FACES; face++) {
            int at = GRID_FACES * k + face, other = cells->neighbour[at];
            if (other >= 0) {
                double across = m->width[cells->cell[other]];
                from_width += m->lubrication->by_width[at] * (w + across);
                from_width += across_alone(m, at) * across;
            }
        }
        double own = w + extra_diagonal(m, k) * l->x[k];
        l->y[k] = own - from_width - from_pressure - ilsai_jacobian_source_change(m, k, l->x);
    }
}

void ilsai_jacobian_multiply(void *context, const double *x, double *y) {
    jacobian *m = context;
    apply_elasticity(m, x);
    share_cells(balance_volumes, m, x, y);
    share_cells(clear_widths, m, x, NULL);
}

/* What the self term of numbered cell k lacks, less what the front takes of it when the width of
 * the cell itself moves it. */
static double corrected_self(const jacobian *m, int k) {
    const sensitivity *r = sensitivity_of(m, k);
    double sum = m->self_correction[k];
    for (int p = 0; r && p < r->count; p++) {
        sum += r->from[p] == m->cells->cell[k] ? r->pressure[p] : 0;
    }
    return sum;
}

/* ---- Preconditioner ----------------------------------------------------------------------- */

/* The part of a cell, or of a face that the axis cuts, which lies on the solved side of the axis.
 */
static double half_on_axis(bool mirror, int count, int at, int first) {
    return mirror && count % 2 && at == first ? 0.5 : 1;
}

/* Sets where the numbered cells lie on the rectangle of the preconditioner, and their weights. */
static void place_cells(void *context, int first, int end) {
    jacobian *m = ((const loop *)context)->m;
    const grid *g = m->g;
    box part = ilsai_box_fold(g, &m->cells->footprint);
    size_t stride = ilsai_box_columns(&part) + 2;
    for (int k = first; k < end; k++) {
        int i = m->cells->cell[k] % g->nx, j = m->cells->cell[k] / g->nx;
        m->place[k] = (size_t)(j - part.y0 + 1) * stride + (size_t)(i - part.x0 + 1);
        m->weight[k] = half_on_axis(g->mirror_x, g->nx, i, g->lo_x) *
                       half_on_axis(g->mirror_y, g->ny, j, g->lo_y);
    }
}

/* Whether elasticity finds the width of numbered cell k from its pressure. That of a cell which
 * closes hardly moves: what it leaks and lets out sees to that. */
static bool bends(const jacobian *m, int k) {
    return is_elastic(m, k) && !(m->lubrication->restrained && m->lubrication->by_own_width[k] < 0);
}

/* The spring of a cell that does not bend. Where its pressure is not the unknown no flow changes
 * it, so that its spring is a stiff one. */
static double spring_of_stiff_cell(const jacobian *m, int k, double spring) {
    if (has_pressure(m, k)) {
        return extra_diagonal(m, k);
    }
    const double *by_pressure = m->lubrication->by_pressure + (size_t)GRID_FACES * (size_t)k;
    double pull = spring;
    for (int face = 0; face < GRID_FACES; face++) {
        pull += by_pressure[face];
    }
    return JACOBIAN_STIFF * pull;
}

static void set_flow(void *context, int first, int end) {
    jacobian *m = ((const loop *)context)->m;
    const grid *g = m->g;
    multigrid_level *l = &m->multigrid.level[0];
    double spring = spring_of(m);
    for (int k = first; k < end; k++) {
        const double *by_pressure = m->lubrication->by_pressure + (size_t)GRID_FACES * (size_t)k;
        int i = m->cells->cell[k] % g->nx, j = m->cells->cell[k] / g->nx;
        size_t at = m->place[k];
        l->right[at] = half_on_axis(g->mirror_y, g->ny, j, g->lo_y) * by_pressure[GRID_RIGHT];
        l->up[at] = half_on_axis(g->mirror_x, g->nx, i, g->lo_x) * by_pressure[GRID_UP];
        l->spring[at] = m->weight[k] * (bends(m, k) ? spring : spring_of_stiff_cell(m, k, spring));
    }
}

static void set_open_cells(void *context, int first, int end) {
    jacobian *m = ((const loop *)context)->m;
    for (int k = first; k < end; k++) {
        m->near_field.open[m->place[k]] = bends(m, k);
        m->near_field.extra[m->place[k]] = bends(m, k) ? corrected_self(m, k) : 0;
    }
}

/* One stencil serves all cells, that of the first numbered one: a preconditioner may be inexact. */
static void set_near_field(jacobian *m) {
    near_field *n = &m->near_field;
    int i = m->cells->cell[0] % m->g->nx, j = m->cells->cell[0] / m->g->nx;
    n->about_x = ilsai_grid_about_x(m->g);
    n->about_y = ilsai_grid_about_y(m->g);
    n->self = self_entry(m);
    n->beside = ilsai_elasticity_entry(m->elastic, i, j, i + 1, j);
    n->above = ilsai_elasticity_entry(m->elastic, i, j, i, j + 1);
    n->corner = ilsai_elasticity_entry(m->elastic, i, j, i + 1, j + 1);
    share_cells(set_open_cells, m, NULL, NULL);
}

ilsa_status ilsai_jacobian_set_preconditioner(jacobian *m) {
    double start = ilsai_clock();
    box part = ilsai_box_fold(m->g, &m->cells->footprint);
    int nx = (int)ilsai_box_columns(&part), ny = (int)ilsai_box_rows(&part);
    m->multigrid.threads = m->near_field.threads = m->threads;
    const grown_array arrays[] = {ILSAI_GROWN(m->place), ILSAI_GROWN(m->weight)};
    ILSAI_TRY(ilsai_grow((size_t)m->cells->count, &m->place_capacity, arrays,
                         sizeof arrays / sizeof *arrays));
    ILSAI_TRY(ilsai_multigrid_shape(&m->multigrid, nx, ny));
    ILSAI_TRY(ilsai_near_field_shape(&m->near_field, nx, ny));
    share_cells(place_cells, m, NULL, NULL);
    share_cells(set_flow, m, NULL, NULL);
    ilsai_multigrid_build(&m->multigrid);
    set_near_field(m);
    m->seconds_preconditioner += ilsai_clock() - start;
    return ILSA_OK;
}

static void lay_out(void *context, int first, int end) {
    const loop *l = context;
    for (int k = first; k < end; k++) {
        l->m->multigrid.level[0].b[l->m->place[k]] = l->m->weight[k] * l->x[k];
    }
}

static void hand_over(void *context, int first, int end) {
    jacobian *m = ((const loop *)context)->m;
    for (int k = first; k < end; k++) {
        size_t at = m->place[k];
        m->near_field.y[at] = bends(m, k) ? m->multigrid.level[0].y[at] : 0;
    }
}

static void read_out(void *context, int first, int end) {
    const loop *l = context;
    const jacobian *m = l->m;
    for (int k = first; k < end; k++) {
        size_t at = m->place[k];
        l->y[k] = bends(m, k)          ? m->near_field.x[at]
                  : has_pressure(m, k) ? m->multigrid.level[0].y[at]
                                       : l->x[k] / (is_free(m, k) + extra_diagonal(m, k));
    }
}

/*
 * The matrix is nearly (d - dt A) C, because C^-1 acts on pressures as a spring d wherever flow
 * does not level them out. So multigrid finds pressures first, and the near field of C finds widths
 * from them. Where the pressure is the unknown it is the result. In a cell whose pressure no flow
 * changes the diagonal alone is inverted.
 */
void ilsai_jacobian_precondition(void *context, const double *x, double *y) {
    jacobian *m = context;
    double start = ilsai_clock();
    share_cells(lay_out, m, x, NULL);
    ilsai_multigrid_cycle(&m->multigrid);
    share_cells(hand_over, m, NULL, NULL);
    ilsai_near_field_solve(&m->near_field);
    share_cells(read_out, m, x, y);
    m->seconds_preconditioner += ilsai_clock() - start;
}

/* ---- Full matrix -------------------------------------------------------------------------- */

/* The entry of C between numbered cells a and b, with those of the images of b added. */
static double folded_entry(const jacobian *m, int a, int b) {
    int image[4], nx = m->g->nx, cell = m->cells->cell[b], here = m->cells->cell[a];
    int count = ilsai_grid_images(m->g, cell % nx, cell / nx, image);
    double sum = 0;
    for (int c = 0; c < count; c++) {
        sum +=
            ilsai_elasticity_entry(m->elastic, here % nx, here / nx, image[c] % nx, image[c] / nx);
    }
    return sum;
}

/* Adds value times the derivatives of a sensitivity to a row. */
static void add_sensitivity(const jacobian *m, double *out, const sensitivity *r,
                            const double *derivative, double value) {
    for (int p = 0; r && p < r->count; p++) {
        int number = m->cells->number[r->from[p]];
        out[number] += is_free(m, number) ? value * derivative[p] : 0;
    }
}

/* Adds value times the width of numbered cell k, in terms of the unknowns, to a row. */
static void add_width(const jacobian *m, double *out, int k, double value) {
    const sensitivity *r = sensitivity_of(m, k);
    if (is_free(m, k)) {
        out[k] += value;
    }
    if (!is_elastic(m, k)) {
        add_sensitivity(m, out, r, r ? r->width : NULL, m->fill[k] * value);
    }
}

/*
 * In the full matrix a pressure that is an unknown is divided by self_entry, so that all unknowns
 * are widths: pivots are chosen among the unknowns, and the choice must not depend on units.
 */

/* Sets out to the pressure of numbered cell row in terms of the unknowns: a row of C, with the
 * widths of the tip cells replaced by their sensitivities. */
static void fill_influence_row(jacobian *m, int row, double *out) {
    const unknowns *cells = m->cells;
    memset(out, 0, (size_t)cells->count * sizeof *out);
    if (!is_elastic(m, row)) {
        out[row] = has_pressure(m, row) ? self_entry(m) : 0;
        return;
    }
    for (int k = 0; k < cells->count; k++) {
        add_width(m, out, k, folded_entry(m, row, k));
    }
    const sensitivity *own = sensitivity_of(m, row);
    out[row] += m->self_correction[row];
    add_sensitivity(m, out, own, own ? own->pressure : NULL, 1);
}

ilsa_status ilsai_jacobian_set_influence(jacobian *m) {
    double start = ilsai_clock();
    size_t n = (size_t)m->cells->count;
    const grown_array squares[] = {ILSAI_GROWN(m->full), ILSAI_GROWN(m->influence)};
    const grown_array pivots = ILSAI_GROWN(m->pivots);
    ILSAI_TRY(ilsai_grow(n * n, &m->full_capacity, squares, sizeof squares / sizeof *squares));
    ILSAI_TRY(ilsai_grow(n, &m->pivot_capacity, &pivots, 1));
    for (size_t row = 0; row < n; row++) {
        fill_influence_row(m, (int)row, m->influence + row * n);
    }
    m->seconds_preconditioner += ilsai_clock() - start;
    return ILSA_OK;
}

/* Sets a row of the full matrix, which is stored as a column of the transpose. */
static void fill_full_row(jacobian *m, int row) {
    const unknowns *cells = m->cells;
    size_t n = (size_t)cells->count;
    double *out = m->full + (size_t)row * n, total = 0, diagonal = 1;
    memset(out, 0, n * sizeof *out);
    for (int face = 0; face < GRID_FACES; face++) {
        int at = GRID_FACES * row + face, other = cells->neighbour[at];
        if (other < 0) {
            continue;
        }
        cblas_daxpy((int)n, -m->lubrication->by_pressure[at], m->influence + (size_t)other * n, 1,
                    out, 1);
        add_width(m, out, other, -m->lubrication->by_width[at] - across_alone(m, at));
        diagonal -= m->lubrication->by_width[at];
        total += m->lubrication->by_pressure[at];
    }
    cblas_daxpy((int)n, total, m->influence + (size_t)row * n, 1, out, 1);
    add_width(m, out, row, diagonal);
    const sensitivity *r = sensitivity_of(m, row);
    add_sensitivity(m, out, r, r ? r->source_term : NULL, -m->fill[row]);
    out[row] += (has_pressure(m, row) ? self_entry(m) : 1) * extra_diagonal(m, row);
}

ilsa_status ilsai_jacobian_solve_full(jacobian *m, const double *b, double *x) {
    double start = ilsai_clock();
    int n = m->cells->count;
    for (int row = 0; row < n; row++) {
        fill_full_row(m, row);
    }
    lapack_int info = LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, m->full, n, m->pivots);
    memcpy(x, b, (size_t)n * sizeof *x);
    if (info == 0) {
        LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', n, 1, m->full, n, m->pivots, x, n);
    }
    for (int k = 0; k < n; k++) {
        x[k] *= has_pressure(m, k) ? self_entry(m) : 1;
    }
    m->seconds_preconditioner += ilsai_clock() - start;
    return info == 0 ? ILSA_OK : ILSA_STEP_REJECTED;
}
