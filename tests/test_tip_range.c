/*
 * The tip functions over the whole double range of their arguments: floating-point exceptions,
 * NaN, order, the inversion put back, and what becomes of results beyond the range.
 */
#include "check.h"
#include "host.h"
#include "tip/asymptote.h"

#include <fenv.h>
#include <float.h>

enum { BAD = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW };

static long points(void) {
    return host_long() ? 10000000 : 100000;
}

static double power_of_10(double low, double high) {
    return pow(10.0, low + (high - low) * uniform());
}

/* Any positive double, all exponents alike. */
static double any(void) {
    return ldexp(1.0 + uniform(), (int)(2098.0 * uniform()) - 1074);
}

/* A law, a front and a survey cell, from the whole range or, every third, from a part of it. */
typedef struct point {
    ilsa_material_def law;
    double V, s, dt;
} point;

static point nth_point(long n) {
    const double decades = n % 2 ? 6.0 : 30.0;
    double x[7];
    for (int k = 0; k < 7; k++)
        x[k] = n % 3 ? any() : power_of_10(-decades, decades);
    point p = {{x[0], x[1], x[2], x[3]}, x[4], x[5], x[6]};
    p.law.K_prime *= n % 7 != 1;
    p.law.C_prime *= n % 5 != 1;
    p.law.mu_prime *= n % 11 != 1 || p.law.K_prime == 0.0;
    return p;
}

static void fail_at(const char *what, const point *p, double a, double b) {
    fail_msg("%s: E' %.17g, mu' %.17g, K' %.17g, C' %.17g, V %.17g, s %.17g, dt %.17g: %.17g %.17g",
             what, p->law.E_prime, p->law.mu_prime, p->law.K_prime, p->law.C_prime, p->V, p->s,
             p->dt, a, b);
}

static void begin(void) {
    feclearexcept(FE_ALL_EXCEPT);
}

/* After a call whose result is in range, or is refused. */
static void check(const char *what, const point *p, int in_range, double a, double b) {
    const int raised = fetestexcept(BAD);
    if (raised & (in_range ? BAD : FE_INVALID | FE_DIVBYZERO))
        fail_at(what, p, a, b);
    if (in_range && !(a >= 0.0 && a <= DBL_MAX && b >= 0.0 && b <= DBL_MAX))
        fail_at(what, p, a, b);
}

/* A width that belongs to the front, is just above it or has nothing to do with it. */
static double survey_width(const point *p) {
    double w = 0.0;
    if (uniform() < 0.5 || ilsa_tip_width(&p->law, p->V, p->s, &w) != ILSA_OK || w == 0.0)
        return any();
    const double factor = uniform() < 0.5 ? 1.0 + power_of_10(-16.0, 0.0) : power_of_10(-9.0, 9.0);
    return w * factor <= DBL_MAX && w * factor > 0.0 ? w * factor : w;
}

static void scaled_functions_raise_nothing(void **state) {
    (void)state;
    for (long n = 0; n < points(); n++) {
        const double C = n % 17 ? any() : 0.0, near = 1.0 - ldexp(1.0, -(int)(53.0 * uniform()));
        const double K = n % 19 == 0 ? 0.0 : n % 13 == 0 ? near : n % 2 ? any() : uniform();
        const point p = {.V = K, .s = C};
        begin();
        const double g = ilsa_tip_g_delta(K, C), delta = ilsa_tip_delta_p(K, C, uniform());
        check("g_delta, delta_p", &p, 1, g, delta);
    }
}

static void widths_and_moments_raise_nothing(void **state) {
    (void)state;
    for (long n = 0; n < points(); n++) {
        const point p = nth_point(n);
        double w = 0.0, M0 = 0.0, M1 = 0.0;
        ilsa_tip_regime r;
        begin();
        int ok = ilsa_tip_width(&p.law, n % 23 ? p.V : 0.0, p.s, &w) == ILSA_OK;
        check("width", &p, ok, w, 0.0);
        w = ok && w > 0.0 && n % 2 ? w : any();
        begin();
        ok = ilsa_tip_moments(&p.law, p.V, p.s, w, &M0, &M1) == ILSA_OK;
        check("moments", &p, ok, M0, M1);
        begin();
        assert_int_equal(ilsa_tip_triangle(&p.law, p.V, p.s, w, &r), ILSA_OK);
        check("triangle", &p, 1, r.x, r.y);
        assert_below(fabs(r.N_k + r.N_mt + r.N_m - 1.0), 1e-15);
    }
}

