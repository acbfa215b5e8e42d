/* The penny-shaped fracture that a run starts from, against reference solutions and vertices. */
#include "check.h"
#include "csv.h"
#include "tip/penny.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static ilsa_material_def law(double mu_prime, double K_prime, double C_prime) {
    return (ilsa_material_def){
        .E_prime = 1.0, .mu_prime = mu_prime, .K_prime = K_prime, .C_prime = C_prime};
}

static penny_solution at_time(ilsa_material_def scaled, double Q, double t) {
    penny_solution solution;
    assert_int_equal(ilsai_penny_at_time(&scaled, Q, t, &solution), ILSA_OK);
    return solution;
}

/* The scaling of (5.1): phi, tau. */
static penny_solution at_phi_tau(double phi, double tau) {
    return at_time(law(1.0, 1.0, pow(phi, 0.25)), 1.0, tau);
}

/* 2 pi times the integral of field(r) r dr, in panels of equal width in ln(1 - rho). */
static double area_integral(double (*field)(const penny_solution *, double),
                            const penny_solution *solution) {
    const double x[3] = {0.11270166537925831, 0.5, 0.88729833462074169};
    const double weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    const double panel = 1e-3;
    double sum = 0.0;
    for (int i = 0; i < 35000; i++) {
        for (int k = 0; k < 3; k++) {
            double rho = -expm1(-panel * (i + x[k]));
            sum += weight[k] * field(solution, rho) * rho * (1.0 - rho);
        }
    }
    return 2.0 * PI * solution->R * solution->R * panel * sum;
}

/* What a unit area has lost since the front passed, (2.4). */
static double leaked(const penny_solution *solution, double rho) {
    double age = solution->t - ilsai_penny_arrival(solution, rho);
    return 2.0 * solution->scaled.C_prime * sqrt(fmax(age, 0.0));
}

static void test_history(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/radial_history.csv");
    double R = NOTHING_YET, efficiency = NOTHING_YET, V = NOTHING_YET, alpha = NOTHING_YET,
           center = NOTHING_YET, middle = NOTHING_YET, pressure = NOTHING_YET;
    for (size_t i = 0; i < csv_rows(table); i++) {
        penny_solution s = at_phi_tau(csv_get(table, i, "phi"), csv_get(table, i, "tau"));
        R = worst_of(R, relative(s.R, csv_get(table, i, "R")));
        efficiency = worst_of(efficiency, fabs(s.efficiency - csv_get(table, i, "efficiency")));
        V = worst_of(V, relative(s.V, csv_get(table, i, "V")));
        alpha = worst_of(alpha, fabs(s.alpha - csv_get(table, i, "alpha_dlnR_dlnt")));
        center =
            worst_of(center, relative(ilsai_penny_width(&s, 0), csv_get(table, i, "w_center")));
        middle =
            worst_of(middle, relative(ilsai_penny_width(&s, 0.5), csv_get(table, i, "w_rho0p5")));
        pressure = worst_of(pressure,
                            relative(ilsai_penny_pressure(&s, 0.5), csv_get(table, i, "p_rho0p5")));
    }
    csv_free(table);
    print_message("history: R %.1e, efficiency %.1e, V %.1e, alpha %.1e, w(0) %.1e, w(0.5) %.1e, "
                  "p(0.5) %.1e\n",
                  R, efficiency, V, alpha, center, middle, pressure);
    assert_below(R, 3e-4);
    assert_below(efficiency, 2e-4);
    assert_below(V, 4e-3);
    assert_below(alpha, 1e-3);
    assert_below(center, 5e-4);
    assert_below(middle, 6e-4);
    assert_below(pressure, 1e-3);
}

