/*
 * Scenes from the field, of tests/data/field, as ilsa-run takes them: layers from a log, thin pays,
 * slickwater, shut-ins. A dozen of a second each; with $ILSA_LONG all hundred but those that take
 * minutes.
 */
#include "../bench/scene_files/field.h"
#include "check.h"

#include <stdio.h>
#include <stdlib.h>

enum { SCENES = 100, QUICK = 12 };

/* Of each kind that has once stalled, or held pressures that mean nothing. */
static const int quick[QUICK] = {5, 10, 11, 12, 17, 18, 21, 41, 51, 61, 65, 74};

/* Long thin pays on cells of 0.8 m: over a minute of CPU time, 80 an hour. */
static int takes_minutes(int scene) {
    return scene == 2 || scene == 33 || scene == 80 || scene == 100;
}

/* More than any takes, under a sanitizer too. */
#define SECONDS 600

static void say(const field_case *run, const field_result *r, void *user) {
    (void)user;
    if (r->verdict == FIELD_WRONG)
        print_message("%s: %s\n", run->file, r->what);
}

/* Each ends right, with one attempt in twenty refused at most; of all attempts one in a hundred. */
static void field_scenes_run_to_their_end(void **state) {
    (void)state;
    int all = getenv("ILSA_LONG") != NULL, count = 0, wrong = 0, often = 0;
    field_case *runs = calloc(SCENES, sizeof *runs);
    field_result *results = calloc(SCENES, sizeof *results);
    double steps = 0, refused = 0, passes = 0;
    assert_true(runs && results);
    for (int k = 0; k < (all ? SCENES : QUICK); k++) {
        int scene = all ? k + 1 : quick[k];
        if (takes_minutes(scene))
            continue;
        runs[count].seconds = SECONDS;
        snprintf(runs[count].file, sizeof runs[count].file, "tests/data/field/%04d.ini", scene);
        count++;
    }
    field_run(runs, results, count, say, NULL);
    for (int k = 0; k < count; k++) {
        const ilsa_report *total = &results[k].end.total;
        steps += (double)total->steps;
        refused += (double)total->rejected;
        passes += (double)total->front_iterations;
        wrong += results[k].verdict == FIELD_WRONG;
        often += (double)total->rejected > 1 + 0.05 * (double)(total->steps + total->rejected);
    }
    print_message("%d field scenes: %d wrong, %.0f of %.0f attempts refused, in %d over 5 %%, %.1f "
                  "passes a step\n",
                  count, wrong, refused, steps + refused, often, passes / steps);
    free(runs);
    free(results);
    assert_int_equal(wrong, 0);
    assert_int_equal(often, 0);
    assert_below(refused, 0.01 * (steps + refused));
    assert_below(passes, 5 * steps); /* a wrong sensitivity once had 10 in some scenes */
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(field_scenes_run_to_their_end)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
