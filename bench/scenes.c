/*
 * Every scene of examples/scenes through the public interface: the work it took, where the time
 * went, the answers, the worst volume balance over all steps; and the symmetric scene beside what a
 * public simulator gave on the same mesh.
 *
 *     bench_scenes [NAME ...]      scenes whose name contains NAME; without: all sixteen
 */
#include "common_layers.h"
#include "common_worst.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SCENES = LAYER_SCENES + FIG_SCENES, MAX_TIMES = LAYER_TIMES };

/* One scene's run. */
typedef struct run {
    const char *name;
    ilsa_summary at[MAX_TIMES]; /* at its output times */
    ilsa_profile profile;
    double balance; /* worst of injected - fracture - leaked over injected */
    ilsa_status status;
    int reached;        /* of the output times */
    int median, worst;  /* products of a step, refused attempts included */
    int worst_unknowns; /* largest number of unknowns */
} run;

enum { MOST = 100000 };
static double products[MOST]; /* per accepted step of the scene at work */

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double unbalance(const ilsa_summary *s) {
    return fabs(s->volume_injected - s->volume_fracture - s->volume_leaked) / s->volume_injected;
}

/* On to a time, step by step; counts the steps so far in *steps. */
static ilsa_status follow(run *r, ilsa_solver *solver, double time, int *steps) {
    ilsa_summary s;
    ilsa_status status = ilsa_get_summary(solver, &s);
    while (status == ILSA_OK && s.time < time && *steps < MOST) {
        ilsa_report report;
        status = ilsa_advance_one(solver, time, &report);
        if (status != ILSA_OK || ilsa_get_summary(solver, &s) != ILSA_OK)
            break;
        products[(*steps)++] = (double)report.elasticity_products;
        r->balance = larger_of(r->balance, unbalance(&s));
        r->worst_unknowns = s.unknowns > r->worst_unknowns ? s.unknowns : r->worst_unknowns;
    }
    return status;
}

static void run_scene(run *r, ilsa_solver *solver, const double *times, int count) {
    int steps = 0;
    if (!solver) {
        r->status = ILSA_ERR_STATE;
        return;
    }
    while (r->reached < count && r->status == ILSA_OK) {
        r->status = follow(r, solver, times[r->reached], &steps);
        ilsa_get_summary(solver, &r->at[r->reached]);
        r->reached += r->status == ILSA_OK;
    }
    if (r->status != ILSA_OK)
        fprintf(stderr, "%s: %s\n", r->name, ilsa_last_error(solver));
    qsort(products, (size_t)steps, sizeof *products, ascending);
    r->median = steps ? (int)products[steps / 2] : 0;
    r->worst = steps ? (int)products[steps - 1] : 0;
    ilsa_get_profile(solver, &r->profile);
    ilsa_solver_destroy(&solver);
}

/* The summary where it ended: the last time, or the stop before. */
static const ilsa_summary *last(const run *r) {
    return &r->at[r->status == ILSA_OK ? r->reached - 1 : r->reached];
}

static double per_step(const run *r, long count) {
    return (double)count / (double)last(r)->total.steps;
}

static void print_work(const run *r, int count) {
    printf(
        "\n### Work\n\nPer accepted step, refused attempts included.\n\n"
        "| scene | ended | steps | refused | products: mean | median | worst step | front passes "
        "| Newton | Krylov per Newton | unknowns at most | volume balance | wall s |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (; count-- > 0; r++) {
        const ilsa_report *t = &last(r)->total;
        printf(
            "| %s | %s | %ld | %ld (%.1f %%) | %.1f | %d | %d | %.2f | %.2f | %.2f | %d | %.1e | "
            "%.2f |\n",
            r->name, r->status ? ilsa_status_text(r->status) : "yes", t->steps, t->rejected,
            100 * (double)t->rejected / (double)(t->steps + t->rejected),
            per_step(r, t->elasticity_products), r->median, r->worst,
            per_step(r, t->front_iterations), per_step(r, t->newton_iterations),
            (double)t->krylov_iterations / (double)t->newton_iterations, r->worst_unknowns,
            r->balance, t->seconds);
    }
}

