#include "solve/gmres.h"

#include "base/memory.h"
#include <cblas.h>
#include <float.h>
#include <math.h>
#include <string.h>

struct gmres {
    int restart;
    size_t capacity;    /* unknowns that there is room for */
    double *basis;      /* restart + 1 vectors: orthonormal basis of the Krylov space */
    double *vector;     /* 2 vectors of work */
    double *hessenberg; /* column k at k (restart + 1): upper triangle after the rotations */
    double *cosine, *sine, *rhs, *correction;
};

/* What one solve works on. */
typedef struct krylov {
    gmres *g;
    int n;
    gmres_operator *A, *M;
    void *context;
} krylov;

gmres *ilsai_gmres_create(int restart) {
    gmres *g = ilsai_allocate_zeroed(1, sizeof *g);
    size_t m = (size_t)restart;
    double *small = ilsai_allocate((m + 1) * m + 4 * (m + 1), sizeof *small);
    if (!g || !small) {
        ilsai_release(g);
        ilsai_release(small);
        return NULL;
    }
    g->restart = restart;
    g->hessenberg = small;
    g->cosine = small + (m + 1) * m;
    g->sine = g->cosine + m + 1;
    g->rhs = g->sine + m + 1;
    g->correction = g->rhs + m + 1;
    return g;
}

void ilsai_gmres_destroy(gmres **g) {
    if (!*g) {
        return;
    }
    ilsai_release((*g)->basis);
    ilsai_release((*g)->vector);
    ilsai_release((*g)->hessenberg);
    ilsai_release(*g);
    *g = NULL;
}

ilsa_status ilsai_gmres_reserve(gmres *g, size_t n) {
    const grown_array arrays[] = {{&g->basis, ((size_t)g->restart + 1) * sizeof *g->basis},
                                  {&g->vector, 2 * sizeof *g->vector}};
    return ilsai_grow(n, &g->capacity, arrays, sizeof arrays / sizeof *arrays);
}

/* The plain sum of squares is several times faster than dnrm2, which serves where it fails. */
static double norm(int n, const double *x) {
    double squares = cblas_ddot(n, x, 1, x, 1);
    if (squares > 1e-280 && squares < 1e280) {
        return sqrt(squares);
    }
    return isnan(squares) ? squares : cblas_dnrm2(n, x, 1);
}

static double *basis_vector(const krylov *s, int k) {
    return s->g->basis + (size_t)k * (size_t)s->n;
}

/* y = A M^-1 x */
static void apply(const krylov *s, const double *x, double *y) {
    if (s->M) {
        s->M(s->context, x, s->g->vector);
        x = s->g->vector;
    }
    s->A(s->context, x, y);
}

/* Takes the first `count` basis vectors out of w and adds what was taken to h. */
static void project_out(const krylov *s, int count, double *w, double *h) {
    double *taken = s->g->correction;
    cblas_dgemv(CblasColMajor, CblasTrans, s->n, count, 1, s->g->basis, s->n, w, 1, 0, taken, 1);
    cblas_dgemv(CblasColMajor, CblasNoTrans, s->n, count, -1, s->g->basis, s->n, taken, 1, 1, w, 1);
    cblas_daxpy(count, 1, taken, 1, h, 1);
}

/*
 * Classical Gram-Schmidt, a second time where the first has lost a digit or more to cancellation:
 * the basis stays orthogonal to ten roundings. Returns the norm of what is left of w, 0 where that
 * is rounding only.
 */
static double orthogonalise(const krylov *s, int count, double *w, double *h) {
    memset(h, 0, (size_t)count * sizeof *h);
    project_out(s, count, w, h);
    double left = norm(s->n, w), before = hypot(left, norm(count, h));
    if (left >= 0.1 * before) {
        return left;
    }
    project_out(s, count, w, h);
    left = norm(s->n, w);
    return left <= DBL_EPSILON * before ? 0 : left;
}

/* Rotates column k of the Hessenberg matrix into the triangle. Returns its diagonal entry. */
static double rotate(gmres *g, int k, double *h, double below) {
    for (int i = 0; i < k; i++) {
        double upper = h[i];
        h[i] = g->cosine[i] * upper + g->sine[i] * h[i + 1];
        h[i + 1] = g->cosine[i] * h[i + 1] - g->sine[i] * upper;
    }
    double radius = hypot(h[k], below);
    g->cosine[k] = radius > 0 ? h[k] / radius : 1;
    g->sine[k] = radius > 0 ? below / radius : 0;
    h[k] = radius;
    g->rhs[k + 1] = -g->sine[k] * g->rhs[k];
    g->rhs[k] *= g->cosine[k];
    return radius;
}

