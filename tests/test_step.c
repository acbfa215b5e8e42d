/* The physics of a step: what it must conserve, leave alone, mirror and scale. */
#include "check.h"
#include "front/geometry.h"
#include "host.h"
#include "step/solver.h"
#include "tip/stress_step.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

enum { COUNT_MAX = 101 * 101 };

static double suggested(const ilsa_solver *solver) {
    double dt = 0;
    assert_int_equal(ilsa_suggest_dt(solver, &dt), ILSA_OK);
    assert_true(dt > 0 && isfinite(dt));
    return dt;
}

static void check_message(const char *message, const char *part) {
    if (!strstr(message, part))
        fail_msg("message '%s' does not contain '%s'", message, part);
}

static size_t cells_of(const ilsa_solver *solver) {
    ilsa_mesh_def mesh;
    assert_int_equal(ilsa_get_mesh_def(solver, &mesh), ILSA_OK);
    return (size_t)mesh.nx * (size_t)mesh.ny;
}

/* Two sources, layers, cells that are no squares, all three processes. */
static host_scene rich_scene(void) {
    host_scene scene = host_three_layers(71, 65);
    scene.mesh.dx = 1.1;
    scene.mesh.dy = 0.8;
    scene.sigma[0] = 7.25e6;
    scene.source_count = 2;
    scene.source[1] = (ilsa_source_def){3, 1.5, 0.004};
    return scene;
}

/* Volume */

/* A step of dt or half of it or a quarter, as a host tries; returns what was accepted. After a
 * shut-in with strong leak-off the cells at the front are about to close, and only short steps are
 * left. */
static double step_or_less(ilsa_solver *solver, double dt) {
    ilsa_status status = ilsa_step(solver, dt, NULL);
    for (int k = 0; k < 16 && status > 0; k++) {
        dt *= 0.5;
        status = ilsa_step(solver, dt, NULL);
    }
    assert_int_equal(status, ILSA_OK);
    return dt;
}

/* Steps and changes of rate; what was injected is what the rates say, and it is all there. */
static void check_volume(host_scene scene, double radius) {
    static const double factor[] = {1, 2, 0, 0, 0.3, 1, 1};
    ilsa_solver *solver = host_started(&scene, radius);
    ilsa_summary before = host_summary(solver);
    for (size_t k = 0; k < sizeof factor / sizeof *factor; k++) {
        double rate = 0, dt = 0.6 * suggested(solver);
        for (int n = 0; n < scene.source_count; n++) {
            double own = scene.source[n].rate * (n == 0 ? factor[k] : 1 - 0.5 * factor[k]);
            rate += own;
            assert_int_equal(ilsa_set_rate(solver, n, own), ILSA_OK);
        }
        dt = step_or_less(solver, dt);
        ilsa_summary now = host_summary(solver);
        double injected = before.volume_injected + rate * dt;
        assert_true(fabs(host_imbalance(solver)) <= 1e-12);
        assert_true(fabs(now.volume_injected / injected - 1) <= 1e-14);
        assert_true(fabs(now.volume_fracture / now.volume_injected - now.efficiency) <= 1e-15);
        assert_true(now.volume_leaked >= before.volume_leaked);
        assert_int_equal(now.volume_leaked > before.volume_leaked, scene.material.C_prime > 0);
        before = now;
    }
    ilsa_solver_destroy(&solver);
}

static void volume_is_conserved(void **unused) {
    (void)unused;
    const double phi[] = {0, 1e-2, 1};
    for (size_t k = 0; k < sizeof phi / sizeof *phi; k++) {
        host_scene scene = host_penny(phi[k], 41, 0.1);
        check_volume(scene, 0.9);
        scene.material.K_prime = 0;
        check_volume(scene, 0.9);
        scene.source[1] = (ilsa_source_def){-0.45, 0.35, 0.5};
        scene.source[2] = (ilsa_source_def){0.05, 0.5, 0.25}; /* on the edge between cells */
        scene.source_count = 3;
        check_volume(scene, 0.9);
    }
    check_volume(rich_scene(), 7);
}

/* Without injection and leak-off the same fluid spreads until the front comes to rest. */
static void shut_in_without_leak_off(void **unused) {
    (void)unused;
    host_scene scene = host_penny(0, 41, 0.05);
    ilsa_solver *solver = host_started(&scene, 0.5);
    host_steps(solver, 2);
    ilsa_summary first = host_summary(solver), last = first;
    assert_int_equal(ilsa_set_rate(solver, 0, 0), ILSA_OK);
    for (int k = 0; k < 45; k++) {
        host_steps(solver, 1);
        ilsa_summary now = host_summary(solver);
        assert_true(now.volume_injected == first.volume_injected);
        assert_true(fabs(host_imbalance(solver)) <= 1e-12);
        assert_true(now.x_max >= last.x_max);
        assert_true(now.width_source <= last.width_source * (1 + 1e-3));
        last = now;
    }
    /* A penny under uniform pressure with K_I = K': V = 2^(1/2) pi K' R^(5/2) / (3 E'). */
    double R = pow(3 * last.volume_fracture / (sqrt(2) * pi), 0.4);
    print_message("step: at rest at R = %.4f, %.2f %% off\n", last.x_max,
                  100 * (last.x_max / R - 1));
    assert_true(last.V_max * last.time < 1e-3 * R);
    assert_true(fabs(last.x_max / R - 1) < 0.025);
    ilsa_solver_destroy(&solver);
}

