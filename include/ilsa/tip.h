/*
 * The closed-form three-process tip asymptote of a fluid-driven fracture, section 3 of Dontsov and
 * Peirce (ilsa/ilsa.h has the full citation). The functions are pure, have no handle and are safe
 * from any thread.
 *
 * The parameters say which processes there are. K_prime = 0 leaves out toughness, C_prime = 0
 * leak-off. mu_prime = 0 leaves out viscosity, and leak-off with it; it needs K_prime > 0, as in a
 * material, and w = K' s^(1/2) / E' at every velocity.
 *
 * Arguments may be of the whole double range, subnormal numbers included. A result beyond the
 * largest double is refused with ILSA_ERR_VALUE and leaves all outputs as they were. A result below
 * the smallest is rounded as usual, to a subnormal number or 0. No function raises FE_INVALID or
 * FE_DIVBYZERO, and none raises FE_OVERFLOW unless it refuses a result.
 */
#ifndef ILSA_TIP_H
#define ILSA_TIP_H

#include <ilsa/material.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Returns g_delta(K_hat, C_hat) of (3.14), with K_hat = K' s^(1/2) / (E' w) >= 0 and
 * C_hat = 2 C' s^(1/2) / (V^(1/2) w) >= 0. It is 0 for K_hat >= 1, and NaN for a NaN, negative or
 * infinite argument.
 */
ILSA_API double ilsa_tip_g_delta(double K_hat, double C_hat);

/*
 * Returns Delta_p(K_hat, C_hat, p) of (3.17), 0 <= p <= 1; p = 0 gives Delta itself. It is 0 for
 * K_hat >= 1, and NaN for a NaN or infinite argument or one out of its range.
 */
ILSA_API double ilsa_tip_delta_p(double K_hat, double C_hat, double p);

/*
 * Writes the width w at distance s > 0 behind a front that moves at V >= 0, (3.15). V = 0 gives the
 * toughness width K' s^(1/2) / E'. ILSA_ERR_NULL, ILSA_ERR_VALUE.
 */
ILSA_API ilsa_status ilsa_tip_width(const ilsa_material_def *scaled, double V, double s, double *w);

/*
 * Writes the moments of the width over [0, s] (3.18), with p0 = 0.377 and p1 = 0.260, for the width
 * w that ilsa_tip_width gives at s: M0 in length^2, M1 in length^3.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE.
 */
ILSA_API ilsa_status ilsa_tip_moments(const ilsa_material_def *scaled, double V, double s, double w,
                                      double *M0, double *M1);

/*
 * Inverts the width of a survey cell (4.9): writes the distance s >= s0 from a cell of width w > 0
 * to the front, and the velocity V = (s - s0) / dt >= 0, when the distance was s0 > 0 a time dt > 0
 * ago. V = 0 and s = s0 where the stress intensity is below the toughness (K_hat > 1 at s0). With
 * mu_prime = 0 the distance is the larger of s0 and (E' w / K')^2.
 * A distance of more than 1e200 times s0 may be refused with
 * ILSA_ERR_VALUE though it is in the double range.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE.
 */
ILSA_API ilsa_status ilsa_tip_distance(const ilsa_material_def *scaled, double w, double s0,
                                       double dt, double *s, double *V);

/* The place of a width in the parametric triangle (3.19), (3.20). */
typedef struct ilsa_tip_regime {
    double N_k, N_mt,
        N_m;     /* shape functions of toughness, leak-off and viscosity; their sum is 1 */
    double x, y; /* m is at (0, 0), m-tilde at (1/2, 3^(1/2)/2), k at (1, 0) */
} ilsa_tip_regime;

/*
 * Writes the place of the width w at distance s behind a front of velocity V >= 0; V = 0 is the k
 * vertex. In the figures of the paper it has the colour red = N_k, green = N_mt, blue = N_m.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE.
 */
ILSA_API ilsa_status ilsa_tip_triangle(const ilsa_material_def *scaled, double V, double s,
                                       double w, ilsa_tip_regime *regime);

#ifdef __cplusplus
}
#endif
#endif