/* The pressure passes through zero near the tip: its error is measured by the one at rho = 0.5. */
static void test_profiles(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/radial_profiles.csv");
    penny_solution s = {0};
    double inside = NOTHING_YET, rim = NOTHING_YET;
    double pressure = NOTHING_YET, rim_pressure = NOTHING_YET;
    for (size_t i = 0; i < csv_rows(table); i++) {
        double rho = csv_get(table, i, "rho");
        if (i == 0 || rho < csv_get(table, i - 1, "rho")) {
            s = at_phi_tau(csv_get(table, i, "phi"), csv_get(table, i, "tau"));
        }
        double w = relative(ilsai_penny_width(&s, rho), csv_get(table, i, "Omega"));
        double p = fabs(ilsai_penny_pressure(&s, rho) - csv_get(table, i, "Pi")) /
                   ilsai_penny_pressure(&s, 0.5);
        double *width_error = rho < 0.96 ? &inside : &rim;
        double *pressure_error = rho < 0.96 ? &pressure : &rim_pressure;
        *width_error = worst_of(*width_error, w);
        *pressure_error = worst_of(*pressure_error, p);
    }
    csv_free(table);
    print_message("profiles, rho <= 0.95: w %.1e, p %.1e; rho = 0.99, 0.999: w %.1e, p %.1e\n",
                  inside, pressure, rim, rim_pressure);
    assert_below(inside, 1.2e-3);
    assert_below(pressure, 1.5e-3);
    assert_below(rim, 2.5e-3);
    assert_below(rim_pressure, 1e-2);
}

/* E' = Q = t = 1 with R, w and p in the scales of the vertex. */
static void check_vertex(const char *name, ilsa_material_def scaled, const double scale[3],
                         double tolerance) {
    csv_table *table = csv_read("tests/data/radial_vertices.csv");
    penny_solution s = at_time(scaled, 1.0, 1.0);
    double R = NOTHING_YET, w = NOTHING_YET, p = NOTHING_YET;
    for (size_t i = 0; i < csv_rows(table); i++) {
        if (strcmp(csv_text(table, i, "vertex"), name) == 0) {
            double rho = csv_get(table, i, "rho");
            R = worst_of(R, relative(s.R, csv_get(table, i, "gamma") * scale[0]));
            w = worst_of(
                w, relative(ilsai_penny_width(&s, rho), csv_get(table, i, "Omega") * scale[1]));
            p = worst_of(p,
                         fabs(ilsai_penny_pressure(&s, rho) / scale[2] - csv_get(table, i, "Pi")));
        }
    }
    csv_free(table);
    print_message("vertex %-2s: R %.1e, w %.1e, p %.1e, efficiency %.1e\n", name, R, w, p,
                  s.efficiency);
    assert_below(R, tolerance);
    assert_below(w, 1.5e-3 + tolerance);
    assert_below(p, 5e-3 + tolerance);
}

/* Leaving out a process is exact; for the others a parameter is taken to its end. */
static void test_vertices(void **state) {
    (void)state;
    const double C = 1e12, one[3] = {1.0, 1.0, 1.0};
    check_vertex("M", law(1.0, 0.0, 0.0), one, 1e-4);
    check_vertex("K", law(1e-30, 1.0, 0.0), one, 1e-4);
    check_vertex("Mt", law(1.0, 0.0, C), (double[]){pow(C, -0.5), pow(C, -0.125), pow(C, 0.375)},
                 1e-3);
    check_vertex("Kt", law(1e-60, 1.0, C), (double[]){pow(C, -0.5), pow(C, -0.25), pow(C, 0.25)},
                 1e-3);
}

