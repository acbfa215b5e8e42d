#include "tip/asymptote.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/*
 * Everything rests on F(K, B) = integral of u^3 / (u + B) over [K, 1]: three times F is the bracket
 * of (3.11), without the terms that cancel in it. What is computed is
 *     G(K, B) = (1 + B) F(K, B) = integral of u^3 / (omega + theta u) over [K, 1],
 *     theta = 1 / (1 + B), omega = B / (1 + B),
 * between 0 and 1/3 for every B of the double range. (3.13) is Delta = G(K, b0 C), and (3.14) is
 * g_delta = theta G(K, b C) / C1(Delta). kappa = 1 - K is carried as its own number, because K has
 * lost it near the toughness vertex.
 */

#define PI        3.141592653589793
#define LN_2      0.69314718055994531
#define BETA_M    3.1473451902649446 /* (3.3) */
#define BETA_MT   2.5335594408265696
#define BETA_M3   31.176914536239791  /* beta_m^3 */
#define B0_PER_C  0.99117998230567239 /* 3 beta_mt^4 / (4 beta_m^3) of (3.6) */
#define MOMENT_P0 0.377               /* after (3.18) */
#define MOMENT_P1 0.260

/*
 * Newton in ln x ends where step^2 times the step before (1 for the first), the error to come, is
 * below this; and in a row of widths, each begun from the last, where 1e-12 of a width will do.
 */
#define LAST_STEP   1e-14
#define LAST_IN_ROW 1e-12
#define NEWTON_MOST 20
#define ROUNDING    1e-14

/* Part of the first distance of a row below which nothing depends on more than its power law. */
#define ROW_NEAR 1e-3

/* Where a root is looked for, and the largest step in ln x: x exp(STEP_MOST) is in range. */
#define X_LEAST   1e-250
#define X_MOST    1e250
#define STEP_MOST 130.0

/* G(K, B) and what its derivatives are made of. */
typedef struct tip_bracket {
    double G, theta, omega;
    double by_kappa; /* dG / d ln kappa = (1 + B) dF / d ln kappa */
    double by_B;     /* (1 + B) dF / d ln B, <= 0 */
} tip_bracket;

/* g_delta and the derivatives of its logarithm. */
typedef struct tip_g {
    double g;
    double by_kappa; /* d ln g / d ln kappa at constant C */
    double by_C;     /* d ln g / d ln C at constant K */
} tip_g;

/* C1(delta) of (3.9) with the derivative of its logarithm. */
typedef struct tip_factor {
    double value, dlog;
} tip_factor;

/* The value of an increasing function of ln x and its slope; d ln V / d ln w. */
typedef struct tip_residual {
    double value, slope, v_by_w;
} tip_residual;

typedef tip_residual (*tip_equation)(const void *problem, double x);

/*
 * Sum of the Gauss-Legendre rule for G, two nodes m +- h x a term: one division for both, and
 * all numbers positive. node2 = x^2.
 */
static inline double gauss_sum(int pairs, const double *node2, const double *weight, double kappa,
                               double theta, double omega) {
    const double h = 0.5 * kappa, m = 1.0 - h, m2 = m * m, h2 = h * h;
    const double middle = omega + theta * m, middle2 = middle * middle, theta2 = theta * theta;
    double term[8];
    for (int j = 0; j < pairs; j++) {
        const double q = h2 * node2[j];
        term[j] = weight[j] * (theta * (m2 - q) * (m2 + q) + omega * m * (m2 + 3.0 * q)) /
                  (middle2 - theta2 * q);
    }
    double sum = 0.0;
    for (int j = 0; j < pairs / 2; j++) {
        sum += term[j] + term[j + pairs / 2];
    }
    return kappa * sum;
}

static double gauss_8(double kappa, double theta, double omega) {
    static const double node2[4] = {0.033648268067506853, 0.27618431387246444, 0.63467747623463664,
                                    0.92215660849205873};
    static const double weight[4] = {0.36268378337836198, 0.31370664587788729, 0.22238103445337447,
                                     0.10122853629037626};
    return gauss_sum(4, node2, weight, kappa, theta, omega);
}

static double gauss_16(double kappa, double theta, double omega) {
    static const double node2[8] = {
        0.0090273770256471514, 0.079300559811486653, 0.20977936861551007, 0.38177105339711555,
        0.57063582016217218,   0.74931737854740332,  0.89222197421379785, 0.97891421016235110};
    static const double weight[8] = {
        0.18945061045506850, 0.18260341504492359,  0.16915651939500254,  0.14959598881657673,
        0.12462897125553387, 0.095158511682492785, 0.062253523938647893, 0.027152459411754095};
    return gauss_sum(8, node2, weight, kappa, theta, omega);
}

