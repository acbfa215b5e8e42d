/* Volume and leak-off of a cell that the front crosses: src/tip/tip_cell.c. */
#include "check.h"
#include "csv.h"
#include "tip/tip_cell.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* cos and sin exact at the ends, as the solver has them. */
static tip_cell_front make_front(double ell, double alpha, double dx, double dy) {
    const double right = 1.5707963267948966;
    return (tip_cell_front){ell, alpha == right ? 0.0 : cos(alpha),
                            alpha == right ? 1.0 : sin(alpha), dx, dy};
}

static tip_cell_front read_front(const csv_table *table, size_t i) {
    return make_front(csv_get(table, i, "ell"), csv_get(table, i, "alpha"), csv_get(table, i, "dx"),
                      csv_get(table, i, "dy"));
}

/* Mean of M0 over [far - h, far], M0(xi < 0) = 0, by the double exponential rule. */
static double quadrature_strip(const ilsa_material_def *law, double V, double K_I, double h,
                               double far) {
    const double step = 1.0 / 32.0, pi = 3.141592653589793;
    const double width = fmin(h, far);
    double sum = 0.0;
    if (far <= 0.0)
        return 0.0;
    for (int k = -144; k <= 144; k++) {
        const double q = exp(-pi * sinh(k * step));
        const double xi = (far - width) + width / (1.0 + q);
        const double weight = step * pi * cosh(k * step) * q / ((1.0 + q) * (1.0 + q));
        const double w =
            V > 0.0 ? ilsai_asymptote_width(law, V, xi) : K_I / law->E_prime * sqrt(xi);
        double M0, M1;
        if (!(weight > 0.0 && xi > 0.0))
            continue;
        ilsai_asymptote_moments(law, V, xi, w, &M0, &M1);
        sum += weight * M0;
    }
    return width < h ? sum * (width / h) : sum;
}

/* The volume as M0 integrated over the strips, independently of the library's rule. */
static double quadrature_volume(const ilsa_material_def *law, double V, double K_I,
                                const tip_cell_front *f) {
    const double a = f->dy * f->sin_a, b = f->dx * f->cos_a, h = fmin(a, b), H = fmax(a, b);
    return f->dx * f->dy / H *
           (quadrature_strip(law, V, K_I, h, f->ell) -
            quadrature_strip(law, V, K_I, h, f->ell - H));
}

static void test_volume_table(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/tip_cell_volume.csv");
    double exact = NOTHING_YET, closed = NOTHING_YET, moments = NOTHING_YET, formula = NOTHING_YET;
    for (size_t i = 0; i < csv_rows(table); i++) {
        const ilsa_material_def law = {csv_get(table, i, "E_p"), csv_get(table, i, "mu_p"),
                                       csv_get(table, i, "K_p"), csv_get(table, i, "C_p")};
        const tip_cell_front front = read_front(table, i);
        const double V = csv_get(table, i, "V"), K_I = csv_get(table, i, "KI_p_if_V0");
        const double volume = ilsai_tip_cell_volume(&law, V, K_I, &front);
        exact = worst_of(exact, relative(volume, csv_get(table, i, "Vol_quad_exact_tip")));
        closed = worst_of(closed, relative(volume, csv_get(table, i, "Vol_quad")));
        moments =
            worst_of(moments, relative(volume, csv_get(table, i, "Vol_eq418_with_far_corner")));
        formula = worst_of(formula, relative(volume, quadrature_volume(&law, V, K_I, &front)));
    }
    print_message("tip_cell_volume.csv, %zu rows: volume against the exact tip %.3g, against the "
                  "integral of the closed form %.3g, against (4.18) with the far corner %.3g, "
                  "against quadrature of the same formula %.2g\n",
                  csv_rows(table), exact, closed, moments, formula);
    csv_free(table);
    assert_below(exact, 0.003);
    assert_below(closed, 0.00142);
    assert_below(moments, 0.003);
    assert_below(formula, 1e-4);
}

/*
 * Central differences of the volume over itself. Across the corners, where the chord's slope jumps,
 * they are none of its derivative.
 */
