#include "elastic/self_term.h"

#include "base/gauss.h"
#include "elastic/dd_kernel.h"
#include <math.h>

static const double pi = 3.14159265358979323846;

/* Half the cell's extents along the normal, the smaller of which counts as nothing below this. */
#define SELF_TERM_NARROW 1e-3

static double power_positive(double x, double exponent) {
    return x > 0 ? pow(x, exponent) : 0;
}

/*
 * Mean of s_+^lambda over a cell whose centre is at s and which reaches a and b along the normal:
 * the second difference of s_+^(lambda + 2), the first where the cell is narrow.
 */
static double mean_power(double s, double a, double b, double lambda) {
    double wide = fmax(a, b), narrow = fmin(a, b);
    if (s + wide + narrow <= 0) {
        return 0;
    }
    if (narrow < SELF_TERM_NARROW * wide) {
        double exponent = lambda + 1;
        return (power_positive(s + wide, exponent) - power_positive(s - wide, exponent)) /
               (2 * wide * exponent);
    }
    double exponent = lambda + 2;
    double sum =
        power_positive(s + wide + narrow, exponent) - power_positive(s + wide - narrow, exponent) -
        power_positive(s - wide + narrow, exponent) + power_positive(s - wide - narrow, exponent);
    return sum / (4 * wide * narrow * (lambda + 1) * exponent);
}

/* Where the cell reaches less than this part of s the mean is its expansion to the second order. */
#define SELF_TERM_FAR 0.2

double ilsai_self_term_mean(double dx, double dy, const self_term_front *front) {
    double a = 0.5 * dx * front->cos_a, b = 0.5 * dy * front->sin_a, s = front->s;
    if (a + b < SELF_TERM_FAR * s) {
        return 1 - front->exponent * (1 - front->exponent) * (a * a + b * b) / (6 * s * s);
    }
    return mean_power(front->s, a, b, front->exponent) * pow(front->s, -front->exponent);
}

/* ---- The sum over the lattice ------------------------------------------------------------- */

/* Cells to each side that are summed one by one: so many cell sizes, but not more than a limit. */
#define SELF_TERM_REACH      3.5
#define SELF_TERM_CELLS_MOST 40

/* Integral of (s - R q)_+^lambda R^-2 over R > rho: with u = 1 / R and u = from + (to - from) t^6,
 * which leaves both ends smooth. */
static double along_ray(double s, double q, double rho, double lambda) {
    double from = fmax(0, q / s), to = 1 / rho, sum = 0;
    if (from >= to) {
        return 0;
    }
    for (int k = 0; k < GAUSS8_POINTS; k++) {
        double t = ilsai_gauss8_node[k], t5 = t * t * t * t * t, u = from + (to - from) * t5 * t;
        sum += ilsai_gauss8_weight[k] * t5 * pow((s * u - q) / u, lambda);
    }
    return 6 * (to - from) * sum;
}

/* Pressure over E' at the centre from the widths beyond a rectangle of half sides x and y. */
static double beyond(const self_term_front *f, double x, double y) {
    double corner = atan2(y, x), front = atan2(f->sin_a, f->cos_a);
    /* where the ray changes its side of the rectangle or turns from the front */
    double stop[7] = {-corner,
                      corner,
                      pi - corner,
                      pi + corner,
                      2 * pi - corner,
                      front + 0.5 * pi,
                      front - 0.5 * pi > -corner ? front - 0.5 * pi : front + 1.5 * pi};
    double sum = 0, last = stop[0];
    for (int k = 1; k < 7; k++) {
        double next = INFINITY;
        for (int m = 1; m < 7; m++) {
            next = stop[m] > last && stop[m] < next ? stop[m] : next;
        }
        for (int p = 0; p < GAUSS8_POINTS && next < INFINITY; p++) {
            double angle = last + (next - last) * ilsai_gauss8_node[p], c = cos(angle),
                   n = sin(angle);
            double rho = fmin(x / fabs(c), y / fabs(n));
            sum += ilsai_gauss8_weight[p] * (next - last) *
                   along_ray(f->s, c * f->cos_a + n * f->sin_a, rho, f->exponent);
        }
        last = next < INFINITY ? next : last;
    }
    return -sum / (8 * pi);
}

double ilsai_self_term_exact(double dx, double dy, const self_term_front *f) {
    double size = SELF_TERM_REACH * fmax(dx, dy), a = 0.5 * dx * f->cos_a, b = 0.5 * dy * f->sin_a;
    long nx = lround(fmin(size / dx, SELF_TERM_CELLS_MOST)),
         ny = lround(fmin(size / dy, SELF_TERM_CELLS_MOST));
    double exact = 0.25 * f->exponent / tan(pi * f->exponent) * pow(f->s, f->exponent - 1);
    double sum = beyond(f, ((double)nx + 0.5) * dx, ((double)ny + 0.5) * dy);
    for (long j = -ny; j <= ny; j++) {
        for (long i = -nx; i <= nx; i++) {
            double s = f->s - (double)i * dx * f->cos_a - (double)j * dy * f->sin_a;
            sum += ilsai_dd_kernel(i, j, dx, dy) * mean_power(s, a, b, f->exponent);
        }
    }
    return (exact - sum) / (ilsai_dd_kernel(0, 0, dx, dy) * mean_power(f->s, a, b, f->exponent));
}