/* With leak-off the fracture empties; when it cannot go on it says that it closes. */
static void shut_in_with_leak_off(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1, 41, 0.05);
    ilsa_solver *solver = host_started(&scene, 0.5);
    host_steps(solver, 2);
    ilsa_summary first = host_summary(solver), last = first;
    assert_int_equal(ilsa_set_rate(solver, 0, 0), ILSA_OK);
    ilsa_status status = ILSA_OK;
    for (int k = 0; k < 100 && !status; k++) {
        host_image before = host_save(solver);
        status = ilsa_step(solver, 0.01 * last.time, NULL);
        assert_true(!status || host_is(solver, &before));
        ilsa_summary now = host_summary(solver);
        assert_true(now.volume_injected == first.volume_injected);
        assert_true(fabs(host_imbalance(solver)) <= 1e-12);
        assert_true(status || now.volume_leaked > last.volume_leaked);
        last = now;
        host_free(&before);
    }
    assert_int_equal(status, ILSA_CLOSED);
    check_message(ilsa_last_error(solver), "close");
    assert_true(last.volume_fracture < 0.7 * first.volume_fracture);
    ilsa_solver_destroy(&solver);
}

/* Refused steps */

/* The step is refused with the status, and neither the state nor the next step is another. */
static void check_untouched(ilsa_solver *solver, double dt, ilsa_status expected) {
    host_image before = host_save(solver);
    double next = 0.5 * suggested(solver);
    host_step(solver, next);
    host_image after = host_save(solver);
    host_restore(solver, &before);
    ilsa_report report = {.time = -1};
    assert_int_equal(ilsa_step(solver, dt, &report), expected);
    assert_true(report.time == host_summary(solver).time && report.steps == 0);
    assert_true(strlen(ilsa_last_error(solver)) > 0);
    assert_true(host_is(solver, &before));
    host_step(solver, next);
    assert_true(host_is(solver, &after));
    host_restore(solver, &before);
    host_free(&before);
    host_free(&after);
}

static void refused_steps_change_nothing(void **unused) {
    (void)unused;
    host_scene scenes[] = {rich_scene(), host_penny(1, 41, 0.1), host_penny(0, 41, 0.1)};
    static const double bad[] = {0, -1, NAN, INFINITY, -INFINITY, 1e-30};
    for (size_t n = 0; n < 3; n++) {
        ilsa_solver *solver = host_started(&scenes[n], n == 0 ? 7 : 0.9);
        host_steps(solver, 3);
        for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
            check_untouched(solver, bad[k], ILSA_ERR_VALUE);
            assert_non_null(strstr(ilsa_last_error(solver), "dt = "));
        }
        int refused = 0;
        for (int k = 0; k < 14; k++) {
            double factor = 2 * pow(7, k);
            host_image before = host_save(solver);
            ilsa_status status = ilsa_step(solver, factor * suggested(solver), NULL);
            assert_true(status >= 0);
            refused += status > 0;
            assert_true(status == ILSA_OK || host_is(solver, &before));
            host_restore(solver, &before);
            host_free(&before);
            if (status)
                check_untouched(solver, factor * suggested(solver), status);
        }
        assert_true(refused >= 8);
        ilsa_solver_destroy(&solver);
    }
}

/* Small steps are steps, down to the last bit of the clock. */
static void small_steps_are_taken(void **unused) {
    (void)unused;
    host_scene scene = rich_scene();
    ilsa_solver *solver = host_started(&scene, 7);
    host_steps(solver, 3);
    host_image start = host_save(solver);
    double whole = suggested(solver), time = host_summary(solver).time;
    for (int k = 1; k <= 13; k++) {
        double factor = pow(10, -k);
        host_restore(solver, &start);
        ilsa_summary before = host_summary(solver);
        host_step(solver, factor * whole);
        ilsa_summary now = host_summary(solver);
        assert_true(fabs(host_imbalance(solver)) <= 1e-12);
        assert_true(now.time == time + factor * whole && now.x_max >= before.x_max);
        assert_true(fabs(now.width_source / before.width_source - 1) < 0.1 * factor + 1e-5);
    }
    host_free(&start);
    ilsa_solver_destroy(&solver);
}

static void mesh_edge_is_its_own_status(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1e-2, 31, 0.05);
    ilsa_solver *solver = host_started(&scene, 0.5);
    ilsa_status status = ILSA_OK;
    double dt = 0;
    while (status == ILSA_OK) {
        dt = suggested(solver);
        status = ilsa_step(solver, dt, NULL);
    }
    assert_int_equal(status, ILSA_MESH_EDGE);
    check_message(ilsa_last_error(solver), "edge of the mesh");
    /* Half a mesh is 0.775: the footprint may come within one cell of it. */
    assert_true(host_summary(solver).x_max > 0.64 && host_summary(solver).x_max < 0.75);
    host_image before = host_save(solver);
    assert_int_equal(ilsa_step(solver, dt, NULL), ILSA_MESH_EDGE);
    assert_int_equal(ilsa_advance_one(solver, 1e9, NULL), ILSA_MESH_EDGE);
    assert_int_equal(ilsa_advance(solver, 1e9, NULL), ILSA_MESH_EDGE);
    assert_true(host_is(solver, &before));
    host_free(&before);
    ilsa_solver_destroy(&solver);
}

