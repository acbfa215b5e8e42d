/*
 * Memory that fails, one request after the other, in every call that asks for any: a status and a
 * message, nothing changed, and the same bits as ever when the call is made again. That nothing
 * leaks is seen under AddressSanitizer and valgrind.
 */
#include "check.h"
#include "elastic/elasticity.h"
#include "failing.h"
#include "host.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- Scenes ------------------------------------------------------------------------------------
 */

/* Leak-off, layers, two sources, no symmetry, threads. */
static host_scene rich(void) {
    host_scene scene = host_three_layers(35, 35);
    scene.interface_y[0] = -6;
    scene.interface_y[1] = 7.3;
    scene.source[0].rate = 0.006;
    scene.source[1] = (ilsa_source_def){1.5, 0, 0.004};
    scene.source_count = 2;
    scene.options.threads = 2;
    return scene;
}

/* Leak-off, layers, a quarter of it solved, BLAS and LU. */
static host_scene dense(void) {
    host_scene scene = host_three_layers(35, 35);
    scene.options.product = ILSA_PRODUCT_BLAS;
    scene.options.linear = ILSA_LINEAR_DENSE;
    return scene;
}

/* No leak-off, uniform stress, GMRES; on a mesh that the second radius all but fills. */
static host_scene plain(void) {
    host_scene scene = host_penny(0, 31, 0.1);
    scene.options.linear = ILSA_LINEAR_GMRES;
    scene.options.coarsen = 1;
    return scene;
}

/* A stress for every cell; the plain loop, which asks for what the others do not. */
static host_scene nested(void) {
    static double cells[31 * 31];
    for (int k = 0; k < 31 * 31; k++)
        cells[k] = 0.01 * (k % 31);
    host_scene scene = host_penny(1e-2, 31, 0.1);
    scene.cells = cells;
    scene.options.loop = ILSA_LOOP_NESTED;
    scene.options.product = ILSA_PRODUCT_BLAS;
    scene.options.linear = ILSA_LINEAR_GMRES;
    scene.options.coarsen = 1;
    return scene;
}

typedef struct named_scene {
    const char *name;
    host_scene (*make)(void);
    double radius, wide; /* of a small fracture, and of one near the edge of the mesh */
} named_scene;

static const named_scene scenes[] = {
    {"rich", rich, 6, 13},
    {"dense", dense, 6, 13},
    {"nested", nested, 0.6, 1.3},
    {"plain", plain, 0.6, 1.3},
};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* ---- Every request of a call fails once ---------------------------------------------------------
 */

/* A call, and what it gives besides the state as one number. */
typedef ilsa_status action(ilsa_solver *solver, const void *context, double *answer);

/* What is tried: the call on a solver of the scene in a given state, NULL: without a fracture. */
typedef struct trial {
    const char *name;
    const host_scene *scene;
    const host_image *before;
    action *call;
    const void *context;
    int keeps_steps; /* steps that were accepted before memory failed stay */
} trial;

static ilsa_solver *ready(const trial *t) {
    ilsa_solver *solver = host_solver(t->scene);
    if (t->before)
        host_restore(solver, t->before);
    return solver;
}

/* What the call leaves when all goes well. */
static host_image expected(const trial *t, double *answer) {
    ilsa_solver *solver = ready(t);
    ilsa_status status = t->call(solver, t->context, answer);
    if (status)
        fail_msg("%s: %s", t->name, ilsa_last_error(solver));
    host_image after = host_save(solver);
    ilsa_solver_destroy(&solver);
    return after;
}

static void check_failure(const trial *t, ilsa_solver *solver, ilsa_status status, int most) {
    double time;
    if (status != ILSA_ERR_MEMORY || !strstr(ilsa_last_error(solver), "memory"))
        fail_msg("%s, request %d: status %d, %s", t->name, most, status, ilsa_last_error(solver));
    if (!t->before)
        assert_int_equal(ilsa_get_time(solver, &time), ILSA_ERR_STATE);
    else if (!t->keeps_steps && !host_is(solver, t->before))
        fail_msg("%s, request %d: the state has changed", t->name, most);
}

