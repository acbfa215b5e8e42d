/*
 * Scenes where nobody looks: a part of each kind of bench/common_extremes_kinds.c, all of them with
 * $ILSA_LONG; and, for each fault that the map has shown, what a user would have seen.
 */
#include "../bench/common_extremes.h"
#include "check.h"
#include "host.h"

#include <string.h>

static void show(const extreme_sweep *sweep, const char *name, const extreme_result *result) {
    if (result->verdict != EXTREME_RIGHT)
        print_message("%s: %s: %s: %s\n", sweep->kind->name, name,
                      result->verdict == EXTREME_FAILED ? "failed" : "refused", result->what);
}

static extreme_sweep sweep_over(const char *name, int stride) {
    for (int k = 0; k < extreme_kind_count; k++)
        if (strcmp(extreme_kinds[k].name, name) == 0)
            return extreme_sweep_over(&extreme_kinds[k], stride, show);
    fail_msg("no kind %s", name);
    return (extreme_sweep){0};
}

/* Every stride-th case of a kind ends right but for so many that are refused with a message. */
static void sample(const char *name, int stride, int refused) {
    const extreme_sweep s = sweep_over(name, stride);
    print_message("%s: %d cases, %d right, %d refused, %d failed\n", name, s.cases,
                  s.count[EXTREME_RIGHT], s.count[EXTREME_REFUSED], s.count[EXTREME_FAILED]);
    assert_int_equal(s.count[EXTREME_FAILED], 0);
    assert_true(s.count[EXTREME_REFUSED] <= refused);
}

/* ---- The map ------------------------------------------------------------------------------ */

static void parametric_space(void **unused) {
    (void)unused;
    sample("parametric space", 6, 0);
    sample("vanishing parts", 4, 0);
}

static void meshes_and_steps(void **unused) {
    (void)unused;
    sample("oblong cells", 7, 0);
    sample("starts", 7, 0);
    sample("steps asked for", 4, 0);
    sample("sources", 5, 0);
}

static void stress_fields(void **unused) {
    (void)unused;
    sample("thin layers", 3, 2);
    sample("layers off the edges", 11, 1);
    sample("drops", 4, 3);
    sample("islands", 3, 2);
}

static void changes_of_rate(void **unused) {
    (void)unused;
    sample("rates", 7, 4);
    sample("shut-ins", 7, 4);
}

/* ---- What a user would have seen ---------------------------------------------------------- */

/*
 * Barriers of 100 and 1000 net pressures: the run ended with ILSA_CLOSED or ILSA_STALLED when the
 * front met them, and between discs of such stress it crept on by thousands of tiny steps.
 */
static void high_barriers_end_no_run(void **unused) {
    (void)unused;
    sample("barriers", 1, 0);
}

static void an_hourglass_goes_on(void **unused) {
    (void)unused;
    sample("waists", 1, 0);
}

/* E' = K' = Q = 1, no viscosity, no leak-off. */
static host_scene inviscid(void) {
    host_scene scene = host_penny(0, 29, 1);
    scene.material.mu_prime = 0;
    return scene;
}

/* The K vertex: R = 0.8546 (E' Q t / K')^(2/5), p = (pi / 8) K' (2 R)^(-1/2). */
static void a_fluid_without_viscosity_has_one_pressure(void **unused) {
    (void)unused;
    const host_scene scene = inviscid();
    ilsa_solver *solver = host_started(&scene, 5);
    host_steps(solver, 20);
    const ilsa_summary s = host_summary(solver);
    const double R = 0.85463870 * pow(s.time, 0.4), pi = acos(-1);
    assert_below(relative(s.x_max, R), 0.005);
    assert_below(relative(s.pressure_source, pi / 8 / sqrt(2 * R)), 0.01);
    assert_below(fabs(host_imbalance(solver)), 1e-12);
    const double *pressure = host_pressure(solver);
    const unsigned char *kind = host_kind(solver);
    for (int n = 0; n < 29 * 29; n++)
        if (kind[n] == ILSA_CELL_CHANNEL)
            assert_below(relative(pressure[n], s.pressure_source), 1e-4);
    ilsa_solver_destroy(&solver);
}

/* What stands for no viscosity is of the start and goes with the state. */
static void no_viscosity_goes_with_a_snapshot(void **unused) {
    (void)unused;
    host_scene scene = inviscid();
    ilsa_solver *solver = host_started(&scene, 5);
    host_steps(solver, 3);
    host_image image = host_save(solver);
    scene.source[0].rate = 1e3; /* of the definition, which is no part of the state */
    ilsa_solver *copy = host_started(&scene, 4);
    host_restore(copy, &image);
    host_steps(solver, 5);
    host_steps(copy, 5);
    host_free(&image);
    image = host_save(solver);
    assert_true(host_is(copy, &image));
    host_free(&image);
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&copy);
}

static void nothing_holds_a_front_without_viscosity_and_toughness(void **unused) {
    (void)unused;
    const ilsa_material_def def = {1, 0, 0, 1};
    ilsa_material *material;
    assert_int_equal(ilsa_material_create(&def, &material), ILSA_ERR_VALUE);
    assert_non_null(strstr(ilsa_last_error(NULL), "mu_prime = 0: must be > 0 where K_prime = 0"));
    /* a viscosity that no number can stand for is refused, the fracture before kept */
    host_scene scene = inviscid();
    scene.material.K_prime = 1e-100;
    ilsa_solver *solver = host_solver(&scene);
    assert_int_equal(ilsa_start_radial(solver, 5), ILSA_ERR_VALUE);
    assert_true(ilsa_last_error(solver)[0] != '\0');
    ilsa_solver_destroy(&solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parametric_space),
        cmocka_unit_test(meshes_and_steps),
        cmocka_unit_test(stress_fields),
        cmocka_unit_test(changes_of_rate),
        cmocka_unit_test(high_barriers_end_no_run),
        cmocka_unit_test(an_hourglass_goes_on),
        cmocka_unit_test(a_fluid_without_viscosity_has_one_pressure),
        cmocka_unit_test(no_viscosity_goes_with_a_snapshot),
        cmocka_unit_test(nothing_holds_a_front_without_viscosity_and_toughness),
    };
    return cmocka_run_group_tests_name("extremes", tests, NULL, NULL);
}
