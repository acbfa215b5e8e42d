/*
 * Radial accuracy against the reference of tests/data, as Markdown tables for docs/accuracy.md.
 *
 *     bench_accuracy [fig7] [convergence] [roundness] [steps] [startup] [long]
 *
 * Without a table's name: all of them. long: 80 cells in convergence, 40 cells in fig7.
 */
#include "common_radial.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CASES = 5 };

static int is_long;

/* The four vertices and the middle of the triangle, each at a time where it is that. */
typedef struct radial_case {
    penny_law law;
    double time;
} radial_case;

static const radial_case cases[CASES] = {
    {{"M", 1, 0, 0}, 1},
    {{"M-tilde", 1, 0, 1}, 100},
    {{"K", 1, 1, 0}, 1e5},
    {{"K-tilde", 1e-4, 1, 1}, 100},
    {{"phi 1e-4, tau 1", 1, 1, 0.1}, 1},
};

/* What a run came to. */
typedef struct outcome {
    ilsa_status status;
    penny reference, state;
    radial_front front;
    ilsa_report total;
} outcome;

static double percent(double value, double reference) {
    return 100 * (value / reference - 1);
}

/* From a radius to a time; reads the state where it stops. */
static outcome run(const radial_def *def, double R, double time) {
    outcome o = {.status = ILSA_ERR_STATE};
    ilsa_summary s;
    ilsa_solver *solver = radial_start(def, R);
    if (!solver)
        return o;
    o.status = radial_advance(solver, time, 1000);
    o.state = radial_state(solver);
    o.front = radial_measure(solver);
    o.reference = radial_reference(def->law, o.state.time);
    if (ilsa_get_summary(solver, &s) == ILSA_OK)
        o.total = s.total;
    ilsa_solver_destroy(&solver);
    return o;
}

/* A case, from half its radius on, with so many cells per radius at the end. */
static outcome run_case(const radial_case *c, double cells, double aspect, double step_cells) {
    const penny end = radial_reference(c->law, c->time);
    const radial_def def = {.law = c->law,
                            .dx = end.R / cells,
                            .aspect = aspect,
                            .mesh_cells = 1.1 * cells + 1,
                            .step_cells = step_cells};
    return run(&def, 0.5 * end.R, c->time);
}

static const char *mark(ilsa_status status) {
    return status == ILSA_OK ? "" : " (stopped)";
}

static double error_R(const outcome *o) {
    return percent(o->state.R, o->reference.R);
}

/* ---- Convergence -------------------------------------------------------------------------- */

static void convergence_row(const radial_case *c, double cells, double *before) {
    const outcome o = run_case(c, cells, 1, 0);
    const penny *a = &o.state, *b = &o.reference;
    const double e = error_R(&o);
    printf("| %s | %g | %+.2f%s | ", c->law.name, cells, e, mark(o.status));
    if (isnan(*before))
        printf("|");
    else
        printf("%.1f |", log2(fabs(*before / e)));
    printf(" %+.2f | %+.2f | %+.4f | %+.2f | %+.2f | %+.2f | %ld | %ld |\n",
           percent(o.front.axis, b->R), percent(o.front.diagonal, b->R),
           a->efficiency - b->efficiency, percent(a->width, b->width),
           percent(a->width_half, b->width_half), percent(a->pressure_half, b->pressure_half),
           o.total.steps, o.total.rejected);
    *before = e;
}

static void convergence(void) {
    printf("\n### Convergence\n\nErrors in %%, of the efficiency absolute; from half the radius, "
           "dt in proportion to dx (level 3).\n\n"
           "| case | cells per radius | R, mean | order | R on x axis | R on diagonal | "
           "efficiency | w centre | w rho 0.5 | p rho 0.5 | steps | refused |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < CASES; k++) {
        double before = NAN;
        for (double cells = 5; cells <= (is_long ? 80 : 40); cells *= 2)
            convergence_row(&cases[k], cells, &before);
        fflush(stdout);
    }
}

/* ---- Roundness ---------------------------------------------------------------------------- */

