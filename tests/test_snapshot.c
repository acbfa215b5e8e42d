/* Snapshots: the same bits after a restore, and nothing changed by an image that is refused. */
#include "base/error.h"
#include "check.h"
#include "failing.h"
#include "host.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Where things stand in an image: header {magic[8], layout, version, size, checksum}, then body. */
enum { HEADER = 32, AT_LAYOUT = 8, AT_VERSION = 12, AT_CHECKSUM = 24 };

/* A small scene with everything on, and a solver some steps into it. */
static host_scene small_scene(void) {
    host_scene scene = host_three_layers(61, 61);
    scene.source_count = 2;
    scene.source[1] = (ilsa_source_def){2, 1, 0.002};
    return scene;
}

static ilsa_solver *running(const host_scene *scene, int steps) {
    ilsa_solver *solver = host_started(scene, 5);
    host_steps(solver, steps);
    return solver;
}

static void check_message(const char *message, const char *part) {
    if (!strstr(message, part))
        fail_msg("message '%s' does not contain '%s'", message, part);
}

/* Sizes */

static void size_is_asked_first(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = running(&scene, 3);
    size_t size = 77;
    assert_int_equal(ilsa_snapshot_save(solver, NULL, &size), ILSA_OK);
    assert_true(size > 1000);
    size_t again = 0, room = size + 64;
    assert_int_equal(ilsa_snapshot_save(solver, NULL, &again), ILSA_OK);
    assert_int_equal(again, size);
    unsigned char *buffer = malloc(room);
    assert_non_null(buffer);
    memset(buffer, 0x5a, room);
    assert_int_equal(ilsa_snapshot_save(solver, buffer, &room), ILSA_OK);
    assert_int_equal(room, size);
    for (size_t k = size; k < size + 64; k++)
        assert_int_equal(buffer[k], 0x5a);
    assert_int_equal(ilsa_snapshot_restore(solver, buffer, size), ILSA_OK);
    free(buffer);
    ilsa_solver_destroy(&solver);
}

static void small_buffer_is_not_touched(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = running(&scene, 2);
    host_image image = host_save(solver);
    const size_t rooms[] = {0, 1, HEADER, image.size / 2, image.size - 1};
    for (size_t k = 0; k < sizeof rooms / sizeof *rooms; k++) {
        size_t size = rooms[k];
        memset(image.bytes, 0x5a, image.size);
        assert_int_equal(ilsa_snapshot_save(solver, image.bytes, &size), ILSA_NO_SPACE);
        assert_int_equal(size, image.size);
        check_message(ilsa_last_error(NULL), "buffer");
        for (size_t b = 0; b < image.size; b++)
            assert_int_equal(image.bytes[b], 0x5a);
    }
    host_free(&image);
    ilsa_solver_destroy(&solver);
}