/* x += M^-1 V y, y from the k by k triangle. */
static void add_correction(const krylov *s, int k, double *x) {
    gmres *g = s->g;
    double *sum = g->vector + s->n;
    cblas_dcopy(k, g->rhs, 1, g->correction, 1);
    cblas_dtrsv(CblasColMajor, CblasUpper, CblasNoTrans, CblasNonUnit, k, g->hessenberg,
                g->restart + 1, g->correction, 1);
    cblas_dgemv(CblasColMajor, CblasNoTrans, s->n, k, 1, g->basis, s->n, g->correction, 1, 0, sum,
                1);
    if (s->M) {
        s->M(s->context, sum, g->vector);
        sum = g->vector;
    }
    cblas_daxpy(s->n, 1, sum, 1, x, 1);
}

enum { CYCLE_GOES_ON, CYCLE_DONE, CYCLE_BROKEN };

/*
 * One Arnoldi step; *k columns are good afterwards. A column that is not finite, or that adds
 * nothing because A is singular, is left out and breaks the cycle.
 */
static int extend(const krylov *s, int *k, double target) {
    gmres *g = s->g;
    double *w = basis_vector(s, *k + 1);
    double *h = g->hessenberg + (size_t)*k * ((size_t)g->restart + 1);
    apply(s, basis_vector(s, *k), w);
    double below = orthogonalise(s, *k + 1, w, h), size = hypot(below, norm(*k + 1, h));
    if (!isfinite(size)) {
        return CYCLE_BROKEN;
    }
    double kept = g->rhs[*k];
    if (rotate(g, *k, h, below) <= DBL_EPSILON * size) {
        g->rhs[*k] = kept;
        return CYCLE_BROKEN;
    }
    ++*k;
    if (below == 0 || fabs(g->rhs[*k]) <= target) {
        return CYCLE_DONE;
    }
    cblas_dscal(s->n, 1 / below, w, 1);
    return CYCLE_GOES_ON;
}

/* From the residual in basis vector 0, of norm beta: improves x, returns how the cycle ended. */
static int cycle(const krylov *s, double beta, double target, int products, double *x,
                 gmres_result *result) {
    gmres *g = s->g;
    int k = 0, state = CYCLE_GOES_ON;
    cblas_dscal(s->n, 1 / beta, basis_vector(s, 0), 1);
    g->rhs[0] = beta;
    while (state == CYCLE_GOES_ON && k < g->restart && k < products) {
        state = extend(s, &k, target);
        result->iterations++;
    }
    if (k > 0) {
        add_correction(s, k, x);
    }
    result->residual = fabs(g->rhs[k]);
    return state;
}

/* b - A x into basis vector 0; returns its norm. */
static double true_residual(const krylov *s, const double *b, const double *x) {
    double *r = basis_vector(s, 0);
    s->A(s->context, x, r);
    cblas_dscal(s->n, -1, r, 1);
    cblas_daxpy(s->n, 1, b, 1, r, 1);
    return norm(s->n, r);
}

gmres_result ilsai_gmres_solve(gmres *g, size_t n, gmres_operator *A, gmres_operator *M,
                               void *context, const double *b, double *x, double tolerance,
                               int max_iterations) {
    krylov s = {g, (int)n, A, M, context};
    double size = norm(s.n, b), beta = size, target = tolerance * size;
    gmres_result result = {0, beta, false};
    memset(x, 0, n * sizeof *x);
    memcpy(g->basis, b, n * sizeof *b);
    while (isfinite(beta) && beta > target && result.iterations < max_iterations) {
        int state = cycle(&s, beta, target, max_iterations - result.iterations, x, &result);
        if (state != CYCLE_GOES_ON || result.iterations + 1 >= max_iterations) {
            break;
        }
        beta = result.residual = true_residual(&s, b, x);
        result.iterations++;
    }
    result.converged = isfinite(size) && result.residual <= target && isfinite(norm(s.n, x));
    if (size > 0) {
        result.residual /= size;
    }
    return result;
}
