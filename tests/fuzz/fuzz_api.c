/*
 * Calls of the library in any order with any values. The meshes that are stepped are small; sizes
 * and counts that must be refused are as large as they come. After every call: the status is one of
 * those in status.h, a failure has a message of its own and has changed nothing, and what a solver
 * holds is finite, has no negative width and accounts for every litre.
 */
#include "fuzz.h"
#include <ilsa/ilsa.h>

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What one input may cost. */
enum { SLOTS = 2, NONE = SLOTS, CALLS = 40, STEPS = 12, CELLS_MAX = 15 * 15, SOURCES_MAX = 3 };

typedef struct image {
    unsigned char *bytes; /* NULL: none */
    size_t size;
} image;

typedef struct world {
    fuzz_input in;
    ilsa_mesh *mesh[SLOTS + 1];
    ilsa_material *material[SLOTS + 1];
    ilsa_stress *stress[SLOTS + 1];
    ilsa_solver *solver[SLOTS + 1];
    image image[SLOTS];
    int steps;                  /* tried so far */
    double length, time, force; /* units in which the numbers below are ordinary */
} world;

/* Checks of one call */

/* Leaves messages that no call below can give, so that a stale one is seen. */
static void mark(ilsa_solver *s) {
    const ilsa_material_def marked = {-12345, 1, 1, 1};
    ilsa_material *none;
    FUZZ_EXPECT(ilsa_material_create(&marked, &none) == ILSA_ERR_VALUE && !none);
    FUZZ_EXPECT(!s || ilsa_set_rate(s, INT_MIN, 0) == ILSA_ERR_VALUE);
}

static void check_status(ilsa_status status, const ilsa_solver *keeper) {
    const char *text = ilsa_status_text(status), *message = ilsa_last_error(keeper);
    FUZZ_EXPECT(status >= ILSA_ERR_NUMERIC && status <= ILSA_NO_SPACE && *text);
    if (status != ILSA_OK)
        FUZZ_EXPECT(*message && !strstr(message, "-12345") && !strstr(message, "-2147483648"));
}

static image take_image(const ilsa_solver *s) {
    image i = {NULL, 0};
    ilsa_status status = s ? ilsa_snapshot_save(s, NULL, &i.size) : ILSA_ERR_STATE;
    if (status == ILSA_OK) {
        i.bytes = malloc(i.size);
        FUZZ_EXPECT(i.bytes && ilsa_snapshot_save(s, i.bytes, &i.size) == ILSA_OK);
    } else {
        FUZZ_EXPECT(status == ILSA_ERR_STATE);
    }
    return i;
}

static int same_image(const image *a, const image *b) {
    if (!a->bytes || !b->bytes)
        return a->bytes == b->bytes;
    return a->size == b->size && memcmp(a->bytes, b->bytes, a->size) == 0;
}

static void check_same(const ilsa_solver *s, const image *expected) {
    image now = take_image(s);
    FUZZ_EXPECT(same_image(&now, expected));
    free(now.bytes);
}

static int is_finite_and_positive(double x) {
    return x >= 0 && isfinite(x);
}

static void check_fields(const ilsa_solver *s, const ilsa_summary *sum) {
    ilsa_mesh_def mesh;
    const double *width, *pressure, *stress, *trigger;
    const unsigned char *kind;
    double volume = 0;
    FUZZ_EXPECT(!ilsa_get_mesh_def(s, &mesh) && !ilsa_get_width(s, &width));
    FUZZ_EXPECT(!ilsa_get_pressure(s, &pressure) && !ilsa_get_stress(s, &stress));
    FUZZ_EXPECT(!ilsa_get_trigger_time(s, &trigger) && !ilsa_get_cell_kinds(s, &kind));
    for (int k = 0; k < mesh.nx * mesh.ny; k++) {
        FUZZ_EXPECT(kind[k] <= ILSA_CELL_CLOSED && isfinite(stress[k]));
        FUZZ_EXPECT(is_finite_and_positive(width[k]) && isfinite(pressure[k]));
        FUZZ_EXPECT(kind[k] || (width[k] == 0 && pressure[k] == 0));
        FUZZ_EXPECT(!trigger || !isnan(trigger[k]));
        volume += width[k] * mesh.dx * mesh.dy;
    }
    FUZZ_EXPECT(fabs(volume - sum->volume_fracture) <= 1e-9 * sum->volume_fracture);
}