static void bad_arguments_are_refused(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = host_solver(&scene);
    size_t size = 5;
    unsigned char byte = 7;
    assert_int_equal(ilsa_snapshot_save(solver, &byte, &size), ILSA_ERR_STATE);
    check_message(ilsa_last_error(NULL), "ilsa_start_radial");
    assert_int_equal(ilsa_snapshot_save(NULL, &byte, &size), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "solver");
    assert_int_equal(ilsa_start_radial(solver, 5), ILSA_OK);
    assert_int_equal(ilsa_snapshot_save(solver, &byte, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "size");
    assert_true(size == 5 && byte == 7);
    host_image image = host_save(solver);
    assert_int_equal(ilsa_snapshot_restore(NULL, image.bytes, image.size), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "solver");
    assert_int_equal(ilsa_snapshot_restore(solver, NULL, image.size), ILSA_ERR_NULL);
    check_message(ilsa_last_error(solver), "buffer");
    assert_true(host_is(solver, &image));
    host_free(&image);
    ilsa_solver_destroy(&solver);
}

/* The same bits */

/* Two solvers that did the same have the same image: nothing undefined gets into it. */
static void equal_states_have_equal_images(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *a = running(&scene, 6);
    free(memset(malloc(100000), 0x77, 100000));
    ilsa_solver *b = running(&scene, 6);
    host_image image = host_save(a);
    assert_true(host_is(a, &image));
    assert_true(host_is(b, &image));
    host_steps(b, 1);
    assert_false(host_is(b, &image));
    host_free(&image);
    ilsa_solver_destroy(&a);
    ilsa_solver_destroy(&b);
}

/* Steps dt from an image of the state, twice; the solver ends where the first step led. */
static void check_round_trip(ilsa_solver *solver, double dt) {
    host_image start = host_save(solver);
    host_step(solver, dt);
    host_image first = host_save(solver);
    assert_false(host_same(&start, &first));
    host_restore(solver, &start);
    assert_true(host_is(solver, &start));
    host_step(solver, dt);
    assert_true(host_is(solver, &first));
    host_free(&start);
    host_free(&first);
}

/* The other solver, whatever it did before, goes on from the image of this one with the same bits.
 */
static void check_transfer(ilsa_solver *from, ilsa_solver *to, int steps) {
    host_image start = host_save(from);
    host_restore(to, &start);
    assert_true(host_is(to, &start));
    host_steps(from, steps);
    host_steps(to, steps);
    host_image end = host_save(from);
    assert_true(host_is(to, &end));
    host_restore(from, &start);
    host_free(&start);
    host_free(&end);
}

/* 3600 s of the symmetric scene with a step taken back every 36 s. */
static void hundred_steps_taken_back(void **state) {
    (void)state;
    enum { POINTS = 100 };
    host_scene scene = host_three_layers(325, 95);
    ilsa_solver *solver = host_started(&scene, 5), *other = host_solver(&scene);
    double time = 0, dt;
    int points = 0;
    for (int k = 1; k <= POINTS; k++) {
        while (time < (k - 0.5) * 3600 / POINTS) {
            host_steps(solver, 1);
            assert_int_equal(ilsa_get_time(solver, &time), ILSA_OK);
        }
        assert_int_equal(ilsa_suggest_dt(solver, &dt), ILSA_OK);
        check_round_trip(solver, k % 3 == 0 ? 0.6 * dt : dt);
        assert_int_equal(ilsa_get_time(solver, &time), ILSA_OK);
        points++;
        if (k % 20 == 0)
            check_transfer(solver, other, 1);
    }
    print_message("snapshot: %d steps taken back until %g s, %d cells\n", points, time,
                  host_summary(solver).cells);
    assert_true(time > 3560);
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&other);
}

/* Without leak-off, without toughness, off centre, uniform and per-cell stress, every solver. */
static void other_scenes_resume(void **state) {
    (void)state;
    double cells[41 * 41];
    for (int k = 0; k < 41 * 41; k++)
        cells[k] = 0.01 * (k % 7);
    for (int n = 0; n < 8; n++) {
        host_scene scene = host_penny(n % 2, 41, 0.1);
        scene.material.K_prime = n == 2 ? 0 : 1;
        scene.source[0].x = n == 3 ? 0.33 : 0;
        scene.cells = n >= 4 ? cells : NULL;
        scene.options.linear = n == 5 ? ILSA_LINEAR_DENSE : ILSA_LINEAR_AUTO;
        scene.options.product = n == 6 ? ILSA_PRODUCT_BLAS : ILSA_PRODUCT_AUTO;
        ilsa_solver *solver = host_started(&scene, 0.5), *other = host_started(&scene, 1.2);
        host_steps(solver, 3);
        double dt;
        assert_int_equal(ilsa_suggest_dt(solver, &dt), ILSA_OK);
        check_round_trip(solver, 0.8 * dt);
        host_steps(other, 2);
        check_transfer(solver, other, 3);
        ilsa_solver_destroy(&solver);
        ilsa_solver_destroy(&other);
    }
}

