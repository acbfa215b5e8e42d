/*
 * Leak-off: the fluid that a cell loses to the rock on both sides of the fracture in a step.
 *
 * Each function is of one cell and knows no solver. The law is Carter's (carter.c), C' / (t -
 * t_0)^(1/2) a unit of area and time since the front passed at t_0. Another law takes its place by
 * functions of these names and, where its loss depends on the pressure, by the derivative: the
 * coupled solve then has to take it to the diagonal of the Newton matrix, which it need not with
 * Carter's.
 */
#ifndef ILSAI_LEAKOFF_H
#define ILSAI_LEAKOFF_H

#include "tip/tip_cell.h"

/* Volume per area of the cell that it loses in a step, and the derivative by the fluid's pressure.
 */
typedef struct leakoff {
    double volume;
    double by_pressure; /* 0 by Carter's law */
} leakoff;

/*
 * The loss of a channel cell in a step from `time` on, of length dt: Dontsov and Peirce 2017,
 * (4.8), but with the mean over the cell in the place of the value at its centre. The front passed
 * the centre at `trigger` and the rest of the cell within `spread` before and after, see
 * ilsai_tip_cell_spread.
 */
leakoff ilsai_leakoff_channel(double C_prime, double time, double dt, double trigger,
                              double spread);

/*
 * The loss of a tip cell since the last knot but one of the front's path, Dontsov and Peirce 2017,
 * (4.25). `velocity` says whether the whole path counts or its ends alone.
 */
leakoff ilsai_leakoff_tip(double C_prime, tip_cell_velocity velocity, const tip_cell_front *front,
                          const tip_cell_history *path);

#endif
