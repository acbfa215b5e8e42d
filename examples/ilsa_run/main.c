/* ilsa-run: runs a scene file and writes its results. */
#include "keys.h"
#include "model.h"
#include "outfile.h"
#include "run.h"
#include "scene.h"
#include "stress_log.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

/* OpenBLAS has it; where another BLAS is linked there is nothing to set. */
#pragma weak openblas_set_num_threads
extern void openblas_set_num_threads(int threads);

/* Matrices of a step are small: threads of BLAS, unless asked for, would wait for each other. */
static void keep_blas_alone(void) {
    if (!getenv("OPENBLAS_NUM_THREADS") && openblas_set_num_threads)
        openblas_set_num_threads(1);
}

static const char usage[] =
    "usage: ilsa-run SCENE.ini [--out DIR] [--level N] [--threads N] [--quiet]\n"
    "  --out DIR    where the results go; SCENE.out without it. Earlier results are replaced.\n"
    "  --level N    1 fast .. 5 accurate, instead of the scene's own\n"
    "  --threads N  1 .. 64, instead of the scene's own; results do not depend on it\n"
    "  --quiet      no progress, no closing line\n";

typedef struct options {
    const char *scene, *out;
    int level, threads; /* 0: the scene's */
    int quiet, help;
} options;

static int bad_usage(const char *message, const char *word) {
    fprintf(stderr, "ilsa-run: %s%s\n%s", message, word, usage);
    return 0;
}

/* A whole number 1 .. 64, or 0. */
static int read_threads(const char *text) {
    char *end;
    long threads = strtol(text, &end, 10);
    return *end || threads < 1 || threads > 64 ? 0 : (int)threads;
}

static int read_options(int argc, char **argv, options *o) {
    static const struct option known[] = {
        {"out", required_argument, NULL, 'o'},     {"level", required_argument, NULL, 'l'},
        {"threads", required_argument, NULL, 't'}, {"quiet", no_argument, NULL, 'q'},
        {"help", no_argument, NULL, 'h'},          {NULL, 0, NULL, 0}};
    int c;
    while ((c = getopt_long(argc, argv, "", known, NULL)) != -1) {
        if (c == 'o')
            o->out = optarg;
        else if (c == 'l' && optarg[0] >= '1' && optarg[0] <= '5' && !optarg[1])
            o->level = optarg[0] - '0';
        else if (c == 'l')
            return bad_usage("--level must be in 1 .. 5, not ", optarg);
        else if (c == 't' && read_threads(optarg))
            o->threads = read_threads(optarg);
        else if (c == 't')
            return bad_usage("--threads must be in 1 .. 64, not ", optarg);
        else if (c == 'q')
            o->quiet = 1;
        else if (c == 'h')
            o->help = 1;
        else
            return bad_usage("the options are", " these:");
    }
    if (o->help)
        return 1;
    if (optind + 1 != argc)
        return bad_usage("one scene file must be given", "");
    o->scene = argv[optind];
    return o->out && !*o->out ? bad_usage("--out must name a directory", "") : 1;
}

/* "name.out" for "any/where/name.ini". */
static char *default_directory(const char *scene_path) {
    const char *slash = strrchr(scene_path, '/'), *name = slash ? slash + 1 : scene_path;
    size_t length = strlen(name);
    char *directory = malloc(length + sizeof ".out");
    if (length > 4 && strcmp(name + length - 4, ".ini") == 0)
        length -= 4;
    if (directory)
        sprintf(directory, "%.*s.out", (int)length, name);
    return directory;
}

static int run(scene *sc, const options *o) {
    if (o->level)
        sc->options.level = o->level;
    if (o->threads)
        sc->options.threads = o->threads;
    char *directory = o->out ? strdup(o->out) : default_directory(o->scene);
    int exit_status = directory ? run_scene(sc, directory, o->quiet) : EXIT_RUN_FAILED;
    free(directory);
    return exit_status;
}

int main(int argc, char **argv) {
    options o = {0};
    scene sc;
    output_guard();
    keep_blas_alone();
    if (!read_options(argc, argv, &o))
        return EXIT_BAD_SCENE;
    if (o.help) {
        printf("%s\nkeys of a scene:\n", usage);
        keys_print(stdout);
        return output_written() ? EXIT_DONE : EXIT_RUN_FAILED;
    }
    if (!scene_read(o.scene, &sc, stderr))
        return EXIT_BAD_SCENE;
    int exit_status = stress_log_take(&sc, stderr) ? run(&sc, &o) : EXIT_BAD_SCENE;
    scene_free(&sc);
    return exit_status;
}
