/* The closed-form tip asymptote: src/tip/asymptote.c against tables, limits and itself. */
#include "check.h"
#include "csv.h"
#include "tip/asymptote.h"

#include <float.h>
#include <math.h>

#define BETA_M  3.1473451902649446
#define BETA_MT 2.5335594408265696

/* What a function that fails must leave in its outputs. */
#define UNTOUCHED (-7.25)

static double power_of_10(double low, double high) {
    return pow(10.0, low + (high - low) * uniform());
}

/* Every combination of processes turns up. */
static ilsa_material_def random_law(double decades) {
    ilsa_material_def law = {power_of_10(-decades, decades), power_of_10(-decades, decades),
                             power_of_10(-decades, decades), power_of_10(-decades, decades)};
    const double kind = uniform();
    if (kind < 0.1 || (kind >= 0.3 && kind < 0.4))
        law.K_prime = 0.0;
    if (kind >= 0.1 && kind < 0.2)
        law.C_prime = 0.0;
    if (kind >= 0.2 && kind < 0.3)
        law.K_prime = law.C_prime = 0.0;
    return law;
}

static void test_g_delta_table(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/gdelta.csv");
    double g = NOTHING_YET, delta = NOTHING_YET, p0 = NOTHING_YET, p1 = NOTHING_YET;
    for (size_t i = 0; i < csv_rows(table); i++) {
        const double K = csv_get(table, i, "Khat"), C = csv_get(table, i, "Chat");
        g = worst_of(g, relative(ilsa_tip_g_delta(K, C), csv_get(table, i, "g_delta")));
        delta = worst_of(delta, relative(ilsa_tip_delta_p(K, C, 0.0), csv_get(table, i, "Delta")));
        p0 = worst_of(p0,
                      relative(ilsa_tip_delta_p(K, C, 0.377), csv_get(table, i, "Delta_p0_0p377")));
        p1 = worst_of(p1,
                      relative(ilsa_tip_delta_p(K, C, 0.260), csv_get(table, i, "Delta_p1_0p260")));
    }
    print_message("gdelta.csv, %zu rows: worst relative error g_delta %.2g, Delta %.2g, "
                  "Delta_p0 %.2g, Delta_p1 %.2g\n",
                  csv_rows(table), g, delta, p0, p1);
    csv_free(table);
    assert_below(g, 1e-13);
    assert_below(delta, 1e-13);
    assert_below(p0, 1e-13);
    assert_below(p1, 1e-13);
}

/* Worst errors of width and moment ratios against their columns, and of the width against (3.2). */
typedef struct width_errors {
    double w, M0, M1, truth;
} width_errors;

static void compare_width(const csv_table *table, size_t i, const ilsa_material_def *law, double s,
                          double w_unit, const char *closed, const char *exact,
                          width_errors *worst) {
    double w, M0, M1;
    assert_int_equal(ilsa_tip_width(law, 1.0, s, &w), ILSA_OK);
    assert_int_equal(ilsa_tip_moments(law, 1.0, s, w, &M0, &M1), ILSA_OK);
    worst->w = worst_of(worst->w, relative(w / w_unit, csv_get(table, i, closed)));
    worst->truth = worst_of(worst->truth, relative(w / w_unit, csv_get(table, i, exact)));
    worst->M0 = worst_of(worst->M0, relative(M0 / (w * s), csv_get(table, i, "M0_over_ws_closed")));
    worst->M1 =
        worst_of(worst->M1, relative(M1 / (w * s * s), csv_get(table, i, "M1_over_ws2_closed")));
}

static void report_width(const char *name, size_t rows, width_errors worst) {
    print_message("%s, %zu rows: worst relative error of the closed form w %.2g, M0 %.2g, M1 %.2g; "
                  "w against (3.2) %.3g\n",
                  name, rows, worst.w, worst.M0, worst.M1, worst.truth);
    assert_below(worst.w, 1e-10);
    assert_below(worst.M0, 1e-10);
    assert_below(worst.M1, 1e-10);
    assert_below(worst.truth, 0.00143);
}

static void test_width_table(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/tip_w.csv");
    width_errors worst = {NOTHING_YET, NOTHING_YET, NOTHING_YET, NOTHING_YET};
    for (size_t i = 0; i < csv_rows(table); i++) {
        const double root = csv_get(table, i, "s_tilde");
        const ilsa_material_def law = {1.0, 1.0, 1.0, 0.5 * csv_get(table, i, "chi")};
        compare_width(table, i, &law, root * root, root, "w_tilde_gdelta", "w_tilde", &worst);
    }
    report_width("tip_w.csv", csv_rows(table), worst);
    csv_free(table);
}

static void test_width_table_without_toughness(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/tip_mmt.csv");
    width_errors worst = {NOTHING_YET, NOTHING_YET, NOTHING_YET, NOTHING_YET};
    for (size_t i = 0; i < csv_rows(table); i++) {
        const double root = csv_get(table, i, "xi");
        const ilsa_material_def law = {1.0, 1.0, 0.0, 0.5};
        compare_width(table, i, &law, root * root, root, "omega_gdelta", "omega", &worst);
    }
    report_width("tip_mmt.csv", csv_rows(table), worst);
    csv_free(table);
}

static double width_of(const ilsa_material_def *law, double V, double s) {
    double w = NAN;
    assert_int_equal(ilsa_tip_width(law, V, s, &w), ILSA_OK);
    return w;
}

