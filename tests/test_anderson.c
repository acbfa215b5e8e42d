/* Anderson acceleration on fixed points that are known. */
#include "check.h"
#include "failing.h"
#include "solve/anderson.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE_MAX_TESTED = 400, DEPTH_MAX = 10 };

static anderson *make(int depth, int n) {
    anderson *a = ilsai_anderson_create(depth);
    assert_non_null(a);
    assert_int_equal(ilsai_anderson_begin(a, n), ILSA_OK);
    return a;
}

/* The map x -> truth + M (x - truth) with |M| about norm in every direction. */
typedef struct linear_map {
    int n;
    double truth[DEPTH_MAX], matrix[DEPTH_MAX][DEPTH_MAX];
} linear_map;

static linear_map make_map(int n, double norm, uint64_t seed) {
    linear_map m = {.n = n};
    double sum = 0;
    for (int i = 0; i < n; i++) {
        m.truth[i] = next_random(&seed);
        for (int j = 0; j < n; j++) {
            m.matrix[i][j] = next_random(&seed);
            sum += m.matrix[i][j] * m.matrix[i][j];
        }
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            m.matrix[i][j] *= norm / sqrt(sum);
        }
    }
    return m;
}

static void apply(const linear_map *m, const double *x, double *g) {
    for (int i = 0; i < m->n; i++) {
        g[i] = m->truth[i];
        for (int j = 0; j < m->n; j++) {
            g[i] += m->matrix[i][j] * (x[j] - m->truth[j]);
        }
    }
}

static double distance(const linear_map *m, const double *x) {
    double worst = NOTHING_YET;
    for (int i = 0; i < m->n; i++) {
        worst = worst_of(worst, fabs(x[i] - m->truth[i]));
    }
    return worst;
}

/* Distance from the fixed point after some steps from zero. */
static double after_steps(const linear_map *m, int depth, int steps) {
    double x[DEPTH_MAX] = {0}, g[DEPTH_MAX];
    anderson *a = make(depth, m->n);
    for (int k = 0; k < steps; k++) {
        apply(m, x, g);
        ilsai_anderson_next(a, g, x);
    }
    ilsai_anderson_destroy(&a);
    return distance(m, x);
}

/* n + 1 evaluations span the space: the combination of no residual is the solution. */
static void linear_fixed_point_in_n_plus_1_steps(void **state) {
    (void)state;
    double worst = NOTHING_YET, plain = INFINITY;
    for (int n = 1; n <= 8; n++) {
        for (uint64_t seed = 1; seed <= 20; seed++) {
            linear_map m = make_map(n, 0.9, seed);
            worst = worst_of(worst, after_steps(&m, n, n + 1));
            worst = worst_of(worst, after_steps(&m, DEPTH_MAX, n + 1));
            plain = n > 1 ? smaller_of(plain, after_steps(&m, n, n)) : plain;
        }
    }
    print_message("linear, n <= 8: worst error %.2g after n + 1 steps, best %.2g after n\n", worst,
                  plain);
    assert_below(worst, 1e-9);
    assert_above(plain, 1e-8); /* one step less is not enough: the solution was not known before */
}

/* The plain iteration turns and grows by a quarter each time. */
static void diverging_iteration_converges(void **state) {
    (void)state;
    linear_map m = {.n = 2, .truth = {2, -1}, .matrix = {{0, -1.25}, {1.25, 0}}};
    assert_true(after_steps(&m, 0, 3) > 2);
    assert_true(after_steps(&m, 2, 3) < 1e-13);
}

static void depth_zero_is_plain_iteration(void **state) {
    (void)state;
    linear_map m = make_map(6, 0.9, 5);
    double x[DEPTH_MAX] = {0}, g[DEPTH_MAX];
    anderson *a = make(0, m.n);
    for (int k = 0; k < 20; k++) {
        apply(&m, x, g);
        ilsai_anderson_next(a, g, x);
        assert_memory_equal(x, g, sizeof(double) * 6);
    }
    ilsai_anderson_destroy(&a);
}

static void first_step_is_plain(void **state) {
    (void)state;
    for (int depth = 0; depth <= DEPTH_MAX; depth++) {
        double x[] = {1, 2, 3}, g[] = {1.5, -2, 0.25};
        anderson *a = make(depth, 3);
        ilsai_anderson_next(a, g, x);
        assert_memory_equal(x, g, sizeof g);
        ilsai_anderson_destroy(&a);
    }
}

/* With one earlier iterate it is the secant method along the residual's change. */
static void depth_one_is_the_secant_step(void **state) {
    (void)state;
    uint64_t seed = 3;
    anderson *a = make(1, 4);
    double x[4], g[4], last_g[4], last_f[4] = {0};
    for (int step = 0; step < 12; step++) {
        double up = 0, down = 0, scale = pow(0.9, step), f[4], used[4];
        for (int k = 0; k < 4; k++) {
            used[k] = x[k] = next_random(&seed);
            f[k] = scale * (1 + 0.3 * next_random(&seed));
            g[k] = x[k] + f[k];
        }
        ilsai_anderson_next(a, g, x);
        for (int k = 0; k < 4; k++) {
            up += (f[k] - last_f[k]) * (g[k] - used[k]);
            down += (f[k] - last_f[k]) * (f[k] - last_f[k]);
        }
        for (int k = 0; k < 4; k++) {
            double expected = g[k] - (step > 0 ? up / down * (g[k] - last_g[k]) : 0);
            assert_true(fabs(x[k] - expected) < 1e-12 * (1 + fabs(up / down)));
            last_g[k] = g[k];
            last_f[k] = g[k] - used[k];
        }
    }
    ilsai_anderson_destroy(&a);
}

