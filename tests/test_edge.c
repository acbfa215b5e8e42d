/* The mesh that a fracture outgrows during an advance: what is done, what is said, what is seen. */
#include "check.h"
#include "host.h"

#include <math.h>
#include <string.h>

static ilsa_mesh_def mesh_of(const ilsa_solver *solver) {
    ilsa_mesh_def mesh;
    assert_int_equal(ilsa_get_mesh_def(solver, &mesh), ILSA_OK);
    return mesh;
}

/* A penny between strong barriers at -half and half, on nx by ny cells of 0.1. */
static host_scene between_barriers(int nx, int ny, double half) {
    host_scene scene = host_penny(1e-2, nx, 0.1);
    scene.mesh.ny = ny;
    scene.interfaces = 2;
    scene.interface_y[0] = -half;
    scene.interface_y[1] = half;
    scene.sigma[0] = scene.sigma[2] = 3;
    scene.options.coarsen = 1;
    return scene;
}

/* Advances step by step until the mesh is another one, and returns the report of that step. */
static ilsa_report until_changed(ilsa_solver *solver) {
    ilsa_report report = {0};
    for (int k = 0; k < 400; k++) {
        ilsa_status status = ilsa_advance_one(solver, 1e30, &report);
        if (status != ILSA_OK)
            fail_msg("%s: %s", ilsa_status_text(status), ilsa_last_error(solver));
        assert_int_equal(report.steps, 1);
        if (report.coarsened + report.grown > 0)
            return report;
    }
    fail_msg("the edge of the mesh is not reached");
    return report;
}

static void check_done(const ilsa_report *r, long x, long y, long grown) {
    if (r->coarsened_x != x || r->coarsened_y != y || r->grown != grown)
        fail_msg("coarsened %ld along x, %ld along y, grown %ld", r->coarsened_x, r->coarsened_y,
                 r->grown);
}

/* Of more than 40 cells across 20 are enough: coarsened, which is cheap. */
static void a_penny_of_many_cells_is_coarsened(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1e-2, 45, 0.1);
    scene.options.coarsen = 1;
    ilsa_solver *solver = host_started(&scene, 1.6);
    ilsa_report report = until_changed(solver);
    check_done(&report, 1, 1, 0);
    assert_int_equal(report.coarsened, 1);
    ilsa_summary now = host_summary(solver);
    assert_true(now.total.coarsened == 1 && now.total.coarsened_y == 1 && now.total.grown == 0);
    assert_true(mesh_of(solver).dx == 0.2 && mesh_of(solver).nx == 45);
    ilsa_solver_destroy(&solver);
}

/* Of 27 cells across none can be spared. */
static void a_penny_of_few_cells_gets_more(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1e-2, 29, 0.1), large = host_penny(1e-2, 57, 0.1);
    scene.options.coarsen = 1;
    ilsa_solver *solver = host_started(&scene, 0.9), *twin = host_started(&large, 0.9);
    ilsa_report report = until_changed(solver);
    check_done(&report, 0, 0, 1);
    ilsa_mesh_def mesh = mesh_of(solver);
    assert_true(mesh.nx == 57 && mesh.ny == 57 && mesh.dx == 0.1 && mesh.dy == 0.1);
    while (host_summary(twin).time < host_summary(solver).time)
        host_steps(twin, 1);
    ilsa_summary a = host_summary(solver), b = host_summary(twin);
    assert_true(a.time == b.time && a.x_max == b.x_max && a.width_source == b.width_source);
    /* At its next edge it has 55 cells across. */
    report = until_changed(solver);
    check_done(&report, 1, 1, 0);
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&twin);
}

/* Twelve cells across half of the layer: they stay, and cells become twice as long. */
static void cells_across_a_pay_stay(void **unused) {
    (void)unused;
    host_scene scene = between_barriers(61, 41, 1.2);
    ilsa_solver *solver = host_started(&scene, 0.8);
    ilsa_report report = until_changed(solver);
    check_done(&report, 1, 0, 0);
    ilsa_mesh_def mesh = mesh_of(solver);
    assert_true(mesh.dx == 0.2 && mesh.dy == 0.1 && mesh.nx == 61 && mesh.ny == 41);
    report = until_changed(solver);
    check_done(&report, 1, 0, 0); /* 0.4 to 0.1, six across the pay */
    report = until_changed(solver);
    check_done(&report, 0, 0, 1);
    mesh = mesh_of(solver);
    assert_true(mesh.dx == 0.4 && mesh.dy == 0.1 && mesh.nx == 121 && mesh.ny == 41);
    assert_true(fabs(host_imbalance(solver)) <= 1e-12);
    ilsa_solver_destroy(&solver);
}

