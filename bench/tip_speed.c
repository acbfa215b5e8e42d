/* Time per call of the tip functions, over random arguments of all regimes. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <time.h>

#include "tip/tip_cell.h"

enum { POINTS = 4096, PASSES = 25 };

/* Dimensionless: E' = mu' = V = s = 1, so that K_prime and C_prime set the regime. */
typedef struct point {
    ilsa_material_def law;
    double K, C, s0, w, dt;
    tip_cell_front front;
    tip_cell_history history;
} point;

static point points[POINTS];

static double uniform(void) {
    static uint64_t state = 88172645463325252u;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) / 9007199254740992.0;
}

static double power_of_10(double low, double high) {
    return pow(10.0, low + (high - low) * uniform());
}

static void make_history(point *p) {
    ilsai_tip_cell_enter(&p->history, 0.0);
    for (int k = 1; k < 8; k++)
        ilsai_tip_cell_record(&p->history, k, p->front.ell * sqrt(k / 7.0));
}

static void make_points(void) {
    for (int i = 0; i < POINTS; i++) {
        point *p = &points[i];
        const double alpha = 1.5707963 * uniform();
        p->K = i % 3 ? uniform() : 1.0 - power_of_10(-8.0, 0.0);
        p->C = i % 4 ? power_of_10(-4.0, 4.0) : 0.0;
        p->law = (ilsa_material_def){1.0, 1.0, i % 5 ? power_of_10(-2.0, 2.0) : 0.0,
                                     i % 4 ? power_of_10(-3.0, 3.0) : 0.0};
        p->dt = power_of_10(-3.0, 1.0);
        p->s0 = 1.0;
        p->w = ilsai_asymptote_width(&p->law, 1.0, 1.0 + p->dt);
        p->front = (tip_cell_front){2.0 * uniform(), cos(alpha), sin(alpha), 1.0, 0.8};
        make_history(p);
    }
}

static double call_g_delta(const point *p) {
    return ilsa_tip_g_delta(p->K, p->C);
}

static double call_width(const point *p) {
    return ilsai_asymptote_width(&p->law, 1.0, 1.0);
}

static double call_moments(const point *p) {
    double M0, M1;
    ilsai_asymptote_moments(&p->law, 1.0, 1.0, p->w, &M0, &M1);
    return M0 + M1;
}

static double call_distance(const point *p) {
    return ilsai_asymptote_distance(&p->law, p->w, p->s0, p->dt).s;
}

static double call_volume(const point *p) {
    return ilsai_tip_cell_volume(&p->law, 1.0, 0.0, &p->front);
}

static double call_leakoff(const point *p) {
    return ilsai_tip_cell_leakoff(1.0, &p->front, &p->history);
}

static double nanoseconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

/* The best of several passes: the others shared the machine. */
static void measure(const char *name, double (*call)(const point *)) {
    double best = HUGE_VAL, sum = 0.0;
    for (int pass = 0; pass < PASSES; pass++) {
        const double start = nanoseconds();
        for (int i = 0; i < POINTS; i++)
            sum += call(&points[i]);
        best = fmin(best, (nanoseconds() - start) / POINTS);
    }
    printf("%-28s %8.0f ns   (checksum %.15g)\n", name, best, sum);
}

int main(void) {
    make_points();
    measure("g_delta (3.14)", call_g_delta);
    measure("width (3.15)", call_width);
    measure("moments (3.18)", call_moments);
    measure("distance (4.9)", call_distance);
    measure("tip cell volume (4.18)", call_volume);
    measure("tip cell leak-off (4.24)", call_leakoff);
    return 0;
}
