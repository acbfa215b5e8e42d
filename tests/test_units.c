/*
 * Units: a scene in any units of length, time and force is the same fracture. The scenes of
 * examples/scenes, and the ways of solving them, in units that are 1e-12 and 1e12 of the first.
 */
#include "check.h"
#include "shown.h"

/* Cells of 20 m / CELLS, which is half of what the scenes are shown on. */
enum { CELLS = 11, MOST_UNITS = 8, STEPS = 15, WHOLE = 100000 };

/* In each of length, time and force. */
static const shown_units each[] = {{1e-12, 1, 1}, {1e12, 1, 1},  {1, 1e-12, 1},
                                   {1, 1e12, 1},  {1, 1, 1e-12}, {1, 1, 1e12}};
enum { EACH = 6 };

/* In all of them at once. */
static const shown_units corners[MOST_UNITS] = {
    {1e-12, 1e-12, 1e-12}, {1e12, 1e-12, 1e-12}, {1e-12, 1e12, 1e-12}, {1e12, 1e12, 1e-12},
    {1e-12, 1e-12, 1e12},  {1e12, 1e-12, 1e12},  {1e-12, 1e12, 1e12},  {1e12, 1e12, 1e12}};

/* What happens to a solver, in the units u, before step k. */
typedef void event(ilsa_solver *solver, shown_units u, int k);

static void step(ilsa_solver *solver, double end) {
    if (ilsa_advance_one(solver, end, NULL) != ILSA_OK)
        fail_msg("%s", ilsa_last_error(solver));
}

/* Worst difference at any of so many steps, with the steps that the solvers choose. */
static shown_difference worst_in(const shown *s, const shown_units *units, int count, int steps,
                                 event *happens) {
    const shown_units one = {1, 1, 1};
    shown_difference worst = SHOWN_NOTHING_YET;
    ilsa_solver *first = host_started(&s->scene, s->radius), *other[MOST_UNITS];
    shown in[MOST_UNITS];
    for (int n = 0; n < count; n++) {
        in[n] = shown_in_units(s, units[n]);
        other[n] = host_started(&in[n].scene, in[n].radius);
    }
    for (int k = 0; k < steps && host_summary(first).time < s->end; k++) {
        if (happens)
            happens(first, one, k);
        step(first, s->end);
        for (int n = 0; n < count; n++) {
            if (happens)
                happens(other[n], units[n], k);
            step(other[n], in[n].end);
            worst = shown_worse(worst, shown_compare(first, other[n], units[n], 0));
        }
    }
    ilsa_solver_destroy(&first);
    for (int n = 0; n < count; n++)
        ilsa_solver_destroy(&other[n]);
    return worst;
}

static void check(const shown *s, const char *how, const shown_units *units, int count, int steps,
                  event *happens) {
    const shown_difference d = worst_in(s, units, count, steps, happens);
    print_message("%s%s: width %.1g, pressure %.1g, front %.1g cells, time %.1g\n", s->name, how,
                  d.width, d.pressure, d.front, d.time);
    assert_below(shown_largest(d), 1e-9);
}

/* Every third scene for a few steps; in check-long every one to its end. */
static void scenes_have_no_units(void **state) {
    (void)state;
    for (int which = 0; which < SHOWN_SCENES; which += host_long() ? 1 : 3) {
        const shown s = shown_scene(which, CELLS);
        check(&s, "", each, EACH, host_long() ? WHOLE : STEPS, NULL);
    }
}

/* Parameters beyond 1e30 among them, which the tip functions take by logarithms. */
static void units_may_all_change_at_once(void **state) {
    (void)state;
    const shown s = shown_scene(1, CELLS);
    check(&s, ", all units", corners, MOST_UNITS, host_long() ? WHOLE : STEPS, NULL);
}

/* Options that choose other code, for a scene. */
typedef struct way {
    const char *name;
    int scene;
    ilsa_solver_def options;
} way;

enum { LAYERS = 4, RADIAL_K = SHOWN_LAYERED + 2 };

static void ways_of_solving_have_no_units(void **state) {
    (void)state;
    const way ways[] = {
        {", dense", LAYERS, {.linear = ILSA_LINEAR_DENSE}},
        {", iterative", LAYERS, {.linear = ILSA_LINEAR_GMRES}},
        {", BLAS", LAYERS, {.product = ILSA_PRODUCT_BLAS}},
        {", unfolded", LAYERS, {.symmetry = ILSA_SYMMETRY_NONE}},
        {", nested", LAYERS, {.loop = ILSA_LOOP_NESTED}},
        {", LEFM", RADIAL_K, {.tip = ILSA_TIP_TOUGHNESS}},
        {", no leak-off at the tip", LAYERS, {.tip = ILSA_TIP_TOUGHNESS_VISCOSITY}},
        {", fast", LAYERS, {.level = 1}},
        {", accurate", LAYERS, {.level = 5}},
        {", sharp", LAYERS, {.tolerance = 1e-10}},
        {", short steps", LAYERS, {.step_cells = 0.05}},
        {", dt_max", LAYERS, {.dt_max = 0.3}},
    };
    for (size_t n = 0; n < sizeof ways / sizeof *ways; n++) {
        shown s = shown_scene(ways[n].scene, CELLS);
        s.scene.options = ways[n].options;
        s.scene.options.level = ways[n].options.level ? ways[n].options.level : 3;
        check(&s, ways[n].name, corners + n % 7, 2, host_long() ? 60 : 8, NULL);
    }
}

/* A source beside the centre and another one, and a stress of its own in every cell. */
static void scenes_of_the_hosts_have_no_units(void **state) {
    (void)state;
    shown s = shown_scene(7, CELLS);
    s.scene.mesh.dy *= 0.7;
    s.scene.source_count = 2;
    s.scene.source[0] = (ilsa_source_def){1.3, -0.4, 0.006};
    s.scene.source[1] = (ilsa_source_def){-1.1, 0.9, 0.004};
    check(&s, ", two sources", corners + 3, 3, host_long() ? 60 : STEPS, NULL);
}

/* Rates that change, and a mesh that is coarsened. */
static void change_rate(ilsa_solver *solver, shown_units u, int k) {
    const double factor = k < 4 ? 1 : k < 8 ? 0.5 : 2;
    const double rate = 0.01 * factor * u.length * u.length * u.length / u.time;
    assert_int_equal(ilsa_set_rate(solver, 0, rate), ILSA_OK);
    if (k == 10)
        assert_int_equal(ilsa_coarsen(solver), ILSA_OK);
}

static void changes_on_the_way_have_no_units(void **state) {
    (void)state;
    const shown s = shown_scene(0, 21);
    check(&s, ", rates and a coarsening", corners + 2, 4, 14, change_rate);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_have_no_units),
        cmocka_unit_test(units_may_all_change_at_once),
        cmocka_unit_test(ways_of_solving_have_no_units),
        cmocka_unit_test(scenes_of_the_hosts_have_no_units),
        cmocka_unit_test(changes_on_the_way_have_no_units),
    };
    return cmocka_run_group_tests_name("units", tests, NULL, NULL);
}
