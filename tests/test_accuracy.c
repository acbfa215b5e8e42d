/*
 * Right answers over the whole parameter space, on coarse meshes: penny-shaped fractures of all
 * regimes against the independent reference of tests/data, and, for phi and times that it does not
 * have, against the library's own penny-shaped solution (R to 2e-4). Leak-off where the front
 * changes its velocity against small steps. The whole sweeps with $ILSA_LONG; bench/accuracy.c
 * prints them.
 */
#include "../bench/common_layers.h"
#include "../bench/common_radial.h"
#include "check.h"
#include "host.h"
#include "step/solver.h"

#include <stdio.h>

/* The worst of several errors, absolute. */
static void keep(penny *worst, const penny *error) {
    worst->R = worst_of(worst->R, fabs(error->R));
    worst->efficiency = worst_of(worst->efficiency, fabs(error->efficiency));
    worst->width = worst_of(worst->width, fabs(error->width));
    worst->width_half = worst_of(worst->width_half, fabs(error->width_half));
    worst->pressure_half = worst_of(worst->pressure_half, fabs(error->pressure_half));
}

/* ---- Fig. 7 ------------------------------------------------------------------------------- */

/* A penny through four times a decade of tau, on 10 to 20 cells per radius as the mesh coarsens. */
static void follow(double phi, int first_decade, int last_decade) {
    enum { TIMES_MOST = 41 };
    const penny_law law = radial_law(phi);
    double R[TIMES_MOST];
    int count = 0;
    penny worst = {.R = NOTHING_YET,
                   .efficiency = NOTHING_YET,
                   .width = NOTHING_YET,
                   .width_half = NOTHING_YET,
                   .pressure_half = NOTHING_YET};
    ilsa_solver *solver = radial_start_at(law, pow(10, first_decade - 0.5), 20);
    assert_non_null(solver);
    for (int k = 4 * first_decade; k <= 4 * last_decade; k++) {
        assert_int_equal(radial_advance(solver, pow(10, 0.25 * k), 200), ILSA_OK);
        const penny now = radial_state(solver), reference = radial_reference(law, now.time);
        const penny error = radial_error(&now, &reference);
        R[count++] = fabs(error.R);
        keep(&worst, &error);
    }
    ilsa_solver_destroy(&solver);
    const double median = radial_median(R, count);
    print_message("phi %g, %d times: R %.2f %%, median %.2f %%, efficiency %.4f, width %.2f %%, "
                  "at rho = 0.5 %.2f %%, pressure %.2f %%\n",
                  phi, count, 100 * worst.R, 100 * median, worst.efficiency, 100 * worst.width,
                  100 * worst.width_half, 100 * worst.pressure_half);
    assert_below(worst.R, 0.005);
    assert_below(median, 0.0035);
    assert_below(worst.efficiency, 0.01);
    assert_below(worst.width, 0.01);
    assert_below(worst.width_half, 0.015);
    assert_below(worst.pressure_half, 0.015);
}

static void histories(void **unused) {
    (void)unused;
    const int step = host_long() ? 1 : 3; /* 0, 1e-2, 1e4 */
    for (int phi = 0; phi < RADIAL_PHIS; phi += step)
        follow(radial_phi(phi), -5, 5);
}

static void histories_beyond_the_table(void **unused) {
    (void)unused;
    const int whole = host_long();
    follow(3e-3, whole ? -5 : 1, whole ? 5 : 3);
    follow(30, whole ? -5 : -3, whole ? 5 : -1);
    follow(1e12, -5, whole ? 1 : -3);
}

/* ---- Meshes ------------------------------------------------------------------------------- */

static radial_growth grow(const penny_case *c, double cells, double aspect, double step_cells) {
    const radial_growth g = radial_grow(c, cells, aspect, step_cells);
    if (g.status != ILSA_OK)
        fail_msg("%s on %g cells ended with %s", c->law.name, cells, ilsa_status_text(g.status));
    const penny error = radial_error(&g.state, &g.reference);
    print_message("%s to %g on %g cells, dx/dy %g: R %+.2f %%, efficiency %+.4f, roundness %.2f "
                  "%%, %ld steps, %ld refused\n",
                  c->law.name, c->time, cells, aspect, 100 * error.R, error.efficiency,
                  100 * g.roundness, g.total.steps, g.total.rejected);
    assert_below(fabs(g.balance), 1e-9);
    return g;
}

static double error_R(const radial_growth *g) {
    return fabs(g->state.R / g->reference.R - 1);
}

/* Radius by cells per radius, and roundness where it is asked for. */
static void meshes(void **unused) {
    (void)unused;
    static const struct {
        double cells, R, roundness;
    } at[] = {{5, 0.025, INFINITY}, {10, 0.01, 0.01}, {40, 0.0025, 0.004}};
    for (int k = 0; k < PENNY_CASES; k++)
        for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
            const radial_growth g = grow(&penny_cases[k], at[i].cells, 1, 0);
            assert_below(error_R(&g), at[i].R);
            assert_below(fabs(g.state.efficiency - g.reference.efficiency), 0.01);
            if (isfinite(at[i].roundness))
                assert_below(g.roundness, at[i].roundness);
        }
}

