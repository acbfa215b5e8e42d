/*
 * The tip asymptote, Dontsov and Peirce 2017, section 3, without the checks of arguments that
 * ilsa/tip.h makes.
 *
 * The parameters of the material say which processes the asymptote includes: without toughness
 * K_prime is 0, without leak-off C_prime is 0, and toughness alone is mu_prime = 0 with K_prime >
 * 0.
 */
#ifndef ILSAI_ASYMPTOTE_H
#define ILSAI_ASYMPTOTE_H

#include <ilsa/tip.h>

/* The width at distance s > 0 behind a front of velocity V >= 0, (3.15). V = 0: the width
 * K' s^(1/2) / E'. */
double ilsai_asymptote_width(const ilsa_material_def *law, double V, double s);

/* The asymptote at a distance s. */
typedef struct asymptote_point {
    double w;        /* width */
    double M0;       /* integral of the width over 0 .. s */
    double exponent; /* d ln w / d ln s, 1/2 .. 2/3 */
    double by_V;     /* d ln w / d ln V, 0 .. 1/3 */
} asymptote_point;

/*
 * Sets the points at count distances s for V > 0. Falling distances are the fastest, because each
 * solution begins from the last one. The first width is exact and the others are so to 1e-12, but
 * for distances below a thousandth of the first: these follow a power law, to 0.2.
 */
void ilsai_asymptote_row(const ilsa_material_def *law, double V, int count, const double *s,
                         asymptote_point *point);

/* The moments M0 and M1 of the width over 0 .. s, (3.18), for V >= 0. w is the width at s. */
void ilsai_asymptote_moments(const ilsa_material_def *law, double V, double s, double w, double *M0,
                             double *M1);

/* d ln w / d ln s = (1 + Delta) / 2 at distance s, 1/2 .. 2/3, for V >= 0. w is the width at s. */
double ilsai_asymptote_exponent(const ilsa_material_def *law, double V, double s, double w);

/* Where a survey cell places the front, (4.9). */
typedef struct asymptote_front {
    double s;     /* distance of the front, >= s0 */
    double V;     /* (s - s0) / dt */
    double ds_dw; /* derivative of s by w; 0 where the front rests */
} asymptote_front;

/* Inverts the asymptote for width w, where the front was at distance s0 a time dt before. */
asymptote_front ilsai_asymptote_distance(const ilsa_material_def *law, double w, double s0,
                                         double dt);

/* ilsai_asymptote_distance, with its iteration begun at the distance `near`. */
asymptote_front ilsai_asymptote_distance_near(const ilsa_material_def *law, double w, double s0,
                                              double dt, double near);

#endif
