/*
 * What each part of a scene costs: a radial fracture of about 5000 wet cells with nothing but
 * viscosity, solved whole, and the same with one part more. CPU time and heap.
 *
 *     OPENBLAS_NUM_THREADS=1 bench_features
 */
#include "common_malloc.h"
#include "common_speed.h"

#include <math.h>
#include <stdio.h>

enum { CELLS = 38, WARM = 4, STEPS = 8, REPEATS = 15 };

/* What the host does after every step. */
typedef enum reading { READS_NOTHING, SAVES, READS_FIELDS } reading;

typedef struct variant {
    const char *name;
    int leak_off, toughness, equal_layers, second_source;
    ilsa_symmetry symmetry;
    reading reads;
} variant;

static const variant variants[] = {
    {"nothing more", 0, 0, 0, 0, ILSA_SYMMETRY_NONE, READS_NOTHING},
    {"leak-off", 1, 0, 0, 0, ILSA_SYMMETRY_NONE, READS_NOTHING},
    {"toughness", 0, 1, 0, 0, ILSA_SYMMETRY_NONE, READS_NOTHING},
    {"leak-off and toughness", 1, 1, 0, 0, ILSA_SYMMETRY_NONE, READS_NOTHING},
    {"layers of equal stress", 0, 0, 1, 0, ILSA_SYMMETRY_NONE, READS_NOTHING},
    {"second source at rest", 0, 0, 0, 1, ILSA_SYMMETRY_NONE, READS_NOTHING},
    {"snapshot each step", 0, 0, 0, 0, ILSA_SYMMETRY_NONE, SAVES},
    {"fields, front, regimes each step", 0, 0, 0, 0, ILSA_SYMMETRY_NONE, READS_FIELDS},
    {"symmetry x", 0, 0, 0, 0, ILSA_SYMMETRY_X, READS_NOTHING},
    {"symmetry y", 0, 0, 0, 0, ILSA_SYMMETRY_Y, READS_NOTHING},
    {"symmetry xy", 0, 0, 0, 0, ILSA_SYMMETRY_XY, READS_NOTHING},
    {"leak-off, toughness, symmetry xy", 1, 1, 0, 0, ILSA_SYMMETRY_XY, READS_NOTHING},
};
enum { VARIANTS = sizeof variants / sizeof *variants };

typedef struct cost {
    ilsa_status status;
    double seconds; /* of all measured steps */
    ilsa_report work;
    int cells, unknowns;
    size_t made, grown; /* bytes of the new solver, added by the steps and what reads them */
    long calls;         /* allocations during the measured steps */
} cost;

/* The rock of the layered scenes under uniform stress, a penny of 20 m. */
static ilsa_solver *start(const variant *v) {
    const ilsa_source_def wells[] = {{0, 0, 0.01}, {4, 0, 0}};
    ilsa_solver_def how = ilsa_solver_def_default();
    speed_scene scene = speed_scene_of(SPEED_SYMMETRIC);
    scene.start = scene.length;
    scene.half_x = scene.half_y = 1.2;
    scene.stress = v->equal_layers ? SPEED_LAYERS : SPEED_UNIFORM;
    for (int k = 0; k < 3; k++)
        scene.sigma[k] = 0;
    scene.material.C_prime *= v->leak_off;
    scene.material.K_prime *= v->toughness;
    how.symmetry = v->symmetry;
    how.sources = wells;
    how.source_count = 1 + v->second_source;
    return speed_start(&scene, CELLS, &how);
}

