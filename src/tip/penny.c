/*
 * The penny-shaped fracture, from the integral form of its equations.
 *
 * Units: the length (Q t)^(1/3), the time t and the stress E' leave mu', K' and C' as the only
 * numbers, and none of them is divided by. With rho = r / R, s = 1 - rho and g = -dp/drho, Abel's
 * inversion of (2.2) for a circle, integrated by parts, reads
 *
 *   w(rho) = (8 R / pi) [ m sqrt(1 - rho^2) + int_0^1 H(rho, y) g(y) dy ],
 *   H(rho, y) = y^2 int_1^(1 / max(rho, y)) sqrt((1 - rho^2 v^2) / (1 - y^2 v^2)) dv,
 *
 * and (2.3) with (2.5) integrated from the tip inwards gives g = R mu' q / w^3. The number m, which
 * is the stress intensity left to what happens outside the outermost node, is found from the tip
 * asymptote (3.15) there, so that no tip scale has to be resolved. All terms are positive and the
 * right-hand side falls when w rises: relaxed substitution in ln w converges from anywhere.
 * The radius follows from the volume balance. The seven steps in ln t that lead to the time asked
 * for supply the exponents of growth and the trigger times; they begin with a power law.
 */
#include "tip/penny.h"

#include "base/gauss.h"

#include "tip/asymptote.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define PI 3.14159265358979323846

enum {
    NODES = ILSAI_PENNY_NODES,
    LAST = NODES - 1, /* the node next to the tip; node 0 is the source */
    GAUSS = 3,        /* points a panel between nodes */
    INNER = GAUSS * LAST,
    TIP_PANELS = 4, /* between the outermost node and TIP_DEPTH */
    SAMPLES = INNER + GAUSS * TIP_PANELS,
    ANGLES = GAUSS8_POINTS, /* points for H */
    STENCIL = 4
};

/* The outermost node stands at s = exp(-DEPTH), close enough to the tip for (3.15). */
static const double DEPTH = 8.0;
/* Flow beyond this acts on the nodes as a stress intensity does, and is contained in m. */
static const double TIP_DEPTH = 16.0;
/* The width of a step in ln t. */
static const double LOG_STEP = 0.75;

/* Radii of the vertex solutions, in units of the parameters that matter there. */
static const double VISCOSITY_RADIUS = 0.69783755, TOUGHNESS_RADIUS = 0.85463870,
                    LEAK_OFF_RADIUS = 0.45015816;

static const double GAUSS3_X[GAUSS] = {0.11270166537925831, 0.5, 0.88729833462074169};
static const double GAUSS3_W[GAUSS] = {0.27777777777777778, 0.44444444444444444,
                                       0.27777777777777778};
/* A quadrature point between nodes: fields there are sums of weight[k] field[node + k]. */
typedef struct sample {
    int node;
    double weight[STENCIL];
    double rho, s;
    double measure; /* its share of d rho */
} sample;

typedef struct grid {
    double rho[NODES], s[NODES];
    double
        flow_scale[NODES]; /* s^(4/3): f = rho s^(4/3) g varies slowly, tip and source included */
    sample samples[SAMPLES];
    double width_of_f[NODES][NODES];    /* the integral of H g for the nodal values of f */
    double pressure_of_f[NODES][NODES]; /* p - m; row 0, where p is infinite, is not used */
} radial_grid;

/* Nodes are dense at the source and geometric at the tip: -ln s as a function of their index. */
static double depth_of_index(double zeta) {
    return DEPTH * zeta * zeta / ((double)LAST * LAST);
}

static double index_of_depth(double depth) {
    return LAST * sqrt(depth / DEPTH);
}

/* Weights of the cubic through four nodes at the index coordinate zeta. */
static void interpolation(double zeta, int *node, double weight[STENCIL]) {
    int first = (int)zeta - 1;
    if (first < 0) {
        first = 0;
    }
    if (first > LAST - (STENCIL - 1)) {
        first = LAST - (STENCIL - 1);
    }
    double x = zeta - first;
    weight[0] = -(x - 1.0) * (x - 2.0) * (x - 3.0) / 6.0;
    weight[1] = x * (x - 2.0) * (x - 3.0) / 2.0;
    weight[2] = -x * (x - 1.0) * (x - 3.0) / 2.0;
    weight[3] = x * (x - 1.0) * (x - 2.0) / 6.0;
    *node = first;
}