/* (3.11) as printed: exact enough where B is small, and needed where the pole is near u = K. */
static double bracket_printed(double K, double kappa, double B) {
    const double logarithm = B > 1e-30 ? B * B * B * log1p(kappa / (K + B)) : 0.0;
    const double cubic = kappa * (1.0 + K + K * K) / 3.0;
    return (1.0 + B) * (cubic - 0.5 * B * kappa * (1.0 + K) + B * B * kappa - logarithm);
}

static tip_bracket bracket(double K, double kappa, double B) {
    tip_bracket f = {.theta = 1.0 / (1.0 + B), .by_kappa = 0.0, .by_B = 0.0};
    f.omega = B * f.theta;
    if (K + B >= 2.0 * kappa) {
        f.G = gauss_8(kappa, f.theta, f.omega);
    } else if (B < 0.3 && K < 0.2) {
        f.G = bracket_printed(K, kappa, B);
    } else {
        f.G = gauss_16(kappa, f.theta, f.omega);
    }
    const double pole = f.theta * K + f.omega;
    if (pole > 0.0) {
        /* Euler's relation for F, homogeneous of degree 3 in B and both ends of the integral. */
        const double K2 = K * K;
        const double ends = f.theta * K * (1.0 + K + K2) + f.omega * (1.0 + K) * (1.0 + K2);
        f.by_kappa = kappa * K2 * K / pole;
        f.by_B = 3.0 * f.G - kappa * ends / pole;
    }
    return f;
}

/*
 * C1 = 4 pi (1 + d) / (1 + 2 d) T(d^2) with T(y) = tan(pi d) (1 - 4 d^2) / (pi d (1 - d^2)), free
 * of singularities for d < 3/2; T is its interpolating polynomial on 0 <= d <= 1/2 (error 4e-17).
 */
static tip_factor factor_C1(double d) {
    static const double even[6] = {1.0,
                                   0.11827440344686072,
                                   0.022590987654849883,
                                   0.004446133360434121,
                                   0.0009140707208492647,
                                   0.0003281727954294107};
    static const double odd[6] = {0.2898681336964368,    0.05125534635745701,   0.01001146147298533,
                                  0.0019670205351392306, 0.0002871593567395032, 0.0};
    /* T = E(y^2) + y O(y^2): two short chains of operations instead of a long one. */
    const double y = d * d, z = y * y;
    double E = even[5], dE = 0.0, O = odd[5], dO = 0.0;
    for (int k = 4; k >= 0; k--) {
        dE = dE * z + E;
        dO = dO * z + O;
        E = E * z + even[k];
        O = O * z + odd[k];
    }
    const double T = E + y * O, dT = O + 2.0 * y * (dE + y * dO);
    return (tip_factor){4.0 * PI * (1.0 + d) / (1.0 + 2.0 * d) * T,
                        1.0 / (1.0 + d) - 2.0 / (1.0 + 2.0 * d) + 2.0 * d * dT / T};
}

/* (3.14) with the whole derivative, that of Delta included. C2(delta) of (3.9) is C1(1.5 delta). */
static tip_g g_delta(double K, double kappa, double C) {
    const tip_bracket zeroth = bracket(K, kappa, B0_PER_C * C);
    const double delta = zeroth.G; /* (3.13) */
    const tip_factor C1 = factor_C1(delta), C2 = factor_C1(1.5 * delta);
    const tip_bracket f = bracket(K, kappa, C * (C2.value / C1.value));
    const double by_b = f.by_B / f.G;
    const double by_delta = by_b * (1.5 * C2.dlog - C1.dlog) - C1.dlog;
    return (tip_g){f.theta * f.G / C1.value, f.by_kappa / f.G + by_delta * zeroth.by_kappa,
                   by_b + by_delta * (zeroth.omega * zeroth.G + zeroth.by_B)};
}

/* (3.17) with s = g0 (beta_m^3 + beta_mt^4 C) = (3 + 4 b0 C) F, for p[0] and p[1]. */
static void delta_p(double K, double C, const double p[2], double delta[2]) {
    delta[0] = delta[1] = 0.0;
    if (K >= 1.0) {
        return;
    }
    const tip_bracket f = bracket(K, 1.0 - K, B0_PER_C * C);
    for (int k = 0; k < 2; k++) {
        delta[k] = (1.0 - p[k] + p[k] * (4.0 - f.theta) * f.G) * f.G;
    }
}

