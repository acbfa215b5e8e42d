/* The fracture on a mesh of more cells: nothing that a user sees changes, then or later. */
#include "check.h"
#include "host.h"

#include <math.h>
#include <string.h>

static void grow(ilsa_solver *solver, int columns, int rows) {
    assert_int_equal(ilsa_grow(solver, columns, rows), ILSA_OK);
}

static ilsa_mesh_def mesh_of(const ilsa_solver *solver) {
    ilsa_mesh_def mesh;
    assert_int_equal(ilsa_get_mesh_def(solver, &mesh), ILSA_OK);
    return mesh;
}

/* Scenes: every parity of the counts, with and without leak-off, off centre, layers, two sources
 * and no symmetry; `more` cells on every side of what the scene has. */
enum { SCENES = 8 };

static host_scene scene_of(int which, int more) {
    host_scene scene = host_penny(which % 2 ? 1 : 0, 41 - which % 3 + 2 * more, 0.1);
    scene.mesh.ny = 36 + which % 2 + 2 * more;
    scene.mesh.dy = which == 3 ? 0.12 : 0.1;
    scene.source[0].x = which == 4 || which == 5 ? 0.27 : 0;
    scene.source[0].y = which == 5 ? -0.2 : 0;
    scene.interfaces = which >= 6 ? 2 : 0;
    scene.interface_y[0] = -0.45;
    scene.interface_y[1] = which == 6 ? 0.45 : 0.62;
    scene.sigma[0] = scene.sigma[2] = scene.interfaces ? 0.4 : 0;
    if (which == 7) {
        scene.source_count = 2;
        scene.source[1] = (ilsa_source_def){.x = 0.3, .y = 0.1, .rate = 0.5};
    }
    return scene;
}

/* Fields of a solver on those cells that another has in the middle, and what is in the others. */
static void check_field(const ilsa_solver *small, const ilsa_solver *large, const double *a,
                        const double *b, double outside) {
    ilsa_mesh_def m = mesh_of(small), n = mesh_of(large);
    int columns = (n.nx - m.nx) / 2, rows = (n.ny - m.ny) / 2;
    for (int j = 0; j < n.ny; j++)
        for (int i = 0; i < n.nx; i++) {
            int k = i - columns, l = j - rows;
            int there = k >= 0 && k < m.nx && l >= 0 && l < m.ny;
            assert_true(b[j * n.nx + i] == (there ? a[l * m.nx + k] : outside));
        }
}

/* Counters and seconds of the work done aside, which are no part of the fracture. */
static void check_summaries(const ilsa_solver *a, const ilsa_solver *b) {
    ilsa_summary x = host_summary(a), y = host_summary(b);
    memset(&x.total, 0, sizeof x.total);
    memset(&y.total, 0, sizeof y.total);
    assert_memory_equal(&x, &y, sizeof x);
}

static void check_fronts(ilsa_solver *a, ilsa_solver *b) {
    const ilsa_front_point *p, *q;
    size_t count, other;
    assert_int_equal(ilsa_get_front(a, &p, &count), ILSA_OK);
    assert_int_equal(ilsa_get_front(b, &q, &other), ILSA_OK);
    assert_true(count == other && count > 10);
    for (size_t k = 0; k < count; k++)
        assert_true(p[k].x == q[k].x && p[k].y == q[k].y && p[k].V == q[k].V &&
                    p[k].loop == q[k].loop);
}

static void check_kinds(const ilsa_solver *small, const ilsa_solver *large) {
    ilsa_mesh_def m = mesh_of(small), n = mesh_of(large);
    const unsigned char *a, *b;
    assert_int_equal(ilsa_get_cell_kinds(small, &a), ILSA_OK);
    assert_int_equal(ilsa_get_cell_kinds(large, &b), ILSA_OK);
    for (int j = 0; j < m.ny; j++)
        for (int i = 0; i < m.nx; i++)
            assert_int_equal(a[j * m.nx + i],
                             b[(j + (n.ny - m.ny) / 2) * n.nx + i + (n.nx - m.nx) / 2]);
}

/* Everything that a host can read. */
static void check_same(ilsa_solver *small, ilsa_solver *large) {
    check_summaries(small, large);
    check_fronts(small, large);
    check_kinds(small, large);
    check_field(small, large, host_width(small), host_width(large), 0);
    check_field(small, large, host_pressure(small), host_pressure(large), 0);
    if (host_trigger(small))
        check_field(small, large, host_trigger(small), host_trigger(large), INFINITY);
}