static void check_summary(const ilsa_summary *s) {
    double lost = s->volume_injected - s->volume_fracture - s->volume_leaked;
    FUZZ_EXPECT(is_finite_and_positive(s->time) && is_finite_and_positive(s->V_max));
    FUZZ_EXPECT(isfinite(s->x_max - s->x_min) && isfinite(s->y_max - s->y_min));
    FUZZ_EXPECT(s->extent_x_max >= s->extent_x_min && s->extent_y_max >= s->extent_y_min);
    FUZZ_EXPECT(is_finite_and_positive(s->volume_fracture));
    FUZZ_EXPECT(is_finite_and_positive(s->volume_leaked));
    FUZZ_EXPECT(fabs(lost) <= 1e-9 * s->volume_injected);
    FUZZ_EXPECT(s->efficiency >= 0 && s->efficiency <= 1 + 1e-9);
}

static void check_regime(const ilsa_tip_regime *r) {
    FUZZ_EXPECT(r->N_k >= 0 && r->N_mt >= 0 && r->N_m >= 0);
    FUZZ_EXPECT(fabs(r->N_k + r->N_mt + r->N_m - 1) <= 1e-9);
}

static void check_front(ilsa_solver *s) {
    const ilsa_front_point *front;
    const ilsa_survey_point *survey;
    size_t points, cells;
    FUZZ_EXPECT(!ilsa_get_front(s, &front, &points) && points > 0);
    for (size_t k = 0; k < points; k++) {
        FUZZ_EXPECT(isfinite(front[k].x) && isfinite(front[k].y));
        FUZZ_EXPECT(is_finite_and_positive(front[k].V) && front[k].loop >= 0);
        check_regime(&front[k].regime);
    }
    FUZZ_EXPECT(!ilsa_get_survey(s, &survey, &cells) && cells > 0);
    for (size_t k = 0; k < cells; k++) {
        FUZZ_EXPECT(is_finite_and_positive(survey[k].s) && is_finite_and_positive(survey[k].V));
        FUZZ_EXPECT(is_finite_and_positive(survey[k].w));
        check_regime(&survey[k].regime);
    }
}

static void check_solver(ilsa_solver *s) {
    ilsa_summary sum;
    ilsa_model model;
    ilsa_profile profile;
    double dt, t;
    FUZZ_EXPECT(!ilsa_get_summary(s, &sum) && !ilsa_get_model(s, &model));
    FUZZ_EXPECT(!ilsa_get_profile(s, &profile));
    FUZZ_EXPECT(!ilsa_suggest_dt(s, &dt) && dt > 0 && isfinite(dt));
    FUZZ_EXPECT(!ilsa_get_time(s, &t) && t == sum.time);
    check_summary(&sum);
    check_fields(s, &sum);
    check_front(s);
}

/* After a call on a solver that was as before shows; a refused one may have changed it only where
 * it says so. */
static ilsa_status check_call(ilsa_status status, ilsa_solver *s, image *before, int may_change) {
    check_status(status, s);
    image after = take_image(s);
    if (status != ILSA_OK && !may_change)
        FUZZ_EXPECT(same_image(before, &after));
    if (after.bytes) {
        check_solver(s);
        FUZZ_EXPECT(!ilsa_snapshot_restore(s, after.bytes, after.size));
        check_same(s, &after);
    }
    free(after.bytes);
    free(before->bytes);
    return status;
}

/* Values */

/* As a rule one that a fracture can be made with. */
static double some_number(fuzz_input *in, double low, double high) {
    return fuzz_choice(in, 8) == 7 ? fuzz_odd(in) : fuzz_between(in, low, high);
}

