/* Small helpers of tests of numbers: errors that a NaN cannot hide, the same random numbers always.
 */
#ifndef TESTS_NUMBERS_H
#define TESTS_NUMBERS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static inline double larger(double a, double b) {
    return !(b <= a) ? b : a; /* a NaN wins, so that a test cannot miss it */
}

static inline double relative(double value, double reference) {
    return reference != 0.0 ? fabs(value / reference - 1.0) : fabs(value);
}

static inline void assert_below(double value, double bound) {
    if (!(value <= bound))
        fail_msg("%.3g exceeds %.3g", value, bound);
}

/* Marsaglia's xorshift: the same numbers on every machine. */
static uint64_t random_state = 88172645463325252u;

static inline double uniform(void) {
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (double)(random_state >> 11) / 9007199254740992.0;
}

#endif