static void distances_raise_nothing(void **state) {
    (void)state;
    for (long n = 0; n < points(); n++) {
        const point p = nth_point(n);
        const double w = survey_width(&p);
        double s = 0.0, V = 0.0;
        begin();
        const int ok = ilsa_tip_distance(&p.law, w, p.s, p.dt, &s, &V) == ILSA_OK;
        check("distance", &p, ok, s, V);
        if (ok && !(s >= p.s))
            fail_at("distance", &p, s, V);
    }
}

/* What the solver calls beside these. */
static void inner_functions_raise_nothing(void **state) {
    (void)state;
    long asked = 0;
    for (long n = 0; n < points() / 4; n++) {
        const point p = nth_point(n);
        const double w = ilsai_asymptote_width(&p.law, p.V, p.s), s[2] = {p.s, 0.5 * p.s};
        if (!(w <= DBL_MAX && w > 0.0 && s[1] > 0.0))
            continue;
        asked++;
        asymptote_point row[2];
        begin();
        ilsai_asymptote_row(&p.law, p.V, 2, s, row);
        check("row", &p, row[0].M0 <= DBL_MAX, row[1].w, row[1].M0);
        begin();
        const double exponent = ilsai_asymptote_exponent(&p.law, p.V, p.s, w);
        const double by_V = row[0].by_V;
        check("exponents", &p, 1, exponent, by_V);
        assert_true(exponent >= 0.5 && exponent <= 2.0 / 3.0 + 1e-14 && by_V <= 1.0 / 3.0 + 1e-14);
    }
    assert_true(asked > points() / 8);
}

/* By 1e-10 and more: w is found to a few units of the last place. */
static void widths_grow_with_distance_and_velocity(void **state) {
    (void)state;
    long by_s = 0, by_V = 0;
    for (long n = 0; n < points(); n++) {
        const point p = nth_point(n);
        const double more = 1.0 + power_of_10(-10.0, 2.0);
        double w, further, faster;
        if (p.s * more <= DBL_MAX && p.s >= DBL_MIN &&
            ilsa_tip_width(&p.law, p.V, more * p.s, &further) == ILSA_OK) {
            assert_int_equal(ilsa_tip_width(&p.law, p.V, p.s, &w), ILSA_OK);
            if (!(further >= w) || (w >= DBL_MIN && further == w))
                fail_at("width by s", &p, w, further);
            by_s++;
        }
        if (p.V * more <= DBL_MAX && ilsa_tip_width(&p.law, more * p.V, p.s, &faster) == ILSA_OK) {
            assert_int_equal(ilsa_tip_width(&p.law, p.V, p.s, &w), ILSA_OK);
            if (!(faster >= w))
                fail_at("width by V", &p, w, faster);
            by_V++;
        }
    }
    assert_true(by_s > points() / 2 && by_V > points() / 2);
}

/* Where neither the velocity nor the distance has lost digits to the end of the range. */
static void distances_put_back_give_the_width(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    long moved = 0;
    for (long n = 0; n < points(); n++) {
        const point p = nth_point(n);
        const double w = survey_width(&p);
        double s, V, back = 0.0;
        if (p.law.mu_prime == 0.0 || w < DBL_MIN || p.s < DBL_MIN ||
            ilsa_tip_distance(&p.law, w, p.s, p.dt, &s, &V) != ILSA_OK || V < DBL_MIN)
            continue;
        moved++;
        assert_int_equal(ilsa_tip_width(&p.law, V, s, &back), ILSA_OK);
        if (!(relative(back, w) < 1e-12))
            fail_at("inversion", &p, w, back);
        worst = worst_of(worst, relative(back, w));
    }
    print_message("(4.9) put back into (3.15), %ld survey cells: %.2g\n", moved, worst);
    assert_true(moved > points() / 3);
}

static void distances_grow_with_the_width(void **state) {
    (void)state;
    long compared = 0;
    for (long n = 0; n < points() / 4; n++) {
        const point p = nth_point(n);
        const double w = survey_width(&p), wider = w * (1.0 + power_of_10(-10.0, 2.0));
        double s, V, further, faster;
        if (w < DBL_MIN || !(wider <= DBL_MAX) ||
            ilsa_tip_distance(&p.law, wider, p.s, p.dt, &further, &faster) != ILSA_OK)
            continue;
        if (ilsa_tip_distance(&p.law, w, p.s, p.dt, &s, &V) != ILSA_OK) {
            if (!(further / p.s >
                  1e200)) /* beyond that a distance may be refused, see ilsa/tip.h */
                fail_at("distance of the narrower", &p, w, wider);
            continue;
        }
        if (!(further >= s && faster >= V * (1.0 - 1e-12)))
            fail_at("distance by w", &p, s, further);
        compared++;
    }
    assert_true(compared > points() / 8);
}