/*
 * Root of an increasing function of ln x, or the end of the range beyond which it lies: Newton,
 * kept inside the interval that it has found, and bisection should Newton fail. The second
 * derivative that two slopes give makes the last step one of third order.
 */
static double solve(tip_equation equation, const void *problem, double x, double last_step,
                    tip_residual *last) {
    double low = X_LEAST, high = X_MOST, before = 1.0, slope_before = 0.0;
    x = fmin(fmax(x, low), high);
    for (int k = 0; low < high * (1.0 - ROUNDING); k++) {
        *last = equation(problem, x);
        const double step = -last->value / last->slope;
        if (step * step * fabs(before) < last_step) {
            const double curvature = k > 0 ? (last->slope - slope_before) / before : 0.0;
            const double corrected = step - 0.5 * curvature / last->slope * step * step;
            return x + x * (corrected + 0.5 * corrected * corrected);
        }
        if (last->value > 0.0) {
            high = x;
        } else {
            low = x;
        }
        x *= exp(fmin(step, STEP_MOST));
        before = step;
        slope_before = last->slope;
        if (k >= NEWTON_MOST || !(x > low && x < high)) {
            x = sqrt(low) * sqrt(high);
            before = 1.0;
        }
    }
    return high < X_MOST ? (low > X_LEAST ? x : X_LEAST) : X_MOST;
}

/*
 * (3.15) for the width at s: w_k the toughness width, C_hat = a / w, s_hat = m3 / w^3.
 * The unknown is e = w - w_k > 0.
 */
typedef struct width_problem {
    double w_k, a, m3;
} width_problem;

static tip_residual width_residual(const void *problem, double e) {
    const width_problem *p = problem;
    const double w = p->w_k + e, K = p->w_k / w, kappa = e / w;
    const tip_g f = g_delta(K, kappa, p->a / w);
    const double slope = f.by_kappa * K + kappa * (3.0 - f.by_C);
    return (tip_residual){.value = log(f.g * (w * w * w) / p->m3),
                          .slope = slope,
                          .v_by_w = slope / (kappa * (1.0 + 0.5 * f.by_C))};
}

/*
 * e with F taken as (1 - K^4) / (4 (u + B)), 3/4 <= u <= 1, and C1 as linear in delta: the sum of
 * the fourth powers of (3.3) first, then (3.11) once.
 */
static double width_start(const width_problem *p) {
    const double w_k2 = p->w_k * p->w_k, w_m3 = BETA_M3 * p->m3, b = B0_PER_C * p->a;
    const double first = sqrt(sqrt(w_k2 * w_k2 + w_m3 * (cbrt(w_m3) + 4.0 / 3.0 * b)));
    const double K = p->w_k / first, K2 = K * K, B = b / first;
    const double u = 0.75 * (1.0 + K) * (1.0 + K2) / (1.0 + K + K2);
    const double delta = 0.25 * (1.0 - K2 * K2) * (1.0 + B) / (u + B);
    const double rise = 4.0 * (4.0 * PI - 6.5 * delta) * p->m3 * (u * first + b);
    const double w2 = sqrt(w_k2 * w_k2 + rise);
    return rise / ((sqrt(w2) + p->w_k) * (w2 + w_k2));
}

static double width_solve(const width_problem *p) {
    tip_residual last;
    return p->w_k + solve(width_residual, p, width_start(p), LAST_STEP, &last);
}

/* Within this range no product below overflows, and none that matters vanishes. */
static inline bool is_plain(double x) {
    return x >= 1e-30 && x <= 1e30;
}

static inline bool is_plain_law(const ilsa_material_def *law) {
    return is_plain(law->E_prime) && (is_plain(law->mu_prime) || law->mu_prime == 0.0) &&
           (is_plain(law->K_prime) || law->K_prime == 0.0) &&
           (is_plain(law->C_prime) || law->C_prime == 0.0);
}

/* Beyond it, a number >= 0 of any size, m 2^e: the bits are those of the same sums in range. */
typedef struct wide {
    double m; /* 0, or 1/2 <= m < 1 */
    int e;
} wide;

static wide widen(double x) {
    wide a;
    a.m = frexp(x, &a.e);
    return a;
}

