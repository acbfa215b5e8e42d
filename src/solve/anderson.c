#include "solve/anderson.h"

#include "base/error.h"
#include "base/memory.h"
#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { DEPTH_MAX = 10 };

struct anderson {
    int depth, n;
    size_t capacity; /* unknowns that there is room for */
    int columns;     /* differences that can be of use: depth, at most n */
    int kept;        /* differences held, <= depth */
    int next;        /* column that the next difference goes to */
    bool have_last;  /* last_g and last_f are set */
    double smallest; /* smallest residual norm since the last restart */
    double *last_g, *last_f;
    double *delta_g, *delta_f; /* n by depth, differences of g and of f = g - x */
    double *matrix, *rhs;      /* least squares, destroyed by the factorisation */
    double work[64 * DEPTH_MAX];
};

anderson *ilsai_anderson_create(int depth) {
    anderson *a = ilsai_allocate_zeroed(1, sizeof *a);
    if (a) {
        a->depth = depth;
    }
    return a;
}

void ilsai_anderson_destroy(anderson **a) {
    if (*a) {
        ilsai_release((*a)->last_g);
        ilsai_release((*a)->last_f);
        ilsai_release((*a)->delta_g);
        ilsai_release((*a)->delta_f);
        ilsai_release((*a)->matrix);
        ilsai_release((*a)->rhs);
        ilsai_release(*a);
        *a = NULL;
    }
}

ilsa_status ilsai_anderson_begin(anderson *a, int n) {
    const size_t columns = (size_t)a->depth * sizeof(double);
    const grown_array arrays[] = {ILSAI_GROWN(a->last_g), ILSAI_GROWN(a->last_f),
                                  ILSAI_GROWN(a->rhs),    {&a->delta_g, columns},
                                  {&a->delta_f, columns}, {&a->matrix, columns}};
    ILSAI_TRY(ilsai_grow((size_t)n, &a->capacity, arrays, sizeof arrays / sizeof *arrays));
    a->n = n;
    a->columns = a->depth < n ? a->depth : n;
    a->kept = a->next = 0;
    a->have_last = false;
    a->smallest = INFINITY;
    return ILSA_OK;
}

/* Stores the differences to the last evaluation. */
static void remember(anderson *a, const double *g, const double *x) {
    size_t n = (size_t)a->n;
    double *column_g = a->delta_g + (size_t)a->next * n,
           *column_f = a->delta_f + (size_t)a->next * n;
    if (a->have_last && a->columns > 0) {
        for (size_t k = 0; k < n; k++) {
            column_g[k] = g[k] - a->last_g[k];
            column_f[k] = g[k] - x[k] - a->last_f[k];
        }
        a->next = (a->next + 1) % a->columns;
        a->kept += a->kept < a->columns;
    }
    for (size_t k = 0; k < n; k++) {
        a->last_g[k] = g[k];
        a->last_f[k] = g[k] - x[k];
    }
    a->have_last = true;
}

static double residual_norm(const anderson *a, const double *g, const double *x) {
    double sum = 0;
    for (int k = 0; k < a->n; k++) {
        sum += (g[k] - x[k]) * (g[k] - x[k]);
    }
    return sqrt(sum);
}

/* Weights of the differences that make the residual least; false if there is no sound solution. */
static bool weights(anderson *a, int columns) {
    size_t size = (size_t)a->n * (size_t)columns;
    memcpy(a->matrix, a->delta_f, size * sizeof(double));
    memcpy(a->rhs, a->last_f, (size_t)a->n * sizeof(double));
    if (LAPACKE_dgels_work(LAPACK_COL_MAJOR, 'N', a->n, columns, 1, a->matrix, a->n, a->rhs, a->n,
                           a->work, (lapack_int)(sizeof a->work / sizeof *a->work)) != 0) {
        return false;
    }
    double sum = 0;
    for (int k = 0; k < columns; k++) {
        sum += fabs(a->rhs[k]);
    }
    return sum < 1e4;
}

void ilsai_anderson_next(anderson *a, const double *g, double *x) {
    double norm = residual_norm(a, g, x);
    if (norm > 2 * a->smallest) {
        a->kept = a->next = 0;
        a->have_last = false;
        a->smallest = norm;
    }
    a->smallest = norm < a->smallest ? norm : a->smallest;
    remember(a, g, x);
    memcpy(x, g, (size_t)a->n * sizeof(double));
    if (a->kept == 0 || !weights(a, a->kept)) {
        return;
    }
    for (int c = 0; c < a->kept; c++) {
        for (int k = 0; k < a->n; k++) {
            x[k] -= a->rhs[c] * a->delta_g[(size_t)c * (size_t)a->n + (size_t)k];
        }
    }
}
