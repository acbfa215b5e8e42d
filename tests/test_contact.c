/* Closure: what a host sees of cells whose faces touch, after shut-in and under stress that rises.
 */
#include "check.h"
#include "elastic/dd_kernel.h"
#include "elastic/elasticity.h"
#include "host.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A penny of phi that has grown a little and is shut in. */
static ilsa_solver *shut_in(const host_scene *scene, double radius) {
    ilsa_solver *solver = host_started(scene, radius);
    host_steps(solver, 3);
    assert_int_equal(ilsa_set_rate(solver, 0, 0), ILSA_OK);
    return solver;
}

static host_scene leaking_penny(void) {
    return host_penny(0.01, 31, 0.1);
}

/* Steps until a part of the channel is closed, or all of it: 1. */
static void close_to(ilsa_solver *solver, double part) {
    for (int k = 0; k < 400; k++) {
        ilsa_summary now = host_summary(solver);
        if (now.closed_cells >= part * (now.cells - now.tip_cells)) {
            return;
        }
        host_steps(solver, 1);
    }
    fail_msg("not closed after 400 steps");
}

static ilsa_solver *half_closed(void) {
    host_scene scene = leaking_penny();
    ilsa_solver *solver = shut_in(&scene, 1);
    close_to(solver, 0.5);
    return solver;
}

/* ---- The penny that is shut in ----------------------------------------------------------------
 */

/* C' ((t1 - t0)^(1/2) - (t2 - t0)^(1/2)) 2 over the disc that the front of r ~ t^b has passed. */
static double carter(double C_prime, double R, double t_R, double b, double from, double to) {
    double sum = 0;
    const int n = 20000;
    for (int k = 0; k < n; k++) {
        double r = (k + 0.5) / n * R, arrived = t_R * pow(r / R, 1 / b);
        double leaked = 2 * C_prime * (sqrt(to - arrived) - sqrt(from - arrived));
        sum += leaked * 2 * acos(-1) * r * R / n;
    }
    return sum;
}

/*
 * While all of it is open a fracture at rest loses what the rock takes: Carter's law over the disc,
 * with times of arrival of a front that went as a power of time before.
 */
static void an_open_penny_loses_what_the_rock_takes(void **state) {
    (void)state;
    host_scene scene = host_penny(0.01, 41, 0.1);
    ilsa_solver *solver = host_started(&scene, 1);
    double R[2], t[2];
    for (int k = 0; k < 2; k++) {
        R[k] = host_summary(solver).x_max;
        t[k] = host_summary(solver).time;
        host_steps(solver, 6);
    }
    double b = log(R[1] / R[0]) / log(t[1] / t[0]);
    assert_int_equal(ilsa_set_rate(solver, 0, 0), ILSA_OK);
    host_steps(solver, 5); /* comes to rest */
    ilsa_summary from = host_summary(solver), to = from;
    while (host_summary(solver).closed_cells == 0) {
        to = host_summary(solver);
        host_steps(solver, 1);
    }
    assert_true(to.time > 1.05 * from.time && to.x_max < 1.002 * from.x_max);
    double t_R = t[1] * pow(from.x_max / R[1], 1 / b);
    double taken = carter(scene.material.C_prime, from.x_max, t_R, b, from.time, to.time);
    double leaked = to.volume_leaked - from.volume_leaked;
    print_message("contact: leaked %.4f, Carter over the disc %.4f\n", leaked, taken);
    assert_true(fabs(leaked / taken - 1) < 0.02);
    assert_true(relative(from.volume_fracture - to.volume_fracture, leaked) < 1e-10);
    ilsa_solver_destroy(&solver);
}

