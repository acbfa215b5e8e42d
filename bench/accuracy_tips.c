/*
 * What the tip asymptote is worth: the same fractures with the full one, with that of toughness and
 * viscosity, and with toughness alone (LEFM), as Markdown tables for docs/accuracy.md.
 *
 *     bench_accuracy_tips [long] [radial] [layers]
 *
 * Without a table's name: both. long: H/42 and two more of the layered scenes (an hour).
 */
#include "common_layers.h"
#include "common_radial.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int is_long;

enum { TIPS = 3, MESHES = 3 };
static const char *const tip_name[TIPS] = {[ILSA_TIP_FULL] = "full",
                                           [ILSA_TIP_TOUGHNESS_VISCOSITY] = "toughness-viscosity",
                                           [ILSA_TIP_TOUGHNESS] = "toughness (LEFM)"};

/*
 * Raises the rate from low to full, in proportion to a power of the injected volume, until that is
 * last. A front that follows toughness alone has to be led: it cannot leave from the true width of
 * a fast fracture, which at the tip is many times that of toughness.
 */
static ilsa_status raise_rate(ilsa_solver *solver, double low, double full, double last) {
    ilsa_summary s;
    ilsa_status status = ilsa_get_summary(solver, &s);
    const double first = s.volume_injected, power = log(full / low) / log(last / first);
    while (status == ILSA_OK && s.volume_injected < last) {
        const double rate = low * pow(s.volume_injected / first, power);
        status = ilsa_set_rate(solver, 0, rate);
        status = status ? status
                        : ilsa_advance_one(solver, s.time + 0.1 * s.volume_injected / rate, NULL);
        status = status ? status : ilsa_get_summary(solver, &s);
    }
    return status ? status : ilsa_set_rate(solver, 0, full);
}

/* The time at which so much has been injected, at the full rate from now on. */
static double time_of(ilsa_solver *solver, double volume, double rate) {
    ilsa_summary s = {0};
    ilsa_get_summary(solver, &s);
    return s.time + (volume - s.volume_injected) / rate;
}

/* ---- Radial ------------------------------------------------------------------------------- */

/* E' = mu' = K' = 1, C' = phi^(1/4), rate 1 but for the beginning. */
typedef struct radial_case {
    const char *name;
    double phi, time;
    double low;  /* rate at first */
    double part; /* of the volume after which it is 1 */
} radial_case;

static const radial_case radial_cases[] = {{"viscosity: phi 0, tau 1e-3", 0, 1e-3, 1e-3, 0.25},
                                           {"viscosity: phi 0, tau 1e-2", 0, 1e-2, 1e-3, 0.25},
                                           {"viscosity: phi 0, tau 1", 0, 1, 0.1, 0.1},
                                           {"middle: phi 1e-4, tau 1", 1e-4, 1, 0.1, 0.1},
                                           {"leak-off: phi 1, tau 1", 1, 1, 0.1, 0.1},
                                           {"toughness: phi 0, tau 1e5", 0, 1e5, 0.1, 0.1}};
enum { RADIAL_CASES = sizeof radial_cases / sizeof *radial_cases };
static const double radial_cells[MESHES] = {10, 20, 40};

/* What a run came to: errors against the reference; NaN if it did not get there. */
typedef struct radial_outcome {
    double R, efficiency; /* %, absolute */
    long steps, refused;
} radial_outcome;

/* From a quarter of the radius to the volume at which the radius ought to be so many cells. */
static radial_outcome run_radial(const radial_case *c, double cells, ilsa_tip_model tip) {
    const penny_law law = radial_law(c->phi);
    const penny end = radial_reference(law, c->time);
    const radial_def def = {.law = law,
                            .dx = end.R / cells,
                            .aspect = 1,
                            .mesh_cells = 1.5 * cells,
                            .tip = tip,
                            .rate = c->low};
    radial_outcome o = {NAN, NAN, 0, 0};
    ilsa_solver *solver = radial_start(&def, 0.25 * end.R);
    ilsa_status status = solver ? raise_rate(solver, c->low, 1, c->part * c->time) : ILSA_ERR_STATE;
    ilsa_summary s = {0};
    status = status ? status : radial_advance(solver, time_of(solver, c->time, 1), 2000);
    if (status == ILSA_OK) {
        const penny is = radial_state(solver);
        o.R = 100 * (is.R / end.R - 1);
        o.efficiency = is.efficiency - end.efficiency;
    }
    if (solver && ilsa_get_summary(solver, &s) == ILSA_OK) {
        o.steps = s.total.steps;
        o.refused = s.total.rejected;
    }
    ilsa_solver_destroy(&solver);
    return o;
}