/* (3.3), and the moment ratios of its three power laws. */
static void test_vertices(void **state) {
    (void)state;
    const ilsa_material_def k = {3.0, 1e-20, 5.0, 1e-20}, m = {3.0, 2.0, 0.0, 0.0};
    const ilsa_material_def mt = {3.0, 2.0, 0.0, 1e12};
    const double V = 0.7, s = 1.9;
    const ilsa_material_def *law[3] = {&k, &mt, &m};
    const double vertex[3] = {5.0 / 3.0 * sqrt(s),
                              BETA_MT * pow(4.0 * 4.0 * V * 1e24 / 9.0, 0.125) * pow(s, 0.625),
                              BETA_M * cbrt(2.0 * V / 3.0) * pow(s, 2.0 / 3.0)};
    const double power[3] = {0.5, 0.625, 2.0 / 3.0};
    for (int i = 0; i < 3; i++) {
        const double w = width_of(law[i], V, s);
        double M0, M1;
        assert_below(relative(w, vertex[i]), i == 1 ? 1e-9 : 1e-14);
        assert_int_equal(ilsa_tip_moments(law[i], V, s, w, &M0, &M1), ILSA_OK);
        assert_below(relative(M0, w * s / (1.0 + power[i])), 1e-7);
        assert_below(relative(M1, w * s * s / (2.0 + power[i])), 1e-7);
    }
}

/* The width exceeds every vertex (but for the closed form's own error) and is at least w_k. */
static void test_width_above_vertices(void **state) {
    (void)state;
    for (int i = 0; i < 20000; i++) {
        const ilsa_material_def law = random_law(6.0);
        const double V = power_of_10(-6.0, 6.0), s = power_of_10(-6.0, 6.0);
        const double w = width_of(&law, V, s);
        const double mt = 4.0 * law.mu_prime * law.mu_prime * V * law.C_prime * law.C_prime;
        assert_true(w >= law.K_prime * sqrt(s) / law.E_prime * (1.0 - 1e-15));
        assert_true(w >= 0.998 * BETA_M * cbrt(law.mu_prime * V / law.E_prime * s * s));
        assert_true(w >=
                    0.998 * BETA_MT * pow(mt / law.E_prime / law.E_prime, 0.125) * pow(s, 0.625));
    }
}

static void test_width_grows(void **state) {
    (void)state;
    for (int i = 0; i < 20000; i++) {
        const ilsa_material_def law = random_law(4.0);
        const double V = power_of_10(-6.0, 6.0), s = power_of_10(-6.0, 6.0);
        const double w = width_of(&law, V, s);
        assert_true(width_of(&law, V, 1.01 * s) > w);
        assert_true(width_of(&law, 1.01 * V, s) >= w);
        assert_true(law.K_prime > 0.0 || width_of(&law, 1.01 * V, s) > w);
    }
}

/* Every law, slow and fast; distances as a tip cell and as a survey cell have them. */
static void rows_are_widths_alone(void **state) {
    (void)state;
    static const double part[2][5] = {{1.0, 0.37, 0.045, 4e-4, 4e-5}, {1.0, 2.8, 0.0, 0.0, 0.0}};
    double near = NOTHING_YET, far = NOTHING_YET, by_V = NOTHING_YET, moment = NOTHING_YET;
    for (int n = 0; n < 4000; n++) {
        const ilsa_material_def law = random_law(4.0);
        const double V = power_of_10(-6.0, 6.0), first = power_of_10(-4.0, 4.0), small = 1e-5;
        const int count = n % 2 ? 2 : 5;
        double s[5];
        asymptote_point point[5];
        for (int k = 0; k < count; k++)
            s[k] = first * part[n % 2][k];
        ilsai_asymptote_row(&law, V, count, s, point);
        for (int k = 0; k < count; k++) {
            const double w = ilsai_asymptote_width(&law, V, s[k]);
            if (s[k] < 1e-3 * first) {
                far = worst_of(far, relative(point[k].w, w));
                continue;
            }
            double M0, M1;
            const double faster = ilsai_asymptote_width(&law, V * (1.0 + small), s[k]);
            const double slower = ilsai_asymptote_width(&law, V * (1.0 - small), s[k]);
            ilsai_asymptote_moments(&law, V, s[k], w, &M0, &M1);
            near = worst_of(near, relative(point[k].w, w));
            moment = worst_of(moment, relative(point[k].M0, M0));
            by_V = worst_of(by_V, fabs(point[k].by_V - log(faster / slower) / (2.0 * small)));
        }
    }
    print_message(
        "rows: width off by %.2g, M0 by %.2g, d ln w / d ln V by %.2g; by power law %.2g\n", near,
        moment, by_V, far);
    assert_below(near, 1e-10);
    assert_below(moment, 1e-10);
    assert_below(by_V, 1e-5);
    assert_below(far, 0.2);
}

static void test_width_at_rest(void **state) {
    (void)state;
    const ilsa_material_def law = {10.0, 1.0, 4.0, 2.0}, soft = {10.0, 1.0, 0.0, 2.0};
    double M0, M1;
    assert_below(fabs(width_of(&law, 0.0, 9.0) - 1.2), 1e-15);
    assert_below(relative(width_of(&law, 1e-300, 9.0), 1.2), 1e-15);
    assert_true(width_of(&soft, 0.0, 9.0) == 0.0);
    assert_int_equal(ilsa_tip_moments(&law, 0.0, 9.0, 1.2, &M0, &M1), ILSA_OK);
    assert_below(fabs(M0 - 2.0 / 3.0 * 1.2 * 9.0), 1e-14);
    assert_below(fabs(M1 - 2.0 / 5.0 * 1.2 * 81.0), 1e-13);
    assert_int_equal(ilsa_tip_moments(&soft, 0.0, 9.0, 0.0, &M0, &M1), ILSA_OK);
    assert_true(M0 == 0.0 && M1 == 0.0);
}

