/* The choice of the tip model: what each grows, where they agree, and what the full one is worth.
 */
#include "check.h"
#include "csv.h"
#include "host.h"

static host_scene penny_of(double phi, int n, double h, ilsa_tip_model tip) {
    host_scene scene = host_penny(phi, n, h);
    scene.options.tip = tip;
    return scene;
}

/* Mean radius of the front, weighted by angle. */
static double radius_of(ilsa_solver *solver) {
    const ilsa_front_point *f;
    size_t count;
    double sum = 0, turn = 0;
    assert_int_equal(ilsa_get_front(solver, &f, &count), ILSA_OK);
    for (size_t i = 0; i < count; i++) {
        const ilsa_front_point *a = &f[i], *b = &f[i + 1 < count ? i + 1 : 0];
        const double ra = hypot(a->x, a->y), rb = hypot(b->x, b->y);
        const double angle = asin((a->x * b->y - a->y * b->x) / (ra * rb));
        sum += 0.5 * (ra + rb) * angle;
        turn += angle;
    }
    return sum / turn;
}

/* The row of the reference history for phi = 0 at a time. */
static double reference_radius(double tau) {
    csv_table *t = csv_read("tests/data/radial_history.csv");
    size_t row = 0;
    while (csv_get(t, row, "phi") != 0 || relative(csv_get(t, row, "tau"), tau) > 1e-9)
        row++;
    const double R = csv_get(t, row, "R");
    csv_free(t);
    return R;
}

/* Grown from half the radius that it ought to have at the time. */
static double grow(double phi, double R, double time, int cells, ilsa_tip_model tip) {
    host_scene scene = penny_of(phi, 2 * (int)(1.1 * cells + 4) + 1, R / cells, tip);
    ilsa_solver *solver = host_started(&scene, 0.5 * R);
    ilsa_status status = ilsa_advance(solver, time, NULL);
    if (status)
        fail_msg("tip %d, %d cells: %s", (int)tip, cells, ilsa_last_error(solver));
    assert_below(fabs(host_imbalance(solver)), 1e-12);
    const double grown = radius_of(solver);
    ilsa_solver_destroy(&solver);
    return grown;
}

/* What the paper says in words: the full asymptote on a coarse mesh beats LEFM on a fine one. */
static void coarse_full_beats_fine_toughness(void **state) {
    (void)state;
    const double R = reference_radius(1);
    const double full = relative(grow(0, R, 1, 10, ILSA_TIP_FULL), R);
    const double tough = relative(grow(0, R, 1, 20, ILSA_TIP_TOUGHNESS), R);
    const double finer = relative(grow(0, R, 1, 40, ILSA_TIP_TOUGHNESS), R);
    print_message(
        "phi 0, tau 1, error of the radius: full at 10 cells %.2f %%, LEFM at 20 %.2f %%, "
        "at 40 %.2f %%\n",
        100 * full, 100 * tough, 100 * finer);
    assert_below(full, 0.005);
    assert_true(finer < tough && finer > 0.02 && finer > 5 * full);
}

/* With no leak-off there is none to leave out: the same bits. */
static void models_without_leakoff_agree(void **state) {
    (void)state;
    ilsa_solver *solver[2];
    for (int tip = 0; tip < 2; tip++) {
        host_scene scene = penny_of(0, 41, 0.1, (ilsa_tip_model)tip);
        solver[tip] = host_started(&scene, 1);
        host_steps(solver[tip], 5);
    }
    const size_t size = (size_t)41 * 41 * sizeof(double);
    assert_memory_equal(host_width(solver[0]), host_width(solver[1]), size);
    assert_memory_equal(host_pressure(solver[0]), host_pressure(solver[1]), size);
    ilsa_solver_destroy(&solver[0]);
    ilsa_solver_destroy(&solver[1]);
}

/* mu' = 1e-4: toughness rules, and all three agree. */
static void models_agree_where_toughness_rules(void **state) {
    (void)state;
    double R[3];
    for (int tip = 0; tip < 3; tip++) {
        host_scene scene = penny_of(0, 31, 0.1, (ilsa_tip_model)tip);
        scene.material.mu_prime = 1e-4;
        scene.material.C_prime = 0.01;
        ilsa_solver *solver = host_started(&scene, 0.6);
        assert_int_equal(ilsa_advance(solver, 1.5, NULL), ILSA_OK);
        assert_below(fabs(host_imbalance(solver)), 1e-12);
        R[tip] = radius_of(solver);
        ilsa_solver_destroy(&solver);
    }
    assert_below(relative(R[1], R[0]), 0.005);
    assert_below(relative(R[2], R[0]), 0.01);
    assert_true(R[1] != R[0] && R[2] != R[1]);
}

