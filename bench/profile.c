/*
 * What a step costs by the number of wet cells: time by phase, passes, products, iterations,
 * memory. A radial fracture in the middle of the triangle, solved whole and as a quarter; each row
 * runs in a process of its own, so that its peak of memory is its own.
 *
 *     OPENBLAS_NUM_THREADS=1 bench_profile [STEPS]      steps measured, 1 .. 20, default 6, after 8
 */
#include "common_malloc.h"
#include "common_speed.h"

#include <math.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SIZES = 5, WARM = 8 };
static const int sizes[SIZES] = {1000, 3000, 10000, 30000, 100000};

/* A row; sums over the measured steps. */
typedef struct row {
    ilsa_status status;
    int mesh_cells, cells, unknowns;
    double seconds; /* CPU */
    ilsa_report work;
    ilsa_profile spent;
    size_t made, grown, peak; /* bytes: of a new solver, added by its steps, of the process */
    double longest;           /* step, CPU seconds */
} row;

static ilsa_profile since(const ilsa_profile *now, const ilsa_profile *then) {
    return (ilsa_profile){now->product - then->product, now->preconditioner - then->preconditioner,
                          now->front - then->front, now->rest - then->rest};
}

static void measure(row *r, ilsa_solver *solver, int steps) {
    ilsa_profile before = {0}, after = {0};
    (void)ilsa_get_profile(solver, &before);
    for (int k = 0; k < steps && r->status == ILSA_OK; k++) {
        ilsa_report one;
        const double start = speed_clock();
        r->status = ilsa_advance_one(solver, 1e9, &one);
        const double seconds = speed_clock() - start;
        r->seconds += seconds;
        r->longest = fmax(r->longest, seconds);
        r->work.steps += one.steps;
        r->work.rejected += one.rejected;
        r->work.front_iterations += one.front_iterations;
        r->work.newton_iterations += one.newton_iterations;
        r->work.krylov_iterations += one.krylov_iterations;
        r->work.elasticity_products += one.elasticity_products;
    }
    (void)ilsa_get_profile(solver, &after);
    r->spent = since(&after, &before);
}

static void run(row *r, int unknowns, ilsa_symmetry symmetry, int steps) {
    speed_scene scene = speed_scene_of(SPEED_MIDDLE);
    ilsa_solver_def how = ilsa_solver_def_default();
    ilsa_mesh_def mesh;
    ilsa_summary s;
    struct rusage usage;
    const size_t before = heap.live;
    how.symmetry = symmetry;
    const int cells = (int)round(sqrt(unknowns / 3.1416));
    scene.start = scene.length * (1 - 0.5 * (WARM + 0.5 * steps) / cells);
    ilsa_solver *solver = speed_start(&scene, cells, &how);
    if (!solver || ilsa_get_mesh_def(solver, &mesh))
        return;
    r->mesh_cells = mesh.nx * mesh.ny;
    r->made = heap.live - before;
    r->status = ILSA_OK;
    for (int k = 0; k < WARM && r->status == ILSA_OK; k++)
        r->status = ilsa_advance_one(solver, 1e9, NULL);
    measure(r, solver, steps);
    r->grown = heap.live - before - r->made;
    if (ilsa_get_summary(solver, &s) == ILSA_OK)
        r->cells = s.cells, r->unknowns = s.unknowns;
    getrusage(RUSAGE_SELF, &usage);
    r->peak = 1024 * (size_t)usage.ru_maxrss;
    ilsa_solver_destroy(&solver);
}

/* In a process of its own. */
static row run_apart(int unknowns, ilsa_symmetry symmetry, int steps) {
    row r = {.status = ILSA_ERR_STATE};
    int ends[2];
    (void)fflush(stdout);
    if (pipe(ends))
        return r;
    const pid_t child = fork();
    if (child == 0) {
        run(&r, unknowns, symmetry, steps);
        _exit(write(ends[1], &r, sizeof r) != sizeof r);
    }
    close(ends[1]);
    if (child < 0 || read(ends[0], &r, sizeof r) != sizeof r)
        r.status = ILSA_ERR_MEMORY;
    close(ends[0]);
    waitpid(child, NULL, 0);
    return r;
}