/* Sources inject where there is no fracture: refused, until their rate is zero. */
static void source_outside_the_fracture(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1e-2, 41, 0.1);
    scene.source_count = 2;
    scene.source[1] = (ilsa_source_def){1.5, 0.2, 0.5};
    ilsa_solver *solver = host_started(&scene, 0.8);
    host_image before = host_save(solver);
    assert_int_equal(ilsa_step(solver, suggested(solver), NULL), ILSA_ERR_STATE);
    check_message(ilsa_last_error(solver), "source 1");
    assert_true(host_is(solver, &before));
    assert_int_equal(ilsa_advance_one(solver, 1e9, NULL), ILSA_ERR_STATE);
    assert_true(host_is(solver, &before));
    assert_int_equal(ilsa_set_rate(solver, 1, 0), ILSA_OK);
    while (host_summary(solver).x_max < 1.6)
        host_steps(solver, 1);
    assert_int_equal(ilsa_set_rate(solver, 1, 0.5), ILSA_OK);
    host_steps(solver, 2);
    assert_true(fabs(host_imbalance(solver)) <= 1e-12);
    host_free(&before);
    ilsa_solver_destroy(&solver);
}

/* Mirror images */

/* How a cell, a place and a scene are turned. */
enum { FLIP_X = 1, FLIP_Y = 2, TRANSPOSE = 4, TURNS = 8 };

static int turned_cell(const ilsa_mesh_def *mesh, int i, int j, int turn) {
    i = turn & FLIP_X ? mesh->nx - 1 - i : i;
    j = turn & FLIP_Y ? mesh->ny - 1 - j : j;
    return turn & TRANSPOSE ? i * mesh->ny + j : j * mesh->nx + i;
}

static ilsa_source_def turned_source(ilsa_source_def source, int turn) {
    double x = turn & FLIP_X ? -source.x : source.x, y = turn & FLIP_Y ? -source.y : source.y;
    return (ilsa_source_def){turn & TRANSPOSE ? y : x, turn & TRANSPOSE ? x : y, source.rate};
}

static host_scene turned(const host_scene *scene, int turn, double *cells) {
    host_scene out = *scene;
    const ilsa_mesh_def *mesh = &scene->mesh;
    if (turn & TRANSPOSE)
        out.mesh = (ilsa_mesh_def){mesh->ny, mesh->nx, mesh->dy, mesh->dx};
    for (int n = 0; n < scene->source_count; n++)
        out.source[n] = turned_source(scene->source[n], turn);
    for (int j = 0; j < mesh->ny; j++)
        for (int i = 0; i < mesh->nx; i++)
            cells[turned_cell(mesh, i, j, turn)] = scene->cells[j * mesh->nx + i];
    out.cells = cells;
    return out;
}

/* Largest difference of a field and its turned image, over the largest value. */
static double turned_difference(const ilsa_mesh_def *mesh, const double *a, const double *b,
                                int turn) {
    double worst = NOTHING_YET, largest = 0;
    for (int j = 0; j < mesh->ny; j++)
        for (int i = 0; i < mesh->nx; i++) {
            double value = a[j * mesh->nx + i];
            largest = larger_of(largest, fabs(value));
            worst = worst_of(worst, fabs(value - b[turned_cell(mesh, i, j, turn)]));
        }
    return worst / largest;
}

/* A scene without any symmetry. */
static host_scene skew_scene(double *cells) {
    host_scene scene = host_penny(1, 38, 0.1);
    scene.mesh.ny = 33;
    scene.mesh.dy = 0.12;
    scene.source_count = 2;
    scene.source[0].x = 0.07;
    scene.source[1] = (ilsa_source_def){0.3, -0.2, 0.3};
    for (int j = 0; j < scene.mesh.ny; j++)
        for (int i = 0; i < scene.mesh.nx; i++)
            cells[j * scene.mesh.nx + i] = 0.01 * (i % 5) + 0.02 * (j > 20) + 0.004 * i;
    scene.cells = cells;
    return scene;
}

/* Pressures of tip cells that are hardly wet are the least certain of all. */
static void check_turns(double tolerance, double allowed_width, double allowed_pressure) {
    static double cells[38 * 33], turned_cells[38 * 33];
    host_scene scene = skew_scene(cells);
    scene.options.tolerance = tolerance;
    double worst = NOTHING_YET, worst_pressure = NOTHING_YET;
    for (int turn = 1; turn < TURNS; turn++) {
        host_scene image = turned(&scene, turn, turned_cells);
        ilsa_solver *a = host_started(&scene, 0.8), *b = host_started(&image, 0.8);
        for (int k = 0; k < 8; k++) {
            double dt = 0.8 * suggested(a);
            host_step(a, dt);
            host_step(b, dt);
        }
        worst = worst_of(worst, turned_difference(&scene.mesh, host_width(a), host_width(b), turn));
        worst_pressure = worst_of(worst_pressure, turned_difference(&scene.mesh, host_pressure(a),
                                                                    host_pressure(b), turn));
        ilsa_solver_destroy(&a);
        ilsa_solver_destroy(&b);
    }
    print_message("step: turned scenes differ by %.1e in width, %.1e in pressure, tolerance %g\n",
                  worst, worst_pressure, tolerance);
    assert_below(worst, allowed_width);
    assert_below(worst_pressure, allowed_pressure);
}