static void volumes_grow_as_their_derivatives_say(void **state) {
    (void)state;
    static const ilsa_material_def laws[] = {
        {2, 1, 0, 0}, {2, 1, 3, 0}, {2, 1e-3, 3, 0}, {2, 1, 1, 5}};
    const double V = 0.7, step = 0.01;
    double by_ell = NOTHING_YET, by_V = NOTHING_YET;
    for (int n = 0; n < 4; n++)
        for (double alpha = 0.0; alpha < 1.6; alpha += 0.2)
            for (double ell = 0.05; ell < 2.5; ell += 0.15) {
                tip_cell_front at = make_front(ell, alpha, 1.5, 0.8);
                const tip_cell_nodes nodes = ilsai_tip_cell_nodes(&at);
                const tip_cell_growth now = ilsai_tip_cell_growth(&laws[n], V, 0, &nodes);
                const double faster = ilsai_tip_cell_volume(&laws[n], V * (1 + step), 0, &at);
                const double slower = ilsai_tip_cell_volume(&laws[n], V * (1 - step), 0, &at);
                at.ell = ell * (1 + step);
                const double more = ilsai_tip_cell_volume(&laws[n], V, 0, &at);
                at.ell = ell * (1 - step);
                const double less = ilsai_tip_cell_volume(&laws[n], V, 0, &at);
                const double unit = 2 * step * now.volume;
                by_V = worst_of(by_V, fabs((faster - slower) / unit - now.by_log_V / now.volume));
                if (fabs(ell - fmax(1.5 * at.cos_a, 0.8 * at.sin_a)) > 2 * step * ell)
                    by_ell = worst_of(by_ell,
                                      fabs((more - less) / unit - ell * now.by_ell / now.volume));
            }
    print_message("volume: d ln / d ln ell off by %.2g, d ln / d ln V by %.2g\n", by_ell, by_V);
    assert_below(by_ell, 0.01);
    assert_below(by_V, 0.03);
}

/* w = K_I s^(1/2) / E' has elementary integrals: the triangles of (4.15), far corner included. */
static double triangle(double ell) {
    return ell > 0.0 ? 4.0 / 15.0 * pow(ell, 2.5) : 0.0;
}

static void test_volume_at_rest(void **state) {
    (void)state;
    const ilsa_material_def law = {2.0, 1.0, 3.0, 1.0};
    const double K_I = 1.2, dx = 1.5, dy = 0.8;
    for (double alpha = 0.2; alpha < 1.5; alpha += 0.1) {
        const double c = cos(alpha), s = sin(alpha);
        for (double ell = 0.1; ell < 2.5; ell += 0.1) {
            const tip_cell_front front = {ell, c, s, dx, dy};
            const double sum = triangle(ell) - triangle(ell - dy * s) - triangle(ell - dx * c) +
                               triangle(ell - dx * c - dy * s);
            assert_below(
                relative(ilsai_tip_cell_volume(&law, 0.0, K_I, &front), K_I / 2.0 * sum / (s * c)),
                5e-5);
        }
    }
    const tip_cell_front flat = {1.1, 1.0, 0.0, dx, dy}, upright = {0.7, 0.0, 1.0, dx, dy};
    assert_below(relative(ilsai_tip_cell_volume(&law, 0.0, K_I, &flat),
                          dy * K_I / 2.0 * 2.0 / 3.0 * pow(1.1, 1.5)),
                 1e-14);
    assert_below(relative(ilsai_tip_cell_volume(&law, 0.0, K_I, &upright),
                          dx * K_I / 2.0 * 2.0 / 3.0 * pow(0.7, 1.5)),
                 1e-14);
}

/* Volume, area and leak-off of a front at constant velocity for one geometry. */
typedef struct cell_values {
    double volume, area, leakoff;
} cell_values;

static cell_values values_of(double ell, double cos_a, double sin_a, double dx, double dy) {
    const ilsa_material_def law = {1.0, 1.0, 1.0, 0.7};
    const tip_cell_front front = {ell, cos_a, sin_a, dx, dy};
    const double t[2] = {0.0, fmax(ell, 0.0)}, path[2] = {0.0, fmax(ell, 0.0)};
    return (cell_values){ilsai_tip_cell_volume(&law, 1.0, 0.0, &front), ilsai_tip_cell_area(&front),
                         ilsai_tip_cell_leakoff_path(1.0, &front, 2, t, path)};
}