/* The width falls in every cell that is open, no litre is lost, and in the end all is closed. */
static void a_penny_shut_in_closes(void **state) {
    (void)state;
    host_scene scene = leaking_penny();
    ilsa_solver *solver = shut_in(&scene, 1);
    size_t cells = (size_t)scene.mesh.nx * (size_t)scene.mesh.ny;
    double *before = calloc(cells, sizeof *before);
    assert_non_null(before);
    ilsa_summary first = host_summary(solver), last = first;
    host_steps(solver, 5); /* the front comes to rest */
    while (host_summary(solver).closed_cells < last.cells - last.tip_cells) {
        memcpy(before, host_width(solver), cells * sizeof *before);
        host_steps(solver, 1);
        ilsa_summary now = host_summary(solver);
        const double *width = host_width(solver);
        const unsigned char *kind = host_kind(solver);
        for (size_t c = 0; c < cells; c++) {
            int channel = kind[c] >= ILSA_CELL_SURVEY;
            /* A tip cell that had run short fills up when the leak-off around it ends. */
            double filled = channel ? 0 : 1e-2 * now.closure_width;
            assert_true(width[c] <= before[c] * (1 + 1e-12) + filled);
            assert_true(!channel || width[c] >= now.closure_width * (1 - 1e-12));
            assert_true(isfinite(host_pressure(solver)[c]));
        }
        assert_true(now.closed_cells >= last.closed_cells - 4);
        assert_true(fabs(host_imbalance(solver)) <= 1e-12);
        assert_true(now.volume_injected == first.volume_injected);
        assert_true(now.x_max >= last.x_max);
        last = now;
        assert_true(last.total.steps < 500);
    }
    assert_true(last.closure_width < 1.1e-4 * first.width_source);
    assert_true(last.volume_fracture < 2e-4 * first.volume_fracture);
    print_message("contact: closed at %.3f times the time of shut-in, %ld steps, %ld refused\n",
                  last.time / first.time, last.total.steps, last.total.rejected);
    free(before);
    ilsa_solver_destroy(&solver);
}

/* All closed has its own status; time may pass; injection opens it again and it grows on. */
static void a_closed_penny_waits_and_opens(void **state) {
    (void)state;
    host_scene scene = leaking_penny();
    ilsa_solver *solver = shut_in(&scene, 1);
    host_steps(solver, 1);
    double now = host_summary(solver).time;
    assert_int_equal(ilsa_wait(solver, 2 * now), ILSA_ERR_STATE);
    assert_non_null(strstr(ilsa_last_error(solver), "open"));
    close_to(solver, 1);
    host_image closed = host_save(solver);
    now = host_summary(solver).time;
    assert_int_equal(ilsa_step(solver, 0.1 * now, NULL), ILSA_CLOSED);
    assert_non_null(strstr(ilsa_last_error(solver), "every cell is closed"));
    assert_int_equal(ilsa_advance(solver, 2 * now, NULL), ILSA_CLOSED);
    assert_int_equal(ilsa_advance_one(solver, 2 * now, NULL), ILSA_CLOSED);
    assert_true(host_is(solver, &closed));
    static const double bad[] = {NAN, INFINITY, 0, -1};
    for (int k = 0; k < 4; k++) {
        assert_int_equal(ilsa_wait(solver, bad[k]), ILSA_ERR_VALUE);
    }
    assert_int_equal(ilsa_wait(NULL, 1), ILSA_ERR_NULL);
    assert_true(host_is(solver, &closed));
    assert_int_equal(ilsa_wait(solver, 2 * now), ILSA_OK);
    ilsa_summary waited = host_summary(solver);
    assert_true(waited.time == 2 * now);
    assert_int_equal(ilsa_set_rate(solver, 0, 1), ILSA_OK);
    assert_int_equal(ilsa_wait(solver, 3 * now), ILSA_ERR_STATE);
    ilsa_summary grown = waited;
    for (int k = 0; k < 400 && grown.x_max < waited.x_max + 0.2; k++) {
        host_steps(solver, 1);
        grown = host_summary(solver);
        assert_true(fabs(host_imbalance(solver)) <= 1e-12);
    }
    print_message("contact: reopened and grown by two cells in %ld steps, %ld refused\n",
                  grown.total.steps - waited.total.steps,
                  grown.total.rejected - waited.total.rejected);
    assert_true(grown.x_max >= waited.x_max + 0.2 && grown.closed_cells == 0);
    host_free(&closed);
    ilsa_solver_destroy(&solver);
}

/* ---- The conditions of contact ----------------------------------------------------------------
 */

