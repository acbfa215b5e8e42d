/*
 * Memory that fails on demand, for every test: what the library and the tests ask for by malloc,
 * calloc, realloc and FFTW's like of them, FFTW's plans, and threads. The linker leads these calls
 * to failing.c (--wrap, see the Makefile), under the sanitizers and valgrind too. What shared
 * libraries ask for by themselves is not led there.
 */
#ifndef TESTS_FAILING_H
#define TESTS_FAILING_H

/*
 * How many requests of this thread succeed from now on; negative: all. After them one fails, or
 * all that come until this is set anew.
 */
extern _Thread_local int allocations_left;
extern _Thread_local int one_allocation_fails;

/* How many of this thread have failed so far. */
extern _Thread_local int allocations_failed;

#endif