/* Residuals by hand: 1, then what follows. Returns whether the last step was g itself. */
static int is_plain_after(const double *residual, int count) {
    anderson *a = make(3, 2);
    double x[2] = {0, 0}, g[2] = {0, 0};
    for (int k = 0; k < count; k++) {
        double angle = 0.7 * k;
        g[0] = x[0] + residual[k] * cos(angle);
        g[1] = x[1] + residual[k] * sin(angle);
        ilsai_anderson_next(a, g, x);
    }
    ilsai_anderson_destroy(&a);
    return x[0] == g[0] && x[1] == g[1];
}

static void growth_drops_the_memory(void **state) {
    (void)state;
    const double falls[] = {1, 0.5}, grows_little[] = {1, 1.9}, grows[] = {1, 2.1};
    assert_false(is_plain_after(falls, 2));
    assert_false(is_plain_after(grows_little, 2));
    assert_true(is_plain_after(grows, 2));
    /* It is the smallest residual that counts, not the last one. */
    const double slowly[] = {1, 1.5, 2.1}, from_smallest[] = {1, 0.5, 1.1};
    assert_true(is_plain_after(slowly, 3));
    assert_true(is_plain_after(from_smallest, 3));
    /* After a drop what counts is the smallest residual since. */
    const double anew[] = {1, 4, 7}, too_far[] = {1, 4, 9};
    assert_false(is_plain_after(anew, 3));
    assert_true(is_plain_after(too_far, 3));
}

/* After a drop it goes on as if begun there. */
static void nothing_older_than_the_drop_is_used(void **state) {
    (void)state;
    linear_map m = make_map(5, 0.9, 11);
    anderson *seasoned = make(5, 5), *fresh = make(5, 5);
    double x[5] = {0}, y[5], g[5];
    for (int k = 0; k < 3; k++) {
        apply(&m, x, g);
        ilsai_anderson_next(seasoned, g, x);
    }
    for (int k = 0; k < 5; k++) {
        y[k] = x[k] = 100.0 * (k + 1);
    }
    for (int step = 0; step < 5; step++) {
        apply(&m, x, g);
        ilsai_anderson_next(seasoned, g, x);
        apply(&m, y, g);
        ilsai_anderson_next(fresh, g, y);
        assert_memory_equal(x, y, sizeof x);
    }
    ilsai_anderson_destroy(&seasoned);
    ilsai_anderson_destroy(&fresh);
}

static void begin_forgets(void **state) {
    (void)state;
    linear_map m = make_map(4, 0.9, 2);
    anderson *a = make(5, 4);
    double x[4] = {0}, y[4] = {0}, g[4];
    for (int k = 0; k < 3; k++) {
        apply(&m, x, g);
        ilsai_anderson_next(a, g, x);
    }
    assert_int_equal(ilsai_anderson_begin(a, 4), ILSA_OK);
    memset(x, 0, sizeof x);
    anderson *fresh = make(5, 4);
    for (int k = 0; k < 4; k++) {
        apply(&m, x, g);
        ilsai_anderson_next(a, g, x);
        apply(&m, y, g);
        ilsai_anderson_next(fresh, g, y);
        assert_memory_equal(x, y, sizeof x);
    }
    ilsai_anderson_destroy(&a);
    ilsai_anderson_destroy(&fresh);
}

/* At the fixed point all differences vanish; it must stay there. */
static void stays_at_the_fixed_point(void **state) {
    (void)state;
    linear_map m = make_map(3, 0.8, 9);
    anderson *a = make(5, 3);
    double x[3] = {0}, g[3];
    for (int k = 0; k < 60; k++) {
        apply(&m, x, g);
        ilsai_anderson_next(a, g, x);
        assert_true(k < 25 || distance(&m, x) < 1e-12);
    }
    ilsai_anderson_destroy(&a);
}

/* x_k -> a weighted mean of cos(x_k) and its neighbours: returns evaluations to 1e-12. */
static int evaluations(int depth, int n, double stiffness) {
    double x[SIZE_MAX_TESTED] = {0}, g[SIZE_MAX_TESTED], change = 1;
    anderson *a = make(depth, n);
    int count = 0;
    while (!(change < 1e-12) && count < 2000) {
        change = NOTHING_YET;
        for (int k = 0; k < n; k++) {
            double left = x[k > 0 ? k - 1 : 0], right = x[k < n - 1 ? k + 1 : n - 1];
            g[k] = (1 - stiffness) * cos(x[k] + 0.5 * k / n) + stiffness * 0.5 * (left + right);
            change = worst_of(change, fabs(g[k] - x[k]));
        }
        ilsai_anderson_next(a, g, x);
        count++;
    }
    ilsai_anderson_destroy(&a);
    return count;
}