/* Five cells across a pay: longer ones would not tell its lengthwise tip. */
static void a_thin_pay_gets_more_columns(void **unused) {
    (void)unused;
    host_scene scene = between_barriers(61, 15, 0.25);
    ilsa_solver *solver = host_started(&scene, 0.22);
    ilsa_report report = until_changed(solver);
    check_done(&report, 0, 0, 1);
    ilsa_mesh_def mesh = mesh_of(solver);
    assert_true(mesh.dx == 0.1 && mesh.dy == 0.1 && mesh.nx == 121 && mesh.ny == 15);
    ilsa_solver_destroy(&solver);
}

/* The layer counts with neighbours of its stress, wherever the source is in it. */
static void layers_of_one_stress_are_one(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1e-2, 61, 0.1);
    scene.options.coarsen = 1;
    scene.interfaces = 3;
    scene.interface_y[0] = -2;
    scene.interface_y[1] = 0.3;
    scene.interface_y[2] = 2;
    scene.sigma[0] = scene.sigma[3] = 0.01;
    ilsa_solver *solver = host_started(&scene, 2);
    ilsa_report report = until_changed(solver);
    check_done(&report, 1, 1, 0);
    ilsa_solver_destroy(&solver);
    scene.sigma[2] = 0.001; /* the layer of the source ends at 0.3 and has 19 cells, not 36 */
    scene.interface_y[0] = -1.6;
    solver = host_started(&scene, 2);
    report = until_changed(solver);
    check_done(&report, 1, 0, 0);
    ilsa_solver_destroy(&solver);
}

/* Without leave for more cells the mesh is coarsened, at the cost of accuracy. */
static void cells_max_is_kept(void **unused) {
    (void)unused;
    host_scene scene = between_barriers(41, 15, 0.25);
    scene.options.cells_max = 41 * 15;
    ilsa_solver *solver = host_started(&scene, 0.22);
    ilsa_report report = until_changed(solver);
    check_done(&report, 1, 0, 0);
    ilsa_solver_destroy(&solver);
    scene.options.cells_max = 60 * 15;
    solver = host_started(&scene, 0.22);
    report = until_changed(solver);
    check_done(&report, 0, 0, 1);
    assert_int_equal(mesh_of(solver).nx, 59);
    report = until_changed(solver);
    check_done(&report, 1, 0, 0);
    ilsa_solver_destroy(&solver);
}

/* Rows that lie idle above and below a long fracture make room for columns. */
static void idle_rows_become_columns(void **unused) {
    (void)unused;
    host_scene scene = between_barriers(41, 61, 0.25);
    scene.options.cells_max = 41 * 61;
    ilsa_solver *solver = host_started(&scene, 0.22);
    ilsa_report report = until_changed(solver);
    check_done(&report, 0, 0, 1);
    ilsa_mesh_def mesh = mesh_of(solver);
    assert_true(mesh.nx == 81 && mesh.ny < 31 && mesh.ny % 2 == 1 && mesh.dx == 0.1);
    assert_true(fabs(host_imbalance(solver)) <= 1e-12);
    host_image now = host_save(solver);
    ilsa_solver *fresh = host_started(&scene, 0.22);
    host_restore(fresh, &now);
    host_steps(solver, 3);
    host_steps(fresh, 3);
    host_free(&now);
    now = host_save(solver);
    assert_true(host_is(fresh, &now));
    host_free(&now);
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&fresh);
    scene.source_count = 2; /* one that waits outside must stay on the mesh */
    scene.source[1] = (ilsa_source_def){.x = 0, .y = 2.9, .rate = 0};
    solver = host_started(&scene, 0.22);
    report = until_changed(solver);
    check_done(&report, 1, 0, 0);
    ilsa_solver_destroy(&solver);
}