/* Fields outside the old and the new footprint too: nothing of the larger fracture is left. */
static void restore_clears_what_was_there(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 81, 0.05);
    ilsa_solver *small = host_started(&scene, 0.3), *large = host_started(&scene, 1.5);
    host_steps(large, 2);
    host_image image = host_save(small);
    host_restore(large, &image);
    const size_t count = (size_t)81 * 81, bytes = count * sizeof(double);
    assert_memory_equal(host_width(small), host_width(large), bytes);
    assert_memory_equal(host_pressure(small), host_pressure(large), bytes);
    assert_memory_equal(host_trigger(small), host_trigger(large), bytes);
    assert_memory_equal(host_kind(small), host_kind(large), count);
    host_free(&image);
    ilsa_solver_destroy(&small);
    ilsa_solver_destroy(&large);
}

static void rates_and_stress_come_back(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = running(&scene, 2);
    host_image image = host_save(solver);
    host_steps(solver, 2);
    host_image later = host_save(solver);
    ilsa_stress *stress;
    ilsa_stress_def def = {1e6};
    assert_int_equal(ilsa_stress_create(&def, &stress), ILSA_OK);
    assert_int_equal(ilsa_set_stress(solver, stress), ILSA_OK);
    assert_int_equal(ilsa_set_rate(solver, 0, 0.5), ILSA_OK);
    assert_int_equal(ilsa_set_rate(solver, 1, 0), ILSA_OK);
    host_restore(solver, &image);
    assert_true(host_is(solver, &image));
    const double *sigma;
    assert_int_equal(ilsa_get_stress(solver, &sigma), ILSA_OK);
    assert_true(sigma[0] == 7.75e6 && sigma[61 * 61 / 2] == 7e6);
    host_steps(solver, 2);
    assert_true(host_is(solver, &later));
    host_free(&image);
    host_free(&later);
    ilsa_stress_destroy(&stress);
    ilsa_solver_destroy(&solver);
}

/* Across ilsa_coarsen in both directions, odd and even counts, with per-cell stress as well. */
static void coarsened_states_resume(void **state) {
    (void)state;
    for (int n = 40; n <= 41; n++) {
        double cells[41 * 41];
        for (int k = 0; k < n * n; k++)
            cells[k] = 0.01 * (k % 5);
        host_scene scene = host_penny(1, n, 0.1);
        scene.cells = cells;
        scene.source[0].x = 0.23; /* in another column of the coarse mesh */
        ilsa_solver *solver = host_started(&scene, 1.2), *fresh = host_started(&scene, 0.5);
        host_steps(solver, 1);
        host_image fine = host_save(solver);
        assert_int_equal(ilsa_coarsen(solver), ILSA_OK);
        host_image coarse = host_save(solver);
        check_transfer(solver, fresh, 2); /* the fresh one becomes coarse */
        host_steps(solver, 2);
        host_restore(solver, &fine); /* and this one fine again */
        assert_true(host_is(solver, &fine));
        assert_int_equal(ilsa_coarsen(solver), ILSA_OK);
        assert_true(host_is(solver, &coarse));
        ilsa_mesh_def mesh;
        assert_int_equal(ilsa_get_mesh_def(fresh, &mesh), ILSA_OK);
        assert_true(mesh.dx == 0.2 && mesh.dy == 0.2 && mesh.nx == n);
        host_free(&fine);
        host_free(&coarse);
        ilsa_solver_destroy(&solver);
        ilsa_solver_destroy(&fresh);
    }
}

/* The image of a solver that was coarsened along one direction alone. */
static void oblong_states_resume(void **state) {
    (void)state;
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_solver *solver = host_started(&scene, 1.2), *fresh = host_started(&scene, 0.5);
    assert_int_equal(ilsa_coarsen_along(solver, ILSA_ALONG_Y), ILSA_OK);
    check_transfer(solver, fresh, 2);
    ilsa_mesh_def mesh;
    assert_int_equal(ilsa_get_mesh_def(fresh, &mesh), ILSA_OK);
    assert_true(mesh.dx == 0.1 && mesh.dy == 0.2);
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&fresh);
}