static wide shifted(double x, int e) {
    wide a = widen(x);
    a.e += e;
    return a;
}

static wide times(wide a, wide b) {
    return shifted(a.m * b.m, a.e + b.e);
}

static wide over(wide a, wide b) {
    return shifted(a.m / b.m, a.e - b.e);
}

static wide root_of(wide a) {
    const int odd = a.e % 2 != 0;
    return shifted(sqrt(odd ? 2.0 * a.m : a.m), (a.e - odd) / 2);
}

/* In units of 2^e. */
static double narrow(wide a, int e) {
    return ldexp(a.m, a.e - e);
}

/* Binary exponents are limited to this: beyond it a ratio is as good as infinite. */
#define BITS_MOST 865

static double limited(wide a) {
    return ldexp(a.m, a.e < BITS_MOST ? a.e : BITS_MOST);
}

/* Where C_hat is beyond 2^332 only its product with s_hat matters: by how much it is. */
#define BITS_C_MOST 332

static int excess_of(wide C, int unit) {
    const int excess = C.e - unit - BITS_C_MOST;
    return C.m > 0.0 && excess > 0 ? excess : 0;
}

/* The larger of an exponent and that of a, which is raised to 1 / power; nothing where a is 0. */
static int larger_exponent(int e, wide a, int power) {
    const int other = a.e / power;
    return a.m > 0.0 && other > e ? other : e;
}

/* The width for any arguments, in units near the largest vertex width (3.3). */
static double width_beyond(const ilsa_material_def *law, double V, double s) {
    const wide E = widen(law->E_prime), s_wide = widen(s), root = root_of(s_wide);
    const wide w_k = times(over(widen(law->K_prime), E), root);
    if (V <= 0.0 || law->mu_prime == 0.0) {
        return narrow(w_k, 0);
    }
    const wide V_wide = widen(V);
    const wide a = over(times(shifted(law->C_prime, 1), root), root_of(V_wide));
    const wide m3 = times(times(times(over(widen(law->mu_prime), E), V_wide), s_wide), s_wide);
    if (!(m3.m > 0.0)) {
        return narrow(w_k, 0);
    }
    int unit = larger_exponent(m3.e / 3, w_k, 1);
    unit = larger_exponent(unit, times(m3, a), 4);
    const int excess = excess_of(a, unit), unit3 = 3 * unit - excess;
    if (m3.e - unit3 < -BITS_MOST) {
        return narrow(w_k, 0);
    }
    const width_problem p = {narrow(w_k, unit), narrow(a, unit + excess), narrow(m3, unit3)};
    return ldexp(width_solve(&p), unit);
}

static width_problem plain_problem(const ilsa_material_def *law, double V, double s) {
    const double root = sqrt(s);
    return (width_problem){law->K_prime / law->E_prime * root, 2.0 * law->C_prime * root / sqrt(V),
                           law->mu_prime / law->E_prime * V * s * s};
}

double ilsai_asymptote_width(const ilsa_material_def *law, double V, double s) {
    if (!is_plain_law(law) || !is_plain(s) || !(is_plain(V) || V == 0.0)) {
        return width_beyond(law, V, s);
    }
    if (V == 0.0 || law->mu_prime == 0.0) {
        return law->K_prime / law->E_prime * sqrt(s);
    }
    const width_problem p = plain_problem(law, V, s);
    return width_solve(&p);
}

/* K_hat and C_hat of (3.10) for V > 0; a width below the range counts as its smallest. */
static void scaled_variables(const ilsa_material_def *law, double V, double s, double w, double *K,
                             double *C) {
    if (is_plain_law(law) && is_plain(V) && is_plain(s) && is_plain(w)) {
        const double root = sqrt(s) / w;
        *K = law->K_prime / law->E_prime * root;
        *C = 2.0 * law->C_prime / sqrt(V) * root;
        return;
    }
    const wide root = over(root_of(widen(s)), widen(fmax(w, DBL_MIN)));
    *K = limited(times(over(widen(law->K_prime), widen(law->E_prime)), root));
    *C = limited(times(over(shifted(law->C_prime, 1), root_of(widen(V))), root));
}

