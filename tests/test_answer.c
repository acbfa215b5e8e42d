/*
 * Same answer: run again, with more threads, and by other ways to the same solution. What compilers
 * and options change is compared by tests/same_answer.sh.
 */
#include "check.h"
#include "shown.h"

enum { CELLS = 11, STEPS = 12, STEPS_LONG = 40 };

static int steps_of_a_run(void) {
    return host_long() ? STEPS_LONG : STEPS;
}

static void step(ilsa_solver *solver, double end) {
    if (ilsa_advance_one(solver, end, NULL) != ILSA_OK)
        fail_msg("%s", ilsa_last_error(solver));
}

static host_image image_of(const shown *s) {
    ilsa_solver *solver = host_started(&s->scene, s->radius);
    for (int k = 0; k < steps_of_a_run() && host_summary(solver).time < s->end; k++)
        step(solver, s->end);
    host_image image = host_save(solver);
    ilsa_solver_destroy(&solver);
    return image;
}

static void check_bits(const shown *first, const shown *second, const char *how) {
    host_image a = image_of(first), b = image_of(second);
    if (!host_same(&a, &b))
        fail_msg("%s%s: other bits", first->name, how);
    host_free(&a);
    host_free(&b);
}

static void runs_have_the_same_bits(void **state) {
    (void)state;
    for (int which = 0; which < SHOWN_SCENES; which += host_long() ? 1 : 3) {
        const shown s = shown_scene(which, CELLS);
        check_bits(&s, &s, ", again");
    }
}

/* On finer cells, so that there is something to share. */
static void threads_give_the_same_bits(void **state) {
    (void)state;
    for (int which = 1; which < SHOWN_SCENES; which += host_long() ? 1 : 6)
        for (int unfolded = 0; unfolded < 2; unfolded++) {
            shown one = shown_scene(which, host_long() ? 21 : CELLS), two;
            one.scene.options.symmetry = unfolded ? ILSA_SYMMETRY_NONE : ILSA_SYMMETRY_AUTO;
            one.scene.options.linear = ILSA_LINEAR_GMRES;
            two = one;
            two.scene.options.threads = 2;
            check_bits(&one, &two, ", two threads");
        }
}

/* Worst difference at any step, both with the smallest sensible tolerance. */
static void check_close(shown first, shown second, const char *how) {
    const shown_units units = {1, 1, 1};
    shown_difference worst = SHOWN_NOTHING_YET;
    first.scene.options.tolerance = second.scene.options.tolerance = 1e-11;
    ilsa_solver *a = host_started(&first.scene, first.radius);
    ilsa_solver *b = host_started(&second.scene, second.radius);
    for (int k = 0; k < steps_of_a_run() && host_summary(a).time < first.end; k++) {
        step(a, first.end);
        step(b, first.end);
        worst = shown_worse(worst, shown_compare(a, b, units, 0));
    }
    print_message("%s%s: width %.1g, pressure %.1g, front %.1g cells, time %.1g\n", first.name, how,
                  worst.width, worst.pressure, worst.front, worst.time);
    assert_below(shown_largest(worst), 1e-10);
    ilsa_solver_destroy(&a);
    ilsa_solver_destroy(&b);
}

static void solvers_and_products_agree(void **state) {
    (void)state;
    for (int which = host_long() ? 0 : 2; which < SHOWN_SCENES; which += host_long() ? 1 : 3) {
        const shown s = shown_scene(which, CELLS);
        shown iterative = s, dense = s, direct = s;
        iterative.scene.options.linear = direct.scene.options.linear = ILSA_LINEAR_GMRES;
        dense.scene.options.linear = ILSA_LINEAR_DENSE;
        direct.scene.options.product = ILSA_PRODUCT_BLAS;
        check_close(iterative, dense, ", iterative and dense");
        check_close(iterative, direct, ", products by transforms and directly");
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runs_have_the_same_bits),
        cmocka_unit_test(threads_give_the_same_bits),
        cmocka_unit_test(solvers_and_products_agree),
    };
    return cmocka_run_group_tests_name("answer", tests, NULL, NULL);
}
