#include "solve/anderson.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_MAX = 10 };

struct anderson {
    int depth, n, capacity;
    int columns;     /* differences that can be of use: depth, at most n */
    int kept;        /* differences held, <= depth */
    int next;        /* column that the next difference goes to */
    int have_last;   /* last_g and last_f are set */
    double smallest; /* smallest residual norm since the last restart */
    double *last_g, *last_f;
    double *delta_g, *delta_f; /* n by depth, differences of g and of f = g - x */
    double *matrix, *rhs;      /* least squares, destroyed by the factorisation */
    double work[64 * DEPTH_MAX];
};

anderson *ilsai_anderson_create(int depth) {
    anderson *a = calloc(1, sizeof *a);
    if (a) {
        a->depth = depth;
    }
    return a;
}

static void release(anderson *a) {
    free(a->last_g);
    free(a->last_f);
    free(a->delta_g);
    free(a->delta_f);
    free(a->matrix);
    free(a->rhs);
}

void ilsai_anderson_destroy(anderson **a) {
    if (*a) {
        release(*a);
        free(*a);
        *a = NULL;
    }
}

static ilsa_status reserve(anderson *a, int n) {
    if (n <= a->capacity) {
        return ILSA_OK;
    }
    anderson grown = {.depth = a->depth, .capacity = n + n / 2 + 16};
    size_t rows = (size_t)grown.capacity, columns = (size_t)(a->depth > 0 ? a->depth : 1);
    grown.last_g = malloc(rows * sizeof(double));
    grown.last_f = malloc(rows * sizeof(double));
    grown.delta_g = malloc(rows * columns * sizeof(double));
    grown.delta_f = malloc(rows * columns * sizeof(double));
    grown.matrix = malloc(rows * columns * sizeof(double));
    grown.rhs = malloc(rows * sizeof(double));
    if (!grown.last_g || !grown.last_f || !grown.delta_g || !grown.delta_f || !grown.matrix ||
        !grown.rhs) {
        release(&grown);
        return ILSA_ERR_MEMORY;
    }
    release(a);
    *a = grown;
    return ILSA_OK;
}

ilsa_status ilsai_anderson_begin(anderson *a, int n) {
    if (reserve(a, n) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    a->n = n;
    a->columns = a->depth < n ? a->depth : n;
    a->kept = a->next = a->have_last = 0;
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
    a->have_last = 1;
}

static double residual_norm(const anderson *a, const double *g, const double *x) {
    double sum = 0;
    for (int k = 0; k < a->n; k++) {
        sum += (g[k] - x[k]) * (g[k] - x[k]);
    }
    return sqrt(sum);
}

/* Weights of the differences that make the residual least; 0 if there is no sound solution. */
static int weights(anderson *a, int columns) {
    size_t size = (size_t)a->n * (size_t)columns;
    memcpy(a->matrix, a->delta_f, size * sizeof(double));
    memcpy(a->rhs, a->last_f, (size_t)a->n * sizeof(double));
    if (LAPACKE_dgels_work(LAPACK_COL_MAJOR, 'N', a->n, columns, 1, a->matrix, a->n, a->rhs, a->n,
                           a->work, (lapack_int)(sizeof a->work / sizeof *a->work)) != 0) {
        return 0;
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
        a->kept = a->next = a->have_last = 0;
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
