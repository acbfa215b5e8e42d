#include "solve/multigrid.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/tuning.h"
#include <string.h>

/* Conductances this many times larger along one axis have cells joined along that axis alone. */
#define MULTIGRID_ANISOTROPY 3.0
/*
 * Two Jacobi steps, damped so (before the coarse level; after it the other way round): Chebyshev's
 * for the upper three quarters of the spectrum.
 */
static const double damping[2] = {1 / 1.78033, 1 / 0.71967};

enum { LEVEL_ARRAYS = 8 }; /* the last one holds the two widths */

static size_t level_size(int nx, int ny) {
    return ((size_t)nx + 2) * ((size_t)ny + 2);
}

void ilsai_multigrid_destroy(multigrid *m) {
    ilsai_release(m->pool);
    ilsai_release(m->maps);
    memset(m, 0, sizeof *m);
}

static void place_level(multigrid_level *l, int nx, int ny, double *pool, int *maps) {
    size_t size = level_size(nx, ny);
    *l = (multigrid_level){.nx = nx, .ny = ny, .stride = nx + 2};
    l->right = pool;
    l->up = pool + size;
    l->spring = pool + 2 * size;
    l->inverse = pool + 3 * size;
    l->y = pool + 4 * size;
    l->b = pool + 5 * size;
    l->work = pool + 6 * size;
    l->wide_x = pool + 7 * size;
    l->wide_y = l->wide_x + nx;
    l->into_x = maps;
    l->into_y = maps + nx;
}

/*
 * Joins n cells to pairs from both ends inwards; a middle cell stays alone, or takes both its
 * neighbours where these would stay alone. Returns how many cells result.
 */
static int join(int n, int *into) {
    int half = n / 2, pairs = half / 2, odd = half % 2, count = 2 * pairs + (odd || n % 2);
    if (n % 2 == 0 && odd) { /* the middle is a pair */
        count = 2 * pairs + 1;
    }
    for (int i = 0; i < n; i++) {
        int from_end = i < n - 1 - i ? i : n - 1 - i;
        int at = from_end / 2 < pairs ? from_end / 2 : pairs;
        into[i] = i == from_end || at == pairs ? at : count - 1 - at;
    }
    return count;
}

/* Cells that n are joined to. */
static int joined(int n) {
    return 2 * (n / 4) + (n % 4 > 0);
}

/* Room for the levels below as well, however they come to be: each has half the cells or less. */
static size_t pool_size(int nx, int ny) {
    size_t size = level_size(nx, ny);
    while (nx > 1 || ny > 1) {
        bool along_x = nx >= ny;
        nx = along_x ? joined(nx) : nx;
        ny = along_x ? ny : joined(ny);
        size += level_size(nx, ny);
    }
    return LEVEL_ARRAYS * size;
}

static ilsa_status reserve(multigrid *m, int nx, int ny) {
    /* joining along one axis alone keeps the other's border: twice the room is enough */
    size_t size = 2 * pool_size(nx, ny), map_size = 4 * ((size_t)nx + (size_t)ny) + 512;
    const grown_array pool = ILSAI_GROWN(m->pool), maps = ILSAI_GROWN(m->maps);
    ILSAI_TRY(ilsai_grow(size, &m->pool_capacity, &pool, 1));
    return ilsai_grow(map_size, &m->maps_capacity, &maps, 1);
}

ilsa_status ilsai_multigrid_shape(multigrid *m, int nx, int ny) {
    ILSAI_TRY(reserve(m, nx, ny));
    place_level(&m->level[0], nx, ny, m->pool, m->maps);
    memset(m->pool, 0, LEVEL_ARRAYS * level_size(nx, ny) * sizeof *m->pool);
    for (int k = 0; k < nx + ny; k++) {
        m->level[0].wide_x[k] = 1;
    }
    m->levels = 1;
    return ILSA_OK;
}

/* What leaves a cell: at is its place in the arrays. */
static double diagonal(const multigrid_level *l, size_t at) {
    return l->spring[at] + l->right[at] + l->right[at - 1] + l->up[at] +
           l->up[at - (size_t)l->stride];
}

static size_t row(const multigrid_level *l, int j) {
    return ((size_t)j + 1) * (size_t)l->stride + 1;
}

/* A loop over the rows of a level; what it needs depends on the loop. */
typedef struct sweep {
    const multigrid_level *l, *coarse;
    double part;
    const double *from;
    double *to;
} sweep;

