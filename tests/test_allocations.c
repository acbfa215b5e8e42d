/* Memory that steps ask for: none once the footprint's buffers are there, little while they grow.
 */
#include "../bench/common_malloc.h"
#include "check.h"
#include "host.h"

enum { STEPS = 100, GROWING = 40 };

typedef struct growth_case {
    double phi;
    ilsa_symmetry symmetry;
} growth_case;

static const growth_case cases[] = {{0, ILSA_SYMMETRY_AUTO},
                                    {0, ILSA_SYMMETRY_NONE},
                                    {1e-2, ILSA_SYMMETRY_AUTO},
                                    {1e-2, ILSA_SYMMETRY_NONE}};
enum { CASES = sizeof cases / sizeof *cases };

static ilsa_solver *started(const growth_case *c) {
    host_scene scene = host_penny(c->phi, 81, 0.05);
    scene.options.symmetry = c->symmetry;
    return host_started(&scene, 0.5);
}

/* In steps so short that the footprint's box stays; everybody's allocations count. */
static long allocations_at_rest(const growth_case *c) {
    ilsa_solver *solver = started(c);
    double dt = 0;
    host_steps(solver, GROWING);
    assert_int_equal(ilsa_suggest_dt(solver, &dt), ILSA_OK);
    const ilsa_summary before = host_summary(solver);
    const long calls = heap.calls;
    for (int k = 0; k < STEPS; k++)
        host_step(solver, dt / 400);
    const long made = heap.calls - calls;
    assert_true(host_summary(solver).x_max > before.x_max);
    ilsa_solver_destroy(&solver);
    return made;
}

static void none_in_a_grown_footprint(void **unused) {
    (void)unused;
    for (int k = 0; k < CASES; k++)
        assert_int_equal(allocations_at_rest(&cases[k]), 0);
}

/*
 * From 10 to over 20 cells: all that was asked for is a few times what is there at the end, half a
 * megabyte for each larger transform included, which is only asked whether it is there.
 */
static void growth_is_amortised(void **unused) {
    (void)unused;
    for (int k = 0; k < CASES; k++) {
        ilsa_solver *solver = started(&cases[k]);
        const heap_counts before = heap;
        host_steps(solver, GROWING);
        assert_true(host_summary(solver).x_max > 1);
        assert_true(heap.bytes - before.bytes <= 7 * (heap.live - before.live));
        ilsa_solver_destroy(&solver);
    }
}

/* The list of survey cells is there after the first reading. */
static void none_in_a_reading_again(void **unused) {
    (void)unused;
    ilsa_solver *solver = started(&cases[0]);
    const ilsa_survey_point *survey;
    size_t count;
    assert_int_equal(ilsa_get_survey(solver, &survey, &count), ILSA_OK);
    const long calls = heap.calls;
    for (int k = 0; k < 3; k++)
        assert_int_equal(ilsa_get_survey(solver, &survey, &count), ILSA_OK);
    assert_int_equal(heap.calls, calls);
    ilsa_solver_destroy(&solver);
}

/* Every case by the solver's own choice, and one by each other way to solve. */
static const struct {
    const growth_case *c;
    ilsa_product product;
    ilsa_linear_solver linear;
} ways[] = {{&cases[0], ILSA_PRODUCT_AUTO, ILSA_LINEAR_AUTO},
            {&cases[1], ILSA_PRODUCT_AUTO, ILSA_LINEAR_AUTO},
            {&cases[2], ILSA_PRODUCT_AUTO, ILSA_LINEAR_AUTO},
            {&cases[3], ILSA_PRODUCT_AUTO, ILSA_LINEAR_AUTO},
            {&cases[2], ILSA_PRODUCT_BLAS, ILSA_LINEAR_GMRES},
            {&cases[2], ILSA_PRODUCT_AUTO, ILSA_LINEAR_DENSE}};

/* From 10 to over 20 cells, so that all that grows with the footprint has grown. */
static ilsa_solver *grown(int way) {
    host_scene scene = host_penny(ways[way].c->phi, 81, 0.05);
    scene.options.symmetry = ways[way].c->symmetry;
    scene.options.product = ways[way].product;
    scene.options.linear = ways[way].linear;
    ilsa_solver *solver = host_started(&scene, 0.5);
    const ilsa_front_point *front;
    size_t count;
    host_steps(solver, GROWING);
    assert_int_equal(ilsa_get_front(solver, &front, &count), ILSA_OK);
    return solver;
}

/* By how much more memory is in use once a solver has come, grown and gone. */
static long kept_by(int way) {
    const size_t before = heap.live;
    ilsa_solver *solver = grown(way);
#ifdef COUNTS_HEAP
    assert_true(heap.live > before);
#endif
    ilsa_solver_destroy(&solver);
    return (long)(heap.live - before);
}

/*
 * What a solver has taken is given back with it. What FFTW keeps for all plans to come is there
 * after a solver or two; a solver that kept something would do so every time.
 */
static void nothing_is_kept(void **unused) {
    (void)unused;
    for (int way = 0; way < (int)(sizeof ways / sizeof *ways); way++) {
        long kept = 1;
        for (int time = 0; time < 5 && kept > 0; time++)
            kept = kept_by(way);
        assert_true(kept <= 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(none_in_a_grown_footprint),
        cmocka_unit_test(growth_is_amortised),
        cmocka_unit_test(none_in_a_reading_again),
        cmocka_unit_test(nothing_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