static void oblong_cells(void **unused) {
    (void)unused;
    for (int k = 0; k < PENNY_CASES; k++) {
        const radial_growth g = grow(&penny_cases[k], 10, 2, 0);
        assert_below(error_R(&g), 0.01);
        assert_below(g.roundness, 0.01);
        if (k == PENNY_M_TILDE || host_long())
            assert_below(grow(&penny_cases[k], 40, 2, 0).roundness, 0.004);
    }
}

/* Steps of one cell against steps of a quarter. */
static void steps(void **unused) {
    (void)unused;
    for (int k = 0; k < PENNY_CASES; k++) {
        const radial_growth whole = grow(&penny_cases[k], 20, 1, 1);
        const radial_growth quarter = grow(&penny_cases[k], 20, 1, 0.25);
        assert_below(relative(whole.state.R, quarter.state.R), 0.005);
    }
}

/* ---- Start-up ----------------------------------------------------------------------------- */

static void start_at(double phi, double tau) {
    char name[40];
    snprintf(name, sizeof name, "phi %g", phi);
    penny_case c = {radial_law(phi), tau};
    c.law.name = name;
    const radial_growth g = grow(&c, 10, 1, 0);
    const double stored = relative(g.state.efficiency, g.reference.efficiency);
    print_message("    volume in the fracture %.2f %% off\n", 100 * stored);
    assert_below(error_R(&g), 0.01);
    assert_below(fabs(g.state.efficiency - g.reference.efficiency), 0.01);
    assert_below(stored, 0.01);
}

/* From 5 to 10 cells per radius: the corners of (tau, phi), and points between and beyond. */
static void start_up(void **unused) {
    (void)unused;
    static const double phi_tau[][2] = {
        {0, 1e-5}, {0, 1e5},   {1e4, 1e-5}, {1e4, 1e5},  {1e-4, 1e3},  {3e-3, 10},  {1, 0.1},
        {1, 1e3},  {30, 2e-3}, {30, 7e4},   {1e8, 0.02}, {1e12, 1e-3}, {1e12, 0.1}, {1e12, 10}};
    for (size_t k = 0; k < sizeof phi_tau / sizeof *phi_tau; k++)
        start_at(phi_tau[k][0], phi_tau[k][1]);
    for (int phi = 0; phi < RADIAL_PHIS && host_long(); phi++)
        for (int tau = 4; tau <= 44; tau += 4)
            start_at(radial_phi(phi), radial_row(phi, tau).time);
}

/* ---- Leak-off where the front changes its velocity ---------------------------------------- */

static ilsa_summary into_barrier(tip_cell_velocity velocity, int parts) {
    ilsa_solver *solver = layer_start(&layer_scenes[LAYER_SYMMETRIC_PHI1], 11);
    assert_non_null(solver);
    solver->numerics.velocity = velocity;
    assert_int_equal(layer_advance(solver, 150, parts), ILSA_OK);
    const ilsa_summary s = host_summary(solver);
    ilsa_solver_destroy(&solver);
    return s;
}

/*
 * Strong leak-off into a barrier: against an eighth of the steps, and what the history of the
 * velocity is worth.
 */
static void velocity_changes(void **unused) {
    (void)unused;
    const ilsa_summary small = into_barrier(TIP_CELL_HISTORY, 8);
    const ilsa_summary usual = into_barrier(TIP_CELL_HISTORY, 1);
    const ilsa_summary constant = into_barrier(TIP_CELL_CONSTANT, 1);
    const double off = usual.volume_leaked / small.volume_leaked - 1;
    const double far = constant.volume_leaked / small.volume_leaked - 1;
    print_message("leaked by 150 s: %+.2f %%, by a constant velocity %+.2f %%; efficiency %+.4f, "
                  "length %+.2f %%, height %+.2f %%\n",
                  100 * off, 100 * far, usual.efficiency - small.efficiency,
                  100 * (usual.x_max / small.x_max - 1), 100 * (usual.y_max / small.y_max - 1));
    assert_below(fabs(off), 0.005);
    assert_true(fabs(far) > 2 * fabs(off));
    assert_below(fabs(usual.efficiency - small.efficiency), 0.002);
    assert_below(relative(usual.x_max, small.x_max), 0.005);
    assert_below(relative(usual.y_max, small.y_max), 0.005);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(histories),
        cmocka_unit_test(histories_beyond_the_table),
        cmocka_unit_test(meshes),
        cmocka_unit_test(oblong_cells),
        cmocka_unit_test(steps),
        cmocka_unit_test(start_up),
        cmocka_unit_test(velocity_changes),
    };
    return cmocka_run_group_tests_name("accuracy", tests, NULL, NULL);
}