static int some_count(fuzz_input *in, int low, int high) {
    static const int odd[] = {0,       -1,      1,       2,       1 << 16,
                              1 << 28, 1000000, 1000001, INT_MAX, INT_MIN + 1};
    int odd_one = fuzz_choice(in, 8) == 7;
    return odd_one ? odd[fuzz_choice(in, (int)(sizeof odd / sizeof *odd))]
                   : low + fuzz_choice(in, high - low + 1);
}

/* One of the slots, now and then that of none, which stays empty. */
static int choose(fuzz_input *in) {
    int choice = fuzz_choice(in, 8 * SLOTS + 1);
    return choice == 8 * SLOTS ? NONE : choice % SLOTS;
}

/* Up to where products of a few quantities leave the double range. */
static void set_units(world *w) {
    static const double unit[] = {1, 1e-12, 1e12, 1e-50, 1e50, 1e-100, 1e100, 1e-140};
    w->length = unit[fuzz_choice(&w->in, 8)];
    w->time = unit[fuzz_choice(&w->in, 8)];
    w->force = unit[fuzz_choice(&w->in, 8)];
}

static double stress_unit(const world *w) {
    return w->force / w->length / w->length;
}

static double rate_unit(const world *w) {
    return w->length * w->length * w->length / w->time;
}

static double some_stress(world *w) {
    return some_number(&w->in, 1e-3, 1e3) * stress_unit(w);
}

/* Meshes, materials, stresses */

static int cells_of(const ilsa_mesh *mesh) {
    ilsa_mesh_def def = {0, 0, 0, 0};
    return mesh && !ilsa_mesh_get_def(mesh, &def) && def.nx <= CELLS_MAX / def.ny ? def.nx * def.ny
                                                                                  : 0;
}

static void make_mesh(world *w) {
    int at = choose(&w->in);
    ilsa_mesh **mesh = at == NONE ? NULL : &w->mesh[at];
    ilsa_mesh_def def = {some_count(&w->in, 7, 15), some_count(&w->in, 7, 15),
                         some_number(&w->in, 0.1, 10) * w->length,
                         some_number(&w->in, 0.1, 10) * w->length};
    if (fuzz_choice(&w->in, 4) < 3)
        def.dy = def.dx;
    if (mesh)
        ilsa_mesh_destroy(mesh);
    check_status(ilsa_mesh_create(fuzz_choice(&w->in, 16) == 15 ? NULL : &def, mesh), NULL);
}

static void make_material(world *w) {
    int at = choose(&w->in);
    ilsa_material **material = at == NONE ? NULL : &w->material[at];
    fuzz_input *in = &w->in;
    ilsa_material_def def = {some_number(in, 1e-2, 1e2) * stress_unit(w),
                             some_number(in, 1e-2, 1e2) * stress_unit(w) * w->time,
                             some_number(in, 1e-2, 1e2) * stress_unit(w) * sqrt(w->length),
                             some_number(in, 1e-2, 1e2) * w->length / sqrt(w->time)};
    if (fuzz_choice(in, 4) == 3) {
        ilsa_rock rock = {some_number(in, 1e8, 1e11), some_number(in, 0.01, 0.5),
                          some_number(in, 1e-4, 1), some_number(in, 1e4, 1e7),
                          some_number(in, 1e-8, 1e-3)};
        check_status(ilsa_material_def_from_rock(&rock, &def), NULL);
    }
    if (fuzz_choice(in, 4) == 3)
        def.K_prime = 0;
    if (fuzz_choice(in, 4) == 3)
        def.C_prime = 0;
    if (material)
        ilsa_material_destroy(material);
    check_status(ilsa_material_create(&def, material), NULL);
}

static void make_stress(world *w) {
    int at = choose(&w->in);
    ilsa_stress **stress = at == NONE ? NULL : &w->stress[at];
    ilsa_stress_def def = {some_stress(w)};
    if (stress)
        ilsa_stress_destroy(stress);
    check_status(ilsa_stress_create(&def, stress), NULL);
}

static void set_uniform(world *w) {
    ilsa_stress *stress = w->stress[choose(&w->in)];
    check_status(ilsa_stress_set_uniform(stress, some_stress(w)), NULL);
}