static void curved_fixed_points_need_fewer_evaluations(void **state) {
    (void)state;
    int plain = evaluations(0, SIZE_MAX_TESTED, 0.9);
    int deep = evaluations(5, SIZE_MAX_TESTED, 0.9);
    print_message("%d unknowns, curved: %d evaluations plain, %d with depth 5\n", SIZE_MAX_TESTED,
                  plain, deep);
    assert_true(2 * deep < plain && plain < 2000);
}

/* More memory than there are unknowns: the oldest of it is of no use, the rest is. */
static void depth_beyond_the_unknowns_is_no_worse(void **state) {
    (void)state;
    for (int n = 1; n <= 4; n++) {
        int enough = evaluations(n, n, 0.1), more = evaluations(DEPTH_MAX, n, 0.1);
        print_message("%d unknowns: %d evaluations with depth %d, %d with depth %d\n", n, enough, n,
                      more, DEPTH_MAX);
        assert_true(more <= enough + 2);
    }
}

static void one_handle_serves_many_sizes(void **state) {
    (void)state;
    static const int sizes[] = {3, SIZE_MAX_TESTED, 1, 8, 100};
    anderson *a = ilsai_anderson_create(DEPTH_MAX);
    assert_non_null(a);
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        int n = sizes[s];
        double x[SIZE_MAX_TESTED] = {0}, g[SIZE_MAX_TESTED], worst = NOTHING_YET;
        assert_int_equal(ilsai_anderson_begin(a, n), ILSA_OK);
        for (int step = 0; step < 60; step++) {
            for (int k = 0; k < n; k++) {
                g[k] = 1 + (0.1 + 0.4 * k / n) * (x[k] - 1);
            }
            ilsai_anderson_next(a, g, x);
        }
        for (int k = 0; k < n; k++) {
            worst = worst_of(worst, fabs(x[k] - 1));
        }
        assert_below(worst, 1e-12);
    }
    ilsai_anderson_destroy(&a);
    assert_null(a);
    ilsai_anderson_destroy(&a);
}

static void no_unknowns(void **state) {
    (void)state;
    double none = 7;
    anderson *a = make(5, 0);
    for (int k = 0; k < 4; k++) {
        ilsai_anderson_next(a, &none, &none);
    }
    assert_true(none == 7);
    ilsai_anderson_destroy(&a);
}

/* A residual that is no number must not be kept: the next ones are plain, then it recovers. */
static void recovers_from_bad_numbers(void **state) {
    (void)state;
    linear_map m = make_map(4, 0.5, 21);
    anderson *a = make(3, 4);
    double x[4] = {0}, g[4];
    for (int k = 0; k < 40; k++) {
        apply(&m, x, g);
        if (k == 2) {
            double bad[4] = {NAN, 0, 0, 0}, spoilt[4] = {0};
            ilsai_anderson_next(a, bad, spoilt);
        }
        ilsai_anderson_next(a, g, x);
    }
    assert_true(distance(&m, x) < 1e-10);
    ilsai_anderson_destroy(&a);
}

static void no_memory_leaves_it_as_it_was(void **state) {
    (void)state;
    linear_map m = make_map(4, 0.9, 2);
    anderson *a = make(5, 4);
    for (int allowed = 0; allowed < 6; allowed++) {
        double x[4] = {0}, g[4];
        allocations_left = allowed;
        ilsa_status status = ilsai_anderson_begin(a, 10000);
        allocations_left = -1;
        assert_int_equal(status, ILSA_ERR_MEMORY);
        assert_int_equal(ilsai_anderson_begin(a, 4), ILSA_OK);
        for (int k = 0; k < 5; k++) {
            apply(&m, x, g);
            ilsai_anderson_next(a, g, x);
        }
        assert_true(distance(&m, x) < 1e-9);
    }
    allocations_left = 0;
    anderson *none = ilsai_anderson_create(5);
    allocations_left = -1;
    assert_null(none);
    ilsai_anderson_destroy(&a);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_fixed_point_in_n_plus_1_steps),
        cmocka_unit_test(diverging_iteration_converges),
        cmocka_unit_test(depth_zero_is_plain_iteration),
        cmocka_unit_test(first_step_is_plain),
        cmocka_unit_test(depth_one_is_the_secant_step),
        cmocka_unit_test(growth_drops_the_memory),
        cmocka_unit_test(nothing_older_than_the_drop_is_used),
        cmocka_unit_test(begin_forgets),
        cmocka_unit_test(stays_at_the_fixed_point),
        cmocka_unit_test(curved_fixed_points_need_fewer_evaluations),
        cmocka_unit_test(depth_beyond_the_unknowns_is_no_worse),
        cmocka_unit_test(one_handle_serves_many_sizes),
        cmocka_unit_test(no_unknowns),
        cmocka_unit_test(recovers_from_bad_numbers),
        cmocka_unit_test(no_memory_leaves_it_as_it_was),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
