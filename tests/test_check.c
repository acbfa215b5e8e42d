/* Tests of what tests are made of: with a NaN, an infinity or an empty set anywhere, they fail. */
#include "check.h"

#include <stdbool.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

/* Whether a test fails: run by a cmocka of its own in a child, which does not say so. */
static bool fails(CMUnitTestFunction test) {
    fflush(NULL);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        const struct CMUnitTest alone[] = {{"alone", test, NULL, NULL, NULL}};
        const bool quiet = freopen("/dev/null", "w", stdout) && freopen("/dev/null", "w", stderr);
        _exit(quiet ? cmocka_run_group_tests(alone, NULL, NULL) : 2);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) <= 1);
    return WEXITSTATUS(status) == 1;
}

/* ---- What the tests below are run on -------------------------------------------------------- */

static double error[3], bound, expected;
static int errors;

static bool fails_on(CMUnitTestFunction test, int count, double a, double b, double c) {
    errors = count;
    error[0] = a;
    error[1] = b;
    error[2] = c;
    return fails(test);
}

static double worst_error(void) {
    double worst = NOTHING_YET;
    for (int k = 0; k < errors; k++)
        worst = worst_of(worst, error[k]);
    return worst;
}

static void worst_is_below(void **state) {
    (void)state;
    assert_below(worst_error(), bound);
}

/* Each of two sets has its worst: of all errors, and of the first alone. */
static void worst_of_worsts_is_below(void **state) {
    (void)state;
    const double all = worst_of(NOTHING_YET, worst_error());
    assert_below(worst_of(all, error[0]), bound);
}

static void least_is_above(void **state) {
    (void)state;
    double least = INFINITY;
    for (int k = 0; k < errors; k++)
        least = smaller_of(least, error[k]);
    assert_above(least, bound);
}

static void first_is_near(void **state) {
    (void)state;
    assert_near(error[0], expected, bound);
}

static void first_is_relatively_near(void **state) {
    (void)state;
    assert_below(relative(error[0], expected), bound);
}

/* Errors over the largest value, which are the same three. */
static void parts_of_the_largest_are_below(void **state) {
    (void)state;
    double largest = 0;
    for (int k = 0; k < errors; k++)
        largest = larger_of(largest, fabs(error[k]));
    assert_below(1e-3 * worst_error() / largest, bound);
}

/* ---- The tests ------------------------------------------------------------------------------ */

static void passes_with_small_errors(void **state) {
    (void)state;
    bound = 1e-12;
    assert_false(fails_on(worst_is_below, 3, 1e-15, 3e-15, 2e-15));
    assert_false(fails_on(worst_is_below, 1, 1e-12, 0, 0)); /* the bound itself */
    assert_false(fails_on(worst_of_worsts_is_below, 2, 1e-15, 0, 0));
    bound = 0;
    assert_false(fails_on(worst_is_below, 3, 0, 0, 0));
}

static void fails_with_a_large_error_anywhere(void **state) {
    (void)state;
    bound = 1e-12;
    assert_true(fails_on(worst_is_below, 3, 2e-12, 0, 0));
    assert_true(fails_on(worst_is_below, 3, 0, 2e-12, 0));
    assert_true(fails_on(worst_is_below, 3, 0, 0, 2e-12));
    assert_true(fails_on(worst_of_worsts_is_below, 2, 0, 2e-12, 0));
}

/* Tests of collected values, with a value and a bound of which they pass. */
static const struct {
    CMUnitTestFunction test;
    double good, bound;
} collecting[] = {{worst_is_below, 1e-5, 1e-3},
                  {worst_of_worsts_is_below, 1e-5, 1e-3},
                  {parts_of_the_largest_are_below, 1e-5, 1e-2},
                  {least_is_above, 2, 1}};
enum { COLLECTING = sizeof collecting / sizeof *collecting };

static void fails_with_a_nan_anywhere(void **state) {
    (void)state;
    for (int n = 0; n < COLLECTING; n++) {
        const CMUnitTestFunction test = collecting[n].test;
        const double good = collecting[n].good;
        bound = collecting[n].bound;
        assert_false(fails_on(test, 3, good, good, good));
        assert_true(fails_on(test, 3, NAN, good, good));
        assert_true(fails_on(test, 3, good, NAN, good));
        assert_true(fails_on(test, 3, good, good, NAN));
        assert_true(fails_on(test, 3, good, -NAN, good));
        assert_true(fails_on(test, 1, NAN, 0, 0));
    }
}