/* The worst over the last fifth of the growth; it comes and goes as the front passes the cells. */
static double worst_roundness(const radial_case *c, double cells, double aspect, outcome *end) {
    const penny last = radial_reference(c->law, c->time);
    const radial_def def = {
        .law = c->law, .dx = last.R / cells, .aspect = aspect, .mesh_cells = 1.1 * cells + 1};
    ilsa_solver *solver = radial_start(&def, 0.5 * last.R);
    double worst = 0, now = 0;
    *end = (outcome){.status = solver ? ILSA_OK : ILSA_ERR_STATE};
    for (int k = 0; k < 1000 && end->status == ILSA_OK && now < c->time; k++) {
        ilsa_report report;
        end->status = ilsa_advance_one(solver, c->time, &report);
        end->front = radial_measure(solver);
        now = report.time;
        if (end->front.mean > 0.8 * last.R)
            worst = fmax(worst, (end->front.high - end->front.low) / end->front.mean);
    }
    ilsa_solver_destroy(&solver);
    return worst;
}

static void roundness(void) {
    printf("\n### Roundness\n\n(Largest - smallest radius) / mean, %%: worst of the steps over the "
           "last fifth of the radius, and at the end; cells per radius counted in dx.\n\n"
           "| case | 10 cells, dx/dy = 1 | 10 cells, 2 | 40 cells, 1 | 40 cells, 2 |\n"
           "|---|---|---|---|---|\n");
    for (int k = 0; k < CASES; k++) {
        printf("| %s |", cases[k].law.name);
        for (int i = 0; i < 4; i++) {
            outcome o;
            const double worst = worst_roundness(&cases[k], i < 2 ? 10 : 40, 1 + i % 2, &o);
            printf(" %.2f, %.2f%s |", 100 * worst,
                   100 * (o.front.high - o.front.low) / o.front.mean, mark(o.status));
        }
        printf("\n");
        fflush(stdout);
    }
}

/* ---- Time step ---------------------------------------------------------------------------- */

static void steps(void) {
    const double size[] = {1, 0.5, 0.25, 0.125};
    printf(
        "\n### Time step\n\nError of the mean radius, %%, at 20 cells per radius, from 10 cells, "
        "by the front's advance in one step. The solver itself takes no step longer than a "
        "tenth of the time. dt -> 0: from the last two, first order.\n\n"
        "| case | 1 cell | 0.5 | 0.25 | 0.125 | dt -> 0 | 1 against 0.25 |\n"
        "|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < CASES; k++) {
        double e[4];
        printf("| %s |", cases[k].law.name);
        for (int i = 0; i < 4; i++) {
            const outcome o = run_case(&cases[k], 20, 1, size[i]);
            e[i] = error_R(&o);
            printf(" %+.2f%s (%ld steps) |", e[i], mark(o.status), o.total.steps);
        }
        printf(" %+.2f | %+.2f |\n", 2 * e[3] - e[2], e[0] - e[2]);
        fflush(stdout);
    }
}

/* ---- Start-up ----------------------------------------------------------------------------- */

static void startup_cell(int phi, int tau, double *worst) {
    const penny end = radial_row(phi, tau);
    const radial_case c = {radial_law(radial_phi(phi)), end.time};
    const outcome o = run_case(&c, 10, 1, 0);
    const double e = error_R(&o);
    printf(" %+.2f%s, %+.3f |", e, o.status ? "!" : "",
           o.state.efficiency - o.reference.efficiency);
    if (o.status == ILSA_OK && fabs(e) > fabs(*worst))
        *worst = e;
}

static void startup(void) {
    double worst = 0;
    printf("\n### Start-up\n\nA penny of 5 cells grown to 10 cells at the time tau: error of the "
           "mean radius, %%, and of the efficiency. !: stalled on the way, the error where it "
           "stopped.\n\n| tau |");
    for (int phi = 0; phi < RADIAL_PHIS; phi++)
        printf(" phi %g |", radial_phi(phi));
    printf("\n|---|---|---|---|---|---|---|---|\n");
    for (int tau = 4; tau <= 44; tau += 4) {
        printf("| %.0e |", radial_row(0, tau).time);
        for (int phi = 0; phi < RADIAL_PHIS; phi++)
            startup_cell(phi, tau, &worst);
        printf("\n");
        fflush(stdout);
    }
    printf("\nWorst of those that arrived: %+.2f %%.\n", worst);
}

/* ---- Figure 7 ----------------------------------------------------------------------------- */

