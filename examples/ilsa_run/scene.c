#include "scene.h"

#include "draft.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static double number_or(const section *s, int key, double otherwise) {
    return draft_has(s, key) ? s->values[key].number : otherwise;
}

/* Moves the numbers of a list out of the draft. */
static double *take_numbers(section *s, int key, int *count) {
    double *numbers = s->values[key].numbers;
    *count = s->values[key].count;
    s->values[key].numbers = NULL;
    return numbers;
}

/* Exactly one of two keys; 1 when so. */
static int require_one(draft *d, const section *s, int a, int b) {
    const key_def *keys = s->def->keys;
    if (draft_has(s, a) != draft_has(s, b))
        return 1;
    if (draft_has(s, a)) {
        int later = s->values[a].line > s->values[b].line ? a : b, first = a + b - later;
        draft_error(d, s->values[later].line, s->name, keys[later].name, s->values[later].text,
                    "%s is given too, on line %d; must be either %s or %s", keys[first].name,
                    s->values[first].line, keys[a].name, keys[b].name);
        return 0;
    }
    char range_a[160], range_b[160];
    key_range(&keys[a], range_a, sizeof range_a);
    key_range(&keys[b], range_b, sizeof range_b);
    draft_error(d, s->line, s->name, NULL, NULL, "missing; must have %s (%s) or %s (%s)",
                keys[a].name, range_a, keys[b].name, range_b);
    return 0;
}

/* Of two keys that say the same the one given. */
static int given(const section *s, int a, int b) {
    return draft_has(s, a) ? a : b;
}

/* Something must hold the front back. */
static void check_front(draft *d, const section *s) {
    int mu = given(s, MATERIAL_MU, MATERIAL_MU_PRIME),
        K = given(s, MATERIAL_K_IC, MATERIAL_K_PRIME);
    if (!d->error_count && s->values[mu].number == 0 && s->values[K].number == 0)
        draft_range_error(d, s, mu, "> 0 where %s = 0 (line %d): nothing holds the front",
                          s->def->keys[K].name, s->values[K].line);
}

static void check_material(draft *d, const section *s) {
    require_one(d, s, MATERIAL_E, MATERIAL_E_PRIME);
    require_one(d, s, MATERIAL_MU, MATERIAL_MU_PRIME);
    require_one(d, s, MATERIAL_K_IC, MATERIAL_K_PRIME);
    require_one(d, s, MATERIAL_C_L, MATERIAL_C_PRIME);
    if (draft_has(s, MATERIAL_E))
        draft_require(d, s, MATERIAL_NU);
    else if (draft_has(s, MATERIAL_NU) && draft_has(s, MATERIAL_E_PRIME))
        draft_error(d, s->values[MATERIAL_NU].line, s->name, "nu", s->values[MATERIAL_NU].text,
                    "must be given with E only; E_prime contains it");
    check_front(d, s);
}

/* A scaled value may be beyond what the library takes though the one it is made of is not. */
static void check_scaled(draft *d, const section *s, int plain, int scaled, double value,
                         double least) {
    int key = given(s, plain, scaled);
    if (value == 0 || (value >= least && value <= MAGNITUDE_MOST))
        return;
    if (key == scaled)
        draft_range_error(d, s, key, "in %g .. %g", least, MAGNITUDE_MOST);
    else
        draft_error(d, s->values[key].line, s->name, s->def->keys[key].name, s->values[key].text,
                    "%s is %.10g; must be in %g .. %g", s->def->keys[scaled].name, value, least,
                    MAGNITUDE_MOST);
}