static double difference(cell_values a, cell_values b) {
    return worst_of(relative(a.volume, b.volume),
                    worst_of(relative(a.area, b.area), relative(a.leakoff, b.leakoff)));
}

static void test_continuous_in_alpha(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    for (double ell = 0.05; ell < 4.0; ell += 0.05) {
        const cell_values flat = values_of(ell, 1.0, 0.0, 1.5, 0.8);
        const cell_values upright = values_of(ell, 0.0, 1.0, 1.5, 0.8);
        for (double alpha = 1e-15; alpha < 1e-8; alpha *= 10.0) {
            const double c = cos(alpha), s = sin(alpha);
            const double bound = 1e-9 + 40.0 * alpha; /* the geometry itself moves by dy alpha */
            assert_below(difference(values_of(ell, c, s, 1.5, 0.8), flat), bound);
            assert_below(difference(values_of(ell, s, c, 1.5, 0.8), upright), bound);
            if (alpha < 1e-13)
                worst = worst_of(worst, difference(values_of(ell, c, s, 1.5, 0.8), flat));
        }
    }
    print_message("step at alpha = 0: %.2g\n", worst);
}

static void test_continuous_in_ell(void **state) {
    (void)state;
    for (double alpha = 0.0; alpha < 1.58; alpha += 0.05) {
        const double c = cos(alpha), s = fabs(sin(alpha)), a = 0.8 * s, b = 1.5 * c;
        const double corner[3] = {a, b, a + b};
        for (int k = 0; k < 3; k++) {
            const double d = 1e-10;
            if (corner[k] < 1e-3)
                continue;
            assert_below(difference(values_of(corner[k] - d, c, s, 1.5, 0.8),
                                    values_of(corner[k] + d, c, s, 1.5, 0.8)),
                         1e-7 + 10.0 * d / corner[k]);
        }
    }
}

static void test_grows_with_ell(void **state) {
    (void)state;
    for (double alpha = 0.0; alpha < 1.58; alpha += 0.05) {
        const double c = cos(alpha), s = fabs(sin(alpha));
        cell_values last = values_of(-0.1, c, s, 1.5, 0.8);
        assert_true(last.volume == 0.0 && last.area == 0.0 && last.leakoff == 0.0);
        for (double ell = 0.01; ell < 5.0; ell *= 1.02) {
            const cell_values now = values_of(ell, c, s, 1.5, 0.8);
            assert_true(now.volume > last.volume && now.leakoff > last.leakoff);
            assert_true(now.area >= last.area && now.area <= 1.5 * 0.8 * (1.0 + 1e-15));
            last = now;
        }
        assert_below(relative(last.area, 1.5 * 0.8), 1e-15);
    }
}

/* The axes are equal, and a square cell is symmetric about its diagonal. */
static void test_symmetric(void **state) {
    (void)state;
    for (int i = 0; i < 2000; i++) {
        const double alpha = 1.57 * uniform(), c = cos(alpha), s = sin(alpha);
        const double dx = 0.2 + uniform(), dy = 0.2 + uniform(), ell = 3.0 * uniform();
        assert_below(difference(values_of(ell, c, s, dx, dy), values_of(ell, s, c, dy, dx)), 1e-13);
    }
}

static void test_area(void **state) {
    (void)state;
    for (int i = 0; i < 2000; i++) {
        const double alpha = 1.57 * uniform(), c = cos(alpha), s = sin(alpha);
        const double dx = 0.2 + uniform(), dy = 0.2 + uniform(), ell = 2.0 * uniform() + 0.01;
        const tip_cell_front front = {ell, c, s, dx, dy};
        const double a = fmax(ell - dy * s, 0.0), b = fmax(ell - dx * c, 0.0);
        const double far = fmax(ell - dx * c - dy * s, 0.0);
        const double area = 0.5 * (ell * ell - a * a - b * b + far * far) / (s * c);
        assert_below(fabs(ilsai_tip_cell_area(&front) - area), 1e-13 * (1.0 + ell * ell / (s * c)));
    }
    const tip_cell_front flat = {0.3, 1.0, 0.0, 1.5, 0.8};
    assert_below(relative(ilsai_tip_cell_area(&flat), 0.24), 1e-15);
}