/* The call when request number `most` fails; then again with memory. Returns whether any failed. */
static int fails_once(const trial *t, int most, const host_image *after, double answer) {
    double got = NAN;
    ilsa_solver *solver = ready(t);
    allocations_failed = 0;
    allocations_left = most;
    ilsa_status status = t->call(solver, t->context, &got);
    allocations_left = -1;
    int failed = allocations_failed;
    if (failed || status) {
        check_failure(t, solver, status, most);
        assert_int_equal(t->call(solver, t->context, &got), ILSA_OK);
    }
    if (!host_is(solver, after) || got != answer)
        fail_msg("%s, request %d: another answer afterwards", t->name, most);
    ilsa_solver_destroy(&solver);
    return failed > 0;
}

/* Each request alone and with all that follow it; one of the two in turn unless $ILSA_LONG. */
static void sweep(const trial *t, int least) {
    double answer = 0;
    host_image after = expected(t, &answer);
    int count = 0, failed = 1;
    while (failed) {
        one_allocation_fails = count % 2;
        failed = fails_once(t, count, &after, answer);
        one_allocation_fails = !one_allocation_fails;
        failed = failed && (!host_long() || fails_once(t, count, &after, answer));
        count += failed;
    }
    one_allocation_fails = 0;
    print_message("%s: %d requests failed in turn\n", t->name, count);
    assert_true(count >= least);
    host_free(&after);
}

/* Each scene, small or wide, after some steps. */
static host_image state_of(const host_scene *scene, double radius, int steps) {
    ilsa_solver *solver = host_started(scene, radius);
    host_steps(solver, steps);
    host_image image = host_save(solver);
    ilsa_solver_destroy(&solver);
    return image;
}

/* Sweeps of many steps are made with the last scene alone unless $ILSA_LONG. */
static int first_of_long_sweep(void) {
    return host_long() ? 0 : SCENES - 1;
}

static void sweep_scenes(const char *what, action *call, int least, int keeps_steps) {
    for (int k = 0; k < SCENES; k++) {
        char name[64];
        host_scene scene = scenes[k].make();
        host_image before = state_of(&scene, scenes[k].radius, 2);
        snprintf(name, sizeof name, "%s, %s", what, scenes[k].name);
        sweep(&(trial){name, &scene, &before, call, NULL, keeps_steps}, least);
        host_free(&before);
    }
}

/* ---- The calls ----------------------------------------------------------------------------------
 */

static ilsa_status start(ilsa_solver *solver, const void *radius, double *answer) {
    *answer = 0;
    return ilsa_start_radial(solver, *(const double *)radius);
}

static ilsa_status one_step(ilsa_solver *solver, const void *unused, double *answer) {
    (void)unused;
    double dt = 0;
    ilsa_status status = ilsa_suggest_dt(solver, &dt);
    *answer = dt;
    return status ? status : ilsa_step(solver, 0.7 * dt, NULL);
}

/* To a time that takes some steps. */
static ilsa_status some_steps(ilsa_solver *solver, const void *end, double *answer) {
    *answer = 0;
    return ilsa_advance(solver, *(const double *)end, NULL);
}

static ilsa_status coarsen(ilsa_solver *solver, const void *unused, double *answer) {
    (void)unused;
    *answer = 0;
    return ilsa_coarsen(solver);
}

static ilsa_status grow(ilsa_solver *solver, const void *unused, double *answer) {
    (void)unused;
    *answer = 0;
    return ilsa_grow(solver, 3, 2);
}

/* A step that has to coarsen or grow the mesh first. */
static ilsa_status step_at_the_edge(ilsa_solver *solver, const void *unused, double *answer) {
    (void)unused;
    *answer = 0; /* the mesh may be another when memory fails */
    return ilsa_advance_one(solver, 1e300, NULL);
}