/* Finite values of a rock may still be out of range once scaled. */
static void take_material(draft *d, scene *sc, const section *s) {
    ilsa_rock rock = {.E = number_or(s, MATERIAL_E, 1),
                      .nu = number_or(s, MATERIAL_NU, 0),
                      .mu = number_or(s, MATERIAL_MU, 1),
                      .K_Ic = number_or(s, MATERIAL_K_IC, 0),
                      .C_L = number_or(s, MATERIAL_C_L, 0)};
    ilsa_material_def *m = &sc->material;
    if (ilsa_material_def_from_rock(&rock, m)) {
        draft_error(d, s->line, s->name, NULL, NULL, "%s", ilsa_last_error(NULL));
        return;
    }
    m->E_prime = number_or(s, MATERIAL_E_PRIME, m->E_prime);
    m->mu_prime = number_or(s, MATERIAL_MU_PRIME, m->mu_prime);
    m->K_prime = number_or(s, MATERIAL_K_PRIME, m->K_prime);
    m->C_prime = number_or(s, MATERIAL_C_PRIME, m->C_prime);
    check_scaled(d, s, MATERIAL_E, MATERIAL_E_PRIME, m->E_prime, MAGNITUDE_LEAST);
    check_scaled(d, s, MATERIAL_MU, MATERIAL_MU_PRIME, m->mu_prime, MAGNITUDE_LEAST);
    check_scaled(d, s, MATERIAL_K_IC, MATERIAL_K_PRIME, m->K_prime, 0);
    check_scaled(d, s, MATERIAL_C_L, MATERIAL_C_PRIME, m->C_prime, 0);
    sc->laboratory = draft_has(s, MATERIAL_E);
}

static void check_mesh(draft *d, const section *s) {
    int complete =
        draft_require(d, s, MESH_NX) & draft_require(d, s, MESH_NY) & draft_require(d, s, MESH_DX);
    if (!complete || d->error_count)
        return;
    double dx = s->values[MESH_DX].number, dy = number_or(s, MESH_DY, dx);
    if (dy < 1e-3 * dx || dy > 1e3 * dx)
        draft_range_error(d, s, MESH_DY, "in %.10g .. %.10g, dx / 1000 .. 1000 dx", 1e-3 * dx,
                          1e3 * dx);
    double most = 268435456.0, nx = s->values[MESH_NX].number;
    if (nx * s->values[MESH_NY].number > most)
        draft_range_error(d, s, MESH_NY, "in 3 .. %.0f with this nx: 2^28 cells in all",
                          fmin(1e6, floor(most / nx)));
}

static void take_mesh(scene *sc, const section *s) {
    sc->mesh = ilsa_mesh_def_default();
    sc->mesh.nx = (int)s->values[MESH_NX].number;
    sc->mesh.ny = (int)s->values[MESH_NY].number;
    sc->mesh.dx = s->values[MESH_DX].number;
    sc->mesh.dy = number_or(s, MESH_DY, sc->mesh.dx);
}

/* The place of the first value of a list that is not above the one before it; 0: there is none. */
static int first_fall(const key_value *list) {
    for (int i = 1; i < list->count; i++)
        if (list->numbers[i] <= list->numbers[i - 1])
            return i;
    return 0;
}

/* What a list must be that does not rise; names the two values. */
static void fall_error(draft *d, const section *s, int key, const char *range) {
    const key_value *list = &s->values[key];
    int i = first_fall(list);
    double before = list->numbers[i - 1], after = list->numbers[i];
    if (before == after)
        draft_error(d, list->line, s->name, s->def->keys[key].name, list->text,
                    "values %d and %d are both %.15g; must be %s", i, i + 1, after, range);
    else
        draft_error(d, list->line, s->name, s->def->keys[key].name, list->text,
                    "value %d, %.15g, is below value %d, %.15g; must be %s", i + 1, after, i,
                    before, range);
}

static void check_log(draft *d, const section *s) {
    const key_value *interfaces = &s->values[STRESS_INTERFACES];
    const key_value *depth = &s->values[STRESS_ORIGIN_DEPTH];
    if (draft_has(s, STRESS_PROFILE) && interfaces->line)
        draft_error(d, interfaces->line, s->name, "interfaces", interfaces->text,
                    "profile is given too, on line %d; must be either interfaces or profile",
                    s->values[STRESS_PROFILE].line);
    if (!draft_has(s, STRESS_PROFILE) && depth->line)
        draft_error(d, depth->line, s->name, "origin_depth", depth->text,
                    "must be given with profile only");
}

static void check_stress(draft *d, const section *s) {
    const key_value *interfaces = &s->values[STRESS_INTERFACES];
    int count = s->values[STRESS_SIGMA].count;
    require_one(d, s, STRESS_SIGMA, STRESS_PROFILE);
    check_log(d, s);
    if (d->error_count || draft_has(s, STRESS_PROFILE))
        return;
    if (first_fall(interfaces))
        fall_error(d, s, STRESS_INTERFACES, "rising, from the bottom interface up");
    if (count == interfaces->count + 1)
        return;
    if (interfaces->count)
        draft_range_error(d, s, STRESS_SIGMA, "%d values, one more than interfaces, not %d",
                          interfaces->count + 1, count);
    else
        draft_range_error(d, s, STRESS_SIGMA, "one value, or interfaces must be given");
}