/* sigma + C w at a cell, by summing. */
static double closure_stress(const ilsa_solver *solver, const host_scene *scene, int cell) {
    const double *width = host_width(solver);
    int nx = scene->mesh.nx;
    double sum = 0;
    for (int other = 0; other < nx * scene->mesh.ny; other++) {
        int di = abs(other % nx - cell % nx), dj = abs(other / nx - cell / nx);
        sum += width[other] != 0
                   ? width[other] * ilsai_dd_kernel(di, dj, scene->mesh.dx, scene->mesh.dy)
                   : 0;
    }
    return sum * scene->material.E_prime;
}

/* Whether a cell that no longer says so is a survey cell. */
static int beside_tip(const ilsa_solver *solver, int cell) {
    ilsa_mesh_def m;
    assert_int_equal(ilsa_get_mesh_def(solver, &m), ILSA_OK);
    const unsigned char *kind = host_kind(solver) + cell;
    return kind[-1] < ILSA_CELL_SURVEY || kind[1] < ILSA_CELL_SURVEY ||
           kind[-m.nx] < ILSA_CELL_SURVEY || kind[m.nx] < ILSA_CELL_SURVEY;
}

/*
 * Behind the survey cells the fluid carries the closure stress, in open cells and in the film of
 * closed ones; and there are both.
 */
static void closed_faces_press_on_each_other(void **state) {
    (void)state;
    host_scene scene = leaking_penny();
    ilsa_solver *solver = half_closed();
    double closure = host_summary(solver).closure_width, largest = 0;
    int open = 0, closed = 0;
    for (int cell = 0; cell < scene.mesh.nx * scene.mesh.ny; cell++) {
        int kind = host_kind(solver)[cell];
        if (kind != ILSA_CELL_CHANNEL && (kind != ILSA_CELL_CLOSED || beside_tip(solver, cell))) {
            continue;
        }
        double stress = closure_stress(solver, &scene, cell), p = host_pressure(solver)[cell];
        largest = larger_of(largest, fabs(stress));
        open += kind == ILSA_CELL_CHANNEL;
        closed += kind == ILSA_CELL_CLOSED;
        assert_true((host_width(solver)[cell] > 1.001 * closure) == (kind == ILSA_CELL_CHANNEL));
        assert_true(fabs(p - stress) < 1e-3 * largest);
    }
    assert_true(open > 20 && closed > 20);
    ilsa_solver_destroy(&solver);
}

/* Closing keeps the penny's symmetry: about both axes and with the axes exchanged. */
static void closing_is_symmetric(void **state) {
    (void)state;
    host_scene scene = leaking_penny();
    scene.options.symmetry = ILSA_SYMMETRY_NONE;
    scene.options.level = 5;
    ilsa_solver *solver = shut_in(&scene, 1);
    close_to(solver, 0.3);
    int n = scene.mesh.nx;
    const double *width = host_width(solver);
    double worst = NOTHING_YET;
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            double w = width[j * n + i], largest = host_summary(solver).width_source;
            worst = worst_of(worst, fabs(width[j * n + n - 1 - i] - w) / largest);
            worst = worst_of(worst, fabs(width[(n - 1 - j) * n + i] - w) / largest);
            worst = worst_of(worst, fabs(width[i * n + j] - w) / largest);
        }
    }
    print_message("contact: octants differ by %.2g of the width\n", worst);
    assert_below(worst, 1e-4);
    ilsa_solver_destroy(&solver);
}

/* However it is solved the same fluid is left at the same time. */
static void every_way_of_solving_agrees(void **state) {
    (void)state;
    double volume[5];
    for (int k = 0; k < 5; k++) {
        host_scene scene = leaking_penny();
        scene.options.level = 5;
        scene.options.step_cells = 0.5;
        scene.options.linear = k == 1 ? ILSA_LINEAR_DENSE : ILSA_LINEAR_GMRES;
        scene.options.symmetry = k == 2 ? ILSA_SYMMETRY_NONE : ILSA_SYMMETRY_AUTO;
        scene.options.product = k == 3 ? ILSA_PRODUCT_BLAS : ILSA_PRODUCT_AUTO;
        scene.options.threads = k == 4 ? 2 : 0;
        ilsa_solver *solver = shut_in(&scene, 1);
        double t = host_summary(solver).time;
        for (int n = 1; n <= 20; n++) {
            assert_int_equal(ilsa_advance(solver, t * (1 + 0.035 * n), NULL), ILSA_OK);
        }
        assert_true(host_summary(solver).closed_cells > 20);
        volume[k] = host_summary(solver).volume_fracture;
        ilsa_solver_destroy(&solver);
    }
    for (int k = 1; k < 5; k++) {
        assert_true(relative(volume[k], volume[0]) < 1e-3);
    }
    assert_true(volume[4] == volume[0]);
}