/* Rounding is another in a turned scene; what iterating leaves of it shrinks with the tolerance. */
static void mirrored_scenes_give_mirrored_answers(void **unused) {
    (void)unused;
    check_turns(1e-7, 1e-9, 1e-4);
    check_turns(0, 1e-6, 1e-2);
}

/* Symmetric scenes on their half or quarter and whole. */

static double difference(const double *a, const double *b, size_t count) {
    double worst = NOTHING_YET, largest = 0;
    for (size_t k = 0; k < count; k++) {
        worst = worst_of(worst, fabs(a[k] - b[k]));
        largest = larger_of(largest, fabs(a[k]));
    }
    return worst / largest;
}

static int mirrored_bits(const ilsa_mesh_def *mesh, const double *a, int about_x, int about_y) {
    int same = 1;
    for (int j = 0; j < mesh->ny; j++)
        for (int i = 0; i < mesh->nx; i++) {
            double here = a[j * mesh->nx + i];
            same &= !about_x || here == a[j * mesh->nx + mesh->nx - 1 - i];
            same &= !about_y || here == a[(mesh->ny - 1 - j) * mesh->nx + i];
        }
    return same;
}

/* Symmetric about x if sources and stress are; the stress is symmetric about y where asked for. */
static host_scene symmetric_scene(int nx, int ny, int about_y) {
    host_scene scene = host_three_layers(nx, ny);
    scene.sigma[0] = about_y ? scene.sigma[2] : 7.25e6;
    return scene;
}

static void check_fold(host_scene scene, ilsa_symmetry symmetry, double allowed) {
    scene.options.symmetry = symmetry;
    ilsa_solver *folded = host_started(&scene, 7);
    scene.options.symmetry = ILSA_SYMMETRY_NONE;
    ilsa_solver *whole = host_started(&scene, 7);
    for (int k = 0; k < 8; k++) {
        double dt = 0.9 * suggested(whole);
        host_step(folded, dt);
        host_step(whole, dt);
        assert_true(fabs(host_imbalance(folded)) <= 1e-12);
    }
    int about_x = symmetry != ILSA_SYMMETRY_Y, about_y = symmetry != ILSA_SYMMETRY_X;
    ilsa_model used;
    assert_int_equal(ilsa_get_model(folded, &used), ILSA_OK);
    assert_int_equal(used.symmetry, symmetry);
    assert_true(mirrored_bits(&scene.mesh, host_width(folded), about_x, about_y));
    ilsa_summary a = host_summary(folded), b = host_summary(whole);
    int fold = symmetry == ILSA_SYMMETRY_XY ? 4 : 2;
    assert_true(a.unknowns < 1.2 * b.unknowns / fold + 20);
    double off = difference(host_width(whole), host_width(folded), cells_of(whole));
    print_message("step: symmetry %d, %d x %d: %d unknowns for %d, width differs by %.1e\n",
                  (int)symmetry, scene.mesh.nx, scene.mesh.ny, a.unknowns, b.unknowns, off);
    assert_below(off, allowed);
    ilsa_solver_destroy(&folded);
    ilsa_solver_destroy(&whole);
}

static void folded_scenes_give_the_whole_answer(void **unused) {
    (void)unused;
    for (int n = 0; n < 4; n++) {
        int nx = 51 + n % 2, ny = 41 + n / 2;
        check_fold(symmetric_scene(nx, ny, 1), ILSA_SYMMETRY_XY, 1e-3);
        check_fold(symmetric_scene(nx, ny, 1), ILSA_SYMMETRY_Y, 1e-3);
        check_fold(symmetric_scene(nx, ny, 0), ILSA_SYMMETRY_X, 1e-3);
    }
}

/* With a sharp tolerance only rounding is left between the two. */
static void folding_is_exact_but_for_tolerance(void **unused) {
    (void)unused;
    for (int n = 0; n < 4; n++) {
        int nx = 51 + n % 2, ny = 41 + n / 2;
        for (int symmetry = ILSA_SYMMETRY_X; symmetry <= ILSA_SYMMETRY_XY; symmetry++) {
            host_scene scene = symmetric_scene(nx, ny, symmetry != ILSA_SYMMETRY_X);
            scene.options.tolerance = 1e-11;
            scene.options.linear = ILSA_LINEAR_GMRES;
            check_fold(scene, (ilsa_symmetry)symmetry, 1e-10);
        }
    }
}

/* Takes one of the three layers' stress for another in a running solver. */
static void set_layer(ilsa_solver *solver, const host_scene *scene, int layer, double sigma) {
    ilsa_stress_def zero = ilsa_stress_def_default();
    ilsa_stress *stress = NULL;
    double layers[HOST_LAYERS];
    memcpy(layers, scene->sigma, sizeof layers);
    layers[layer] = sigma;
    assert_int_equal(ilsa_stress_create(&zero, &stress), ILSA_OK);
    assert_int_equal(ilsa_stress_set_layers(stress, scene->interfaces, scene->interface_y, layers),
                     ILSA_OK);
    assert_int_equal(ilsa_set_stress(solver, stress), ILSA_OK);
    ilsa_stress_destroy(&stress);
}

/* What a quarter knows of its tip cells' pasts is known of their images when the host's stress
 * takes the symmetry away. */
