/*
 * Radial runs of the planar solver against the reference of tests/data, for the accuracy tables and
 * for tests/test_accuracy.c. E' = Q = 1 throughout. The programs run from the top of the tree.
 */
#ifndef BENCH_COMMON_RADIAL_H
#define BENCH_COMMON_RADIAL_H

#include <ilsa/ilsa.h>

/* A penny-shaped fracture at a time, or what a run made of it. */
typedef struct penny {
    double time, R, efficiency;
    double width;      /* at the centre */
    double width_half; /* at rho = 0.5 */
    double pressure_half;
} penny;

/* The material that a run is made with. */
typedef struct penny_law {
    const char *name;
    double mu_prime, K_prime, C_prime;
} penny_law;

/* The four vertices and the middle of the triangle, each at a time where it is that. */
typedef struct penny_case {
    penny_law law;
    double time;
} penny_case;

enum { PENNY_M, PENNY_M_TILDE, PENNY_K, PENNY_K_TILDE, PENNY_MIDDLE, PENNY_CASES };
extern const penny_case penny_cases[PENNY_CASES];

/* How it is run. */
typedef struct radial_def {
    penny_law law;
    double dx;         /* cell size along x */
    double aspect;     /* dx / dy */
    double mesh_cells; /* largest radius that the mesh holds, in cells of dx */
    double step_cells; /* 0: by level */
    int level;         /* 0: the default */
    int coarsen;
    ilsa_tip_model tip;
    double rate; /* at first; 0: 1 */
} radial_def;

/* What a front is like. */
typedef struct radial_front {
    double mean;           /* radius, weighted by angle */
    double low, high;      /* least and largest radius */
    double axis, diagonal; /* along x, along x = y */
} radial_front;

/* Rows of tests/data/radial_history.csv: the phi and the tau that it has. */
enum { RADIAL_PHIS = 7, RADIAL_TAUS = 49 };
double radial_phi(int phi_index);
/* The row; tau in quarters of a decade from 1e-6. */
penny radial_row(int phi_index, int tau_index);
/* The law of (5.1): mu' = K' = 1, C' = phi^(1/4). */
penny_law radial_law(double phi);

/*
 * The same at any time, for any law: from the table and its neighbours where mu' = K' = 1 and phi
 * is one of the table's (error of the interpolation below 1e-5), else from the library's own
 * penny-shaped start (R to 2e-4, measured against the table).
 */
penny radial_reference(penny_law law, double time);
/* And the time at which it has a radius. */
double radial_time_of(penny_law law, double R);

/* By how much a penny differs: in parts of the reference, of the efficiency absolute. */
penny radial_error(const penny *found, const penny *reference);

/* Starts at a radius; NULL and a message on stderr if that fails. */
ilsa_solver *radial_start(const radial_def *def, double R);

/*
 * The same from the penny at a time, on a mesh that holds `largest` cells per radius, which are
 * half as many now, and coarsens itself.
 */
ilsa_solver *radial_start_at(penny_law law, double time, double largest);

/* As ilsa_advance, and gives up with ILSA_STALLED after so many attempts, refused ones included. */
ilsa_status radial_advance(ilsa_solver *solver, double time, long attempts);

/* Where it stands: radii of the front; width and pressure on the x axis. */
radial_front radial_measure(ilsa_solver *solver);
penny radial_state(ilsa_solver *solver);

/* What a case came to. */
typedef struct radial_growth {
    ilsa_status status;
    penny reference, state; /* where it ended */
    radial_front front;
    double roundness; /* (largest - smallest radius) / mean: worst over the last fifth of R */
    double balance;   /* (fracture + leaked) / injected - 1 */
    ilsa_report total;
} radial_growth;

/*
 * From half the radius to the time of the case, with so many cells of dx per radius at the end;
 * aspect = dx / dy; step_cells as in the solver's definition, 0: by level.
 */
radial_growth radial_grow(const penny_case *c, double cells, double aspect, double step_cells);

/* Middle of count values, which are sorted in place; NaN for none. */
double radial_median(double *values, int count);

#endif