/* ---- A snapshot, units, a width of the host's own -----------------------------------------------
 */

static void a_snapshot_while_closing_resumes_bit_for_bit(void **state) {
    (void)state;
    ilsa_solver *solver = half_closed();
    host_image before = host_save(solver);
    host_steps(solver, 5);
    host_image after = host_save(solver);
    host_restore(solver, &before);
    host_steps(solver, 5);
    assert_true(host_is(solver, &after));
    host_free(&before);
    host_free(&after);
    ilsa_solver_destroy(&solver);
}

/* Volume and width at the source of a penny that closes, over the units of length. */
typedef struct closing {
    double volume, width;
} closing;

static closing close_in(double length, double time, double stress, double rate) {
    host_scene scene = leaking_penny();
    scene.options.tolerance = 1e-8;
    scene.mesh.dx *= length;
    scene.mesh.dy *= length;
    scene.material.E_prime *= stress;
    scene.material.mu_prime *= stress * time;
    scene.material.K_prime *= stress * sqrt(length);
    scene.material.C_prime *= length / sqrt(time);
    scene.source[0].rate *= rate * length * length * length / time;
    ilsa_solver *solver = shut_in(&scene, length);
    double t = host_summary(solver).time;
    for (int n = 1; n <= 20; n++) {
        assert_int_equal(ilsa_advance(solver, t * (1 + 0.03 * n), NULL), ILSA_OK);
    }
    const ilsa_summary end = host_summary(solver);
    assert_true(end.closed_cells > 20);
    ilsa_solver_destroy(&solver);
    return (closing){end.volume_fracture / (length * length * length), end.width_source / length};
}

static double apart(closing a, closing b) {
    return worst_of(relative(a.volume, b.volume), relative(a.width, b.width));
}

/*
 * Lengths by 2^8, times by 2^-6, forces by 2^20 change no more than rounding does. Which cells
 * close first may hang on rounding: what it does is seen where the rate changes by that.
 */
static void closing_knows_no_units(void **state) {
    (void)state;
    const double length = 0x1p8, time = 0x1p-6, stress = 0x1p20 / (length * length);
    const closing here = close_in(1, 1, 1, 1), there = close_in(length, time, stress, 1);
    double rounding = NOTHING_YET;
    for (int n = 1; n <= 4; n++) {
        rounding = worst_of(rounding, apart(close_in(1, 1, 1, 1 + n * 0x1p-51), here));
    }
    print_message("contact: in other units off by %.2g, by rounding %.2g\n", apart(there, here),
                  rounding);
    assert_below(apart(there, here), larger_of(1e-9, 2 * rounding));
    assert_below(rounding, 1e-3);
}

static void a_host_sets_the_closure_width(void **state) {
    (void)state;
    static const double bad[] = {NAN, INFINITY, -1e-9};
    host_scene scene = leaking_penny();
    for (int k = 0; k < 3; k++) {
        ilsa_solver *none;
        scene.options.closure_width = bad[k];
        assert_int_equal(host_try(&scene, &none), ILSA_ERR_VALUE);
        assert_non_null(strstr(ilsa_last_error(NULL), "closure_width"));
    }
    scene.options.closure_width = 0.01;
    ilsa_solver *solver = shut_in(&scene, 1);
    close_to(solver, 1);
    ilsa_summary now = host_summary(solver);
    assert_true(now.closure_width == 0.01);
    assert_true(fabs(now.width_source - 0.01) < 1e-4);
    ilsa_solver_destroy(&solver);
}

/* ---- Stress that closes -------------------------------------------------------------------------
 */