/* A snapshot into memory that was there before; the fields as a writer of files goes over them. */
static double read_state(ilsa_solver *solver, reading what, void *image, size_t room) {
    const double *width, *pressure;
    const unsigned char *kind;
    const ilsa_front_point *front;
    const ilsa_survey_point *survey;
    ilsa_mesh_def m;
    ilsa_summary s;
    size_t count;
    double sum = 0;
    if (what == SAVES)
        return (double)ilsa_snapshot_save(solver, image, &room);
    if (what == READS_NOTHING || ilsa_get_mesh_def(solver, &m) || ilsa_get_width(solver, &width) ||
        ilsa_get_pressure(solver, &pressure) || ilsa_get_cell_kinds(solver, &kind) ||
        ilsa_get_front(solver, &front, &count) || ilsa_get_survey(solver, &survey, &count) ||
        ilsa_get_summary(solver, &s))
        return 0;
    for (int n = 0; n < m.nx * m.ny; n++)
        sum += width[n] + pressure[n] + kind[n];
    return sum;
}

/* The sum keeps the readings from being left out. */
static double take_steps(cost *c, ilsa_solver *solver, const variant *v, void *image, size_t room) {
    double sum = 0;
    for (int k = 0; k < STEPS && c->status == ILSA_OK; k++) {
        ilsa_report r;
        c->status = ilsa_advance_one(solver, 1e9, &r);
        c->work.steps += r.steps;
        c->work.front_iterations += r.front_iterations;
        c->work.newton_iterations += r.newton_iterations;
        c->work.elasticity_products += r.elasticity_products;
        sum += read_state(solver, v->reads, image, room);
    }
    return sum;
}

static cost run(const variant *v) {
    cost c = {.status = ILSA_ERR_STATE};
    ilsa_summary s;
    size_t room = 0;
    void *image = NULL;
    const size_t before = heap.live;
    ilsa_solver *solver = start(v);
    if (!solver)
        return c;
    c.made = heap.live - before;
    c.status = ILSA_OK;
    for (int k = 0; k < WARM && c.status == ILSA_OK; k++)
        c.status = ilsa_advance_one(solver, 1e9, NULL);
    if (v->reads == SAVES && ilsa_snapshot_save(solver, NULL, &room) == ILSA_OK) {
        room *= 2;
        image = malloc(room);
    }
    const long calls = heap.calls;
    const double begin = speed_clock(), sum = take_steps(&c, solver, v, image, room);
    c.seconds = isfinite(sum) ? speed_clock() - begin : NAN;
    c.calls = heap.calls - calls;
    free(image);
    c.grown = heap.live - before - c.made;
    if (ilsa_get_summary(solver, &s) == ILSA_OK)
        c.cells = s.cells, c.unknowns = s.unknowns;
    ilsa_solver_destroy(&solver);
    return c;
}

static void print_row(const variant *v, const cost *c, const cost *base) {
    const double steps = (double)c->work.steps;
    printf("| %s | %d | %d | %.2f | %.3f | %.1f | %.1f | %.1f | %zu | %zu | %ld |%s\n", v->name,
           c->cells, c->unknowns, 1e3 * c->seconds / steps, c->seconds / base->seconds,
           (double)c->work.elasticity_products / steps, (double)c->work.front_iterations / steps,
           (double)c->work.newton_iterations / steps, c->made / 1024, c->grown / 1024, c->calls,
           c->status ? ilsa_status_text(c->status) : "");
}

int main(void) {
    static cost costs[VARIANTS];
    speed_one_thread();
    printf("\nCPU time the least of %d runs of %d steps, the variants in turn; KiB on the heap.\n\n"
           "| with | wet cells | unknowns | ms a step | / nothing more | products a step | front "
           "passes | Newton | KiB, new | KiB, added | allocations in the steps |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|\n",
           REPEATS, STEPS);
    for (int n = 0; n < REPEATS; n++)
        for (int k = 0; k < VARIANTS; k++) {
            const cost c = run(&variants[k]);
            if (n == 0 || c.seconds < costs[k].seconds)
                costs[k] = c;
        }
    for (int k = 0; k < VARIANTS; k++)
        print_row(&variants[k], &costs[k], &costs[0]);
    printf("\nQuarter symmetry: %.2f times as fast; with leak-off and toughness %.2f.\n",
           costs[0].seconds / costs[10].seconds, costs[3].seconds / costs[11].seconds);
    return 0;
}