void ilsai_asymptote_moments(const ilsa_material_def *law, double V, double s, double w, double *M0,
                             double *M1) {
    double delta[2] = {0.0, 0.0};
    if (V > 0.0 && law->mu_prime > 0.0) {
        double K, C;
        scaled_variables(law, V, s, w, &K, &C);
        delta_p(K, C, (double[]){MOMENT_P0, MOMENT_P1}, delta);
    }
    *M0 = w / (1.5 + 0.5 * delta[0]) * s; /* nothing on the way is beyond range before them */
    *M1 = w / (2.5 + 0.5 * delta[1]) * s * s;
}

/* From ln(g_delta w^3) = ln(mu' V s^2 / E'), C_hat falling with the root of V. */
static double velocity_exponent(double K, double C) {
    if (!(K < 1.0)) {
        return 0.0;
    }
    const tip_g f = g_delta(K, 1.0 - K, C);
    return (1.0 + 0.5 * f.by_C) / (3.0 + f.by_kappa * K / (1.0 - K) - f.by_C);
}

/* A width with what (3.18) and the exponent need; next is d ln(w - w_k) / d ln s. */
static asymptote_point point_at(double K, double C, double s, double w, double *next) {
    double delta[2];
    delta_p(K, C, (double[]){0.0, MOMENT_P0}, delta);
    *next = K < 1.0 ? 0.5 + 0.5 * delta[0] / (1.0 - K) : 1.0;
    return (asymptote_point){
        .w = w, .M0 = 2.0 * w * s / (3.0 + delta[1]), .exponent = 0.5 * (1.0 + delta[0])};
}

static bool is_plain_row(const ilsa_material_def *law, double V, int count, const double *s) {
    bool plain = V > 0.0 && is_plain_law(law) && law->mu_prime > 0.0 && is_plain(V);
    for (int k = 0; k < count; k++) {
        plain = plain && is_plain(s[k]);
    }
    return plain;
}

/* One point of a row of any arguments; next as in point_at. */
static asymptote_point point_alone(const ilsa_material_def *law, double V, double s, double *next) {
    const double w = ilsai_asymptote_width(law, V, s);
    *next = 1.0;
    if (!(V > 0.0 && law->mu_prime > 0.0)) {
        return (asymptote_point){w, 2.0 / 3.0 * w * s, 0.5, 0.0};
    }
    double K, C;
    scaled_variables(law, V, s, w, &K, &C);
    asymptote_point point = point_at(K, C, s, w, next);
    point.by_V = velocity_exponent(K, C);
    return point;
}

/* The point before, taken on to the distance s, where the width is w. */
static asymptote_point taken_on(const asymptote_point *before, double s_before, double s,
                                double w) {
    asymptote_point point = *before;
    point.M0 *= w * s / (before->w * s_before);
    point.w = w;
    return point;
}

/* A row of any arguments: as the others, but for widths found alone. */
static void any_row(const ilsa_material_def *law, double V, int count, const double *s,
                    asymptote_point *point) {
    double exponent = 1.0;
    for (int k = 0; k < count; k++) {
        if (V > 0.0 && s[k] < ROW_NEAR * s[0]) {
            const double e = point[k - 1].w - ilsai_asymptote_width(law, 0.0, s[k - 1]);
            const double more = e * pow(s[k] / s[k - 1], exponent);
            point[k] = taken_on(&point[k - 1], s[k - 1], s[k],
                                ilsai_asymptote_width(law, 0.0, s[k]) + more);
        } else {
            point[k] = point_alone(law, V, s[k], &exponent);
        }
    }
}

void ilsai_asymptote_row(const ilsa_material_def *law, double V, int count, const double *s,
                         asymptote_point *point) {
    if (!is_plain_row(law, V, count, s)) {
        any_row(law, V, count, s, point);
        return;
    }
    double exponent = 1.0, e = 0.0;
    for (int k = 0; k < count; k++) {
        const width_problem p = plain_problem(law, V, s[k]);
        e = k == 0 ? width_start(&p) : e * pow(s[k] / s[k - 1], exponent);
        if (s[k] < ROW_NEAR * s[0]) {
            point[k] = taken_on(&point[k - 1], s[k - 1], s[k], p.w_k + e);
            continue;
        }
        tip_residual last = {0};
        e = solve(width_residual, &p, e, k == 0 ? LAST_STEP : LAST_IN_ROW, &last);
        const double w = p.w_k + e;
        point[k] = point_at(p.w_k / w, p.a / w, s[k], w, &exponent);
        point[k].by_V = last.v_by_w > 0.0 ? 1.0 / last.v_by_w : 0.0;
    }
}