/* ---- Tables ------------------------------------------------------------------------------- */

static double per(long count, long of) {
    return (double)count / (double)of;
}

static void print_time(const row *r, const row *before) {
    const ilsa_profile *p = &r->spent;
    const double all = (p->product + p->preconditioner + p->front + p->rest) / 100;
    const long steps = r->work.steps;
    printf("| %d | %d | %.2f | ", r->cells, r->unknowns, 1e3 * r->seconds / (double)steps);
    if (before)
        printf("%.2f |", log(r->seconds / before->seconds) / log(per(r->cells, before->cells)));
    else
        printf("|");
    printf(" %.0f | %.0f | %.0f | %.0f | %.1f | %.1f | %.1f | %.1f | %ld |\n", p->product / all,
           p->preconditioner / all, p->front / all, p->rest / all,
           per(r->work.elasticity_products, steps), per(r->work.front_iterations, steps),
           per(r->work.newton_iterations, steps),
           per(r->work.krylov_iterations, r->work.newton_iterations), r->work.rejected);
}

static void print_memory(const row *r) {
    printf("| %d | %d | %.0f | %.0f | %.0f | %.1f |\n", r->mesh_cells, r->cells,
           (double)r->made / r->mesh_cells, (double)r->grown / r->cells,
           (double)(r->made + r->grown) / r->mesh_cells, (double)r->peak / (1 << 20));
}

static void print_tables(const char *what, ilsa_symmetry symmetry, int steps) {
    row rows[SIZES];
    printf("\n### %s: time\n\nCPU ms a step, mean of %d; its exponent in the number of wet cells, "
           "from the row before; phases in %% of the wall time.\n\n"
           "| wet cells | unknowns | ms a step | exponent | products | preconditioner | front | "
           "rest | products a step | front passes | Newton | GMRES per Newton | refused |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
           what, steps);
    for (int k = 0; k < SIZES; k++) {
        rows[k] = run_apart(sizes[k], symmetry, steps);
        if (rows[k].status != ILSA_OK)
            printf("| %d: %s |\n", sizes[k], ilsa_status_text(rows[k].status));
        else
            print_time(&rows[k], k ? &rows[k - 1] : NULL);
    }
    printf("\nOverall exponent %.2f; longest step of the last row %.2f s.\n",
           log(rows[SIZES - 1].seconds / rows[0].seconds) /
               log(per(rows[SIZES - 1].cells, rows[0].cells)),
           rows[SIZES - 1].longest);
    printf("\n### %s: memory\n\nBytes on the heap: of a new solver per mesh cell, added by its "
           "steps per wet cell, all per mesh cell; MiB of the process at its peak.\n\n"
           "| mesh cells | wet cells | new / mesh cell | added / wet cell | all / mesh cell | peak "
           "MiB |\n|---|---|---|---|---|---|\n",
           what);
    for (int k = 0; k < SIZES; k++)
        if (rows[k].status == ILSA_OK)
            print_memory(&rows[k]);
}

/* A footprint that fills a mesh of a million cells. */
static void print_million(void) {
    const row r = run_apart(740000, ILSA_SYMMETRY_AUTO, 1);
    printf("\n### A million mesh cells\n\n| mesh cells | wet cells | new / mesh cell | added / wet "
           "cell | all / mesh cell | peak MiB |\n|---|---|---|---|---|---|\n");
    print_memory(&r);
    printf("\n%s; %.1f CPU s for the last step.\n", ilsa_status_text(r.status), r.seconds);
}

int main(int argc, char **argv) {
    const long asked = argc > 1 ? strtol(argv[1], NULL, 10) : 0;
    const int steps = asked > 0 && asked <= 20 ? (int)asked : 6;
    speed_one_thread();
    print_tables("No symmetry", ILSA_SYMMETRY_NONE, steps);
    print_tables("Quarter", ILSA_SYMMETRY_AUTO, steps);
    print_million();
    return 0;
}