static double interpolate(const double field[NODES], int node, const double weight[STENCIL]) {
    double sum = 0.0;
    for (int k = 0; k < STENCIL; k++) {
        sum += weight[k] * field[node + k];
    }
    return sum;
}

static sample sample_inside(double zeta, double share) {
    sample point;
    double depth = depth_of_index(zeta);
    interpolation(zeta, &point.node, point.weight);
    point.s = exp(-depth);
    point.rho = -expm1(-depth);
    point.measure = share * point.s * 2.0 * depth / zeta;
    return point;
}

/* Between the outermost node and the tip f stays what it is at that node. */
static sample sample_at_tip(double depth, double share) {
    sample point = {.node = LAST - (STENCIL - 1), .weight = {0.0, 0.0, 0.0, 1.0}};
    point.s = exp(-depth);
    point.rho = -expm1(-depth);
    point.measure = share * point.s;
    return point;
}

static void place_samples(sample samples[SAMPLES]) {
    double panel = (TIP_DEPTH - DEPTH) / TIP_PANELS;
    for (int k = 0; k < GAUSS; k++) {
        double x = GAUSS3_X[k], share = GAUSS3_W[k];
        for (int i = 0; i < LAST; i++) {
            samples[GAUSS * i + k] = sample_inside(i + x, share);
        }
        for (int i = 0; i < TIP_PANELS; i++) {
            samples[INNER + GAUSS * i + k] = sample_at_tip(DEPTH + panel * (i + x), panel * share);
        }
    }
}

/*
 * H(rho, y): with v = cos(psi) / max(rho, y) the integrand is bounded and its kink at rho = y sits
 * at the end psi = 0, where Gauss points are dense. sx = 1 - rho, sy = 1 - y, for their difference.
 */
static double influence(double rho, double sx, double y, double sy) {
    double larger = fmax(rho, y), ratio = fmin(rho, y) / larger;
    double gap = fabs(sx - sy) * (2.0 - sx - sy) / (larger * larger);
    double range = 2.0 * asin(sqrt(0.5 * fmin(sx, sy)));
    double sum = 0.0;
    for (int k = 0; k < ANGLES; k++) {
        double sine = sin(range * ilsai_gauss8_node[k]);
        double root = sqrt(gap + ratio * ratio * sine * sine);
        sum += ilsai_gauss8_weight[k] * (y >= rho ? root : sine * sine / root);
    }
    return y * y * range * sum / larger;
}

/* p(rho) = m - int_0^rho g (1 - c) dz + int_rho^1 g c dz, c = sqrt(1 - z^2): (2.2) at the tip. */
static double pressure_influence(double rho, double z, double s) {
    double c = sqrt(s * (2.0 - s));
    return z < rho ? -z * z / (1.0 + c) : c;
}

static void set_up_grid(radial_grid *grid) {
    memset(grid, 0, sizeof *grid);
    for (int i = 0; i < NODES; i++) {
        double depth = depth_of_index(i);
        grid->s[i] = exp(-depth);
        grid->rho[i] = -expm1(-depth);
        grid->flow_scale[i] = exp(-depth * 4.0 / 3.0);
    }
    place_samples(grid->samples);
    for (int j = 0; j < SAMPLES; j++) {
        const sample *y = &grid->samples[j];
        double measure = y->measure / (y->rho * pow(y->s, 4.0 / 3.0));
        for (int i = 0; i < NODES; i++) {
            double width = measure * influence(grid->rho[i], grid->s[i], y->rho, y->s);
            double pressure = measure * pressure_influence(grid->rho[i], y->rho, y->s);
            for (int k = 0; k < STENCIL; k++) {
                grid->width_of_f[i][y->node + k] += width * y->weight[k];
                grid->pressure_of_f[i][y->node + k] += pressure * y->weight[k];
            }
        }
    }
}