enum { FIRST_TAU = 4, LAST_TAU = 44, ROWS = LAST_TAU - FIRST_TAU + 1, QUANTITIES = 5 };
static const char *const quantity[QUANTITIES] = {"R", "efficiency", "w centre", "w rho 0.5",
                                                 "p rho 0.5"};

/* A history: errors at the table's times; NaN where a run did not get there. */
typedef struct history {
    double error[QUANTITIES][ROWS]; /* %, of the efficiency absolute */
    ilsa_tip_regime regime[ROWS];   /* mean over the survey cells */
    long steps, refused, products, coarsened;
    int stalls;
    double first_stall; /* tau; infinite */
    double seconds;
} history;

static ilsa_tip_regime mean_regime(ilsa_solver *solver) {
    const ilsa_survey_point *p;
    size_t count;
    ilsa_tip_regime r = {0};
    if (ilsa_get_regime(solver, &p, &count) != ILSA_OK)
        return r;
    for (size_t i = 0; i < count; i++) {
        r.N_k += p[i].regime.N_k / (double)count;
        r.N_mt += p[i].regime.N_mt / (double)count;
        r.N_m += p[i].regime.N_m / (double)count;
    }
    return r;
}

static void record(history *h, int row, ilsa_solver *solver, const penny *reference) {
    const penny p = radial_state(solver);
    h->error[0][row] = percent(p.R, reference->R);
    h->error[1][row] = p.efficiency - reference->efficiency;
    h->error[2][row] = percent(p.width, reference->width);
    h->error[3][row] = percent(p.width_half, reference->width_half);
    h->error[4][row] = percent(p.pressure_half, reference->pressure_half);
    h->regime[row] = mean_regime(solver);
}

static void add_work(history *h, ilsa_solver **solver) {
    ilsa_summary s;
    if (*solver && ilsa_get_summary(*solver, &s) == ILSA_OK) {
        h->steps += s.total.steps;
        h->refused += s.total.rejected;
        h->products += s.total.elasticity_products;
        h->coarsened += s.total.coarsened;
        h->seconds += s.total.seconds;
    }
    ilsa_solver_destroy(solver);
}

/* A new start at a time of the table, cells per radius. */
static ilsa_solver *restart(int phi, int tau, double cells, double largest) {
    const penny at = radial_row(phi, tau);
    const radial_def def = {.law = radial_law(radial_phi(phi)),
                            .dx = at.R / cells,
                            .aspect = 1,
                            .mesh_cells = largest,
                            .coarsen = 1};
    return radial_start(&def, at.R);
}

/*
 * From tau = 10^-5.5 on, so that the start is forgotten by 1e-5: the mesh holds `largest` cells and
 * coarsens itself. After a stall a new penny is set at the next time of the table but one.
 */
static void follow(history *h, int phi, double largest) {
    ilsa_solver *solver = restart(phi, FIRST_TAU - 2, 0.5 * largest, largest);
    *h = (history){.first_stall = INFINITY};
    for (int row = 0; row < ROWS; row++) {
        const penny reference = radial_row(phi, FIRST_TAU + row);
        const ilsa_status status =
            solver ? radial_advance(solver, reference.time, 200) : ILSA_ERR_STATE;
        if (status == ILSA_OK) {
            record(h, row, solver, &reference);
            continue;
        }
        for (int q = 0; q < QUANTITIES; q++)
            h->error[q][row] = NAN;
        h->first_stall = fmin(h->first_stall, reference.time);
        h->stalls++;
        add_work(h, &solver);
        solver = restart(phi, FIRST_TAU + row, 0.5 * largest, largest);
    }
    add_work(h, &solver);
}

/* Row of the largest error; -1 if there is none. */
static int worst_row(const double *error) {
    int worst = -1;
    for (int row = 0; row < ROWS; row++)
        if (!isnan(error[row]) && (worst < 0 || fabs(error[row]) > fabs(error[worst])))
            worst = row;
    return worst;
}

static double median(const double *error) {
    double values[ROWS];
    int count = 0;
    for (int row = 0; row < ROWS; row++)
        if (!isnan(error[row]))
            values[count++] = fabs(error[row]);
    return radial_median(values, count);
}