/* Also such as take the arguments out of the range where nothing can overflow. */
static void powers_of_two_are_units_to_the_last_bit(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    for (int n = 0; n < 20000; n++) {
        const int L = 2 * (n % 97 - 48), T = 2 * (n % 89 - 44), P = n % 101 - 50;
        const point p = nth_point(6L * n + 3); /* 1e-6 .. 1e6 */
        const ilsa_material_def law = {ldexp(p.law.E_prime, P), ldexp(p.law.mu_prime, P + T),
                                       ldexp(p.law.K_prime, P + L / 2),
                                       ldexp(p.law.C_prime, L - T / 2)};
        const double V = ldexp(p.V, L - T), s = ldexp(p.s, L), dt = ldexp(p.dt, T);
        const double w = ilsai_asymptote_width(&p.law, p.V, p.s), wide = ldexp(w, L);
        const asymptote_front here = ilsai_asymptote_distance(&p.law, 1.1 * w, p.s, p.dt);
        const asymptote_front there = ilsai_asymptote_distance(&law, 1.1 * wide, s, dt);
        double M[2], N[2];
        worst = worst_of(worst, relative(ilsai_asymptote_width(&law, V, s), wide));
        worst = worst_of(worst, relative(there.s, ldexp(here.s, L)));
        ilsai_asymptote_moments(&p.law, p.V, p.s, w, &M[0], &M[1]);
        ilsai_asymptote_moments(&law, V, s, wide, &N[0], &N[1]);
        assert_true(N[0] == ldexp(M[0], 2 * L) && N[1] == ldexp(M[1], 3 * L));
    }
    print_message("units by powers of two: off by %.2g\n", worst);
    assert_below(worst, 1e-14);
}

/* What a function that fails must leave in its outputs. */
#define UNTOUCHED (-7.25)

static void results_above_the_range_are_refused(void **state) {
    (void)state;
    const ilsa_material_def soft = {1e-300, 1.0, 1e300, 0.0}, thin = {1.0, 1e-300, 0.0, 0.0};
    double a = UNTOUCHED, b = UNTOUCHED;
    assert_int_equal(ilsa_tip_width(&soft, 1.0, 1.0, &a), ILSA_ERR_VALUE);
    assert_int_equal(ilsa_tip_moments(&thin, 1.0, 1e200, 1.0, &a, &b), ILSA_ERR_VALUE); /* M1 */
    assert_int_equal(ilsa_tip_distance(&thin, 1e300, 1.0, 1e-300, &a, &b), ILSA_ERR_VALUE);
    assert_true(a == UNTOUCHED && b == UNTOUCHED);
    /* the largest that is not */
    assert_int_equal(ilsa_tip_moments(&thin, 0.0, 1.0, DBL_MAX, &a, &b), ILSA_OK);
    assert_below(relative(a, DBL_MAX / 1.5), 1e-15);
}

static void results_below_the_range_are_rounded(void **state) {
    (void)state;
    const ilsa_material_def stiff = {1e300, 0.0, 1e-20, 0.0}, little = {1.0, 1e-300, 1e-300, 0.0};
    double a, b;
    assert_int_equal(ilsa_tip_width(&stiff, 1e-300, 1.0, &a), ILSA_OK);
    assert_below(fabs(a - 1e-320), DBL_TRUE_MIN);
    assert_int_equal(ilsa_tip_width(&stiff, 1e-300, 1e-10, &a), ILSA_OK);
    assert_true(a == 0.0);
    assert_int_equal(ilsa_tip_moments(&little, 0.0, 1e-200, 1e-200, &a, &b), ILSA_OK);
    assert_true(a == 0.0 && b == 0.0);
    /* a front so slow that V is subnormal or nothing still stands where it does */
    assert_int_equal(ilsa_tip_distance(&little, 1.0, 1.0, 1e308, &a, &b), ILSA_OK);
    assert_true(a >= 1.0 && b >= 0.0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scaled_functions_raise_nothing),
        cmocka_unit_test(widths_and_moments_raise_nothing),
        cmocka_unit_test(distances_raise_nothing),
        cmocka_unit_test(inner_functions_raise_nothing),
        cmocka_unit_test(widths_grow_with_distance_and_velocity),
        cmocka_unit_test(distances_put_back_give_the_width),
        cmocka_unit_test(distances_grow_with_the_width),
        cmocka_unit_test(powers_of_two_are_units_to_the_last_bit),
        cmocka_unit_test(results_above_the_range_are_refused),
        cmocka_unit_test(results_below_the_range_are_rounded),
    };
    return cmocka_run_group_tests_name("tip range", tests, NULL, NULL);
}
