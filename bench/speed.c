/*
 * The library beside the plain algorithm (nested loops, fixed-point front, no predictor, dense LU,
 * no symmetry) in the same code: both take the same steps from the same state.
 *
 *     OPENBLAS_NUM_THREADS=1 bench_speed [SIZE]      SIZE 0, 1, 2: one of the three; without: all
 *
 * CPU times; their ratio is what counts. The fronts are compared in parts of the footprint's larger
 * half extent.
 */
#include "common_speed.h"
#include "common_worst.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZES = 3 };

/* Wet cells where the comparison begins, cells per radius and per layer that lead there, steps. */
static const struct {
    int unknowns, radial, layered, steps;
} sizes[SIZES] = {{300, 10, 11, 3}, {1300, 20, 21, 2}, {5000, 40, 41, 1}};

/* The steps that plain was able to take, which ours takes after it. */
enum { STEPS_MOST = 64 };
typedef struct timetable {
    int count;
    double dt[STEPS_MOST];
} timetable;

/* What one of the two did. */
typedef struct outcome {
    ilsa_status status;
    double seconds;
    ilsa_report work; /* sums */
    int unknowns;
    timetable taken;
} outcome;

/* One step of the host's, or as many halves of it as are accepted. */
static ilsa_status take(ilsa_solver *solver, double dt, outcome *o) {
    ilsa_report r, *sum = &o->work;
    ilsa_status status = ilsa_step(solver, dt, &r);
    sum->steps += r.steps;
    sum->rejected += r.rejected;
    sum->front_iterations += r.front_iterations;
    sum->newton_iterations += r.newton_iterations;
    sum->elasticity_products += r.elasticity_products;
    if (status == ILSA_OK && o->taken.count < STEPS_MOST)
        o->taken.dt[o->taken.count++] = dt;
    if (status <= ILSA_OK || sum->rejected > STEPS_MOST)
        return status;
    status = take(solver, 0.5 * dt, o);
    return status ? status : take(solver, 0.5 * dt, o);
}

static outcome run_once(ilsa_solver *solver, const timetable *steps) {
    outcome o = {.status = ILSA_OK};
    const double start = speed_clock();
    for (int k = 0; k < steps->count && o.status == ILSA_OK; k++)
        o.status = take(solver, steps->dt[k], &o);
    o.seconds = speed_clock() - start;
    return o;
}

/* From a state on, several times where that is quick: the least time counts. */
static outcome run(ilsa_solver *solver, const ilsa_solver *from, const timetable *steps) {
    enum { REPEATS = 7 };
    outcome best = {.seconds = HUGE_VAL};
    double spent = 0;
    ilsa_summary s;
    for (int k = 0; k < REPEATS && spent < 0.3; k++) {
        const ilsa_status status = speed_copy_state(solver, from);
        const outcome refused = {.status = status};
        const outcome o = status ? refused : run_once(solver, steps);
        spent += o.seconds;
        best = o.seconds < best.seconds ? o : best;
    }
    if (ilsa_get_summary(solver, &s) == ILSA_OK)
        best.unknowns = s.unknowns;
    return best;
}

/* ---- Fronts ------------------------------------------------------------------------------- */

typedef struct curve {
    const ilsa_front_point *at;
    size_t count;
} curve;

static double to_segment(const ilsa_front_point *p, const ilsa_front_point *a,
                         const ilsa_front_point *b) {
    const double x = b->x - a->x, y = b->y - a->y;
    const double along = ((p->x - a->x) * x + (p->y - a->y) * y) / (x * x + y * y);
    const double u = fmin(fmax(along, 0), 1);
    return hypot(p->x - a->x - u * x, p->y - a->y - u * y);
}

/* The largest distance of a point of one front from the other, which is one closed curve. */
static double apart(const curve *a, const curve *b) {
    double worst = 0;
    for (size_t i = 0; i < a->count; i++) {
        double nearest = HUGE_VAL;
        for (size_t k = 0; k < b->count; k++)
            nearest = smaller_of(
                nearest, to_segment(&a->at[i], &b->at[k], &b->at[k + 1 < b->count ? k + 1 : 0]));
        worst = larger_of(worst, nearest);
    }
    return worst;
}

/* Between the two fronts, % of the larger half extent. */
static double difference(ilsa_solver *ours, ilsa_solver *plain) {
    curve a, b;
    ilsa_summary s;
    if (ilsa_get_front(ours, &a.at, &a.count) || ilsa_get_front(plain, &b.at, &b.count) ||
        ilsa_get_summary(ours, &s))
        return NAN;
    const double extent =
        0.5 * fmax(s.extent_x_max - s.extent_x_min, s.extent_y_max - s.extent_y_min);
    return 100 * larger_of(apart(&a, &b), apart(&b, &a)) / extent;
}

