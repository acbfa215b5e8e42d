/* A scene: what is to be run, read from a file and checked. */
#ifndef ILSA_RUN_SCENE_H
#define ILSA_RUN_SCENE_H

#include "keys.h"

#include <ilsa/ilsa.h>
#include <stdio.h>

/* The rate of a source from times[i] on is rates[i]; times[0] = 0. */
typedef struct scene_source {
    double x, y;
    int count;
    double *times, *rates;
    int line; /* of its rate or schedule, for messages */
} scene_source;

/* A stress log that the scene names. It is read after the scene, by stress_log_take. */
typedef struct scene_log {
    char *file; /* as in the scene; NULL: there is none */
    int has_origin_depth;
    double origin_depth; /* the depth of y = 0 */
    int rows;            /* once it is read: how many, and the y of the lowest and the highest */
    double bottom, top;
} scene_log;

typedef struct scene {
    const char *path;
    ilsa_material_def material;
    int laboratory; /* the material was given as E, nu, mu, ...: figures are labelled in SI */
    ilsa_mesh_def mesh;
    int interface_count;
    double *interfaces, *sigma; /* sigma: interface_count + 1; NULL until a log is read */
    scene_log log;
    scene_source *sources;
    int source_count;
    double radius, time;      /* of the initial fracture; one of them is 0 */
    double t_end, dt_initial; /* dt_initial: 0: not limited */
    double *output_times;
    int output_count;
    ilsa_solver_def options; /* without handles */
    /* For messages: of the headings, and of the keys, 0 where one was not given. */
    int headings[SECTION_COUNT], lines[SECTION_COUNT][KEYS_MAX];
} scene;

/*
 * Reads and checks a scene file. What is wrong with it goes to errors, a line each, with file,
 * line, key and valid range; the result is then 0.
 */
int scene_read(const char *path, scene *s, FILE *errors);

/*
 * Checks what only the started fracture can tell: that the times asked for lie after its own time,
 * and that the steps asked for move the clock on.
 */
int scene_check_start(const scene *s, double t_start, FILE *errors);

/* Says "file:line: [section] key" and the text. Where the key was not given: line of its heading.
 */
void scene_error(const scene *s, FILE *errors, int part, int key, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* "injection" for source 0, "injection.2" for source 1. The name stands in a buffer of the caller.
 */
enum { SOURCE_NAME_SIZE = 32 };
const char *scene_source_name(char *name, int source);

void scene_free(scene *s);

/* The rate of a source at a time, and the first time after t at which any rate changes. */
double scene_rate(const scene_source *source, double t);
double scene_next_change(const scene *s, double t);

#endif
