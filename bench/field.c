/*
 * Scenes as they come from the field, each run to its end and judged: see scene_files/field.h.
 *
 *     bench_field [-l LEVEL] [-f HALVINGS] [-s SECONDS] [-v] FILE ...
 *
 * A row a scene, then what they sum to. -l: at another level than the file's; -f: on cells halved
 * so many times; -s: CPU seconds a run may take. -v runs each scene five times: as it is, with its
 * stresses changed in the seventh digit, its starting radius by 1 % up and down, its cells by 1 %;
 * and prints by how much the answers differ.
 */
#include "scene_files/field.h"
#include "common_worst.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const verdicts[] = {"right", "edge", "WRONG"};

/* ---- A row a scene -------------------------------------------------------------------------- */

/* Rows are printed in the order of the scenes, as soon as all before them are known. */
typedef struct table {
    const field_case *runs;
    const field_result *results;
    char *done;
    int count, printed;
} table;

static const char *base(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static void print_row(const field_case *run, const field_result *r) {
    const ilsa_summary *s = &r->end;
    printf("%-16s %-6s %6ld %6ld %7.2f %6.1f %5d %7.1f %7.1f %8.1f %7.1f %7.1f %7.3f %7.4f %7.2f",
           base(run->file), verdicts[r->verdict], s->total.steps, s->total.rejected, r->seconds,
           r->across, s->closed_cells, 1e-6 * r->least_pressure, 1e-6 * r->most_pressure,
           0.5 * (s->extent_x_max - s->extent_x_min), s->extent_y_min, s->extent_y_max,
           1e3 * s->width_source, s->efficiency, 1e-6 * r->net_pressure);
    printf("%s%s\n", r->verdict == FIELD_WRONG ? "  " : "",
           r->verdict == FIELD_WRONG ? r->what : "");
    fflush(stdout);
}

static void show(const field_case *run, const field_result *result, void *user) {
    table *t = user;
    (void)result;
    t->done[run - t->runs] = 1;
    while (t->printed < t->count && t->done[t->printed]) {
        print_row(&t->runs[t->printed], &t->results[t->printed]);
        t->printed++;
    }
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_sums(const field_result *results, int count) {
    double *seconds = malloc((size_t)count * sizeof *seconds), sum = 0, worst_part = 0;
    long steps = 0, refused = 0;
    int right = 0, over = 0;
    if (!seconds)
        return;
    for (int k = 0; k < count; k++) {
        const ilsa_report *total = &results[k].end.total;
        double part = (double)total->rejected / fmax((double)(total->steps + total->rejected), 1);
        seconds[k] = results[k].seconds;
        sum += seconds[k];
        steps += total->steps;
        refused += total->rejected;
        right += results[k].verdict != FIELD_WRONG;
        over += part > 0.05;
        worst_part = larger_of(worst_part, part);
    }
    qsort(seconds, (size_t)count, sizeof *seconds, ascending);
    printf("%d of %d right; refused %ld of %ld attempts, %.2f %%, of a scene at most %.1f %%, "
           "in %d over 5 %%; CPU s: sum %.1f, median %.2f, largest %.1f\n",
           right, count, refused, steps + refused,
           100 * (double)refused / fmax((double)(steps + refused), 1), 100 * worst_part, over, sum,
           seconds[count / 2], seconds[count - 1]);
    free(seconds);
}

/* ---- Luck ----------------------------------------------------------------------------------- */

enum { VARIANTS = 5 };
static const field_case variants[VARIANTS] = {
    {.level = 0},           {.stress_noise = 1e-7}, {.radius_part = 0.01},
    {.radius_part = -0.01}, {.cell_part = 0.01},
};

static double off(double value, double reference) {
    return 100 * fabs(value / reference - 1);
}

/* By how much a variant's answers differ: in per cent, heights in cells. */
static void print_variant(const field_result *was, const field_result *is) {
    const ilsa_summary *a = &was->end, *b = &is->end;
    double height =
        larger_of(fabs(b->extent_y_max - a->extent_y_max), fabs(b->extent_y_min - a->extent_y_min));
    if (is->verdict == FIELD_WRONG || was->verdict == FIELD_WRONG)
        printf(" | %-34s", is->verdict == FIELD_WRONG ? "WRONG" : "");
    else
        printf(" | %6.2f %5.2f %6.2f %6.2f %6.2f",
               off(b->extent_x_max - b->extent_x_min, a->extent_x_max - a->extent_x_min),
               height / was->dy, off(b->width_source, a->width_source),
               off(b->efficiency, a->efficiency), off(b->pressure_source, a->pressure_source));
}

static void print_luck(const field_case *runs, const field_result *results, int scenes) {
    printf(
        "scene            | half-length %%, heights cells, width %%, efficiency %%, pressure %%, "
        "with: stresses in the 7th digit | radius +1 %% | radius -1 %% | cells +1 %%\n");
    for (int k = 0; k < scenes; k++, runs += VARIANTS, results += VARIANTS) {
        printf("%-16s", base(runs->file));
        for (int v = 1; v < VARIANTS; v++)
            print_variant(&results[0], &results[v]);
        printf("\n");
    }
}

/* ---- ---------------------------------------------------------------------------------------- */

/* The number that an option was given; NAN where there is none. */
static double number(const char *text) {
    char *end;
    double value = strtod(text, &end);
    return end == text || *end ? NAN : value;
}

static int usage(void) {
    fprintf(stderr, "bench_field [-l LEVEL] [-f HALVINGS] [-s SECONDS] [-v] FILE ...\n");
    return 2;
}

/* Runs the scenes, each as the options say or in all variants, and prints what came of them.
 * Returns how many runs were wrong. */
static int run_all(field_case *runs, field_result *results, char *done, int count, int luck) {
    table t = {runs, results, done, count, 0};
    int wrong = 0;
    printf("scene            verdict steps refused  CPU s across closed  p least  p most (MPa) "
           "half-length  bottom     top  w (mm)  effic. net (MPa)\n");
    field_run(runs, results, count, show, &t);
    print_sums(results, count);
    if (luck)
        print_luck(runs, results, count / VARIANTS);
    for (int k = 0; k < count; k++)
        wrong += results[k].verdict == FIELD_WRONG;
    return wrong;
}

/* Each file as the options say, in so many variants. */
static void set_runs(field_case *runs, int count, int each, const field_case *options,
                     char *const *files) {
    for (int k = 0; k < count; k++) {
        runs[k] = variants[k % each];
        runs[k].level = options->level;
        runs[k].finer = options->finer;
        runs[k].seconds = options->seconds;
        snprintf(runs[k].file, sizeof runs[k].file, "%s", files[k / each]);
    }
}

int main(int argc, char **argv) {
    field_case options = {.level = 0};
    int luck = 0;
    for (int c; (c = getopt(argc, argv, "l:f:s:v")) != -1;) {
        double value = c == 'v' || c == '?' ? 0 : number(optarg);
        if (c == 'l' && value >= 1 && value <= 5)
            options.level = (int)value;
        else if (c == 'f' && value >= 0 && value <= 4)
            options.finer = (int)value;
        else if (c == 's' && value > 0)
            options.seconds = value;
        else if (c == 'v')
            luck = 1;
        else
            return usage();
    }
    int scenes = argc - optind, each = luck ? VARIANTS : 1, count = scenes * each, wrong = 1;
    if (scenes < 1)
        return usage();
    field_case *runs = calloc((size_t)count, sizeof *runs);
    field_result *results = calloc((size_t)count, sizeof *results);
    char *done = calloc((size_t)count, 1);
    if (runs && results && done) {
        set_runs(runs, count, each, &options, argv + optind);
        wrong = run_all(runs, results, done, count, luck);
    }
    free(runs);
    free(results);
    free(done);
    return wrong > 0;
}
