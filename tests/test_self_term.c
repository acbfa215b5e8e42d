/*
 * Constant elements beside the front: the term against other ways to find it, and what it does for
 * penny-shaped fractures whose pressure and width are known.
 */
#include "check.h"
#include "elastic/dd_kernel.h"
#include "elastic/elasticity.h"
#include "elastic/self_term.h"
#include "tip/asymptote.h"
#include "tip/penny.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

static self_term_front seen(double s, double alpha, double exponent) {
    return (self_term_front){s, fabs(cos(alpha)), fabs(sin(alpha)), exponent};
}

/* ---- Means -------------------------------------------------------------------------------- */

/* Mean of s_+^lambda over the cell by midpoints. */
static double mean_by_points(double dx, double dy, const self_term_front *f) {
    enum { POINTS = 400 };
    double sum = 0;
    for (int k = 0; k < POINTS * POINTS; k++) {
        double x = ((k % POINTS + 0.5) / POINTS - 0.5) * dx;
        double y = ((k / POINTS + 0.5) / POINTS - 0.5) * dy;
        double s = f->s - x * f->cos_a - y * f->sin_a;
        sum += s > 0 ? pow(s, f->exponent) : 0;
    }
    return sum / (POINTS * POINTS) * pow(f->s, -f->exponent);
}

static void means_of_powers(void **unused) {
    (void)unused;
    static const double alpha[] = {0, 1e-5, 0.02, 0.4, PI / 4, 1.2, PI / 2};
    double worst = NOTHING_YET;
    for (size_t a = 0; a < sizeof alpha / sizeof *alpha; a++)
        for (double s = 0.3; s < 3; s *= 1.7) {
            self_term_front f = seen(s, alpha[a], 0.6);
            worst = worst_of(worst,
                             fabs(ilsai_self_term_mean(1, 0.5, &f) - mean_by_points(1, 0.5, &f)));
        }
    print_message("means: %.1e off midpoints\n", worst);
    assert_below(worst, 2e-5);
}

/* ---- The term ----------------------------------------------------------------------------- */

static void table_gives_the_sum(void **unused) {
    (void)unused;
    static const double side[][2] = {{1, 1}, {1, 0.5}, {0.3, 0.9}, {2, 0.2}};
    for (size_t k = 0; k < sizeof side / sizeof *side; k++) {
        double dx = side[k][0], dy = side[k][1], worst = NOTHING_YET, slope = NOTHING_YET,
               far = NOTHING_YET;
        self_term_table table;
        ilsai_self_term_table(&table, dx, dy);
        srand(7);
        for (int n = 0; n < 400; n++) {
            self_term_front f =
                seen(1, PI / 2 * rand() / RAND_MAX, 0.5 + rand() / (6.0 * RAND_MAX));
            double full = dx * f.cos_a + dy * f.sin_a;
            f.s = full * (0.5 + 1.5 * rand() / RAND_MAX);
            self_term term = ilsai_self_term_lookup(&table, &f);
            worst = worst_of(worst, fabs(term.value - ilsai_self_term_exact(dx, dy, &f)));
            self_term_front next = f;
            next.s += 1e-6 * full;
            double difference = (ilsai_self_term_lookup(&table, &next).value - term.value) / 1e-6;
            slope = worst_of(slope, fabs(difference - term.slope * full));
            far = f.s > 1.6 * full ? worst_of(far, fabs(term.value)) : far;
        }
        print_message("%g by %g: table %.1e off, slope %.1e off, %.1e beyond 1.6 cells\n", dx, dy,
                      worst, slope, far);
        assert_below(worst, 2e-3);
        assert_below(slope, 1e-3);
        assert_below(far, 4e-3);
    }
}

/* Swapping the axes, and cells of another size, change nothing. */
static void term_has_no_axes_or_units(void **unused) {
    (void)unused;
    for (double alpha = 0; alpha < 1.6; alpha += 0.19) {
        self_term_front f = seen(0.9, alpha, 0.58), turned = {0.9, f.sin_a, f.cos_a, 0.58},
                        large = f;
        large.s *= 1e7;
        double term = ilsai_self_term_exact(1, 0.7, &f);
        assert_true(fabs(ilsai_self_term_exact(0.7, 1, &turned) - term) < 1e-10);
        assert_true(fabs(ilsai_self_term_exact(1e7, 0.7e7, &large) - term) < 1e-10);
    }
}

/* ---- Penny-shaped fractures --------------------------------------------------------------- */

/* A circle on cells dx by dy around the origin: E' = 1, radius R. */
typedef struct circle {
    double dx, dy, R;
    const penny_solution *solution; /* NULL: uniform pressure 1 */
    double unit;                    /* R over the radius of the solution */
} circle;

static double width_at(const circle *c, double r) {
    double rho = r / c->R;
    return rho >= 1      ? 0
           : c->solution ? ilsai_penny_width(c->solution, rho)
                         : 8 / PI * c->R * sqrt((1 - rho) * (1 + rho));
}

static double pressure_at(const circle *c, double r) {
    return c->solution ? ilsai_penny_pressure(c->solution, r / c->R) / c->unit : 1;
}

typedef struct cell {
    int i, j;
    int full;
    double mean; /* exact */
} cell;