static void set_layers(world *w) {
    enum { MOST = 4 };
    ilsa_stress *stress = w->stress[choose(&w->in)];
    double y[MOST], sigma[MOST + 1];
    int count = fuzz_choice(&w->in, MOST + 2) - 1;
    for (int k = 0; k < MOST; k++)
        y[k] = (some_number(&w->in, 0.1, 10) - 5) * w->length;
    for (int k = 0; k <= MOST; k++)
        sigma[k] = some_stress(w);
    check_status(ilsa_stress_set_layers(stress, count, y, sigma), NULL);
}

static void set_cells(world *w) {
    ilsa_stress *stress = w->stress[choose(&w->in)];
    const ilsa_mesh *mesh = w->mesh[choose(&w->in)];
    double sigma[CELLS_MAX];
    double first = some_stress(w), other = some_stress(w);
    unsigned every = 1 + fuzz_byte(&w->in);
    if (mesh && cells_of(mesh) == 0)
        return;
    for (unsigned k = 0; k < CELLS_MAX; k++)
        sigma[k] = k % every != 0 ? first : other;
    check_status(ilsa_stress_set_cells(stress, mesh, sigma), NULL);
}

/* Every kind of handle, twice. */
static void destroy(world *w) {
    int at = choose(&w->in), none = at == NONE;
    unsigned which = fuzz_byte(&w->in);
    for (int times = 0; times < 2; times++) {
        if (which & 1)
            ilsa_mesh_destroy(none ? NULL : &w->mesh[at]);
        if (which & 2)
            ilsa_material_destroy(none ? NULL : &w->material[at]);
        if (which & 4)
            ilsa_stress_destroy(none ? NULL : &w->stress[at]);
        if (which & 8)
            ilsa_solver_destroy(none ? NULL : &w->solver[at]);
    }
    FUZZ_EXPECT(!(which & 8) || !w->solver[at]);
}

/* Solvers */

static ilsa_solver_def some_options(fuzz_input *in) {
    ilsa_solver_def def = ilsa_solver_def_default();
    int odd = fuzz_choice(in, 8) == 7;
    def.level = some_count(in, 1, 5);
    def.tip = (ilsa_tip_model)(odd ? fuzz_choice(in, 5) - 1 : fuzz_choice(in, 3));
    def.symmetry = (ilsa_symmetry)(odd ? fuzz_choice(in, 7) - 1 : fuzz_choice(in, 2));
    def.loop = (ilsa_front_loop)(odd ? fuzz_choice(in, 4) - 1 : fuzz_choice(in, 2));
    def.linear = (ilsa_linear_solver)(odd ? fuzz_choice(in, 5) - 1 : fuzz_choice(in, 3));
    def.product = (ilsa_product)(odd ? fuzz_choice(in, 5) - 1 : fuzz_choice(in, 2) * 2);
    def.coarsen = odd ? some_count(in, 0, 1) : fuzz_choice(in, 2);
    def.cells_max = odd ? some_count(in, 0, 2000) : 2000;
    def.threads = odd ? some_count(in, 0, 3) : fuzz_choice(in, 8) == 7 ? 2 : 0;
    def.step_cells = odd ? some_number(in, 0.01, 1) : 0;
    def.tolerance = odd ? some_number(in, 1e-6, 0.1) : 0;
    def.dt_max = odd ? some_number(in, 1e-3, 1e3) : 0;
    if (def.threads > 4)
        def.threads = INT_MAX; /* no more threads than that are made */
    return def;
}