/* ---- The table ---------------------------------------------------------------------------- */

/*
 * Nodes: u = full / (2 s), full the extent of the cell along the normal, so that u = 1 where the
 * cell has just filled and 0 far from the front, where the term is 0; a little beyond 1 for a
 * direction that is not quite that of the cell. Directions: by the part of full that is along y.
 */
#define SELF_TERM_U_STEP 0.05

static double exponent_at(int k) {
    return 0.5 + k / 12.0;
}

static self_term_front front_at(double dx, double dy, int exponent, int angle, int distance) {
    double part = angle / (SELF_TERM_ANGLES - 1.0), x = (1 - part) / dx, y = part / dy,
           r = hypot(x, y);
    self_term_front f = {.cos_a = x / r, .sin_a = y / r, .exponent = exponent_at(exponent)};
    f.s = (dx * f.cos_a + dy * f.sin_a) / (2 * SELF_TERM_U_STEP * distance);
    return f;
}

void ilsai_self_term_table(self_term_table *t, double dx, double dy) {
    double size = fmax(dx, dy);
    t->dx = dx;
    t->dy = dy;
    for (int e = 0; e < SELF_TERM_EXPONENTS; e++) {
        for (int a = 0; a < SELF_TERM_ANGLES; a++) {
            int mirrored = dx == dy && 2 * a > SELF_TERM_ANGLES - 1;
            t->at[e][a][0] = 0;
            for (int d = 1; d < SELF_TERM_DISTANCES; d++) {
                self_term_front f = front_at(dx / size, dy / size, e, a, d);
                t->at[e][a][d] = mirrored ? t->at[e][SELF_TERM_ANGLES - 1 - a][d]
                                          : ilsai_self_term_exact(dx / size, dy / size, &f);
            }
        }
    }
}

/* Where a value lies between four nodes of a cubic, and the weights of these. */
typedef struct cubic {
    int node[4];
    double weight[4], slope[4];
} cubic;

/* A node beyond an end lies on the line through the last two. */
static void fold_end(cubic *c, int outer, int end, int inner) {
    c->node[outer] = c->node[end];
    c->weight[end] += 2 * c->weight[outer];
    c->slope[end] += 2 * c->slope[outer];
    c->weight[inner] -= c->weight[outer];
    c->slope[inner] -= c->slope[outer];
    c->weight[outer] = c->slope[outer] = 0;
}

/* Catmull-Rom through nodes 0 .. count - 1 at x. */
static cubic cubic_at(double x, int count) {
    int k = (int)fmin(fmax(x, 0), count - 2);
    double t = x - k, t2 = t * t, t3 = t2 * t;
    cubic c = {{k - 1, k, k + 1, k + 2},
               {-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1, -1.5 * t3 + 2 * t2 + 0.5 * t,
                0.5 * t3 - 0.5 * t2},
               {-1.5 * t2 + 2 * t - 0.5, 4.5 * t2 - 5 * t, -4.5 * t2 + 4 * t + 0.5, 1.5 * t2 - t}};
    if (k == 0) {
        fold_end(&c, 0, 1, 2);
    }
    if (k == count - 2) {
        fold_end(&c, 3, 2, 1);
    }
    return c;
}

/* Lagrange's weights of the three exponents. */
static void exponent_weights(double exponent, double w[SELF_TERM_EXPONENTS]) {
    double x = 12 * (fmin(fmax(exponent, 0.5), 2.0 / 3.0) - 0.5);
    w[0] = 0.5 * (x - 1) * (x - 2);
    w[1] = x * (2 - x);
    w[2] = 0.5 * x * (x - 1);
}

self_term ilsai_self_term_lookup(const self_term_table *table, const self_term_front *f) {
    double full = table->dx * f->cos_a + table->dy * f->sin_a, u = full / (2 * f->s);
    double most = SELF_TERM_U_STEP * (SELF_TERM_DISTANCES - 1), by_u = u < most ? -u / f->s : 0;
    cubic distance = cubic_at(fmin(u, most) / SELF_TERM_U_STEP, SELF_TERM_DISTANCES);
    cubic angle = cubic_at(table->dy * f->sin_a / full * (SELF_TERM_ANGLES - 1), SELF_TERM_ANGLES);
    double by_exponent[SELF_TERM_EXPONENTS];
    self_term out = {0, 0};
    exponent_weights(f->exponent, by_exponent);
    for (int e = 0; e < SELF_TERM_EXPONENTS; e++) {
        for (int a = 0; a < 4; a++) {
            const double *at = table->at[e][angle.node[a]];
            double w = by_exponent[e] * angle.weight[a];
            for (int d = 0; d < 4; d++) {
                out.value += w * distance.weight[d] * at[distance.node[d]];
                out.slope += w * distance.slope[d] * at[distance.node[d]];
            }
        }
    }
    out.slope *= by_u / SELF_TERM_U_STEP;
    return out;
}