/* ---------------------------------------------------------------------------------------------- */

/* When the front passed the radius, both as logarithms: cubic between the times, power law before.
 */
static double log_arrival(const penny_history *history, double log_radius) {
    const double *x = history->log_radius, *y = history->log_time, *alpha = history->alpha;
    int k = history->count - 1;
    while (k > 0 && log_radius < x[k - 1]) {
        k--;
    }
    if (k == 0) {
        return y[0] + (log_radius - x[0]) / alpha[0];
    }
    double h = x[k] - x[k - 1], a = (log_radius - x[k - 1]) / h, b = 1.0 - a;
    return a * a * (3.0 - 2.0 * a) * y[k] + b * b * (3.0 - 2.0 * b) * y[k - 1] +
           h * a * b * (b / alpha[k - 1] - a / alpha[k]);
}

/* What is known while stepping; history holds the accepted times and, last, the present trial. */
typedef struct march {
    const radial_grid *grid;
    ilsa_material_def law; /* in the units above */
    penny_history history;
    double log_width[NODES];
    double f[NODES], m;       /* the pressure gradient, and the stress intensity at the tip */
    double growth[NODES];     /* d ln(volume outside the node) / d ln t at constant rho */
    double outside[2][NODES]; /* ln of that volume, but for a constant, at the last two times */
    double volume[NODES];     /* int_rho^1 w rho drho at the present time */
    double leak_rate[NODES];  /* int_rho^1 C' (t - t0)^(-1/2) rho drho */
    double leaked;            /* the whole leaked volume */
    double tip_power;         /* d ln w / d ln s at the outermost node */
} radial_march;

/* Backward differences, second order from the second step on. */
static double log_rate(int step, double now, double before, double earlier) {
    if (step == 1) {
        return (now - before) / LOG_STEP;
    }
    return (3.0 * now - 4.0 * before + earlier) / (2.0 * LOG_STEP);
}

/* Carter's leak-off (2.4) outside each node, and since the beginning. */
static void leak_off(radial_march *march) {
    if (march->law.C_prime == 0.0) {
        return;
    }
    const penny_history *history = &march->history;
    int now = history->count - 1;
    double x = history->log_radius[now], radius = exp(x), time = exp(history->log_time[now]);
    double tip = march->grid->s[LAST], alpha = history->alpha[now];
    /* next to the tip t - t0 = t s / alpha */
    double rate = 2.0 * march->law.C_prime * sqrt(alpha * tip / time);
    double total = march->law.C_prime * (4.0 / 3.0) * sqrt(time * tip / alpha) * tip;
    march->leak_rate[LAST] = rate;
    for (int i = LAST - 1; i >= 0; i--) {
        for (int k = 0; k < GAUSS; k++) {
            const sample *y = &march->grid->samples[GAUSS * i + k];
            double passed = log_arrival(history, x + log(y->rho)) - history->log_time[now];
            double age = sqrt(-time * expm1(fmin(passed, 0.0)));
            rate += march->law.C_prime / age * y->rho * y->measure;
            total += 2.0 * march->law.C_prime * age * y->rho * y->measure;
        }
        march->leak_rate[i] = rate;
    }
    march->leaked = 2.0 * PI * radius * radius * total;
}

/* int_0^s_tip w rho ds for w ~ s^tip_power, which the closed form follows closely enough there. */
static double tip_volume(double width, double s, double power) {
    return width * s * (1.0 / (1.0 + power) - s / (2.0 + power));
}

static void integrate_width(radial_march *march) {
    double sum = tip_volume(exp(march->log_width[LAST]), march->grid->s[LAST], march->tip_power);
    march->volume[LAST] = sum;
    for (int i = LAST - 1; i >= 0; i--) {
        for (int k = 0; k < GAUSS; k++) {
            const sample *y = &march->grid->samples[GAUSS * i + k];
            sum += exp(interpolate(march->log_width, y->node, y->weight)) * y->rho * y->measure;
        }
        march->volume[i] = sum;
    }
}