static ilsa_status restore(ilsa_solver *solver, const void *image, double *answer) {
    const host_image *from = image;
    *answer = 0;
    return ilsa_snapshot_restore(solver, from->bytes, from->size);
}

static ilsa_status take_stress(ilsa_solver *solver, const void *stress, double *answer) {
    const double *sigma = NULL;
    ilsa_status status = ilsa_set_stress(solver, stress);
    ilsa_get_stress(solver, &sigma);
    *answer = sigma[7];
    return status;
}

static ilsa_status read_front(ilsa_solver *solver, const void *unused, double *answer) {
    (void)unused;
    const ilsa_front_point *points = NULL;
    size_t count = 0;
    ilsa_status status = ilsa_get_front(solver, &points, &count);
    *answer = 0;
    for (size_t k = 0; k < count; k++)
        *answer += hypot(points[k].x, points[k].y) + points[k].regime.N_k;
    return status;
}

static ilsa_status read_regime(ilsa_solver *solver, const void *unused, double *answer) {
    (void)unused;
    const ilsa_survey_point *points = NULL;
    size_t count = 0;
    ilsa_status status = ilsa_get_survey(solver, &points, &count);
    *answer = 0;
    for (size_t k = 0; k < count; k++)
        *answer += points[k].s * points[k].w;
    return status;
}

/* ---- Tests ------------------------------------------------------------------------------------
 */

/* Makes all that a solver needs while request number `most` fails; returns whether any did. */
static int made_without(const named_scene *named, const host_scene *scene, int most,
                        ilsa_solver **solver) {
    allocations_failed = 0;
    allocations_left = most;
    ilsa_status status = host_try(scene, solver);
    allocations_left = -1;
    int failed = allocations_failed > 0;
    if (status != (failed ? ILSA_ERR_MEMORY : ILSA_OK) || (*solver == NULL) != failed ||
        (failed && !strstr(ilsa_last_error(NULL), "no memory")))
        fail_msg("%s, request %d: %s", named->name, most, ilsa_last_error(NULL));
    return failed;
}

/* Mesh, material, stress, its setters and the solver with its threads; then it works as ever. */
static void a_solver_is_made_or_refused(void **unused) {
    (void)unused;
    for (int k = 0; k < 2 * SCENES; k++) {
        const named_scene *named = &scenes[k / 2];
        host_scene scene = named->make();
        host_image after = state_of(&scene, named->radius, 1);
        ilsa_solver *solver;
        int count = 0;
        one_allocation_fails = k % 2;
        while (made_without(named, &scene, count, &solver))
            count++;
        one_allocation_fails = 0;
        print_message("create, %s: %d requests failed in turn\n", named->name, count);
        assert_true(count > 25);
        assert_int_equal(ilsa_start_radial(solver, named->radius), ILSA_OK);
        host_steps(solver, 1);
        assert_true(host_is(solver, &after));
        host_free(&after);
        ilsa_solver_destroy(&solver);
    }
}

static void a_start_without_memory_starts_nothing(void **unused) {
    (void)unused;
    for (int k = 0; k < SCENES; k++) {
        host_scene scene = scenes[k].make();
        sweep(&(trial){"start", &scene, NULL, start, &scenes[k].radius, 0}, 0);
    }
}

/* The first step of a handle, where every buffer is made. */
static void a_step_without_memory_changes_nothing(void **unused) {
    (void)unused;
    sweep_scenes("step", one_step, 20, 0);
}

/* Steps that were accepted stay, and the way on is the same. */
static void an_advance_goes_on_where_memory_failed(void **unused) {
    (void)unused;
    for (int k = first_of_long_sweep(); k < SCENES; k++) {
        host_scene scene = scenes[k].make();
        host_image before = state_of(&scene, scenes[k].radius, 1);
        ilsa_solver *solver = host_started(&scene, scenes[k].radius);
        host_steps(solver, 4);
        double end = host_summary(solver).time;
        ilsa_solver_destroy(&solver);
        sweep(&(trial){"advance", &scene, &before, some_steps, &end, 1}, 20);
        host_free(&before);
    }
}