/* The image of a solver whose mesh has grown, into one whose mesh has not, and back. */
static void grown_states_resume(void **state) {
    (void)state;
    for (int n = 40; n <= 41; n++) {
        static double cells[41 * 41];
        for (int k = 0; k < n * n; k++)
            cells[k] = 0.01 * (k % 5);
        host_scene scene = host_penny(1, n, 0.1);
        scene.cells = cells;
        ilsa_solver *solver = host_started(&scene, 1.2), *fresh = host_started(&scene, 0.5);
        host_steps(solver, 1);
        host_image small = host_save(solver);
        assert_int_equal(ilsa_grow(solver, 3, 6), ILSA_OK);
        host_image large = host_save(solver);
        check_transfer(solver, fresh, 2);
        host_steps(solver, 2);
        host_restore(solver, &small);
        assert_true(host_is(solver, &small));
        check_transfer(solver, fresh, 2);
        ilsa_mesh_def mesh;
        assert_int_equal(ilsa_get_mesh_def(fresh, &mesh), ILSA_OK);
        assert_true(mesh.nx == n && mesh.ny == n);
        assert_int_equal(ilsa_grow(solver, 3, 6), ILSA_OK);
        assert_true(host_is(solver, &large));
        assert_int_equal(ilsa_coarsen(solver), ILSA_OK); /* both at once */
        check_transfer(solver, fresh, 2);
        host_free(&small);
        host_free(&large);
        ilsa_solver_destroy(&solver);
        ilsa_solver_destroy(&fresh);
    }
}

/* A state that has lost its symmetry has lost it in the image too, though the scene has it again.
 */
static void lost_symmetry_stays_lost(void **state) {
    (void)state;
    host_scene scene = host_penny(0, 41, 0.1);
    scene.source_count = 3;
    scene.source[1] = (ilsa_source_def){0.3, 0, 0.5};
    scene.source[2] = (ilsa_source_def){-0.3, 0, 0.5};
    ilsa_solver *solver = host_started(&scene, 0.9), *other = host_started(&scene, 0.9);
    ilsa_model model;
    assert_int_equal(ilsa_get_model(other, &model), ILSA_OK);
    assert_int_equal(model.symmetry, ILSA_SYMMETRY_XY);
    assert_int_equal(ilsa_set_rate(solver, 1, 0.1), ILSA_OK);
    host_steps(solver, 2);
    assert_int_equal(ilsa_set_rate(solver, 1, 0.5), ILSA_OK);
    host_image image = host_save(solver);
    host_restore(other, &image);
    assert_int_equal(ilsa_get_model(other, &model), ILSA_OK);
    assert_int_equal(model.symmetry, ILSA_SYMMETRY_Y);
    host_free(&image);
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&other);
}

/* Refused images */

/* The image is refused, with a message, and the solver is bit for bit what it was. */
static void check_refused(ilsa_solver *solver, const host_image *before, const void *bytes,
                          size_t size, ilsa_status expected, const char *part) {
    assert_int_equal(ilsa_snapshot_restore(solver, bytes, size), expected);
    check_message(ilsa_last_error(solver), part);
    assert_true(host_is(solver, before));
}

static void foreign_images_are_refused(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = running(&scene, 2);
    host_image before = host_save(solver);
    unsigned char *noise = calloc(before.size, 1);
    assert_non_null(noise);
    check_refused(solver, &before, noise, before.size, ILSA_ERR_SNAPSHOT, "not a snapshot");
    for (size_t k = 0; k < before.size; k++)
        noise[k] = (unsigned char)(k * 2654435761u >> 13);
    check_refused(solver, &before, noise, before.size, ILSA_ERR_SNAPSHOT, "not a snapshot");
    check_refused(solver, &before, noise, 0, ILSA_ERR_SNAPSHOT, "truncated");
    free(noise);
    host_free(&before);
    ilsa_solver_destroy(&solver);
}