/* One substitution: the widths that the flow through the present widths calls for. */
static void substitute(radial_march *march, double tip_width, double log_ratio[NODES]) {
    const radial_grid *grid = march->grid;
    int now = march->history.count - 1;
    double radius = exp(march->history.log_radius[now]), time = exp(march->history.log_time[now]);
    double alpha = march->history.alpha[now], sums[NODES];
    integrate_width(march);
    for (int i = 0; i < NODES; i++) {
        double w = exp(march->log_width[i]);
        double flow = march->growth[i] * march->volume[i] +
                      alpha * grid->rho[i] * grid->rho[i] * w + time * march->leak_rate[i];
        march->f[i] =
            march->law.mu_prime * radius * radius / time * grid->flow_scale[i] * flow / (w * w * w);
    }
    for (int i = 0; i < NODES; i++) {
        sums[i] = 0.0;
        for (int j = 0; j < NODES; j++) {
            sums[i] += grid->width_of_f[i][j] * march->f[j];
        }
    }
    double tip = grid->s[LAST], tip_root = sqrt(tip * (2.0 - tip));
    double stiffness = PI / (8.0 * radius);
    march->m = (stiffness * tip_width - sums[LAST]) / tip_root;
    for (int i = 0; i < NODES; i++) {
        double root = sqrt(grid->s[i] * (2.0 - grid->s[i]));
        double w = (march->m * root + sums[i]) / stiffness;
        log_ratio[i] = log(fmax(w, 0.5 * tip_width * root / tip_root)) - march->log_width[i];
    }
}

/*
 * The widths for the present radius and velocity. The substitution has its spectrum in [-3, 0]
 * (f goes as 1 / w^3 at most): these factors are Chebyshev's for 1 - spectrum in [1, 4].
 */
static bool solve_widths(radial_march *march, double tolerance) {
    static const double RELAXATION[3] = {0.2631, 0.4, 0.8326};
    int now = march->history.count - 1;
    double radius = exp(march->history.log_radius[now]), time = exp(march->history.log_time[now]);
    double V = march->history.alpha[now] * radius / time, s = radius * march->grid->s[LAST];
    double tip_width = ilsai_asymptote_width(&march->law, V, s);
    march->tip_power = log(tip_width / ilsai_asymptote_width(&march->law, V, 0.5 * s)) / log(2.0);
    for (int pass = 0; pass < 150; pass++) {
        double ratio[NODES], worst = 0.0;
        substitute(march, tip_width, ratio);
        for (int i = 0; i < NODES; i++) {
            worst = fmax(worst, fabs(ratio[i]));
            march->log_width[i] += RELAXATION[pass % 3] * fmax(-2.0, fmin(2.0, ratio[i]));
        }
        if (worst < tolerance) {
            return true;
        }
    }
    return false;
}

static double fracture_volume(const radial_march *march) {
    double radius = exp(march->history.log_radius[march->history.count - 1]);
    return 2.0 * PI * radius * radius * march->volume[0];
}

/* The radii that viscosity, toughness and leak-off alone would allow: the vertex solutions. */
static double log_radius_of_viscosity(const ilsa_material_def *law, double log_time) {
    return log(VISCOSITY_RADIUS) + (4.0 * log_time - log(law->mu_prime)) / 9.0;
}

static double log_radius_of_toughness(const ilsa_material_def *law, double log_time) {
    return law->K_prime > 0.0 ? log(TOUGHNESS_RADIUS) + 0.4 * (log_time - log(law->K_prime))
                              : HUGE_VAL;
}

static double log_radius_of_leak_off(const ilsa_material_def *law, double log_time) {
    return law->C_prime > 0.0 ? log(LEAK_OFF_RADIUS) + 0.25 * log_time - 0.5 * log(law->C_prime)
                              : HUGE_VAL;
}

/*
 * alpha before there is a history: Q t = volume + leaked, where the volume goes as R^power and
 * would be Q t for R ~ t^volume_alpha, and what leaks goes as R^2 t^(1/2).
 */