/* Stress on one half of the mesh; nothing leaks, so that the fluid is pressed into the other. */
static ilsa_stress *on_the_right(const host_scene *scene, double stress) {
    int nx = scene->mesh.nx, count = nx * scene->mesh.ny;
    double *sigma = calloc((size_t)count, sizeof *sigma);
    ilsa_stress_def def = ilsa_stress_def_default();
    ilsa_mesh *mesh;
    ilsa_stress *out;
    assert_non_null(sigma);
    for (int cell = 0; cell < count; cell++) {
        sigma[cell] = cell % nx > nx / 2 + 4 ? stress : 0;
    }
    assert_int_equal(ilsa_mesh_create(&scene->mesh, &mesh), ILSA_OK);
    assert_int_equal(ilsa_stress_create(&def, &out), ILSA_OK);
    assert_int_equal(ilsa_stress_set_cells(out, mesh, sigma), ILSA_OK);
    ilsa_mesh_destroy(&mesh);
    free(sigma);
    return out;
}

static void rising_stress_closes_and_falling_opens(void **state) {
    (void)state;
    host_scene scene = host_penny(0, 41, 0.1);
    ilsa_solver *solver = shut_in(&scene, 1);
    ilsa_stress *high = on_the_right(&scene, 2), *none = on_the_right(&scene, 0);
    double volume = host_summary(solver).volume_fracture;
    assert_int_equal(ilsa_set_stress(solver, high), ILSA_OK);
    host_steps(solver, 20);
    ilsa_summary pressed = host_summary(solver);
    assert_true(pressed.closed_cells > 10);
    assert_true(fabs(host_imbalance(solver)) <= 1e-12 && pressed.volume_fracture == volume);
    assert_int_equal(ilsa_set_stress(solver, none), ILSA_OK);
    host_steps(solver, 20);
    ilsa_summary freed = host_summary(solver);
    print_message("contact: %d cells closed by stress, %d when it is gone\n", pressed.closed_cells,
                  freed.closed_cells);
    assert_true(freed.closed_cells == 0);
    assert_true(fabs(host_imbalance(solver)) <= 1e-12 && freed.volume_fracture == volume);
    ilsa_stress_destroy(&high);
    ilsa_stress_destroy(&none);
    ilsa_solver_destroy(&solver);
}

/* A start that reaches into barriers of twice the net pressure closes there and goes on. */
static void a_fracture_in_its_barriers_closes_there(void **state) {
    (void)state;
    host_scene scene = host_three_layers(171, 61);
    scene.sigma[0] = scene.sigma[2] = 9e6;
    ilsa_solver *solver = host_started(&scene, 14);
    assert_int_equal(ilsa_advance(solver, 400, NULL), ILSA_OK);
    ilsa_summary now = host_summary(solver);
    print_message("contact: in the barriers %d cells closed, half-length %.1f m, %ld steps, %ld "
                  "refused\n",
                  now.closed_cells, now.x_max, now.total.steps, now.total.rejected);
    assert_true(now.closed_cells > 0 && now.x_max > 30);
    assert_true(fabs(host_imbalance(solver)) <= 1e-12);
    ilsa_solver_destroy(&solver);
}

/* ---- In the field ------------------------------------------------------------------------------
 */

/* A layer of 40 m between barriers, pumped with linear gel. */
static host_scene gel_in_a_layer(int nx, int ny, double h) {
    const ilsa_rock rock = {.E = 30e9, .nu = 0.25, .mu = 0.03, .K_Ic = 1.5e6, .C_L = 3e-5};
    host_scene scene = host_three_layers(nx, ny);
    assert_int_equal(ilsa_material_def_from_rock(&rock, &scene.material), ILSA_OK);
    scene.mesh.dx = scene.mesh.dy = h;
    scene.interface_y[0] = -20;
    scene.interface_y[1] = 20;
    scene.sigma[0] = scene.sigma[2] = 45e6;
    scene.sigma[1] = 40e6;
    scene.source[0].rate = 0.06;
    return scene;
}

/*
 * An hour and more of closing: no pressure is far from the stresses and what the fluid once had
 * over them, in the tip cells neither, and the fluid of closed cells carries the closure stress.
 */
