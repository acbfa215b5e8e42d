/*
 * A penny-shaped fracture grown by the planar solver from 4.5 to 10 cells per radius, against the
 * independent reference: history and vertices.
 */
#include "../src/radial.h"
#include "csv.h"

#include <ilsa/ilsa.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define PI 3.14159265358979323846

/* Radius at the start and at the end, in cells of the larger side. */
static const double cells_start = 4.5, cells_end = 10;

/* What a run is to give: E' = Q = 1. */
typedef struct penny {
    const char *name;
    double mu_prime, K_prime, C_prime, time;
    double R, efficiency;
} penny;

/* What it gave. */
typedef struct outcome {
    double R; /* mean over the front */
    double roundness, efficiency, balance;
    long steps, rejected;
} outcome;

static void require(ilsa_status status, const ilsa_solver *solver) {
    if (status != ILSA_OK)
        fail_msg("%s: %s", ilsa_status_text(status), ilsa_last_error(solver));
}

/* aspect = dx / dy; the mesh holds 13 of the larger cells each way. */
static ilsa_solver *make_solver(const penny *p, double aspect) {
    const ilsa_material_def scaled = {1, p->mu_prime, p->K_prime, p->C_prime};
    const ilsa_source_def well = {.rate = 1};
    ilsa_mesh_def grid = ilsa_mesh_def_default();
    ilsa_solver_def def = ilsa_solver_def_default();
    ilsa_mesh *mesh;
    ilsa_material *material;
    ilsa_solver *solver;
    grid.nx = 27;
    grid.ny = (int)(26 * aspect) + 1;
    grid.dx = p->R / cells_end;
    grid.dy = grid.dx / aspect;
    require(ilsa_mesh_create(&grid, &mesh), NULL);
    require(ilsa_material_create(&scaled, &material), NULL);
    def.mesh = mesh;
    def.material = material;
    def.sources = &well;
    def.source_count = 1;
    require(ilsa_solver_create(&def, &solver), NULL);
    ilsa_mesh_destroy(&mesh);
    ilsa_material_destroy(&material);
    return solver;
}

/* Mean radius, weighted by the angle that each piece of the front subtends, and the spread. */
static void measure_front(ilsa_solver *solver, outcome *o) {
    const ilsa_front_point *f;
    size_t count;
    double low = HUGE_VAL, high = 0, sum = 0, turn = 0;
    require(ilsa_get_front(solver, &f, &count), solver);
    for (size_t i = 0; i < count; i++) {
        const size_t j = i + 1 < count ? i + 1 : 0;
        const double r = hypot(f[i].x, f[i].y), next = hypot(f[j].x, f[j].y);
        const double angle = asin((f[i].x * f[j].y - f[i].y * f[j].x) / (r * next));
        assert_int_equal(f[i].loop, 0);
        low = fmin(low, r);
        high = fmax(high, r);
        sum += 0.5 * (r + next) * angle;
        turn += angle;
    }
    assert_true(fabs(turn - 2 * PI) < 1e-9);
    o->R = sum / turn;
    o->roundness = (high - low) / o->R;
}

static outcome grow(const penny *p, double aspect) {
    ilsa_solver *solver = make_solver(p, aspect);
    ilsa_report report;
    ilsa_summary now;
    outcome o;
    require(ilsa_start_radial(solver, cells_start / cells_end * p->R), solver);
    require(ilsa_advance(solver, p->time, &report), solver);
    require(ilsa_get_summary(solver, &now), solver);
    measure_front(solver, &o);
    assert_true(now.time == p->time);
    o.efficiency = now.efficiency;
    o.balance = (now.volume_fracture + now.volume_leaked) / now.volume_injected - 1;
    o.steps = report.steps;
    o.rejected = report.rejected;
    ilsa_solver_destroy(&solver);
    return o;
}

/* The worst of a group of runs. */
typedef struct worst {
    double R, efficiency, roundness, balance;
} worst;

static void compare(const penny *p, double aspect, worst *w) {
    const outcome o = grow(p, aspect);
    const double error = o.R / p->R - 1, lost = o.efficiency - p->efficiency;
    printf("%-22s dx/dy %g: R %+.2f %%, efficiency %.4f %+.4f, roundness %.2f %%, "
           "%ld steps, %ld refused\n",
           p->name, aspect, 100 * error, p->efficiency, lost, 100 * o.roundness, o.steps,
           o.rejected);
    w->R = fmax(w->R, fabs(error));
    w->efficiency = fmax(w->efficiency, fabs(lost));
    w->roundness = fmax(w->roundness, o.roundness);
    w->balance = fmax(w->balance, fabs(o.balance));
}

