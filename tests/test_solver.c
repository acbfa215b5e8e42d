/* Every function of solver.h: bad input of each kind, then what good input gives. */
#include "base/tuning.h"
#include "check.h"
#include "elastic/elasticity.h"
#include "host.h"

#include <float.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static const double bad[] = {NAN, INFINITY, -INFINITY, -1};
enum { BAD = sizeof bad / sizeof *bad };

static void check_message(const char *message, const char *part) {
    if (!strstr(message, part))
        fail_msg("message '%s' does not contain '%s'", message, part);
}

/* A definition that is good but for what a test changes in it. */
typedef struct parts {
    ilsa_mesh *mesh;
    ilsa_material *material;
    ilsa_stress *stress;
    ilsa_source_def source[2];
    ilsa_solver_def def;
} parts;

static void make_parts(parts *p) {
    ilsa_mesh_def mesh = {41, 31, 0.1, 0.1};
    ilsa_material_def material = {1, 1, 1, 0.3};
    ilsa_stress_def stress = {0.5};
    *p = (parts){.def = ilsa_solver_def_default()};
    assert_int_equal(ilsa_mesh_create(&mesh, &p->mesh), ILSA_OK);
    assert_int_equal(ilsa_material_create(&material, &p->material), ILSA_OK);
    assert_int_equal(ilsa_stress_create(&stress, &p->stress), ILSA_OK);
    p->source[0].rate = p->source[1].rate = 1;
    p->def.mesh = p->mesh;
    p->def.material = p->material;
    p->def.stress = p->stress;
    p->def.sources = p->source;
    p->def.source_count = 2;
}

static void free_parts(parts *p) {
    ilsa_mesh_destroy(&p->mesh);
    ilsa_material_destroy(&p->material);
    ilsa_stress_destroy(&p->stress);
}

/* The definition is refused, with a message that names what is wrong, and there is no handle. */
static void check_refused(const ilsa_solver_def *def, ilsa_status expected, const char *name) {
    int dummy;
    ilsa_solver *solver = (ilsa_solver *)(void *)&dummy;
    ilsa_status status = ilsa_solver_create(def, &solver);
    if (status != expected)
        fail_msg("%s: status %d", name, status);
    check_message(ilsa_last_error(NULL), name);
    assert_null(solver);
}

static void defaults_are_as_documented(void **state) {
    (void)state;
    ilsa_solver_def def = ilsa_solver_def_default();
    assert_true(!def.mesh && !def.material && !def.stress && !def.sources);
    assert_true(def.source_count == 0 && def.level == 3 && def.coarsen == 0);
    assert_true(def.symmetry == ILSA_SYMMETRY_AUTO && def.linear == ILSA_LINEAR_AUTO);
    assert_true(def.tip == ILSA_TIP_FULL);
    assert_true(def.product == ILSA_PRODUCT_AUTO);
    assert_true(def.step_cells == 0 && def.tolerance == 0 && def.dt_max == 0);
}