double ilsai_asymptote_exponent(const ilsa_material_def *law, double V, double s, double w) {
    double delta[2] = {0.0, 0.0};
    if (V > 0.0) {
        double K, C;
        scaled_variables(law, V, s, w, &K, &C);
        delta_p(K, C, (double[]){0.0, 0.0}, delta);
    }
    return 0.5 * (1.0 + delta[0]);
}

/*
 * (4.9) in units of s0: K0 and C0 are K_hat at s0 and C_hat for V = s0 / dt, m0 likewise s_hat.
 * With xi = v / s0 the unknown is x, 1 / x = 1 / xi - 1 / xi_most, which runs from 0 to infinity
 * between arrest and the distance where K_hat = 1.
 */
typedef struct distance_problem {
    double K0, C0, log_m0;
    double gap;     /* 1 - K0^2 */
    double xi_rate; /* 1 / xi_most = K0^2 / (1 - K0^2) */
} distance_problem;

static tip_residual distance_residual(const void *problem, double x) {
    const distance_problem *p = problem;
    const double xi = 1.0 / (1.0 / x + p->xi_rate), f = xi / x, S = 1.0 + xi, root = sqrt(S);
    const double K = p->K0 * root, kappa = p->gap * f / (1.0 + K);
    const tip_g h = g_delta(K, kappa, p->C0 * root / sqrt(xi));
    const double by_K = h.by_kappa * K / kappa;
    const double log_s = S < 1e30 && h.g > 1e-100
                             ? log(xi * (S * S) / h.g)
                             : log(xi) + 2.0 * log(S) - log(fmax(h.g, DBL_MIN));
    const double by_xi = 1.0 + (0.5 * h.by_C + xi * (0.5 * by_K + 2.0)) / S;
    return (tip_residual){
        .value = p->log_m0 + log_s, .slope = f * by_xi, .v_by_w = (3.0 + by_K - h.by_C) / by_xi};
}

/* Logarithms are limited to this before exp. */
#define LOG_MOST 600.0

/* The sum of the inverses of the vertex solutions of (4.9), each of its two limits in xi. */
static double distance_start(const distance_problem *p) {
    const double m = fmin(p->log_m0 + log(BETA_M3), LOG_MOST);
    double inverse = exp(m) + exp(m / 3.0);
    if (p->C0 > 0.0) {
        const double mt = fmin(2.0 * (m + log(4.0 / 3.0 * B0_PER_C * p->C0)), LOG_MOST);
        inverse += exp(mt) + exp(mt / 6.0);
    }
    return 1.0 / fmax(inverse, 1.0 / X_MOST);
}

/* K0, C0 and m0 for any arguments; false where K0 >= 1. */
static bool distance_beyond(distance_problem *p, const ilsa_material_def *law, double w, double s0,
                            double dt) {
    const wide w_wide = widen(w), r = over(widen(s0), w_wide), E = widen(law->E_prime);
    const wide K0 = over(times(over(widen(law->K_prime), E), root_of(widen(s0))), w_wide);
    const wide C0 = over(times(shifted(law->C_prime, 1), root_of(widen(dt))), w_wide);
    const wide r3 = times(times(r, r), r);
    const wide m0 = over(times(over(widen(law->mu_prime), E), r3), widen(dt));
    const int excess = excess_of(C0, 0);
    p->K0 = limited(K0);
    p->C0 = narrow(C0, excess);
    p->log_m0 = log(m0.m) + LN_2 * (m0.e + excess);
    return p->K0 < 1.0;
}

static bool distance_plain(distance_problem *p, const ilsa_material_def *law, double w, double s0,
                           double dt) {
    const double r = s0 / w;
    p->K0 = law->K_prime / law->E_prime * sqrt(s0) / w;
    p->C0 = 2.0 * law->C_prime * sqrt(dt) / w;
    p->log_m0 = log(law->mu_prime / law->E_prime * (r * r * r) / dt);
    return p->K0 < 1.0;
}

/* (4.9) by toughness alone, whatever the velocity: w = K' s^(1/2) / E'. */
static asymptote_front distance_of_toughness(const ilsa_material_def *law, double w, double s0,
                                             double dt) {
    double s;
    if (is_plain_law(law) && is_plain(w)) {
        const double root = law->E_prime * w / law->K_prime;
        s = root * root;
    } else {
        const wide root = over(times(widen(law->E_prime), widen(w)), widen(law->K_prime));
        s = narrow(times(root, root), 0);
    }
    if (!(s > s0)) {
        return (asymptote_front){s0, 0.0, 0.0};
    }
    return (asymptote_front){s, (s - s0) / dt, limited(over(shifted(s, 1), widen(w)))};
}

