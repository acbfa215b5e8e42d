#include "jacobian.h"

#include "clock.h"
#include <cblas.h>
#include <ilsa/solver.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void ilsai_jacobian_destroy(jacobian *m) {
    free(m->width);
    free(m->pressure);
    free(m->band);
    free(m->full);
    free(m->influence);
    free(m->pivots);
    free(m->response_of);
    free(m->edge);
    memset(m, 0, sizeof *m);
}

static const tip_response *response_of(const jacobian *m, int k) {
    return m->response && m->response_of[k] >= 0 ? &m->response[m->response_of[k]] : NULL;
}

/* Sum of a response's weights times the changes of the widths it answers to. */
static double respond(const jacobian *m, const tip_response *r, const double *weight,
                      const double *x) {
    double sum = 0;
    for (int p = 0; r && p < r->count; p++) {
        sum += weight[p] * x[m->a->slot[r->from[p]]];
    }
    return sum;
}

double ilsai_jacobian_tip_width(const jacobian *m, int k, const double *x) {
    const tip_response *r = response_of(m, k);
    return r ? respond(m, r, r->width, x) : 0;
}

double ilsai_jacobian_tip_gain(const jacobian *m, int k, const double *x) {
    const tip_response *r = response_of(m, k);
    return r ? respond(m, r, r->gain, x) : 0;
}

double ilsai_jacobian_edge_pressure(const jacobian *m, int k, const double *x) {
    const tip_response *r = response_of(m, k);
    return r ? respond(m, r, r->pressure, x) : 0;
}

/* Pressure changes that the width changes x of the channel cells bring about, and the tip's own. */
static void apply_elasticity(jacobian *m, const double *x) {
    const active *a = m->a;
    int image[4];
    for (int k = 0; k < a->count; k++) {
        int cell = a->cell[k];
        int count = ilsai_grid_images(m->g, cell % m->g->nx, cell / m->g->nx, image);
        double w = a->tip[k] ? ilsai_jacobian_tip_width(m, k, x) : x[k];
        for (int c = 0; c < count; c++) {
            m->width[image[c]] = w;
        }
    }
    double start = ilsai_clock();
    size_t corner = (size_t)ilsai_grid_cell(m->g, a->footprint.x0, a->footprint.y0);
    ilsai_elasticity_multiply(m->e, m->width + corner, m->pressure + corner, (size_t)m->g->nx);
    m->seconds_product += ilsai_clock() - start;
    m->products++;
    for (int k = 0; k < a->count; k++) {
        if (a->tip[k]) {
            m->pressure[a->cell[k]] = x[k];
        } else {
            m->pressure[a->cell[k]] += m->edge[k] * x[k] + ilsai_jacobian_edge_pressure(m, k, x);
        }
    }
}

static void clear_width(jacobian *m) {
    const active *a = m->a;
    int image[4];
    for (int k = 0; k < a->count; k++) {
        int cell = a->cell[k];
        int count = ilsai_grid_images(m->g, cell % m->g->nx, cell / m->g->nx, image);
        for (int c = 0; c < count; c++) {
            m->width[image[c]] = 0;
        }
    }
}

void ilsai_jacobian_multiply(void *context, const double *x, double *y) {
    jacobian *m = context;
    const active *a = m->a;
    apply_elasticity(m, x);
    ilsai_flow_gain(m->f, a, m->pressure, y);
    for (int k = 0; k < a->count; k++) {
        double w = m->width[a->cell[k]], from_width = 0;
        for (int face = 0; face < GRID_FACES; face++) {
            int at = GRID_FACES * k + face, other = a->neighbour[at];
            if (other >= 0) {
                from_width += m->f->slope[at] * (w + m->width[a->cell[other]]);
            }
        }
        y[k] = w - from_width - y[k] - ilsai_jacobian_tip_gain(m, k, x);
    }
    clear_width(m);
}

/* Receives the entry of a row in a column. */
typedef void entry_sink(jacobian *m, int row, int column, double value);

/* What the self term of active cell k lacks, its own part in the front's move included. */
static double edge_self(const jacobian *m, int k) {
    const tip_response *r = response_of(m, k);
    double sum = m->edge[k];
    for (int p = 0; r && p < r->count; p++) {
        sum += r->from[p] == m->a->cell[k] ? r->pressure[p] : 0;
    }
    return sum;
}