static void a_quarter_unfolds(void **unused) {
    (void)unused;
    host_scene scene = symmetric_scene(51, 41, 1);
    ilsa_solver *solver[2];
    scene.options.tolerance = 1e-9;
    for (int k = 0; k < 2; k++) {
        scene.options.symmetry = k ? ILSA_SYMMETRY_NONE : ILSA_SYMMETRY_AUTO;
        solver[k] = host_started(&scene, 7);
    }
    for (int n = 0; n < 8; n++) {
        double dt = 0.5 * suggested(solver[0]);
        for (int k = 0; k < 2; k++) {
            if (n == 4)
                set_layer(solver[k], &scene, 0, 7.25e6);
            host_step(solver[k], dt);
            assert_true(fabs(host_imbalance(solver[k])) <= 1e-12);
        }
        ilsa_model used;
        assert_int_equal(ilsa_get_model(solver[0], &used), ILSA_OK);
        assert_int_equal(used.symmetry, n < 4 ? ILSA_SYMMETRY_XY : ILSA_SYMMETRY_X);
    }
    ilsa_summary a = host_summary(solver[0]), b = host_summary(solver[1]);
    double off = difference(host_width(solver[1]), host_width(solver[0]), cells_of(solver[1]));
    double leaked = fabs(a.volume_leaked / b.volume_leaked - 1);
    print_message("step: unfolded, width differs by %.1e, leaked by %.1e\n", off, leaked);
    assert_below(off, 1e-8);
    assert_below(leaked, 1e-8);
    for (int k = 0; k < 2; k++)
        ilsa_solver_destroy(&solver[k]);
}

/* Units */

/* Scales length, time and force. */
static host_scene rescaled(const host_scene *scene, double length, double time, double force) {
    host_scene out = *scene;
    double stress = force / (length * length);
    out.mesh.dx *= length;
    out.mesh.dy *= length;
    out.material.E_prime *= stress;
    out.material.mu_prime *= stress * time;
    out.material.K_prime *= stress * sqrt(length);
    out.material.C_prime *= length / sqrt(time);
    for (int k = 0; k < HOST_LAYERS; k++)
        out.sigma[k] *= stress;
    for (int k = 0; k < HOST_LAYERS - 1; k++)
        out.interface_y[k] *= length;
    for (int k = 0; k < scene->source_count; k++) {
        out.source[k].x *= length;
        out.source[k].y *= length;
        out.source[k].rate *= length * length * length / time;
    }
    return out;
}

/* Largest difference of widths times scale, over the largest. */
static double scaled_difference(const double *a, const double *b, double scale, size_t count) {
    double worst = NOTHING_YET, largest = 0;
    for (size_t k = 0; k < count; k++) {
        worst = worst_of(worst, fabs(a[k] * scale - b[k]));
        largest = larger_of(largest, fabs(b[k]));
    }
    return worst / largest;
}

/* The same steps of the scene in both units, by the solver's own choice. */
static double unit_difference(const host_scene *scene, double radius, double length, double time,
                              double force) {
    host_scene other = rescaled(scene, length, time, force);
    ilsa_solver *a = host_started(scene, radius), *b = host_started(&other, radius * length);
    for (int k = 0; k < 6; k++) {
        host_steps(a, 1);
        host_steps(b, 1);
    }
    size_t count = cells_of(a);
    double worst = scaled_difference(host_width(a), host_width(b), length, count);
    double stress = force / (length * length);
    worst = worst_of(worst, scaled_difference(host_pressure(a), host_pressure(b), stress, count));
    ilsa_summary p = host_summary(a), q = host_summary(b);
    worst = worst_of(worst, fabs(q.time / (p.time * time) - 1));
    worst = worst_of(worst, fabs(q.x_max / (p.x_max * length) - 1));
    worst = worst_of(worst, fabs(q.volume_leaked / (p.volume_leaked * pow(length, 3)) - 1));
    ilsa_solver_destroy(&a);
    ilsa_solver_destroy(&b);
    return worst;
}

/* Force scales exactly. Lengths and times pass through logarithms in the start: rounding is left.
 */
static void units_that_are_powers_of_two(void **unused) {
    (void)unused;
    host_scene scene = rich_scene();
    assert_true(unit_difference(&scene, 7, 1, 1, 0x1p30) == 0);
    assert_true(unit_difference(&scene, 7, 1, 1, 0x1p-25) == 0);
    double worst = unit_difference(&scene, 7, 0x1p12, 0x1p-18, 0x1p6);
    worst = worst_of(worst, unit_difference(&scene, 7, 0x1p-40, 0x1p40, 1));
    print_message("step: units of powers of two change the answer by %.1e\n", worst);
    assert_below(worst, 1e-9);
}

static void units_of_any_size(void **unused) {
    (void)unused;
    host_scene scene = rich_scene();
    static const double unit[] = {1e-12, 1e-6, 0.3048, 1e3, 1e12};
    double worst = NOTHING_YET;
    for (int k = 0; k < 5; k++) {
        worst = worst_of(worst, unit_difference(&scene, 7, unit[k], 1, 1));
        worst = worst_of(worst, unit_difference(&scene, 7, 1, unit[k], 1));
        worst = worst_of(worst, unit_difference(&scene, 7, 1, 1, unit[k]));
        worst =
            worst_of(worst, unit_difference(&scene, 7, unit[k], unit[4 - k], unit[(k + 2) % 5]));
    }
    print_message("step: other units change the answer by %.1e\n", worst);
    assert_below(worst, 1e-9);
}