static void a_mesh_without_memory_stays_fine(void **unused) {
    (void)unused;
    sweep_scenes("coarsen", coarsen, 10, 0);
    sweep_scenes("grow", grow, 10, 0);
}

/* The state from which the next step coarsens or grows the mesh. */
static host_image at_the_edge(const named_scene *named, const host_scene *scene) {
    ilsa_solver *solver = host_started(scene, named->wide);
    host_image before = {NULL, 0};
    ilsa_report report = {0};
    for (int k = 0; k < 30 && report.coarsened + report.grown == 0; k++) {
        host_free(&before);
        before = host_save(solver);
        assert_int_equal(ilsa_advance_one(solver, 1e300, &report), ILSA_OK);
    }
    assert_true(scene->options.cells_max == 1 ? report.coarsened > 0 : report.grown == 1);
    ilsa_solver_destroy(&solver);
    return before;
}

static void an_edge_reached_without_memory_is_passed_later(void **unused) {
    (void)unused;
    for (int k = 2 * first_of_long_sweep(); k < 2 * SCENES; k++) {
        const named_scene *named = &scenes[k / 2];
        host_scene scene = named->make();
        scene.options.coarsen = 1;
        scene.options.cells_max = k % 2;
        host_image before = at_the_edge(named, &scene);
        sweep(&(trial){"edge", &scene, &before, step_at_the_edge, NULL, 1}, 30);
        host_free(&before);
    }
}

/* From an image on a larger and coarser mesh. */
static void a_snapshot_without_memory_is_not_restored(void **unused) {
    (void)unused;
    for (int k = 0; k < SCENES; k++) {
        host_scene scene = scenes[k].make();
        host_image before = state_of(&scene, scenes[k].radius, 2);
        ilsa_solver *solver = host_started(&scene, scenes[k].wide);
        assert_int_equal(ilsa_grow(solver, 2, 1), ILSA_OK);
        assert_int_equal(ilsa_coarsen(solver), ILSA_OK);
        host_image coarse = host_save(solver);
        ilsa_solver_destroy(&solver);
        sweep(&(trial){"restore", &scene, &before, restore, &coarse, 0}, 3);
        host_free(&before);
        host_free(&coarse);
    }
}

/* A stress of layers and one of cells, made and given to a solver. */
static void a_stress_without_memory_is_not_taken(void **unused) {
    (void)unused;
    host_scene scene = plain();
    double cells[31 * 31], y[2] = {-1, 1}, sigma[3] = {0.3, 0, 0.2};
    for (int k = 0; k < 31 * 31; k++)
        cells[k] = 0.001 * (k % 40);
    host_image before = state_of(&scene, 0.6, 2);
    ilsa_stress_def zero = ilsa_stress_def_default();
    ilsa_mesh *mesh = NULL;
    ilsa_stress *stress = NULL;
    assert_int_equal(ilsa_mesh_create(&scene.mesh, &mesh), ILSA_OK);
    assert_int_equal(ilsa_stress_create(&zero, &stress), ILSA_OK);
    for (int by_cell = 0; by_cell < 2; by_cell++) {
        allocations_left = 0;
        ilsa_status status = by_cell ? ilsa_stress_set_cells(stress, mesh, cells)
                                     : ilsa_stress_set_layers(stress, 2, y, sigma);
        allocations_left = -1;
        assert_int_equal(status, ILSA_ERR_MEMORY);
        assert_non_null(strstr(ilsa_last_error(NULL), "no memory"));
        status = by_cell ? ilsa_stress_set_cells(stress, mesh, cells)
                         : ilsa_stress_set_layers(stress, 2, y, sigma);
        assert_int_equal(status, ILSA_OK);
        sweep(&(trial){"stress", &scene, &before, take_stress, stress, 0}, 1);
    }
    host_free(&before);
    ilsa_mesh_destroy(&mesh);
    ilsa_stress_destroy(&stress);
}

