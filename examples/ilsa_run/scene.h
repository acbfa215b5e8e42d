/* A scene: what is to be run, read from a file and checked. */
#ifndef ILSA_RUN_SCENE_H
#define ILSA_RUN_SCENE_H

#include <ilsa/ilsa.h>
#include <stdio.h>

/* The rate of a source from times[i] on is rates[i]; times[0] = 0. */
typedef struct scene_source {
    double x, y;
    int count;
    double *times, *rates;
    int line; /* of its rate or schedule, for messages */
} scene_source;

typedef struct scene {
    const char *path;
    ilsa_material_def material;
    int laboratory; /* the material was given as E, nu, mu, ...: figures are labelled in SI */
    ilsa_mesh_def mesh;
    ilsa_symmetry symmetry;
    int interface_count;
    double *interfaces, *sigma; /* sigma: interface_count + 1 */
    scene_source *sources;
    int source_count;
    double radius, time;              /* of the initial fracture; one of them is 0 */
    double t_end, dt_initial, dt_max; /* dt_*: 0: not limited */
    double closure_width;             /* 0: the library's own */
    double *output_times;
    int output_count;
    int level, coarsen, threads;
    ilsa_tip_model tip;
    int symmetry_line, initial_line, t_end_line, output_line; /* for messages */
} scene;

/*
 * Reads and checks a scene file. What is wrong with it goes to errors, a line each, with file,
 * line, key and valid range; the result is then 0.
 */
int scene_read(const char *path, scene *s, FILE *errors);

/*
 * Checks what only the started fracture can tell: that the times asked for lie after its own time.
 */
int scene_check_start(const scene *s, double t_start, FILE *errors);

void scene_free(scene *s);

/* The rate of a source at a time, and the first time after t at which any rate changes. */
double scene_rate(const scene_source *source, double t);
double scene_next_change(const scene *s, double t);

#endif