static void make_solver(world *w) {
    int at = choose(&w->in);
    ilsa_solver **solver = at == NONE ? NULL : &w->solver[at];
    const ilsa_mesh *mesh = w->mesh[choose(&w->in)];
    const ilsa_material *material = w->material[choose(&w->in)];
    const ilsa_stress *stress = w->stress[choose(&w->in)];
    ilsa_source_def sources[SOURCES_MAX];
    ilsa_solver_def def = some_options(&w->in);
    if (mesh && cells_of(mesh) == 0)
        return;
    def.mesh = mesh;
    def.material = material;
    def.stress = stress;
    def.sources = fuzz_choice(&w->in, 32) == 31 ? NULL : sources;
    def.source_count = 1 + (fuzz_choice(&w->in, 8) == 7) * fuzz_choice(&w->in, SOURCES_MAX);
    for (int k = 0; k < SOURCES_MAX; k++) {
        int away = k > 0 || fuzz_choice(&w->in, 4) == 3;
        sources[k].x = away ? some_number(&w->in, 0.1, 4) * w->length : 0;
        sources[k].y = away ? some_number(&w->in, 0.1, 4) * w->length : 0;
        sources[k].rate = some_number(&w->in, 1e-2, 1e2) * rate_unit(w);
    }
    if (fuzz_choice(&w->in, 32) == 31)
        def.source_count = fuzz_choice(&w->in, 2) ? INT_MAX : -fuzz_choice(&w->in, 2);
    if (solver)
        ilsa_solver_destroy(solver);
    mark(NULL);
    check_status(ilsa_solver_create(&def, solver), NULL);
}

static void start(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    ilsa_mesh_def mesh = {0, 0, 1, 1};
    image before = take_image(s);
    if (s)
        FUZZ_EXPECT(!ilsa_get_mesh_def(s, &mesh));
    mark(s);
    if (fuzz_choice(&w->in, 4) == 3)
        check_call(ilsa_start_radial_at(s, some_number(&w->in, 1e-2, 1e2) * w->time), s, &before,
                   0);
    else
        check_call(ilsa_start_radial(s, some_number(&w->in, 2, 5) * fmax(mesh.dx, mesh.dy)), s,
                   &before, 0);
}

static void set_rate(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    int source = some_count(&w->in, 0, 1);
    double rate = fuzz_choice(&w->in, 4) < 3 ? some_number(&w->in, 1e-3, 1e3) * rate_unit(w) : 0;
    image before = take_image(s);
    mark(s);
    check_call(ilsa_set_rate(s, source, rate), s, &before, 0);
}

static void set_stress(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    ilsa_stress *stress = w->stress[choose(&w->in)];
    image before = take_image(s);
    mark(s);
    check_call(ilsa_set_stress(s, stress), s, &before, 0);
}

/* A step or a limit of so many suggested ones. */
static double some_step(world *w, ilsa_solver *s) {
    double dt = 1;
    if (s && ilsa_suggest_dt(s, &dt) != ILSA_OK)
        dt = 1;
    return some_number(&w->in, 0.1, 10) * dt;
}

static int may_step(world *w, int count) {
    w->steps += count;
    return w->steps <= STEPS;
}

static void check_report(const ilsa_report *r) {
    FUZZ_EXPECT(r->steps >= 0 && r->rejected >= 0 && r->front_iterations >= 0);
    FUZZ_EXPECT(is_finite_and_positive(r->time) && is_finite_and_positive(r->dt));
    FUZZ_EXPECT(r->seconds >= 0 && is_finite_and_positive(r->front_advance));
}

static void step(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    ilsa_report report = {0};
    double dt = some_step(w, s);
    int reported = fuzz_choice(&w->in, 2);
    image before = take_image(s);
    mark(s);
    if (may_step(w, 1))
        check_call(ilsa_step(s, dt, reported ? &report : NULL), s, &before, 0);
    else
        free(before.bytes);
    check_report(&report);
}

static double time_of(const ilsa_solver *s) {
    double t;
    return s && ilsa_get_time(s, &t) == ILSA_OK ? t : 0;
}

static int coarsens(ilsa_solver *s, const image *before) {
    ilsa_mesh_def mesh = {0, 0, 0, 0};
    (void)before;
    return s && ilsa_get_mesh_def(s, &mesh) == ILSA_OK;
}

static void advance_one(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    ilsa_report report = {0};
    double limit = time_of(s) + some_step(w, s);
    image before = take_image(s);
    mark(s);
    if (may_step(w, 2)) {
        ilsa_status status = ilsa_advance_one(s, limit, &report);
        check_call(status, s, &before, coarsens(s, &before) && report.coarsened > 0);
        FUZZ_EXPECT(status != ILSA_OK || time_of(s) <= limit);
    } else {
        free(before.bytes);
    }
    check_report(&report);
}

