/* The largest and the least of many numbers, in which a NaN cannot hide. */
#ifndef BENCH_COMMON_WORST_H
#define BENCH_COMMON_WORST_H

#include <math.h>

/*
 * The larger and the smaller of two, NaN if either of them is one: `worst = larger_of(worst,
 * error)` stays NaN once it has seen a NaN, whatever comes later. fmax and fmin would leave it out.
 */
static inline double larger_of(double a, double b) {
    return isnan(a) || b <= a ? a : b;
}

static inline double smaller_of(double a, double b) {
    return isnan(a) || b >= a ? a : b;
}

#endif