/* Integrals of the closed-form width over [0, s] by Simpson's rule in ln s. */
static void integrate_width(const ilsa_material_def *law, double V, double s, double *M0,
                            double *M1) {
    const int steps = 800;
    const double h = 40.0 / steps;
    *M0 = *M1 = 0.0;
    for (int k = 0; k <= steps; k++) {
        const double x = s * exp(-h * k), w = width_of(law, V, x);
        const double weight = h / 3.0 * (k == 0 || k == steps ? 1.0 : k % 2 ? 4.0 : 2.0);
        *M0 += weight * w * x;
        *M1 += weight * w * x * x;
    }
}

/* ERRATA: 0.141 % for M0 and 0.0525 % for M1, against integration of the closed form. */
static void test_moments_are_integrals(void **state) {
    (void)state;
    double worst0 = NOTHING_YET, worst1 = NOTHING_YET;
    for (int i = 0; i < 400; i++) {
        const ilsa_material_def law = random_law(4.0);
        const double V = power_of_10(-4.0, 4.0), s = power_of_10(-4.0, 4.0);
        double M0, M1, exact0, exact1;
        assert_int_equal(ilsa_tip_moments(&law, V, s, width_of(&law, V, s), &M0, &M1), ILSA_OK);
        integrate_width(&law, V, s, &exact0, &exact1);
        worst0 = worst_of(worst0, relative(M0, exact0));
        worst1 = worst_of(worst1, relative(M1, exact1));
    }
    print_message("moments (3.18) against integrals of the width: M0 %.3g, M1 %.3g\n", worst0,
                  worst1);
    assert_below(worst0, 0.00142);
    assert_below(worst1, 0.00053);
}

static void test_g_delta_range(void **state) {
    (void)state;
    for (int i = 0; i < 20000; i++) {
        const double K = uniform(), C = power_of_10(-6.0, 6.0);
        const double g = ilsa_tip_g_delta(K, C), delta = ilsa_tip_delta_p(K, C, 0.0);
        assert_true(g > 0.0 && g <= ilsa_tip_g_delta(0.0, 0.0));
        assert_true(ilsa_tip_g_delta(0.999 * K, C) > (K > 0.01 ? g : (1.0 - 1e-15) * g));
        assert_true(ilsa_tip_g_delta(K, 1.001 * C) < g);
        assert_true(delta >= 0.0 && delta <= 1.0 / 3.0 + 1e-15);
        assert_true(ilsa_tip_delta_p(K, C, 1.0) >= 0.0);
    }
    assert_true(ilsa_tip_g_delta(1.0, 2.0) == 0.0 && ilsa_tip_g_delta(DBL_MAX, 2.0) == 0.0);
    assert_true(ilsa_tip_delta_p(1.0, 2.0, 0.3) == 0.0 && ilsa_tip_delta_p(3.0, 0.0, 0.3) == 0.0);
    const double small[] = {0.0, 4e-324, DBL_MIN, 1e-200, 1e-30};
    for (size_t i = 0; i < sizeof small / sizeof *small; i++) {
        assert_below(relative(ilsa_tip_g_delta(small[i], small[i]), ilsa_tip_g_delta(0.0, 0.0)),
                     1e-15);
        assert_below(relative(ilsa_tip_delta_p(small[i], small[i], 0.5), 1.0 / 3.0), 1e-15);
    }
    assert_true(ilsa_tip_g_delta(0.5, DBL_MAX) >= 0.0 && ilsa_tip_g_delta(0.0, 1e300) > 0.0);
}

/* F(K, B) = integral of u^3 / (u + B) over [K, 1], by the double exponential rule. */
static long double quadrature_F(long double kappa, long double B) {
    const long double step = 1.0L / 32.0L, half_pi = 1.57079632679489661923L;
    long double sum = 0.0L;
    for (int k = -128; k <= 128; k++) {
        const long double q = expl(-2.0L * half_pi * sinhl((long double)k * step));
        const long double u = 1.0L - kappa / (1.0L + q); /* from K to 1 */
        const long double weight =
            2.0L * half_pi * coshl((long double)k * step) * q / ((1.0L + q) * (1.0L + q));
        sum += weight * u * u * u / (u + B);
    }
    return kappa * step * sum;
}

/* (3.9), (3.13) and (3.14) as printed, in extended precision. */
static long double quadrature_g_delta(long double kappa, long double C) {
    const long double pi = 3.14159265358979323846L, b0 = 0.99117998230567238915L * C;
    const long double d = (1.0L + b0) * quadrature_F(kappa, b0);
    const long double C1 = 4.0L * (1.0L - 2.0L * d) / (d * (1.0L - d)) * tanl(pi * d);
    const long double C2 =
        16.0L * (1.0L - 3.0L * d) / (3.0L * d * (2.0L - 3.0L * d)) * tanl(1.5L * pi * d);
    return quadrature_F(kappa, C * C2 / C1) / C1;
}