static double first_alpha(const radial_march *march, double efficiency) {
    double log_time = march->history.log_time[0];
    bool tough = log_radius_of_toughness(&march->law, log_time) <
                 log_radius_of_viscosity(&march->law, log_time);
    double power = tough ? 2.5 : 3.0, volume_alpha = tough ? 0.4 : 4.0 / 9.0;
    double lost = 1.0 - efficiency;
    return (efficiency * power * volume_alpha + 0.5 * lost) / (efficiency * power + 2.0 * lost);
}

/* How fast the volume outside each node grows, for the next pass; returns the largest change. */
static double update_growth(radial_march *march) {
    int now = march->history.count - 1;
    double change = 0.0, efficiency = fracture_volume(march);
    efficiency /= efficiency + march->leaked;
    if (now == 0) {
        march->history.alpha[0] = first_alpha(march, efficiency);
    }
    for (int i = 0; i < NODES; i++) {
        double outside = 2.0 * march->history.log_radius[now] + log(march->volume[i]);
        /* at first 1 without leak-off, 9/16 to 5/8 when all but leaks */
        double growth = 0.6 + 0.4 * efficiency;
        if (now > 0) {
            growth = log_rate(now, outside, march->outside[0][i], march->outside[1][i]);
        }
        double step = 0.8 * (fmax(0.1, fmin(2.0, growth)) - march->growth[i]);
        change = fmax(change, fabs(step));
        march->growth[i] += step;
    }
    return change;
}

static void set_radius(radial_march *march, double log_radius) {
    penny_history *history = &march->history;
    int now = history->count - 1;
    history->log_radius[now] = log_radius;
    if (now > 0) {
        double earlier = now > 1 ? history->log_radius[now - 2] : 0.0;
        double alpha = log_rate(now, log_radius, history->log_radius[now - 1], earlier);
        history->alpha[now] = fmax(0.15, fmin(0.6, alpha));
    }
}

/*
 * Volume balance: secant steps on the logarithm of the radius, with slopes that physics allows and
 * only from differences that stand out of what is left in the widths. The growth rates lag behind.
 */
static bool solve_radius(radial_march *march, double log_radius) {
    double slope = 2.5, previous = 0.0, previous_x = 0.0, tolerance = 1e-3, noise = 0.0;
    int now = march->history.count - 1;
    for (int pass = 0; pass < 60; pass++) {
        set_radius(march, log_radius);
        leak_off(march);
        if (!solve_widths(march, tolerance)) {
            return false;
        }
        double change = update_growth(march);
        double excess = log(fracture_volume(march) + march->leaked) - march->history.log_time[now];
        if (pass > 0 && fabs(excess - previous) > noise) {
            slope = fmax(1.5, fmin(5.0, (excess - previous) / (log_radius - previous_x)));
        }
        if (fabs(excess) < 1e-10 && change < 1e-8 && tolerance < 1e-9) {
            return true;
        }
        noise = 10.0 * tolerance;
        tolerance = fmax(1e-10, fmin(tolerance, 0.01 * fmax(fabs(excess), change)));
        previous = excess;
        previous_x = log_radius;
        log_radius -= fmax(-1.0, fmin(1.0, excess / slope));
    }
    return false;
}

static bool start_march(radial_march *march, double log_time) {
    double x = fmin(log_radius_of_viscosity(&march->law, log_time),
                    fmin(log_radius_of_toughness(&march->law, log_time),
                         log_radius_of_leak_off(&march->law, log_time)));
    march->history.count = 1;
    march->history.log_time[0] = log_time;
    march->history.alpha[0] = first_alpha(march, 0.5);
    double V = march->history.alpha[0] * exp(x - log_time);
    for (int i = 0; i < NODES; i++) {
        double s = exp(x) * march->grid->s[i];
        march->log_width[i] = log(ilsai_asymptote_width(&march->law, V, s));
        march->growth[i] = 1.0;
    }
    return solve_radius(march, x);
}

static bool step_march(radial_march *march) {
    int now = march->history.count++;
    for (int i = 0; i < NODES; i++) {
        march->outside[1][i] = march->outside[0][i];
        march->outside[0][i] = 2.0 * march->history.log_radius[now - 1] + log(march->volume[i]);
    }
    march->history.log_time[now] = march->history.log_time[now - 1] + LOG_STEP;
    double guess = march->history.log_radius[now - 1] + march->history.alpha[now - 1] * LOG_STEP;
    return solve_radius(march, guess);
}

