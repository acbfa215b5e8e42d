/* GMRES on matrices small enough to know the answer. */
#include "check.h"
#include "failing.h"
#include "solve/gmres.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A dense matrix by rows, a diagonal preconditioner, a count of products. */
typedef struct dense {
    size_t n;
    double *a, *diagonal;
    int products;
    double spoil; /* written over the first value of the product number `spoil_at` */
    int spoil_at;
} dense;

static void multiply(void *context, const double *x, double *y) {
    dense *d = context;
    for (size_t i = 0; i < d->n; i++) {
        y[i] = 0;
        for (size_t j = 0; j < d->n; j++)
            y[i] += d->a[i * d->n + j] * x[j];
    }
    if (++d->products == d->spoil_at)
        y[0] = d->spoil;
}

static void divide_by_diagonal(void *context, const double *x, double *y) {
    const dense *d = context;
    for (size_t i = 0; i < d->n; i++)
        y[i] = x[i] / d->diagonal[i];
}

/* Random entries over a diagonal that grows from 1 to `spread`. */
static dense make_dense(size_t n, double off, double spread) {
    dense d = {.n = n, .a = malloc(n * n * sizeof(double)), .diagonal = malloc(n * sizeof(double))};
    uint64_t seed = 17;
    if (!d.a || !d.diagonal)
        abort();
    for (size_t k = 0; k < n * n; k++)
        d.a[k] = off * next_random(&seed);
    for (size_t i = 0; i < n; i++) {
        d.diagonal[i] = 1 + (spread - 1) * (double)i / (double)n;
        for (size_t j = 0; j < n; j++)
            d.a[i * n + j] *= d.diagonal[i];
        d.a[i * n + i] += d.diagonal[i];
    }
    return d;
}

static void free_dense(dense *d) {
    free(d->a);
    free(d->diagonal);
}

static gmres *make_gmres(int restart, size_t n) {
    gmres *g = ilsai_gmres_create(restart);
    assert_non_null(g);
    assert_int_equal(ilsai_gmres_reserve(g, n), ILSA_OK);
    return g;
}

static double norm(size_t n, const double *x) {
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += x[i] * x[i];
    return sqrt(sum);
}

/* |b - A x| / |b| */
static double residual(dense *d, const double *b, const double *x) {
    double *r = malloc(d->n * sizeof *r);
    assert_non_null(r);
    multiply(d, x, r);
    for (size_t i = 0; i < d->n; i++)
        r[i] = b[i] - r[i];
    double size = norm(d->n, r) / norm(d->n, b);
    free(r);
    return size;
}

static double *ones(size_t n) {
    double *b = malloc(n * sizeof *b);
    assert_non_null(b);
    for (size_t i = 0; i < n; i++)
        b[i] = 1;
    return b;
}

/* One solve with a fresh handle; checks what must hold of any solve. */
static gmres_result solve(dense *d, int restart, gmres_operator *M, double *x, double tolerance,
                          int most) {
    double *b = ones(d->n);
    gmres *g = make_gmres(restart, d->n);
    d->products = 0;
    gmres_result result = ilsai_gmres_solve(g, d->n, multiply, M, d, b, x, tolerance, most);
    assert_int_equal(result.iterations, d->products);
    assert_true(result.iterations <= most);
    double truth = residual(d, b, x);
    assert_true(fabs(truth - result.residual) < 1e-12 + 1e-9 * truth);
    assert_int_equal(result.converged, result.residual <= tolerance);
    ilsai_gmres_destroy(&g);
    assert_null(g);
    ilsai_gmres_destroy(&g);
    free(b);
    return result;
}

static void residual_is_true_at_every_tolerance(void **state) {
    (void)state;
    dense d = make_dense(120, 0.1, 1000);
    double x[120];
    int last = 0;
    static const double tolerance[] = {1e-1, 1e-4, 1e-7, 1e-10, 1e-13};
    for (size_t t = 0; t < sizeof tolerance / sizeof *tolerance; t++) {
        gmres_result result = solve(&d, 150, divide_by_diagonal, x, tolerance[t], 150);
        print_message("tolerance %.0e: %d products, residual %.2e\n", tolerance[t],
                      result.iterations, result.residual);
        assert_true(result.converged);
        assert_true(result.iterations >= last);
        last = result.iterations;
    }
    free_dense(&d);
}

static void without_preconditioner(void **state) {
    (void)state;
    dense d = make_dense(60, 0.05, 2);
    double x[60];
    assert_true(solve(&d, 60, NULL, x, 1e-10, 60).converged);
    free_dense(&d);
}