/* Between the points of the table, and where one rule of the library takes over from another. */
static void test_g_delta_quadrature(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    for (int i = 0; i < 6000; i++) {
        const double kappa = i % 3 == 0 ? power_of_10(-6.0, 0.0) : uniform();
        const double K = i % 3 == 1 ? 0.2 + 1e-3 * (uniform() - 0.5) : 1.0 - kappa;
        double C = power_of_10(-4.0, 4.0);
        if (i % 6 == 2) /* B = 0.3 */
            C = 0.3 + 0.02 * (uniform() - 0.5);
        if (i % 6 == 5) /* K + B = 2 kappa */
            C = fmax(2.0 - 3.0 * K, 0.0) * (1.0 + 0.02 * (uniform() - 0.5));
        if (1.0 - 3.0 * ilsa_tip_delta_p(K, C, 0.0) < 1e-4) /* C2 as printed is 0 / 0 */
            continue;
        const double exact = (double)quadrature_g_delta(1.0L - (long double)K, C);
        worst = worst_of(worst, relative(ilsa_tip_g_delta(K, C), exact));
    }
    print_message("g_delta against its quadrature, 6000 random points: %.2g\n", worst);
    assert_below(worst, 1e-13);
}

/* A survey cell whose K_hat at s0 is below 1 more often than not. */
static double random_survey_width(const ilsa_material_def *law, double s0) {
    if (law->K_prime == 0.0 || uniform() < 0.3)
        return power_of_10(-6.0, 6.0);
    return law->K_prime * sqrt(s0) / law->E_prime * (1.0 + power_of_10(-12.0, 1.0));
}

static void test_distance_inverts_width(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    int moved = 0;
    for (int i = 0; i < 100000; i++) {
        const ilsa_material_def law = random_law(6.0);
        const double s0 = power_of_10(-6.0, 6.0), dt = power_of_10(-6.0, 6.0);
        const double w = random_survey_width(&law, s0);
        double s, V;
        assert_int_equal(ilsa_tip_distance(&law, w, s0, dt, &s, &V), ILSA_OK);
        assert_true(s >= s0 && V >= 0.0);
        if (V == 0.0) {
            assert_true(s == s0 && law.K_prime * sqrt(s0) >= law.E_prime * w * (1.0 - 1e-15));
            continue;
        }
        moved++;
        assert_true(fabs((s - s0) - V * dt) <= 1e-15 * s);
        assert_true(law.K_prime * sqrt(s) <= law.E_prime * w * (1.0 + 1e-14));
        worst = worst_of(worst, relative(width_of(&law, V, s), w));
    }
    print_message("(4.9) put back into (3.15), %d random survey cells: %.2g\n", moved, worst);
    assert_true(moved > 50000);
    assert_below(worst, 1e-12);
}

/* Also the other way: V from a width that was made with it. */
static void test_distance_finds_velocity(void **state) {
    (void)state;
    const ilsa_material_def laws[] = {
        {1.0, 1.0, 1.0, 1.0}, {1.0, 1.0, 0.0, 1.0}, {1.0, 1.0, 1.0, 0.0}, {1.0, 1.0, 0.0, 0.0}};
    for (size_t i = 0; i < sizeof laws / sizeof *laws; i++) {
        for (double V = 1e-3; V < 2e3; V *= 10.0) {
            const double s = 2.5, dt = 0.5 / V;
            double s_found, V_found;
            assert_int_equal(ilsa_tip_distance(&laws[i], width_of(&laws[i], V, s), s - V * dt, dt,
                                               &s_found, &V_found),
                             ILSA_OK);
            assert_below(relative(V_found, V), 1e-12);
            assert_below(relative(s_found, s), 1e-13);
        }
    }
}

static void test_distance_arrested(void **state) {
    (void)state;
    const ilsa_material_def law = {10.0, 1.0, 4.0, 0.1};
    double s, V;
    assert_int_equal(ilsa_tip_distance(&law, 1.2 * (1.0 - 1e-12), 9.0, 2.0, &s, &V), ILSA_OK);
    assert_true(s == 9.0 && V == 0.0);
    assert_true(ilsai_asymptote_distance(&law, 1.1, 9.0, 2.0).ds_dw == 0.0);
    /* Continuous into arrest, and the front passes the point where K_hat = 1 never. */
    assert_int_equal(ilsa_tip_distance(&law, 1.2 * (1.0 + 1e-12), 9.0, 2.0, &s, &V), ILSA_OK);
    assert_true(V > 0.0 && s >= 9.0 && s < 9.0 * (1.0 + 3e-12));
}

static void test_distance_grows_with_width(void **state) {
    (void)state;
    for (int i = 0; i < 20000; i++) {
        const ilsa_material_def law = random_law(4.0);
        const double s0 = power_of_10(-3.0, 3.0), dt = power_of_10(-3.0, 3.0);
        const double w = random_survey_width(&law, s0);
        const asymptote_front a = ilsai_asymptote_distance(&law, w, s0, dt);
        const asymptote_front b = ilsai_asymptote_distance(&law, 1.001 * w, s0, dt);
        assert_true(b.V > a.V || (a.V == 0.0 && b.V == 0.0));
        assert_true(b.s >= a.s && a.ds_dw >= 0.0);
    }
}