/* Fills the solution, in the units of the caller, from the end of the march. */
static void finish(const radial_march *march, penny_solution *solution) {
    double length = cbrt(solution->Q * solution->t), E = solution->scaled.E_prime;
    int now = march->history.count - 1;
    const penny_history *history = &march->history;
    solution->R = length * exp(history->log_radius[now]);
    solution->alpha = history->alpha[now];
    solution->V = solution->alpha * solution->R / solution->t;
    solution->tip_power = march->tip_power;
    solution->history = *history;
    for (int k = 0; k <= now; k++) {
        solution->history.log_radius[k] -= history->log_radius[now];
        solution->history.log_time[k] -= history->log_time[now];
    }
    for (int i = 0; i < NODES; i++) {
        double p = march->m;
        for (int j = 0; j < NODES; j++) {
            p += march->grid->pressure_of_f[i][j] * march->f[j];
        }
        solution->log_width[i] = march->log_width[i] + log(length);
        solution->pressure[i] = E * p;
        solution->pressure_slope[i] = -E * march->f[i] / cbrt(march->grid->s[i]);
    }
}

/* The volume of exactly the width that ilsai_penny_width interpolates. */
static double profile_volume(const penny_solution *solution) {
    double sum = tip_volume(exp(solution->log_width[LAST]), exp(-DEPTH), solution->tip_power);
    for (int i = 0; i < LAST; i++) {
        for (int k = 0; k < ANGLES; k++) {
            sample y = sample_inside(i + ilsai_gauss8_node[k], ilsai_gauss8_weight[k]);
            sum += exp(interpolate(solution->log_width, y.node, y.weight)) * y.rho * y.measure;
        }
    }
    return 2.0 * PI * solution->R * solution->R * sum;
}

static bool is_positive(double x) {
    return isfinite(x) && x > 0.0;
}

static bool is_valid(const ilsa_material_def *scaled, double Q, double size) {
    return is_positive(scaled->E_prime) && is_positive(scaled->mu_prime) &&
           isfinite(scaled->K_prime) && scaled->K_prime >= 0.0 && isfinite(scaled->C_prime) &&
           scaled->C_prime >= 0.0 && is_positive(Q) && is_positive(size);
}

static ilsa_status solve_at_time(const radial_grid *grid, penny_solution *solution) {
    const ilsa_material_def *scaled = &solution->scaled;
    double t = solution->t, length = cbrt(solution->Q * t);
    if (!is_positive(scaled->E_prime * t) || !is_positive(scaled->E_prime * sqrt(length))) {
        return ILSA_ERR_VALUE;
    }
    radial_march march;
    memset(&march, 0, sizeof march);
    march.grid = grid;
    march.law.E_prime = 1.0;
    march.law.mu_prime = scaled->mu_prime / (scaled->E_prime * t);
    march.law.K_prime = scaled->K_prime / (scaled->E_prime * sqrt(length));
    march.law.C_prime = scaled->C_prime * sqrt(t) / length;
    if (!is_valid(&march.law, solution->Q, length)) {
        return ILSA_ERR_VALUE;
    }
    bool solved = start_march(&march, -LOG_STEP * (ILSAI_PENNY_TIMES - 1));
    while (solved && march.history.count < ILSAI_PENNY_TIMES) {
        solved = step_march(&march);
    }
    if (!solved) {
        return ILSA_ERR_VALUE;
    }
    finish(&march, solution);
    solution->efficiency = profile_volume(solution) / (solution->Q * t);
    return ILSA_OK;
}

ilsa_status ilsai_penny_at_time(const ilsa_material_def *scaled, double Q, double t,
                                penny_solution *solution) {
    if (!is_valid(scaled, Q, t)) {
        return ILSA_ERR_VALUE;
    }
    radial_grid grid;
    set_up_grid(&grid);
    penny_solution trial = {.scaled = *scaled, .Q = Q, .t = t};
    ilsa_status status = solve_at_time(&grid, &trial);
    if (status == ILSA_OK) {
        *solution = trial;
    }
    return status;
}

