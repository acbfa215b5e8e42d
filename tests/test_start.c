/* The penny that a run begins with, as it lies on the mesh: against its own solution by points. */
#include "check.h"
#include "host.h"
#include "step/state.h"
#include "tip/penny.h"

#include <math.h>

enum { POINTS = 30 };

/* Mean and standard deviation over a cell of when the front passed, and what has leaked since. */
typedef struct passing {
    double deviation, leaked;
} passing;

static passing passing_of(const ilsa_solver *s, const penny_solution *p, int cell) {
    const double x0 = s->mesh.dx * (cell % s->mesh.nx - 0.5 * (s->mesh.nx - 1));
    const double y0 = s->mesh.dy * (cell / s->mesh.nx - 0.5 * (s->mesh.ny - 1));
    double sum = 0, squares = 0, leaked = 0;
    for (int k = 0; k < POINTS * POINTS; k++) {
        const double x = x0 + s->mesh.dx * ((k % POINTS + 0.5) / POINTS - 0.5);
        const double y = y0 + s->mesh.dy * ((k / POINTS + 0.5) / POINTS - 0.5);
        const double t = ilsai_penny_arrival(p, hypot(x, y) / p->R);
        sum += t;
        squares += t * t;
        leaked += 2 * s->material.C_prime * sqrt(p->t - t);
    }
    const double mean = sum / (POINTS * POINTS);
    return (passing){sqrt(squares / (POINTS * POINTS) - mean * mean), leaked / (POINTS * POINTS)};
}

/* A spread passed evenly before and after has the deviation of 1 / sqrt(3) of it. */
static void channel_cells_know_how_long_the_front_took(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1, 41, 0.1);
    scene.mesh.dy = 0.13;
    scene.options.symmetry = ILSA_SYMMETRY_NONE;
    ilsa_solver *solver = host_started(&scene, 1.5);
    penny_solution p;
    assert_int_equal(ilsai_penny_at_radius(&solver->material, 1, 1.5, &p), ILSA_OK);
    double spread = NOTHING_YET, leaked = NOTHING_YET;
    for (int cell = 0; cell < scene.mesh.nx * scene.mesh.ny; cell++) {
        if (host_kind(solver)[cell] < ILSA_CELL_SURVEY || solver->field.level[cell] < -0.7)
            continue; /* nearer to the source the front's velocity changes within a cell */
        const passing exact = passing_of(solver, &p, cell);
        spread = worst_of(spread, relative(solver->field.spread[cell] / sqrt(3), exact.deviation));
        leaked = worst_of(leaked, relative(solver->field.leaked[cell], exact.leaked));
    }
    print_message("start: spread of the passing %.2f %% off, leaked %.2f %%\n", 100 * spread,
                  100 * leaked);
    assert_below(spread, 0.01);
    assert_below(leaked, 0.03); /* a front crosses a cell in chords, not evenly */
    ilsa_solver_destroy(&solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channel_cells_know_how_long_the_front_took),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
