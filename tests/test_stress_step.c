/*
 * Steps of the far-field stress close behind the front: the width that one adds, against the
 * integral equation that it solves, and what it does for fronts just inside a barrier.
 */
#include "check.h"
#include "host.h"
#include "tip/stress_step.h"
#include "tip/tip_cell.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

/* ---- The width --------------------------------------------------------------------------------
 */

/* d w / d s = (4 / pi) ln |(s^(1/2) + d^(1/2)) / (s^(1/2) - d^(1/2))|. */
static double slope(double s, double d) {
    double h = 1e-6 * fabs(s - d);
    return (ilsai_stress_step_width(s + h, d) - ilsai_stress_step_width(s - h, d)) / (2 * h);
}

/*
 * p / E' = -(1 / 4 pi) times the principal value of the integral of w'(x) / (x - s) over x > 0, as
 * the integral over u > 0 of [w'(s + u) - w'(s - u)] / u, in u = e^y.
 */
static double pressure(double s, double d) {
    enum { POINTS = 400000 };
    double sum = 0, low = log(1e-7 * s), high = log(1e9 * s), dy = (high - low) / POINTS;
    for (int k = 0; k < POINTS; k++) {
        double u = exp(low + (k + 0.5) * dy);
        sum += (slope(s + u, d) - (u < s ? slope(s - u, d) : 0)) * dy;
    }
    return -sum / (4 * PI);
}

/* The pressure that the width brings about is higher by 1 behind the jump than in front of it. */
static void width_carries_the_jump(void **unused) {
    (void)unused;
    double behind = pressure(1.7, 1), in_front = pressure(0.4, 1), deep = pressure(6, 1);
    print_message("jump: pressure %.4f deep, %.4f behind, %.4f in front\n", deep, behind, in_front);
    assert_true(fabs(behind - in_front - 1) < 2e-3);
    assert_true(fabs(deep - behind) < 1e-3);
}

static void front_feels_no_jump(void **unused) {
    (void)unused;
    for (double s = 1e-12; s < 1e-3; s *= 10) {
        double first = 4 / PI * 4 / 3 * pow(s, 1.5);
        assert_true(fabs(ilsai_stress_step_width(s, 1) / first - 1) < 2 * s + 1e-9);
    }
    assert_true(ilsai_stress_step_width(0, 1) == 0 && ilsai_stress_step_width(1, 0) == 0);
    assert_true(ilsai_stress_step_width(-1, 1) == 0 && ilsai_stress_step_width(1, -1) == 0);
    assert_true(ilsai_stress_step_at(0, 1).moment == 0 && ilsai_stress_step_at(1, -1).moment == 0);
}

static void moment_is_the_integral(void **unused) {
    (void)unused;
    static const double ends[] = {1e-9, 1e-4, 0.3, 0.9, 1, 1.1, 4, 300};
    double worst = NOTHING_YET;
    for (int k = 0; k < 8; k++) {
        enum { POINTS = 20000 };
        double sum = 0;
        for (int i = 0; i < POINTS; i++)
            sum += ilsai_stress_step_width(2.5 * ends[k] * (i + 0.5) / POINTS, 2.5) * 2.5 *
                   ends[k] / POINTS;
        worst = worst_of(worst, fabs(ilsai_stress_step_at(2.5 * ends[k], 2.5).moment / sum - 1));
    }
    print_message("jump: moment %.1e off midpoints\n", worst);
    assert_below(worst, 1e-6);
}

/* What a step a distance d behind the front adds to the volume of a cell. */
static tip_cell_step step_in_cell(double d, const tip_cell_front *front) {
    const tip_cell_nodes nodes = ilsai_tip_cell_nodes(front);
    return ilsai_tip_cell_step(d, &nodes);
}

/* The derivative by d against differences: the front passes a step by this alone. */
static void volume_grows_with_the_depth_of_the_step(void **unused) {
    (void)unused;
    double worst = NOTHING_YET;
    for (double alpha = 0; alpha < 1.6; alpha += 0.31)
        for (double ell = 0.2; ell < 2; ell += 0.35)
            for (double d = 0.013; d < 30; d *= 1.9) {
                const tip_cell_front f = {ell, cos(alpha), fabs(sin(alpha)), 1, 0.7};
                const double part = 1e-4, now = step_in_cell(d, &f).volume;
                const double more = step_in_cell(d * (1 + part), &f).volume;
                const double less = step_in_cell(d * (1 - part), &f).volume;
                const double slope = (more - less) / (2 * part);
                worst = worst_of(worst, fabs(slope - d * step_in_cell(d, &f).by_d) / now);
            }
    print_message("jump: derivative by its depth %.1e off differences, of the volume\n", worst);
    assert_below(worst, 1e-6);
}

