/*
 * The nine scenes of section 5.2 on H/11, H/21 and H/42, with the limit that they go to, as
 * Markdown tables for docs/accuracy.md.
 *
 *     bench_accuracy_layers [long] [NAME ...]
 *
 * Scenes whose name contains NAME; without: all nine. H/42 is run only with long (minutes a scene).
 */
#include "common_layers.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int is_long;

enum { MESHES = 3, QUANTITIES = 5 };
static const int meshes[MESHES] = {11, 21, 42};
static const char *const quantity[QUANTITIES] = {"half-length, m", "up, m", "down, m",
                                                 "width at source, mm", "efficiency"};

/* What one scene gave: by time, quantity and mesh; NaN where a run did not get there. */
typedef struct answers {
    double value[LAYER_TIMES][QUANTITIES][MESHES];
    long steps[MESHES], refused[MESHES];
    double seconds[MESHES];
} answers;

static void read_state(answers *a, int time, int mesh, const ilsa_summary *s) {
    const double value[QUANTITIES] = {s->x_max, s->y_max, -s->y_min, 1e3 * s->width_source,
                                      s->efficiency};
    for (int q = 0; q < QUANTITIES; q++)
        a->value[time][q][mesh] = value[q];
}

static void run(const layer_scene *scene, int mesh, answers *a, int wanted) {
    ilsa_solver *solver = wanted ? layer_start(scene, meshes[mesh]) : NULL;
    ilsa_status status = solver ? ILSA_OK : ILSA_ERR_STATE;
    ilsa_summary s = {0};
    for (int k = 0; k < LAYER_TIMES; k++) {
        status = status ? status : ilsa_advance(solver, layer_times[k], NULL);
        status = status ? status : ilsa_get_summary(solver, &s);
        if (status == ILSA_OK)
            read_state(a, k, mesh, &s);
        else
            for (int q = 0; q < QUANTITIES; q++)
                a->value[k][q][mesh] = NAN;
    }
    if (status != ILSA_OK && wanted)
        fprintf(stderr, "%s on H/%d: %s\n", scene->name, meshes[mesh], ilsa_last_error(solver));
    if (solver && ilsa_get_summary(solver, &s) == ILSA_OK) {
        a->steps[mesh] = s.total.steps;
        a->refused[mesh] = s.total.rejected;
        a->seconds[mesh] = s.total.seconds;
    }
    ilsa_solver_destroy(&solver);
}

/*
 * Where the values go as the cells shrink: by the observed order of three where that is one, 0.5 or
 * more, taken as 2 at most; else by the first order of the last two.
 */
static double limit(const double v[MESHES], double *order) {
    const double a = v[1] - v[0], b = v[2] - v[1];
    *order = NAN;
    if (isnan(v[2]))
        return v[1] + a;
    *order = a * b > 0 ? log2(a / b) : NAN;
    *order = *order >= 0.5 ? *order : NAN;
    const double p = isnan(*order) ? 1 : fmin(*order, 2);
    return v[2] + b / (exp2(p) - 1);
}

/* Of one quantity over all scenes and times: H/21 against the limit. */
typedef struct worst {
    double difference; /* %, absolute for the efficiency */
    const char *scene;
    double time;
} worst;

static void print_cell(int q, const double v[MESHES], double *difference) {
    double order;
    const double end = limit(v, &order);
    *difference = q == 4 ? v[1] - end : 100 * (v[1] / end - 1);
    printf(" %.4g, %.4g,", v[0], v[1]);
    if (!isnan(v[2]))
        printf(" %.4g", v[2]);
    if (!isnan(order))
        printf(" (%.1f)", order);
    printf(q == 4 ? " -> %.4g: %+.4f |" : " -> %.4g: %+.1f %% |", end, *difference);
}

static void print_row(const char *scene, int time, double v[QUANTITIES][MESHES], worst *w) {
    printf("| %s | %g |", scene, layer_times[time]);
    for (int q = 0; q < QUANTITIES; q++) {
        double difference;
        print_cell(q, v[q], &difference);
        if (fabs(difference) > fabs(w[q].difference))
            w[q] = (worst){difference, scene, layer_times[time]};
    }
    printf("\n");
}

static void print_scene(const layer_scene *scene, worst w[QUANTITIES]) {
    answers a = {0};
    for (int mesh = 0; mesh < MESHES; mesh++)
        run(scene, mesh, &a, mesh < MESHES - 1 || is_long);
    for (int k = 0; k < LAYER_TIMES; k++)
        print_row(scene->name, k, a.value[k], w);
    fprintf(stderr, "%s: steps %ld %ld %ld, refused %ld %ld %ld, %.1f %.1f %.1f s\n", scene->name,
            a.steps[0], a.steps[1], a.steps[2], a.refused[0], a.refused[1], a.refused[2],
            a.seconds[0], a.seconds[1], a.seconds[2]);
    fflush(stdout);
}

int main(int argc, char **argv) {
    worst w[QUANTITIES] = {{0}};
    int first = 1;
    for (; first < argc && strcmp(argv[first], "long") == 0; first++)
        is_long = 1;
    printf("\n### Three layers\n\nOn H/11, H/21%s, (observed order) -> limit: H/21 against the "
           "limit. The limit is Richardson's with the observed order where that is 0.5 or more, at "
           "most 2, else of the last two in the first order.\n\n| scene | time, s |",
           is_long ? ", H/42" : "");
    for (int q = 0; q < QUANTITIES; q++)
        printf(" %s |", quantity[q]);
    printf("\n|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < LAYER_SCENES; k++) {
        int wanted = argc == first;
        for (int i = first; i < argc; i++)
            wanted |= strstr(layer_scenes[k].name, argv[i]) != NULL;
        if (wanted)
            print_scene(&layer_scenes[k], w);
    }
    printf("\n| worst of H/21 against the limit | | scene | time, s |\n|---|---|---|---|\n");
    for (int q = 0; q < QUANTITIES; q++)
        printf(q == 4 ? "| %s | %+.4f | %s | %g |\n" : "| %s | %+.2f %% | %s | %g |\n", quantity[q],
               w[q].difference, w[q].scene ? w[q].scene : "", w[q].time);
    return 0;
}
