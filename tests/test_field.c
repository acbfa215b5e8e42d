/*
 * Scenes as a completions engineer would set them: thin pays between strong barriers, weak layers
 * behind a barrier, layers that are shut in. Each has once ended in "no progress" or stuttered.
 */
#include "check.h"
#include "host.h"

#include <math.h>
#include <string.h>

/* Cells of 2 m, one source of the rate at the origin. */
static host_scene field_scene(int nx, int ny, const ilsa_rock *rock, double rate) {
    host_scene scene = {.mesh = {.nx = nx, .ny = ny, .dx = 2, .dy = 2}, .source_count = 1};
    scene.source[0].rate = rate;
    scene.options = ilsa_solver_def_default();
    assert_int_equal(ilsa_material_def_from_rock(rock, &scene.material), ILSA_OK);
    return scene;
}

/* Layers from the lowest one on, with interfaces between them. */
static void set_layers(host_scene *scene, int interfaces, const double *y, const double *sigma) {
    scene->interfaces = interfaces;
    memcpy(scene->interface_y, y, (size_t)interfaces * sizeof *y);
    memcpy(scene->sigma, sigma, (size_t)(interfaces + 1) * sizeof *sigma);
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
    set_layers(&scene, 2, (const double[]){-6, 6}, (const double[]){46e6, 40e6, 49e6});
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
    set_layers(&scene, 3, (const double[]){-4, 5, 21},
               (const double[]){30.9e6, 29.1e6, 30.5e6, 29.4e6});
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

/* ---- After the pumps have stopped ---------------------------------------------------------------
 */

/* Linear gel in a layer of 80 m between barriers of many net pressures. */
static host_scene shut_in_layer(void) {
    ilsa_rock rock = {.E = 7.325e9, .nu = 0.287, .mu = 0.02742, .K_Ic = 1.114e6, .C_L = 3.8e-6};
    host_scene scene = field_scene(201, 51, &rock, 0.02937);
    scene.mesh.dx = scene.mesh.dy = 4;
    set_layers(&scene, 2, (const double[]){-54.53, 25.14},
               (const double[]){16.28e6, 9.305e6, 15.09e6});
    return scene;
}

/* The least and the largest pressure anywhere in the fracture, once no pump runs. */
typedef struct pressures {
    double least, most;
} pressures;

static pressures watched_after_shut_in(ilsa_solver *solver, double t_end) {
    pressures seen = {INFINITY, -INFINITY};
    ilsa_mesh_def m;
    assert_int_equal(ilsa_get_mesh_def(solver, &m), ILSA_OK);
    while (host_summary(solver).time < t_end) {
        ilsa_status status = ilsa_advance_one(solver, t_end, NULL);
        if (status == ILSA_CLOSED) {
            break;
        }
        assert_int_equal(status, ILSA_OK);
        for (int cell = 0; cell < m.nx * m.ny; cell++) {
            if (host_kind(solver)[cell] != ILSA_CELL_EMPTY) {
                seen.least = fmin(seen.least, host_pressure(solver)[cell]);
                seen.most = fmax(seen.most, host_pressure(solver)[cell]);
            }
        }
    }
    return seen;
}

/* Cells at the barriers closed and opened in turn, a tenth of all attempts was refused. */
static void a_layer_shut_in_closes_without_stuttering(void **state) {
    (void)state;
    host_scene scene = shut_in_layer();
    ilsa_solver *solver = host_started(&scene, 14.05);
    assert_int_equal(ilsa_advance(solver, 2260, NULL), ILSA_OK);
    assert_int_equal(ilsa_set_rate(solver, 0, 0), ILSA_OK);
    pressures seen = watched_after_shut_in(solver, 8790);
    ilsa_summary end = host_summary(solver);
    print_message("field: after shut-in %.3g .. %.3g MPa, %ld steps, %ld refused\n",
                  1e-6 * seen.least, 1e-6 * seen.most, end.total.steps, end.total.rejected);
    assert_true(seen.least > -100e6 && seen.most < 100e6);
    assert_true((double)end.total.rejected <= 0.05 * (double)end.total.steps);
    assert_below(fabs(host_imbalance(solver)), 1e-12);
    ilsa_solver_destroy(&solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thin_pay_is_pumped_to_its_end),
        cmocka_unit_test(thin_pay_does_not_depend_on_its_start),
        cmocka_unit_test(front_breaks_into_a_weaker_layer),
        cmocka_unit_test(a_layer_shut_in_closes_without_stuttering),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