static void restarts_converge(void **state) {
    (void)state;
    dense d = make_dense(100, 0.04, 50);
    double x[100];
    gmres_result whole = solve(&d, 100, divide_by_diagonal, x, 1e-10, 500);
    gmres_result restarted = solve(&d, 8, divide_by_diagonal, x, 1e-10, 500);
    print_message("%d products, %d when restarted every 8\n", whole.iterations,
                  restarted.iterations);
    assert_true(whole.converged && restarted.converged);
    assert_true(restarted.iterations >= whole.iterations);
    assert_true(solve(&d, 1, divide_by_diagonal, x, 1e-6, 5000).converged);
    free_dense(&d);
}

static void stops_at_the_limit(void **state) {
    (void)state;
    dense d = make_dense(100, 0.1, 50);
    double x[100];
    for (int most = 0; most < 14; most++) {
        gmres_result result = solve(&d, 4, NULL, x, 1e-12, most);
        assert_false(result.converged);
        assert_true(result.residual <= 1);
    }
    free_dense(&d);
}

/* As many distinct eigenvalues, as many products: the space is exhausted, not divided by zero. */
static void ends_when_the_space_is_exhausted(void **state) {
    (void)state;
    dense d = make_dense(30, 0, 1);
    double x[30];
    for (size_t i = 0; i < 30; i++)
        d.a[i * 30 + i] = i % 2 ? 3 : 1;
    gmres_result result = solve(&d, 30, NULL, x, 1e-14, 30);
    assert_true(result.converged);
    assert_int_equal(result.iterations, 2);
    free_dense(&d);
}

static void singular_matrix_is_not_solved(void **state) {
    (void)state;
    dense zero = make_dense(10, 0, 1), gap = make_dense(10, 0, 1);
    double x[10];
    memset(zero.a, 0, 100 * sizeof *zero.a);
    assert_false(solve(&zero, 10, NULL, x, 1e-6, 30).converged);
    gap.a[33] = 0; /* one row without an entry, one equation 0 = 1 */
    gmres_result result = solve(&gap, 10, NULL, x, 1e-6, 30);
    assert_false(result.converged);
    assert_true(fabs(result.residual - sqrt(0.1)) < 1e-12); /* least squares */
    free_dense(&zero);
    free_dense(&gap);
}

static void zero_right_hand_side(void **state) {
    (void)state;
    dense d = make_dense(10, 0.1, 1);
    double b[10] = {0}, x[10] = {1, 2, 3};
    gmres *g = make_gmres(5, 10);
    gmres_result result = ilsai_gmres_solve(g, 10, multiply, NULL, &d, b, x, 1e-6, 10);
    assert_true(result.converged);
    assert_int_equal(result.iterations, 0);
    assert_true(result.residual == 0);
    assert_true(norm(10, x) == 0);
    ilsai_gmres_destroy(&g);
    free_dense(&d);
}

/* Sizes whose squares leave the number range. */
static void any_scale_of_numbers(void **state) {
    (void)state;
    static const double scale[] = {1e-250, 1e-160, 1e160, 1e250};
    if (getenv("ILSA_VALGRIND"))
        skip(); /* where the norms of OpenBLAS are not of 80 bits */
    dense d = make_dense(20, 0.1, 3);
    gmres *g = make_gmres(20, 20);
    for (size_t s = 0; s < sizeof scale / sizeof *scale; s++) {
        double x[20], *b = ones(20);
        for (size_t i = 0; i < 20; i++)
            b[i] *= scale[s];
        gmres_result result = ilsai_gmres_solve(g, 20, multiply, NULL, &d, b, x, 1e-8, 20);
        assert_true(result.converged && result.residual < 1e-8);
        for (size_t i = 0; i < 20; i++)
            x[i] /= scale[s];
        for (size_t i = 0; i < 20; i++)
            b[i] = 1;
        assert_true(residual(&d, b, x) < 1.01e-8);
        free(b);
    }
    ilsai_gmres_destroy(&g);
    free_dense(&d);
}

static void bad_numbers_end_it(void **state) {
    (void)state;
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    dense d = make_dense(40, 0.1, 5);
    gmres *g = make_gmres(6, 40);
    double x[40], *b = ones(40);
    for (size_t k = 0; k < 3; k++) {
        d.spoil = bad[k];
        for (d.spoil_at = 1; d.spoil_at < 15; d.spoil_at++) {
            d.products = 0;
            gmres_result result = ilsai_gmres_solve(g, 40, multiply, NULL, &d, b, x, 1e-12, 100);
            assert_false(result.converged);
            assert_int_equal(result.iterations, d.spoil_at);
            assert_true(isfinite(norm(40, x)));
        }
        d.spoil_at = 0;
        b[7] = bad[k];
        gmres_result result = ilsai_gmres_solve(g, 40, multiply, NULL, &d, b, x, 1e-12, 100);
        assert_false(result.converged);
        assert_int_equal(result.iterations, 0);
        assert_true(norm(40, x) == 0);
        b[7] = 1;
    }
    free(b);
    ilsai_gmres_destroy(&g);
    free_dense(&d);
}

