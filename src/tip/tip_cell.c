#include "tip/tip_cell.h"

#include "tip/stress_step.h"
#include <math.h>
#include <stddef.h>

/*
 * The chord of the cell at distance s from the interior corner is a trapezoid: it rises from 0 at
 * s = 0 to its full length at h, stays until H and falls to 0 at H + h, h and H the smaller and the
 * larger of dy sin(alpha) and dx cos(alpha). Volume and leak-off are integrals over s of a positive
 * quantity times this chord; no term is subtracted, and alpha = 0 and pi/2 are not special.
 */
typedef struct tip_cell_chord {
    double h, H, length;
} tip_cell_chord;

static tip_cell_chord chord_of(const tip_cell_front *front) {
    const double a = front->dy * front->sin_a, b = front->dx * front->cos_a;
    const double H = fmax(a, b);
    return (tip_cell_chord){fmin(a, b), H, front->dx * front->dy / H};
}

double ilsai_tip_cell_area(const tip_cell_front *front) {
    const tip_cell_chord c = chord_of(front);
    const double ell = front->ell, rest = c.H + c.h - ell;
    if (ell <= 0.0) {
        return 0.0;
    }
    if (rest <= 0.0) {
        return c.H * c.length;
    }
    if (ell < c.h) {
        return 0.5 * c.length * ell * (ell / c.h);
    }
    if (ell < c.H) {
        return c.length * (ell - 0.5 * c.h);
    }
    return c.length * (c.H - 0.5 * rest * (rest / c.h));
}

/*
 * Adds the mean over the strip [far - h, far] of what is 0 for xi < 0. The nodes are those of
 * Gauss-Legendre in r = xi^(1/3), where M0 is smooth up to the front (r^(9/2) to r^5 there): error
 * 1e-5 with 4, and with 2 where the front is far.
 */
static void add_strip(tip_cell_nodes *n, double h, double far, double sign) {
    static const double node[6] = {0.78867513459481288, 0.21132486540518712, 0.93056815579702629,
                                   0.66999052179242813, 0.33000947820757187, 0.069431844202973712};
    static const double weight[6] = {0.5,
                                     0.5,
                                     0.17392742256872693,
                                     0.32607257743127307,
                                     0.32607257743127307,
                                     0.17392742256872693};
    const double width = fmin(h, far), r0 = cbrt(far - width), r1 = cbrt(far);
    const double norm = r0 * r0 + r0 * r1 + r1 * r1, dr = width / norm;
    const double part = sign * (width < h ? width / h : 1.0) * 3.0 / norm;
    const int first = width < 0.3 * far ? 0 : 2, end = first ? 6 : 2;
    for (int k = first; k < end; k++) {
        const double r = r0 + dr * node[k];
        n->xi[n->count] = r * r * r;
        n->weight[n->count++] = part * weight[k] * r * r;
    }
}

/* The volume is the sum of M0 by these, its derivative by ell that of the width. */
tip_cell_nodes ilsai_tip_cell_nodes(const tip_cell_front *front) {
    const tip_cell_chord c = chord_of(front);
    tip_cell_nodes n = {0};
    if (front->ell > 0.0) {
        add_strip(&n, c.h, front->ell, c.length);
    }
    if (front->ell > c.H) {
        add_strip(&n, c.h, front->ell - c.H, -c.length);
    }
    return n;
}

/* Width and M0 at the nodes; of a front at rest those of its K_I. */
static void row_of(const ilsa_material_def *law, double V, double K_I, const tip_cell_nodes *n,
                   asymptote_point *point) {
    if (V > 0.0) {
        ilsai_asymptote_row(law, V, n->count, n->xi, point);
        return;
    }
    for (int k = 0; k < n->count; k++) {
        const double w = K_I / law->E_prime * sqrt(n->xi[k]);
        point[k] = (asymptote_point){w, 2.0 / 3.0 * w * n->xi[k], 0.5, 0.0};
    }
}

