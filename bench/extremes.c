/*
 * The map of extremes, as a table for docs/extremes.md: cases by kind, how many ended right, were
 * refused clearly, failed; then each that did not end right, with what it said. Exit status 1 if
 * any has failed.
 *
 *     bench_extremes [verbose] [KIND ...]     kinds whose name contains KIND; without: all
 */
#include "common_extremes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const verdicts[EXTREME_VERDICTS] = {"right", "refused", "failed"};

enum { LINE = 480, MOST = 1000 };
static char lines[MOST][LINE];
static int line_count, is_verbose;

static void note(const extreme_sweep *sweep, const char *name, const extreme_result *r) {
    if (is_verbose)
        fprintf(stderr, "%s: %s: %s: R %+.2f %%, %ld steps, %ld refused, %.2f s: %s\n",
                sweep->kind->name, name, verdicts[r->verdict], 100 * r->error_R, r->steps,
                r->refused, r->seconds, r->what);
    if (r->verdict != EXTREME_RIGHT && line_count < MOST)
        snprintf(lines[line_count++], LINE, "| %s | %s | %s | %ld, %ld | %.1f | %s |",
                 sweep->kind->name, name, verdicts[r->verdict], r->steps, r->refused, r->seconds,
                 r->what);
}

static int wanted(const char *name, int argc, char **argv) {
    int any = 0, found = 0;
    for (int k = 1; k < argc; k++) {
        const int word = strcmp(argv[k], "verbose") == 0;
        is_verbose |= word;
        any |= !word;
        found |= !word && strstr(name, argv[k]) != NULL;
    }
    return found || !any;
}

static void print_row(const char *name, const char *about, const extreme_sweep *s) {
    printf("| %s | %s | %d | %d | %d | %d | ", name, about, s->cases, s->count[EXTREME_RIGHT],
           s->count[EXTREME_REFUSED], s->count[EXTREME_FAILED]);
    if (s->worst_R != 0)
        printf("%.2f ", 100 * s->worst_R);
    printf("| %.0f |\n", s->seconds);
    fflush(stdout);
}

static void add(extreme_sweep *all, const extreme_sweep *s) {
    all->cases += s->cases;
    all->seconds += s->seconds;
    for (int v = 0; v < EXTREME_VERDICTS; v++)
        all->count[v] += s->count[v];
}

int main(int argc, char **argv) {
    extreme_sweep all = {0};
    printf("| kind | what | cases | right | refused | failed | worst R, %% | s |\n"
           "|---|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < extreme_kind_count; k++)
        if (wanted(extreme_kinds[k].name, argc, argv)) {
            const extreme_sweep s = extreme_sweep_over(&extreme_kinds[k], 1, note);
            print_row(s.kind->name, s.kind->about, &s);
            add(&all, &s);
        }
    print_row("all", "", &all);
    if (line_count > 0)
        printf("\n| kind | case | verdict | steps, refused | s | what it said |\n"
               "|---|---|---|---|---|---|\n");
    for (int k = 0; k < line_count; k++)
        printf("%s\n", lines[k]);
    printf("\nRight: %.1f %%.\n", 100.0 * all.count[EXTREME_RIGHT] / (all.cases ? all.cases : 1));
    return all.count[EXTREME_FAILED] > 0;
}