/* The state that so many single steps at most lead to, if they come to end. */
static image by_single_steps(ilsa_solver *s, double end) {
    enum { MOST = 12 };
    ilsa_status status = ILSA_OK;
    for (int k = 0; k < MOST && status == ILSA_OK && time_of(s) < end; k++)
        status = ilsa_advance_one(s, end, NULL);
    return status == ILSA_OK && time_of(s) == end ? take_image(s) : (image){NULL, 0};
}

/* To a time some suggested steps away: what single steps reach is reached, bit for bit. */
static void advance(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    double end = time_of(s), dt = 1;
    if (s && ilsa_suggest_dt(s, &dt) != ILSA_OK)
        dt = 1;
    end += fuzz_choice(&w->in, 8) == 7 ? -dt : fuzz_between(&w->in, 0.1, 3) * dt;
    image before = take_image(s), expected = {NULL, 0};
    if (before.bytes && end > time_of(s) && may_step(w, 4)) {
        expected = by_single_steps(s, end);
        FUZZ_EXPECT(!ilsa_snapshot_restore(s, before.bytes, before.size));
    }
    mark(s);
    if (expected.bytes || !(end > time_of(s))) {
        check_call(ilsa_advance(s, end, NULL), s, &before, 0);
        if (expected.bytes)
            check_same(s, &expected);
    } else {
        free(before.bytes);
    }
    free(expected.bytes);
}

static void coarsen(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    image before = take_image(s);
    mark(s);
    int directions = fuzz_choice(&w->in, 6) - 1;
    check_call(directions < 0 ? ilsa_coarsen(s) : ilsa_coarsen_along(s, directions), s, &before, 0);
}

static void grow(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    int odd = fuzz_choice(&w->in, 8) == 7;
    int columns = odd ? some_count(&w->in, 0, 9) : fuzz_choice(&w->in, 4);
    int rows = odd ? some_count(&w->in, 0, 9) : fuzz_choice(&w->in, 4);
    image before = take_image(s);
    mark(s);
    check_call(ilsa_grow(s, columns, rows), s, &before, 0);
}

/* Reading what may not be there. */
static void read_solver(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    ilsa_mesh_def mesh;
    ilsa_summary summary;
    ilsa_model model;
    const double *field;
    const unsigned char *kind;
    double number;
    mark(s);
    check_status(ilsa_get_mesh_def(s, &mesh), NULL);
    check_status(ilsa_get_time(s, &number), NULL);
    check_status(ilsa_suggest_dt(s, &number), NULL);
    check_status(ilsa_get_width(s, &field), NULL);
    check_status(ilsa_get_pressure(s, fuzz_choice(&w->in, 2) ? &field : NULL), NULL);
    check_status(ilsa_get_stress(s, &field), NULL);
    check_status(ilsa_get_trigger_time(s, &field), NULL);
    check_status(ilsa_get_cell_kinds(s, &kind), NULL);
    check_status(ilsa_get_summary(s, &summary), NULL);
    check_status(ilsa_get_model(s, &model), NULL);
}

static void read_front(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    const ilsa_front_point *front;
    const ilsa_survey_point *survey;
    size_t count;
    mark(s);
    check_status(ilsa_get_front(s, fuzz_choice(&w->in, 8) ? &front : NULL, &count), s);
    mark(s);
    check_status(ilsa_get_survey(s, &survey, fuzz_choice(&w->in, 8) ? &count : NULL), s);
}

/* Snapshots */

static void save(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    image *to = &w->image[fuzz_choice(&w->in, SLOTS)];
    free(to->bytes);
    *to = take_image(s);
    if (!to->bytes)
        return;
    size_t room = fuzz_choice(&w->in, 4) == 0 ? SIZE_MAX : (size_t)fuzz_byte(&w->in) * 64;
    size_t needed = room;
    mark(s);
    if (room < to->size) {
        FUZZ_EXPECT(ilsa_snapshot_save(s, to->bytes, &needed) == ILSA_NO_SPACE);
        check_status(ILSA_NO_SPACE, NULL);
    } else {
        FUZZ_EXPECT(ilsa_snapshot_save(s, to->bytes, &needed) == ILSA_OK);
    }
    FUZZ_EXPECT(needed == to->size);
}