/*
 * What the pressure of active cell b, weighing value in a row, is in terms of the unknowns. The tip
 * widths' responses are left out of the stencil matrix: they would double its band and save
 * nothing.
 */
static void spread_pressure(jacobian *m, int row, int b, double value, entry_sink *sink) {
    const active *a = m->a;
    if (a->tip[b]) {
        sink(m, row, b, value);
        return;
    }
    sink(m, row, b, value * edge_self(m, b));
    int ib = a->cell[b] % m->g->nx, jb = a->cell[b] / m->g->nx;
    for (int dj = -1; dj <= 1; dj++) {
        for (int di = -1; di <= 1; di++) {
            int i = ib + di, j = jb + dj;
            if (i < 0 || i >= m->g->nx || j < 0 || j >= m->g->ny) {
                continue;
            }
            int column = a->slot[ilsai_grid_fold(m->g, i, j)];
            if (column >= 0 && !a->tip[column]) {
                sink(m, row, column, value * ilsai_elasticity_entry(m->e, di, dj));
            }
        }
    }
}

static void visit_row(jacobian *m, int row, entry_sink *sink) {
    const active *a = m->a;
    double diagonal = 1, own_pressure = 0;
    for (int face = 0; face < GRID_FACES; face++) {
        int at = GRID_FACES * row + face, other = a->neighbour[at];
        if (other < 0) {
            continue;
        }
        own_pressure += m->f->conductance[at];
        spread_pressure(m, row, other, -m->f->conductance[at], sink);
        if (!a->tip[other]) {
            sink(m, row, other, -m->f->slope[at]);
        }
        diagonal -= m->f->slope[at];
    }
    spread_pressure(m, row, row, own_pressure, sink);
    if (!a->tip[row]) {
        sink(m, row, row, diagonal);
    }
}

static void measure_band(jacobian *m, int row, int column, double value) {
    (void)value;
    int distance = row > column ? row - column : column - row;
    m->lower = distance > m->lower ? distance : m->lower;
}

static void add_to_band(jacobian *m, int row, int column, double value) {
    size_t rows = 3 * (size_t)m->lower + 1;
    m->band[(size_t)column * rows + (size_t)(2 * m->lower + row - column)] += value;
}

static ilsa_status reserve(double **array, size_t *capacity, size_t size) {
    if (size > *capacity) {
        size_t grown = size + size / 2;
        double *fresh = malloc(grown * sizeof *fresh);
        if (!fresh) {
            return ILSA_ERR_MEMORY;
        }
        free(*array);
        *array = fresh;
        *capacity = grown;
    }
    return ILSA_OK;
}

static ilsa_status reserve_pivots(jacobian *m) {
    size_t size = (size_t)m->a->count;
    if (size > m->pivot_capacity) {
        size_t grown = size + size / 2;
        int *fresh = malloc(grown * sizeof *fresh);
        if (!fresh) {
            return ILSA_ERR_MEMORY;
        }
        free(m->pivots);
        m->pivots = fresh;
        m->pivot_capacity = grown;
    }
    return ILSA_OK;
}