static void a_larger_mesh_changes_nothing_that_is_seen(void **unused) {
    (void)unused;
    for (int which = 0; which < SCENES; which++) {
        host_scene scene = scene_of(which, 0);
        ilsa_solver *solver = host_started(&scene, 0.8), *twin = host_started(&scene, 0.8);
        host_steps(solver, 5);
        host_steps(twin, 5);
        grow(solver, 3, 0);
        check_same(twin, solver);
        grow(solver, 0, 8);
        check_same(twin, solver);
        grow(solver, 2, 1);
        check_same(twin, solver);
        ilsa_mesh_def mesh = mesh_of(solver);
        assert_true(mesh.nx == scene.mesh.nx + 10 && mesh.ny == scene.mesh.ny + 18);
        assert_true(mesh.dx == scene.mesh.dx && mesh.dy == scene.mesh.dy);
        ilsa_solver_destroy(&solver);
        ilsa_solver_destroy(&twin);
    }
}

/* The small mesh is grown where it is full, as late as can be. */
static void growth_at_the_edge_is_as_a_larger_mesh_from_the_start(void **unused) {
    (void)unused;
    for (int which = 0; which < SCENES; which++) {
        host_scene scene = scene_of(which, 0), large = scene_of(which, 9);
        ilsa_solver *solver = host_started(&scene, 0.8), *twin = host_started(&large, 0.8);
        int after = 0, before = 0;
        while (after < 8) {
            double dt;
            assert_int_equal(ilsa_suggest_dt(solver, &dt), ILSA_OK);
            ilsa_status status = ilsa_step(solver, dt, NULL);
            if (status == ILSA_MESH_EDGE) {
                assert_true(after == 0);
                check_same(solver, twin);
                grow(solver, 9, 9);
                status = ilsa_step(solver, dt, NULL);
            }
            assert_int_equal(status, ILSA_OK);
            host_step(twin, dt);
            check_same(solver, twin);
            int grown = mesh_of(solver).nx == large.mesh.nx;
            after += grown;
            before += !grown;
        }
        assert_true(before > 5);
        assert_true(fabs(host_imbalance(solver)) <= 1e-12);
        ilsa_solver_destroy(&solver);
        ilsa_solver_destroy(&twin);
    }
}

/* Shut in, cells closed and draining: the same steps with and without the cells outside. */
static void growth_while_the_fracture_closes(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_solver *solver = host_started(&scene, 1), *twin = host_started(&scene, 1);
    ilsa_solver *both[] = {solver, twin};
    int closed = 0;
    for (int k = 0; k < 2; k++) {
        host_steps(both[k], 5);
        assert_int_equal(ilsa_set_rate(both[k], 0, 0), ILSA_OK);
    }
    for (int n = 0; n < 60; n++) {
        if (n % 10 == 3)
            grow(solver, 1 + n % 3, 2);
        ilsa_status status = ilsa_advance_one(solver, 1e9, NULL);
        assert_int_equal(ilsa_advance_one(twin, 1e9, NULL), status);
        if (status != ILSA_OK)
            break;
        closed = host_summary(solver).closed_cells;
        check_same(twin, solver);
    }
    assert_true(closed > 0);
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&twin);
}

/* Layers go on, cells take the value of the nearest one, and what was there stays. */
static void stress_goes_on_into_the_new_cells(void **unused) {
    (void)unused;
    host_scene scene = scene_of(7, 0), large = scene_of(7, 4);
    ilsa_solver *solver = host_started(&scene, 0.8), *twin = host_started(&large, 0.8);
    const double *a, *b;
    grow(solver, 4, 4);
    assert_int_equal(ilsa_get_stress(solver, &a), ILSA_OK);
    assert_int_equal(ilsa_get_stress(twin, &b), ILSA_OK);
    assert_memory_equal(a, b, sizeof *a * (size_t)(large.mesh.nx * large.mesh.ny));
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&twin);

    static double cells[31 * 31];
    for (int k = 0; k < 31 * 31; k++)
        cells[k] = 0.001 * (k % 31) + 0.01 * (k / 31 % 7);
    scene = host_penny(1, 31, 0.1);
    scene.cells = cells;
    solver = host_started(&scene, 0.8);
    grow(solver, 3, 5);
    assert_int_equal(ilsa_get_stress(solver, &a), ILSA_OK);
    for (int j = 0; j < 41; j++)
        for (int i = 0; i < 37; i++) {
            int k = i < 3 ? 0 : i > 33 ? 30 : i - 3, l = j < 5 ? 0 : j > 35 ? 30 : j - 5;
            assert_true(a[j * 37 + i] == cells[l * 31 + k]);
        }
    host_steps(solver, 2);
    ilsa_solver_destroy(&solver);
}