/* From a distance that may be near the one sought, if it lies where one can be. */
static double distance_guess(const distance_problem *p, double xi) {
    const double inverse = xi > 0.0 ? 1.0 / xi - p->xi_rate : 0.0;
    return inverse > 0.0 ? 1.0 / inverse : distance_start(p);
}

asymptote_front ilsai_asymptote_distance(const ilsa_material_def *law, double w, double s0,
                                         double dt) {
    return ilsai_asymptote_distance_near(law, w, s0, dt, s0);
}

asymptote_front ilsai_asymptote_distance_near(const ilsa_material_def *law, double w, double s0,
                                              double dt, double near) {
    distance_problem p;
    if (law->mu_prime == 0.0) {
        return distance_of_toughness(law, w, s0, dt);
    }
    const bool plain = is_plain_law(law) && is_plain(w) && is_plain(s0) && is_plain(dt);
    if (!(plain ? distance_plain(&p, law, w, s0, dt) : distance_beyond(&p, law, w, s0, dt))) {
        return (asymptote_front){s0, 0.0, 0.0};
    }
    p.gap = (1.0 - p.K0) * (1.0 + p.K0);
    p.xi_rate = p.K0 * p.K0 / p.gap;
    tip_residual last = {0};
    const double x =
        solve(distance_residual, &p, distance_guess(&p, (near - s0) / s0), LAST_STEP, &last);
    if (x <= X_LEAST) { /* beyond the double range, both ways */
        return (asymptote_front){s0, 0.0, 0.0};
    }
    if (x >= X_MOST && p.xi_rate < 1e-200) {
        return (asymptote_front){HUGE_VAL, HUGE_VAL, 0.0};
    }
    const double per_xi = 1.0 / x + p.xi_rate, v = s0 / per_xi;
    if (plain) {
        return (asymptote_front){s0 + v, v / dt, last.v_by_w * v / w};
    }
    const wide far = over(widen(s0), widen(per_xi)); /* v, which may be too small */
    return (asymptote_front){s0 + v, narrow(over(far, widen(dt)), 0),
                             limited(times(widen(last.v_by_w), over(far, widen(w))))};
}

static bool is_positive(double x) {
    return x > 0.0 && x <= DBL_MAX;
}

static bool is_not_negative(double x) {
    return x >= 0.0 && x <= DBL_MAX;
}

static bool is_law(const ilsa_material_def *law) {
    const bool ruled = is_positive(law->mu_prime) || (law->mu_prime == 0.0 && law->K_prime > 0.0);
    return is_positive(law->E_prime) && ruled && is_not_negative(law->K_prime) &&
           is_not_negative(law->C_prime);
}

/* A width that ilsa_tip_width can give: zero is one without toughness and at rest. */
static bool is_width(const ilsa_material_def *law, double V, double w) {
    return is_positive(w) || (w == 0.0 && V == 0.0 && law->K_prime == 0.0);
}

double ilsa_tip_g_delta(double K_hat, double C_hat) {
    if (!is_not_negative(K_hat) || !is_not_negative(C_hat)) {
        return NAN;
    }
    return K_hat < 1.0 ? g_delta(K_hat, 1.0 - K_hat, C_hat).g : 0.0;
}

double ilsa_tip_delta_p(double K_hat, double C_hat, double p) {
    if (!is_not_negative(K_hat) || !is_not_negative(C_hat) || !(p >= 0.0 && p <= 1.0)) {
        return NAN;
    }
    double delta[2];
    delta_p(K_hat, C_hat, (double[]){p, p}, delta);
    return delta[0];
}

ilsa_status ilsa_tip_width(const ilsa_material_def *scaled, double V, double s, double *w) {
    if (!scaled || !w) {
        return ILSA_ERR_NULL;
    }
    if (!is_law(scaled) || !is_not_negative(V) || !is_positive(s)) {
        return ILSA_ERR_VALUE;
    }
    const double width = ilsai_asymptote_width(scaled, V, s);
    if (!is_not_negative(width)) { /* beyond the double range */
        return ILSA_ERR_VALUE;
    }
    *w = width;
    return ILSA_OK;
}

