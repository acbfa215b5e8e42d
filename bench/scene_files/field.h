/*
 * Field scenes: files as ilsa-run takes them, run to their end and judged after every step.
 *
 * Right is a run that ends at its own end, or at the edge of a mesh that the scene does not let
 * coarsen, with every volume balanced, no NaN, no negative width, and every pressure between -1 and
 * 1 GPa, within the CPU time that it was given.
 */
#ifndef BENCH_FIELD_H
#define BENCH_FIELD_H

#include <ilsa/ilsa.h>

/* What is bounded, and how. */
#define FIELD_BALANCE  1e-9 /* of the injected volume */
#define FIELD_PRESSURE 1e9  /* Pa */
#define FIELD_SECONDS  60   /* of CPU time */

/* One run: a file, and how it is to differ from what stands there. Zeros change nothing. */
typedef struct field_case {
    char file[200];
    int level;           /* 1 .. 5; 0: the file's */
    int finer;           /* cells are halved so many times */
    double stress_noise; /* the stress of each layer times 1 + this times a number in -1 .. 1 */
    double radius_part;  /* the starting radius times 1 + this */
    double cell_part;    /* dx and dy times 1 + this */
    double seconds;      /* of CPU time that it may take; 0: FIELD_SECONDS */
} field_case;

typedef enum field_verdict { FIELD_RIGHT, FIELD_EDGE, FIELD_WRONG } field_verdict;

typedef struct field_result {
    field_verdict verdict;                         /* FIELD_EDGE: right, at the edge of its mesh */
    char what[240];                                /* is wrong */
    double seconds;                                /* of CPU time */
    double balance, least_pressure, most_pressure; /* the worst of all steps */
    double net_pressure;                           /* at source 0, at the end */
    double across; /* cells across the layer of source 0, or as much of it as is wet */
    double dx, dy; /* at the end */
    ilsa_summary end;
} field_result;

/* Called as each run ends, in the order of the runs' ends. */
typedef void field_shown(const field_case *run, const field_result *result, void *user);

/*
 * Runs count cases, each in a process of its own and as many at once as there are processors; a
 * process that dies is a wrong result. shown may be NULL.
 */
void field_run(const field_case *runs, field_result *results, int count, field_shown *shown,
               void *user);

#endif