static void pressures_stay_those_of_rock_after_shut_in(void **state) {
    (void)state;
    host_scene scene = gel_in_a_layer(81, 31, 4);
    ilsa_solver *solver = host_started(&scene, 12);
    assert_int_equal(ilsa_advance(solver, 600, NULL), ILSA_OK);
    assert_int_equal(ilsa_set_rate(solver, 0, 0), ILSA_OK);
    double least = INFINITY, most = -INFINITY;
    while (host_summary(solver).time < 5000) {
        ilsa_status status = ilsa_advance_one(solver, 5000, NULL);
        if (status == ILSA_CLOSED) {
            break;
        }
        assert_int_equal(status, ILSA_OK);
        for (int cell = 0; cell < scene.mesh.nx * scene.mesh.ny; cell++) {
            if (host_kind(solver)[cell] != ILSA_CELL_EMPTY) {
                least = fmin(least, host_pressure(solver)[cell]);
                most = fmax(most, host_pressure(solver)[cell]);
            }
        }
    }
    ilsa_summary now = host_summary(solver);
    int closed = 0;
    for (int cell = 0; cell < scene.mesh.nx * scene.mesh.ny; cell++) {
        if (host_kind(solver)[cell] == ILSA_CELL_CLOSED) {
            double stress = scene.sigma[1] + closure_stress(solver, &scene, cell);
            int j = cell / scene.mesh.nx - scene.mesh.ny / 2;
            closed++;
            assert_true(abs(j) > 4 || beside_tip(solver, cell) ||
                        relative(host_pressure(solver)[cell], stress) < 1e-3);
        }
    }
    assert_int_equal(closed, now.closed_cells);
    print_message("contact: pressures after shut-in %.3g to %.3g MPa, %d closed, %ld steps, %ld "
                  "refused\n",
                  1e-6 * least, 1e-6 * most, closed, now.total.steps, now.total.rejected);
    assert_true(closed > 100 && least > -100e6 && most < 100e6);
    assert_true((double)now.total.rejected <= 0.05 * (double)now.total.steps);
    assert_true(fabs(host_imbalance(solver)) <= 1e-12);
    ilsa_solver_destroy(&solver);
}

/* ---- Again and again ----------------------------------------------------------------------------
 */

static void pumping_in_strokes_loses_nothing(void **state) {
    (void)state;
    host_scene scene = host_penny(0.01, 61, 0.1);
    scene.options.coarsen = 1;
    ilsa_solver *solver = host_started(&scene, 1);
    double period = host_summary(solver).time;
    for (int stroke = 0; stroke < (host_long() ? 100 : 10); stroke++) {
        double t = host_summary(solver).time;
        assert_int_equal(ilsa_set_rate(solver, 0, stroke % 2), ILSA_OK);
        ilsa_status status = ilsa_advance(solver, t + 1.5 * period, NULL);
        if (status != ILSA_OK && !(status == ILSA_CLOSED && stroke % 2 == 0)) {
            fail_msg("stroke %d: %s", stroke, ilsa_last_error(solver));
        }
        assert_true(fabs(host_imbalance(solver)) <= 1e-11);
    }
    ilsa_solver_destroy(&solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_open_penny_loses_what_the_rock_takes),
        cmocka_unit_test(a_penny_shut_in_closes),
        cmocka_unit_test(a_closed_penny_waits_and_opens),
        cmocka_unit_test(closed_faces_press_on_each_other),
        cmocka_unit_test(closing_is_symmetric),
        cmocka_unit_test(every_way_of_solving_agrees),
        cmocka_unit_test(a_snapshot_while_closing_resumes_bit_for_bit),
        cmocka_unit_test(closing_knows_no_units),
        cmocka_unit_test(a_host_sets_the_closure_width),
        cmocka_unit_test(rising_stress_closes_and_falling_opens),
        cmocka_unit_test(a_fracture_in_its_barriers_closes_there),
        cmocka_unit_test(pressures_stay_those_of_rock_after_shut_in),
        cmocka_unit_test(pumping_in_strokes_loses_nothing),
    };
    return cmocka_run_group_tests_name("contact", tests, NULL, NULL);
}