static void readings_without_memory_can_be_made_again(void **unused) {
    (void)unused;
    sweep_scenes("front", read_front, 2, 0);
    sweep_scenes("regime", read_regime, 1, 0);
}

/* Allows the process no more than so many bytes; 0 if that can be. */
static int limit_to(size_t bytes) {
    struct rlimit limit = {bytes, RLIM_INFINITY};
    return setrlimit(RLIMIT_AS, &limit);
}

/* Takes what the heap has left, so that all that is asked for later comes from the system. */
static void fill_heap(void) {
    for (size_t size = (size_t)1 << 20; size >= 16; size /= 2) {
        void *volatile block;
        do
            block = malloc(size);
        while (block);
    }
}

/* As `sweep` cannot: FFTW gets no more than the library does, in a process of its own. */
static ilsa_status box_within(size_t base, size_t more) {
    int result = 0;
    fflush(stdout);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        elasticity *e = NULL;
        ilsa_status status = ilsai_elasticity_create(1, 1, 1, ILSA_PRODUCT_FFT, &e);
        int limited = !limit_to(base);
        fill_heap();
        limited = limited && !limit_to(base + more);
        status = status || !limited ? ILSA_ERR_STATE
                                    : ilsai_elasticity_set_box(e, &(box){0, 299, 0, 299},
                                                               MIRROR_NONE, MIRROR_NONE);
        _exit(-status);
    }
    assert_int_equal(waitpid(child, &result, 0), child);
    if (!WIFEXITED(result))
        fail_msg("signal %d with %zu bytes more", WTERMSIG(result), more);
    return (ilsa_status)-WEXITSTATUS(result);
}

static size_t bytes_in_use(void) {
    char line[80] = "";
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file)
        return 0;
    char *got = fgets(line, sizeof line, file);
    fclose(file);
    return got ? strtoul(line, NULL, 10) * (size_t)sysconf(_SC_PAGESIZE) : 0;
}

/* The sanitizers and valgrind need more address space than there is. */
static int limits_work(void) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return 0;
#else
    return bytes_in_use() > 0 && !getenv("ILSA_VALGRIND");
#endif
}

/* The first test: FFTW asks for most in the first plans of a process. */
static void a_full_address_space_does_not_end_the_process(void **unused) {
    (void)unused;
    const size_t base = bytes_in_use(), step = (size_t)32 << 10;
    int refused = 0;
    ilsa_status status = ILSA_ERR_MEMORY;
    if (!limits_work() || !ilsai_elasticity_has_fft())
        skip();
    for (int k = 0; status != ILSA_OK && k < 1000; k++) {
        status = box_within(base, (size_t)k * step);
        assert_true(status == ILSA_OK || status == ILSA_ERR_MEMORY);
        refused += status != ILSA_OK;
    }
    print_message("box of 300 x 300: refused in %d limits of the address space\n", refused);
    assert_int_equal(status, ILSA_OK);
    assert_true(refused > 50);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_full_address_space_does_not_end_the_process),
        cmocka_unit_test(a_solver_is_made_or_refused),
        cmocka_unit_test(a_start_without_memory_starts_nothing),
        cmocka_unit_test(a_step_without_memory_changes_nothing),
        cmocka_unit_test(an_advance_goes_on_where_memory_failed),
        cmocka_unit_test(a_mesh_without_memory_stays_fine),
        cmocka_unit_test(an_edge_reached_without_memory_is_passed_later),
        cmocka_unit_test(a_snapshot_without_memory_is_not_restored),
        cmocka_unit_test(a_stress_without_memory_is_not_taken),
        cmocka_unit_test(readings_without_memory_can_be_made_again),
    };
    return cmocka_run_group_tests_name("memory", tests, NULL, NULL);
}