static void print_worst(int phi, const history *h) {
    printf("| %g |", radial_phi(phi));
    for (int q = 0; q < QUANTITIES; q++) {
        const int row = worst_row(h->error[q]);
        if (row < 0)
            printf(" - |");
        else
            printf(q == 1 ? " %+.4f at %.1e; %.4f |" : " %+.2f at %.1e; %.2f |", h->error[q][row],
                   radial_row(phi, FIRST_TAU + row).time, median(h->error[q]));
    }
    const int row = worst_row(h->error[0]);
    if (row >= 0)
        printf(" %.2f, %.2f, %.2f |", h->regime[row].N_k, h->regime[row].N_mt, h->regime[row].N_m);
    printf(" %ld | %ld | %.1f | %d", h->steps, h->refused, (double)h->products / (double)h->steps,
           h->stalls);
    if (h->stalls)
        printf(" from %.0e on", h->first_stall);
    printf(" | %.1f |\n", h->seconds);
}

static void print_decades(const history h[RADIAL_PHIS], int q) {
    printf("\nError of %s%s by time; -: not reached.\n\n| tau |", quantity[q],
           q == 1 ? "" : ", %,");
    for (int phi = 0; phi < RADIAL_PHIS; phi++)
        printf(" phi %g |", radial_phi(phi));
    printf("\n|---|---|---|---|---|---|---|---|\n");
    for (int row = 0; row < ROWS; row += 4) {
        printf("| %.0e |", radial_row(0, FIRST_TAU + row).time);
        for (int phi = 0; phi < RADIAL_PHIS; phi++)
            if (isnan(h[phi].error[q][row]))
                printf(" - |");
            else
                printf(q == 1 ? " %+.4f |" : " %+.2f |", h[phi].error[q][row]);
        printf("\n");
    }
}

static void print_overall(const history h[RADIAL_PHIS]) {
    printf("\n| over all | worst | median |\n|---|---|---|\n");
    for (int q = 0; q < QUANTITIES; q++) {
        double all[RADIAL_PHIS * ROWS];
        int count = 0;
        for (int k = 0; k < RADIAL_PHIS * ROWS; k++) {
            const double e = h[k / ROWS].error[q][k % ROWS];
            if (!isnan(e))
                all[count++] = fabs(e);
        }
        const double middle = radial_median(all, count);
        printf(q == 1 ? "| %s | %.4f | %.4f |\n" : "| %s | %.2f | %.2f |\n", quantity[q],
               count ? all[count - 1] : NAN, middle);
    }
}

static void figure7_on(double largest) {
    static history h[RADIAL_PHIS];
    printf("\n### Figure 7: %g to %g cells per radius\n\ntau from 1e-5 to 1e5 at %d times; "
           "errors in %%, of the efficiency absolute: worst at tau; median of the absolute "
           "values. Regime: mean N_k, N_mt, N_m of the survey cells where R is worst.\n\n"
           "| phi | R | efficiency | w centre | w rho 0.5 | p rho 0.5 | regime | steps | refused | "
           "products a step | times not reached | s |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|\n",
           0.5 * largest, largest, ROWS);
    for (int phi = 0; phi < RADIAL_PHIS; phi++) {
        follow(&h[phi], phi, largest);
        print_worst(phi, &h[phi]);
        fflush(stdout);
    }
    print_overall(h);
    print_decades(h, 0);
    print_decades(h, 1);
}

static void figure7(void) {
    figure7_on(20);
    if (is_long)
        figure7_on(40);
}

/* ------------------------------------------------------------------------------------------- */

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        void (*print)(void);
    } tables[] = {{"convergence", convergence},
                  {"roundness", roundness},
                  {"steps", steps},
                  {"startup", startup},
                  {"fig7", figure7}};
    const int count = sizeof tables / sizeof *tables;
    int chosen[sizeof tables / sizeof *tables] = {0}, any = 0;
    for (int k = 1; k < argc; k++) {
        int known = strcmp(argv[k], "long") == 0;
        is_long |= known;
        for (int t = 0; t < count; t++)
            if (strcmp(argv[k], tables[t].name) == 0)
                known = any = chosen[t] = 1;
        if (!known) {
            fprintf(stderr, "%s: no table %s\n", argv[0], argv[k]);
            return 2;
        }
    }
    for (int t = 0; t < count; t++)
        if (chosen[t] || !any)
            tables[t].print();
    return 0;
}