static void every_length_but_one_is_refused(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = running(&scene, 2);
    host_image before = host_save(solver);
    unsigned char *longer = malloc(before.size + 8);
    assert_non_null(longer);
    memcpy(longer, before.bytes, before.size);
    memset(longer + before.size, 0, 8);
    size_t stride = host_long() ? 1 : 97;
    for (size_t size = 0; size < before.size; size += size < 2048 ? 1 : stride) {
        /* A copy of just that size: AddressSanitizer sees what is read beyond it. */
        unsigned char *cut = malloc(size ? size : 1);
        assert_non_null(cut);
        memcpy(cut, before.bytes, size);
        ilsa_status status = ilsa_snapshot_restore(solver, cut, size);
        assert_int_equal(status, ILSA_ERR_SNAPSHOT);
        check_message(ilsa_last_error(solver), "truncated");
        free(cut);
    }
    for (size_t size = before.size + 1; size <= before.size + 8; size++)
        assert_int_equal(ilsa_snapshot_restore(solver, longer, size), ILSA_ERR_SNAPSHOT);
    assert_true(host_is(solver, &before));
    free(longer);
    host_free(&before);
    ilsa_solver_destroy(&solver);
}

static void every_altered_byte_is_noticed(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = running(&scene, 2);
    host_image before = host_save(solver), altered = host_save(solver);
    size_t stride = host_long() ? 1 : 61;
    for (size_t at = 0; at < before.size; at += at < 1024 ? 1 : stride)
        for (unsigned bit = 0; bit < 8; bit += host_long() ? 1 : 7) {
            altered.bytes[at] ^= (unsigned char)(1u << bit);
            assert_int_equal(ilsa_snapshot_restore(solver, altered.bytes, altered.size),
                             ILSA_ERR_SNAPSHOT);
            altered.bytes[at] = before.bytes[at];
        }
    assert_true(host_is(solver, &before));
    assert_int_equal(ilsa_snapshot_restore(solver, altered.bytes, altered.size), ILSA_OK);
    host_free(&before);
    host_free(&altered);
    ilsa_solver_destroy(&solver);
}

static void other_versions_are_refused(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = running(&scene, 2);
    host_image before = host_save(solver), altered = host_save(solver);
    altered.bytes[AT_VERSION]++;
    check_refused(solver, &before, altered.bytes, altered.size, ILSA_ERR_SNAPSHOT, "version");
    altered.bytes[AT_VERSION]--;
    altered.bytes[AT_LAYOUT]++;
    check_refused(solver, &before, altered.bytes, altered.size, ILSA_ERR_SNAPSHOT, "layout");
    host_free(&before);
    host_free(&altered);
    ilsa_solver_destroy(&solver);
}

/* One after the other, everything that makes another definition. */
enum { DEFINITIONS = 25 };

static void alter_numerics(host_scene *scene, int which) {
    ilsa_solver_def *def = &scene->options;
    switch (which) {
    case 0:
        def->level = 4;
        break;
    case 1:
        def->symmetry = ILSA_SYMMETRY_NONE;
        break;
    case 2:
        def->linear = ILSA_LINEAR_GMRES;
        break;
    case 3:
        def->product = ILSA_PRODUCT_BLAS;
        break;
    case 4:
        def->coarsen = 1;
        break;
    case 5:
        def->step_cells = 0.4;
        break;
    case 6:
        def->tolerance = 1e-4;
        break;
    case 7:
        def->tip = ILSA_TIP_TOUGHNESS_VISCOSITY;
        break;
    case 8:
        def->tip = ILSA_TIP_TOUGHNESS;
        break;
    default:
        def->dt_max = 100;
    }
}

static void alter_material(host_scene *scene, int which) {
    double *value = which == 0   ? &scene->material.E_prime
                    : which == 1 ? &scene->material.mu_prime
                    : which == 2 ? &scene->material.K_prime
                                 : &scene->material.C_prime;
    *value *= 1 + 1e-15 * (1 << which);
    *value = which == 4 ? 0 : *value;
}