/* Without viscosity the width is that of toughness at any velocity, with or without leak-off. */
static void test_toughness_alone(void **state) {
    (void)state;
    const ilsa_material_def laws[] = {{10.0, 0.0, 4.0, 0.0}, {10.0, 0.0, 4.0, 0.7}};
    for (size_t i = 0; i < sizeof laws / sizeof *laws; i++) {
        for (double V = 0.0; V < 1e300; V = 1e10 * V + 1e-200) {
            double M0, M1;
            ilsa_tip_regime r;
            assert_below(fabs(width_of(&laws[i], V, 9.0) - 1.2), 1e-15);
            assert_int_equal(ilsa_tip_moments(&laws[i], V, 9.0, 1.2, &M0, &M1), ILSA_OK);
            assert_below(relative(M0, 2.0 / 3.0 * 1.2 * 9.0), 1e-15);
            assert_below(relative(M1, 2.0 / 5.0 * 1.2 * 81.0), 1e-15);
            assert_int_equal(ilsa_tip_triangle(&laws[i], V, 9.0, 1.2, &r), ILSA_OK);
            assert_true(r.N_k == 1.0 && r.N_mt == 0.0 && r.N_m == 0.0);
        }
    }
}

/* (4.9) is then (E' w / K')^2, whatever the time, and not below s0. */
static void test_distance_of_toughness(void **state) {
    (void)state;
    const ilsa_material_def law = {10.0, 0.0, 4.0, 0.3};
    double s, V;
    for (double dt = 1e-6; dt < 1e7; dt *= 1e3) {
        assert_int_equal(ilsa_tip_distance(&law, 1.2, 4.0, dt, &s, &V), ILSA_OK);
        assert_below(relative(s, 9.0), 1e-15);
        assert_below(relative(V, 5.0 / dt), 1e-15);
        assert_below(relative(ilsai_asymptote_distance(&law, 1.2, 4.0, dt).ds_dw, 2.0 * 9.0 / 1.2),
                     1e-15);
        assert_int_equal(ilsa_tip_distance(&law, 1.2 * (1.0 - 1e-12), 9.0, dt, &s, &V), ILSA_OK);
        assert_true(s == 9.0 && V == 0.0);
        assert_true(ilsai_asymptote_distance(&law, 1.1, 9.0, dt).ds_dw == 0.0);
    }
    /* Numbers whose products overflow on the way. */
    const ilsa_material_def huge = {1e200, 0.0, 1e250, 0.0};
    assert_int_equal(ilsa_tip_distance(&huge, 1e150, 1.0, 1.0, &s, &V), ILSA_OK);
    assert_below(relative(s, 1e200), 1e-12);
    assert_below(relative(width_of(&huge, 1.0, s), 1e150), 1e-12);
    assert_int_equal(ilsa_tip_distance(&law, 1e200, 1.0, 1.0, &s, &V), ILSA_ERR_VALUE);
    assert_int_equal(ilsa_tip_distance(&law, 1.2, 4.0, 1e-310, &s, &V), ILSA_ERR_VALUE);
}

/* It is what little viscosity comes to. */
static void test_little_viscosity(void **state) {
    (void)state;
    for (int i = 0; i < 1000; i++) {
        ilsa_material_def law = {power_of_10(-2.0, 2.0), 0.0, power_of_10(-2.0, 2.0), 0.0},
                          thin = law;
        const double s = power_of_10(-2.0, 2.0), dt = power_of_10(-2.0, 2.0);
        const double w = width_of(&law, 1.0, s) * (1.0 + power_of_10(-3.0, 1.0));
        thin.mu_prime = 1e-25;
        const asymptote_front a = ilsai_asymptote_distance(&law, w, s, dt);
        const asymptote_front b = ilsai_asymptote_distance(&thin, w, s, dt);
        assert_below(relative(b.s, a.s), 1e-8);
        assert_below(relative(b.ds_dw, a.ds_dw), 1e-8);
        assert_below(relative(width_of(&thin, 1.0, s), width_of(&law, 1.0, s)), 1e-12);
    }
}

/* ds_dw against central differences of V dt = s - s0. */
static void test_distance_derivative(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    for (int i = 0; i < 20000; i++) {
        const ilsa_material_def law = random_law(3.0);
        const double s0 = power_of_10(-2.0, 2.0), dt = power_of_10(-2.0, 2.0);
        const double w = law.K_prime > 0.0
                             ? law.K_prime * sqrt(s0) / law.E_prime * (1.0 + power_of_10(-4.0, 1.0))
                             : power_of_10(-3.0, 3.0);
        const double h = 1e-4 * (w - law.K_prime * sqrt(s0) / law.E_prime);
        const asymptote_front a = ilsai_asymptote_distance(&law, w - h, s0, dt);
        const asymptote_front b = ilsai_asymptote_distance(&law, w + h, s0, dt);
        const asymptote_front f = ilsai_asymptote_distance(&law, w, s0, dt);
        worst = worst_of(worst, relative(f.ds_dw, (b.V - a.V) * dt / (2.0 * h)));
    }
    print_message("ds_dw against central differences: %.2g\n", worst);
    assert_below(worst, 1e-6);
}