/* Far outside the table: found, ordered in time, never above the vertices, and inverted. */
static void test_range(void **state) {
    (void)state;
    double inverse = NOTHING_YET;
    for (int k = -14; k <= 12; k += 2) {
        double phi = k < -12 ? 0.0 : pow(10.0, k), radius = 0.0, efficiency = 1.0 + 1e-8;
        for (int n = -9; n <= 9; n += 2) {
            double tau = pow(10.0, n);
            penny_solution s = at_phi_tau(phi, tau), back;
            assert_int_equal(ilsai_penny_at_radius(&s.scaled, s.Q, s.R, &back), ILSA_OK);
            inverse = worst_of(inverse, relative(back.t, tau));
            assert_true(back.R == s.R);
            assert_true(s.R > radius);
            assert_true(s.efficiency > 0.0 && s.efficiency <= efficiency);
            assert_true(s.alpha > 0.249 && s.alpha < 0.446);
            double bound = fmin(0.69783755 * pow(tau, 4.0 / 9.0), 0.8546387 * pow(tau, 0.4));
            if (phi > 0.0) {
                bound = fmin(bound, 0.45015816 * pow(tau, 0.25) * pow(phi, -0.125));
            }
            assert_true(s.R < 1.001 * bound && s.R > 0.6 * bound);
            radius = s.R;
            efficiency = s.efficiency * (1.0 + 1e-8);
        }
    }
    print_message("tau 1e-9..1e9, phi 0..1e12: t from R within %.1e\n", inverse);
    assert_below(inverse, 1e-8);
}

/* The profile holds the volume it says, and with what leaked it makes up what was injected. */
static void test_volume(void **state) {
    (void)state;
    const double C[] = {0.0, 0.1, 1.0, 10.0}, K[] = {0.0, 1.0};
    double profile = NOTHING_YET, balance = NOTHING_YET;
    for (int i = 0; i < 8; i++) {
        penny_solution s = at_time(law(1.0, K[i % 2], C[i / 2]), 2.0, 0.3);
        double volume = s.efficiency * s.Q * s.t;
        profile = worst_of(profile, relative(area_integral(ilsai_penny_width, &s), volume));
        balance = worst_of(balance, relative(volume + area_integral(leaked, &s), s.Q * s.t));
    }
    print_message("volume: of the profile %.1e, balance with leak-off %.1e\n", profile, balance);
    assert_below(profile, 1e-10);
    assert_below(balance, 2e-4);
}

/* The front passed rho R when the fracture was that large. */
static void test_arrival(void **state) {
    (void)state;
    const double C[] = {0.0, 0.1, 1.0, 10.0};
    double worst = NOTHING_YET;
    for (int i = 0; i < 4; i++) {
        penny_solution s = at_time(law(1.0, 1.0, C[i]), 1.0, 5.0), earlier;
        double last = 0.0;
        for (int k = 1; k < 100; k++) {
            double t = ilsai_penny_arrival(&s, 0.01 * k);
            assert_true(t > last && t < s.t);
            last = t;
        }
        for (int k = 1; k < 10; k++) {
            ilsai_penny_at_radius(&s.scaled, s.Q, 0.1 * k * s.R, &earlier);
            worst = worst_of(worst, fabs(ilsai_penny_arrival(&s, 0.1 * k) - earlier.t) / s.t);
        }
        assert_true(ilsai_penny_arrival(&s, 0.0) == 0.0);
        assert_true(ilsai_penny_arrival(&s, 1.0) == s.t);
        assert_true(ilsai_penny_arrival(&s, 1.5) == s.t);
    }
    print_message("arrival: %.1e of the time\n", worst);
    assert_below(worst, 1e-3);
}

/* The same fracture in centimetres, minutes and an odd unit of mass. */
static void test_units(void **state) {
    (void)state;
    const double length = 100.0, time = 1.0 / 60.0, stress = 7.3e-5;
    ilsa_material_def si = {3.5e10, 0.0012, 1.5e6, 3e-5}, odd = si;
    odd.E_prime *= stress;
    odd.mu_prime *= stress * time;
    odd.K_prime *= stress * sqrt(length);
    odd.C_prime *= length / sqrt(time);
    penny_solution a = at_time(si, 0.05, 900.0);
    penny_solution b = at_time(odd, 0.05 * length * length * length / time, 900.0 * time);
    double worst = relative(b.R, a.R * length);
    worst = worst_of(worst, relative(b.V, a.V * length / time));
    worst = worst_of(worst, relative(b.efficiency, a.efficiency));
    for (int k = 0; k < 10; k++) {
        double rho = 0.1 * k;
        worst = worst_of(worst,
                         relative(ilsai_penny_width(&b, rho), ilsai_penny_width(&a, rho) * length));
        worst = worst_of(
            worst, relative(ilsai_penny_pressure(&b, rho), ilsai_penny_pressure(&a, rho) * stress));
    }
    print_message("units: %.1e; R %.4g m, efficiency %.3f, w %.3g m, p %.3g Pa\n", worst, a.R,
                  a.efficiency, ilsai_penny_width(&a, 0), ilsai_penny_pressure(&a, 0.5));
    assert_below(worst, 1e-9);
}