/* The front's distance since t_A in the table's three histories. */
static double history_ell(const csv_table *table, size_t i, double t) {
    const double h1 = csv_get(table, i, "h1"), h2 = csv_get(table, i, "h2");
    const double h3 = csv_get(table, i, "h3"), h4 = csv_get(table, i, "h4");
    switch ((int)csv_get(table, i, "history")) {
    case 0:
        return h1 * t;
    case 1:
        return h1 * expm1(4.0 / 9.0 * log1p(t / h2));
    default:
        return t < h3 ? h1 * t : h1 * h3 + h2 * (t - h3) - (h1 - h2) * h4 * expm1((h3 - t) / h4);
    }
}

/*
 * Leak-off, positive, along count knots: one at the start, the others from the end of the constant
 * velocity of history 2 to the present, graded towards both.
 */
static double leakoff_knots(const csv_table *table, size_t i, double now, int count) {
    const tip_cell_front front = read_front(table, i);
    const double start = fmin(csv_get(table, i, "h3"), now);
    double *t = malloc(2 * (size_t)count * sizeof *t), *ell = t + count;
    assert_non_null(t);
    t[0] = ell[0] = 0.0;
    const int first = start > 0.0 ? 1 : 0;
    for (int k = first; k < count; k++) {
        const double part = (double)(k - first) / (count - 1 - first);
        t[k] = start + (now - start) * part * part * (3.0 - 2.0 * part);
        ell[k] = history_ell(table, i, t[k]);
    }
    const double leakoff =
        now > 0.0 ? ilsai_tip_cell_leakoff_path(csv_get(table, i, "C_p"), &front, count, t, ell)
                  : 0.0;
    free(t);
    return leakoff;
}

/* Leak-off along a recorded history of equal time steps. */
static double leakoff_recorded(const csv_table *table, size_t i, double now, int steps) {
    const tip_cell_front front = read_front(table, i);
    tip_cell_history history;
    ilsai_tip_cell_enter(&history, 0.0);
    for (int k = 1; k <= steps; k++)
        ilsai_tip_cell_record(&history, now * k / steps, history_ell(table, i, now * k / steps));
    return ilsai_tip_cell_leakoff(csv_get(table, i, "C_p"), &front, &history);
}

static void test_leakoff_constant_velocity(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/tip_cell_leakoff.csv");
    double worst = NOTHING_YET, worst_S = NOTHING_YET;
    int rows = 0;
    for (size_t i = 0; i < csv_rows(table); i++) {
        if (csv_get(table, i, "history") != 0.0)
            continue;
        const double t = csv_get(table, i, "t_minus_tA"), before = t - csv_get(table, i, "Dt");
        const double L = leakoff_recorded(table, i, t, 1);
        const double L_before = before > 0.0 ? leakoff_recorded(table, i, before, 1) : 0.0;
        const double cell = csv_get(table, i, "dx") * csv_get(table, i, "dy");
        worst = worst_of(worst, relative(L, -csv_get(table, i, "L_t")));
        worst =
            worst_of(worst, relative(leakoff_recorded(table, i, t, 40), -csv_get(table, i, "L_t")));
        worst = worst_of(worst, relative(L_before, -csv_get(table, i, "L_t_minus_Dt")));
        worst_S = worst_of(worst_S, relative((L_before - L) / cell, csv_get(table, i, "S")));
        rows++;
    }
    print_message("tip_cell_leakoff.csv, %d rows of constant velocity: L %.2g, S %.2g\n", rows,
                  worst, worst_S);
    csv_free(table);
    assert_true(rows > 20);
    assert_below(worst, 1e-10);
    assert_below(worst_S, 1e-10);
}

static void test_leakoff_fine_history(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/tip_cell_leakoff.csv");
    double worst = NOTHING_YET, worst_S = NOTHING_YET;
    for (size_t i = 0; i < csv_rows(table); i++) {
        const double t = csv_get(table, i, "t_minus_tA"), before = t - csv_get(table, i, "Dt");
        const double L = leakoff_knots(table, i, t, 10001);
        const double L_before = leakoff_knots(table, i, before, 10001);
        const double cell = csv_get(table, i, "dx") * csv_get(table, i, "dy");
        worst = worst_of(worst, relative(L, -csv_get(table, i, "L_t")));
        worst = worst_of(worst, relative(L_before, -csv_get(table, i, "L_t_minus_Dt")));
        worst_S = worst_of(worst_S, relative((L_before - L) / cell, csv_get(table, i, "S")));
    }
    print_message("tip_cell_leakoff.csv, %zu rows, 10001 graded knots: L %.2g, S %.2g\n",
                  csv_rows(table), worst, worst_S);
    csv_free(table);
    assert_below(worst, 1e-8);
    assert_below(worst_S, 1e-7); /* a difference of two L */
}

