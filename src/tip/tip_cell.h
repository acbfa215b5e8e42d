/*
 * A tip cell, which is one that the front crosses: its fluid volume, Dontsov and Peirce 2017,
 * (4.15) to (4.18), and its leak-off, (4.20) to (4.25). The far corner is included, so that both
 * hold until the cell is full and after that.
 *
 * The front in a cell is a straight line with normal (cos_a, sin_a), both >= 0, at distance ell
 * from the farthest interior corner. The wet part is a polygon. Its chord at distance s from that
 * corner has a length that is a trapezoid in s.
 */
#ifndef ILSAI_TIP_CELL_H
#define ILSAI_TIP_CELL_H

#include "tip/asymptote.h"

typedef struct tip_cell_front {
    double ell;          /* distance of the front from the farthest interior corner, may be <= 0 */
    double cos_a, sin_a; /* normal, pointing out of the fracture, reflected into 0 .. pi/2 */
    double dx, dy;       /* cell size */
} tip_cell_front;

/*
 * The volume of fluid in the cell, a length^3 that is not divided by dx dy, 0 for ell <= 0. Behind
 * a front of velocity V > 0 the width is the asymptote. Behind a front at rest, V = 0, it is K_I
 * s^(1/2) / E' with the stress intensity K_I scaled as K'.
 */
double ilsai_tip_cell_volume(const ilsa_material_def *law, double V, double K_I,
                             const tip_cell_front *front);

/* Distances and weights of the sums over the wet part of a cell that the functions here take. */
enum { TIP_CELL_NODES = 8 };
typedef struct tip_cell_nodes {
    int count;
    double xi[TIP_CELL_NODES], weight[TIP_CELL_NODES];
} tip_cell_nodes;
tip_cell_nodes ilsai_tip_cell_nodes(const tip_cell_front *front);

/*
 * The volume with its derivatives by ell and by ln V, each with the other held. The second one
 * leaves out the derivative of M0 / w, which is less than 0.03 of the volume.
 */
typedef struct tip_cell_growth {
    double volume, by_ell, by_log_V;
} tip_cell_growth;
tip_cell_growth ilsai_tip_cell_growth(const ilsa_material_def *law, double V, double K_I,
                                      const tip_cell_nodes *nodes);

/* The volume of the width that a stress step of h / E' = 1 a distance d behind the front adds, see
 * stress_step.h, and its derivatives by ell and by d, each with the other held. */
typedef struct tip_cell_step {
    double volume, by_ell, by_d;
} tip_cell_step;
tip_cell_step ilsai_tip_cell_step(double d, const tip_cell_nodes *nodes);

/* The area of the wet part of the cell, 0 .. dx dy. */
double ilsai_tip_cell_area(const tip_cell_front *front);

/*
 * The path of the front since it entered the cell: it was at distance ell[k] at time t[k] for
 * k = 0 .. count - 1. Times increase and ell does not decrease. The first knot is the entry, ell =
 * 0, and the last one is the present.
 */
enum { TIP_CELL_KNOTS = 16 };
typedef struct tip_cell_history {
    int count;
    double t[TIP_CELL_KNOTS], ell[TIP_CELL_KNOTS];
} tip_cell_history;

/* Begins a path with the front at the interior corner at time t_A. */
void ilsai_tip_cell_enter(tip_cell_history *history, double t_A);

/*
 * Corrects the distance of the front at the last knot to ell, but to no less than that of the knot
 * before and to no more than `most`. The knot of the entry stays as it is.
 */
void ilsai_tip_cell_amend(tip_cell_history *history, double ell, double most);

/*
 * Appends the front at distance ell at time t, which is later than the last knot. An ell below that
 * of the last knot is taken as the latter. A full path drops the inner knot whose loss changes it
 * least.
 */
void ilsai_tip_cell_record(tip_cell_history *history, double t, double ell);

/*
 * The volume that has leaked from the cell until the time of the last knot, >= 0, a length^3. It is
 * 2 C' times the integral of (t - t_0)^(1/2) over the wet part, by the path of the front, (4.20)
 * and (4.22); (4.24) has the opposite sign.
 */
double ilsai_tip_cell_leakoff(double C_prime, const tip_cell_front *front,
                              const tip_cell_history *history);

/* Whether the whole path counts, or its ends alone as in (4.21) and (4.23), for comparisons. */
typedef enum tip_cell_velocity { TIP_CELL_HISTORY, TIP_CELL_CONSTANT } tip_cell_velocity;

/* The volume that has leaked since the last knot but one, as the difference of two totals. */
double ilsai_tip_cell_leakoff_last(double C_prime, tip_cell_velocity velocity,
                                   const tip_cell_front *front, const tip_cell_history *history);

/*
 * The volume that has leaked by a path of any number of knots. The front moves linearly from one
 * knot to the next, and the last knot is the present. front->ell plays no part. The result is exact
 * for the path given, so that one segment gives (4.21) and (4.23).
 */
double ilsai_tip_cell_leakoff_path(double C_prime, const tip_cell_front *front, int count,
                                   const double *t, const double *ell);

/*
 * The volume per area that has leaked from a full cell: 2 C' times the mean of (t - t_0)^(1/2) over
 * it. The front passed the centre a time `age` ago, and the rest of the cell evenly within `spread`
 * before and after that. With spread = 0 this is (4.8).
 */
double ilsai_tip_cell_full_leakoff(double C_prime, double age, double spread);

/* The volume per area that leaks from a full cell between age and age + dt, without cancellation.
 */
double ilsai_tip_cell_full_leakoff_step(double C_prime, double age, double dt, double spread);

/* The spread of a cell that the front took the time T to pass: the one of the same variance. */
double ilsai_tip_cell_spread(const tip_cell_front *front, double T);

#endif