static void take_stress(draft *d, scene *sc, section *s) {
    int layers;
    if (draft_has(s, STRESS_PROFILE)) {
        sc->log.file = strdup(s->values[STRESS_PROFILE].text);
        sc->log.has_origin_depth = draft_has(s, STRESS_ORIGIN_DEPTH);
        sc->log.origin_depth = number_or(s, STRESS_ORIGIN_DEPTH, 0);
        if (!sc->log.file)
            draft_error(d, 0, NULL, NULL, NULL, "out of memory");
        return;
    }
    sc->sigma = take_numbers(s, STRESS_SIGMA, &layers);
    sc->interfaces = take_numbers(s, STRESS_INTERFACES, &sc->interface_count);
}

static void check_place(draft *d, const section *s, int key, double half) {
    if (fabs(number_or(s, key, 0)) >= half)
        draft_range_error(d, s, key, "inside the mesh, in %.10g .. %.10g", -half, half);
}

static void check_injection(draft *d, const section *s, const section *mesh) {
    require_one(d, s, INJECTION_RATE, INJECTION_SCHEDULE);
    if (d->error_count)
        return;
    double dx = mesh->values[MESH_DX].number;
    const key_value *rate = &s->values[INJECTION_RATE], *schedule = &s->values[INJECTION_SCHEDULE];
    double first = rate->line ? rate->number : schedule->numbers[1];
    if (strcmp(s->name, "injection") == 0 && first == 0)
        draft_range_error(d, s, rate->line ? INJECTION_RATE : INJECTION_SCHEDULE,
                          "> 0 at first: this source made the initial fracture");
    check_place(d, s, INJECTION_X, 0.5 * mesh->values[MESH_NX].number * dx);
    check_place(d, s, INJECTION_Y,
                0.5 * mesh->values[MESH_NY].number * number_or(mesh, MESH_DY, dx));
}

const char *scene_source_name(char *name, int source) {
    snprintf(name, SOURCE_NAME_SIZE, source > 0 ? "injection.%d" : "injection", source + 1);
    return name;
}

/* The section of source i = 0, 1, ..., or NULL. */
static section *injection(const draft *d, int i) {
    char name[SOURCE_NAME_SIZE];
    return draft_section(d, scene_source_name(name, i));
}

static int take_source(scene_source *source, const section *s) {
    int scheduled = draft_has(s, INJECTION_SCHEDULE);
    const key_value *value = &s->values[scheduled ? INJECTION_SCHEDULE : INJECTION_RATE];
    source->x = number_or(s, INJECTION_X, 0);
    source->y = number_or(s, INJECTION_Y, 0);
    source->line = value->line;
    source->count = scheduled ? value->count : 1;
    source->times = calloc((size_t)source->count, sizeof(double));
    source->rates = calloc((size_t)source->count, sizeof(double));
    if (!source->times || !source->rates)
        return 0;
    source->rates[0] = value->number;
    const double *pair = value->numbers;
    for (int i = 0; i < source->count && scheduled; i++, pair += 2) {
        source->times[i] = pair[0];
        source->rates[i] = pair[1];
    }
    return 1;
}

static void take_sources(draft *d, scene *sc) {
    int count = 1; /* [injection] is there */
    while (injection(d, count))
        count++;
    sc->sources = calloc((size_t)count, sizeof *sc->sources);
    if (!sc->sources) {
        draft_error(d, 0, NULL, NULL, NULL, "out of memory");
        return;
    }
    sc->source_count = count;
    for (int i = 0; i < count; i++)
        if (!take_source(&sc->sources[i], injection(d, i)))
            draft_error(d, 0, NULL, NULL, NULL, "out of memory");
}

static void check_injections(draft *d, const section *mesh) {
    int count = 0;
    while (injection(d, count))
        check_injection(d, injection(d, count++), mesh);
    for (int i = 0; i < d->count; i++) {
        const section *s = &d->sections[i];
        if (s->number > count)
            draft_error(d, s->line, s->name, NULL, NULL,
                        "the sources must be numbered without a gap; injection.%d is missing",
                        count + 1);
    }
}