/* Meshes */

/* The same penny at the same time on other meshes; returns the radius. */
static double radius_on(ilsa_mesh_def mesh, double x, double y, double *spread) {
    host_scene scene = host_penny(1e-2, 41, 0.05);
    scene.mesh = mesh;
    scene.source[0].x = x;
    scene.source[0].y = y;
    ilsa_solver *solver = host_started(&scene, 0.45);
    assert_int_equal(ilsa_advance(solver, 1.5, NULL), ILSA_OK);
    ilsa_summary now = host_summary(solver);
    double to[4] = {now.extent_x_max - x, x - now.extent_x_min, now.extent_y_max - y,
                    y - now.extent_y_min};
    double least = fmin(fmin(to[0], to[1]), fmin(to[2], to[3]));
    double most = fmax(fmax(to[0], to[1]), fmax(to[2], to[3]));
    assert_true(fabs(host_imbalance(solver)) <= 1e-12);
    ilsa_solver_destroy(&solver);
    *spread = (most - least) / most;
    return 0.25 * (to[0] + to[1] + to[2] + to[3]);
}

/* Oblong cells, even counts, sources on edges and corners of cells, or anywhere. */
static void the_mesh_does_not_matter(void **unused) {
    (void)unused;
    static const ilsa_mesh_def mesh[] = {
        {41, 41, 0.05, 0.05},  {40, 40, 0.05, 0.05}, {41, 40, 0.05, 0.05}, {61, 41, 0.033, 0.05},
        {40, 80, 0.05, 0.025}, {41, 41, 0.05, 0.05}, {41, 41, 0.05, 0.05}, {41, 40, 0.05, 0.05}};
    static const double place[][2] = {{0, 0}, {0, 0},         {0, 0},        {0, 0},
                                      {0, 0}, {0.025, 0.025}, {0.01, 0.007}, {0.025, 0.01}};
    double spread, first = radius_on(mesh[0], 0, 0, &spread);
    for (size_t k = 0; k < sizeof mesh / sizeof *mesh; k++) {
        double radius = radius_on(mesh[k], place[k][0], place[k][1], &spread);
        print_message("step: %d x %d of %.3f x %.3f, source (%g, %g): R %.4f, spread %.1e\n",
                      mesh[k].nx, mesh[k].ny, mesh[k].dx, mesh[k].dy, place[k][0], place[k][1],
                      radius, spread);
        assert_true(fabs(radius / first - 1) < 0.01);
        assert_true(spread < 0.025);
    }
}

/* The clock */

static void advance_lands_on_its_end(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1e-2, 61, 0.05);
    ilsa_solver *solver = host_started(&scene, 0.4);
    double time = host_summary(solver).time;
    long steps = 0;
    static const double factor[] = {1.0000001, 1.1, 1 / 3.0, 1.7, 1 + 1e-15, 1.01};
    for (size_t k = 0; k < sizeof factor / sizeof *factor; k++) {
        double end = factor[k] < 1 ? time + factor[k] : time * factor[k];
        ilsa_report report;
        assert_int_equal(ilsa_advance(solver, end, &report), ILSA_OK);
        assert_int_equal(ilsa_get_time(solver, &time), ILSA_OK);
        assert_true(time == end && report.time == end);
        assert_true(fabs(host_imbalance(solver)) <= 1e-12);
        steps += report.steps;
    }
    assert_int_equal(host_summary(solver).total.steps, steps);
    /* One step of those that it takes when the end is near. */
    double end = time + 1.5 * suggested(solver);
    assert_int_equal(ilsa_advance_one(solver, end, NULL), ILSA_OK);
    assert_true(host_summary(solver).time > time && host_summary(solver).time < end);
    for (int k = 0; k < 3 && host_summary(solver).time < end; k++)
        assert_int_equal(ilsa_advance_one(solver, end, NULL), ILSA_OK);
    assert_true(host_summary(solver).time == end);
    ilsa_solver_destroy(&solver);
}

/* A suggested step moves the front by what was asked for, and is never longer than dt_max. */
static void suggested_steps_fit(void **unused) {
    (void)unused;
    static const double cells[] = {0.1, 0.5, 1};
    for (size_t k = 0; k < sizeof cells / sizeof *cells; k++) {
        host_scene scene = host_penny(0, 81, 0.05);
        scene.options.step_cells = cells[k];
        ilsa_solver *solver = host_started(&scene, 1.2);
        ilsa_report report;
        assert_int_equal(ilsa_step(solver, suggested(solver), NULL), ILSA_OK);
        assert_int_equal(ilsa_step(solver, suggested(solver), &report), ILSA_OK);
        assert_true(report.front_advance > 0.75 * cells[k]);
        assert_true(report.front_advance < 1.25 * cells[k]);
        double dt = 0.3 * suggested(solver);
        scene.options.dt_max = dt;
        ilsa_solver *slow = host_started(&scene, 1.2);
        assert_true(suggested(slow) == dt);
        assert_int_equal(ilsa_advance_one(slow, 1e9, &report), ILSA_OK);
        assert_true(report.dt == dt);
        ilsa_solver_destroy(&solver);
        ilsa_solver_destroy(&slow);
    }
}