static void check_says(const ilsa_solver *solver, const char *part) {
    if (!strstr(ilsa_last_error(solver), part))
        fail_msg("message '%s' does not contain '%s'", ilsa_last_error(solver), part);
}

/* Seven cells across cannot become fewer: the edge is said, with its place and what to try. */
static void where_nothing_is_left_it_is_said(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1e-2, 9, 0.1);
    scene.options.coarsen = 1;
    scene.options.cells_max = 1;
    ilsa_solver *solver = host_started(&scene, 0.2);
    ilsa_status status = ILSA_OK;
    while (status == ILSA_OK)
        status = ilsa_advance_one(solver, 1e30, NULL);
    assert_int_equal(status, ILSA_MESH_EDGE);
    check_says(solver, "x -0.");
    check_says(solver, "9 x 9 cells");
    check_says(solver, "cells_max");
    host_image before = host_save(solver);
    assert_int_equal(ilsa_advance(solver, 1e30, NULL), ILSA_MESH_EDGE);
    assert_true(host_is(solver, &before));
    host_free(&before);
    ilsa_solver_destroy(&solver);
    scene = host_penny(1e-2, 29, 0.1);
    solver = host_started(&scene, 0.9);
    assert_int_equal(ilsa_advance(solver, 1e30, NULL), ILSA_MESH_EDGE);
    check_says(solver, "coarsen = 1");
    ilsa_solver_destroy(&solver);
}

/* What a user sees */

static double jump(double before, double after) {
    return fabs(after / before - 1);
}

/*
 * A fracture between barriers 6 m apart that outgrows 17 columns: on 261 x 61 cells from the start
 * it comes to x = 38.27 m, with 0.5143 mm and 2.7133 MPa at the source.
 */
static void a_fracture_of_one_height_runs_on_along_x(void **unused) {
    (void)unused;
    const ilsa_rock rock = {.E = 3.3e10, .nu = 0.4, .mu = 1.1e-3, .K_Ic = 0, .C_L = 0};
    host_scene scene = {.mesh = {17, 35, 0.3235294, 0.1371428}, .source_count = 1};
    scene.source[0].rate = 0.001;
    scene.interfaces = 2;
    scene.interface_y[0] = -3;
    scene.interface_y[1] = 3;
    scene.sigma[0] = scene.sigma[2] = 7.5e6;
    scene.sigma[1] = 1e6;
    scene.options = ilsa_solver_def_default();
    scene.options.coarsen = 1;
    assert_int_equal(ilsa_material_def_from_rock(&rock, &scene.material), ILSA_OK);
    ilsa_solver *solver = host_started(&scene, 1);
    ilsa_report report;
    assert_int_equal(ilsa_advance(solver, 145, &report), ILSA_OK);
    assert_true(report.grown > 0 && report.coarsened_x > 0);
    ilsa_summary end = host_summary(solver);
    print_message("edge: x %.2f m, width %.4f mm, pressure %.4f MPa\n", end.x_max,
                  1e3 * end.width_source, 1e-6 * end.pressure_source);
    assert_true(jump(38.27, end.x_max) < 0.01); /* 0.4 % */
    assert_true(jump(0.5143e-3, end.width_source) < 0.01);
    assert_true(jump(2.7133e6, end.pressure_source) < 0.005);
    assert_true(6 / mesh_of(solver).dy > 10);
    ilsa_solver_destroy(&solver);
}

/* Rock and rates of the field: `what` is 0 viscosity, 1 toughness, 2 leak-off, 3 a pay between
 * barriers, 4 leak-off and shut in, 5 a pay with leak-off and shut in. */
enum { STATES = 6 };