/* Other units of length, time and stress: the same answer, scaled. */
static void test_units(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    for (int i = 0; i < 5000; i++) {
        const ilsa_material_def law = random_law(3.0);
        const double L = power_of_10(-20.0, 20.0), T = power_of_10(-20.0, 20.0);
        const double P = power_of_10(-20.0, 20.0);
        const ilsa_material_def other = {law.E_prime * P, law.mu_prime * P * T,
                                         law.K_prime * P * sqrt(L), law.C_prime * L / sqrt(T)};
        const double V = power_of_10(-3.0, 3.0), s = power_of_10(-3.0, 3.0);
        const double w = width_of(&law, V, s), dt = 0.1 * s / V;
        const asymptote_front a = ilsai_asymptote_distance(&law, 1.3 * w, s, dt);
        const asymptote_front b = ilsai_asymptote_distance(&other, 1.3 * w * L, s * L, dt * T);
        double M[4];
        ilsai_asymptote_moments(&law, V, s, w, &M[0], &M[1]);
        ilsai_asymptote_moments(&other, V * L / T, s * L, w * L, &M[2], &M[3]);
        worst = worst_of(worst, relative(width_of(&other, V * L / T, s * L), w * L));
        worst = worst_of(worst, relative(b.s, a.s * L));
        worst = worst_of(worst, relative(b.V, a.V * L / T));
        worst = worst_of(worst, relative(b.ds_dw, a.ds_dw));
        worst = worst_of(worst, relative(M[2], M[0] * L * L));
        worst = worst_of(worst, relative(M[3], M[1] * L * L * L));
    }
    print_message("other units, factors to 1e+-20: %.2g\n", worst);
    assert_below(worst, 1e-13);
}

/* The whole double range, subnormal numbers included: a status or a sane number, never a NaN. */
static void test_double_range(void **state) {
    (void)state;
    int widths = 0, distances = 0;
    for (int i = 0; i < 100000; i++) {
        ilsa_material_def law = random_law(308.0);
        if (i % 16 == 0)
            law.mu_prime = 0.0;
        const double a = power_of_10(-320.0, 308.0), s = power_of_10(-320.0, 308.0);
        const double w = power_of_10(-320.0, 308.0);
        double out, V, M0, M1;
        ilsa_tip_regime regime;
        const int ruled = law.mu_prime > 0.0 || law.K_prime > 0.0;
        if (!(law.E_prime > 0.0 && ruled && a > 0.0 && s > 0.0 && w > 0.0))
            continue;
        if (ilsa_tip_width(&law, a, s, &out) == ILSA_OK) {
            assert_true(out >= 0.0 && out <= DBL_MAX);
            widths++;
            if (out > 0.0 && ilsa_tip_moments(&law, a, s, out, &M0, &M1) == ILSA_OK)
                assert_true(M0 >= 0.0 && M0 <= DBL_MAX && M1 >= 0.0 && M1 <= DBL_MAX);
        }
        if (ilsa_tip_distance(&law, w, s, a, &out, &V) == ILSA_OK) {
            assert_true(out >= s && out <= DBL_MAX && V >= 0.0 && V <= DBL_MAX);
            assert_true(ilsai_asymptote_distance(&law, w, s, a).ds_dw >= 0.0);
            distances++;
        }
        assert_int_equal(ilsa_tip_triangle(&law, a, s, w, &regime), ILSA_OK);
        assert_below(fabs(regime.N_k + regime.N_mt + regime.N_m - 1.0), 1e-14);
    }
    assert_true(widths > 30000 && distances > 30000);
}

static ilsa_tip_regime regime_of(const ilsa_material_def *law, double V, double s, double w) {
    ilsa_tip_regime regime;
    assert_int_equal(ilsa_tip_triangle(law, V, s, w, &regime), ILSA_OK);
    return regime;
}

static void test_triangle_partition(void **state) {
    (void)state;
    const double root3 = sqrt(3.0);
    for (int i = 0; i < 20000; i++) {
        const ilsa_material_def law = random_law(6.0);
        const double V = power_of_10(-6.0, 6.0), s = power_of_10(-6.0, 6.0);
        const ilsa_tip_regime r = regime_of(&law, V, s, width_of(&law, V, s));
        assert_true(r.N_k >= 0.0 && r.N_mt >= 0.0 && r.N_m >= 0.0);
        assert_true(r.N_k <= 1.0 && r.N_mt <= 1.0 && r.N_m <= 1.0);
        assert_below(fabs(r.N_k + r.N_mt + r.N_m - 1.0), 1e-15);
        assert_below(fabs(r.x - (r.N_k + 0.5 * r.N_mt)), 1e-15);
        assert_below(fabs(r.y - 0.5 * root3 * r.N_mt), 1e-15);
        assert_true(law.K_prime > 0.0 || r.N_k == 0.0);
        assert_true(law.C_prime > 0.0 || r.N_mt == 0.0);
    }
}

/* (3.19) as printed, at a point where it is not singular. */
static void test_triangle_formula(void **state) {
    (void)state;
    const ilsa_material_def law = {2.0, 3.0, 1.5, 0.4};
    const double V = 0.3, s = 0.8, w = width_of(&law, V, s);
    const double w_k = 1.5 / 2.0 * sqrt(s), w_m = BETA_M * cbrt(3.0 * V / 2.0 * s * s);
    const double w_mt = BETA_MT * pow(4.0 * 9.0 * V * 0.16 / 4.0, 0.125) * pow(s, 0.625);
    const double k = w_k / (w - w_k), mt = w_mt / (w - w_mt), m = w_m / (w - w_m);
    const ilsa_tip_regime r = regime_of(&law, V, s, w);
    assert_below(relative(r.N_k, k / (k + mt + m)), 1e-12);
    assert_below(relative(r.N_mt, mt / (k + mt + m)), 1e-12);
    assert_below(relative(r.N_m, m / (k + mt + m)), 1e-12);
}