/* Height of the footprint on the y axis over its largest: below 1 it has a waist. */
static double waist(const ilsa_solver *solver) {
    ilsa_summary s;
    if (ilsa_get_summary(solver, &s))
        return NAN;
    return (s.y_max - s.y_min) / (s.extent_y_max - s.extent_y_min);
}

/* ---- One scene ---------------------------------------------------------------------------- */

/* Ours, grown until it has so many wet cells. */
static ilsa_solver *grow(const speed_scene *scene, int cells, int unknowns) {
    const ilsa_solver_def how = ilsa_solver_def_default();
    ilsa_solver *solver = speed_start(scene, cells, &how);
    ilsa_summary s = {0};
    ilsa_status status = solver ? ilsa_get_summary(solver, &s) : ILSA_ERR_STATE;
    while (status == ILSA_OK && s.cells < unknowns) {
        status = ilsa_advance_one(solver, 1000 * scene->end, NULL);
        status = status ? status : ilsa_get_summary(solver, &s);
    }
    if (status != ILSA_OK) {
        fprintf(stderr, "%s: %s\n", scene->name, ilsa_last_error(solver));
        ilsa_solver_destroy(&solver);
    }
    return solver;
}

static void print_row(const speed_scene *scene, const outcome *ours, const outcome *plain,
                      double off) {
    const ilsa_report *o = &ours->work, *p = &plain->work;
    printf("| %s | %d, %d | %ld, %ld | %ld, %ld | %ld, %ld | %ld, %ld | %.4f | %.4f | %.2f | "
           "**%.1f** |\n",
           scene->name, plain->unknowns, ours->unknowns, p->steps + p->rejected,
           o->steps + o->rejected, p->front_iterations, o->front_iterations, p->newton_iterations,
           o->newton_iterations, p->elasticity_products, o->elasticity_products, off, ours->seconds,
           plain->seconds, plain->seconds / ours->seconds);
    fflush(stdout);
}

/*
 * Steps of the length that ours suggests; where all of the fluid leaks off, half of it: the nested
 * loops do not converge on the whole.
 */
static timetable suggested(const ilsa_solver *ours, int which, int count) {
    timetable t = {.count = count};
    double dt = 0;
    (void)ilsa_suggest_dt(ours, &dt);
    for (int k = 0; k < count; k++)
        t.dt[k] = which == SPEED_M_TILDE ? 0.5 * dt : dt;
    return t;
}

/* Plain over ours; NaN where one of them did not arrive. */
static double race(int which, int size, ilsa_solver *from, ilsa_solver *ours, ilsa_solver *plain) {
    const speed_scene scene = speed_scene_of(which);
    const timetable steps = suggested(from, which, sizes[size].steps);
    const outcome p = run(plain, from, &steps), o = run(ours, from, &p.taken);
    print_row(&scene, &o, &p, difference(ours, plain));
    if (scene.stress == SPEED_DISCS)
        printf("\nThe hourglass is %.0f %% as high at its waist as at its widest.\n",
               100 * waist(ours));
    return p.status || o.status ? NAN : p.seconds / o.seconds;
}

static double compare(int which, int size) {
    const speed_scene scene = speed_scene_of(which);
    const int cells = scene.stress == SPEED_UNIFORM ? sizes[size].radial : sizes[size].layered;
    ilsa_solver_def how = ilsa_solver_def_default();
    ilsa_solver *from = grow(&scene, cells, sizes[size].unknowns);
    ilsa_solver *ours = speed_start(&scene, cells, &how);
    how.loop = ILSA_LOOP_NESTED;
    how.linear = ILSA_LINEAR_DENSE;
    how.symmetry = ILSA_SYMMETRY_NONE;
    ilsa_solver *plain = speed_start(&scene, cells, &how);
    const double ratio = from && ours && plain ? race(which, size, from, ours, plain) : NAN;
    ilsa_solver_destroy(&plain);
    ilsa_solver_destroy(&ours);
    ilsa_solver_destroy(&from);
    return ratio;
}

static void print_size(int size) {
    double sum = 0;
    printf(
        "\n### %d unknowns, %d step%s\n\n"
        "Plain, ours. Attempts: steps taken and refused. Fronts apart: %% of the half extent.\n\n"
        "| scene | unknowns | attempts | front passes | linear systems | products | fronts apart "
        "| ours, s | plain, s | plain / ours |\n|---|---|---|---|---|---|---|---|---|---|\n",
        sizes[size].unknowns, sizes[size].steps, sizes[size].steps > 1 ? "s" : "");
    for (int which = 0; which < SPEED_SCENES; which++)
        sum += log(compare(which, size));
    printf("\nGeometric mean of plain / ours: **%.1f**\n", exp(sum / SPEED_SCENES));
}

int main(int argc, char **argv) {
    speed_one_thread();
    for (int size = 0; size < SIZES; size++)
        if (argc < 2 || strtol(argv[1], NULL, 10) == size)
            print_size(size);
    return 0;
}