/*
 * Radius, efficiency and balance as asked for. The roundness is what is reached: on oblong cells
 * the front of the toughness vertices moves in bursts (docs/accuracy.md).
 */
static void assert_worst(const char *what, double aspect, const worst *w) {
    printf("worst of %s: R %.2f %%, efficiency %.4f, roundness %.2f %%, balance %.1e\n", what,
           100 * w->R, w->efficiency, 100 * w->roundness, w->balance);
    assert_true(w->R <= 0.02);
    assert_true(w->efficiency <= 0.02);
    assert_true(w->roundness <= (aspect == 1 ? 0.02 : 0.03));
    assert_true(w->balance <= 1e-9);
}

/* M and K: one row's factor of the scale that the paper gives, exact. */
static double vertex_factor(const char *name) {
    csv_table *t = csv_read("tests/data/radial_vertices.csv");
    size_t row = 0;
    while (strcmp(csv_text(t, row, "vertex"), name) != 0)
        row++;
    const double gamma = csv_get(t, row, "gamma");
    csv_free(t);
    return gamma;
}

/*
 * A vertex with leak-off is reached as slowly as the efficiency falls: what the fracture still
 * holds counts. So the reference is the penny-shaped solution there, which test_radial_start
 * compares with the independent one (R to 2e-4).
 */
static penny leaking(penny p) {
    const ilsa_material_def scaled = {1, p.mu_prime, p.K_prime, p.C_prime};
    radial_solution solution;
    require(ilsai_radial_at_time(&scaled, 1, p.time, &solution), NULL);
    p.R = solution.R;
    p.efficiency = solution.efficiency;
    return p;
}

static void run_vertices(double aspect) {
    /* mu' = 1e-4: tau = 1e10, R within 1e-4 of the vertex. */
    const penny cases[] = {
        {.name = "M", .mu_prime = 1, .time = 1, .R = vertex_factor("M"), .efficiency = 1},
        {.name = "K", 1e-4, 1, 0, .time = 1, .R = vertex_factor("K"), .efficiency = 1},
        leaking((penny){.name = "M-tilde", 1, 0, 1, .time = 100}),
        leaking((penny){.name = "K-tilde", 1e-4, 1, 1, .time = 100}),
    };
    worst w = {0};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        compare(&cases[k], aspect, &w);
    assert_worst("vertices", aspect, &w);
}

static size_t history_row(const csv_table *t, double phi, double tau) {
    size_t row = 0;
    while (csv_get(t, row, "phi") != phi || fabs(csv_get(t, row, "tau") / tau - 1) > 1e-9)
        row++;
    return row;
}

/* The scaling of (5.1): C' = phi^(1/4), time tau. */
static void run_history(double aspect) {
    csv_table *t = csv_read("tests/data/radial_history.csv");
    const double phi[] = {1e-4, 1}, tau[] = {0.1, 1, 10, 100, 1000};
    worst w = {0};
    for (int k = 0; k < 10; k++) {
        const size_t row = history_row(t, phi[k / 5], tau[k % 5]);
        char name[40];
        snprintf(name, sizeof name, "phi %g, tau %g", phi[k / 5], tau[k % 5]);
        const penny p = {.name = name,
                         .mu_prime = 1,
                         .K_prime = 1,
                         .C_prime = pow(phi[k / 5], 0.25),
                         .time = csv_get(t, row, "tau"),
                         .R = csv_get(t, row, "R"),
                         .efficiency = csv_get(t, row, "efficiency")};
        compare(&p, aspect, &w);
    }
    assert_worst("phi 1e-4 and 1", aspect, &w);
    csv_free(t);
}

static void vertices(void **state) {
    (void)state;
    run_vertices(1);
}

static void vertices_on_oblong_cells(void **state) {
    (void)state;
    run_vertices(2);
}

static void history(void **state) {
    (void)state;
    run_history(1);
}

static void history_on_oblong_cells(void **state) {
    (void)state;
    run_history(2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vertices),
        cmocka_unit_test(vertices_on_oblong_cells),
        cmocka_unit_test(history),
        cmocka_unit_test(history_on_oblong_cells),
    };
    return cmocka_run_group_tests_name("radial_run", tests, NULL, NULL);
}