static void print_profile(const run *r, int count) {
    printf("\n### Where the time goes, %% of the steps' wall time\n\n"
           "| scene | elasticity products | preconditioner | front | rest | ms a step |\n"
           "|---|---|---|---|---|---|\n");
    for (; count-- > 0; r++) {
        const ilsa_profile *p = &r->profile;
        const double all = last(r)->total.seconds / 100;
        printf("| %s | %.0f | %.0f | %.0f | %.0f | %.1f |\n", r->name, p->product / all,
               p->preconditioner / all, p->front / all, p->rest / all,
               1e5 * all / (double)last(r)->total.steps);
    }
}

static void print_answers(const run *r, int count) {
    printf(
        "\n### Answers\n\nLengths and times in m and s in the layered scenes, dimensionless in "
        "the radial ones.\n\n| scene | time | half-length | up | down | width at source | "
        "pressure there | efficiency | cells | at rest |\n|---|---|---|---|---|---|---|---|---|---|"
        "\n");
    for (; count-- > 0; r++)
        for (int k = 0; k < r->reached; k++) {
            const ilsa_summary *s = &r->at[k];
            printf("| %s | %g | %.4g | %.4g | %.4g | %.4g | %.5g | %.4f | %d | %d |\n", r->name,
                   s->time, s->x_max, s->y_max, -s->y_min, s->width_source, s->pressure_source,
                   s->efficiency, s->cells, s->arrested_cells);
        }
}

/* Issue 2, figure 6: PyFrac on the same mesh, symmetric barriers, phi = 1e-2. */
static const struct {
    double time, length, height, width, efficiency;
} peer[] = {{100, 13.78, 12.32, 2.80e-3, 0.873},
            {200, 20.10, 14.24, 3.22e-3, 0.844},
            {400, 30.50, 16.66, 3.68e-3, 0.808}};

static double percent(double ours, double theirs) {
    return 100 * (ours / theirs - 1);
}

static void print_peer_rows(int cells) {
    ilsa_solver *solver = layer_start(&layer_scenes[1], cells);
    for (size_t k = 0; k < sizeof peer / sizeof *peer && solver; k++) {
        ilsa_summary s;
        if (ilsa_advance(solver, peer[k].time, NULL) || ilsa_get_summary(solver, &s))
            break;
        printf("| H/%d | %g | %.2f, %.2f, %+.1f %% | %.2f, %.2f, %+.1f %% | %.3f, %.2f, %+.1f %% | "
               "%.4f, %.3f, %+.1f %% |\n",
               cells, s.time, s.x_max, peer[k].length, percent(s.x_max, peer[k].length), s.y_max,
               peer[k].height, percent(s.y_max, peer[k].height), 1e3 * s.width_source,
               1e3 * peer[k].width, percent(s.width_source, peer[k].width), s.efficiency,
               peer[k].efficiency, percent(s.efficiency, peer[k].efficiency));
    }
    ilsa_solver_destroy(&solver);
}

static void print_peer(void) {
    printf("\n### %s beside a public simulator\n\nOurs, theirs (on H/21), difference; ours also "
           "on finer cells, for where both ought to be.\n\n"
           "| ours on | time | half-length, m | half-height, m | width at source, mm | efficiency "
           "|\n|---|---|---|---|---|---|\n",
           layer_scenes[1].name);
    print_peer_rows(21);
    print_peer_rows(42);
    print_peer_rows(63);
}

static int wanted(const char *name, int argc, char **argv) {
    int found = argc < 2;
    for (int k = 1; k < argc; k++)
        found |= strstr(name, argv[k]) != NULL;
    return found;
}

int main(int argc, char **argv) {
    static run runs[SCENES];
    int count = 0;
    for (int k = 0; k < SCENES; k++) {
        const fig_scene *fig = k < FIG_SCENES ? &fig_scenes[k] : NULL;
        /* cppcheck-suppress negativeIndex ; takes no notice of the condition */
        const layer_scene *layers = fig ? NULL : &layer_scenes[k - FIG_SCENES];
        run *r = &runs[count];
        r->name = fig ? fig->name : layers->name;
        if (!wanted(r->name, argc, argv))
            continue;
        if (fig)
            run_scene(r, fig_start(fig), &fig->time, 1);
        else
            run_scene(r, layer_start(layers, 21), layer_times, LAYER_TIMES);
        count++;
    }
    print_work(runs, count);
    print_profile(runs, count);
    print_answers(runs, count);
    if (wanted(layer_scenes[1].name, argc, argv))
        print_peer();
    return 0;
}