/* An infinity among the values, and one for a bound, which nothing would exceed. */
static void fails_with_an_infinity(void **state) {
    (void)state;
    for (int n = 0; n < COLLECTING; n++) {
        const CMUnitTestFunction test = collecting[n].test;
        const double good = collecting[n].good, beyond = test == least_is_above ? -1 : 1;
        bound = collecting[n].bound;
        assert_true(fails_on(test, 3, good, beyond * INFINITY, good));
        bound = beyond * INFINITY;
        assert_true(fails_on(test, 3, good, beyond * INFINITY, good));
        assert_true(fails_on(test, 3, good, good, good));
        bound = NAN;
        assert_true(fails_on(test, 3, good, good, good));
    }
}

static void fails_with_an_empty_set(void **state) {
    (void)state;
    for (int n = 0; n < COLLECTING; n++) {
        bound = collecting[n].bound;
        assert_true(fails_on(collecting[n].test, 0, collecting[n].good, 0, 0));
    }
}

static void nearness(void **state) {
    (void)state;
    static const CMUnitTestFunction test[] = {first_is_near, first_is_relatively_near};
    for (int n = 0; n < 2; n++) {
        bound = 1e-3;
        expected = 1;
        assert_false(fails_on(test[n], 1, 1.0005, 0, 0));
        assert_false(fails_on(test[n], 1, 0.9995, 0, 0));
        assert_true(fails_on(test[n], 1, 1.002, 0, 0));
        assert_true(fails_on(test[n], 1, 0.998, 0, 0));
        assert_true(fails_on(test[n], 1, NAN, 0, 0));
        assert_true(fails_on(test[n], 1, INFINITY, 0, 0));
        assert_true(fails_on(test[n], 1, -INFINITY, 0, 0));
        expected = NAN;
        assert_true(fails_on(test[n], 1, 1, 0, 0));
        assert_true(fails_on(test[n], 1, NAN, 0, 0));
        expected = INFINITY;
        assert_true(fails_on(test[n], 1, 1, 0, 0));
        expected = 0;
        assert_false(fails_on(test[n], 1, 0.0005, 0, 0));
        assert_true(fails_on(test[n], 1, 0.002, 0, 0));
        assert_true(fails_on(test[n], 1, NAN, 0, 0));
        expected = 1;
        bound = INFINITY;
        assert_true(fails_on(test[n], 1, 1, 0, 0));
        bound = NAN;
        assert_true(fails_on(test[n], 1, 1, 0, 0));
    }
    bound = 1e-3;
    expected = INFINITY;
    assert_false(fails_on(first_is_near, 1, INFINITY, 0, 0));
    assert_true(fails_on(first_is_near, 1, -INFINITY, 0, 0));
    expected = 1000;
    assert_false(fails_on(first_is_relatively_near, 1, 1000.5, 0, 0));
    assert_true(fails_on(first_is_near, 1, 1000.5, 0, 0));
}

/* Within -1 .. 1 and 0 .. 1, in every tenth of it, and the same from the same seed. */
static void random_numbers_fill_their_range(void **state) {
    (void)state;
    uint64_t seed = 3, again = 3, other = 4;
    int signed_tenths[10] = {0}, tenths[10] = {0}, differ = 0;
    for (int k = 0; k < 10000; k++) {
        const double x = next_random(&seed), u = uniform();
        assert_true(x >= -1 && x < 1 && u >= 0 && u < 1);
        assert_true(next_random(&again) == x);
        differ += next_random(&other) != x;
        signed_tenths[(int)(5 * (x + 1))]++;
        tenths[(int)(10 * u)]++;
    }
    for (int k = 0; k < 10; k++)
        assert_true(signed_tenths[k] > 800 && tenths[k] > 800);
    assert_true(differ > 9990);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes_with_small_errors),
        cmocka_unit_test(fails_with_a_large_error_anywhere),
        cmocka_unit_test(fails_with_a_nan_anywhere),
        cmocka_unit_test(fails_with_an_infinity),
        cmocka_unit_test(fails_with_an_empty_set),
        cmocka_unit_test(nearness),
        cmocka_unit_test(random_numbers_fill_their_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
