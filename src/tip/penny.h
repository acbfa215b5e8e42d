/*
 * A penny-shaped fracture, with which a run starts: constant rate Q from a point, uniform stress,
 * parameters anywhere in (tau, phi) of Dontsov and Peirce 2017, section 5.1.
 *
 * Its errors against the reference solution for phi = 0 .. 1e4 and tau = 1e-6 .. 1e6 are 0.02 % of
 * R, 0.3 % of V, 0.0002 of the efficiency, 0.1 % of the width up to rho = 0.95 and 0.2 % at 0.999,
 * and 0.1 % of the pressure; near the tip that is 1 % of the pressure at rho = 0.5. A solution is
 * found for parameters 100 powers of ten either way. A call takes 1 to 4 ms for a time and 5 to 13
 * ms for a radius. It allocates nothing.
 */
#ifndef ILSAI_PENNY_H
#define ILSAI_PENNY_H

#include <ilsa/material.h>

enum {
    ILSAI_PENNY_NODES = 25, /* of the profiles, from the source to the tip */
    ILSAI_PENNY_TIMES = 8   /* of the history that is computed, the last is t */
};

/* The radius through time: ln(t / t_end) is piecewise cubic in ln(R / R_end), before the first of
 * the times a power law. */
typedef struct penny_history {
    int count;
    double log_radius[ILSAI_PENNY_TIMES];
    double log_time[ILSAI_PENNY_TIMES];
    double alpha[ILSAI_PENNY_TIMES]; /* d ln R / d ln t */
} penny_history;

typedef struct penny_solution {
    ilsa_material_def scaled;
    double Q;          /* rate */
    double t;          /* time since the start of injection */
    double R;          /* radius */
    double V;          /* dR / dt */
    double alpha;      /* d ln R / d ln t */
    double efficiency; /* volume in the fracture / (Q t) */

    /* Private to penny.c. */
    double log_width[ILSAI_PENNY_NODES];
    double pressure[ILSAI_PENNY_NODES];       /* from node 1 on */
    double pressure_slope[ILSAI_PENNY_NODES]; /* d p / d ln(rho / (1 - rho)) */
    double tip_power;                         /* d ln w / d ln s at the outermost node */
    penny_history history;
} penny_solution;

/* The solution at a time t > 0. ILSA_ERR_VALUE if it cannot be found (parameters out of reach). */
ilsa_status ilsai_penny_at_time(const ilsa_material_def *scaled, double Q, double t,
                                penny_solution *solution);

/* The solution with radius R > 0. ILSA_ERR_VALUE if it cannot be found. */
ilsa_status ilsai_penny_at_radius(const ilsa_material_def *scaled, double Q, double R,
                                  penny_solution *solution);

/* Width at r = rho R, 0 <= rho < 1; its volume is efficiency Q t. 0 for rho >= 1. */
double ilsai_penny_width(const penny_solution *solution, double rho);

/* Net pressure p - sigma at rho; finite: constant below rho = 0.014 and above 0.9997. */
double ilsai_penny_pressure(const penny_solution *solution, double rho);

/* When the front passed r = rho R: between 0 and t, 0 at rho = 0, t at rho = 1. */
double ilsai_penny_arrival(const penny_solution *solution, double rho);

#endif
