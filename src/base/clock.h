/* The wall time in seconds. It serves the report and the profile and no result depends on it. */
#ifndef ILSAI_CLOCK_H
#define ILSAI_CLOCK_H

#include <time.h>

static inline double ilsai_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