static cell make_cell(const circle *c, int i, int j) {
    enum { POINTS = 60 };
    cell made = {i, j, 0, 0};
    double x = (abs(i) + 0.5) * c->dx, y = (abs(j) + 0.5) * c->dy;
    made.full = hypot(x, y) < c->R;
    for (int k = 0; k < POINTS * POINTS; k++) {
        double u = i + (k % POINTS + 0.5) / POINTS - 0.5, v = j + (k / POINTS + 0.5) / POINTS - 0.5;
        made.mean += width_at(c, hypot(u * c->dx, v * c->dy)) / (POINTS * POINTS);
    }
    return made;
}

static int list_cells(const circle *c, cell *list) {
    int count = 0, nx = (int)(c->R / c->dx) + 1, ny = (int)(c->R / c->dy) + 1;
    for (int j = -ny; j <= ny; j++)
        for (int i = -nx; i <= nx; i++) {
            cell made = make_cell(c, i, j);
            if (made.mean > 0)
                list[count++] = made;
        }
    return count;
}

static double exponent_at(const circle *c, double s) {
    if (!c->solution)
        return 0.5;
    const penny_solution *p = c->solution;
    double at = s / c->R * p->R, w = ilsai_asymptote_width(&p->scaled, p->V, at);
    return ilsai_asymptote_exponent(&p->scaled, p->V, at, w);
}

/* Worst error of the full cells' widths beside the front, the tip cells given. */
static double worst_width(const circle *c, int use_term) {
    cell *list = malloc(6000 * sizeof *list);
    int count = list_cells(c, list), n = 0, at = 0;
    for (int k = 0; k < count; k++)
        n += list[k].full;
    assert_true(n > 0); /* which the analyzer does not know to end the test otherwise */
    /* NOLINTNEXTLINE(clang-analyzer-optin.portability.UnixAPI) */
    double *matrix = calloc((size_t)n * (size_t)n, sizeof *matrix),
           *w = calloc((size_t)n, sizeof *w);
    int *number = malloc((size_t)n * sizeof *number);
    assert_true(list && matrix && w && number);
    for (int k = 0; k < count; k++)
        if (list[k].full)
            number[at++] = k;
    for (int a = 0; a < n; a++) {
        const cell *p = &list[number[a]];
        double x = p->i * c->dx, y = p->j * c->dy, r = hypot(x, y), s = c->R - r;
        w[a] = pressure_at(c, r);
        for (int k = 0; k < count; k++)
            if (!list[k].full)
                w[a] -= ilsai_dd_kernel(p->i - list[k].i, p->j - list[k].j, c->dx, c->dy) *
                        list[k].mean;
        for (int b = 0; b < n; b++) {
            /* NOLINTNEXTLINE(clang-analyzer-core.uninitialized.ArraySubscript): n were filled */
            const cell *q = &list[number[b]];
            matrix[(size_t)a * (size_t)n + (size_t)b] =
                ilsai_dd_kernel(p->i - q->i, p->j - q->j, c->dx, c->dy);
        }
        self_term_front f = seen(s, atan2(y, x), exponent_at(c, s));
        if (use_term && s < 2.5 * fmax(c->dx, c->dy))
            matrix[(size_t)a * (size_t)n + (size_t)a] *=
                1 + ilsai_self_term_exact(c->dx, c->dy, &f);
    }
    assert_int_equal(LAPACKE_dposv(LAPACK_COL_MAJOR, 'U', n, 1, matrix, n, w, n), 0);
    double worst = NOTHING_YET;
    for (int a = 0; a < n; a++) {
        const cell *p = &list[number[a]];
        if (c->R - hypot(p->i * c->dx, p->j * c->dy) < 1.6 * fmax(c->dx, c->dy))
            worst = worst_of(worst, fabs(w[a] / p->mean - 1));
    }
    free(list);
    free(matrix);
    free(w);
    free(number);
    return worst;
}

static void pennies_have_their_widths(void **unused) {
    (void)unused;
    static const struct {
        double dx, dy, R, most;
    } at[] = {
        {1, 1, 10.3, 0.005}, {1, 1, 20.2, 0.004}, {1, 0.5, 10.3, 0.015}, {0.4, 1, 9.8, 0.015}};
    for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
        circle c = {at[k].dx, at[k].dy, at[k].R, NULL, 1};
        double with = worst_width(&c, 1), without = worst_width(&c, 0);
        print_message("uniform pressure, %g by %g, R = %g: widths %.2f %% off, %.2f %% without\n",
                      c.dx, c.dy, c.R, 100 * with, 100 * without);
        assert_below(with, at[k].most);
        assert_true(without > 5 * with);
    }
}

/* Viscosity-dominated: the pressure falls without bound towards the front. */
static void viscous_pennies_have_their_widths(void **unused) {
    (void)unused;
    ilsa_material_def viscous = {1, 1, 0, 0};
    penny_solution solution;
    assert_int_equal(ilsai_penny_at_time(&viscous, 1, 1, &solution), ILSA_OK);
    circle c = {1, 1, 15.3, &solution, 15.3 / solution.R};
    double with = worst_width(&c, 1), without = worst_width(&c, 0);
    print_message("viscosity, R = %g: widths %.2f %% off, %.2f %% without\n", c.R, 100 * with,
                  100 * without);
    assert_below(with, 0.01);
    assert_true(without > 4 * with);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means_of_powers),
        cmocka_unit_test(table_gives_the_sum),
        cmocka_unit_test(term_has_no_axes_or_units),
        cmocka_unit_test(pennies_have_their_widths),
        cmocka_unit_test(viscous_pennies_have_their_widths),
    };
    return cmocka_run_group_tests_name("edge", tests, NULL, NULL);
}
