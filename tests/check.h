/*
 * What every test begins with: cmocka and the headers it asks for, comparisons that can fail, and
 * the same random numbers always.
 *
 * A test collects its errors from NOTHING_YET by worst_of and hands the worst to assert_below. A
 * NaN stays in it until then; and where no error was collected at all, or where an error is itself
 * the worst of an empty set, the assertion fails too.
 */
#ifndef TESTS_CHECK_H
#define TESTS_CHECK_H

#include "../bench/common_worst.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* The worst of no errors. */
#define NOTHING_YET (-INFINITY)

/* The worse of the errors so far and one more: NaN once one was NaN, or was NOTHING_YET. */
double worst_of(double worst, double error);

/* |value / reference - 1|, and |value| where the reference is zero. */
double relative(double value, double reference);

/* Fails unless value <= bound, both of them finite: a worst of no errors is not. */
#define assert_below(value, bound) check_below(value, bound, #value, __FILE__, __LINE__)

/* Fails unless value >= bound, both of them finite: the least of no numbers, INFINITY, is not. */
#define assert_above(value, bound) check_above(value, bound, #value, __FILE__, __LINE__)

/* Fails unless |value - expected| <= error, a finite one; equal infinities are near too. */
#define assert_near(value, expected, error)                                                        \
    check_near(value, expected, error, #value, __FILE__, __LINE__)

/* What these stand for: the value's text and place are what is said of a failure. */
void check_below(double value, double bound, const char *what, const char *file, int line);
void check_above(double value, double bound, const char *what, const char *file, int line);
void check_near(double value, double expected, double error, const char *what, const char *file,
                int line);

/* The next of a sequence in -1 .. 1 that its seed determines: the same on every machine. */
double next_random(uint64_t *seed);

/* In 0 .. 1, from a seed that the program shares. */
double uniform(void);

#endif