static void create_needs_its_pointers(void **state) {
    (void)state;
    parts p;
    make_parts(&p);
    assert_int_equal(ilsa_solver_create(&p.def, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "solver");
    check_refused(NULL, ILSA_ERR_NULL, "def");
    ilsa_solver_def def = p.def;
    def.mesh = NULL;
    check_refused(&def, ILSA_ERR_NULL, "mesh");
    def = p.def;
    def.material = NULL;
    check_refused(&def, ILSA_ERR_NULL, "material");
    def = p.def;
    def.sources = NULL;
    check_refused(&def, ILSA_ERR_NULL, "sources");
    /* No stress is zero stress. */
    ilsa_solver *solver;
    const double *sigma;
    def = p.def;
    def.stress = NULL;
    assert_int_equal(ilsa_solver_create(&def, &solver), ILSA_OK);
    assert_int_equal(ilsa_start_radial(solver, 0.5), ILSA_OK);
    assert_int_equal(ilsa_get_stress(solver, &sigma), ILSA_OK);
    for (int k = 0; k < 41 * 31; k++)
        assert_true(sigma[k] == 0);
    ilsa_solver_destroy(&solver);
    free_parts(&p);
}

static void create_refuses_bad_integers(void **state) {
    (void)state;
    parts p;
    make_parts(&p);
    static const int counts[] = {0, -1, 1001, -2147483647}, levels[] = {-1, -3, 6, 1000000};
    for (int k = 0; k < 4; k++) {
        ilsa_solver_def def = p.def;
        def.source_count = counts[k];
        check_refused(&def, ILSA_ERR_VALUE, "source_count");
        def = p.def;
        def.level = levels[k];
        check_refused(&def, ILSA_ERR_VALUE, "level");
        def = p.def;
        def.tip = (ilsa_tip_model)(k % 2 ? 3 + k : -1 - k);
        check_refused(&def, ILSA_ERR_VALUE, "tip");
        def = p.def;
        def.symmetry = (ilsa_symmetry)(k % 2 ? 5 + k : -1 - k);
        check_refused(&def, ILSA_ERR_VALUE, "symmetry");
        def = p.def;
        def.linear = (ilsa_linear_solver)(k % 2 ? 3 + k : -1 - k);
        check_refused(&def, ILSA_ERR_VALUE, "linear");
        def = p.def;
        def.loop = (ilsa_front_loop)(k % 2 ? 2 + k : -1 - k);
        check_refused(&def, ILSA_ERR_VALUE, "loop");
        def = p.def;
        def.product = (ilsa_product)(k % 2 ? 3 + k : -1 - k);
        check_refused(&def, ILSA_ERR_VALUE, "product");
        def = p.def;
        def.coarsen = k % 2 ? 2 + k : -1 - k;
        check_refused(&def, ILSA_ERR_VALUE, "coarsen");
    }
    free_parts(&p);
}

static void create_refuses_bad_numbers(void **state) {
    (void)state;
    parts p;
    make_parts(&p);
    static const double steps[] = {NAN, INFINITY, -1, 0.0099, 1.01, 1e-300};
    static const double tolerances[] = {NAN, INFINITY, -1, 0.9e-12, 0.11, 1e-300};
    for (int k = 0; k < 6; k++) {
        ilsa_solver_def def = p.def;
        def.step_cells = steps[k];
        check_refused(&def, ILSA_ERR_VALUE, "step_cells");
        def = p.def;
        def.tolerance = tolerances[k];
        check_refused(&def, ILSA_ERR_VALUE, "tolerance");
    }
    for (int k = 0; k < BAD; k++) {
        ilsa_solver_def def = p.def;
        def.dt_max = bad[k];
        check_refused(&def, ILSA_ERR_VALUE, "dt_max");
    }
    free_parts(&p);
}

static void create_refuses_bad_sources(void **state) {
    (void)state;
    parts p;
    make_parts(&p);
    static const double beyond[] = {NAN, INFINITY, -INFINITY, 2.06, -2.06, 1e300};
    for (int n = 0; n < 2; n++) {
        for (int k = 0; k < 6; k++) {
            p.source[n].x = beyond[k];
            check_refused(&p.def, ILSA_ERR_VALUE, "source x");
            p.source[n].x = 0;
            p.source[n].y = k < 3 ? beyond[k] : beyond[k] * 1.6 / 2.06;
            check_refused(&p.def, ILSA_ERR_VALUE, "source y");
            p.source[n].y = 0;
        }
        for (int k = 0; k < BAD; k++) {
            p.source[n].rate = bad[k];
            check_refused(&p.def, ILSA_ERR_VALUE, "rate");
            p.source[n].rate = 1;
        }
    }
    /* On the very edge of the mesh is on the mesh; no rate is a rate. */
    ilsa_solver *solver;
    p.source[1] = (ilsa_source_def){0.5 * 41 * 0.1, -0.5 * 31 * 0.1, 0};
    assert_int_equal(ilsa_solver_create(&p.def, &solver), ILSA_OK);
    assert_int_equal(ilsa_start_radial(solver, 0.5), ILSA_OK);
    host_steps(solver, 1);
    ilsa_solver_destroy(&solver);
    free_parts(&p);
}

static void create_refuses_what_does_not_match(void **state) {
    (void)state;
    parts p;
    make_parts(&p);
    ilsa_mesh_def defs[] = {{41, 32, 0.1, 0.1}, {40, 31, 0.1, 0.1}, {41, 31, 0.2, 0.1}};
    double *values = calloc((size_t)41 * 32, sizeof *values);
    assert_non_null(values);
    for (int k = 0; k < 3; k++) {
        ilsa_mesh *other;
        assert_int_equal(ilsa_mesh_create(&defs[k], &other), ILSA_OK);
        assert_int_equal(ilsa_stress_set_cells(p.stress, other, values), ILSA_OK);
        check_refused(&p.def, ILSA_ERR_MISMATCH, "stress");
        ilsa_mesh_destroy(&other);
    }
    assert_int_equal(ilsa_stress_set_cells(p.stress, p.mesh, values), ILSA_OK);
    ilsa_solver *solver;
    assert_int_equal(ilsa_solver_create(&p.def, &solver), ILSA_OK);
    ilsa_solver_destroy(&solver);
    p.def.product = ILSA_PRODUCT_FFT;
    if (!ilsai_elasticity_has_fft())
        check_refused(&p.def, ILSA_ERR_MISMATCH, "FFT");
    free(values);
    free_parts(&p);
}

/* LEFM has no front without toughness; the other models do without. */
static void create_refuses_toughness_without_any(void **state) {
    (void)state;
    for (int tip = ILSA_TIP_FULL; tip <= ILSA_TIP_TOUGHNESS; tip++) {
        host_scene scene = host_penny(1, 31, 0.1);
        ilsa_solver *solver;
        scene.material.K_prime = 0;
        scene.options.tip = (ilsa_tip_model)tip;
        ilsa_status status = host_try(&scene, &solver);
        assert_int_equal(status, tip == ILSA_TIP_TOUGHNESS ? ILSA_ERR_MISMATCH : ILSA_OK);
        if (status)
            check_message(ilsa_last_error(NULL), "tip = ILSA_TIP_TOUGHNESS");
        assert_true((solver == NULL) == (status != ILSA_OK));
        ilsa_solver_destroy(&solver);
    }
}

static void destroy_takes_anything(void **state) {
    (void)state;
    ilsa_solver *solver = NULL;
    ilsa_solver_destroy(NULL);
    ilsa_solver_destroy(&solver);
    host_scene scene = host_penny(0, 21, 0.1);
    solver = host_solver(&scene);
    ilsa_solver_destroy(&solver);
    assert_null(solver);
    ilsa_solver_destroy(&solver);
}

/* Symmetry */

/* What the solver uses, and which requests are refused. */
static void check_symmetry(const host_scene *scene, int about_x, int about_y) {
    static const ilsa_symmetry found[] = {ILSA_SYMMETRY_NONE, ILSA_SYMMETRY_X, ILSA_SYMMETRY_Y,
                                          ILSA_SYMMETRY_XY};
    for (int asked = ILSA_SYMMETRY_AUTO; asked <= ILSA_SYMMETRY_XY; asked++) {
        host_scene with = *scene;
        with.options.symmetry = (ilsa_symmetry)asked;
        int x = asked == ILSA_SYMMETRY_X || asked == ILSA_SYMMETRY_XY;
        int y = asked == ILSA_SYMMETRY_Y || asked == ILSA_SYMMETRY_XY;
        ilsa_solver *solver;
        ilsa_status status = host_try(&with, &solver);
        if ((x && !about_x) || (y && !about_y)) {
            assert_int_equal(status, ILSA_ERR_MISMATCH);
            check_message(ilsa_last_error(NULL), !y || about_y ? "x = 0" : "y = 0");
            assert_null(solver);
            continue;
        }
        assert_int_equal(status, ILSA_OK);
        assert_int_equal(ilsa_start_radial(solver, 0.8), ILSA_OK);
        ilsa_model model;
        assert_int_equal(ilsa_get_model(solver, &model), ILSA_OK);
        x = asked == ILSA_SYMMETRY_AUTO ? about_x : x;
        y = asked == ILSA_SYMMETRY_AUTO ? about_y : y;
        assert_int_equal(model.symmetry, found[x + 2 * y]);
        host_steps(solver, 1);
        assert_true(fabs(host_imbalance(solver)) <= 1e-12);
        ilsa_solver_destroy(&solver);
    }
}

static void symmetry_is_found_in_the_stress(void **state) {
    (void)state;
    double cells[41 * 41] = {0};
    host_scene scene = host_penny(1e-2, 41, 0.1);
    check_symmetry(&scene, 1, 1);
    scene.interfaces = 1;
    scene.interface_y[0] = 0.3;
    scene.sigma[1] = 0.1;
    check_symmetry(&scene, 1, 0);
    scene.interfaces = 2;
    scene.interface_y[0] = -0.33;
    scene.interface_y[1] = 0.33;
    scene.sigma[0] = scene.sigma[2] = 0.2;
    check_symmetry(&scene, 1, 1);
    scene.cells = cells;
    cells[17 * 41 + 3] = 0.1;
    check_symmetry(&scene, 0, 0);
    cells[17 * 41 + 37] = 0.1;
    check_symmetry(&scene, 1, 0);
    cells[23 * 41 + 3] = cells[23 * 41 + 37] = 0.1;
    check_symmetry(&scene, 1, 1);
    cells[17 * 41 + 3] = cells[23 * 41 + 37] = 0;
    check_symmetry(&scene, 0, 0);
}

static void symmetry_is_found_in_the_sources(void **state) {
    (void)state;
    host_scene scene = host_penny(1e-2, 41, 0.1);
    scene.source[0].x = 0.1;
    check_symmetry(&scene, 0, 1);
    scene.source[0].y = 1e-9;
    check_symmetry(&scene, 0, 0);
    scene = host_penny(1e-2, 41, 0.1);
    scene.source_count = 3;
    scene.source[1] = (ilsa_source_def){0.3, 0, 0.5};
    scene.source[2] = (ilsa_source_def){-0.3, 0, 0.5};
    check_symmetry(&scene, 1, 1);
    scene.source[2].rate = 0.4;
    check_symmetry(&scene, 0, 1);
    scene.source[2].rate = 0.5;
    scene.source[2].y = scene.source[1].y = 0.2;
    check_symmetry(&scene, 1, 0);
    /* Two sources in one place have no image in one. */
    scene.source_count = 4;
    scene.source[3] = scene.source[1];
    check_symmetry(&scene, 0, 0);
}

/* The penny is laid around the first source: what it is off the axis is no symmetric state. */
static void symmetry_is_found_in_the_state(void **state) {
    (void)state;
    host_scene scene = host_penny(0, 41, 0.1);
    scene.source_count = 2;
    scene.source[0].x = 0.3;
    scene.source[1] = (ilsa_source_def){-0.3, 0, 1};
    ilsa_solver *solver = host_started(&scene, 0.9);
    ilsa_model model;
    assert_int_equal(ilsa_get_model(solver, &model), ILSA_OK);
    assert_int_equal(model.symmetry, ILSA_SYMMETRY_Y);
    ilsa_solver_destroy(&solver);
}

/* Rates that are no longer equal are no symmetry; equal again they are none either: the state is
 * not. */
static void symmetry_is_lost_with_a_rate(void **state) {
    (void)state;
    host_scene scene = host_penny(0, 41, 0.1);
    scene.source_count = 3;
    scene.source[1] = (ilsa_source_def){0.3, 0, 0.5};
    scene.source[2] = (ilsa_source_def){-0.3, 0, 0.5};
    ilsa_solver *solver = host_started(&scene, 0.9);
    ilsa_model model;
    for (int k = 0; k < 3; k++) {
        assert_int_equal(ilsa_set_rate(solver, 1, k == 1 ? 0.1 : 0.5), ILSA_OK);
        assert_int_equal(ilsa_get_model(solver, &model), ILSA_OK);
        assert_int_equal(model.symmetry, k == 0 ? ILSA_SYMMETRY_XY : ILSA_SYMMETRY_Y);
        host_steps(solver, 1);
    }
    ilsa_solver_destroy(&solver);
}

/* Start */

static void check_start_refused(ilsa_solver *solver, double radius, double time,
                                ilsa_status expected, const char *name) {
    host_image before = host_save(solver);
    ilsa_status status =
        isnan(time) ? ilsa_start_radial(solver, radius) : ilsa_start_radial_at(solver, time);
    if (status != expected)
        fail_msg("start %g, %g: status %d", radius, time, status);
    check_message(ilsa_last_error(solver), name);
    assert_true(host_is(solver, &before));
    host_free(&before);
}

static void start_refuses_bad_input(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_solver *solver = host_started(&scene, 0.7);
    assert_int_equal(ilsa_start_radial(NULL, 1), ILSA_ERR_NULL);
    assert_int_equal(ilsa_start_radial_at(NULL, 1), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "solver");
    for (int k = 1; k < BAD; k++) {
        check_start_refused(solver, bad[k], NAN, ILSA_ERR_VALUE, "radius");
        check_start_refused(solver, 0, bad[k], ILSA_ERR_VALUE, "time");
    }
    check_start_refused(solver, 0, NAN, ILSA_ERR_VALUE, "radius");
    check_start_refused(solver, NAN, NAN, ILSA_ERR_VALUE, "radius");
    check_start_refused(solver, 0, 0, ILSA_ERR_VALUE, "time");
    check_start_refused(solver, 0.199, NAN, ILSA_ERR_VALUE, "radius");
    check_start_refused(solver, 0, 1e-3, ILSA_ERR_VALUE, "radius");
    check_start_refused(solver, 1.91, NAN, ILSA_MESH_EDGE, "radius");
    check_start_refused(solver, 0, 1e4, ILSA_MESH_EDGE, "radius");
    assert_int_equal(ilsa_set_rate(solver, 0, 0), ILSA_OK);
    check_start_refused(solver, 0.7, NAN, ILSA_ERR_VALUE, "rate of source 0");
    check_start_refused(solver, 0, 1, ILSA_ERR_VALUE, "rate of source 0");
    ilsa_solver_destroy(&solver);
}

/* Numbers at the ends of the range: an answer of some kind, and no fracture off the mesh. */
static void start_survives_extreme_numbers(void **state) {
    (void)state;
    static const double extreme[] = {DBL_MIN, 1e-300, 1e-100, 1e100, 1e300, DBL_MAX, 4.9e-324};
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_solver *solver = host_started(&scene, 0.7);
    host_image before = host_save(solver);
    for (size_t k = 0; k < sizeof extreme / sizeof *extreme; k++) {
        assert_true(ilsa_start_radial(solver, extreme[k]) != ILSA_OK);
        assert_true(ilsa_start_radial_at(solver, extreme[k]) != ILSA_OK);
    }
    assert_true(host_is(solver, &before));
    host_free(&before);
    ilsa_solver_destroy(&solver);
}

/* One number of a scene replaced. */
static ilsa_status try_magnitude(int which, double value) {
    host_scene scene = host_penny(1, 41, 0.1);
    double *number[] = {&scene.mesh.dx,          &scene.material.E_prime, &scene.material.mu_prime,
                        &scene.material.K_prime, &scene.material.C_prime, &scene.source[0].rate,
                        &scene.sigma[0]};
    *number[which] = value;
    scene.mesh.dy = scene.mesh.dx;
    ilsa_solver *solver;
    ilsa_status status = host_try(&scene, &solver);
    ilsa_solver_destroy(&solver);
    return status;
}

/* Units in which volumes or squares of stresses overflow are refused, not computed with. */
static void absurd_units_are_refused(void **state) {
    (void)state;
    static const char *const name[] = {"dx",      "E_prime",     "mu_prime",      "K_prime",
                                       "C_prime", "source rate", "largest stress"};
    for (int k = 0; k < 7; k++) {
        assert_int_equal(try_magnitude(k, 1e60), ILSA_OK);
        assert_int_equal(try_magnitude(k, 1.001e60), ILSA_ERR_VALUE);
        check_message(ilsa_last_error(NULL), name[k]);
        assert_int_equal(try_magnitude(k, 1e-60), ILSA_OK);
        assert_int_equal(try_magnitude(k, 0.999e-60), k < 3 ? ILSA_ERR_VALUE : ILSA_OK);
    }
    host_scene scene = host_penny(1, 41, 1e30);
    scene.material = (ilsa_material_def){1e-60, 1e60, 0, 0};
    ilsa_solver *solver = host_solver(&scene);
    assert_int_equal(ilsa_start_radial(solver, 7e30), ILSA_ERR_VALUE);
    check_message(ilsa_last_error(solver), "must all be 1e-60 .. 1e+60");
    assert_int_equal(ilsa_set_rate(solver, 0, 1e61), ILSA_ERR_VALUE);
    ilsa_solver_destroy(&solver);
}

/* Zero is the default of the level, as of every other option. */
static void level_zero_is_the_default(void **state) {
    (void)state;
    host_scene scene = host_penny(0, 41, 0.1);
    scene.options.level = 0;
    ilsa_solver *solver = host_started(&scene, 0.7);
    ilsa_model used;
    assert_int_equal(ilsa_get_model(solver, &used), ILSA_OK);
    assert_int_equal(used.level, ilsa_solver_def_default().level);
    ilsa_solver_destroy(&solver);
}

/* A getter that fails says why to whoever asks, until another call of the thread fails. */
static void message_of_a_getter_is_told_by_every_handle(void **state) {
    (void)state;
    host_scene scene = host_penny(0, 41, 0.1);
    ilsa_solver *empty = host_solver(&scene), *full = host_started(&scene, 0.7);
    const double *width;
    assert_int_equal(ilsa_set_rate(empty, 0, -1), ILSA_ERR_VALUE);
    check_message(ilsa_last_error(empty), "rate");
    assert_int_equal(ilsa_get_width(empty, &width), ILSA_ERR_STATE);
    const ilsa_solver *asked[] = {empty, full, NULL};
    for (int k = 0; k < 3; k++) {
        check_message(ilsa_last_error(asked[k]), "ilsa_start_radial");
    }
    assert_int_equal(ilsa_get_width(full, &width), ILSA_OK);
    check_message(ilsa_last_error(full), "ilsa_start_radial");
    assert_int_equal(ilsa_suggest_dt(full, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(full), "dt is NULL");
    assert_int_equal(ilsa_set_rate(full, 7, 1), ILSA_ERR_VALUE);
    check_message(ilsa_last_error(full), "source = 7");
    check_message(ilsa_last_error(empty), "rate");
    ilsa_solver_destroy(&empty);
    ilsa_solver_destroy(&full);
}

/* A stress that is too large is refused, and the one that was there stays. */
static void absurd_stress_is_refused(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_solver *solver = host_started(&scene, 0.7);
    host_image before = host_save(solver);
    const ilsa_stress_def def = {1e61};
    const double y = 0, sigma[] = {0, -1e61};
    ilsa_stress *stress;
    assert_int_equal(ilsa_stress_create(&def, &stress), ILSA_OK);
    assert_int_equal(ilsa_set_stress(solver, stress), ILSA_ERR_VALUE);
    check_message(ilsa_last_error(solver), "largest stress = 1e+61");
    assert_int_equal(ilsa_stress_set_layers(stress, 1, &y, sigma), ILSA_OK);
    assert_int_equal(ilsa_set_stress(solver, stress), ILSA_ERR_VALUE);
    assert_true(host_is(solver, &before));
    host_steps(solver, 1);
    host_free(&before);
    ilsa_stress_destroy(&stress);
    ilsa_solver_destroy(&solver);
}

static void radius_and_time_of_a_start_agree(void **state) {
    (void)state;
    static const double phi[] = {0, 1e-4, 1};
    for (int k = 0; k < 3; k++) {
        host_scene scene = host_penny(phi[k], 41, 0.1);
        ilsa_solver *a = host_started(&scene, 0.77), *b = host_solver(&scene);
        double time = host_summary(a).time;
        assert_int_equal(ilsa_start_radial_at(b, time), ILSA_OK);
        ilsa_summary p = host_summary(a), q = host_summary(b);
        assert_true(p.time == q.time && fabs(q.x_max / p.x_max - 1) < 1e-6);
        assert_true(fabs(q.width_source / p.width_source - 1) < 1e-6);
        assert_true(p.volume_injected == time);
        assert_true(fabs(host_imbalance(a)) < 1e-14 && fabs(host_imbalance(b)) < 1e-14);
        ilsa_solver_destroy(&a);
        ilsa_solver_destroy(&b);
    }
}

static void a_start_replaces_the_fracture(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_solver *a = host_started(&scene, 0.5), *b = host_started(&scene, 1.2);
    host_steps(b, 3);
    assert_int_equal(ilsa_start_radial(b, 0.5), ILSA_OK);
    host_image image = host_save(a);
    assert_true(host_is(b, &image));
    const size_t bytes = sizeof(double) * 41 * 41;
    assert_memory_equal(host_width(a), host_width(b), bytes);
    assert_memory_equal(host_trigger(a), host_trigger(b), bytes);
    host_steps(a, 2);
    host_steps(b, 2);
    host_free(&image);
    image = host_save(a);
    assert_true(host_is(b, &image));
    host_free(&image);
    ilsa_solver_destroy(&a);
    ilsa_solver_destroy(&b);
}

/* Rates and stress */

static void set_rate_refuses_bad_input(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 41, 0.1);
    scene.source_count = 2;
    ilsa_solver *solver = host_started(&scene, 0.7);
    host_image before = host_save(solver);
    assert_int_equal(ilsa_set_rate(NULL, 0, 1), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "solver");
    static const int index[] = {-1, 2, 1000000, -2147483647};
    for (int k = 0; k < 4; k++) {
        assert_int_equal(ilsa_set_rate(solver, index[k], 1), ILSA_ERR_VALUE);
        check_message(ilsa_last_error(solver), "source");
    }
    for (int k = 0; k < BAD; k++) {
        assert_int_equal(ilsa_set_rate(solver, k % 2, bad[k]), ILSA_ERR_VALUE);
        check_message(ilsa_last_error(solver), "rate");
    }
    assert_true(host_is(solver, &before));
    assert_int_equal(ilsa_set_rate(solver, 1, 0), ILSA_OK);
    assert_false(host_is(solver, &before) && scene.source[1].rate > 0);
    host_free(&before);
    ilsa_solver_destroy(&solver);
}

static void set_stress_refuses_bad_input(void **state) {
    (void)state;
    double values[30 * 41] = {0};
    host_scene scene = host_three_layers(41, 41);
    ilsa_solver *solver = host_started(&scene, 5);
    host_image before = host_save(solver);
    ilsa_mesh_def def = {30, 41, 20.0 / 21, 20.0 / 21};
    ilsa_stress_def zero = ilsa_stress_def_default();
    ilsa_mesh *mesh;
    ilsa_stress *stress;
    assert_int_equal(ilsa_mesh_create(&def, &mesh), ILSA_OK);
    assert_int_equal(ilsa_stress_create(&zero, &stress), ILSA_OK);
    assert_int_equal(ilsa_set_stress(NULL, stress), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "solver");
    assert_int_equal(ilsa_set_stress(solver, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(solver), "stress");
    assert_int_equal(ilsa_stress_set_cells(stress, mesh, values), ILSA_OK);
    assert_int_equal(ilsa_set_stress(solver, stress), ILSA_ERR_MISMATCH);
    check_message(ilsa_last_error(solver), "stress");
    const double *sigma;
    assert_int_equal(ilsa_get_stress(solver, &sigma), ILSA_OK);
    assert_true(sigma[0] == 7.75e6 && sigma[41 * 41 / 2] == 7e6);
    assert_true(host_is(solver, &before));
    host_steps(solver, 1);
    host_free(&before);
    ilsa_mesh_destroy(&mesh);
    ilsa_stress_destroy(&stress);
    ilsa_solver_destroy(&solver);
}

/* A stress that is higher everywhere by the same amount raises the pressure by it, nothing else. */
static void check_rise(ilsa_solver *a, ilsa_solver *b, double allowed) {
    for (int k = 0; k < 4; k++) {
        double dt;
        assert_int_equal(ilsa_suggest_dt(a, &dt), ILSA_OK);
        host_step(a, 0.8 * dt);
        host_step(b, 0.8 * dt);
    }
    ilsa_summary p = host_summary(a), q = host_summary(b);
    assert_true(fabs(q.width_source / p.width_source - 1) < allowed);
    assert_true(fabs(q.x_max / p.x_max - 1) < allowed);
    assert_true(fabs(q.pressure_source - p.pressure_source - 3) < 10 * allowed);
    ilsa_solver_destroy(&a);
    ilsa_solver_destroy(&b);
}

/* Set before the start and after it: then the first guess is another one. */
static void pressure_rises_with_the_stress(void **state) {
    (void)state;
    host_scene scene = host_penny(1e-2, 41, 0.1);
    ilsa_stress_def def = {3};
    ilsa_stress *stress;
    assert_int_equal(ilsa_stress_create(&def, &stress), ILSA_OK);
    for (int after = 0; after < 2; after++) {
        ilsa_solver *a = host_started(&scene, 0.8), *b = host_started(&scene, 0.8);
        assert_int_equal(ilsa_set_stress(b, stress), ILSA_OK);
        if (!after)
            assert_int_equal(ilsa_start_radial(b, 0.8), ILSA_OK);
        check_rise(a, b, after ? 1e-3 : 1e-8);
    }
    ilsa_stress_destroy(&stress);
}

/* The clock */

static void steps_refuse_bad_calls(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_report report = {.steps = 5}, nothing = {0};
    ilsa_solver *solver = host_solver(&scene);
    double dt = 7;
    assert_int_equal(ilsa_step(NULL, 1, &report), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "solver");
    assert_int_equal(ilsa_advance(NULL, 1, &report), ILSA_ERR_NULL);
    assert_int_equal(ilsa_advance_one(NULL, 1, &report), ILSA_ERR_NULL);
    assert_int_equal(report.steps, 5);
    assert_int_equal(ilsa_step(solver, 1, &report), ILSA_ERR_STATE);
    check_message(ilsa_last_error(solver), "ilsa_start_radial");
    assert_memory_equal(&report, &nothing, sizeof report);
    assert_int_equal(ilsa_advance(solver, 1, NULL), ILSA_ERR_STATE);
    assert_int_equal(ilsa_advance_one(solver, 1, NULL), ILSA_ERR_STATE);
    assert_int_equal(ilsa_suggest_dt(solver, &dt), ILSA_ERR_STATE);
    check_message(ilsa_last_error(NULL), "ilsa_start_radial");
    assert_int_equal(ilsa_suggest_dt(NULL, &dt), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "solver");
    assert_int_equal(ilsa_start_radial(solver, 0.5), ILSA_OK);
    assert_int_equal(ilsa_suggest_dt(solver, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "dt");
    assert_true(dt == 7);
    ilsa_solver_destroy(&solver);
}

static void advance_refuses_bad_times(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_solver *solver = host_started(&scene, 0.5);
    double time = host_summary(solver).time;
    const double times[] = {time, 0.5 * time, 0, -1, NAN, INFINITY, -INFINITY};
    host_image before = host_save(solver);
    for (size_t k = 0; k < sizeof times / sizeof *times; k++) {
        ilsa_report report = {.steps = 5};
        assert_int_equal(ilsa_advance(solver, times[k], &report), ILSA_ERR_VALUE);
        check_message(ilsa_last_error(solver), "t_end");
        assert_true(report.time == time && report.steps == 0);
        assert_int_equal(ilsa_advance_one(solver, times[k], NULL), ILSA_ERR_VALUE);
        check_message(ilsa_last_error(solver), "t_limit");
    }
    assert_true(host_is(solver, &before));
    host_free(&before);
    ilsa_solver_destroy(&solver);
}

/* Reports of steps add up to the total of the summary, and the phases to the seconds. */
static void reports_add_up(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 61, 0.05);
    ilsa_solver *solver = host_started(&scene, 0.5);
    ilsa_report sum = {0}, one;
    double dt;
    for (int k = 0; k < 6; k++) {
        assert_int_equal(ilsa_suggest_dt(solver, &dt), ILSA_OK);
        ilsa_status status = ilsa_step(solver, k == 2 ? 50 * dt : dt, &one);
        assert_int_equal(status != ILSA_OK, k == 2);
        assert_true(one.steps == (k != 2) && one.rejected == (k == 2));
        assert_true(k == 2 || (one.dt == dt && one.front_advance > 0 && one.front_change <= 1e-3));
        assert_true(one.seconds > 0 && one.newton_iterations > 0 && one.elasticity_products > 0);
        sum.steps += one.steps;
        sum.rejected += one.rejected;
        sum.front_iterations += one.front_iterations;
        sum.newton_iterations += one.newton_iterations;
        sum.krylov_iterations += one.krylov_iterations;
        sum.elasticity_products += one.elasticity_products;
    }
    ilsa_report total = host_summary(solver).total;
    assert_true(total.steps == sum.steps && total.rejected == sum.rejected);
    assert_true(total.front_iterations == sum.front_iterations);
    assert_true(total.newton_iterations == sum.newton_iterations);
    assert_true(total.krylov_iterations == sum.krylov_iterations);
    assert_true(total.elasticity_products == sum.elasticity_products);
    ilsa_profile profile;
    assert_int_equal(ilsa_get_profile(solver, &profile), ILSA_OK);
    double phases = profile.product + profile.preconditioner + profile.front + profile.rest;
    assert_true(fabs(phases - total.seconds) < 1e-9);
    assert_true(profile.product > 0 && profile.preconditioner > 0 && profile.front > 0);
    ilsa_solver_destroy(&solver);
}

/* Reading */

typedef ilsa_status (*reader)(const ilsa_solver *, const double **);

static void check_field(ilsa_solver *empty, ilsa_solver *solver, reader read, const char *name) {
    const double *field = NULL;
    assert_int_equal(read(NULL, &field), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "solver");
    assert_int_equal(read(solver, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), name);
    assert_int_equal(read(empty, &field), ILSA_ERR_STATE);
    check_message(ilsa_last_error(NULL), "ilsa_start_radial");
    assert_null(field);
    assert_int_equal(read(solver, &field), ILSA_OK);
    assert_non_null(field);
}

static void fields_refuse_bad_calls(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_solver *solver = host_started(&scene, 0.7), *empty = host_solver(&scene);
    check_field(empty, solver, ilsa_get_width, "width");
    check_field(empty, solver, ilsa_get_pressure, "pressure");
    check_field(empty, solver, ilsa_get_stress, "stress");
    check_field(empty, solver, ilsa_get_trigger_time, "trigger");
    const unsigned char *kind = NULL;
    assert_int_equal(ilsa_get_cell_kinds(NULL, &kind), ILSA_ERR_NULL);
    assert_int_equal(ilsa_get_cell_kinds(solver, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "kind");
    assert_int_equal(ilsa_get_cell_kinds(empty, &kind), ILSA_ERR_STATE);
    assert_null(kind);
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&empty);
}

static void numbers_refuse_bad_calls(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_solver *solver = host_started(&scene, 0.7), *empty = host_solver(&scene);
    ilsa_summary summary = {.time = -7};
    ilsa_model model = {.level = -7};
    ilsa_profile profile = {.rest = -7};
    ilsa_mesh_def mesh = {-7, 0, 0, 0};
    double time = -7;
    assert_int_equal(ilsa_get_summary(NULL, &summary), ILSA_ERR_NULL);
    assert_int_equal(ilsa_get_summary(solver, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "summary");
    assert_int_equal(ilsa_get_summary(empty, &summary), ILSA_ERR_STATE);
    assert_int_equal(ilsa_get_model(NULL, &model), ILSA_ERR_NULL);
    assert_int_equal(ilsa_get_model(solver, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "model");
    assert_int_equal(ilsa_get_model(empty, &model), ILSA_ERR_STATE);
    assert_int_equal(ilsa_get_profile(NULL, &profile), ILSA_ERR_NULL);
    assert_int_equal(ilsa_get_profile(solver, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "profile");
    assert_int_equal(ilsa_get_profile(empty, &profile), ILSA_ERR_STATE);
    assert_int_equal(ilsa_get_time(NULL, &time), ILSA_ERR_NULL);
    assert_int_equal(ilsa_get_time(solver, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "time");
    assert_int_equal(ilsa_get_time(empty, &time), ILSA_ERR_STATE);
    assert_int_equal(ilsa_get_mesh_def(NULL, &mesh), ILSA_ERR_NULL);
    assert_int_equal(ilsa_get_mesh_def(solver, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "def");
    assert_true(summary.time == -7 && model.level == -7 && profile.rest == -7 && time == -7 &&
                mesh.nx == -7);
    assert_int_equal(ilsa_get_mesh_def(empty, &mesh), ILSA_OK);
    assert_true(mesh.nx == 41 && mesh.ny == 41 && mesh.dx == 0.1 && mesh.dy == 0.1);
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&empty);
}

/* Kinds, fields and summary of one state tell the same story. */
static void readings_agree(void **state) {
    (void)state;
    host_scene scene = host_three_layers(51, 41);
    ilsa_solver *solver = host_started(&scene, 7);
    host_steps(solver, 5);
    const double *width = host_width(solver), *pressure = host_pressure(solver), *stress = NULL;
    const unsigned char *kind = host_kind(solver);
    assert_int_equal(ilsa_get_stress(solver, &stress), ILSA_OK);
    ilsa_summary now = host_summary(solver);
    int wet = 0, tips = 0, survey = 0;
    for (int k = 0; k < 51 * 41; k++) {
        wet += kind[k] != ILSA_CELL_EMPTY;
        tips += kind[k] == ILSA_CELL_TIP;
        survey += kind[k] == ILSA_CELL_SURVEY;
        assert_true(kind[k] == ILSA_CELL_EMPTY ? width[k] == 0 && pressure[k] == 0 : width[k] > 0);
        assert_true(kind[k] < ILSA_CELL_SURVEY || pressure[k] > stress[k] - 1e6);
        if (kind[k] == ILSA_CELL_SURVEY || kind[k] == ILSA_CELL_CHANNEL) {
            int rim = kind[k - 1] < 2 || kind[k + 1] < 2 || kind[k - 51] < 2 || kind[k + 51] < 2;
            assert_int_equal(kind[k], rim ? ILSA_CELL_SURVEY : ILSA_CELL_CHANNEL);
        }
    }
    int centre = 20 * 51 + 25;
    assert_true(now.cells == wet && now.tip_cells == tips && now.survey_cells == survey);
    assert_true(now.width_source == width[centre] && now.pressure_source == pressure[centre]);
    assert_true(now.efficiency == now.volume_fracture / now.volume_injected);
    assert_true(fabs(host_integral(solver, width) / now.volume_fracture - 1) < 1e-13);
    assert_true(now.unknowns > 0 && now.unknowns < wet);
    ilsa_solver_destroy(&solver);
}

/* Also where a pass of the front has wetted a cell that the next one has not. */
static void pressure_is_zero_outside(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 15, 1e-3);
    scene.options.level = 1;
    ilsa_solver *solver = host_started(&scene, 2e-3);
    for (int step = 0; step < 8; step++) {
        host_steps(solver, 1);
        const double *pressure = host_pressure(solver);
        const unsigned char *kind = host_kind(solver);
        for (int k = 0; k < 15 * 15; k++)
            assert_true(kind[k] != ILSA_CELL_EMPTY || pressure[k] == 0);
    }
    ilsa_solver_destroy(&solver);
}

/* With next to no leak-off, whatever the initial solution leaves open of its volume. */
static void leaked_volume_is_not_negative(void **state) {
    (void)state;
    for (int k = -6; k < 2; k++) {
        host_scene scene = host_penny(1e-40, 15, pow(10, k));
        ilsa_solver *solver = host_started(&scene, 3 * scene.mesh.dx);
        assert_true(host_summary(solver).volume_leaked >= 0);
        ilsa_solver_destroy(&solver);
    }
}

/* Those that were survey cells at the start of the step answer to (4.9); new ones do in the next.
 */
static void survey_cells_follow_the_asymptote(void **state) {
    (void)state;
    host_scene scene = host_penny(1e-2, 61, 0.05);
    ilsa_solver *solver = host_started(&scene, 0.9);
    host_steps(solver, 5);
    const double *width;
    const unsigned char *kind;
    unsigned char before[61 * 61];
    assert_int_equal(ilsa_get_cell_kinds(solver, &kind), ILSA_OK);
    memcpy(before, kind, sizeof before);
    host_steps(solver, 1);
    double worst = NOTHING_YET;
    const ilsa_survey_point *points;
    size_t count;
    assert_true(!ilsa_get_width(solver, &width) && !ilsa_get_cell_kinds(solver, &kind));
    assert_int_equal(ilsa_get_survey(solver, &points, &count), ILSA_OK);
    assert_int_equal(count, host_summary(solver).survey_cells);
    for (size_t k = 0; k < count; k++) {
        const ilsa_survey_point *p = &points[k];
        double w;
        assert_int_equal(kind[p->cell], ILSA_CELL_SURVEY);
        assert_true(p->w == width[p->cell] && p->s > 0 && p->s < 0.1);
        assert_true(fabs(p->x - 0.05 * (p->cell % 61 - 30)) < 1e-12);
        int row = p->cell / 61 - 30;
        assert_true(fabs(p->y - 0.05 * row) < 1e-12);
        assert_int_equal(ilsa_tip_width(&scene.material, p->V, p->s, &w), ILSA_OK);
        if (before[p->cell] == ILSA_CELL_SURVEY)
            worst = worst_of(worst, fabs(w / p->w - 1));
        double sum = p->regime.N_k + p->regime.N_mt + p->regime.N_m;
        assert_true(fabs(sum - 1) < 1e-12);
    }
    print_message("solver: survey cells off the asymptote by %.1e\n", worst);
    assert_true(worst > 0);
    assert_below(worst, 0.05);
    ilsa_solver_destroy(&solver);
}

/* What a scene does not have is not modelled. */
static void the_model_says_what_is_on(void **state) {
    (void)state;
    for (int n = 0; n < 8; n++) {
        host_scene scene = host_penny(n & 1 ? 1 : 0, 31, 0.1);
        scene.material.K_prime = n & 2 ? 1 : 0;
        scene.options.tip = n & 4 ? ILSA_TIP_TOUGHNESS_VISCOSITY : ILSA_TIP_FULL;
        scene.interfaces = n & 4 ? 1 : 0;
        scene.sigma[1] = 0.1;
        ilsa_solver *solver = host_started(&scene, 0.7);
        ilsa_model model;
        const double *trigger;
        assert_int_equal(ilsa_get_model(solver, &model), ILSA_OK);
        assert_int_equal(ilsa_get_trigger_time(solver, &trigger), ILSA_OK);
        assert_int_equal(model.leak_off, n & 1);
        assert_int_equal(model.tip, scene.options.tip);
        assert_int_equal(trigger != NULL, n & 1);
        assert_int_equal(model.toughness, n & 2 ? 1 : 0);
        assert_int_equal(model.stress_varies, n & 4 ? 1 : 0);
        assert_int_equal(model.product,
                         ilsai_elasticity_has_fft() ? ILSA_PRODUCT_FFT : ILSA_PRODUCT_BLAS);
        host_steps(solver, 2);
        assert_true(n & 1 || host_summary(solver).volume_leaked == 0);
        ilsa_solver_destroy(&solver);
    }
}

/* Ways to the same answer */

/* Steps of the same length by two solvers; returns the largest difference of width. */
static double disagreement(ilsa_solver *a, ilsa_solver *b, int steps, int count) {
    const double *p, *q;
    double worst = NOTHING_YET, largest = 0, dt;
    for (int k = 0; k < steps; k++) {
        assert_int_equal(ilsa_suggest_dt(a, &dt), ILSA_OK);
        host_step(a, 0.9 * dt);
        host_step(b, 0.9 * dt);
    }
    assert_true(!ilsa_get_width(a, &p) && !ilsa_get_width(b, &q));
    for (int k = 0; k < count; k++) {
        worst = worst_of(worst, fabs(p[k] - q[k]));
        largest = larger_of(largest, p[k]);
    }
    ilsa_solver_destroy(&a);
    ilsa_solver_destroy(&b);
    return worst / largest;
}

/* The plain algorithm goes to the same front by more passes. */
static void loops_agree(void **state) {
    (void)state;
    host_scene scene = host_three_layers(51, 41);
    scene.options.tolerance = 1e-5;
    ilsa_solver *coupled = host_started(&scene, 7);
    scene.options.loop = ILSA_LOOP_NESTED;
    scene.options.linear = ILSA_LINEAR_DENSE;
    ilsa_solver *nested = host_started(&scene, 7);
    double dt;
    assert_int_equal(ilsa_suggest_dt(coupled, &dt), ILSA_OK);
    host_step(coupled, dt);
    host_step(nested, dt);
    long passes[] = {host_summary(coupled).total.front_iterations,
                     host_summary(nested).total.front_iterations};
    double off = disagreement(coupled, nested, 4, 51 * 41);
    print_message("solver: coupled and nested loops differ by %.1e, %ld and %ld passes\n", off,
                  passes[0], passes[1]);
    assert_below(off, 1e-4);
    assert_true(passes[1] > passes[0]);
}

/*
 * At the usual tolerance a cell that is about to fill may be a tip cell to one and a channel cell
 * to the other.
 */
static void linear_solvers_agree(void **state) {
    (void)state;
    static const double tolerance[] = {0, 1e-8};
    for (int k = 0; k < 2; k++) {
        host_scene scene = host_three_layers(51, 41);
        scene.options.tolerance = tolerance[k];
        scene.options.symmetry = k ? ILSA_SYMMETRY_AUTO : ILSA_SYMMETRY_NONE;
        scene.options.linear = ILSA_LINEAR_DENSE;
        ilsa_solver *dense = host_started(&scene, 7);
        scene.options.linear = ILSA_LINEAR_GMRES;
        ilsa_solver *gmres = host_started(&scene, 7);
        host_steps(gmres, 1);
        assert_true(host_summary(gmres).total.krylov_iterations > 0);
        assert_int_equal(ilsa_start_radial(gmres, 7), ILSA_OK);
        double off = disagreement(dense, gmres, 5, 51 * 41);
        print_message("solver: dense and GMRES differ by %.1e at tolerance %g\n", off,
                      tolerance[k]);
        assert_below(off, k ? 1e-7 : 4e-3);
    }
}

static void products_agree(void **state) {
    (void)state;
    host_scene scene = host_three_layers(51, 41);
    if (!ilsai_elasticity_has_fft())
        skip();
    scene.options.tolerance = 1e-8;
    scene.options.product = ILSA_PRODUCT_FFT;
    ilsa_solver *fft = host_started(&scene, 7);
    scene.options.product = ILSA_PRODUCT_BLAS;
    ilsa_solver *blas = host_started(&scene, 7);
    ilsa_model model;
    assert_int_equal(ilsa_get_model(blas, &model), ILSA_OK);
    assert_int_equal(model.product, ILSA_PRODUCT_BLAS);
    double off = disagreement(fft, blas, 5, 51 * 41);
    print_message("solver: FFT and BLAS differ by %.1e\n", off);
    assert_below(off, 1e-9);
}

/* Each level takes smaller steps and a sharper tolerance, and all come to the same radius. */
static void levels_trade_speed_for_accuracy(void **state) {
    (void)state;
    static const double step[] = ILSAI_LEVEL_STEP, tolerance[] = ILSAI_LEVEL_TOLERANCE;
    double radius[ILSAI_LEVELS];
    long steps = 0, least = 0;
    for (int level = 1; level <= ILSAI_LEVELS; level++) {
        host_scene scene = host_penny(1e-2, 61, 0.05);
        scene.options.level = level;
        ilsa_solver *solver = host_started(&scene, 0.6);
        ilsa_model model;
        assert_int_equal(ilsa_get_model(solver, &model), ILSA_OK);
        assert_true(model.level == level && model.step_cells == step[level - 1]);
        assert_true(model.tolerance == tolerance[level - 1]);
        ilsa_report report;
        assert_int_equal(ilsa_advance(solver, 4, &report), ILSA_OK);
        assert_true(report.front_change <= tolerance[level - 1]);
        assert_true(report.steps >= steps);
        steps = report.steps;
        least = level == 1 ? steps : least;
        radius[level - 1] = host_summary(solver).x_max;
        ilsa_solver_destroy(&solver);
    }
    assert_true(steps > 3 * least / 2);
    for (int level = 1; level < ILSAI_LEVELS; level++)
        assert_true(fabs(radius[level - 1] / radius[ILSAI_LEVELS - 1] - 1) < 0.01);
    print_message("solver: radius %.4f at level 1, %.4f at level 3, %.4f at level 5\n", radius[0],
                  radius[2], radius[4]);
}

static void options_override_the_level(void **state) {
    (void)state;
    host_scene scene = host_penny(1e-2, 61, 0.05);
    scene.options.step_cells = 0.3;
    scene.options.tolerance = 1e-6;
    ilsa_solver *solver = host_started(&scene, 0.6);
    ilsa_model model;
    ilsa_report report;
    assert_int_equal(ilsa_get_model(solver, &model), ILSA_OK);
    assert_true(model.step_cells == 0.3 && model.tolerance == 1e-6);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(ilsa_advance_one(solver, 1e9, &report), ILSA_OK);
        assert_true(report.front_change <= 1e-6);
    }
    assert_true(report.front_advance < 0.36);
    ilsa_solver_destroy(&solver);
}

/* Handles are independent: runs in four threads at once give the bits of a run alone. */
static void *run_in_thread(void *image) {
    host_scene scene = host_three_layers(61, 61);
    ilsa_solver *solver = host_started(&scene, 5);
    host_steps(solver, 12);
    *(host_image *)image = host_save(solver);
    ilsa_solver_destroy(&solver);
    return NULL;
}

static void threads_do_not_disturb_each_other(void **state) {
    (void)state;
    enum { THREADS = 4 };
    pthread_t thread[THREADS];
    host_image alone, image[THREADS];
    for (int t = 0; t < THREADS; t++)
        assert_int_equal(pthread_create(&thread[t], NULL, run_in_thread, &image[t]), 0);
    for (int t = 0; t < THREADS; t++)
        assert_int_equal(pthread_join(thread[t], NULL), 0);
    run_in_thread(&alone);
    for (int t = 0; t < THREADS; t++) {
        assert_true(host_same(&alone, &image[t]));
        host_free(&image[t]);
    }
    host_free(&alone);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_as_documented),
        cmocka_unit_test(create_needs_its_pointers),
        cmocka_unit_test(create_refuses_bad_integers),
        cmocka_unit_test(create_refuses_bad_numbers),
        cmocka_unit_test(create_refuses_bad_sources),
        cmocka_unit_test(create_refuses_what_does_not_match),
        cmocka_unit_test(create_refuses_toughness_without_any),
        cmocka_unit_test(destroy_takes_anything),
        cmocka_unit_test(symmetry_is_found_in_the_stress),
        cmocka_unit_test(symmetry_is_found_in_the_sources),
        cmocka_unit_test(symmetry_is_found_in_the_state),
        cmocka_unit_test(symmetry_is_lost_with_a_rate),
        cmocka_unit_test(start_refuses_bad_input),
        cmocka_unit_test(start_survives_extreme_numbers),
        cmocka_unit_test(absurd_units_are_refused),
        cmocka_unit_test(level_zero_is_the_default),
        cmocka_unit_test(message_of_a_getter_is_told_by_every_handle),
        cmocka_unit_test(absurd_stress_is_refused),
        cmocka_unit_test(radius_and_time_of_a_start_agree),
        cmocka_unit_test(a_start_replaces_the_fracture),
        cmocka_unit_test(set_rate_refuses_bad_input),
        cmocka_unit_test(set_stress_refuses_bad_input),
        cmocka_unit_test(pressure_rises_with_the_stress),
        cmocka_unit_test(steps_refuse_bad_calls),
        cmocka_unit_test(advance_refuses_bad_times),
        cmocka_unit_test(reports_add_up),
        cmocka_unit_test(fields_refuse_bad_calls),
        cmocka_unit_test(numbers_refuse_bad_calls),
        cmocka_unit_test(readings_agree),
        cmocka_unit_test(pressure_is_zero_outside),
        cmocka_unit_test(leaked_volume_is_not_negative),
        cmocka_unit_test(survey_cells_follow_the_asymptote),
        cmocka_unit_test(the_model_says_what_is_on),
        cmocka_unit_test(linear_solvers_agree),
        cmocka_unit_test(loops_agree),
        cmocka_unit_test(products_agree),
        cmocka_unit_test(levels_trade_speed_for_accuracy),
        cmocka_unit_test(options_override_the_level),
        cmocka_unit_test(threads_do_not_disturb_each_other),
    };
    return cmocka_run_group_tests_name("solver", tests, NULL, NULL);
}