/* A mesh that was coarsened grows, and one that has grown is coarsened. */
static void growth_and_coarsening_follow_each_other(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1, 41, 0.05);
    ilsa_solver *solver = host_started(&scene, 0.8);
    assert_int_equal(ilsa_coarsen_along(solver, ILSA_ALONG_X), ILSA_OK);
    grow(solver, 0, 10);
    host_steps(solver, 12);
    assert_int_equal(ilsa_coarsen_along(solver, ILSA_ALONG_Y), ILSA_OK);
    host_steps(solver, 3);
    ilsa_mesh_def mesh = mesh_of(solver);
    assert_true(mesh.nx == 41 && mesh.ny == 61 && mesh.dx == 0.1 && mesh.dy == 0.1);
    assert_true(fabs(host_imbalance(solver)) <= 1e-12);
    ilsa_summary now = host_summary(solver);
    assert_true(fabs(now.extent_x_max / now.extent_y_max - 1) < 0.01);
    ilsa_model used;
    assert_int_equal(ilsa_get_model(solver, &used), ILSA_OK);
    assert_int_equal(used.symmetry, ILSA_SYMMETRY_XY);
    ilsa_solver_destroy(&solver);
}

static void check_refused(ilsa_solver *solver, int columns, int rows, const char *part) {
    host_image before = host_save(solver);
    assert_int_equal(ilsa_grow(solver, columns, rows), ILSA_ERR_VALUE);
    if (!strstr(ilsa_last_error(solver), part))
        fail_msg("message '%s' does not contain '%s'", ilsa_last_error(solver), part);
    assert_true(host_is(solver, &before));
    host_free(&before);
}

static void bad_calls_are_refused(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1, 41, 0.1);
    scene.options.cells_max = 50 * 50;
    assert_int_equal(ilsa_grow(NULL, 1, 1), ILSA_ERR_NULL);
    ilsa_solver *solver = host_solver(&scene);
    assert_int_equal(ilsa_grow(solver, 1, 1), ILSA_ERR_STATE);
    assert_int_equal(ilsa_start_radial(solver, 0.9), ILSA_OK);
    check_refused(solver, -1, 1, "columns = -1");
    check_refused(solver, 1, -1, "rows = -1");
    check_refused(solver, 2000000000, 0, "columns = 2e+09");
    check_refused(solver, 500000, 0, "nx = 1000041");
    check_refused(solver, 100000, 100000, "nx ny = ");
    check_refused(solver, 5, 5, "cells_max");
    grow(solver, 4, 4);
    grow(solver, 0, 0);
    check_refused(solver, 1, 1, "cells_max");
    ilsa_solver_destroy(&solver);
    scene.options.cells_max = 10; /* the mesh of the definition may be larger */
    solver = host_started(&scene, 0.9);
    check_refused(solver, 1, 0, "cells_max allows 1681");
    ilsa_solver_destroy(&solver);
    scene.options.cells_max = 0;
    solver = host_started(&scene, 0.9);
    check_refused(solver, 300, 300, "cells_max allows 100000");
    grow(solver, 130, 130);
    ilsa_solver_destroy(&solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_larger_mesh_changes_nothing_that_is_seen),
        cmocka_unit_test(growth_at_the_edge_is_as_a_larger_mesh_from_the_start),
        cmocka_unit_test(growth_while_the_fracture_closes),
        cmocka_unit_test(stress_goes_on_into_the_new_cells),
        cmocka_unit_test(growth_and_coarsening_follow_each_other),
        cmocka_unit_test(bad_calls_are_refused),
    };
    return cmocka_run_group_tests_name("grow", tests, NULL, NULL);
}
