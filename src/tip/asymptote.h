/* The tip asymptote without argument checks: for use inside the library. Section 3. */
#ifndef ILSAI_ASYMPTOTE_H
#define ILSAI_ASYMPTOTE_H

#include <ilsa/tip.h>

/*
 * Which processes the tip model includes is carried by the parameters: K_prime = 0, C_prime = 0, or
 * mu_prime = 0 with K_prime > 0 for toughness alone.
 */
typedef ilsa_material_def ilsa_material_def;

/* Width at distance s > 0 behind a front of velocity V >= 0, (3.15); V = 0: toughness width. */
double ilsai_asymptote_width(const ilsa_material_def *law, double V, double s);

/*
 * The asymptote at a distance: width, M0 over [0, s], d ln w / d ln s (1/2 .. 2/3), d ln w / d ln V
 * (0 .. 1/3).
 */
typedef struct asymptote_point {
    double w, M0, exponent, by_V;
} asymptote_point;

/*
 * The same at count distances, best in falling order: each is begun from the last, and all but the
 * first are found to 1e-12; those below a thousandth of it follow by a power law, to 0.2.
 */
void ilsai_asymptote_row(const ilsa_material_def *law, double V, int count, const double *s,
                         asymptote_point *point);

/* M0 and M1 over [0, s] of (3.18) for V >= 0 (V = 0: Delta_p = 0), w the width at s. */
void ilsai_asymptote_moments(const ilsa_material_def *law, double V, double s, double w, double *M0,
                             double *M1);

/* d ln w / d ln s at distance s for V >= 0, w the width there: 1/2 .. 2/3, (1 + Delta) / 2. */
double ilsai_asymptote_exponent(const ilsa_material_def *law, double V, double s, double w);

/* The survey-cell inversion (4.9). */
typedef struct asymptote_front {
    double s;     /* distance to the front, >= s0 */
    double V;     /* (s - s0) / dt */
    double ds_dw; /* derivative of s with respect to w; 0 for an arrested front */
} asymptote_front;

asymptote_front ilsai_asymptote_distance(const ilsa_material_def *law, double w, double s0,
                                         double dt);

/* The same, begun from a distance that may be near it. */
asymptote_front ilsai_asymptote_distance_near(const ilsa_material_def *law, double w, double s0,
                                              double dt, double near);

#endif