static void alter_mesh(host_scene *scene, int which) {
    ilsa_mesh_def *mesh = &scene->mesh;
    mesh->nx += which == 0 ? 2 : 0;
    mesh->ny -= which == 1 ? 2 : 0;
    mesh->dx *= which == 2 ? 2 : which == 4 ? 3 : which == 5 ? 1.5 : 1;
    mesh->dy *= which == 3 ? 2 : which == 4 ? 3 : which == 5 ? 1.5 : 1;
}

static void alter_sources(host_scene *scene, int which) {
    scene->source_count += which == 0 ? 1 : which == 1 ? -1 : 0;
    scene->source[1].x += which == 2 ? 2 : 0;
    scene->source[0].y += which == 3 ? 1e-3 : 0;
}

static void alter(host_scene *scene, int which) {
    if (which < 10)
        alter_numerics(scene, which);
    else if (which < 15)
        alter_material(scene, which - 10);
    else if (which < 21)
        alter_mesh(scene, which - 15);
    else
        alter_sources(scene, which - 21);
}

static void other_definitions_are_refused(void **state) {
    (void)state;
    host_scene scene = small_scene();
    scene.source[2] = (ilsa_source_def){-1, -1, 0};
    ilsa_solver *solver = running(&scene, 2), *other;
    host_image image = host_save(solver);
    for (int which = 0; which < DEFINITIONS; which++) {
        host_scene altered = scene;
        alter(&altered, which);
        other = host_started(&altered, 7);
        host_image before = host_save(other);
        ilsa_status status = ilsa_snapshot_restore(other, image.bytes, image.size);
        if (status != ILSA_ERR_MISMATCH)
            fail_msg("definition %d: status %d", which, status);
        check_message(ilsa_last_error(other), "another definition");
        assert_true(host_is(other, &before));
        host_free(&before);
        ilsa_solver_destroy(&other);
    }
    host_free(&image);
    ilsa_solver_destroy(&solver);
}

/* What is refused without a fracture leaves the solver without one. */
static void refusal_without_a_fracture(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = running(&scene, 2), *empty = host_solver(&scene);
    host_image image = host_save(solver);
    image.bytes[image.size - 1] ^= 1;
    assert_int_equal(ilsa_snapshot_restore(empty, image.bytes, image.size), ILSA_ERR_SNAPSHOT);
    double time;
    assert_int_equal(ilsa_get_time(empty, &time), ILSA_ERR_STATE);
    image.bytes[image.size - 1] ^= 1;
    host_restore(empty, &image);
    assert_true(host_is(empty, &image));
    host_free(&image);
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&empty);
}

/* The checksum of src/api/snapshot.c, so that unsound images get past it. */
static void sign(host_image *image) {
    uint64_t hash = 14695981039346656037u, word;
    size_t k = HEADER;
    for (; k + sizeof word <= image->size; k += sizeof word) {
        memcpy(&word, image->bytes + k, sizeof word);
        hash = (hash ^ word) * 1099511628211u;
        hash ^= hash >> 29;
    }
    for (; k < image->size; k++)
        hash = (hash ^ image->bytes[k]) * 1099511628211u;
    memcpy(image->bytes + AT_CHECKSUM, &hash, sizeof hash);
}

/*
 * Images with a right checksum and a wrong inside, as a faulty writer might make them: either
 * refused, the solver as it was, or taken; never read or written out of bounds.
 */
static void unsound_images_do_no_harm(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = running(&scene, 2);
    host_image before = host_save(solver), altered = host_save(solver);
    sign(&altered);
    assert_true(host_same(&before, &altered));
    int refused = 0, taken = 0;
    static const unsigned char value[] = {0xff, 0x7f, 0x80, 0x00, 0x01};
    for (size_t at = HEADER; at < 3000; at++)
        for (size_t v = 0; v < sizeof value; v++) {
            altered.bytes[at] = value[v];
            sign(&altered);
            ilsa_status status = ilsa_snapshot_restore(solver, altered.bytes, altered.size);
            altered.bytes[at] = before.bytes[at];
            *(status ? &refused : &taken) += 1;
            if (status)
                assert_true(status == ILSA_ERR_SNAPSHOT || status == ILSA_ERR_MISMATCH ||
                            status == ILSA_ERR_MEMORY);
            if (status && v == 0)
                assert_true(host_is(solver, &before));
            else if (!status)
                host_restore(solver, &before);
        }
    print_message("snapshot: %d unsound images refused, %d harmless\n", refused, taken);
    assert_true(refused > 100 && taken > 100);
    host_free(&before);
    host_free(&altered);
    ilsa_solver_destroy(&solver);
}