ilsa_status ilsai_jacobian_factor_stencil(jacobian *m) {
    double start = ilsai_clock();
    int n = m->a->count;
    m->lower = 0;
    for (int row = 0; row < n; row++) {
        visit_row(m, row, measure_band);
    }
    size_t size = (3 * (size_t)m->lower + 1) * (size_t)n;
    if (reserve(&m->band, &m->band_capacity, size) != ILSA_OK || reserve_pivots(m) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    memset(m->band, 0, size * sizeof *m->band);
    for (int row = 0; row < n; row++) {
        visit_row(m, row, add_to_band);
    }
    lapack_int info = LAPACKE_dgbtrf_work(LAPACK_COL_MAJOR, n, n, m->lower, m->lower, m->band,
                                          3 * m->lower + 1, m->pivots);
    m->seconds_preconditioner += ilsai_clock() - start;
    return info == 0 ? ILSA_OK : ILSA_ERR_NUMERIC;
}

void ilsai_jacobian_precondition(void *context, const double *x, double *y) {
    jacobian *m = context;
    double start = ilsai_clock();
    memcpy(y, x, (size_t)m->a->count * sizeof *y);
    LAPACKE_dgbtrs_work(LAPACK_COL_MAJOR, 'N', m->a->count, m->lower, m->lower, 1, m->band,
                        3 * m->lower + 1, m->pivots, y, m->a->count);
    m->seconds_preconditioner += ilsai_clock() - start;
}

/* C between cells a and b, b's images included. */
static double folded_entry(const jacobian *m, int a, int b) {
    int image[4], nx = m->g->nx, cell = m->a->cell[b], here = m->a->cell[a];
    int count = ilsai_grid_images(m->g, cell % nx, cell / nx, image);
    double sum = 0;
    for (int c = 0; c < count; c++) {
        sum += ilsai_elasticity_entry(m->e, here % nx - image[c] % nx, here / nx - image[c] / nx);
    }
    return sum;
}

/* What the pressure of active cell row is in terms of the unknowns: C with the tips' responses. */
static void fill_influence_row(jacobian *m, int row, double *out) {
    const active *a = m->a;
    memset(out, 0, (size_t)a->count * sizeof *out);
    if (a->tip[row]) {
        out[row] = 1;
        return;
    }
    for (int k = 0; k < a->count; k++) {
        double value = folded_entry(m, row, k);
        const tip_response *r = a->tip[k] ? response_of(m, k) : NULL;
        out[k] += a->tip[k] ? 0 : value;
        for (int p = 0; r && p < r->count; p++) {
            out[a->slot[r->from[p]]] += value * r->width[p];
        }
    }
    const tip_response *own = response_of(m, row);
    out[row] += m->edge[row];
    for (int p = 0; own && p < own->count; p++) {
        out[a->slot[own->from[p]]] += own->pressure[p];
    }
}

ilsa_status ilsai_jacobian_set_influence(jacobian *m) {
    double start = ilsai_clock();
    size_t n = (size_t)m->a->count, capacity = m->full_capacity;
    if (reserve(&m->full, &capacity, n * n) != ILSA_OK ||
        reserve(&m->influence, &m->full_capacity, n * n) != ILSA_OK ||
        reserve_pivots(m) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    for (size_t row = 0; row < n; row++) {
        fill_influence_row(m, (int)row, m->influence + row * n);
    }
    m->seconds_preconditioner += ilsai_clock() - start;
    return ILSA_OK;
}

/* Adds what the width of an active cell is, times value, to a row. */
static void add_width(const jacobian *m, double *out, int k, double value) {
    const tip_response *r = response_of(m, k);
    out[k] += m->a->tip[k] ? 0 : value;
    for (int p = 0; m->a->tip[k] && r && p < r->count; p++) {
        out[m->a->slot[r->from[p]]] += value * r->width[p];
    }
}

/* Row k of the full matrix, stored as a column of the transpose. */
static void fill_full_row(jacobian *m, int row) {
    const active *a = m->a;
    size_t n = (size_t)a->count;
    double *out = m->full + (size_t)row * n, total = 0, diagonal = 1;
    memset(out, 0, n * sizeof *out);
    for (int face = 0; face < GRID_FACES; face++) {
        int at = GRID_FACES * row + face, other = a->neighbour[at];
        if (other < 0) {
            continue;
        }
        cblas_daxpy((int)n, -m->f->conductance[at], m->influence + (size_t)other * n, 1, out, 1);
        add_width(m, out, other, -m->f->slope[at]);
        diagonal -= m->f->slope[at];
        total += m->f->conductance[at];
    }
    cblas_daxpy((int)n, total, m->influence + (size_t)row * n, 1, out, 1);
    add_width(m, out, row, diagonal);
    const tip_response *r = response_of(m, row);
    for (int p = 0; r && p < r->count; p++) {
        out[a->slot[r->from[p]]] -= r->gain[p];
    }
}

ilsa_status ilsai_jacobian_solve_full(jacobian *m, const double *b, double *x) {
    double start = ilsai_clock();
    int n = m->a->count;
    for (int row = 0; row < n; row++) {
        fill_full_row(m, row);
    }
    lapack_int info = LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, m->full, n, m->pivots);
    memcpy(x, b, (size_t)n * sizeof *x);
    if (info == 0) {
        LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', n, 1, m->full, n, m->pivots, x, n);
    }
    m->seconds_preconditioner += ilsai_clock() - start;
    return info == 0 ? ILSA_OK : ILSA_ERR_NUMERIC;
}
