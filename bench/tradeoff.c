/*
 * Speed against accuracy: every level on several meshes, time and products beside the errors.
 * Radial fractures from half their radius on, against the reference of tests/data; the symmetric
 * layered scene to 900 s, against level 5 on cells of H/42.
 *
 *     OPENBLAS_NUM_THREADS=1 bench_tradeoff [csv]      from the top of the tree
 */
#include "common_radial.h"
#include "common_speed.h"
#include "common_worst.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LEVELS = 5, MESHES = 3, SCENES = 5, PER_SCENE = MESHES * LEVELS, RUNS = SCENES * PER_SCENE };
static const int which[SCENES] = {SPEED_M, SPEED_K, SPEED_M_TILDE, SPEED_MIDDLE, SPEED_SYMMETRIC};
static const int radial_cells[MESHES] = {10, 20, 40}, layer_cells[MESHES] = {11, 21, 31};
static const double layer_time = 900;
enum { REFERENCE_CELLS = 42 };

/* What is compared; lengths along x. */
typedef struct answer {
    double radius, width, efficiency;
} answer;

typedef struct run {
    const char *scene;
    int cells, level;
    ilsa_status status;
    double seconds;
    long steps, refused, products;
    answer error; /* % */
    double worst; /* the largest of the three */
} run;

static run runs[RUNS]; /* by scene, mesh, level */

static run *run_at(int scene, int mesh, int level) {
    return &runs[(scene * MESHES + mesh) * LEVELS + level];
}

static int is_radial(const speed_scene *scene) {
    return scene->stress == SPEED_UNIFORM;
}

static double end_of(const speed_scene *scene) {
    return is_radial(scene) ? scene->end : layer_time;
}

static answer answer_of(const speed_scene *scene, ilsa_solver *solver) {
    ilsa_summary s = {0};
    (void)ilsa_get_summary(solver, &s);
    return (answer){is_radial(scene) ? radial_measure(solver).mean : s.x_max, s.width_source,
                    s.efficiency};
}

/* ---- Runs --------------------------------------------------------------------------------- */

static answer attempt(run *r, const speed_scene *scene, int cells, int level) {
    ilsa_solver_def how = ilsa_solver_def_default();
    how.level = level;
    ilsa_solver *solver = speed_start(scene, cells, &how);
    answer a = {NAN, NAN, NAN};
    ilsa_report work = {0};
    const double start = speed_clock();
    r->status = solver ? ilsa_advance(solver, end_of(scene), &work) : ILSA_ERR_STATE;
    r->seconds = speed_clock() - start;
    r->steps = work.steps;
    r->refused = work.rejected;
    r->products = work.elasticity_products;
    if (r->status == ILSA_OK)
        a = answer_of(scene, solver);
    ilsa_solver_destroy(&solver);
    return a;
}

static answer reference_of(const speed_scene *scene) {
    run r;
    if (!is_radial(scene))
        return attempt(&r, scene, REFERENCE_CELLS, LEVELS);
    const ilsa_material_def *m = &scene->material;
    const penny p =
        radial_reference((penny_law){"", m->mu_prime, m->K_prime, m->C_prime}, scene->end);
    return (answer){p.R, p.width, p.efficiency};
}

/* Several times where that is quick: the least time counts. */
static run measure(const speed_scene *scene, int cells, int level, const answer *truth) {
    enum { REPEATS = 5 };
    run r = {.scene = scene->name, .cells = cells, .level = level};
    double least = HUGE_VAL, spent = 0;
    for (int k = 0; k < REPEATS && spent < 0.5; k++) {
        const answer a = attempt(&r, scene, cells, level);
        spent += r.seconds;
        least = fmin(least, r.seconds);
        r.error = (answer){100 * (a.radius / truth->radius - 1), 100 * (a.width / truth->width - 1),
                           100 * (a.efficiency - truth->efficiency)};
    }
    r.seconds = least;
    r.worst =
        larger_of(larger_of(fabs(r.error.radius), fabs(r.error.width)), fabs(r.error.efficiency));
    return r;
}

static void run_all(void) {
    for (int s = 0; s < SCENES; s++) {
        const speed_scene scene = speed_scene_of(which[s]);
        const answer truth = reference_of(&scene);
        for (int m = 0; m < MESHES; m++)
            for (int l = 0; l < LEVELS; l++)
                *run_at(s, m, l) = measure(
                    &scene, is_radial(&scene) ? radial_cells[m] : layer_cells[m], l + 1, &truth);
    }
}

