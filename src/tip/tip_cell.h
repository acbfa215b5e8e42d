/*
 * A cell that the front crosses: fluid volume (4.15)-(4.18) and leak-off (4.20)-(4.25), with the
 * far corner included, so that both hold until the cell is full and beyond.
 *
 * The front in a cell is a straight line with normal (cos_a, sin_a), both >= 0, at distance ell
 * from the interior corner; the wet part is a polygon whose chord at distance s from that corner
 * has a trapezoidal length.
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
 * Volume of fluid in the cell (a length^3: not divided by dx dy) behind a front of velocity V > 0,
 * or V = 0 and stress intensity K_I (scaled as K'): w = K_I s^(1/2) / E'. 0 for ell <= 0.
 */
double ilsai_tip_cell_volume(const ilsa_material_def *law, double V, double K_I,
                             const tip_cell_front *front);

/*
 * The same with its derivatives by ell and by ln V, each with the other held; the second leaves out
 * that of M0 / w, which is less than 0.03 of the volume.
 */
typedef struct tip_cell_growth {
    double volume, by_ell, by_log_V;
} tip_cell_growth;
tip_cell_growth ilsai_tip_cell_growth(const ilsa_material_def *law, double V, double K_I,
                                      const tip_cell_front *front);

/* The volume of the width that a stress step of height 1 adds at a distance d behind the front. */
double ilsai_tip_cell_step_volume(double d, const tip_cell_front *front);
tip_cell_growth ilsai_tip_cell_step_growth(double d, const tip_cell_front *front);

/* Part of the cell that is wet, area, 0 .. dx dy. */
double ilsai_tip_cell_area(const tip_cell_front *front);

/*
 * Where the front was since it entered the cell: ell[k] at time t[k], k = 0 .. count - 1, times
 * increasing, ell not decreasing; ell[0] = 0 at t[0] = t_A. The last knot is the present.
 */
enum { TIP_CELL_KNOTS = 16 };
typedef struct tip_cell_history {
    int count;
    double t[TIP_CELL_KNOTS], ell[TIP_CELL_KNOTS];
} tip_cell_history;

/* Begins a history with the front at the interior corner at time t_A. */
void ilsai_tip_cell_enter(tip_cell_history *history, double t_A);

/*
 * Says anew where the front was at the last knot: ell is held between that of the knot before and
 * most. The knot of the entry stays.
 */
void ilsai_tip_cell_amend(tip_cell_history *history, double ell, double most);

/*
 * Appends the front at distance ell at time t, later than the last knot; an ell below the last is
 * taken as the last. A full history drops the inner knot whose loss changes the path least.
 */
void ilsai_tip_cell_record(tip_cell_history *history, double t, double ell);

/*
 * Fluid leaked from the cell until the time of the last knot, >= 0, length^3 (minus (4.24)):
 * 2 C' times the integral of (t - t_0)^(1/2) over the wet part, by the path of the front, (4.20)
 * and (4.22).
 */
double ilsai_tip_cell_leakoff(double C_prime, const tip_cell_front *front,
                              const tip_cell_history *history);

/* Whether the path counts, or its ends alone as (4.21) and (4.23) have it: to compare with. */
typedef enum tip_cell_velocity { TIP_CELL_HISTORY, TIP_CELL_CONSTANT } tip_cell_velocity;

/* The part of it that has leaked since the last knot but one, by one and the same formula. */
double ilsai_tip_cell_leakoff_last(double C_prime, tip_cell_velocity velocity,
                                   const tip_cell_front *front, const tip_cell_history *history);

/*
 * The same for a path of any number of knots: the front moves linearly from
 * (t[k], ell[k]) to (t[k + 1], ell[k + 1]) and the last knot is the present. front->ell plays no
 * part. Exact for the path given, so that one segment is (4.21) and (4.23).
 */
double ilsai_tip_cell_leakoff_path(double C_prime, const tip_cell_front *front, int count,
                                   const double *t, const double *ell);

/*
 * Once the cell is full: 2 C' times the mean of (t - t_0)^(1/2) over it, per area, when the front
 * passed the centre a time `age` ago and passed the rest evenly within `spread` before and after.
 * (4.8) is spread = 0. A cell that the front takes the time T to pass in has the spread below: that
 * of the same variance.
 */
double ilsai_tip_cell_full_leakoff(double C_prime, double age, double spread);

/* What leaks of that in the time dt from the age on, without cancellation. */
double ilsai_tip_cell_full_leakoff_step(double C_prime, double age, double dt, double spread);

double ilsai_tip_cell_spread(const tip_cell_front *front, double T);

#endif