static void spoil_all(void *context, const double *x, double *y) {
    const dense *d = context;
    (void)x;
    for (size_t i = 0; i < d->n; i++)
        y[i] = NAN;
}

static void bad_preconditioner_ends_it(void **state) {
    (void)state;
    dense d = make_dense(40, 0.1, 5);
    gmres *g = make_gmres(6, 40);
    double x[40], *b = ones(40);
    gmres_result result = ilsai_gmres_solve(g, 40, multiply, spoil_all, &d, b, x, 1e-12, 100);
    assert_false(result.converged);
    assert_int_equal(result.iterations, 1);
    assert_true(norm(40, x) == 0);
    free(b);
    ilsai_gmres_destroy(&g);
    free_dense(&d);
}

static void one_handle_serves_many_sizes(void **state) {
    (void)state;
    gmres *g = ilsai_gmres_create(50);
    assert_non_null(g);
    static const size_t size[] = {10, 200, 3, 201, 400, 50};
    for (size_t k = 0; k < sizeof size / sizeof *size; k++) {
        dense d = make_dense(size[k], 0.02, 3);
        double *b = ones(size[k]), *x = ones(size[k]);
        assert_int_equal(ilsai_gmres_reserve(g, size[k]), ILSA_OK);
        assert_true(ilsai_gmres_solve(g, size[k], multiply, divide_by_diagonal, &d, b, x, 1e-9, 50)
                        .converged);
        assert_true(residual(&d, b, x) < 1.01e-9);
        free(b);
        free(x);
        free_dense(&d);
    }
    ilsai_gmres_destroy(&g);
}

static void no_memory_leaves_it_as_it_was(void **state) {
    (void)state;
    gmres *g = make_gmres(50, 20);
    dense d = make_dense(20, 0.02, 3);
    double x[20], *b = ones(20);
    assert_int_equal(ilsai_gmres_reserve(g, SIZE_MAX / 8 / 51), ILSA_ERR_MEMORY);
    assert_true(ilsai_gmres_solve(g, 20, multiply, NULL, &d, b, x, 1e-9, 50).converged);
    for (int most = 0; most < 2; most++) {
        allocations_left = most;
        gmres *none = ilsai_gmres_create(50);
        allocations_left = most;
        ilsa_status status = ilsai_gmres_reserve(g, 1000);
        allocations_left = -1;
        assert_null(none);
        assert_int_equal(status, ILSA_ERR_MEMORY);
        assert_true(ilsai_gmres_solve(g, 20, multiply, NULL, &d, b, x, 1e-9, 50).converged);
    }
    free(b);
    free_dense(&d);
    ilsai_gmres_destroy(&g);
}

/* Eigenvalues over eight decades: no better than rounding times the condition can be had. */
static void ill_conditioned_matrix(void **state) {
    (void)state;
    dense d = make_dense(50, 0, 1);
    double x[50];
    for (size_t i = 0; i < 50; i++) {
        d.a[i * 50 + i] = pow(10, -8 * (double)i / 49);
        if (i + 1 < 50)
            d.a[i * 50 + i + 1] = 0.3 * d.a[i * 50 + i];
    }
    double *b = ones(50);
    gmres *g = make_gmres(50, 50);
    gmres_result result = ilsai_gmres_solve(g, 50, multiply, NULL, &d, b, x, 1e-9, 50);
    print_message("condition 1e8: %d products, residual %.2e, in truth %.2e\n", result.iterations,
                  result.residual, residual(&d, b, x));
    assert_true(result.converged);
    assert_true(residual(&d, b, x) < 1e-9);
    free(b);
    ilsai_gmres_destroy(&g);
    free_dense(&d);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(residual_is_true_at_every_tolerance),
        cmocka_unit_test(without_preconditioner),
        cmocka_unit_test(restarts_converge),
        cmocka_unit_test(stops_at_the_limit),
        cmocka_unit_test(ends_when_the_space_is_exhausted),
        cmocka_unit_test(singular_matrix_is_not_solved),
        cmocka_unit_test(zero_right_hand_side),
        cmocka_unit_test(any_scale_of_numbers),
        cmocka_unit_test(bad_numbers_end_it),
        cmocka_unit_test(bad_preconditioner_ends_it),
        cmocka_unit_test(one_handle_serves_many_sizes),
        cmocka_unit_test(no_memory_leaves_it_as_it_was),
        cmocka_unit_test(ill_conditioned_matrix),
    };
    return cmocka_run_group_tests_name("gmres", tests, NULL, NULL);
}
