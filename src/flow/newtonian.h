/*
 * A Newtonian fluid in laminar flow: Poiseuille's law, Dontsov and Peirce 2017, (2.3) and (4.3).
 * Through a face flows w^3 / mu' times the pressure gradient, where w is the mean of the widths of
 * both cells.
 *
 * Of the three factors of w^3 two are of the end of the step and one is the mean over the step.
 * Where the front moves on, the flux through a face is V w. It grows with the width during the step
 * and its mean is V w_mean, while the pressure gradient at the end is mu' V / w^2. With w^3 of the
 * end alone the flux beside the front would be too large by the growth of w in a step, which is the
 * same part on any mesh.
 */
#ifndef ILSAI_NEWTONIAN_H
#define ILSAI_NEWTONIAN_H

#include "flow/lubrication.h"

extern const fluid ilsai_newtonian;

#endif