static void test_repeats(void **state) {
    (void)state;
    penny_solution a = at_phi_tau(1e-2, 3.0), b = at_phi_tau(1e-2, 3.0);
    assert_memory_equal(&a.log_width, &b.log_width, sizeof a.log_width);
    assert_memory_equal(&a.pressure, &b.pressure, sizeof a.pressure);
    assert_true(a.R == b.R && a.efficiency == b.efficiency);
}

/* At the source, at the rim, and past it. */
static void test_ends(void **state) {
    (void)state;
    penny_solution s = at_phi_tau(1e-2, 1.0);
    assert_true(isfinite(ilsai_penny_pressure(&s, 0.0)));
    assert_true(ilsai_penny_pressure(&s, 0.0) > ilsai_penny_pressure(&s, 0.1));
    assert_true(isfinite(ilsai_penny_pressure(&s, 1.0 - 1e-15)));
    assert_true(ilsai_penny_pressure(&s, 1.0) == ilsai_penny_pressure(&s, 1.0 - 1e-15));
    assert_true(ilsai_penny_width(&s, 1.0 - 1e-15) > 0.0);
    assert_true(ilsai_penny_width(&s, 1.0) == 0.0);
    assert_true(ilsai_penny_width(&s, 2.0) == 0.0);
    double last = ilsai_penny_width(&s, 0.0);
    for (int k = 1; k <= 1000; k++) {
        double w = ilsai_penny_width(&s, 1e-3 * k);
        assert_true(w < last);
        last = w;
    }
}

static void test_bad_input(void **state) {
    (void)state;
    const double bad[] = {NAN, INFINITY, -INFINITY, -1.0, 0.0};
    for (int field = 0; field < 6; field++) {
        for (int k = 0; k < 5; k++) {
            double v[6] = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
            v[field] = bad[k];
            if (bad[k] == 0.0 && (field == 2 || field == 3)) {
                continue;
            }
            ilsa_material_def scaled = {v[0], v[1], v[2], v[3]};
            penny_solution solution, before;
            memset(&solution, 0x5a, sizeof solution);
            before = solution;
            assert_int_equal(ilsai_penny_at_time(&scaled, v[4], v[5], &solution), ILSA_ERR_VALUE);
            assert_int_equal(ilsai_penny_at_radius(&scaled, v[4], v[5], &solution), ILSA_ERR_VALUE);
            assert_memory_equal(&solution, &before, sizeof solution);
        }
    }
    ilsa_material_def extreme = law(1e-300, 0.0, 0.0);
    penny_solution solution;
    assert_int_equal(ilsai_penny_at_time(&extreme, 1.0, 1e300, &solution), ILSA_ERR_VALUE);
    assert_int_equal(ilsai_penny_at_radius(&extreme, 1.0, 1e300, &solution), ILSA_ERR_VALUE);
    /* E' t is below the double range */
    ilsa_material_def soft = {1e-200, 1e-200, 0.0, 0.0};
    assert_int_equal(ilsai_penny_at_time(&soft, 1.0, 1e-200, &solution), ILSA_ERR_VALUE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_history),  cmocka_unit_test(test_profiles),
        cmocka_unit_test(test_vertices), cmocka_unit_test(test_range),
        cmocka_unit_test(test_volume),   cmocka_unit_test(test_arrival),
        cmocka_unit_test(test_units),    cmocka_unit_test(test_repeats),
        cmocka_unit_test(test_ends),     cmocka_unit_test(test_bad_input),
    };
    return cmocka_run_group_tests_name("radial", tests, NULL, NULL);
}