tip_cell_growth ilsai_tip_cell_growth(const ilsa_material_def *law, double V, double K_I,
                                      const tip_cell_nodes *nodes) {
    asymptote_point point[TIP_CELL_NODES];
    tip_cell_growth sum = {0.0, 0.0, 0.0};
    row_of(law, V, K_I, nodes, point);
    for (int k = 0; k < nodes->count; k++) {
        sum.volume += nodes->weight[k] * point[k].M0;
        sum.by_ell += nodes->weight[k] * point[k].w;
        sum.by_log_V += nodes->weight[k] * point[k].M0 * point[k].by_V;
    }
    return sum;
}

double ilsai_tip_cell_volume(const ilsa_material_def *law, double V, double K_I,
                             const tip_cell_front *front) {
    const tip_cell_nodes nodes = ilsai_tip_cell_nodes(front);
    return ilsai_tip_cell_growth(law, V, K_I, &nodes).volume;
}

tip_cell_step ilsai_tip_cell_step(double d, const tip_cell_nodes *nodes) {
    tip_cell_step sum = {0.0, 0.0, 0.0};
    for (int k = 0; k < nodes->count; k++) {
        const stress_step_point at = ilsai_stress_step_at(nodes->xi[k], d);
        sum.volume += nodes->weight[k] * at.moment;
        sum.by_ell += nodes->weight[k] * at.width;
        sum.by_d += nodes->weight[k] * at.moment_by_d;
    }
    return sum;
}

void ilsai_tip_cell_enter(tip_cell_history *history, double t_A) {
    history->count = 1;
    history->t[0] = t_A;
    history->ell[0] = 0.0;
}

/* Twice the area of the triangle of three knots: what the path loses with the middle one. */
static double knot_weight(const double t[3], const double ell[3]) {
    return fabs((t[1] - t[0]) * (ell[2] - ell[0]) - (t[2] - t[0]) * (ell[1] - ell[0]));
}

/*
 * Drops the inner knot whose loss changes the path least. The last one stays: whether it is
 * straight on depends on the knot to come, which an iteration moves, and the choice must not move
 * with it.
 */
static void history_drop(tip_cell_history *history) {
    int least = 1;
    double least_weight = HUGE_VAL;
    for (int k = 1; k < history->count - 1; k++) {
        const double weight = knot_weight(&history->t[k - 1], &history->ell[k - 1]);
        if (weight < least_weight) {
            least_weight = weight;
            least = k;
        }
    }
    history->count--;
    for (int k = least; k < history->count; k++) {
        history->t[k] = history->t[k + 1];
        history->ell[k] = history->ell[k + 1];
    }
}

void ilsai_tip_cell_amend(tip_cell_history *history, double ell, double most) {
    const int last = history->count - 1;
    if (last > 0) {
        history->ell[last] = fmax(fmin(ell, most), history->ell[last - 1]);
    }
}

void ilsai_tip_cell_record(tip_cell_history *history, double t, double ell) {
    ell = fmax(ell, history->ell[history->count - 1]);
    if (history->count == TIP_CELL_KNOTS) {
        history_drop(history);
    }
    history->t[history->count] = t;
    history->ell[history->count] = ell;
    history->count++;
}

/*
 * Integral of (t - t_0)^(1/2) times the chord over a piece of s of length ds, both linear in s:
 * from p = (t - t_0)^(1/2) and chord a at its wet end to q < p and b at its end towards the front.
 */
static double leakoff_piece(double ds, double p, double q, double a, double b) {
    const double sum = p + q;
    if (!(ds > 0.0) || !(sum > 0.0)) {
        return 0.0;
    }
    const double p2 = p * p, q2 = q * q;
    const double at_a = p * (3.0 * p2 + 6.0 * p * q + 4.0 * q2) + 2.0 * q2 * q;
    const double at_b = 2.0 * p2 * p + q * (4.0 * p2 + 6.0 * p * q + 3.0 * q2);
    return 2.0 / 15.0 * ds * (a * at_a + b * at_b) / (sum * sum);
}

/* Length of the chord at s on its rise (part 0), its middle (1) or its fall (2). */
static double chord_at(const tip_cell_chord *chord, int part, double s) {
    if (part == 1) {
        return chord->length;
    }
    return chord->length * ((part == 0 ? s : chord->H + chord->h - s) / chord->h);
}

