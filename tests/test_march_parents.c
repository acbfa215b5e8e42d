/*
 * The survey cells that a cell of the front comes from: which of them are kept when there are more
 * than it has room for.
 */
#include "check.h"

/* For drop_least, which is its own; the library's copy is then not linked. */
/* NOLINTNEXTLINE(bugprone-suspicious-include) */
#include "front/march.c"

/* The least goes, with those that are as small but for rounding. */
static void the_least_parents_go(void **unused) {
    (void)unused;
    int survey[] = {1, 2, 3, 4, 5};
    double weight[] = {0.3, 0.1, 0.2, 0.1 * (1 + 1e-12), 0.3};
    assert_int_equal(drop_least(5, survey, weight), 3);
    assert_true(survey[0] == 1 && survey[1] == 3 && survey[2] == 5);
    assert_true(weight[0] == 0.3 && weight[1] == 0.2 && weight[2] == 0.3);
}

/* One that outweighs all others, which are alike, is left alone. */
static void one_parent_may_be_left(void **unused) {
    (void)unused;
    int survey[] = {1, 2, 3, 4, 5};
    double weight[] = {0.1, 0.1, 0.6, 0.1, 0.1};
    assert_int_equal(drop_least(5, survey, weight), 1);
    assert_true(survey[0] == 3 && weight[0] == 0.6);
}

/* Where all are alike none is the least: the last goes. */
static void of_equal_parents_the_last_goes(void **unused) {
    (void)unused;
    int survey[] = {1, 2, 3, 4, 5};
    double weight[] = {0.2, 0.2, 0.2, 0.2, 0.2};
    assert_int_equal(drop_least(5, survey, weight), 4);
    assert_true(survey[0] == 1 && survey[3] == 4);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_least_parents_go),
        cmocka_unit_test(one_parent_may_be_left),
        cmocka_unit_test(of_equal_parents_the_last_goes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
