/*
 * Invariance: a scene mirrored, rotated by 90 degrees or with x and y exchanged is the same
 * fracture, turned; and a radial one keeps its eight octants.
 */
#include "check.h"
#include "shown.h"

#include <stdlib.h>

enum { CELLS = 11, STEPS = 8, STEPS_LONG = 25 };

static const shown_units same_units = {1, 1, 1};

static void step(ilsa_solver *solver, double end) {
    if (ilsa_advance_one(solver, end, NULL) != ILSA_OK)
        fail_msg("%s", ilsa_last_error(solver));
}

static void report(const char *name, const char *how, shown_difference d, double bound) {
    print_message("%s%s: width %.1g, pressure %.1g, front %.1g cells, time %.1g\n", name, how,
                  d.width, d.pressure, d.front, d.time);
    assert_below(shown_largest(d), bound);
}

/* ---- Turned scenes ----------------------------------------------------------------------------
 */

/* Worst difference at any step to the same scene turned; coarsened before one of the steps. */
static shown_difference turned_apart(const shown *s, int turn, int steps, int coarsened) {
    double *cells;
    shown_difference worst = SHOWN_NOTHING_YET;
    const shown t = shown_turned(s, turn, &cells);
    ilsa_solver *first = host_started(&s->scene, s->radius);
    ilsa_solver *second = host_started(&t.scene, s->radius);
    for (int k = 0; k < steps && host_summary(first).time < s->end; k++) {
        if (k == coarsened) {
            assert_int_equal(ilsa_coarsen(first), ILSA_OK);
            assert_int_equal(ilsa_coarsen(second), ILSA_OK);
        }
        step(first, s->end);
        step(second, s->end);
        worst = shown_worse(worst, shown_compare(first, second, same_units, turn));
    }
    ilsa_solver_destroy(&first);
    ilsa_solver_destroy(&second);
    free(cells);
    return worst;
}

/* A mirror, x and y exchanged, and both with the other mirror; in check-long every turn. */
static void check_turns(const shown *s, const char *how, int steps, int coarsened) {
    shown_difference worst = SHOWN_NOTHING_YET;
    for (int turn = 1; turn < SHOWN_TURNS; turn += host_long() ? 1 : 3)
        worst = shown_worse(worst, turned_apart(s, turn, steps, coarsened));
    report(s->name, how, worst, 1e-9);
}

/* Stress of a layer above, one below, and two hills, without any symmetry. */
static double *hills(const ilsa_mesh_def *m) {
    double *sigma = malloc((size_t)m->nx * (size_t)m->ny * sizeof *sigma);
    assert_non_null(sigma);
    for (int k = 0; k < m->nx * m->ny; k++) {
        const double x = (k % m->nx - 0.5 * (m->nx - 1)) * m->dx;
        const double y = (k / m->nx - 0.5 * (m->ny - 1)) * m->dy;
        sigma[k] = 7e6 +
                   (y > 7    ? 4e5
                    : y < -9 ? 2e5
                             : 0) +
                   3e5 * exp(-((x - 9) * (x - 9) + (y - 5) * (y - 5)) / 50) +
                   2e5 * exp(-((x + 6) * (x + 6) + (y - 12) * (y - 12)) / 40);
    }
    return sigma;
}

/* The rock of a layered scene among hills, the source beside the centre. */
static shown among_hills(int which, double dy, double **sigma) {
    shown s = shown_scene(which, CELLS);
    s.scene.mesh = (ilsa_mesh_def){57, 63, s.scene.mesh.dx, dy * s.scene.mesh.dx};
    s.scene.interfaces = 0;
    s.scene.cells = *sigma = hills(&s.scene.mesh);
    s.scene.source[0] = (ilsa_source_def){1.3, -0.7, 0.01};
    s.radius = 6;
    return s;
}

/* Options that choose other code. */
typedef struct way {
    const char *name;
    double dy;
    ilsa_solver_def options;
} way;

static void turned_scenes_are_the_same_turned(void **state) {
    (void)state;
    const way ways[] = {
        {", square cells", 1, {.level = 3}},
        {", flat cells", 0.6, {.level = 3}},
        {", dense", 1, {.linear = ILSA_LINEAR_DENSE}},
        {", BLAS", 0.8, {.product = ILSA_PRODUCT_BLAS}},
        {", nested", 1, {.loop = ILSA_LOOP_NESTED}},
        {", fast", 1, {.level = 1}},
        {", sharp", 1.3, {.tolerance = 1e-10}},
    };
    for (int n = 0; n < (int)(sizeof ways / sizeof *ways); n++) {
        double *sigma;
        shown s = among_hills(3 + n % 3, ways[n].dy, &sigma);
        s.scene.options = ways[n].options;
        s.scene.options.level = ways[n].options.level ? ways[n].options.level : 3;
        check_turns(&s, ways[n].name, host_long() ? STEPS_LONG : STEPS, -1);
        free(sigma);
    }
}