/* One segment of the path, along which age = t - t_0 falls linearly, cut at the corners. */
static double leakoff_segment(const tip_cell_chord *chord, const double s[2], const double age[2]) {
    const double corner[3] = {chord->h, chord->H, chord->H + chord->h};
    double from = s[0], p = sqrt(age[0]), sum = 0.0;
    for (int part = 0; part < 3 && from < s[1]; part++) {
        if (corner[part] <= from) {
            continue;
        }
        const double to = fmin(corner[part], s[1]), done = (to - s[0]) / (s[1] - s[0]);
        const double q = sqrt(age[0] + done * (age[1] - age[0]));
        sum +=
            leakoff_piece(to - from, p, q, chord_at(chord, part, from), chord_at(chord, part, to));
        from = to;
        p = q;
    }
    return sum;
}

double ilsai_tip_cell_leakoff_path(double C_prime, const tip_cell_front *front, int count,
                                   const double *t, const double *ell) {
    const tip_cell_chord chord = chord_of(front);
    double sum = 0.0;
    for (int k = 0; k + 1 < count; k++) {
        const double age[2] = {t[count - 1] - t[k], t[count - 1] - t[k + 1]};
        sum += leakoff_segment(&chord, ell + k, age);
    }
    return 2.0 * C_prime * sum;
}

double ilsai_tip_cell_leakoff(double C_prime, const tip_cell_front *front,
                              const tip_cell_history *history) {
    return ilsai_tip_cell_leakoff_path(C_prime, front, history->count, history->t, history->ell);
}

/* One segment up to the last knot, or up to the time t on the way there. */
static double constant_leakoff(double C_prime, const tip_cell_front *front,
                               const tip_cell_history *history, double t) {
    const int last = history->count - 1;
    const double t0 = history->t[0], part = (t - t0) / (history->t[last] - t0);
    return ilsai_tip_cell_leakoff_path(C_prime, front, 2, (double[]){t0, t},
                                       (double[]){0, part * history->ell[last]});
}

double ilsai_tip_cell_leakoff_last(double C_prime, tip_cell_velocity velocity,
                                   const tip_cell_front *front, const tip_cell_history *history) {
    const int n = history->count;
    const double *t = history->t;
    if (n <= 2) {
        return ilsai_tip_cell_leakoff(C_prime, front, history);
    }
    if (velocity == TIP_CELL_CONSTANT) {
        return constant_leakoff(C_prime, front, history, t[n - 1]) -
               constant_leakoff(C_prime, front, history, t[n - 2]);
    }
    return ilsai_tip_cell_leakoff(C_prime, front, history) -
           ilsai_tip_cell_leakoff_path(C_prime, front, n - 1, t, history->ell);
}

double ilsai_tip_cell_full_leakoff(double C_prime, double age, double spread) {
    const double oldest = fmax(age + spread, 0.0), newest = fmax(age - spread, 0.0);
    const double p = sqrt(oldest), q = sqrt(newest);
    const double wet = newest > 0.0 || spread <= 0.0 ? 1.0 : oldest / (2.0 * spread);
    return p > 0.0 ? 4.0 / 3.0 * C_prime * wet * (oldest + p * q + newest) / (p + q) : 0.0;
}

/* With u = p + q of above the mean of the root is u / 2 + (2/3) e^2 / u^3. */
double ilsai_tip_cell_full_leakoff_step(double C_prime, double age, double dt, double spread) {
    if (!(age > spread)) {
        return ilsai_tip_cell_full_leakoff(C_prime, age + dt, spread) -
               ilsai_tip_cell_full_leakoff(C_prime, age, spread);
    }
    const double p0 = sqrt(age + spread), p1 = sqrt(age + dt + spread);
    const double q0 = sqrt(age - spread), q1 = sqrt(age + dt - spread);
    const double u0 = p0 + q0, u1 = p1 + q1, e0 = spread / (u0 * u0), e1 = spread / (u1 * u1);
    const double rise = dt / (p0 + p1) + dt / (q0 + q1);
    const double less = 4.0 / 3.0 * e0 * e1 * (u1 / u0 + 1.0 + u0 / u1);
    return C_prime * rise * (1.0 - less);
}

double ilsai_tip_cell_spread(const tip_cell_front *front, double T) {
    const double a = front->dx * front->cos_a, b = front->dy * front->sin_a;
    return 0.5 * T * hypot(a, b) / (a + b);
}
