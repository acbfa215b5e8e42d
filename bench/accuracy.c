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

static int is_long;

static const char *mark(ilsa_status status) {
    return status == ILSA_OK ? "" : " (stopped)";
}

static double percent(double value, double reference) {
    return 100 * (value / reference - 1);
}

static double error_R(const radial_growth *g) {
    return percent(g->state.R, g->reference.R);
}

/* ---- Convergence -------------------------------------------------------------------------- */

static void convergence_row(const penny_case *c, double cells, double *before) {
    const radial_growth g = radial_grow(c, cells, 1, 0);
    const penny error = radial_error(&g.state, &g.reference);
    const double e = 100 * error.R;
    printf("| %s | %g | %+.2f%s | ", c->law.name, cells, e, mark(g.status));
    if (isnan(*before))
        printf("|");
    else
        printf("%.1f |", log2(fabs(*before / e)));
    printf(" %+.2f | %+.2f | %+.4f | %+.2f | %+.2f | %+.2f | %ld | %ld |\n",
           percent(g.front.axis, g.reference.R), percent(g.front.diagonal, g.reference.R),
           error.efficiency, 100 * error.width, 100 * error.width_half, 100 * error.pressure_half,
           g.total.steps, g.total.rejected);
    *before = e;
}

static void convergence(void) {
    printf("\n### Convergence\n\nErrors in %%, of the efficiency absolute; from half the radius, "
           "dt in proportion to dx (level 3).\n\n"
           "| case | cells per radius | R, mean | order | R on x axis | R on diagonal | "
           "efficiency | w centre | w rho 0.5 | p rho 0.5 | steps | refused |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < PENNY_CASES; k++) {
        double before = NAN;
        for (int cells = 5; cells <= (is_long ? 80 : 40); cells *= 2)
            convergence_row(&penny_cases[k], cells, &before);
        fflush(stdout);
    }
}

/* ---- Roundness ---------------------------------------------------------------------------- */

static void roundness(void) {
    printf("\n### Roundness\n\n(Largest - smallest radius) / mean, %%: worst of the steps over the "
           "last fifth of the radius, and at the end; cells per radius counted in dx.\n\n"
           "| case | 10 cells, dx/dy = 1 | 10 cells, 2 | 40 cells, 1 | 40 cells, 2 |\n"
           "|---|---|---|---|---|\n");
    for (int k = 0; k < PENNY_CASES; k++) {
        printf("| %s |", penny_cases[k].law.name);
        for (int i = 0; i < 4; i++) {
            const radial_growth g = radial_grow(&penny_cases[k], i < 2 ? 10 : 40, 1 + i % 2, 0);
            printf(" %.2f, %.2f%s |", 100 * g.roundness,
                   100 * (g.front.high - g.front.low) / g.front.mean, mark(g.status));
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
    for (int k = 0; k < PENNY_CASES; k++) {
        double e[4];
        printf("| %s |", penny_cases[k].law.name);
        for (int i = 0; i < 4; i++) {
            const radial_growth g = radial_grow(&penny_cases[k], 20, 1, size[i]);
            e[i] = error_R(&g);
            printf(" %+.2f%s (%ld steps) |", e[i], mark(g.status), g.total.steps);
        }
        printf(" %+.2f | %+.2f |\n", 2 * e[3] - e[2], e[0] - e[2]);
        fflush(stdout);
    }
}

/* ---- Start-up ----------------------------------------------------------------------------- */

static void startup_cell(int phi, int tau, double *worst) {
    const penny end = radial_row(phi, tau);
    const penny_case c = {radial_law(radial_phi(phi)), end.time};
    const radial_growth g = radial_grow(&c, 10, 1, 0);
    const double e = error_R(&g);
    printf(" %+.2f%s, %+.3f |", e, g.status ? "!" : "",
           g.state.efficiency - g.reference.efficiency);
    if (g.status == ILSA_OK && fabs(e) > fabs(*worst))
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
    long steps, refused, products;
    int missed; /* times not reached */
    double seconds;
} history;

static ilsa_tip_regime mean_regime(ilsa_solver *solver) {
    const ilsa_survey_point *p;
    size_t count;
    ilsa_tip_regime r = {0};
    if (ilsa_get_survey(solver, &p, &count) != ILSA_OK)
        return r;
    for (size_t i = 0; i < count; i++) {
        r.N_k += p[i].regime.N_k / (double)count;
        r.N_mt += p[i].regime.N_mt / (double)count;
        r.N_m += p[i].regime.N_m / (double)count;
    }
    return r;
}

static void record(history *h, int row, ilsa_solver *solver, const penny *reference) {
    const penny p = radial_state(solver), error = radial_error(&p, reference);
    h->error[0][row] = 100 * error.R;
    h->error[1][row] = error.efficiency;
    h->error[2][row] = 100 * error.width;
    h->error[3][row] = 100 * error.width_half;
    h->error[4][row] = 100 * error.pressure_half;
    h->regime[row] = mean_regime(solver);
}

static void add_work(history *h, const ilsa_solver *solver) {
    ilsa_summary s;
    if (solver && ilsa_get_summary(solver, &s) == ILSA_OK) {
        h->steps = s.total.steps;
        h->refused = s.total.rejected;
        h->products = s.total.elasticity_products;
        h->seconds = s.total.seconds;
    }
}

/*
 * From tau = 10^-5.5 on, so that the start is forgotten by 1e-5: the mesh holds `largest` cells and
 * coarsens itself.
 */
static void follow(history *h, int phi, double largest) {
    const penny_law law = radial_law(radial_phi(phi));
    ilsa_solver *solver = radial_start_at(law, radial_row(phi, FIRST_TAU - 2).time, largest);
    ilsa_status status = solver ? ILSA_OK : ILSA_ERR_STATE;
    *h = (history){0};
    for (int row = 0; row < ROWS; row++) {
        const penny reference = radial_row(phi, FIRST_TAU + row);
        status = status ? status : radial_advance(solver, reference.time, 200);
        if (status == ILSA_OK)
            record(h, row, solver, &reference);
        else
            for (int q = 0; q < QUANTITIES; q++)
                h->error[q][row] = NAN;
        h->missed += status != ILSA_OK;
    }
    add_work(h, solver);
    ilsa_solver_destroy(&solver);
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
    printf(" %ld | %ld | %.1f | %d | %.1f |\n", h->steps, h->refused,
           (double)h->products / (double)h->steps, h->missed, h->seconds);
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
