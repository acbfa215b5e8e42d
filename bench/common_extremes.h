/*
 * The map of extremes: scenes where nobody looks, each run in a process of its own so that a crash
 * or a hang is a row of the table like any other. For bench/extremes.c and tests/test_extremes.c;
 * the programs run from the top of the tree.
 */
#ifndef BENCH_COMMON_EXTREMES_H
#define BENCH_COMMON_EXTREMES_H

#include "common_radial.h"

#include <stddef.h>

typedef enum extreme_verdict {
    EXTREME_RIGHT,   /* reached its end, all that is checked held */
    EXTREME_REFUSED, /* a status with a message, the state as it was */
    EXTREME_FAILED,
    EXTREME_VERDICTS
} extreme_verdict;

typedef struct extreme_result {
    extreme_verdict verdict;
    char what[240]; /* status and message, or what did not hold; "" */
    double error_R; /* where there is a reference: of the radius, in parts; else 0 */
    long steps, refused;
    double seconds;
} extreme_result;

enum { EXTREME_INTERFACES = 3 };

/*
 * E' = Q = 1. Lengths in cells, the larger of dx and dy where they differ; stresses in net
 * pressures of the penny at rho = 0.5 as it starts.
 */
typedef struct extreme_scene {
    penny_law law;
    double end;         /* time at which a penny in uniform stress has the radius `last` */
    double first, last; /* radius of the penny at the start, and of one at `end` */
    double aspect;      /* dx / dy */
    double room;        /* half of the mesh */
    double x, y;        /* source */
    int interfaces;     /* of layers, at y[] with sigma[interfaces + 1] from below */
    double interface_y[EXTREME_INTERFACES], sigma[EXTREME_INTERFACES + 1];
    double (*stress)(double x, double y); /* NULL, or by place */
    double scale;                         /* of that stress */
    int whole;                            /* 1: no use of symmetry */
    int coarsen;
    int to_edge; /* 1: the edge of the mesh is an end as good as the time */
} extreme_scene;

/* A scene that runs: what its script works on. */
typedef struct extreme_trial {
    extreme_scene scene;
    double parameter;  /* of the script */
    double cell, unit; /* length of a cell, net pressure at the start */
    double start;      /* time at the start */
    ilsa_solver *solver;
    ilsa_status status; /* of the last step that was asked for */
    extreme_result *result;
    void *image;
    size_t image_size;
    double deadline;
} extreme_trial;

typedef void extreme_script(extreme_trial *t);

/* A kind of extremes: calls extreme_case for each of its cases. */
typedef struct extreme_sweep extreme_sweep;
typedef struct extreme_kind {
    const char *name, *about;
    void (*cases)(extreme_sweep *sweep);
} extreme_kind;

extern const extreme_kind extreme_kinds[];
extern const int extreme_kind_count;

/* What a sweep over a kind came to; shown is called with each case as it ends, or NULL. */
struct extreme_sweep {
    const extreme_kind *kind;
    int stride; /* of its cases only each stride-th is run, the first always */
    void (*shown)(const extreme_sweep *sweep, const char *name, const extreme_result *result);
    int offered, cases, count[EXTREME_VERDICTS];
    double seconds, worst_R;
};

/* All cases of a kind, or each stride-th of them. */
extreme_sweep extreme_sweep_over(const extreme_kind *kind, int stride,
                                 void (*shown)(const extreme_sweep *, const char *,
                                               const extreme_result *));

/* One case; called by the functions of kinds. The name is made as by printf. */
void extreme_case(extreme_sweep *sweep, const extreme_scene *scene, extreme_script *script,
                  double parameter, const char *name, ...) __attribute__((format(printf, 5, 6)));

/* ---- For scripts: all end the trial with a verdict when something does not hold. ----------- */

/* Whether the trial still runs. */
int extreme_running(const extreme_trial *t);

void extreme_fail(extreme_trial *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* On to a time by the solver's own steps. */
void extreme_go(extreme_trial *t, double time);

/* One step of exactly dt, which may be refused; its status. */
ilsa_status extreme_step(extreme_trial *t, double dt);

void extreme_set_rate(extreme_trial *t, double rate);
double extreme_time(const extreme_trial *t);

/* Fails the trial unless the mean radius is within 2 % of the penny's at the time now. */
void extreme_check_radius(extreme_trial *t);

#endif