static void test_triangle_vertices(void **state) {
    (void)state;
    const ilsa_material_def law = {2.0, 3.0, 1.5, 0.4}, viscous = {2.0, 3.0, 0.0, 0.0};
    const ilsa_material_def leaky = {1.0, 1.0, 0.0, 1e9}, tough = {1.0, 1e-30, 1.0, 0.0};
    assert_below(fabs(regime_of(&law, 0.0, 0.8, 0.1).N_k - 1.0), 0.0);
    assert_below(fabs(regime_of(&law, 0.0, 0.8, 0.1).x - 1.0), 0.0);
    assert_below(fabs(regime_of(&viscous, 0.0, 0.8, 0.0).N_k - 1.0), 0.0);
    assert_below(fabs(regime_of(&viscous, 1.0, 0.8, width_of(&viscous, 1.0, 0.8)).N_m - 1.0),
                 1e-12);
    assert_below(fabs(regime_of(&leaky, 1.0, 1.0, width_of(&leaky, 1.0, 1.0)).N_mt - 1.0), 1e-3);
    assert_below(fabs(regime_of(&tough, 1.0, 1.0, width_of(&tough, 1.0, 1.0)).N_k - 1.0), 1e-12);
    /* Widths at and below the vertices, which the closed form or a caller may give. */
    const double w_m = BETA_M * cbrt(3.0 / 2.0);
    const ilsa_tip_regime at_m = regime_of(&viscous, 1.0, 1.0, w_m);
    assert_below(fabs(at_m.N_m - 1.0), 1e-12);
    for (double w = 1e-6; w < 10.0; w *= 1.1) {
        const ilsa_tip_regime r = regime_of(&law, 1.0, 1.0, w);
        assert_below(fabs(r.N_k + r.N_mt + r.N_m - 1.0), 1e-15);
    }
}

static const double bad_positive[] = {0.0, -1.0, INFINITY, -INFINITY, NAN};

/* Each value that no positive argument may have, in the place of each member in turn. */
static void test_bad_laws(void **state) {
    (void)state;
    for (int i = 0; i < 20; i++) {
        ilsa_material_def law = {1.0, 1.0, 1.0, 1.0};
        const double bad = bad_positive[i / 4];
        double *member[4] = {&law.E_prime, &law.mu_prime, &law.K_prime, &law.C_prime};
        *member[i % 4] = bad;
        const ilsa_status expected = i % 4 >= 1 && bad == 0.0 ? ILSA_OK : ILSA_ERR_VALUE;
        double a = UNTOUCHED, b = UNTOUCHED;
        ilsa_tip_regime r = {UNTOUCHED, UNTOUCHED, UNTOUCHED, UNTOUCHED, UNTOUCHED};
        assert_int_equal(ilsa_tip_width(&law, 1.0, 1.0, &a), expected);
        assert_true((a == UNTOUCHED) == (expected != ILSA_OK));
        a = UNTOUCHED;
        assert_int_equal(ilsa_tip_moments(&law, 1.0, 1.0, 9.0, &a, &b), expected);
        assert_true((a == UNTOUCHED && b == UNTOUCHED) == (expected != ILSA_OK));
        a = b = UNTOUCHED;
        assert_int_equal(ilsa_tip_distance(&law, 9.0, 1.0, 1.0, &a, &b), expected);
        assert_true((a == UNTOUCHED && b == UNTOUCHED) == (expected != ILSA_OK));
        assert_int_equal(ilsa_tip_triangle(&law, 1.0, 1.0, 9.0, &r), expected);
        assert_true((r.N_k == UNTOUCHED && r.y == UNTOUCHED) == (expected != ILSA_OK));
    }
}

/* Neither viscosity nor toughness: there is no width. */
static void test_law_of_nothing(void **state) {
    (void)state;
    const ilsa_material_def laws[] = {
        {1.0, 0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 1.0}, {1.0, -0.0, -0.0, 1.0}};
    for (size_t i = 0; i < sizeof laws / sizeof *laws; i++) {
        double a = UNTOUCHED, b = UNTOUCHED;
        ilsa_tip_regime r = {.N_k = UNTOUCHED, .x = UNTOUCHED};
        assert_int_equal(ilsa_tip_width(&laws[i], 1.0, 1.0, &a), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_moments(&laws[i], 1.0, 1.0, 1.0, &a, &b), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_distance(&laws[i], 1.0, 1.0, 1.0, &a, &b), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_triangle(&laws[i], 1.0, 1.0, 1.0, &r), ILSA_ERR_VALUE);
        assert_true(a == UNTOUCHED && b == UNTOUCHED && r.N_k == UNTOUCHED && r.x == UNTOUCHED);
    }
}