/* The largest radius around the first source along one axis: the library keeps off the edge. */
static double reach(int n, double size, double at) {
    return 0.5 * (n - 3) * size - fabs(at);
}

static void check_initial(draft *d, const section *s, const scene *sc) {
    if (!require_one(d, s, INITIAL_RADIUS, INITIAL_TIME) || d->error_count ||
        !draft_has(s, INITIAL_RADIUS))
        return;
    const ilsa_mesh_def *m = &sc->mesh;
    double least = 2 * fmax(m->dx, m->dy);
    double most =
        fmin(reach(m->nx, m->dx, sc->sources[0].x), reach(m->ny, m->dy, sc->sources[0].y));
    double radius = s->values[INITIAL_RADIUS].number;
    if (radius >= least && radius < most)
        return;
    if (least < most)
        draft_range_error(d, s, INITIAL_RADIUS,
                          "at least %.10g, 2 cells, and under %.10g: inside the mesh", least, most);
    else
        draft_error(d, s->values[INITIAL_RADIUS].line, s->name, "radius",
                    s->values[INITIAL_RADIUS].text,
                    "must be at least %.10g, 2 cells, for which the mesh is too small around the "
                    "source",
                    least);
}

static void check_run(draft *d, const section *s) {
    const key_value *times = &s->values[RUN_OUTPUT_TIMES];
    if (!draft_require(d, s, RUN_T_END) || d->error_count)
        return;
    double t_end = s->values[RUN_T_END].number;
    if (first_fall(times))
        fall_error(d, s, RUN_OUTPUT_TIMES, "rising");
    else if (times->count && times->numbers[times->count - 1] > t_end)
        draft_range_error(d, s, RUN_OUTPUT_TIMES, "at most t_end = %.10g", t_end);
}

/* A front that only toughness rules needs some. */
static void check_tip(draft *d, const section *s, const scene *sc) {
    if (!d->error_count && sc->options.tip == ILSA_TIP_TOUGHNESS && sc->material.K_prime == 0)
        draft_range_error(d, s, RUN_tip, "full or toughness-viscosity where the toughness is 0");
}

/* The options that the library's table has for a scene file; 0 where the file does not say. A
 * choice goes through a type that every enum holds, signed or not. */
static void take_options(ilsa_solver_def *options, section *const *s) {
    *options = (ilsa_solver_def){0};
#define OPTION_WHOLE(value)  (int)(value)
#define OPTION_CHOICE(value) (unsigned char)(value)
#define OPTION_NUMBER(value) (value)
#define OPTION_OF_MESH(member, kind)                                                               \
    options->member = OPTION_##kind(number_or(s[SECTION_MESH], MESH_##member, 0));
#define OPTION_OF_RUN(member, kind)                                                                \
    options->member = OPTION_##kind(number_or(s[SECTION_RUN], RUN_##member, 0));
#define OPTION_OF_NONE(member, kind)
#define ILSA_OPTION(member, kind, least, most, kept, section, ...) OPTION_OF_##section(member, kind)
#include <ilsa/options.def>
#undef ILSA_OPTION
}

static void take_run(draft *d, scene *sc, section *s) {
    sc->t_end = s->values[RUN_T_END].number;
    sc->dt_initial = number_or(s, RUN_DT_INITIAL, 0);
    sc->output_times = take_numbers(s, RUN_OUTPUT_TIMES, &sc->output_count);
    if (sc->output_times)
        return;
    sc->output_times = malloc(sizeof *sc->output_times);
    if (!sc->output_times) {
        draft_error(d, 0, NULL, NULL, NULL, "out of memory");
        return;
    }
    sc->output_times[0] = sc->t_end;
    sc->output_count = 1;
}

static void take_lines(scene *sc, section *const *s) {
    for (int i = 0; i < SECTION_COUNT; i++) {
        sc->headings[i] = s[i]->line;
        for (int k = 0; k < KEYS_MAX; k++)
            sc->lines[i][k] = s[i]->values[k].line;
    }
}

/* Checks that look at several keys come after those of single values, whose errors they'd repeat.
 */
