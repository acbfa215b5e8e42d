/*
 * What a second thread is worth: steps of one solver that has one or two, by turns from the same
 * state; and steps of two solvers in two threads of the host against those of one.
 *
 *     bench_threads [REPEATS]      of every step; without: 15
 *
 * A penny without symmetry. For a machine with two cores that do nothing else.
 */
#include "base/clock.h"
#include "common_radial.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

static const double CELLS[] = {3e3, 1e4, 3e4, 1e5};
enum { SIZES = sizeof CELLS / sizeof *CELLS, REPEATS = 15, REPEATS_MAX = 1000, WARM = 2 };

/* A solver, the state that its steps start from, and their length. */
typedef struct subject {
    ilsa_solver *solver;
    unsigned char *image;
    size_t size;
    double dt;
    double seconds[REPEATS_MAX];
} subject;

static void check(ilsa_status status, const ilsa_solver *solver) {
    if (status) {
        fprintf(stderr, "%s: %s\n", ilsa_status_text(status), ilsa_last_error(solver));
        exit(1);
    }
}

/* A solver with a penny of so many cells. */
static ilsa_solver *make(double cells, int threads) {
    static const double pi = 3.14159265358979323846;
    double R = sqrt(cells / pi);
    int n = 2 * (int)(R + 12) + 1;
    ilsa_mesh_def mesh_def = {n, n, 1 / R, 1 / R};
    ilsa_material_def material_def = {1, 1, 1, 0.3};
    ilsa_source_def well = {0, 0, 1};
    ilsa_solver_def def = ilsa_solver_def_default();
    ilsa_mesh *mesh;
    ilsa_material *material;
    ilsa_solver *solver;
    check(ilsa_mesh_create(&mesh_def, &mesh), NULL);
    check(ilsa_material_create(&material_def, &material), NULL);
    def.mesh = mesh;
    def.material = material;
    def.sources = &well;
    def.source_count = 1;
    def.symmetry = ILSA_SYMMETRY_NONE;
    def.threads = threads;
    check(ilsa_solver_create(&def, &solver), NULL);
    ilsa_mesh_destroy(&mesh);
    ilsa_material_destroy(&material);
    check(ilsa_start_radial(solver, 1), solver);
    return solver;
}

/* A few steps on from the start. */
static void begin(subject *s, double cells, int threads) {
    s->solver = make(cells, threads);
    for (int k = 0; k < 3; k++)
        check(ilsa_advance_one(s->solver, 1e9, NULL), s->solver);
    check(ilsa_suggest_dt(s->solver, &s->dt), s->solver);
    check(ilsa_snapshot_save(s->solver, NULL, &s->size), s->solver);
    s->image = malloc(s->size);
    if (!s->image)
        check(ILSA_ERR_MEMORY, NULL);
    check(ilsa_snapshot_save(s->solver, s->image, &s->size), s->solver);
}

static void end(subject *s) {
    ilsa_solver_destroy(&s->solver);
    free(s->image);
}

/* Seconds of the step. */
static double step(subject *s) {
    check(ilsa_snapshot_restore(s->solver, s->image, s->size), s->solver);
    double start = ilsai_clock();
    check(ilsa_step(s->solver, s->dt, NULL), s->solver);
    return ilsai_clock() - start;
}

static void one_solver(int repeats) {
    static subject s[2];
    printf("One solver. Milliseconds of a step, medians of %d\n\n", repeats);
    printf("| unknowns | 1 thread | 2 threads | faster by | of the shortest steps |\n");
    printf("|---|---|---|---|---|\n");
    for (int size = 0; size < SIZES; size++) {
        for (int t = 0; t < 2; t++)
            begin(&s[t], CELLS[size], t + 1);
        for (int k = -WARM; k < repeats; k++)
            for (int t = 0; t < 2; t++)
                s[t].seconds[k < 0 ? 0 : k] = step(&s[t]);
        ilsa_summary now;
        check(ilsa_get_summary(s[0].solver, &now), s[0].solver);
        double one = radial_median(s[0].seconds, repeats),
               two = radial_median(s[1].seconds, repeats);
        printf("| %d | %.1f | %.1f | %.2f | %.2f |\n", now.unknowns, 1e3 * one, 1e3 * two,
               one / two, s[0].seconds[0] / s[1].seconds[0]);
        fflush(stdout);
        for (int t = 0; t < 2; t++)
            end(&s[t]);
    }
}

/* Steps for a while. */
typedef struct worker {
    subject s;
    int count;
} worker;

static void *work(void *argument) {
    worker *w = argument;
    for (int k = 0; k < w->count; k++)
        step(&w->s);
    return NULL;
}

/* Steps a second of all of them together. */
static double rate(worker *w, int solvers) {
    pthread_t thread[2];
    double start = ilsai_clock();
    for (int t = 0; t < solvers; t++)
        if (pthread_create(&thread[t], NULL, work, &w[t]))
            check(ILSA_ERR_MEMORY, NULL);
    for (int t = 0; t < solvers; t++)
        pthread_join(thread[t], NULL);
    return solvers * w->count / (ilsai_clock() - start);
}

static void two_solvers(int repeats) {
    static worker w[2];
    static double one[REPEATS_MAX], two[REPEATS_MAX];
    printf("\nTwo solvers of one thread each. Steps a second, medians of %d\n\n", repeats);
    printf("| unknowns | one | two | times | of the highest rates |\n|---|---|---|---|---|\n");
    for (int size = 0; size < SIZES; size++) {
        for (int t = 0; t < 2; t++) {
            begin(&w[t].s, CELLS[size], 1);
            w[t].count = 1 + (int)(3e4 / CELLS[size]);
        }
        rate(w, 2);
        for (int k = 0; k < repeats; k++) {
            one[k] = rate(w, 1);
            two[k] = rate(w, 2);
        }
        ilsa_summary now;
        check(ilsa_get_summary(w[0].s.solver, &now), w[0].s.solver);
        double alone = radial_median(one, repeats), both = radial_median(two, repeats);
        printf("| %d | %.1f | %.1f | %.2f | %.2f |\n", now.unknowns, alone, both, both / alone,
               two[repeats - 1] / one[repeats - 1]);
        fflush(stdout);
        for (int t = 0; t < 2; t++)
            end(&w[t].s);
    }
}

int main(int argc, char **argv) {
    long asked = argc > 1 ? strtol(argv[1], NULL, 10) : REPEATS;
    if (asked < 1 || asked > REPEATS_MAX) {
        fprintf(stderr, "usage: bench_threads [1 .. %d]\n", REPEATS_MAX);
        return 2;
    }
    int repeats = (int)asked;
    one_solver(repeats);
    two_solvers(repeats);
    return 0;
}