static void print_number(const char *format, double value) {
    if (isnan(value))
        printf(" - |");
    else
        printf(format, value);
}

/* A row of the table; errors of the radius go to R. */
static void radial_row_of(const radial_case *c, ilsa_tip_model tip, double R[MESHES]) {
    radial_outcome o[MESHES];
    printf("| %s | %s |", c->name, tip_name[tip]);
    for (int m = 0; m < MESHES; m++) {
        o[m] = run_radial(c, radial_cells[m], tip);
        R[m] = o[m].R;
        print_number(" %+.2f |", o[m].R);
    }
    for (int m = 0; m < MESHES; m++)
        print_number(" %+.4f |", o[m].efficiency);
    printf(" %ld, %ld, %ld | %ld, %ld, %ld |\n", o[0].steps, o[1].steps, o[2].steps, o[0].refused,
           o[1].refused, o[2].refused);
    fflush(stdout);
}

static void print_claim(double R[RADIAL_CASES][TIPS][MESHES]) {
    printf("\nThe full asymptote on the coarsest mesh beside LEFM on the finest, error of R, %%:"
           "\n\n| case | full, 10 cells | LEFM, 40 cells |\n|---|---|---|\n");
    for (int k = 0; k < RADIAL_CASES; k++) {
        printf("| %s |", radial_cases[k].name);
        print_number(" %+.2f |", R[k][ILSA_TIP_FULL][0]);
        print_number(" %+.2f |", R[k][ILSA_TIP_TOUGHNESS][MESHES - 1]);
        printf("\n");
    }
}

/* Whether the first step from the true solution at the full rate can be taken. */
static const char *first_step(ilsa_solver *solver) {
    ilsa_report report;
    const ilsa_status status = solver ? ilsa_advance_one(solver, 1e300, &report) : ILSA_ERR_STATE;
    ilsa_solver_destroy(&solver);
    return status ? "no" : "yes";
}

static ilsa_solver *radial_at_once(const radial_case *c, double cells, ilsa_tip_model tip) {
    const penny end = radial_reference(radial_law(c->phi), c->time);
    const radial_def def = {.law = radial_law(c->phi),
                            .dx = end.R / cells,
                            .aspect = 1,
                            .mesh_cells = cells,
                            .tip = tip};
    return radial_start(&def, 0.5 * end.R);
}

static void beginnings(void) {
    printf("\n### Tip models, the first step\n\nWhether a step can be taken from the true "
           "solution at the full rate and half the radius, on cells with which the radius is 10, "
           "20, 40 of them at the end.\n\n| case | full | toughness-viscosity | LEFM |\n"
           "|---|---|---|---|\n");
    for (int k = 0; k < RADIAL_CASES; k++) {
        printf("| %s |", radial_cases[k].name);
        for (int tip = 0; tip < TIPS; tip++)
            for (int m = 0; m < MESHES; m++)
                printf("%s %s%s", m ? "," : "",
                       first_step(
                           radial_at_once(&radial_cases[k], radial_cells[m], (ilsa_tip_model)tip)),
                       m < MESHES - 1 ? "" : " |");
        printf("\n");
        fflush(stdout);
    }
}