/* Most sums of a time and a step are not the end that was asked for. */
static void every_end_is_hit(void **unused) {
    (void)unused;
    host_scene scene = host_penny(0, 21, 0.1);
    ilsa_solver *solver = host_started(&scene, 0.4);
    double end = host_summary(solver).time;
    for (int k = 0; k < 100; k++) {
        end *= 1 + 1e-3 / (k + 1.7);
        assert_int_equal(ilsa_advance(solver, end, NULL), ILSA_OK);
        assert_true(host_summary(solver).time == end);
    }
    for (int k = 0; k < 30; k++) {
        double step;
        assert_int_equal(ilsa_suggest_dt(solver, &step), ILSA_OK);
        end += 0.11 * (k % 8 + 1) * step;
        assert_int_equal(ilsa_advance(solver, end, NULL), ILSA_OK);
        assert_true(host_summary(solver).time == end);
    }
    ilsa_solver_destroy(&solver);
}

/* What an advance learnt from a refused step wears off when the host steps by itself. */
static void suggestions_recover(void **unused) {
    (void)unused;
    host_scene scene = host_penny(0, 61, 0.05);
    ilsa_solver *solver = host_started(&scene, 0.9);
    host_steps(solver, 2);
    double whole = suggested(solver);
    solver->pace.dt_limit = 0.1 * whole;
    assert_true(suggested(solver) == 0.1 * whole);
    for (int k = 0; k < 7; k++)
        host_step(solver, suggested(solver));
    assert_true(suggested(solver) > 0.7 * whole);
    ilsa_solver_destroy(&solver);
}

/* Fronts at rest */

/* A penny that meets a layer of higher stress on both sides. */
static ilsa_solver *between_barriers(host_scene scene, double barrier) {
    scene.mesh.ny = 41;
    scene.interfaces = 2;
    scene.interface_y[0] = -0.625;
    scene.interface_y[1] = 0.625;
    scene.sigma[0] = scene.sigma[2] = barrier;
    return host_started(&scene, 0.55);
}

static void grow_along(ilsa_solver *solver, double half_length) {
    while (host_summary(solver).x_max < half_length) {
        host_steps(solver, 1);
        assert_true(fabs(host_imbalance(solver)) <= 1e-12);
    }
}

/* Survey cells whose front moves at less than a part of the fastest one's speed. */
static int slow_cells(ilsa_solver *solver, double part) {
    const ilsa_survey_point *points;
    size_t count;
    int slow = 0;
    assert_int_equal(ilsa_get_survey(solver, &points, &count), ILSA_OK);
    for (size_t k = 0; k < count; k++)
        slow += points[k].V < part * host_summary(solver).V_max;
    return slow;
}

/*
 * A front between barriers that it cannot enter creeps there or stays, and runs along. In the
 * barrier, the width at rest is that of K_I <= K' and of the lower stress behind.
 */
static void barriers_hold_the_front(void **unused) {
    (void)unused;
    host_scene scene = host_penny(0, 81, 0.05);
    ilsa_solver *solver = between_barriers(scene, 2);
    grow_along(solver, 1.2);
    ilsa_summary before = host_summary(solver);
    grow_along(solver, 1.6);
    ilsa_summary now = host_summary(solver);
    int slow = slow_cells(solver, 0.1);
    print_message("step: between barriers x %.3f, y %.3f, %d of %d survey cells slow, %d at rest\n",
                  now.x_max, now.y_max, slow, now.survey_cells, now.arrested_cells);
    assert_true(now.y_max < 0.7 && now.y_max - before.y_max < 0.02);
    assert_true(slow > now.survey_cells / 3 && slow < now.survey_cells * 3 / 4);
    assert_true(now.arrested_cells > 0);
    assert_true(now.V_max > 0 && now.arrested_cells < now.survey_cells);
    const ilsa_survey_point *points;
    size_t count;
    int held = 0;
    assert_int_equal(ilsa_get_survey(solver, &points, &count), ILSA_OK);
    for (size_t k = 0; k < count; k++) {
        double s = points[k].s, inside = fabs(points[k].y) - 0.625; /* E' = K' = 1 */
        held += points[k].V == 0 && inside >= 0;
        assert_true(points[k].V >= 0);
        assert_true(points[k].V > 0 || inside < 0 ||
                    points[k].w <= 1.02 * (sqrt(s) + 2 * ilsai_stress_step_width(s, inside + s)));
        assert_true(points[k].V > 0 || points[k].regime.N_k == 1);
    }
    assert_true(held > 0);
    ilsa_solver_destroy(&solver);
}

/* Smallest K_I / K' of the survey cells whose front moves. */
static double least_moving(ilsa_solver *solver) {
    const ilsa_survey_point *points;
    size_t count;
    double least = INFINITY;
    assert_int_equal(ilsa_get_survey(solver, &points, &count), ILSA_OK);
    for (size_t k = 0; k < count; k++)
        if (points[k].V > 0)
            least = smaller_of(least, points[k].w / sqrt(points[k].s));
    return least;
}

/* Where the front moves, the width is that of a moving front: K_I >= K'. */
static void moving_fronts_have_their_toughness(void **unused) {
    (void)unused;
    ilsa_solver *solver = between_barriers(host_penny(0, 81, 0.05), 2);
    grow_along(solver, 1.6);
    print_message("step: smallest K_I of a moving front %.3f K'\n", least_moving(solver));
    assert_above(least_moving(solver), 0.95);
    ilsa_solver_destroy(&solver);
}