/* ---- Which are beaten --------------------------------------------------------------------- */

/* Both slower, by more than clocks differ, and less accurate. */
static int beaten(const run *a, const run *by) {
    return a->products > by->products && a->seconds > 1.02 * by->seconds && a->worst > by->worst;
}

/* Of all meshes and levels of its scene. */
static int on_pareto_front(const run *r) {
    const run *of = run_at((int)((r - runs) / PER_SCENE), 0, 0);
    int on = 1;
    for (int k = 0; k < PER_SCENE; k++)
        on &= !beaten(r, &of[k]);
    return on;
}

/* ---- Tables ------------------------------------------------------------------------------- */

static void print_runs(void) {
    printf("\n### Runs\n\nErrors in %%, of the efficiency absolute x 100. **P**: no mesh and level "
           "of the same scene is both faster and more accurate by the largest of the three errors."
           "\n\n| scene | cells | level | CPU s | steps | refused | products | radius | width | "
           "efficiency | |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < RUNS; k++) {
        const run *r = &runs[k];
        const char *mark = on_pareto_front(r) ? "**P**" : "";
        printf("| %s | %d | %d | %.4f | %ld | %ld | %ld | %+.3f | %+.3f | %+.3f | %s |\n", r->scene,
               r->cells, r->level, r->seconds, r->steps, r->refused, r->products, r->error.radius,
               r->error.width, r->error.efficiency, r->status ? ilsa_status_text(r->status) : mark);
    }
}

/* Over the scenes: time, geometric mean; errors, root mean square. */
typedef struct mean {
    double seconds, products, radius, width, efficiency, worst;
} mean;

static mean mean_of(int mesh, int level) {
    mean m = {0};
    for (int s = 0; s < SCENES; s++) {
        const run *r = run_at(s, mesh, level);
        m.seconds += log(r->seconds) / SCENES;
        m.products += log((double)r->products) / SCENES;
        m.radius += r->error.radius * r->error.radius / SCENES;
        m.width += r->error.width * r->error.width / SCENES;
        m.efficiency += r->error.efficiency * r->error.efficiency / SCENES;
        m.worst += r->worst * r->worst / SCENES;
    }
    return (mean){exp(m.seconds), exp(m.products),    sqrt(m.radius),
                  sqrt(m.width),  sqrt(m.efficiency), sqrt(m.worst)};
}

static void print_means(void) {
    printf(
        "\n### Levels\n\nOver the scenes: geometric mean of times and products, root mean square "
        "of the errors in %%. Beaten by: a level on the same mesh that is faster and more "
        "accurate.\n\n| cells | level | CPU s | level 5 / this | products | radius | width | "
        "efficiency | largest of the three | beaten by |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n");
    for (int mesh = 0; mesh < MESHES; mesh++) {
        const mean last = mean_of(mesh, LEVELS - 1);
        for (int l = 0; l < LEVELS; l++) {
            const mean m = mean_of(mesh, l);
            printf("| %d, H/%d | %d | %.4f | %.2f | %.0f | %.3f | %.3f | %.3f | %.3f |",
                   radial_cells[mesh], layer_cells[mesh], l + 1, m.seconds,
                   last.seconds / m.seconds, m.products, m.radius, m.width, m.efficiency, m.worst);
            for (int k = 0; k < LEVELS; k++) {
                const mean other = mean_of(mesh, k);
                if (other.seconds < m.seconds && other.worst < m.worst)
                    printf(" %d", k + 1);
            }
            printf(" |\n");
        }
    }
}

static void print_csv(void) {
    printf("scene,cells,level,seconds,steps,refused,products,radius,width,efficiency,worst,"
           "pareto\n");
    for (int k = 0; k < RUNS; k++) {
        const run *r = &runs[k];
        printf("%s,%d,%d,%.6f,%ld,%ld,%ld,%.6f,%.6f,%.6f,%.6f,%d\n", r->scene, r->cells, r->level,
               r->seconds, r->steps, r->refused, r->products, r->error.radius, r->error.width,
               r->error.efficiency, r->worst, on_pareto_front(r));
    }
}

int main(int argc, char **argv) {
    speed_one_thread();
    run_all();
    if (argc > 1 && strcmp(argv[1], "csv") == 0) {
        print_csv();
        return 0;
    }
    print_means();
    print_runs();
    return 0;
}