/* Shares the rows of the level that nx is the length of. */
static void share_rows(const multigrid *m, pool_function *function, sweep *s, int rows, int nx) {
    ilsai_thread_pool_run(m->threads, function, s, rows, 1 + ILSAI_SHARE_CELLS / nx);
}

static void set_inverse(void *context, int first, int last) {
    const multigrid_level *l = ((const sweep *)context)->l;
    for (int j = first; j < last; j++) {
        for (size_t at = row(l, j), end = at + (size_t)l->nx; at < end; at++) {
            double sum = diagonal(l, at);
            l->inverse[at] = sum > 0 ? 1 / sum : 0;
        }
    }
}

/* Along which axes the next level joins cells: not across the weaker faces where they are weak. */
static void choose_halving(multigrid_level *l) {
    double along_x = 0, along_y = 0;
    for (int j = 0; j < l->ny; j++) {
        for (size_t at = row(l, j), end = at + (size_t)l->nx; at < end; at++) {
            along_x += l->right[at];
            along_y += l->up[at];
        }
    }
    l->half_x = l->nx > 1 && (l->ny == 1 || MULTIGRID_ANISOTROPY * along_x >= along_y);
    l->half_y = l->ny > 1 && (l->nx == 1 || MULTIGRID_ANISOTROPY * along_y >= along_x);
}

/* How the cells along one axis go into those of the next level. */
static int set_map(bool half, int n, int *into) {
    for (int i = 0; i < n; i++) {
        into[i] = i;
    }
    return half ? join(n, into) : n;
}

static void join_widths(int n, const double *wide, const int *into, double *wider) {
    for (int i = 0; i < n; i++) {
        wider[into[i]] += wide[i];
    }
}

/*
 * What the conductance of the face after cell i becomes between cells that are further apart: in
 * proportion to the distance of their centres. 0 for a face within a joined cell.
 */
static double spread(int i, int n, const double *wide, const int *into, const double *wider) {
    if (i + 1 >= n || into[i + 1] == into[i]) {
        return 0;
    }
    return (wide[i] + wide[i + 1]) / (wider[into[i]] + wider[into[i + 1]]);
}

/* The first row that goes into row `coarse` of the next level. */
static int first_into(const multigrid_level *l, int coarse) {
    int j = 0;
    while (j < l->ny && l->into_y[j] < coarse) {
        j++;
    }
    return j;
}

/* Sums of springs, and of the faces between cells that are not joined; by rows of the sums. */
static void sum_faces(void *context, int first, int end) {
    const multigrid_level *fine = ((const sweep *)context)->l;
    const multigrid_level *coarse = ((const sweep *)context)->coarse;
    for (int j = first_into(fine, first); j < fine->ny && fine->into_y[j] < end; j++) {
        size_t at = row(fine, j), to = row(coarse, fine->into_y[j]);
        double up = spread(j, fine->ny, fine->wide_y, fine->into_y, coarse->wide_y);
        for (int i = 0; i < fine->nx; i++, at++) {
            size_t into = to + (size_t)fine->into_x[i];
            double right = spread(i, fine->nx, fine->wide_x, fine->into_x, coarse->wide_x);
            coarse->spring[into] += fine->spring[at];
            coarse->right[into] += right * fine->right[at];
            coarse->up[into] += up * fine->up[at];
        }
    }
}

static void coarsen(const multigrid *m, const multigrid_level *fine,
                    const multigrid_level *coarse) {
    memset(coarse->right, 0, LEVEL_ARRAYS * level_size(coarse->nx, coarse->ny) * sizeof(double));
    join_widths(fine->nx, fine->wide_x, fine->into_x, coarse->wide_x);
    join_widths(fine->ny, fine->wide_y, fine->into_y, coarse->wide_y);
    sweep s = {.l = fine, .coarse = coarse};
    share_rows(m, sum_faces, &s, coarse->ny, fine->nx);
}

void ilsai_multigrid_build(multigrid *m) {
    double *pool = m->pool;
    int *maps = m->maps;
    m->levels = 1;
    for (multigrid_level *l = m->level;; l++, m->levels++) {
        sweep s = {.l = l};
        share_rows(m, set_inverse, &s, l->ny, l->nx);
        choose_halving(l);
        if (!(l->half_x || l->half_y)) {
            return;
        }
        int nx = set_map(l->half_x, l->nx, l->into_x), ny = set_map(l->half_y, l->ny, l->into_y);
        pool += LEVEL_ARRAYS * level_size(l->nx, l->ny);
        maps += l->nx + l->ny;
        place_level(l + 1, nx, ny, pool, maps);
        coarsen(m, l, l + 1);
    }
}