/* The part of it in a cell, by midpoints. */
static void volume_in_a_cell(void **unused) {
    (void)unused;
    double worst = NOTHING_YET;
    for (double alpha = 0; alpha < 1.6; alpha += 0.31)
        for (double ell = 0.2; ell < 2; ell += 0.35) {
            enum { POINTS = 400 };
            tip_cell_front f = {ell, cos(alpha), fabs(sin(alpha)), 1, 0.7};
            double sum = 0;
            for (int k = 0; k < POINTS * POINTS; k++) {
                double x = (k % POINTS + 0.5) / POINTS * f.dx,
                       y = (k / POINTS + 0.5) / POINTS * f.dy;
                sum += ilsai_stress_step_width(ell - x * f.cos_a - y * f.sin_a, 0.6);
            }
            sum *= f.dx * f.dy / (POINTS * POINTS);
            worst = worst_of(worst, fabs(step_in_cell(0.6, &f).volume - sum));
        }
    print_message("jump: volume in a cell %.1e off midpoints\n", worst);
    assert_below(worst, 1e-3);
    assert_true(step_in_cell(1, &(tip_cell_front){-1, 1, 0, 1, 1}).volume == 0);
}

/* ---- Fronts just inside a barrier -------------------------------------------------------------
 */

/* Section 5.2.1 with phi = 1 at 75, 100, 150 and 200 s. */
enum { BARRIER_TIMES = 4 };
static const double barrier_time[BARRIER_TIMES] = {75, 100, 150, 200};
typedef struct barrier_run {
    double up[BARRIER_TIMES], along[BARRIER_TIMES];
} barrier_run;

static barrier_run grow(const host_scene *scene) {
    ilsa_solver *solver = host_started(scene, 5);
    barrier_run out;
    for (int k = 0; k < BARRIER_TIMES; k++) {
        assert_int_equal(ilsa_advance(solver, barrier_time[k], NULL), ILSA_OK);
        ilsa_summary now = host_summary(solver);
        out.up[k] = now.y_max;
        out.along[k] = now.x_max;
    }
    ilsa_solver_destroy(&solver);
    return out;
}

static host_scene barrier_scene(int across, int up) {
    host_scene scene = host_three_layers(4 * across + 1, 3 * up + 1 - up % 2);
    scene.mesh.dx = 20.0 / across;
    scene.mesh.dy = 20.0 / up;
    scene.material.C_prime = 5.21e-5;
    return scene;
}

static void compare(const barrier_run *a, const barrier_run *fine, const char *name, double up,
                    double along) {
    for (int k = 0; k < BARRIER_TIMES; k++) {
        double off_up = a->up[k] / fine->up[k] - 1, off_along = a->along[k] / fine->along[k] - 1;
        print_message("%s at %g s: up %.2f m, %+.2f %%, along %.2f m, %+.2f %%\n", name,
                      barrier_time[k], a->up[k], 100 * off_up, a->along[k], 100 * off_along);
        assert_true(fabs(off_up) < up);
        assert_true(fabs(off_along) < along);
    }
}

/* The barrier begins at 10 m: the front is less than three cells of H/21 inside it all the time. */
static void coarse_fronts_stand_where_fine_ones_do(void **unused) {
    (void)unused;
    host_scene finest = barrier_scene(63, 63), fine = barrier_scene(21, 21);
    host_scene coarse = barrier_scene(11, 11), oblong = barrier_scene(11, 21);
    barrier_run limit = grow(&finest), a = grow(&fine), b = grow(&coarse), c = grow(&oblong);
    compare(&a, &limit, "H/21", 0.012, 0.006);
    compare(&b, &limit, "H/11", 0.018, 0.008);
    compare(&c, &limit, "H/11 by H/21", 0.018, 0.008);
}

/* Barriers to the left and right as stress per cell, and the same above and below. */
static void barriers_have_no_axis(void **unused) {
    (void)unused;
    enum { N = 41 };
    static double beside[N * N], above[N * N];
    host_scene scene = barrier_scene(11, 11);
    scene.mesh.nx = scene.mesh.ny = N;
    for (int k = 0; k < N * N; k++) {
        beside[k] = abs(k % N - N / 2) > 5 ? 7.75e6 : 7e6;
        above[k] = abs(k / N - N / 2) > 5 ? 7.75e6 : 7e6;
    }
    barrier_run layers = grow(&scene);
    scene.cells = above;
    barrier_run a = grow(&scene);
    scene.cells = beside;
    barrier_run b = grow(&scene);
    for (int k = 0; k < BARRIER_TIMES; k++) {
        assert_true(fabs(a.up[k] / layers.up[k] - 1) < 1e-8);
        assert_true(fabs(a.along[k] / layers.along[k] - 1) < 1e-8);
        assert_true(fabs(a.up[k] / b.along[k] - 1) < 1e-8);
        assert_true(fabs(a.along[k] / b.up[k] - 1) < 1e-8);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(width_carries_the_jump),
        cmocka_unit_test(front_feels_no_jump),
        cmocka_unit_test(moment_is_the_integral),
        cmocka_unit_test(volume_grows_with_the_depth_of_the_step),
        cmocka_unit_test(volume_in_a_cell),
        cmocka_unit_test(coarse_fronts_stand_where_fine_ones_do),
        cmocka_unit_test(barriers_have_no_axis),
    };
    return cmocka_run_group_tests_name("jump", tests, NULL, NULL);
}