ilsa_status ilsa_tip_moments(const ilsa_material_def *scaled, double V, double s, double w,
                             double *M0, double *M1) {
    if (!scaled || !M0 || !M1) {
        return ILSA_ERR_NULL;
    }
    if (!is_law(scaled) || !is_not_negative(V) || !is_positive(s) || !is_width(scaled, V, w)) {
        return ILSA_ERR_VALUE;
    }
    double zeroth, first;
    ilsai_asymptote_moments(scaled, V, s, w, &zeroth, &first);
    if (!is_not_negative(zeroth) || !is_not_negative(first)) {
        return ILSA_ERR_VALUE;
    }
    *M0 = zeroth;
    *M1 = first;
    return ILSA_OK;
}

ilsa_status ilsa_tip_distance(const ilsa_material_def *scaled, double w, double s0, double dt,
                              double *s, double *V) {
    if (!scaled || !s || !V) {
        return ILSA_ERR_NULL;
    }
    if (!is_law(scaled) || !is_positive(w) || !is_positive(s0) || !is_positive(dt)) {
        return ILSA_ERR_VALUE;
    }
    const asymptote_front front = ilsai_asymptote_distance(scaled, w, s0, dt);
    if (!is_positive(front.s) || !is_not_negative(front.V)) {
        return ILSA_ERR_VALUE;
    }
    *s = front.s;
    *V = front.V;
    return ILSA_OK;
}

enum { VERTEX_K, VERTEX_MT, VERTEX_M, VERTICES };

static double log_or_minus_infinity(double x) {
    return x > 0.0 ? log(x) : -HUGE_VAL;
}

/* Logarithms of the vertex widths (3.3) over w. */
static void vertex_ratios(const ilsa_material_def *law, double V, double s, double w,
                          double ratio[VERTICES]) {
    const double log_w = log(w), log_s = log(s), log_E = log(law->E_prime);
    const double log_V = log(V), log_mu = log_or_minus_infinity(law->mu_prime);
    const double log_K = log_or_minus_infinity(law->K_prime);
    const double log_C = log(2.0) + log_or_minus_infinity(law->C_prime);
    ratio[VERTEX_K] = log_K - log_E + 0.5 * log_s - log_w;
    ratio[VERTEX_MT] =
        log(BETA_MT) + 0.25 * (log_mu + 0.5 * log_V + log_C - log_E) + 0.625 * log_s - log_w;
    ratio[VERTEX_M] = log(BETA_M) + (log_mu + log_V - log_E + 2.0 * log_s) / 3.0 - log_w;
}

/*
 * (3.19) times the product of the three differences, which removes its singularities. A vertex at
 * or above w (the closed form can be 0.14 % below one) takes all; of several the highest.
 */
static void shape_functions(const double ratio[VERTICES], double N[VERTICES]) {
    int top = VERTEX_K;
    for (int i = 0; i < VERTICES; i++) {
        if (ratio[i] > ratio[top]) {
            top = i;
        }
    }
    double sum = 0.0;
    for (int i = 0; i < VERTICES; i++) {
        const int j = (i + 1) % VERTICES, k = (i + 2) % VERTICES;
        N[i] = exp(ratio[i] - ratio[top]);
        if (ratio[top] < 0.0) {
            N[i] *= expm1(ratio[j]) * expm1(ratio[k]);
        } else if (i != top) {
            N[i] = 0.0;
        }
        sum += N[i];
    }
    for (int i = 0; i < VERTICES; i++) {
        N[i] /= sum;
    }
}

ilsa_status ilsa_tip_triangle(const ilsa_material_def *scaled, double V, double s, double w,
                              ilsa_tip_regime *regime) {
    if (!scaled || !regime) {
        return ILSA_ERR_NULL;
    }
    if (!is_law(scaled) || !is_not_negative(V) || !is_positive(s) || !is_width(scaled, V, w)) {
        return ILSA_ERR_VALUE;
    }
    double N[VERTICES] = {[VERTEX_K] = 1.0};
    if (V > 0.0) {
        double ratio[VERTICES];
        vertex_ratios(scaled, V, s, w, ratio);
        shape_functions(ratio, N);
    }
    *regime = (ilsa_tip_regime){.N_k = N[VERTEX_K],
                                .N_mt = N[VERTEX_MT],
                                .N_m = N[VERTEX_M],
                                .x = N[VERTEX_K] + 0.5 * N[VERTEX_MT],
                                .y = 0.5 * sqrt(3.0) * N[VERTEX_MT]};
    return ILSA_OK;
}