/* The largest of the times that viscosity, toughness and leak-off alone would need. */
static double log_time_bound(const ilsa_material_def *scaled, double Q, double R) {
    double E = scaled->E_prime;
    double x = 2.25 * log(R / VISCOSITY_RADIUS) + 0.25 * (log(scaled->mu_prime / E) - 3.0 * log(Q));
    if (scaled->K_prime > 0.0) {
        x = fmax(x, 2.5 * log(R / TOUGHNESS_RADIUS) + log(scaled->K_prime / E) - log(Q));
    }
    if (scaled->C_prime > 0.0) {
        x = fmax(x, 4.0 * log(R / LEAK_OFF_RADIUS) + 2.0 * log(scaled->C_prime / Q));
    }
    return x;
}

static void set_radius_exactly(penny_solution *solution, double R) {
    solution->R = R;
    solution->V = solution->alpha * R / solution->t;
    solution->efficiency = profile_volume(solution) / (solution->Q * solution->t);
}

ilsa_status ilsai_penny_at_radius(const ilsa_material_def *scaled, double Q, double R,
                                  penny_solution *solution) {
    if (!is_valid(scaled, Q, R)) {
        return ILSA_ERR_VALUE;
    }
    radial_grid grid;
    set_up_grid(&grid);
    penny_solution trial = {.scaled = *scaled, .Q = Q};
    double log_time = log_time_bound(scaled, Q, R), slope = 0.4, previous = 0.0, previous_x = 0.0;
    for (int pass = 0; pass < 60; pass++) {
        trial.t = exp(log_time);
        if (!is_positive(trial.t) || solve_at_time(&grid, &trial) != ILSA_OK) {
            return ILSA_ERR_VALUE;
        }
        double excess = log(trial.R / R);
        if (fabs(excess) < 1e-9) {
            set_radius_exactly(&trial, R);
            *solution = trial;
            return ILSA_OK;
        }
        if (pass > 0) {
            slope = fmax(0.2, fmin(0.5, (excess - previous) / (log_time - previous_x)));
        }
        previous = excess;
        previous_x = log_time;
        log_time -= excess / slope;
    }
    return ILSA_ERR_VALUE;
}

double ilsai_penny_width(const penny_solution *solution, double rho) {
    if (!(rho < 1.0)) {
        return 0.0;
    }
    double depth = -log1p(-fmax(rho, 0.0));
    if (depth >= DEPTH) {
        return exp(solution->log_width[LAST] - solution->tip_power * (depth - DEPTH));
    }
    int node;
    double weight[STENCIL];
    interpolation(index_of_depth(depth), &node, weight);
    return exp(interpolate(solution->log_width, node, weight));
}

double ilsai_penny_pressure(const penny_solution *solution, double rho) {
    double depth = -log1p(-fmax(rho, 0.0));
    /* ln(rho / s), in which the pressure is straight at the source, is ln(expm1(depth)) */
    double zeta = rho < 1.0 ? index_of_depth(depth) : LAST;
    if (zeta <= 1.0) {
        return solution->pressure[1];
    }
    if (zeta >= LAST) {
        return solution->pressure[LAST];
    }
    int k = (int)zeta;
    double start = log(expm1(depth_of_index(k))), h = log(expm1(depth_of_index(k + 1))) - start;
    double b = (log(expm1(depth)) - start) / h, a = 1.0 - b;
    const double *p = &solution->pressure[k], *slope = &solution->pressure_slope[k];
    return a * a * (3.0 - 2.0 * a) * p[0] + b * b * (3.0 - 2.0 * b) * p[1] +
           h * a * b * (a * slope[0] - b * slope[1]);
}

double ilsai_penny_arrival(const penny_solution *solution, double rho) {
    if (!(rho > 0.0)) {
        return 0.0;
    }
    return solution->t * exp(fmin(log_arrival(&solution->history, log(fmin(rho, 1.0))), 0.0));
}