/* As it is, cut, said to be longer than it is, or altered; of this solver or of another. */
static void restore(world *w) {
    ilsa_solver *s = w->solver[choose(&w->in)];
    const image *from = &w->image[fuzz_choice(&w->in, SLOTS)];
    size_t size = from->size, at = fuzz_byte(&w->in) * (size_t)257;
    int how = fuzz_choice(&w->in, 8);
    if (how == 0 && size > 0)
        size = at % size;
    else if (how == 1)
        size = SIZE_MAX;
    image before = take_image(s);
    int altered = how == 2 && from->bytes;
    if (altered)
        from->bytes[at % from->size] ^= 1;
    mark(s);
    ilsa_status status = ilsa_snapshot_restore(s, from->bytes, size);
    FUZZ_EXPECT(status != ILSA_OK || (!altered && size == from->size));
    check_call(status, s, &before, 0);
    if (altered)
        from->bytes[at % from->size] ^= 1;
    image after = take_image(s);
    FUZZ_EXPECT(status != ILSA_OK || same_image(&after, from));
    free(after.bytes);
}

/* Tip functions */

static void tips(world *w) {
    fuzz_input *in = &w->in;
    ilsa_material_def law = {fuzz_odd(in), fuzz_odd(in), fuzz_odd(in), fuzz_odd(in)};
    double a = fuzz_odd(in), b = fuzz_odd(in), c = fuzz_odd(in), x = 1, y = 1;
    ilsa_tip_regime regime;
    double g = ilsa_tip_g_delta(a, b), p = ilsa_tip_delta_p(a, b, c);
    FUZZ_EXPECT(isnan(g) == !(is_finite_and_positive(a) && is_finite_and_positive(b)));
    FUZZ_EXPECT(isnan(g) || g >= 0);
    FUZZ_EXPECT(isnan(p) || (p >= 0 && p <= 1));
    if (ilsa_tip_width(&law, a, b, &x) == ILSA_OK)
        FUZZ_EXPECT(is_finite_and_positive(x));
    if (ilsa_tip_moments(&law, a, b, x, &x, &y) == ILSA_OK)
        FUZZ_EXPECT(is_finite_and_positive(x) && is_finite_and_positive(y));
    if (ilsa_tip_distance(&law, a, b, c, &x, &y) == ILSA_OK)
        FUZZ_EXPECT(x >= b && is_finite_and_positive(y));
    if (ilsa_tip_triangle(&law, a, b, c, &regime) == ILSA_OK)
        check_regime(&regime);
}

/* A fracture that can be stepped, more or less: without it few inputs come that far. */
static void begin(world *w) {
    if (fuzz_choice(&w->in, 4) == 3)
        set_units(w);
    make_mesh(w);
    make_material(w);
    make_stress(w);
    make_solver(w);
    start(w);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static void (*const calls[])(world *) = {
        make_mesh,   make_material, make_stress, set_uniform, set_layers,  set_cells,  destroy,
        make_solver, start,         set_rate,    set_stress,  step,        step,       step,
        advance_one, advance_one,   advance,     coarsen,     read_solver, read_front, save,
        restore,     restore,       tips,        begin,       grow};
    world w = {.in = {data, size}, .length = 1, .time = 1, .force = 1};
    begin(&w);
    for (int k = 0; k < CALLS && w.in.size > 0; k++)
        calls[fuzz_choice(&w.in, (int)(sizeof calls / sizeof *calls))](&w);
    for (int k = 0; k < SLOTS; k++) {
        ilsa_mesh_destroy(&w.mesh[k]);
        ilsa_material_destroy(&w.material[k]);
        ilsa_stress_destroy(&w.stress[k]);
        ilsa_solver_destroy(&w.solver[k]);
        free(w.image[k].bytes);
    }
    return 0;
}
