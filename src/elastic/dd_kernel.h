/*
 * The displacement-discontinuity kernel of a homogeneous elastic medium, Dontsov and Peirce 2017,
 * (4.6), with the sign corrected: see docs/theory.md, sections 7 and 14.
 */
#ifndef ILSAI_DD_KERNEL_H
#define ILSAI_DD_KERNEL_H

/*
 * The pressure over E' at the centre of a cell that a width of 1 in another brings about. The cells
 * are dx by dy, and i columns and j rows apart. The entry of a cell with itself is positive, all
 * others are negative. The relative error is 2e-15 at any offset.
 */
double ilsai_dd_kernel(long i, long j, double dx, double dy);

#endif