/* What a solver gets that recorded the front at so many equal steps since it entered the cell. */
static double worst_recorded(const csv_table *table, int steps) {
    double worst = NOTHING_YET;
    for (size_t i = 0; i < csv_rows(table); i++) {
        const double now = csv_get(table, i, "t_minus_tA");
        worst = worst_of(
            worst, relative(leakoff_recorded(table, i, now, steps), -csv_get(table, i, "L_t")));
    }
    return worst;
}

static void test_leakoff_recorded_history(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/tip_cell_leakoff.csv");
    const int steps[4] = {1, 3, TIP_CELL_KNOTS - 1, 200};
    const double bound[4] = {0.4, 0.1, 0.02, 0.02};
    for (int k = 0; k < 4; k++) {
        const double worst = worst_recorded(table, steps[k]);
        print_message("tip_cell_leakoff.csv, worst L of a path recorded in %d steps (at most 16 "
                      "knots): %.2g\n",
                      steps[k], worst);
        assert_below(worst, bound[k]);
    }
    csv_free(table);
}

static void test_leakoff_vanishes(void **state) {
    (void)state;
    const tip_cell_front front = {0.5, 0.8, 0.6, 1.0, 1.0};
    tip_cell_history history;
    ilsai_tip_cell_enter(&history, 3.0);
    assert_true(ilsai_tip_cell_leakoff(1.0, &front, &history) == 0.0);
    ilsai_tip_cell_record(&history, 4.0, 0.0);
    assert_true(ilsai_tip_cell_leakoff(1.0, &front, &history) == 0.0);
    ilsai_tip_cell_record(&history, 5.0, 0.5);
    assert_true(ilsai_tip_cell_leakoff(0.0, &front, &history) == 0.0);
    assert_true(ilsai_tip_cell_leakoff(1.0, &front, &history) > 0.0);
}

/* A cell that filled long ago leaks as Carter's law of its whole area. */
static void test_leakoff_of_full_cell(void **state) {
    (void)state;
    const tip_cell_front front = {3.0, 0.8, 0.6, 1.5, 0.8};
    const double t[3] = {0.0, 1e-6, 100.0}, ell[3] = {0.0, 3.0, 3.0};
    assert_below(
        relative(ilsai_tip_cell_leakoff_path(0.7, &front, 3, t, ell), 2.0 * 0.7 * 1.5 * 0.8 * 10.0),
        1e-8);
}

/* A knot on the path changes nothing; a front that waits leaks on. */
static void test_leakoff_path(void **state) {
    (void)state;
    const tip_cell_front front = {0.9, 0.8, 0.6, 1.0, 1.0};
    const double t[4] = {0.0, 1.0, 1.7, 3.0}, ell[4] = {0.0, 0.3, 0.51, 0.9};
    const double two_t[2] = {0.0, 3.0}, two_ell[2] = {0.0, 0.9};
    const double wait_t[4] = {0.0, 3.0, 4.0, 5.0}, wait_ell[4] = {0.0, 0.9, 0.9, 0.9};
    const double two = ilsai_tip_cell_leakoff_path(1.0, &front, 2, two_t, two_ell);
    assert_below(relative(ilsai_tip_cell_leakoff_path(1.0, &front, 4, t, ell), two), 1e-14);
    const double less = ilsai_tip_cell_leakoff_path(1.0, &front, 3, wait_t, wait_ell);
    const double more = ilsai_tip_cell_leakoff_path(1.0, &front, 4, wait_t, wait_ell);
    assert_true(more > less && less > two);
    assert_true(more < 2.0 * sqrt(5.0) * ilsai_tip_cell_area(&front));
}