/* The place of a number in an image; the test fails if it is not there. */
static size_t place_of(const host_image *image, double number) {
    for (size_t at = HEADER; at + sizeof number <= image->size; at++)
        /* The same bits are meant. */
        /* NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c) */
        if (memcmp(image->bytes + at, &number, sizeof number) == 0)
            return at;
    fail_msg("%g is not in the image", number);
    return 0;
}

/* A width that is not a number is not taken for a state, nor one beyond any fracture. */
static void impossible_states_are_refused(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = running(&scene, 2);
    host_image before = host_save(solver), altered = host_save(solver);
    ilsa_summary now = host_summary(solver);
    const double *trigger = host_trigger(solver);
    const double held[] = {now.width_source,    now.pressure_source, now.time,
                           now.volume_fracture, now.volume_leaked,   trigger[33 * 61 + 30],
                           scene.source[1].rate};
    const double bad[] = {NAN, -INFINITY, -1e300, INFINITY, 1e250};
    for (size_t h = 0; h < sizeof held / sizeof *held; h++)
        for (size_t b = 0; b < sizeof bad / sizeof *bad; b++) {
            size_t at = place_of(&before, held[h]);
            if (h == 5 && bad[b] > 0)
                continue; /* infinite: the front has not passed */
            memcpy(altered.bytes + at, &bad[b], sizeof(double));
            sign(&altered);
            check_refused(solver, &before, altered.bytes, altered.size, ILSA_ERR_SNAPSHOT,
                          "malformed");
            memcpy(altered.bytes + at, &held[h], sizeof(double));
        }
    host_free(&before);
    host_free(&altered);
    ilsa_solver_destroy(&solver);
}

/* Saving needs no memory, so a host can do it when there is none. */
static void save_needs_no_memory(void **state) {
    (void)state;
    host_scene scene = small_scene();
    ilsa_solver *solver = running(&scene, 2);
    host_image image = host_save(solver);
    size_t size = image.size;
    memset(image.bytes, 0, size);
    allocations_left = 0;
    ilsa_status status = ilsa_snapshot_save(solver, image.bytes, &size);
    allocations_left = -1;
    assert_int_equal(status, ILSA_OK);
    assert_true(host_is(solver, &image));
    host_free(&image);
    ilsa_solver_destroy(&solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(size_is_asked_first),
        cmocka_unit_test(small_buffer_is_not_touched),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(equal_states_have_equal_images),
        cmocka_unit_test(hundred_steps_taken_back),
        cmocka_unit_test(other_scenes_resume),
        cmocka_unit_test(restore_clears_what_was_there),
        cmocka_unit_test(rates_and_stress_come_back),
        cmocka_unit_test(coarsened_states_resume),
        cmocka_unit_test(oblong_states_resume),
        cmocka_unit_test(grown_states_resume),
        cmocka_unit_test(lost_symmetry_stays_lost),
        cmocka_unit_test(foreign_images_are_refused),
        cmocka_unit_test(every_length_but_one_is_refused),
        cmocka_unit_test(every_altered_byte_is_noticed),
        cmocka_unit_test(other_versions_are_refused),
        cmocka_unit_test(other_definitions_are_refused),
        cmocka_unit_test(refusal_without_a_fracture),
        cmocka_unit_test(unsound_images_do_no_harm),
        cmocka_unit_test(impossible_states_are_refused),
        cmocka_unit_test(save_needs_no_memory),
    };
    return cmocka_run_group_tests_name("snapshot", tests, NULL, NULL);
}