static void test_bad_numbers(void **state) {
    (void)state;
    const ilsa_material_def law = {1.0, 1.0, 1.0, 1.0};
    double a = UNTOUCHED, b = UNTOUCHED;
    ilsa_tip_regime r = {.N_k = UNTOUCHED, .x = UNTOUCHED};
    for (size_t i = 0; i < sizeof bad_positive / sizeof *bad_positive; i++) {
        const double bad = bad_positive[i];
        assert_int_equal(ilsa_tip_width(&law, 1.0, bad, &a), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_moments(&law, 1.0, bad, 1.0, &a, &b), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_moments(&law, 1.0, 1.0, bad, &a, &b), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_moments(&law, 0.0, 1.0, bad, &a, &b), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_distance(&law, bad, 1.0, 1.0, &a, &b), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_distance(&law, 1.0, bad, 1.0, &a, &b), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_distance(&law, 1.0, 1.0, bad, &a, &b), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_triangle(&law, 1.0, bad, 1.0, &r), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_triangle(&law, 1.0, 1.0, bad, &r), ILSA_ERR_VALUE);
        if (bad == 0.0) /* V = 0 is a front at rest */
            continue;
        assert_int_equal(ilsa_tip_width(&law, bad, 1.0, &a), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_moments(&law, bad, 1.0, 1.0, &a, &b), ILSA_ERR_VALUE);
        assert_int_equal(ilsa_tip_triangle(&law, bad, 1.0, 1.0, &r), ILSA_ERR_VALUE);
        assert_true(isnan(ilsa_tip_g_delta(bad, 1.0)) && isnan(ilsa_tip_g_delta(0.5, bad)));
        assert_true(isnan(ilsa_tip_g_delta(2.0, bad)));
        assert_true(isnan(ilsa_tip_delta_p(bad, 1.0, 0.5)));
        assert_true(isnan(ilsa_tip_delta_p(0.5, bad, 0.5)));
        assert_true(isnan(ilsa_tip_delta_p(0.5, 1.0, bad)));
    }
    assert_true(isnan(ilsa_tip_delta_p(0.5, 1.0, 1.0 + DBL_EPSILON)));
    assert_true(a == UNTOUCHED && b == UNTOUCHED && r.N_k == UNTOUCHED && r.x == UNTOUCHED);
}

static void test_results_out_of_range(void **state) {
    (void)state;
    const ilsa_material_def law = {1e-300, 1.0, 1e300, 0.0}, soft = {1.0, 1e-300, 0.0, 0.0};
    double a = UNTOUCHED, b = UNTOUCHED;
    assert_int_equal(ilsa_tip_width(&law, 1.0, 1.0, &a), ILSA_ERR_VALUE);
    assert_int_equal(ilsa_tip_moments(&soft, 1.0, 1e200, 1.0, &a, &b), ILSA_ERR_VALUE);
    assert_int_equal(ilsa_tip_distance(&soft, 1e300, 1.0, 1e-300, &a, &b), ILSA_ERR_VALUE);
    assert_int_equal(ilsa_tip_distance(&soft, 1e308, 1e-300, 1e300, &a, &b), ILSA_ERR_VALUE);
    assert_true(a == UNTOUCHED && b == UNTOUCHED);
}

static void test_null(void **state) {
    (void)state;
    const ilsa_material_def law = {1.0, 1.0, 1.0, 1.0};
    double a = UNTOUCHED;
    ilsa_tip_regime r;
    assert_int_equal(ilsa_tip_width(NULL, 1.0, 1.0, &a), ILSA_ERR_NULL);
    assert_int_equal(ilsa_tip_width(&law, 1.0, 1.0, NULL), ILSA_ERR_NULL);
    assert_int_equal(ilsa_tip_moments(NULL, 1.0, 1.0, 1.0, &a, &a), ILSA_ERR_NULL);
    assert_int_equal(ilsa_tip_moments(&law, 1.0, 1.0, 1.0, NULL, &a), ILSA_ERR_NULL);
    assert_int_equal(ilsa_tip_moments(&law, 1.0, 1.0, 1.0, &a, NULL), ILSA_ERR_NULL);
    assert_int_equal(ilsa_tip_distance(NULL, 1.0, 1.0, 1.0, &a, &a), ILSA_ERR_NULL);
    assert_int_equal(ilsa_tip_distance(&law, 1.0, 1.0, 1.0, NULL, &a), ILSA_ERR_NULL);
    assert_int_equal(ilsa_tip_distance(&law, 1.0, 1.0, 1.0, &a, NULL), ILSA_ERR_NULL);
    assert_int_equal(ilsa_tip_triangle(NULL, 1.0, 1.0, 1.0, &r), ILSA_ERR_NULL);
    assert_int_equal(ilsa_tip_triangle(&law, 1.0, 1.0, 1.0, NULL), ILSA_ERR_NULL);
    assert_true(a == UNTOUCHED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_g_delta_table),
        cmocka_unit_test(test_width_table),
        cmocka_unit_test(test_width_table_without_toughness),
        cmocka_unit_test(test_vertices),
        cmocka_unit_test(test_width_above_vertices),
        cmocka_unit_test(test_width_grows),
        cmocka_unit_test(rows_are_widths_alone),
        cmocka_unit_test(test_width_at_rest),
        cmocka_unit_test(test_moments_are_integrals),
        cmocka_unit_test(test_g_delta_range),
        cmocka_unit_test(test_g_delta_quadrature),
        cmocka_unit_test(test_distance_inverts_width),
        cmocka_unit_test(test_distance_finds_velocity),
        cmocka_unit_test(test_distance_arrested),
        cmocka_unit_test(test_distance_grows_with_width),
        cmocka_unit_test(test_toughness_alone),
        cmocka_unit_test(test_distance_of_toughness),
        cmocka_unit_test(test_little_viscosity),
        cmocka_unit_test(test_distance_derivative),
        cmocka_unit_test(test_units),
        cmocka_unit_test(test_double_range),
        cmocka_unit_test(test_triangle_partition),
        cmocka_unit_test(test_triangle_formula),
        cmocka_unit_test(test_triangle_vertices),
        cmocka_unit_test(test_bad_laws),
        cmocka_unit_test(test_law_of_nothing),
        cmocka_unit_test(test_bad_numbers),
        cmocka_unit_test(test_results_out_of_range),
        cmocka_unit_test(test_null),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
