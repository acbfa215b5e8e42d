/*
 * Leak-off at the front where its velocity changes: into a barrier and into a layer of lower
 * stress. By the velocity's history and by a constant velocity, against the history with eight
 * times smaller steps, as a Markdown table for docs/accuracy.md.
 *
 *     bench_accuracy_history
 */
#include "common_layers.h"

#include "model/mesh.h"
#include "step/solver.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The history, a constant velocity; the history with small steps. */
enum { WAYS = 3, REFERENCE = 2 };
static const tip_cell_velocity velocity[WAYS] = {TIP_CELL_HISTORY, TIP_CELL_CONSTANT,
                                                 TIP_CELL_HISTORY};
static const int refinement[WAYS] = {1, 1, 8};

enum { TIMES = 6 };
static const double times[TIMES] = {30, 50, 70, 100, 150, 250};

/* Leaked beyond the interfaces: in the layers that the front enters. */
enum { LEAKED, BEYOND, EFFICIENCY, LENGTH, UP, DOWN, QUANTITIES };
static const char *const quantity[QUANTITIES] = {"leaked, m3", "of it beyond the interfaces, m3",
                                                 "efficiency", "half-length, m",
                                                 "up, m",      "down, m"};

typedef struct answers {
    double value[WAYS][TIMES][QUANTITIES];
    long steps[WAYS];
} answers;

/* In the cells whose centres are more than half the middle layer's height away from its middle. */
static double leaked_beyond(const ilsa_solver *s) {
    double sum = 0;
    for (int j = 0; j < s->model.mesh.ny; j++)
        for (int i = 0; i < s->model.mesh.nx && fabs(ilsai_mesh_y(&s->model.mesh, j)) > 10; i++)
            sum += s->fracture.cells.leaked[j * s->model.mesh.nx + i];
    return sum * s->model.mesh.dx * s->model.mesh.dy;
}

static void read_state(const ilsa_solver *solver, double value[QUANTITIES], long *steps) {
    ilsa_summary s = {0};
    ilsa_get_summary(solver, &s);
    const double now[QUANTITIES] = {
        s.volume_leaked, leaked_beyond(solver), s.efficiency, s.x_max, s.y_max, -s.y_min};
    memcpy(value, now, sizeof now);
    *steps = s.total.steps;
}

static void run(const layer_scene *scene, int cells, int way, answers *a) {
    ilsa_solver *solver = layer_start(scene, cells);
    ilsa_status status = solver ? ILSA_OK : ILSA_ERR_STATE;
    if (solver)
        solver->numerics.velocity = velocity[way];
    for (int k = 0; k < TIMES; k++) {
        status = status ? status : layer_advance(solver, times[k], refinement[way]);
        if (status == ILSA_OK)
            read_state(solver, a->value[way][k], &a->steps[way]);
        else
            for (int q = 0; q < QUANTITIES; q++)
                a->value[way][k][q] = NAN;
    }
    if (status != ILSA_OK && solver)
        fprintf(stderr, "%s on H/%d: %s\n", scene->name, cells, ilsa_last_error(solver));
    ilsa_solver_destroy(&solver);
}

/* By how much a way differs: in %, of the efficiency absolute, beyond the interfaces of all. */
static double difference(const answers *a, int way, int time, int q) {
    const double *reference = a->value[REFERENCE][time];
    const double d = a->value[way][time][q] - reference[q];
    return q == EFFICIENCY ? d : 100 * d / reference[q == BEYOND ? LEAKED : q];
}

static void print_cell(const answers *a, int time, int q) {
    printf(q == EFFICIENCY ? " %.4f: %+.4f, %+.4f |" : " %.4g: %+.2f, %+.2f |",
           a->value[REFERENCE][time][q], difference(a, 0, time, q), difference(a, 1, time, q));
}

static void print_scene(const layer_scene *scene, int cells) {
    answers a = {0};
    for (int way = 0; way < WAYS; way++)
        run(scene, cells, way, &a);
    for (int k = 0; k < TIMES; k++) {
        printf("| %s | H/%d | %g |", scene->name, cells, times[k]);
        for (int q = 0; q < QUANTITIES; q++)
            print_cell(&a, k, q);
        printf("\n");
    }
    fprintf(stderr, "%s on H/%d: steps %ld %ld %ld\n", scene->name, cells, a.steps[0], a.steps[1],
            a.steps[2]);
    fflush(stdout);
}

int main(void) {
    printf("\n### Leak-off where the front changes its velocity\n\nWith the velocity's history and "
           "an eighth of the usual steps: by how much the usual steps differ from it with the "
           "history, as the library has it, and with a constant velocity. Differences in %%, of "
           "the efficiency absolute, beyond the "
           "interfaces in %% of all that has leaked.\n\n| scene | cells | time, s |");
    for (int q = 0; q < QUANTITIES; q++)
        printf(" %s |", quantity[q]);
    printf("\n|---|---|---|---|---|---|---|---|---|\n");
    for (int cells = 11; cells <= 21; cells += 10)
        print_scene(&layer_scenes[LAYER_SYMMETRIC_PHI1], cells);
    for (int cells = 11; cells <= 21; cells += 10)
        print_scene(&layer_scenes[LAYER_DROP_PHI1], cells);
    return 0;
}