/* Steps so small that the front moves by less than the tolerance still notice that it should rest.
 */
static void small_steps_come_to_rest(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1, 41, 0.05);
    ilsa_solver *solver = host_started(&scene, 0.5);
    host_steps(solver, 5);
    double time = host_summary(solver).time, least = INFINITY;
    assert_int_equal(ilsa_set_rate(solver, 0, 0), ILSA_OK);
    for (int k = 0; k < 80; k++) {
        assert_int_equal(ilsa_advance(solver, time * (1 + 1e-3 * (k + 1)), NULL), ILSA_OK);
        least = smaller_of(least, least_moving(solver));
    }
    print_message("step: smallest K_I of a front that moves while it empties %.3f K'\n", least);
    assert_above(least, 0.9);
    ilsa_solver_destroy(&solver);
}

/* The front never goes back, and the footprint never loses a cell. */
static void fronts_never_go_back(void **unused) {
    (void)unused;
    host_scene scene = rich_scene();
    ilsa_solver *solver = host_started(&scene, 7);
    static unsigned char before[COUNT_MAX];
    size_t count = cells_of(solver);
    memset(before, 0, count);
    for (int k = 0; k < 12; k++) {
        assert_int_equal(ilsa_set_rate(solver, 0, k % 3 == 2 ? 0.001 : 0.01), ILSA_OK);
        host_steps(solver, 1);
        const unsigned char *kind = host_kind(solver);
        const double *trigger = host_trigger(solver), *width = host_width(solver);
        double time = host_summary(solver).time;
        for (size_t c = 0; c < count; c++) {
            assert_true(kind[c] >= (before[c] > ILSA_CELL_SURVEY ? ILSA_CELL_SURVEY : before[c]) ||
                        (before[c] >= ILSA_CELL_SURVEY && kind[c] >= ILSA_CELL_SURVEY));
            assert_int_equal(width[c] > 0, kind[c] != ILSA_CELL_EMPTY);
            assert_true(!(kind[c] >= ILSA_CELL_SURVEY) || trigger[c] <= time);
            assert_true(kind[c] != ILSA_CELL_EMPTY || isinf(trigger[c]));
        }
        memcpy(before, kind, count);
    }
    ilsa_solver_destroy(&solver);
}

/*
 * A thin pay on a coarse mesh: in a row of survey cells with the front above and below, as after a
 * coarsening, the normals of both sides cancel, and the step would see no front or one lengthwise.
 */
static void a_row_one_cell_thick_has_its_front_at_its_sides(void **unused) {
    (void)unused;
    enum { SIZE = 21 };
    const ilsa_mesh_def mesh = {SIZE, SIZE, 0.1, 0.1};
    const grid g = ilsai_grid(&mesh, 0, 0);
    unsigned char kind[SIZE * SIZE];
    double level[SIZE * SIZE];
    for (int cell = 0; cell < SIZE * SIZE; cell++) {
        int i = cell % SIZE, j = cell / SIZE, row = i > 3 && i < 17, off = abs(j - 10);
        kind[cell] = row && off == 0   ? ILSA_CELL_SURVEY
                     : row && off == 1 ? ILSA_CELL_TIP
                                       : ILSA_CELL_EMPTY;
        level[cell] = off <= 2 ? 0.1 * off - 0.02 + (row ? 1e-17 * i : 0.1) : INFINITY;
    }
    const front_view view = {&g, kind, level, NULL, 1};
    survey_cell survey = {.cell = 10 * SIZE + 10, .s0 = 0.02, .h = 0.1};
    ilsai_geometry_set(&view, &survey, 1);
    assert_true(survey.sin_a > 0.999 && survey.cos_a < 0.01);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volume_is_conserved),
        cmocka_unit_test(a_row_one_cell_thick_has_its_front_at_its_sides),
        cmocka_unit_test(shut_in_without_leak_off),
        cmocka_unit_test(shut_in_with_leak_off),
        cmocka_unit_test(refused_steps_change_nothing),
        cmocka_unit_test(small_steps_are_taken),
        cmocka_unit_test(mesh_edge_is_its_own_status),
        cmocka_unit_test(source_outside_the_fracture),
        cmocka_unit_test(mirrored_scenes_give_mirrored_answers),
        cmocka_unit_test(folded_scenes_give_the_whole_answer),
        cmocka_unit_test(folding_is_exact_but_for_tolerance),
        cmocka_unit_test(a_quarter_unfolds),
        cmocka_unit_test(units_that_are_powers_of_two),
        cmocka_unit_test(units_of_any_size),
        cmocka_unit_test(the_mesh_does_not_matter),
        cmocka_unit_test(advance_lands_on_its_end),
        cmocka_unit_test(every_end_is_hit),
        cmocka_unit_test(suggested_steps_fit),
        cmocka_unit_test(suggestions_recover),
        cmocka_unit_test(barriers_hold_the_front),
        cmocka_unit_test(moving_fronts_have_their_toughness),
        cmocka_unit_test(small_steps_come_to_rest),
        cmocka_unit_test(fronts_never_go_back),
    };
    return cmocka_run_group_tests_name("step", tests, NULL, NULL);
}