static host_scene field_state(int what) {
    ilsa_rock rock = {.E = 25e9, .nu = 0.22, .mu = 0.05, .K_Ic = 1.2e6, .C_L = 0};
    rock.mu = what == 1 ? 1e-4 : 0.05;
    rock.K_Ic = what == 0 ? 0 : what == 1 ? 4e6 : 1.2e6;
    rock.C_L = what == 2 || what >= 4 ? 3e-5 : 0;
    host_scene scene = {.mesh = {.nx = 65, .ny = 65, .dx = 1, .dy = 1}, .source_count = 1};
    scene.source[0].rate = 0.05;
    scene.sigma[0] = 45e6;
    scene.options = ilsa_solver_def_default();
    if (what == 3 || what == 5) {
        scene.interfaces = 2;
        scene.interface_y[0] = -12;
        scene.interface_y[1] = 12;
        scene.sigma[1] = 40e6;
        scene.sigma[2] = 46e6;
    }
    assert_int_equal(ilsa_material_def_from_rock(&rock, &scene.material), ILSA_OK);
    return scene;
}

/* A state at the edge of its mesh, or some steps after shut-in. */
static ilsa_solver *field_solver(int what) {
    host_scene scene = field_state(what);
    ilsa_solver *solver = host_started(&scene, 6);
    ilsa_status status = ILSA_OK;
    while (status == ILSA_OK && (what < 4 || host_summary(solver).extent_x_max < 27))
        status = ilsa_advance_one(solver, 1e30, NULL);
    assert_int_equal(status, what < 4 ? ILSA_MESH_EDGE : ILSA_OK);
    if (what >= 4) {
        assert_int_equal(ilsa_set_rate(solver, 0, 0), ILSA_OK);
        host_steps(solver, 5);
    }
    return solver;
}

static void check_jump(int what, const char *where, const ilsa_summary *a, const ilsa_summary *b) {
    double x = fmax(jump(a->x_max, b->x_max), jump(a->x_min, b->x_min));
    double y = fmax(jump(a->y_max, b->y_max), jump(a->y_min, b->y_min));
    double w = jump(a->width_source, b->width_source);
    double p = jump(a->pressure_source, b->pressure_source);
    double e = jump(a->efficiency, b->efficiency);
    print_message("edge: state %d, %s: x %.2f %%, y %.2f %%, width %.2f %%, pressure %.2f %%, "
                  "efficiency %.2f %%\n",
                  what, where, 100 * x, 100 * y, 100 * w, 100 * p, 100 * e);
    assert_true(a->volume_fracture == b->volume_fracture && a->volume_leaked == b->volume_leaked);
    assert_below(fmax(fmax(x, y), fmax(p, e)), 0.005);
    assert_below(w, 0.01);
}

static void nothing_jumps_and_the_next_step_is_accepted(void **unused) {
    (void)unused;
    static const char *const names[] = {"grown", "along x", "along y", "both"};
    for (int what = 0; what < STATES; what++)
        for (int how = 0; how < 4; how++) {
            if ((what == 3 || what == 5) && how >= 2)
                continue; /* that an advance would not do to a pay */
            ilsa_solver *solver = field_solver(what);
            ilsa_summary before = host_summary(solver);
            assert_int_equal(how ? ilsa_coarsen_along(solver, how) : ilsa_grow(solver, 9, 9),
                             ILSA_OK);
            ilsa_summary after = host_summary(solver);
            check_jump(what, names[how], &before, &after);
            if (how == 1 || how == 2)
                assert_int_equal(ilsa_grow(solver, 9, 9), ILSA_OK);
            ilsa_report report;
            assert_int_equal(ilsa_advance_one(solver, 1e30, &report), ILSA_OK);
            assert_int_equal(report.rejected, 0);
            assert_true(fabs(host_imbalance(solver)) <= 1e-12);
            ilsa_solver_destroy(&solver);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_penny_of_many_cells_is_coarsened),
        cmocka_unit_test(a_penny_of_few_cells_gets_more),
        cmocka_unit_test(cells_across_a_pay_stay),
        cmocka_unit_test(a_thin_pay_gets_more_columns),
        cmocka_unit_test(layers_of_one_stress_are_one),
        cmocka_unit_test(cells_max_is_kept),
        cmocka_unit_test(idle_rows_become_columns),
        cmocka_unit_test(a_fracture_of_one_height_runs_on_along_x),
        cmocka_unit_test(where_nothing_is_left_it_is_said),
        cmocka_unit_test(nothing_jumps_and_the_next_step_is_accepted),
    };
    return cmocka_run_group_tests_name("edge", tests, NULL, NULL);
}
