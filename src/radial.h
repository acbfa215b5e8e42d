/*
 * A penny-shaped fracture with its own parameters anywhere in (tau, phi) of section 5.1, for the
 * start of a run: constant rate Q from a point, uniform stress.
 */
#ifndef ILSAI_RADIAL_H
#define ILSAI_RADIAL_H

#include <ilsa/material.h>

enum {
    ILSAI_RADIAL_NODES = 25, /* of the profiles, from the source to the tip */
    ILSAI_RADIAL_TIMES = 8   /* of the history that is computed, the last is t */
};

/* The radius through time: ln(t/t_end) is piecewise cubic in ln(R/R_end), a power law at first. */
typedef struct radial_history {
    int count;
    double log_radius[ILSAI_RADIAL_TIMES];
    double log_time[ILSAI_RADIAL_TIMES];
    double alpha[ILSAI_RADIAL_TIMES]; /* d ln R / d ln t */
} radial_history;

typedef struct radial_solution {
    ilsa_material_def scaled;
    double Q;          /* rate */
    double t;          /* time since the start of injection */
    double R;          /* radius */
    double V;          /* dR / dt */
    double alpha;      /* d ln R / d ln t */
    double efficiency; /* volume in the fracture / (Q t) */

    /* Private to radial.c. */
    double log_width[ILSAI_RADIAL_NODES];
    double pressure[ILSAI_RADIAL_NODES];       /* from node 1 on */
    double pressure_slope[ILSAI_RADIAL_NODES]; /* d p / d ln(rho / (1 - rho)) */
    double tip_power;                          /* d ln w / d ln s at the outermost node */
    radial_history history;
} radial_solution;

/* The solution at a time t > 0. ILSA_ERR_VALUE if it cannot be found (parameters out of reach). */
ilsa_status ilsai_radial_at_time(const ilsa_material_def *scaled, double Q, double t,
                                 radial_solution *solution);

/* The solution with radius R > 0. As above. */
ilsa_status ilsai_radial_at_radius(const ilsa_material_def *scaled, double Q, double R,
                                   radial_solution *solution);

/* Width at r = rho R, 0 <= rho < 1; its volume is efficiency Q t. 0 for rho >= 1. */
double ilsai_radial_width(const radial_solution *solution, double rho);

/* Net pressure p - sigma at rho; a starting guess (2 % will do), finite for rho = 0 and near 1. */
double ilsai_radial_pressure(const radial_solution *solution, double rho);

/* When the front passed r = rho R: between 0 and t, 0 at rho = 0, t at rho = 1. */
double ilsai_radial_arrival(const radial_solution *solution, double rho);

#endif