static void build(draft *d, scene *sc) {
    section *s[SECTION_COUNT];
    for (int i = 0; i < SECTION_COUNT; i++) {
        s[i] = draft_section(d, sections[i].name);
        if (!s[i])
            draft_error(d, d->file.lines, sections[i].name, NULL, NULL, "missing section");
    }
    if (d->error_count)
        return;
    check_material(d, s[SECTION_MATERIAL]);
    check_mesh(d, s[SECTION_MESH]);
    check_stress(d, s[SECTION_STRESS]);
    check_injections(d, s[SECTION_MESH]);
    check_run(d, s[SECTION_RUN]);
    if (!d->error_count) {
        take_material(d, sc, s[SECTION_MATERIAL]);
        take_mesh(sc, s[SECTION_MESH]);
        take_options(&sc->options, s);
        take_stress(d, sc, s[SECTION_STRESS]);
        take_sources(d, sc);
        take_run(d, sc, s[SECTION_RUN]);
    }
    check_tip(d, s[SECTION_RUN], sc);
    check_initial(d, s[SECTION_INITIAL], sc);
    sc->radius = number_or(s[SECTION_INITIAL], INITIAL_RADIUS, 0);
    sc->time = number_or(s[SECTION_INITIAL], INITIAL_TIME, 0);
    take_lines(sc, s);
}

int scene_read(const char *path, scene *sc, FILE *errors) {
    draft d;
    memset(sc, 0, sizeof *sc);
    sc->path = path;
    draft_read(&d, path, errors);
    if (!d.error_count)
        build(&d, sc);
    int good = d.error_count == 0;
    draft_free(&d);
    if (!good)
        scene_free(sc);
    return good;
}

void scene_error(const scene *sc, FILE *errors, int part, int key, const char *format, ...) {
    const key_def *def = &sections[part].keys[key];
    int line = sc->lines[part][key];
    va_list arguments;
    fprintf(errors, "%s:%d: [%s] %s", sc->path, line ? line : sc->headings[part],
            sections[part].name, def->name);
    va_start(arguments, format);
    vfprintf(errors, format, arguments);
    va_end(arguments);
    fputc('\n', errors);
}

/* The first step and every step must be felt by a clock that shows up to t. */
static int moves_clock(const scene *sc, FILE *errors, int key, double dt, double t) {
    if (dt == 0 || t + dt > t)
        return 1;
    scene_error(sc, errors, SECTION_RUN, key, " = %.10g: too small to move the clock on from %.10g",
                dt, t);
    return 0;
}

int scene_check_start(const scene *sc, double t_start, FILE *errors) {
    const scene_source *first = &sc->sources[0];
    const char *after = "must be after the initial fracture's own time";
    int good = 1;
    if (sc->t_end <= t_start) {
        scene_error(sc, errors, SECTION_RUN, RUN_T_END, ": %s, > %.10g", after, t_start);
        good = 0;
    } else if (sc->output_times[0] <= t_start) {
        scene_error(sc, errors, SECTION_RUN, RUN_OUTPUT_TIMES, ": %s, > %.10g", after, t_start);
        good = 0;
    }
    if (first->count > 1 && first->times[1] <= t_start) {
        scene_error(sc, errors, SECTION_INJECTION, INJECTION_SCHEDULE, ": the second t %s, > %.10g",
                    after, t_start);
        good = 0;
    }
    return good & moves_clock(sc, errors, RUN_DT_INITIAL, sc->dt_initial, t_start) &
           moves_clock(sc, errors, RUN_dt_max, sc->options.dt_max, sc->t_end);
}

void scene_free(scene *sc) {
    for (int i = 0; i < sc->source_count; i++) {
        free(sc->sources[i].times);
        free(sc->sources[i].rates);
    }
    free(sc->sources);
    free(sc->interfaces);
    free(sc->sigma);
    free(sc->log.file);
    free(sc->output_times);
    memset(sc, 0, sizeof *sc);
}

double scene_rate(const scene_source *source, double t) {
    int i = 0;
    while (i + 1 < source->count && source->times[i + 1] <= t)
        i++;
    return source->rates[i];
}

double scene_next_change(const scene *sc, double t) {
    double next = INFINITY;
    for (int i = 0; i < sc->source_count; i++)
        for (int k = 0; k < sc->sources[i].count; k++)
            if (sc->sources[i].times[k] > t)
                next = fmin(next, sc->sources[i].times[k]);
    return next;
}