static void two_sources_may_be_turned(void **state) {
    (void)state;
    double *sigma;
    shown s = among_hills(7, 0.8, &sigma);
    s.scene.source_count = 2;
    s.scene.source[1] = (ilsa_source_def){-1.9, 0.4, 0.005};
    check_turns(&s, ", two sources", host_long() ? STEPS_LONG : STEPS, -1);
    free(sigma);
}

static void coarsening_may_be_turned(void **state) {
    (void)state;
    double *sigma;
    const shown s = among_hills(1, 1.2, &sigma);
    check_turns(&s, ", coarsened", 18, 12);
    free(sigma);
}

/* Through ilsa_stress_set_layers, top and bottom exchanged. */
static void layers_may_be_upside_down(void **state) {
    (void)state;
    for (int which = 3; which < SHOWN_LAYERED; which += host_long() ? 1 : 3) {
        const shown s = shown_scene(which, CELLS);
        shown t = s;
        shown_difference worst = SHOWN_NOTHING_YET;
        t.scene.sigma[0] = s.scene.sigma[2];
        t.scene.sigma[2] = s.scene.sigma[0];
        ilsa_solver *up = host_started(&s.scene, s.radius);
        ilsa_solver *down = host_started(&t.scene, s.radius);
        for (int k = 0; k < (host_long() ? 10000 : 25) && host_summary(up).time < s.end; k++) {
            step(up, s.end);
            step(down, s.end);
            worst = shown_worse(worst, shown_compare(up, down, same_units, 2));
        }
        report(s.name, ", upside down", worst, 1e-9);
        ilsa_solver_destroy(&up);
        ilsa_solver_destroy(&down);
    }
}

/* ---- Radial fractures -------------------------------------------------------------------------
 */

/* How far a fracture is from itself in any turn: the worst of its whole growth. */
static shown_difference octants_apart(const shown *s) {
    shown_difference worst = SHOWN_NOTHING_YET;
    ilsa_solver *solver = host_started(&s->scene, s->radius);
    while (host_summary(solver).time < s->end) {
        step(solver, s->end);
        for (int turn = 1; turn < SHOWN_TURNS; turn++)
            worst = shown_worse(worst, shown_compare(solver, solver, same_units, turn));
    }
    ilsa_solver_destroy(&solver);
    return worst;
}

/* The source in the centre of a cell and between cells; whole, and solved in a quarter. */
static void radial_fractures_keep_their_octants(void **state) {
    (void)state;
    static const char *how[] = {", a quarter", ", whole"};
    for (int which = SHOWN_LAYERED; which < SHOWN_SCENES; which += host_long() ? 1 : 3)
        for (int whole = 0; whole < 2; whole++) {
            shown_difference worst = SHOWN_NOTHING_YET;
            for (int even = 0; even < 2; even++) {
                shown s = shown_scene(which, CELLS);
                s.scene.mesh.nx += even;
                s.scene.mesh.ny += even;
                s.scene.options.symmetry = whole ? ILSA_SYMMETRY_NONE : ILSA_SYMMETRY_XY;
                worst = shown_worse(worst, octants_apart(&s));
            }
            report(shown_scene(which, CELLS).name, how[whole], worst, 1e-9);
        }
}

/* Solved to rounding: the unknowns are others, and so is what a tolerance leaves. */
static void a_quarter_is_the_whole(void **state) {
    (void)state;
    for (int which = host_long() ? 0 : 5; which < SHOWN_SCENES; which += host_long() ? 1 : 5) {
        shown s = shown_scene(which, CELLS);
        shown_difference worst = SHOWN_NOTHING_YET;
        s.scene.options.tolerance = 1e-11;
        ilsa_solver *part = host_started(&s.scene, s.radius);
        s.scene.options.symmetry = ILSA_SYMMETRY_NONE;
        ilsa_solver *whole = host_started(&s.scene, s.radius);
        for (int k = 0; k < (host_long() ? 150 : 45) && host_summary(part).time < s.end; k++) {
            step(part, s.end);
            step(whole, s.end);
            worst = shown_worse(worst, shown_compare(part, whole, same_units, 0));
        }
        report(s.name, ", part and whole", worst, 1e-9);
        ilsa_solver_destroy(&part);
        ilsa_solver_destroy(&whole);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turned_scenes_are_the_same_turned),
        cmocka_unit_test(two_sources_may_be_turned),
        cmocka_unit_test(coarsening_may_be_turned),
        cmocka_unit_test(layers_may_be_upside_down),
        cmocka_unit_test(radial_fractures_keep_their_octants),
        cmocka_unit_test(a_quarter_is_the_whole),
    };
    return cmocka_run_group_tests_name("invariance", tests, NULL, NULL);
}
