/*
 * Scenes as a completions engineer would set them, while they are pumped: thin pays between strong
 * barriers, weak layers behind a barrier. Each has once ended in "no progress".
 */
#include "check.h"
#include "host.h"

#include <math.h>

/* Cells of 2 m, one source of the rate at the origin. */
static host_scene field_scene(int nx, int ny, const ilsa_rock *rock, double rate) {
    host_scene scene = {.mesh = {.nx = nx, .ny = ny, .dx = 2, .dy = 2}, .source_count = 1};
    scene.source[0].rate = rate;
    scene.options = ilsa_solver_def_default();
    assert_int_equal(ilsa_material_def_from_rock(rock, &scene.material), ILSA_OK);
    return scene;
}

/* Two parts in a hundred of all attempts, and one, may be refused. */
static ilsa_summary pumped(const host_scene *scene, double radius, double t_end) {
    ilsa_solver *solver = host_started(scene, radius);
    if (ilsa_advance(solver, t_end, NULL) != ILSA_OK) {
        fail_msg("radius %g: %s", radius, ilsa_last_error(solver));
    }
    ilsa_summary end = host_summary(solver);
    if ((double)end.total.rejected > 1 + 0.02 * (double)end.total.steps) {
        fail_msg("radius %g: %ld of %ld attempts refused", radius, end.total.rejected,
                 end.total.rejected + end.total.steps);
    }
    ilsa_solver_destroy(&solver);
    return end;
}

/* Slickwater in a pay of 12 m between barriers of 3 and 4 net pressures. */
static host_scene thin_pay(void) {
    ilsa_rock rock = {.E = 30e9, .nu = 0.25, .mu = 0.002, .K_Ic = 1.2e6, .C_L = 2e-5};
    host_scene scene = field_scene(81, 31, &rock, 0.05);
    scene.interfaces = 2;
    scene.interface_y[0] = -6;
    scene.interface_y[1] = 6;
    scene.sigma[0] = 46e6;
    scene.sigma[1] = 40e6;
    scene.sigma[2] = 49e6;
    return scene;
}

/* The lengthwise tip used to pinch shut at 20 s. */
static void thin_pay_is_pumped_to_its_end(void **state) {
    (void)state;
    host_scene scene = thin_pay();
    ilsa_summary end = pumped(&scene, 5, 60);
    assert_int_equal(end.closed_cells, 0);
}

static void thin_pay_does_not_depend_on_its_start(void **state) {
    (void)state;
    host_scene scene = thin_pay();
    ilsa_summary end = pumped(&scene, 5, 60), other = pumped(&scene, 5.05, 60);
    assert_true(fabs(other.x_max / end.x_max - 1) < 5e-3);
    assert_true(fabs(other.width_source / end.width_source - 1) < 5e-3);
    assert_true(fabs(other.extent_y_max - end.extent_y_max) < 1);
}

/* A layer behind a barrier of 16 m: its stress is lower by 0.8 of the net pressure. */
static host_scene weak_layer(void) {
    ilsa_rock rock = {.E = 25e9, .nu = 0.25, .mu = 0.001, .K_Ic = 1e6, .C_L = 1e-5};
    host_scene scene = field_scene(121, 41, &rock, 0.03);
    scene.interfaces = 3;
    scene.interface_y[0] = -4;
    scene.interface_y[1] = 5;
    scene.interface_y[2] = 21;
    scene.sigma[0] = 30.9e6;
    scene.sigma[1] = 29.1e6;
    scene.sigma[2] = 30.5e6;
    scene.sigma[3] = 29.4e6;
    return scene;
}

/* Level 5 has x 111.6, y 34.8 m. The cell behind the front used to be emptied as it broke in. */
static void front_breaks_into_a_weaker_layer(void **state) {
    (void)state;
    host_scene scene = weak_layer();
    ilsa_summary end = pumped(&scene, 5, 180);
    assert_true(fabs(end.extent_x_max / 111.6 - 1) < 0.01);
    assert_true(fabs(end.extent_y_max - 34.8) < 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thin_pay_is_pumped_to_its_end),
        cmocka_unit_test(thin_pay_does_not_depend_on_its_start),
        cmocka_unit_test(front_breaks_into_a_weaker_layer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
