#include "stress_log.h"

#include "profile.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* As many as twice the rows of cells that a mesh may have. */
enum { LAYERS_MOST = 2000000 };

/* "logs/a.csv" in the directory of the scene. NULL: no memory. */
static char *beside(const char *scene_path, const char *file) {
    const char *slash = *file == '/' ? NULL : strrchr(scene_path, '/');
    size_t directory = slash ? (size_t)(slash - scene_path) + 1 : 0, size = strlen(file) + 1;
    char *path = malloc(directory + size);
    if (path) {
        memcpy(path, scene_path, directory);
        memcpy(path + directory, file, size);
    }
    return path;
}

/*
 * The log, y rising with sigma, as it is or turned about y = 0. Means below y = 0 are those of the
 * turned log above it, so that a log that mirrors itself gives mirrored cells the same bits.
 */
typedef struct view {
    const profile *p;
    int turned;
} view;

static double y_at(view v, int i) {
    return v.turned ? -v.p->place[v.p->count - 1 - i] : v.p->place[i];
}

static double sigma_at(view v, int i) {
    return v.p->sigma[v.turned ? v.p->count - 1 - i : i];
}

/* The first row above y; the number of rows where there is none. */
static int first_above(view v, double y) {
    int low = 0, high = v.p->count;
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (y_at(v, middle) > y)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* The stress at y, which lies between the row above and the one before. */
static double between(view v, int above, double y) {
    if (above == 0)
        return sigma_at(v, 0);
    double low = sigma_at(v, above - 1);
    if (above == v.p->count || low == sigma_at(v, above))
        return low;
    double y0 = y_at(v, above - 1), y1 = y_at(v, above);
    return (low * (y1 - y) + sigma_at(v, above) * (y - y0)) / (y1 - y0);
}

/* Its mean over y0 .. y1; equal values give that value as it stands. */
static double mean(view v, double y0, double y1) {
    int i = first_above(v, y0);
    double left = y0, from = between(v, i, y0), first = from, sum = 0;
    int same = 1;
    for (; i < v.p->count && y_at(v, i) < y1; i++) {
        sum += 0.5 * (from + sigma_at(v, i)) * ((y_at(v, i) - left) / (y1 - y0));
        left = y_at(v, i);
        from = sigma_at(v, i);
        same = same && from == first;
    }
    double last = between(v, i, y1);
    return same && last == first ? first : sum + 0.5 * (from + last) * ((y1 - left) / (y1 - y0));
}

static void add_layer(scene *sc, double bottom, double sigma) {
    if (sigma == sc->sigma[sc->interface_count])
        return;
    sc->interfaces[sc->interface_count++] = bottom;
    sc->sigma[sc->interface_count] = sigma;
}

/* Layers of half a cell, those of equal stress joined. y = 0 is an edge or the middle of a cell. */
static int fill_layers(scene *sc, const profile *p, FILE *errors) {
    double half = 0.5 * sc->mesh.dy;
    double first = floor(sc->log.bottom / half), last = ceil(sc->log.top / half);
    if (!(last - first <= LAYERS_MOST)) {
        scene_error(sc, errors, SECTION_STRESS, STRESS_PROFILE,
                    " = %s: reaches over %.10g cells of dy; must be at most %d", sc->log.file,
                    0.5 * (last - first), LAYERS_MOST / 2);
        return 0;
    }
    sc->interfaces = malloc((size_t)(last - first + 1) * sizeof *sc->interfaces);
    sc->sigma = malloc((size_t)(last - first + 2) * sizeof *sc->sigma);
    if (!sc->interfaces || !sc->sigma) {
        scene_error(sc, errors, SECTION_STRESS, STRESS_PROFILE, " = %s: out of memory",
                    sc->log.file);
        return 0;
    }
    sc->sigma[0] = p->sigma[0];
    for (int k = (int)first; k < (int)last; k++) {
        view v = {p, k < 0};
        add_layer(sc, k * half,
                  k < 0 ? mean(v, -(k + 1) * half, -k * half) : mean(v, k * half, (k + 1) * half));
    }
    add_layer(sc, last * half, p->sigma[p->count - 1]);
    return 1;
}

static int check_origin(const scene *sc, const profile *p, FILE *errors) {
    if (p->downward == sc->log.has_origin_depth)
        return 1;
    if (p->downward)
        scene_error(sc, errors, SECTION_STRESS, STRESS_ORIGIN_DEPTH,
                    ": missing; must be the depth of y = 0: %s gives depths", sc->log.file);
    else
        scene_error(sc, errors, SECTION_STRESS, STRESS_ORIGIN_DEPTH,
                    " = %.10g: must be given with depths only: %s gives y", sc->log.origin_depth,
                    sc->log.file);
    return 0;
}

/* Depths to y, rising; rows that differ in depth must differ in y. */
static int turn_upwards(const scene *sc, profile *p, FILE *errors) {
    double *y = p->place, *sigma = p->sigma, depth = sc->log.origin_depth;
    for (int i = 0, k = p->count - 1; p->downward && i <= k; i++, k--) {
        double y_low = depth - y[k], sigma_low = sigma[k];
        y[k] = depth - y[i];
        sigma[k] = sigma[i];
        y[i] = y_low;
        sigma[i] = sigma_low;
    }
    for (int i = 1; i < p->count; i++) {
        if (y[i] <= y[i - 1]) {
            scene_error(sc, errors, SECTION_STRESS, STRESS_ORIGIN_DEPTH,
                        " = %.10g: so far from the depths of %s that its rows fall together", depth,
                        sc->log.file);
            return 0;
        }
    }
    return 1;
}

static int check_cover(const scene *sc, FILE *errors) {
    const scene_log *log = &sc->log;
    for (int i = 0; i < sc->source_count; i++) {
        double y = sc->sources[i].y;
        if (y < log->bottom || y > log->top) {
            scene_error(
                sc, errors, SECTION_STRESS, STRESS_PROFILE,
                " = %s: reaches from y = %.10g to %.10g; must cover every source, y = %.10g",
                log->file, log->bottom, log->top, y);
            return 0;
        }
    }
    return 1;
}

static int take(scene *sc, profile *p, FILE *errors) {
    if (!check_origin(sc, p, errors) || !turn_upwards(sc, p, errors))
        return 0;
    sc->log.rows = p->count;
    sc->log.bottom = p->place[0];
    sc->log.top = p->place[p->count - 1];
    return check_cover(sc, errors) && fill_layers(sc, p, errors);
}

/* A file that cannot be read at all is the fault of the line that names it. */
static FILE *open_log(const scene *sc, const char *path, FILE *errors) {
    FILE *stream = path ? fopen(path, "r") : NULL;
    int first = stream ? getc(stream) : EOF;
    if (stream && !ferror(stream)) {
        ungetc(first, stream);
        return stream;
    }
    scene_error(sc, errors, SECTION_STRESS, STRESS_PROFILE, " = %s: %s", sc->log.file,
                path ? strerror(errno) : "out of memory");
    if (stream)
        fclose(stream);
    return NULL;
}

int stress_log_take(scene *sc, FILE *errors) {
    profile p = {0};
    if (!sc->log.file)
        return 1;
    char *path = beside(sc->path, sc->log.file);
    FILE *stream = open_log(sc, path, errors);
    int good = stream && profile_read(stream, path, &p, errors) && take(sc, &p, errors);
    if (stream)
        fclose(stream);
    profile_free(&p);
    free(path);
    return good;
}