static void radial(void) {
    double R[RADIAL_CASES][TIPS][MESHES];
    printf("\n### Tip models, radial\n\nA penny grown from a quarter of the radius to 10, 20 and "
           "40 cells per radius. Its rate is low at first and that of the case from a tenth or a "
           "quarter of the volume on. Error of the mean radius, %%, and of the efficiency, "
           "absolute, against the "
           "solution of constant rate at the same injected volume. -: did not get there.\n\n| case "
           "| tip | R, 10 cells | 20 | 40 | efficiency, 10 | 20 | "
           "40 | steps | refused |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < RADIAL_CASES; k++)
        for (int tip = 0; tip < TIPS; tip++)
            radial_row_of(&radial_cases[k], (ilsa_tip_model)tip, R[k][tip]);
    print_claim(R);
    beginnings();
}

/* ---- Three layers ------------------------------------------------------------------------- */

static const int layer_cells[MESHES] = {11, 21, 42};
enum { LENGTH, HEIGHT, WIDTH, EFFICIENCY, QUANTITIES };

/* What one scene gave; NaN where a run did not get there. */
typedef struct answers {
    double value[TIPS][MESHES][LAYER_TIMES][QUANTITIES];
    long steps[TIPS][MESHES], refused[TIPS][MESHES];
} answers;

static void run_layers(const layer_scene *scene, int tip, int mesh, answers *a) {
    const double rate = 0.01;
    const layer_how how = {(ilsa_tip_model)tip, 0.02 * rate, 4};
    ilsa_solver *solver = layer_start_as(scene, layer_cells[mesh], &how);
    ilsa_status status = solver ? raise_rate(solver, how.rate, rate, 80 * rate) : ILSA_ERR_STATE;
    ilsa_summary s = {0};
    for (int k = 0; k < LAYER_TIMES; k++) {
        double *value = a->value[tip][mesh][k];
        status = status ? status
                        : ilsa_advance(solver, time_of(solver, layer_times[k] * rate, rate), NULL);
        status = status ? status : ilsa_get_summary(solver, &s);
        value[LENGTH] = status ? NAN : s.x_max;
        value[HEIGHT] = status ? NAN : s.y_max - s.y_min;
        value[WIDTH] = status ? NAN : 1e3 * s.width_source;
        value[EFFICIENCY] = status ? NAN : s.efficiency;
    }
    if (status != ILSA_OK && solver)
        fprintf(stderr, "%s, %s on H/%d: %s\n", scene->name, tip_name[tip], layer_cells[mesh],
                ilsa_last_error(solver));
    if (solver && ilsa_get_summary(solver, &s) == ILSA_OK) {
        a->steps[tip][mesh] = s.total.steps;
        a->refused[tip][mesh] = s.total.rejected;
    }
    ilsa_solver_destroy(&solver);
}

/* A value and its difference from the best one, %, of the efficiency absolute. */
static void print_answer(int quantity, double value, double best) {
    if (isnan(value))
        printf(" - |");
    else if (quantity == EFFICIENCY)
        printf(" %.4f, %+.4f |", value, value - best);
    else
        printf(" %.4g, %+.1f |", value, 100 * (value / best - 1));
}

static void print_scene(const layer_scene *scene, const answers *a, int meshes) {
    for (int tip = 0; tip < TIPS; tip++)
        for (int mesh = 0; mesh < meshes; mesh++)
            for (int k = 0; k < LAYER_TIMES; k++) {
                printf("| %s | %s | H/%d | %g |", scene->name, tip_name[tip], layer_cells[mesh],
                       layer_times[k]);
                for (int q = 0; q < QUANTITIES; q++)
                    print_answer(q, a->value[tip][mesh][k][q],
                                 a->value[ILSA_TIP_FULL][meshes - 1][k][q]);
                printf(" %ld, %ld |\n", a->steps[tip][mesh], a->refused[tip][mesh]);
            }
    fflush(stdout);
}

static void layers(void) {
    static const struct {
        int scene, is_long; /* its place in layer_scenes */
    } chosen[] = {{0, 0}, {2, 0}, {4, 1}, {8, 1}};
    const int meshes = is_long ? MESHES : MESHES - 1;
    printf("\n### Tip models, three layers\n\nFrom a penny of 4 m and a fiftieth of the rate, the "
           "rate "
           "that of the scene once 80 s of it have been injected; time is the injected volume "
           "over the rate. Each value with its difference from the full tip on H/%d, %%, of the "
           "efficiency absolute. -: did not get there.\n\n"
           "| scene | tip | cells | time, s | half-length, m | height, m | width at source, mm | "
           "efficiency | steps, refused |\n|---|---|---|---|---|---|---|---|---|\n",
           layer_cells[meshes - 1]);
    for (size_t k = 0; k < sizeof chosen / sizeof *chosen; k++) {
        const layer_scene *scene = &layer_scenes[chosen[k].scene];
        answers a = {0};
        if (chosen[k].is_long && !is_long)
            continue;
        for (int tip = 0; tip < TIPS; tip++)
            for (int mesh = 0; mesh < meshes; mesh++)
                run_layers(scene, tip, mesh, &a);
        print_scene(scene, &a, meshes);
    }
}

int main(int argc, char **argv) {
    int with_radial = 0, with_layers = 0;
    for (int k = 1; k < argc; k++) {
        is_long |= strcmp(argv[k], "long") == 0;
        with_radial |= strcmp(argv[k], "radial") == 0;
        with_layers |= strcmp(argv[k], "layers") == 0;
    }
    if (with_radial || !with_layers)
        radial();
    if (with_layers || !with_radial)
        layers();
    return 0;
}
