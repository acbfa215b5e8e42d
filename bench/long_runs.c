/*
 * Long runs: what a solver holds and loses over many steps, and how right it is at the end.
 *
 *     bench_long_runs [STEPS]      of the cycles; without: 100000
 *
 * Cycles of injection, shut-in, closure and restart, with the memory in use and the balance of
 * volume at every tenth; and pennies that grow from 3 cells to 1000 times their radius on a mesh
 * that coarsens. Exit status 1 if memory grew, a volume was lost, or a radius is off by over 1.5 %.
 */
#include "common_malloc.h"
#include "common_radial.h"
#include "common_worst.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { STEPS = 100000, PARTS = 10, MESH = 41, PAUSE = 1000 };
static const double STEP_LOST = 1e-9, RADIUS_OFF = 0.015;
/* Of the heap after a tenth of the steps; a footprint that has grown takes room. */
static const double HEAP_GROWN = 1.1;

static double imbalance(const ilsa_summary *s) {
    return fabs(s->volume_fracture + s->volume_leaked - s->volume_injected) / s->volume_injected;
}

static ilsa_summary summary(const ilsa_solver *solver) {
    ilsa_summary s;
    if (ilsa_get_summary(solver, &s)) {
        fprintf(stderr, "summary: %s\n", ilsa_last_error(NULL));
        exit(1);
    }
    return s;
}

/* ---- Cycles -----------------------------------------------------------------------------------
 */

typedef struct cycles {
    ilsa_solver *solver;
    double period;
    long done; /* half cycles */
    double worst;
} cycles;

/*
 * Half a cycle: injection for as long as the first penny took to grow, or none until all of it has
 * closed. So every cycle brings the same volume to an empty fracture, which hardly grows.
 */
static ilsa_status half_cycle(cycles *c) {
    int pumps = c->done++ % 2 == 0;
    double now = summary(c->solver).time, end = now + (pumps ? 1 : PAUSE) * c->period;
    ilsa_status status = ilsa_set_rate(c->solver, 0, pumps);
    while (!status && now < end) {
        status = ilsa_advance_one(c->solver, end, NULL);
        ilsa_summary s = summary(c->solver);
        now = s.time;
        c->worst = larger_of(c->worst, imbalance(&s));
    }
    return status == ILSA_CLOSED ? ilsa_wait(c->solver, now + c->period) : status;
}

static int run_cycles(long steps) {
    radial_def def = {
        .law = radial_law(0.01), .dx = 0.1, .aspect = 1, .mesh_cells = MESH / 2.0, .coarsen = 1};
    cycles c = {.solver = radial_start(&def, 0.5)};
    int failed = !c.solver;
    size_t held = 0;
    c.period = c.solver ? summary(c.solver).time : 0;
    printf("cycles of injection, shut-in and restart\n"
           "%8s %8s %8s %10s %8s %12s %12s\n",
           "steps", "cycles", "refused", "time", "radius", "heap, bytes", "imbalance");
    for (int part = 1; part <= PARTS && !failed; part++) {
        while (!failed && summary(c.solver).total.steps < steps / PARTS * part) {
            ilsa_status status = half_cycle(&c);
            failed = status != ILSA_OK;
            if (failed) {
                fprintf(stderr, "%s: %s\n", ilsa_status_text(status), ilsa_last_error(c.solver));
            }
        }
        ilsa_summary s = summary(c.solver);
        printf("%8ld %8ld %8ld %10.3g %8.3f %12zu %12.2g\n", s.total.steps, c.done / 2,
               s.total.rejected, s.time, s.x_max, heap.live, c.worst);
        fflush(stdout);
        held = part == 1 ? heap.live : held;
    }
    failed |= (double)heap.live > HEAP_GROWN * (double)held || !(c.worst <= STEP_LOST);
    ilsa_solver_destroy(&c.solver);
    return failed;
}

/* ---- Growth -----------------------------------------------------------------------------------
 */

static int run_growth(const char *name, double phi, double mu_prime, double K_prime) {
    penny_law law = {name, mu_prime, K_prime, sqrt(sqrt(phi))};
    radial_def def = {.law = law, .dx = 1, .aspect = 1, .mesh_cells = 40, .coarsen = 1};
    ilsa_solver *solver = radial_start(&def, 3);
    if (!solver) {
        return 1;
    }
    double end = radial_time_of(law, 3000);
    ilsa_status status = ilsa_advance(solver, end, NULL);
    ilsa_summary s = summary(solver);
    penny reference = radial_reference(law, end);
    double off = radial_measure(solver).mean / reference.R - 1;
    printf("%-14s %8ld %8ld %8ld %9.0f %9.3f %12.2g%s%s\n", name, s.total.steps, s.total.rejected,
           s.total.coarsened, reference.R / 3, 100 * off, imbalance(&s), status ? "  " : "",
           status ? ilsa_last_error(solver) : "");
    fflush(stdout);
    ilsa_solver_destroy(&solver);
    return status || !(fabs(off) < RADIUS_OFF) || imbalance(&s) > STEP_LOST;
}

int main(int argc, char **argv) {
    char *end = NULL;
    long steps = argc > 1 ? strtol(argv[1], &end, 10) : STEPS;
    if (argc > 2 || (end && *end) || steps < PARTS) {
        fprintf(stderr, "usage: bench_long_runs [STEPS], %d or more\n", PARTS);
        return 2;
    }
    int failed = run_cycles(steps);
    printf("\nfrom 3 cells to 1000 times the radius\n"
           "%-14s %8s %8s %8s %9s %9s %12s\n",
           "law", "steps", "refused", "coarsened", "growth", "off, %", "imbalance");
    failed |= run_growth("viscosity", 0, 1, 0);
    failed |= run_growth("toughness", 0, 1e-4, 1);
    failed |= run_growth("all three", 1e-12, 1, 1);
    failed |= run_growth("leak-off", 1e-10, 1, 1);
    return failed;
}