/*
 * Of the ends of the path alone, by a front that is on another line than the one between them: what
 * leaks since the last knot but one does not depend on when the clock began.
 */
static void constant_velocity_begins_at_the_entry(void **state) {
    (void)state;
    const tip_cell_front front = {0.9, 0.8, 0.6, 1.5, 0.8};
    const double ell[4] = {0.0, 0.6, 0.8, 0.9}, age[4] = {0.0, 0.25, 1.0, 2.5};
    const double here[2] = {0.0, 0.9}, before[2] = {0.0, 0.9 * 0.4};
    const double exact = ilsai_tip_cell_leakoff_path(0.7, &front, 2, (double[]){0.0, 2.5}, here) -
                         ilsai_tip_cell_leakoff_path(0.7, &front, 2, (double[]){0.0, 1.0}, before);
    const double t_A[4] = {0.0, 0.5, 8.0, -3.0};
    for (int n = 0; n < 4; n++) {
        tip_cell_history history;
        ilsai_tip_cell_enter(&history, t_A[n]);
        for (int k = 1; k < 4; k++)
            ilsai_tip_cell_record(&history, t_A[n] + age[k], ell[k]);
        const double last = ilsai_tip_cell_leakoff_last(0.7, TIP_CELL_CONSTANT, &front, &history);
        assert_below(relative(last, exact), 1e-14);
    }
}

static void test_history_entry(void **state) {
    (void)state;
    tip_cell_history history;
    ilsai_tip_cell_enter(&history, 2.5);
    assert_int_equal(history.count, 1);
    assert_true(history.t[0] == 2.5 && history.ell[0] == 0.0);
    ilsai_tip_cell_record(&history, 3.0, 0.4);
    ilsai_tip_cell_record(&history, 4.0, 0.3); /* the front does not go back */
    assert_int_equal(history.count, 3);
    assert_true(history.t[2] == 4.0 && history.ell[2] == 0.4);
}

/* A full history keeps its ends and the corner of a path that turns sharply. */
static void test_history_thinning(void **state) {
    (void)state;
    tip_cell_history history;
    ilsai_tip_cell_enter(&history, 0.0);
    for (int k = 1; k <= 500; k++)
        ilsai_tip_cell_record(&history, k, k <= 100 ? 0.01 * k : 1.0 + 0.001 * (k - 100));
    assert_int_equal(history.count, TIP_CELL_KNOTS);
    assert_true(history.t[0] == 0.0 && history.ell[0] == 0.0);
    assert_true(history.t[TIP_CELL_KNOTS - 1] == 500.0);
    assert_below(fabs(history.ell[TIP_CELL_KNOTS - 1] - 1.4), 1e-14);
    int corner = 0;
    for (int k = 1; k < TIP_CELL_KNOTS; k++) {
        assert_true(history.t[k] > history.t[k - 1] && history.ell[k] >= history.ell[k - 1]);
        corner += history.t[k] == 100.0;
    }
    assert_int_equal(corner, 1);
}

/* The front enters a cell at speed 1 and slows down to a quarter of it: where it is. */
static double slowed(double t) {
    return 0.25 * t + 0.375 * (1 - exp(-2 * t));
}

/* What leaks until t = 2 in so many steps, each its share by the path as it is then. */
static double leaked_in_steps(tip_cell_velocity velocity, int steps) {
    tip_cell_front front = {0, 0.8, 0.6, 1, 1};
    tip_cell_history history;
    double sum = 0;
    ilsai_tip_cell_enter(&history, 0);
    for (int k = 1; k <= steps; k++) {
        front.ell = slowed(2.0 * k / steps);
        ilsai_tip_cell_record(&history, 2.0 * k / steps, front.ell);
        sum += ilsai_tip_cell_leakoff_last(1, velocity, &front, &history);
    }
    return sum;
}

/*
 * As into a barrier: with the history, steps eight times longer make little difference; the shares
 * of a constant velocity add up to another volume.
 */
static void test_steps_of_a_front_that_slows(void **state) {
    (void)state;
    const double fine = leaked_in_steps(TIP_CELL_HISTORY, 64);
    const double history = leaked_in_steps(TIP_CELL_HISTORY, 8) / fine - 1;
    const double constant = leaked_in_steps(TIP_CELL_CONSTANT, 8) / fine - 1;
    print_message("slowed to 1/4: history %+.1e, constant velocity %+.1e\n", history, constant);
    assert_below(fabs(history), 0.006);
    assert_true(fabs(constant) > 0.05);
}