/* Where leak-off rules the tip, a tip without it runs ahead and leaks more. */
static void models_differ_where_leakoff_rules(void **state) {
    (void)state;
    ilsa_summary now[2];
    double R[2];
    for (int tip = 0; tip < 2; tip++) {
        host_scene scene = penny_of(1, 41, 0.02, (ilsa_tip_model)tip);
        ilsa_solver *solver = host_started(&scene, 0.12);
        assert_int_equal(ilsa_advance(solver, 0.5, NULL), ILSA_OK);
        assert_below(fabs(host_imbalance(solver)), 1e-12);
        now[tip] = host_summary(solver);
        R[tip] = radius_of(solver);
        ilsa_solver_destroy(&solver);
    }
    print_message("phi 1: without leak-off in the tip R %+.2f %%, efficiency %+.4f\n",
                  100 * (R[1] / R[0] - 1), now[1].efficiency - now[0].efficiency);
    assert_true(R[1] > 1.01 * R[0]);
    assert_true(now[1].efficiency < now[0].efficiency - 0.01);
}

/* The tip cells start with the full asymptote, whatever the model is to make of them. */
static void all_start_from_the_same_penny(void **state) {
    (void)state;
    ilsa_solver *solver[3];
    for (int tip = 0; tip < 3; tip++) {
        host_scene scene = penny_of(1, 41, 0.1, (ilsa_tip_model)tip);
        solver[tip] = host_started(&scene, 1);
    }
    for (int tip = 1; tip < 3; tip++)
        assert_memory_equal(host_width(solver[0]), host_width(solver[tip]),
                            (size_t)41 * 41 * sizeof(double));
    for (int tip = 0; tip < 3; tip++)
        ilsa_solver_destroy(&solver[tip]);
}

/* LEFM's front is reported where the full asymptote has it: far from the toughness vertex. */
static void regimes_are_of_all_processes(void **state) {
    (void)state;
    host_scene scene = penny_of(0, 51, 0.035, ILSA_TIP_TOUGHNESS);
    ilsa_solver *solver = host_started(&scene, 0.35);
    const ilsa_survey_point *survey;
    const ilsa_front_point *front;
    size_t count;
    assert_int_equal(ilsa_advance(solver, 0.7, NULL), ILSA_OK);
    assert_int_equal(ilsa_get_survey(solver, &survey, &count), ILSA_OK);
    int moving = 0;
    for (size_t i = 0; i < count; i++) {
        const ilsa_survey_point *p = &survey[i];
        ilsa_tip_regime there;
        double w;
        assert_true(relative(p->w, sqrt(p->s)) < 0.15); /* its width is that of toughness */
        if (!(p->V > 0))
            continue;
        assert_int_equal(ilsa_tip_width(&scene.material, p->V, p->s, &w), ILSA_OK);
        assert_int_equal(ilsa_tip_triangle(&scene.material, p->V, p->s, w, &there), ILSA_OK);
        assert_memory_equal(&there, &p->regime, sizeof there);
        assert_true(p->regime.N_m > 0.3);
        moving++;
    }
    assert_true(moving > 20);
    assert_int_equal(ilsa_get_front(solver, &front, &count), ILSA_OK);
    for (size_t i = 0; i < count; i++)
        assert_below(fabs(front[i].regime.N_k + front[i].regime.N_m - 1), 1e-12);
    ilsa_solver_destroy(&solver);
}

/* LEFM cannot leave from the true width of a fast fracture: refused, nothing changed. */
static void toughness_refuses_a_viscous_start(void **state) {
    (void)state;
    host_scene scene = penny_of(0, 31, 1e-3, ILSA_TIP_TOUGHNESS);
    ilsa_solver *solver = host_started(&scene, 8e-3);
    host_image before = host_save(solver);
    double dt;
    assert_int_equal(ilsa_suggest_dt(solver, &dt), ILSA_OK);
    assert_true(ilsa_step(solver, dt, NULL) > 0);
    assert_true(host_is(solver, &before));
    host_free(&before);
    ilsa_solver_destroy(&solver);
}

/* A coarsened and a restored solver keep the model. */
static void model_survives_coarsening_and_snapshots(void **state) {
    (void)state;
    for (int tip = 0; tip < 3; tip++) {
        host_scene scene = penny_of(0, 31, 0.1, (ilsa_tip_model)tip);
        scene.material.mu_prime = 1e-4;
        scene.material.C_prime = 0.01;
        ilsa_solver *solver = host_started(&scene, 1), *other = host_solver(&scene);
        ilsa_model model;
        host_steps(solver, 2);
        assert_int_equal(ilsa_coarsen(solver), ILSA_OK);
        host_steps(solver, 1);
        host_image image = host_save(solver);
        host_restore(other, &image);
        host_steps(solver, 2);
        host_steps(other, 2);
        host_image end = host_save(solver);
        assert_true(host_is(other, &end));
        assert_int_equal(ilsa_get_model(other, &model), ILSA_OK);
        assert_int_equal(model.tip, tip);
        host_free(&image);
        host_free(&end);
        ilsa_solver_destroy(&solver);
        ilsa_solver_destroy(&other);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coarse_full_beats_fine_toughness),
        cmocka_unit_test(models_without_leakoff_agree),
        cmocka_unit_test(models_agree_where_toughness_rules),
        cmocka_unit_test(models_differ_where_leakoff_rules),
        cmocka_unit_test(all_start_from_the_same_penny),
        cmocka_unit_test(regimes_are_of_all_processes),
        cmocka_unit_test(toughness_refuses_a_viscous_start),
        cmocka_unit_test(model_survives_coarsening_and_snapshots),
    };
    return cmocka_run_group_tests_name("tip_models", tests, NULL, NULL);
}
