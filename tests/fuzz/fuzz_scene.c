/*
 * The readers of scene files and of stress logs, given anything: each either reads a scene or a log
 * whose values are in their ranges, without a word, or says what is wrong, a line each, and leaves
 * nothing behind. A scene's own log is not opened: stress_log_take, which would, is not called.
 */
#include "fuzz.h"
#include "scene.h"

/* The reader whole: of ilsa-run only what reads scenes is linked. */
#include "profile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A file without a name; path is a way to open it. */
static FILE *write_file(const uint8_t *data, size_t size, char path[32]) {
    FILE *file = tmpfile();
    FUZZ_EXPECT(file && fwrite(data, 1, size, file) == size && fflush(file) == 0);
    snprintf(path, 32, "/dev/fd/%d", fileno(file));
    return file;
}

static void check_source(const scene *sc, const scene_source *source) {
    FUZZ_EXPECT(source->count >= 1 && source->times[0] == 0 && source->line > 0);
    FUZZ_EXPECT(fabs(source->x) < 0.5 * sc->mesh.nx * sc->mesh.dx);
    FUZZ_EXPECT(fabs(source->y) < 0.5 * sc->mesh.ny * sc->mesh.dy);
    for (int i = 0; i < source->count; i++) {
        FUZZ_EXPECT(source->rates[i] >= 0 && isfinite(source->rates[i]));
        FUZZ_EXPECT(i == 0 || source->times[i] > source->times[i - 1]);
        FUZZ_EXPECT(scene_rate(source, source->times[i]) == source->rates[i]);
        FUZZ_EXPECT(i == 0 || scene_next_change(sc, source->times[i - 1]) <= source->times[i]);
    }
}

static void check_material(const ilsa_material_def *m) {
    FUZZ_EXPECT(m->E_prime > 0 && isfinite(m->E_prime));
    FUZZ_EXPECT(m->mu_prime >= 0 && isfinite(m->mu_prime));
    FUZZ_EXPECT(m->K_prime >= 0 && isfinite(m->K_prime));
    FUZZ_EXPECT(m->C_prime >= 0 && isfinite(m->C_prime));
}

static void check_lists(const scene *sc) {
    FUZZ_EXPECT((sc->sigma != NULL) != (sc->log.file != NULL));
    for (int i = 0; i <= sc->interface_count && sc->sigma; i++)
        FUZZ_EXPECT(fabs(sc->sigma[i]) <= 1e60);
    for (int i = 1; i < sc->interface_count; i++)
        FUZZ_EXPECT(sc->interfaces[i] > sc->interfaces[i - 1]);
    FUZZ_EXPECT(sc->output_count >= 1 && sc->output_times[0] > 0);
    for (int i = 1; i < sc->output_count; i++)
        FUZZ_EXPECT(sc->output_times[i] > sc->output_times[i - 1]);
    FUZZ_EXPECT(sc->output_times[sc->output_count - 1] <= sc->t_end);
}

static void check_scene(const scene *sc) {
    const ilsa_mesh_def *m = &sc->mesh;
    FUZZ_EXPECT(m->nx >= 3 && m->ny >= 3 && m->nx <= (1 << 28) / m->ny);
    FUZZ_EXPECT(m->dx > 0 && m->dy > 0 && m->dx <= 1001 * m->dy && m->dy <= 1001 * m->dx);
    FUZZ_EXPECT(sc->options.level >= 0 && sc->options.level <= 5 && sc->options.threads >= 0 &&
                sc->options.threads <= 64);
    FUZZ_EXPECT((sc->radius > 0) != (sc->time > 0));
    FUZZ_EXPECT(sc->t_end > 0 && sc->dt_initial >= 0 && sc->options.dt_max >= 0);
    FUZZ_EXPECT(sc->source_count >= 1);
    for (int i = 0; i < sc->source_count; i++)
        check_source(sc, &sc->sources[i]);
    check_material(&sc->material);
    check_lists(sc);
}

static int is_empty(const scene *sc) {
    return !sc->sources && !sc->sigma && !sc->interfaces && !sc->output_times && !sc->log.file;
}

/* Every line of what it said begins with the name of the file. */
static void check_messages(const char *said, const char *path) {
    for (const char *line = said; *line; line = strchr(line, '\n') + 1) {
        FUZZ_EXPECT(strncmp(line, path, strlen(path)) == 0 && line[strlen(path)] == ':');
        FUZZ_EXPECT(strchr(line, '\n'));
    }
}

static void check_profile(const profile *p) {
    FUZZ_EXPECT(p->count >= 2);
    for (int i = 0; i < p->count; i++) {
        FUZZ_EXPECT(fabs(p->place[i]) <= 1e60 && fabs(p->sigma[i]) <= 1e60);
        FUZZ_EXPECT(i == 0 || p->place[i] > p->place[i - 1]);
    }
}

static void read_as_profile(FILE *file, const char *path) {
    char *said = NULL;
    size_t length = 0;
    profile p;
    FILE *errors = open_memstream(&said, &length);
    FUZZ_EXPECT(errors);
    rewind(file);
    int good = profile_read(file, path, &p, errors);
    FUZZ_EXPECT(fflush(errors) == 0 && good == (length == 0));
    FUZZ_EXPECT(good || (!p.place && !p.sigma && p.count == 0));
    if (good)
        check_profile(&p);
    profile_free(&p);
    fclose(errors);
    check_messages(said, path);
    free(said);
}

static void read_as_scene(const char *path) {
    char *said = NULL;
    size_t length = 0;
    scene sc;
    FILE *errors = open_memstream(&said, &length);
    FUZZ_EXPECT(errors);
    int good = scene_read(path, &sc, errors);
    FUZZ_EXPECT(fflush(errors) == 0 && good == (length == 0));
    FUZZ_EXPECT(good || is_empty(&sc));
    if (good) {
        check_scene(&sc);
        FUZZ_EXPECT(!scene_check_start(&sc, sc.t_end, errors));
        scene_free(&sc);
    }
    fclose(errors);
    check_messages(said, path);
    free(said);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char path[32];
    FILE *file = write_file(data, size, path);
    read_as_scene(path);
    read_as_profile(file, path);
    fclose(file);
    return 0;
}