/* ---- Full cells --------------------------------------------------------------------------- */

/* The front passes the cell at constant speed and goes on: the path against the mean of the root.
 */
static void full_cells_leak_their_mean(void **unused) {
    (void)unused;
    double worst = NOTHING_YET, jump = NOTHING_YET, centre = NOTHING_YET;
    for (double alpha = 0; alpha < 1.6; alpha += 0.19634954084936207) {
        const tip_cell_front f = {0, cos(alpha), fabs(sin(alpha)), 1, 0.6};
        const double full = f.dx * f.cos_a + f.dy * f.sin_a, V = 2;
        const double spread = ilsai_tip_cell_spread(&f, full / V);
        for (double since = 0; since < 30; since = 2 * since + 0.01) {
            const double t[2] = {0, full / V + since}, ell[2] = {0, V * t[1]};
            const double exact = ilsai_tip_cell_leakoff_path(1, &f, 2, t, ell) / (f.dx * f.dy);
            const double age = since + 0.5 * full / V;
            const double mean = ilsai_tip_cell_full_leakoff(1, age, spread);
            worst = worst_of(worst, fabs(mean / exact - 1));
            jump = since == 0 ? worst_of(jump, fabs(mean / exact - 1)) : jump;
            centre = worst_of(centre, fabs(2 * sqrt(age) / exact - 1));
        }
    }
    print_message("full cells: %.2e off, %.2e when they fill; by the centre's time %.2e\n", worst,
                  jump, centre);
    assert_below(worst, 2.5e-3);
    assert_true(centre > 0.05);
}

static void full_cells_without_spread(void **unused) {
    (void)unused;
    for (double age = 1e-9; age < 1e9; age *= 7) {
        assert_true(fabs(ilsai_tip_cell_full_leakoff(3, age, 0) / (6 * sqrt(age)) - 1) < 1e-15);
        assert_true(fabs(ilsai_tip_cell_full_leakoff(3, age, 1e-9 * age) / (6 * sqrt(age)) - 1) <
                    1e-15);
    }
    assert_true(ilsai_tip_cell_full_leakoff(3, 0, 0) == 0);
    for (double age = 0; age < 20; age += 0.3)
        for (double dt = 1e-3; dt < 100; dt *= 10) {
            double by_ends = ilsai_tip_cell_full_leakoff(3, age + dt, 2) -
                             ilsai_tip_cell_full_leakoff(3, age, 2);
            assert_true(fabs(ilsai_tip_cell_full_leakoff_step(3, age, dt, 2) / by_ends - 1) <
                        1e-10);
        }
    /* a front still within the cell leaves a part of it dry */
    assert_true(fabs(ilsai_tip_cell_full_leakoff(3, 0, 2) - 6 * sqrt(2.0) / 3) < 1e-14);
    assert_true(ilsai_tip_cell_full_leakoff(3, -2, 2) == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_volume_table),
        cmocka_unit_test(volumes_grow_as_their_derivatives_say),
        cmocka_unit_test(test_volume_at_rest),
        cmocka_unit_test(test_continuous_in_alpha),
        cmocka_unit_test(test_continuous_in_ell),
        cmocka_unit_test(test_grows_with_ell),
        cmocka_unit_test(test_symmetric),
        cmocka_unit_test(test_area),
        cmocka_unit_test(test_leakoff_constant_velocity),
        cmocka_unit_test(test_leakoff_fine_history),
        cmocka_unit_test(test_leakoff_recorded_history),
        cmocka_unit_test(test_leakoff_vanishes),
        cmocka_unit_test(test_leakoff_of_full_cell),
        cmocka_unit_test(test_leakoff_path),
        cmocka_unit_test(constant_velocity_begins_at_the_entry),
        cmocka_unit_test(test_history_entry),
        cmocka_unit_test(test_history_thinning),
        cmocka_unit_test(test_steps_of_a_front_that_slows),
        cmocka_unit_test(full_cells_leak_their_mean),
        cmocka_unit_test(full_cells_without_spread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