/* What flows into a cell from its neighbours; the order of the sum knows neither sides nor axes. */
static inline double inflow(const multigrid_level *l, const double *y, size_t at) {
    size_t stride = (size_t)l->stride;
    return (l->right[at] * y[at + 1] + l->right[at - 1] * y[at - 1]) +
           (l->up[at] * y[at + stride] + l->up[at - stride] * y[at - stride]);
}

static void relax_rows(void *context, int first, int last) {
    const sweep *s = context;
    const multigrid_level *l = s->l;
    for (int j = first; j < last; j++) {
        for (size_t at = row(l, j), end = at + (size_t)l->nx; at < end; at++) {
            double y = (l->b[at] + inflow(l, s->from, at)) * l->inverse[at];
            s->to[at] = s->from[at] + s->part * (y - s->from[at]);
        }
    }
}

/* A damped Jacobi step from one array into another. */
static void relax(const multigrid *m, const multigrid_level *l, double part, const double *from,
                  double *to) {
    sweep s = {l, NULL, part, from, to};
    share_rows(m, relax_rows, &s, l->ny, l->nx);
}

/* The first step, from y = 0. */
static void relax_zero(void *context, int first, int last) {
    const multigrid_level *l = ((const sweep *)context)->l;
    for (int j = first; j < last; j++) {
        for (size_t at = row(l, j), end = at + (size_t)l->nx; at < end; at++) {
            l->work[at] = damping[0] * l->b[at] * l->inverse[at];
        }
    }
}

/* Both steps, y = 0 before them. */
static void relax_down(const multigrid *m, const multigrid_level *l) {
    sweep s = {.l = l};
    share_rows(m, relax_zero, &s, l->ny, l->nx);
    relax(m, l, damping[1], l->work, l->y);
}

static void relax_up(const multigrid *m, const multigrid_level *l) {
    relax(m, l, damping[1], l->y, l->work);
    relax(m, l, damping[0], l->work, l->y);
}

/* By rows of the coarse level. */
static void sum_residual(void *context, int first, int end) {
    const multigrid_level *l = ((const sweep *)context)->l;
    const multigrid_level *coarse = ((const sweep *)context)->coarse;
    memset(coarse->b + row(coarse, first), 0,
           (size_t)(end - first) * (size_t)coarse->stride * sizeof(double));
    for (int j = first_into(l, first); j < l->ny && l->into_y[j] < end; j++) {
        size_t at = row(l, j), to = row(coarse, l->into_y[j]);
        for (int i = 0; i < l->nx; i++, at++) {
            double out = diagonal(l, at) * l->y[at];
            coarse->b[to + (size_t)l->into_x[i]] += l->b[at] + inflow(l, l->y, at) - out;
        }
    }
}

static void restrict_residual(const multigrid *m, const multigrid_level *l) {
    sweep s = {.l = l, .coarse = l + 1};
    share_rows(m, sum_residual, &s, l[1].ny, l->nx);
}

static void add_rows(void *context, int first, int end) {
    const multigrid_level *l = ((const sweep *)context)->l;
    const multigrid_level *coarse = ((const sweep *)context)->coarse;
    for (int j = first; j < end; j++) {
        size_t at = row(l, j), from = row(coarse, l->into_y[j]);
        for (int i = 0; i < l->nx; i++, at++) {
            l->y[at] += l->inverse[at] > 0 ? coarse->y[from + (size_t)l->into_x[i]] : 0;
        }
    }
}

static void add_correction(const multigrid *m, const multigrid_level *l) {
    sweep s = {.l = l, .coarse = l + 1};
    share_rows(m, add_rows, &s, l->ny, l->nx);
}

/* The V-cycle; the last level is one cell, or cells that nothing connects. */
void ilsai_multigrid_cycle(multigrid *m) {
    for (int k = 0; k + 1 < m->levels; k++) {
        relax_down(m, &m->level[k]);
        restrict_residual(m, &m->level[k]);
    }
    const multigrid_level *last = &m->level[m->levels - 1];
    size_t only = row(last, 0);
    last->y[only] = last->b[only] * last->inverse[only];
    for (int k = m->levels - 2; k >= 0; k--) {
        add_correction(m, &m->level[k]);
        relax_up(m, &m->level[k]);
    }
}
