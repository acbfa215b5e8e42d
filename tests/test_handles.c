/* Mesh, material, stress, status, version: every branch of every function, bad input first. */
#include "base/error.h"
#include "check.h"
#include "failing.h"
#include "model/material.h"
#include "model/mesh.h"
#include "model/stress.h"
#include <ilsa/version.h>

#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double bad[] = {NAN, INFINITY, -INFINITY};

/* The last call failed and said so, naming what was wrong. */
static void check_failed(ilsa_status status, ilsa_status expected, const char *part) {
    assert_int_equal(status, expected);
    if (!strstr(ilsai_thread_error()->text, part))
        fail_msg("message '%s' does not contain '%s'", ilsai_thread_error()->text, part);
    ilsai_thread_error()->text[0] = '\0';
}

/* Status, version, messages */

static void every_status_has_a_text(void **state) {
    (void)state;
    for (int a = ILSA_ERR_NUMERIC; a <= ILSA_NO_SPACE; a++) {
        const char *text = ilsa_status_text((ilsa_status)a);
        assert_non_null(text);
        assert_true(strlen(text) > 0);
        assert_string_not_equal(text, "unknown status");
        for (int b = ILSA_ERR_NUMERIC; b < a; b++)
            assert_string_not_equal(text, ilsa_status_text((ilsa_status)b));
    }
    assert_string_equal(ilsa_status_text((ilsa_status)(ILSA_NO_SPACE + 1)), "unknown status");
    assert_string_equal(ilsa_status_text((ilsa_status)(ILSA_ERR_NUMERIC - 1)), "unknown status");
}

static void version_is_that_of_the_header(void **state) {
    (void)state;
    char text[40];
    snprintf(text, sizeof text, "%d.%d.%d", ILSA_VERSION_MAJOR, ILSA_VERSION_MINOR,
             ILSA_VERSION_PATCH);
    assert_string_equal(ilsa_version_string(), text);
    assert_int_equal(ilsa_version_number(),
                     10000 * ILSA_VERSION_MAJOR + 100 * ILSA_VERSION_MINOR + ILSA_VERSION_PATCH);
}

static void messages_are_cut_not_overrun(void **state) {
    (void)state;
    error_text error;
    char text[1000];
    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = '\0';
    assert_int_equal(ilsai_fail(&error, ILSA_ERR_STATE, "%s", text), ILSA_ERR_STATE);
    assert_int_equal(strlen(error.text), sizeof error.text - 1);
    assert_int_equal(ilsai_fail(&error, ILSA_CLOSED, "%.5s!", error.text), ILSA_CLOSED);
    assert_string_equal(error.text, "xxxxx!");
    assert_int_equal(ilsai_fail(NULL, ILSA_STALLED, "%d", 1), ILSA_STALLED);
}

static void *fail_in_a_thread(void *argument) {
    ilsa_mesh_def def = {2, 3, 1, 1};
    ilsa_mesh *mesh;
    (void)argument;
    assert_string_equal(ilsai_thread_error()->text, "");
    ilsa_mesh_create(&def, &mesh);
    assert_string_equal(ilsai_thread_error()->text, "nx = 2: must be 3 .. 1000000");
    return NULL;
}

static void each_thread_has_its_message(void **state) {
    (void)state;
    pthread_t thread;
    strcpy(ilsai_thread_error()->text, "mine");
    assert_int_equal(pthread_create(&thread, NULL, fail_in_a_thread, NULL), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_string_equal(ilsai_thread_error()->text, "mine");
}

/* Mesh */

static ilsa_status try_mesh(int nx, int ny, double dx, double dy) {
    ilsa_mesh_def def = {nx, ny, dx, dy};
    ilsa_mesh *mesh = (ilsa_mesh *)&def;
    ilsa_status status = ilsa_mesh_create(&def, &mesh);
    assert_true((status == ILSA_OK) == (mesh != NULL));
    ilsa_mesh_destroy(&mesh);
    return status;
}

static void mesh_refuses_bad_definitions(void **state) {
    (void)state;
    ilsa_mesh_def def = ilsa_mesh_def_default();
    ilsa_mesh *mesh = (ilsa_mesh *)&def;
    assert_true(def.nx == 0 && def.ny == 0 && def.dx == 0 && def.dy == 0);
    check_failed(ilsa_mesh_create(&def, NULL), ILSA_ERR_NULL, "mesh is NULL");
    check_failed(ilsa_mesh_create(NULL, &mesh), ILSA_ERR_NULL, "def is NULL");
    assert_null(mesh);
    check_failed(ilsa_mesh_create(&def, &mesh), ILSA_ERR_VALUE, "nx = 0: must be 3 .. 1000000");
    static const int count[] = {INT_MIN, -1, 0, 2, 1000001, INT_MAX};
    for (size_t n = 0; n < sizeof count / sizeof *count; n++) {
        check_failed(try_mesh(count[n], 3, 1, 1), ILSA_ERR_VALUE, "nx = ");
        check_failed(try_mesh(3, count[n], 1, 1), ILSA_ERR_VALUE, "ny = ");
    }
    check_failed(try_mesh(1 << 15, (1 << 13) + 1, 1, 1), ILSA_ERR_VALUE, "nx ny = 32768 x 8193");
    check_failed(try_mesh(1000000, 1000000, 1, 1), ILSA_ERR_VALUE, "268435456 cells");
    static const double size[] = {NAN, INFINITY, -INFINITY, 0, -1};
    for (size_t n = 0; n < sizeof size / sizeof *size; n++) {
        check_failed(try_mesh(3, 3, size[n], 1), ILSA_ERR_VALUE, "dx = ");
        check_failed(try_mesh(3, 3, 1, size[n]), ILSA_ERR_VALUE, "dy = ");
    }
    check_failed(try_mesh(3, 3, 1, 1001), ILSA_ERR_VALUE, "dx / dy = 1 / 1001");
    check_failed(try_mesh(3, 3, 1001, 1), ILSA_ERR_VALUE, "must be 1e-3 .. 1e3");
    check_failed(try_mesh(3, 3, 1e61, 1e61), ILSA_ERR_VALUE, "1e-60 .. 1e+60");
}

static void mesh_accepts_the_whole_range(void **state) {
    (void)state;
    assert_int_equal(try_mesh(3, 3, 1, 1), ILSA_OK);
    assert_int_equal(try_mesh(3, 1000000, 1, 1000), ILSA_OK);
    assert_int_equal(try_mesh(1000000, 3, 1e-6, 1e-9), ILSA_OK);
    assert_int_equal(try_mesh(1 << 15, 1 << 13, 1e60, 1e59), ILSA_OK);
}

static void mesh_lives_and_dies(void **state) {
    (void)state;
    ilsa_mesh_def def = {5, 4, 0.5, 0.25}, seen = ilsa_mesh_def_default();
    ilsa_mesh *mesh;
    assert_int_equal(ilsa_mesh_create(&def, &mesh), ILSA_OK);
    assert_int_equal(ilsa_mesh_get_def(mesh, &seen), ILSA_OK);
    assert_true(ilsai_mesh_same(&def, &seen));
    check_failed(ilsa_mesh_get_def(NULL, &seen), ILSA_ERR_NULL, "mesh is NULL");
    check_failed(ilsa_mesh_get_def(mesh, NULL), ILSA_ERR_NULL, "def is NULL");
    ilsa_mesh_destroy(&mesh);
    assert_null(mesh);
    ilsa_mesh_destroy(&mesh);
    ilsa_mesh_destroy(NULL);
}

static void mesh_same_looks_at_everything(void **state) {
    (void)state;
    ilsa_mesh_def a = {5, 4, 1, 2}, b[] = {{6, 4, 1, 2}, {5, 5, 1, 2}, {5, 4, 3, 2}, {5, 4, 1, 1}};
    assert_true(ilsai_mesh_same(&a, &a));
    for (size_t n = 0; n < 4; n++)
        assert_false(ilsai_mesh_same(&a, &b[n]));
}

/* Every centre is in its cell; every edge in the upper one; the outer edges in the outermost. */
static void cells_hold_their_points(void **state) {
    (void)state;
    static const double size[] = {1, 0.1, 0.3, 1e-9, 7e8, 1.0 / 3};
    for (size_t s = 0; s < sizeof size / sizeof *size; s++)
        for (int n = 3; n < 40; n++) {
            double d = size[s];
            for (int i = 0; i < n; i++) {
                ilsa_mesh_def def = {n, 3, d, d};
                assert_int_equal(ilsai_mesh_locate(n, d, ilsai_mesh_x(&def, i)), i);
                assert_int_equal(ilsai_mesh_locate(n, d, ilsai_mesh_edge(n, d, i)), i);
                double inside = nextafter(ilsai_mesh_edge(n, d, i + 1), -INFINITY);
                assert_int_equal(ilsai_mesh_locate(n, d, inside), i);
                assert_true(ilsai_mesh_x(&def, i) == -ilsai_mesh_x(&def, n - 1 - i));
                assert_true(ilsai_mesh_edge(n, d, i) == -ilsai_mesh_edge(n, d, n - i));
            }
            double end = ilsai_mesh_edge(n, d, n);
            assert_int_equal(ilsai_mesh_locate(n, d, end), n - 1);
            assert_int_equal(ilsai_mesh_locate(n, d, nextafter(end, INFINITY)), -1);
            assert_int_equal(ilsai_mesh_locate(n, d, nextafter(-end, -INFINITY)), -1);
        }
}

/* Material */

static ilsa_status try_material(ilsa_material_def def) {
    ilsa_material *material = (ilsa_material *)&def;
    ilsa_status status = ilsa_material_create(&def, &material);
    assert_true((status == ILSA_OK) == (material != NULL));
    ilsa_material_destroy(&material);
    return status;
}

static void material_refuses_bad_definitions(void **state) {
    (void)state;
    ilsa_material_def def = ilsa_material_def_default(), good = {3e10, 1.2, 1e6, 1e-5};
    ilsa_material *material = (ilsa_material *)&def;
    assert_true(def.E_prime == 0 && def.mu_prime == 0 && def.K_prime == 0 && def.C_prime == 0);
    check_failed(ilsa_material_create(&good, NULL), ILSA_ERR_NULL, "material is NULL");
    check_failed(ilsa_material_create(NULL, &material), ILSA_ERR_NULL, "def is NULL");
    assert_null(material);
    check_failed(try_material(def), ILSA_ERR_VALUE, "E_prime = 0: must be finite and > 0");
    static const double size[] = {NAN, INFINITY, -INFINITY, -1, 0};
    static const char *const name[] = {"E_prime", "mu_prime", "K_prime", "C_prime"};
    for (size_t m = 0; m < 4; m++)
        for (size_t n = 0; n < 5; n++) {
            def = good;
            double *value[] = {&def.E_prime, &def.mu_prime, &def.K_prime, &def.C_prime};
            *value[m] = size[n];
            if (m >= 1 && size[n] == 0)
                assert_int_equal(try_material(def), ILSA_OK);
            else
                check_failed(try_material(def), ILSA_ERR_VALUE, name[m]);
        }
    def = good;
    def.mu_prime = def.K_prime = 0;
    check_failed(try_material(def), ILSA_ERR_VALUE, "mu_prime = 0: must be > 0 where K_prime = 0");
}

static void material_lives_and_dies(void **state) {
    (void)state;
    ilsa_material_def def = {1, 2, 3, 4}, seen = ilsa_material_def_default();
    ilsa_material *material;
    assert_int_equal(ilsa_material_create(&def, &material), ILSA_OK);
    assert_int_equal(ilsa_material_get_def(material, &seen), ILSA_OK);
    assert_memory_equal(&def, &seen, sizeof def);
    check_failed(ilsa_material_get_def(NULL, &seen), ILSA_ERR_NULL, "material is NULL");
    check_failed(ilsa_material_get_def(material, NULL), ILSA_ERR_NULL, "def is NULL");
    ilsa_material_destroy(&material);
    assert_null(material);
    ilsa_material_destroy(&material);
    ilsa_material_destroy(NULL);
}

static void rock_gives_the_scaled_parameters(void **state) {
    (void)state;
    ilsa_rock rock = {9.5e9, 0.2, 0.1, 1e6, 2.5e-5};
    ilsa_material_def def;
    assert_int_equal(ilsa_material_def_from_rock(&rock, &def), ILSA_OK);
    assert_true(fabs(def.E_prime / (9.5e9 / 0.96) - 1) < 1e-15);
    assert_true(def.mu_prime == 12 * 0.1);
    assert_true(fabs(def.K_prime / 3.1915382432114616e6 - 1) < 1e-15);
    assert_true(def.C_prime == 5e-5);
    rock.nu = 0;
    rock.K_Ic = rock.C_L = 0;
    assert_int_equal(ilsa_material_def_from_rock(&rock, &def), ILSA_OK);
    assert_true(def.E_prime == 9.5e9 && def.K_prime == 0 && def.C_prime == 0);
    rock.nu = 0.5;
    assert_int_equal(ilsa_material_def_from_rock(&rock, &def), ILSA_OK);
}

static void rock_refuses_bad_values(void **state) {
    (void)state;
    const ilsa_rock good = {9.5e9, 0.2, 0.1, 1e6, 2.5e-5};
    ilsa_material_def def = {1, 2, 3, 4};
    const ilsa_material_def before = def;
    check_failed(ilsa_material_def_from_rock(NULL, &def), ILSA_ERR_NULL, "rock is NULL");
    check_failed(ilsa_material_def_from_rock(&good, NULL), ILSA_ERR_NULL, "def is NULL");
    static const char *const name[] = {"E = ", "nu = ", "mu = ", "K_Ic = ", "C_L = "};
    static const double size[] = {NAN, INFINITY, -INFINITY, -1e-3};
    for (size_t m = 0; m < 5; m++)
        for (size_t n = 0; n < 4; n++) {
            ilsa_rock rock = good;
            double *value[] = {&rock.E, &rock.nu, &rock.mu, &rock.K_Ic, &rock.C_L};
            *value[m] = size[n];
            check_failed(ilsa_material_def_from_rock(&rock, &def), ILSA_ERR_VALUE, name[m]);
        }
    ilsa_rock rock = good;
    rock.nu = 0.51;
    check_failed(ilsa_material_def_from_rock(&rock, &def), ILSA_ERR_VALUE, "nu = 0.51: must be 0");
    rock = good;
    rock.mu = 1e308;
    check_failed(ilsa_material_def_from_rock(&rock, &def), ILSA_ERR_VALUE, "mu_prime = inf");
    assert_memory_equal(&def, &before, sizeof def);
}

/* Stress */

enum { NX = 5, NY = 6, CELLS = NX * NY };
static const ilsa_mesh_def mesh_def = {NX, NY, 2, 1};

static ilsa_stress *make_stress(double sigma) {
    ilsa_stress_def def = {sigma};
    ilsa_stress *stress;
    assert_int_equal(ilsa_stress_create(&def, &stress), ILSA_OK);
    return stress;
}

static ilsa_mesh *make_mesh(ilsa_mesh_def def) {
    ilsa_mesh *mesh;
    assert_int_equal(ilsa_mesh_create(&def, &mesh), ILSA_OK);
    return mesh;
}

/* sigma[n] = n */
static ilsa_stress *make_cells(ilsa_mesh_def def) {
    ilsa_stress *stress = make_stress(0);
    ilsa_mesh *mesh = make_mesh(def);
    size_t count = ilsai_mesh_cells(&def);
    double *sigma = malloc(count * sizeof *sigma);
    for (size_t n = 0; n < count; n++)
        sigma[n] = (double)n;
    assert_int_equal(ilsa_stress_set_cells(stress, mesh, sigma), ILSA_OK);
    free(sigma);
    ilsa_mesh_destroy(&mesh);
    return stress;
}

static ilsa_stress *make_layers(int count, const double *y, const double *sigma) {
    ilsa_stress *stress = make_stress(0);
    assert_int_equal(ilsa_stress_set_layers(stress, count, y, sigma), ILSA_OK);
    return stress;
}

static void fill(const ilsa_stress *stress, const ilsa_mesh_def *def, double *sigma) {
    assert_int_equal(ilsai_cell_field_fill(&stress->field, "stress", def, sigma), ILSA_OK);
}

static void stress_create_and_destroy(void **state) {
    (void)state;
    ilsa_stress_def def = ilsa_stress_def_default();
    ilsa_stress *stress = (ilsa_stress *)&def;
    assert_true(def.sigma == 0);
    check_failed(ilsa_stress_create(&def, NULL), ILSA_ERR_NULL, "stress is NULL");
    check_failed(ilsa_stress_create(NULL, &stress), ILSA_ERR_NULL, "def is NULL");
    assert_null(stress);
    for (size_t n = 0; n < 3; n++) {
        def.sigma = bad[n];
        stress = (ilsa_stress *)&def;
        check_failed(ilsa_stress_create(&def, &stress), ILSA_ERR_VALUE, "sigma = ");
        assert_null(stress);
    }
    stress = make_stress(-3);
    double sigma[CELLS];
    fill(stress, &mesh_def, sigma);
    for (int n = 0; n < CELLS; n++)
        assert_true(sigma[n] == -3);
    assert_false(ilsai_cell_field_varies(&stress->field));
    ilsa_stress_destroy(&stress);
    assert_null(stress);
    ilsa_stress_destroy(&stress);
    ilsa_stress_destroy(NULL);
}

/* Every set that is refused leaves the field as it was. */
static void stress_sets_refuse_bad_input(void **state) {
    (void)state;
    ilsa_stress *stress = make_cells(mesh_def);
    ilsa_mesh *mesh = make_mesh(mesh_def);
    double y[] = {-1, 1}, sigma[CELLS] = {1, 2, 3};
    unsigned char *before = malloc(ilsai_cell_field_flat_size(&stress->field));
    unsigned char *after = malloc(ilsai_cell_field_flat_size(&stress->field));
    ilsai_cell_field_write(&stress->field, before);
    check_failed(ilsa_stress_set_uniform(NULL, 1), ILSA_ERR_NULL, "stress is NULL");
    check_failed(ilsa_stress_set_layers(NULL, 2, y, sigma), ILSA_ERR_NULL, "stress is NULL");
    check_failed(ilsa_stress_set_layers(stress, 2, NULL, sigma), ILSA_ERR_NULL, "y is NULL");
    check_failed(ilsa_stress_set_layers(stress, 2, y, NULL), ILSA_ERR_NULL, "sigma is NULL");
    check_failed(ilsa_stress_set_layers(stress, 0, y, sigma), ILSA_ERR_VALUE,
                 "interface_count = 0: must be >= 1");
    check_failed(ilsa_stress_set_layers(stress, -1, y, sigma), ILSA_ERR_VALUE, "count = -1");
    check_failed(ilsa_stress_set_cells(NULL, mesh, sigma), ILSA_ERR_NULL, "stress is NULL");
    check_failed(ilsa_stress_set_cells(stress, NULL, sigma), ILSA_ERR_NULL, "mesh is NULL");
    check_failed(ilsa_stress_set_cells(stress, mesh, NULL), ILSA_ERR_NULL, "sigma is NULL");
    y[1] = -1;
    check_failed(ilsa_stress_set_layers(stress, 2, y, sigma), ILSA_ERR_VALUE,
                 "y[1] = -1: must be above y[0] = -1");
    for (size_t n = 0; n < 3; n++) {
        check_failed(ilsa_stress_set_uniform(stress, bad[n]), ILSA_ERR_VALUE, "sigma = ");
        y[1] = bad[n];
        check_failed(ilsa_stress_set_layers(stress, 2, y, sigma), ILSA_ERR_VALUE, "y[1] = ");
        y[1] = 1;
        sigma[2] = bad[n];
        check_failed(ilsa_stress_set_layers(stress, 2, y, sigma), ILSA_ERR_VALUE, "sigma[2] = ");
        sigma[2] = 3;
        sigma[CELLS - 1] = bad[n];
        check_failed(ilsa_stress_set_cells(stress, mesh, sigma), ILSA_ERR_VALUE, "sigma[29] = ");
        sigma[CELLS - 1] = 0;
    }
    ilsai_cell_field_write(&stress->field, after);
    assert_memory_equal(before, after, ilsai_cell_field_flat_size(&stress->field));
    free(before);
    free(after);
    ilsa_mesh_destroy(&mesh);
    ilsa_stress_destroy(&stress);
}

static void stress_kinds_replace_each_other(void **state) {
    (void)state;
    ilsa_mesh *mesh = make_mesh(mesh_def);
    ilsa_stress *stress = make_stress(1);
    double y[] = {0}, layer[] = {4, 8}, cells[CELLS] = {7}, sigma[CELLS];
    for (int round = 0; round < 2; round++) {
        assert_int_equal(ilsa_stress_set_layers(stress, 1, y, layer), ILSA_OK);
        fill(stress, &mesh_def, sigma);
        assert_true(sigma[0] == 4 && sigma[CELLS - 1] == 8);
        assert_int_equal(ilsa_stress_set_cells(stress, mesh, cells), ILSA_OK);
        fill(stress, &mesh_def, sigma);
        assert_true(sigma[0] == 7 && sigma[1] == 0);
        assert_int_equal(ilsa_stress_set_uniform(stress, 5), ILSA_OK);
        fill(stress, &mesh_def, sigma);
        assert_true(sigma[0] == 5 && sigma[1] == 5);
    }
    ilsa_mesh_destroy(&mesh);
    ilsa_stress_destroy(&stress);
}

static void stress_varies(void **state) {
    (void)state;
    double y[] = {-1, 1}, even[] = {2, 2, 2}, odd[] = {2, 2, 3}, cells[CELLS] = {0};
    ilsa_mesh *mesh = make_mesh(mesh_def);
    ilsa_stress *stress = make_layers(2, y, even);
    assert_false(ilsai_cell_field_varies(&stress->field));
    assert_int_equal(ilsa_stress_set_layers(stress, 2, y, odd), ILSA_OK);
    assert_true(ilsai_cell_field_varies(&stress->field));
    assert_int_equal(ilsa_stress_set_cells(stress, mesh, cells), ILSA_OK);
    assert_false(ilsai_cell_field_varies(&stress->field));
    cells[CELLS - 1] = 1;
    assert_int_equal(ilsa_stress_set_cells(stress, mesh, cells), ILSA_OK);
    assert_true(ilsai_cell_field_varies(&stress->field));
    ilsa_mesh_destroy(&mesh);
    ilsa_stress_destroy(&stress);
}

/* Rows of mesh_def: -3 .. -2 .. -1 .. 0 .. 1 .. 2 .. 3. */
static void layers_take_the_mean_over_a_cell(void **state) {
    (void)state;
    double y[] = {-2, -0.75, -0.5, 0.5, 2.5, 40}, layer[] = {1, 2, 10, 4, 8, 16, 99};
    static const double expected[] = {1, 2, 0.25 * 2 + 0.25 * 10 + 0.5 * 4, 0.5 * 4 + 0.5 * 8,
                                      8, 12};
    ilsa_stress *stress = make_layers(6, y, layer);
    double sigma[CELLS];
    fill(stress, &mesh_def, sigma);
    for (int n = 0; n < CELLS; n++)
        assert_true(fabs(sigma[n] - expected[n / NX]) < 1e-14);
    assert_true(sigma[0] == 1 && sigma[NX] == 2); /* uncut, edges included */
    ilsa_stress_destroy(&stress);
    double beyond[] = {-50, 50};
    stress = make_layers(2, beyond, layer);
    fill(stress, &mesh_def, sigma);
    for (int n = 0; n < CELLS; n++)
        assert_true(sigma[n] == 2);
    ilsa_stress_destroy(&stress);
}

/* Whatever the rounding, mirrored layers fill mirrored cells with the same bits. */
static void mirrored_layers_fill_mirrored_cells(void **state) {
    (void)state;
    double y[] = {-2.3, -2.1, -1.7, -0.4, -0.3, 0.3, 0.4, 1.7, 2.1, 2.3};
    double layer[] = {1.1, 2.7, 0.9, 5.3, 4.4, 7.7, 4.4, 5.3, 0.9, 2.7, 1.1};
    ilsa_stress *stress = make_layers(10, y, layer);
    for (int ny = 3; ny < 20; ny++) {
        ilsa_mesh_def def = {3, ny, 1, 5.3 / ny};
        double sigma[60];
        fill(stress, &def, sigma);
        for (ptrdiff_t j = 0; j < ny; j++)
            assert_true(sigma[3 * j] == sigma[3 * (ny - 1 - j)]);
    }
    ilsa_stress_destroy(&stress);
}

static void cells_belong_to_their_mesh(void **state) {
    (void)state;
    ilsa_stress *stress = make_cells(mesh_def);
    double sigma[CELLS];
    fill(stress, &mesh_def, sigma);
    for (int n = 0; n < CELLS; n++)
        assert_true(sigma[n] == n);
    ilsa_mesh_def other = mesh_def;
    other.dx = 3;
    sigma[0] = -1;
    check_failed(ilsai_cell_field_fill(&stress->field, "stress", &other, sigma), ILSA_ERR_MISMATCH,
                 "5 x 6 cells of 2 x 1: the mesh here has 5 x 6 of 3 x 1");
    assert_true(sigma[0] == -1);
    ilsa_stress_destroy(&stress);
}

static void copies_are_independent(void **state) {
    (void)state;
    double y[] = {0}, layer[] = {4, 8}, sigma[CELLS], again[CELLS];
    ilsa_stress *from[] = {make_stress(3), make_layers(1, y, layer), make_cells(mesh_def)};
    for (size_t k = 0; k < 3; k++) {
        ilsa_stress copy;
        fill(from[k], &mesh_def, sigma);
        assert_int_equal(ilsai_cell_field_copy(&from[k]->field, &copy.field), ILSA_OK);
        ilsa_stress_destroy(&from[k]);
        fill(&copy, &mesh_def, again);
        assert_memory_equal(sigma, again, sizeof sigma);
        ilsai_cell_field_clear(&copy.field);
    }
}

/* Coarsening */

/* The overlap of new cell i of size 2 and old cell k of size 1, both n around the origin. */
static double overlap(int n, int i, int k) {
    double low = fmax(2 * i - n, k - 0.5 * n), high = fmin(2 * i + 2 - n, k + 1 - 0.5 * n);
    return fmax(0, high - low);
}

/* Area-weighted mean of old cells by brute force; NaN where there is none. */
static double covered_mean(const double *old, int nx, int ny, int i, int j) {
    double sum = 0, area = 0;
    for (int l = 0; l < ny; l++)
        for (int k = 0; k < nx; k++) {
            double part = overlap(nx, i, k) * overlap(ny, j, l);
            sum += part * old[l * nx + k];
            area += part;
        }
    return area > 0 ? sum / area : NAN;
}

static void coarse_cells_are_means_of_old_ones(void **state) {
    (void)state;
    for (int ny = 3; ny < 12; ny++)
        for (int nx = 3; nx < 12; nx++) {
            ilsa_mesh_def def = {nx, ny, 3, 7}, twice = {nx, ny, 6, 14};
            double old[144], new[144];
            ilsa_stress *stress = make_cells(def);
            fill(stress, &def, old);
            assert_int_equal(ilsai_cell_field_coarsen(&stress->field, 2, 2), ILSA_OK);
            fill(stress, &twice, new);
            double worst = NOTHING_YET;
            for (int j = 0; j < ny; j++)
                for (int i = 0; i < nx; i++) {
                    double mean = covered_mean(old, nx, ny, i, j);
                    if (!isnan(mean)) /* NaN: not all of the cell is covered */
                        worst = worst_of(worst, fabs(new[j * nx + i] - mean));
                }
            assert_below(worst, 1e-12);
            assert_true(new[0] == 0); /* the nearest old cell is the corner, or alone in it */
            assert_true(new[nx * ny - 1] == nx *ny - 1 || nx == 4 || ny == 4);
            ilsa_stress_destroy(&stress);
        }
}

static void coarsening_keeps_a_constant_and_symmetry(void **state) {
    (void)state;
    for (int n = 3; n < 16; n++) {
        ilsa_mesh_def def = {n, n, 1, 1}, twice = {n, n, 2, 2};
        ilsa_mesh *mesh = make_mesh(def);
        ilsa_stress *stress = make_stress(0);
        double sigma[256];
        for (int k = 0; k < n * n; k++)
            sigma[k] = 1.1;
        assert_int_equal(ilsa_stress_set_cells(stress, mesh, sigma), ILSA_OK);
        assert_int_equal(ilsai_cell_field_coarsen(&stress->field, 2, 2), ILSA_OK);
        assert_false(ilsai_cell_field_varies(&stress->field));
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++)
                sigma[j * n + i] = sin(abs(2 * i - n + 1)) + cos(0.3 * abs(2 * j - n + 1));
        assert_int_equal(ilsa_stress_set_cells(stress, mesh, sigma), ILSA_OK);
        assert_int_equal(ilsai_cell_field_coarsen(&stress->field, 2, 2), ILSA_OK);
        fill(stress, &twice, sigma);
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++) {
                assert_true(sigma[j * n + i] == sigma[j * n + n - 1 - i]);
                assert_true(sigma[j * n + i] == sigma[(n - 1 - j) * n + i]);
            }
        ilsa_mesh_destroy(&mesh);
        ilsa_stress_destroy(&stress);
    }
}

static void coarsening_leaves_other_fields(void **state) {
    (void)state;
    double y[] = {0.5}, layer[] = {4, 8}, sigma[CELLS];
    ilsa_stress *stress = make_layers(1, y, layer);
    assert_int_equal(ilsai_cell_field_coarsen(&stress->field, 2, 2), ILSA_OK);
    fill(stress, &mesh_def, sigma);
    assert_true(sigma[2L * NX] == 4 && sigma[3L * NX] == 6 && sigma[4L * NX] == 8);
    ilsa_stress_destroy(&stress);
}

/* Images */

static void images_give_the_field_back(void **state) {
    (void)state;
    double y[] = {-1, 2}, layer[] = {4, 8, 6};
    ilsa_stress *from[] = {make_stress(3), make_layers(2, y, layer), make_cells(mesh_def)};
    for (size_t k = 0; k < 3; k++) {
        size_t size = ilsai_cell_field_flat_size(&from[k]->field);
        /* One byte off the alignment of a double. */
        unsigned char *image = malloc(size + 1), *again = malloc(size);
        cell_field seen;
        ilsai_cell_field_write(&from[k]->field, image + 1);
        assert_int_equal(ilsai_cell_field_read(image + 1, size, &seen), ILSA_OK);
        assert_int_equal(ilsai_cell_field_flat_size(&seen), size);
        ilsai_cell_field_write(&seen, again);
        assert_memory_equal(image + 1, again, size);
        ilsai_cell_field_clear(&seen);
        for (size_t less = 0; less < size; less++) {
            unsigned char *part = malloc(less + 1); /* of its own, so that a reader is caught */
            memcpy(part, image + 1, less);
            check_failed(ilsai_cell_field_read(part, less, &seen), ILSA_ERR_SNAPSHOT, "malformed");
            assert_null(seen.values);
            free(part);
        }
        free(image);
        free(again);
        ilsa_stress_destroy(&from[k]);
    }
}

/* Any damaged image is refused or gives a sound field; under ASan also: nothing is read beyond. */
static void damaged_images_do_no_harm(void **state) {
    (void)state;
    double y[] = {-1, 2}, layer[] = {4, 8, 6};
    ilsa_stress *from[] = {make_stress(3), make_layers(2, y, layer), make_cells(mesh_def)};
    int refused = 0, taken = 0;
    for (size_t k = 0; k < 3; k++) {
        size_t size = ilsai_cell_field_flat_size(&from[k]->field);
        unsigned char *image = malloc(size);
        ilsai_cell_field_write(&from[k]->field, image);
        for (size_t n = 0; n < 8 * size; n++) {
            cell_field seen;
            image[n / 8] ^= (unsigned char)(1 << n % 8);
            ilsa_status status = ilsai_cell_field_read(image, size, &seen);
            image[n / 8] ^= (unsigned char)(1 << n % 8);
            assert_true(status == ILSA_OK || (status == ILSA_ERR_SNAPSHOT && !seen.values));
            status == ILSA_OK ? taken++ : refused++;
            assert_true(ilsai_cell_field_flat_size(&seen) <= size);
            ilsai_cell_field_clear(&seen);
        }
        free(image);
        ilsa_stress_destroy(&from[k]);
    }
    print_message("images with one bit changed: %d refused, %d are another sound field\n", refused,
                  taken);
    assert_true(refused > 100);
}

/* What only several bits can make: numbers that are not finite, layers out of order. */
static void unsound_images_are_refused(void **state) {
    (void)state;
    double y[] = {-1, 2}, layer[] = {4, 8, 6};
    ilsa_stress *uniform = make_stress(3), *layers = make_layers(2, y, layer);
    ilsa_stress *cells = make_cells(mesh_def);
    cell_field seen;
    unsigned char image[1024];
    for (size_t n = 0; n < 3; n++) {
        uniform->field.uniform = layers->field.values[3] = cells->field.values[9] = bad[n];
        ilsa_stress *all[] = {uniform, layers, cells};
        for (size_t k = 0; k < 3; k++) {
            ilsai_cell_field_write(&all[k]->field, image);
            check_failed(ilsai_cell_field_read(image, sizeof image, &seen), ILSA_ERR_SNAPSHOT, "");
        }
    }
    layers->field.values[3] = 1;
    layers->field.values[0] = 5;
    ilsai_cell_field_write(&layers->field, image);
    check_failed(ilsai_cell_field_read(image, sizeof image, &seen), ILSA_ERR_SNAPSHOT, "malformed");
    layers->field.values[0] = -5;
    ilsai_cell_field_write(&layers->field, image);
    assert_int_equal(ilsai_cell_field_read(image, sizeof image, &seen), ILSA_OK);
    ilsai_cell_field_clear(&seen);
    ilsa_stress_destroy(&uniform);
    ilsa_stress_destroy(&layers);
    ilsa_stress_destroy(&cells);
}

/* No memory */

static void creates_survive_no_memory(void **state) {
    (void)state;
    ilsa_material_def material_def = {1, 2, 3, 4};
    ilsa_stress_def stress_def = {1};
    ilsa_mesh *mesh = (ilsa_mesh *)&material_def;
    ilsa_material *material = (ilsa_material *)&material_def;
    ilsa_stress *stress = (ilsa_stress *)&material_def;
    allocations_left = 0;
    ilsa_status a = ilsa_mesh_create(&mesh_def, &mesh);
    ilsa_status b = ilsa_material_create(&material_def, &material);
    ilsa_status c = ilsa_stress_create(&stress_def, &stress);
    allocations_left = -1;
    assert_true(a == ILSA_ERR_MEMORY && b == a && c == a);
    assert_true(!mesh && !material && !stress);
    assert_string_equal(ilsai_thread_error()->text, "no memory for a stress field");
}

/* Every allocation of a stress field fails once; the field stays and nothing leaks. */
static void stress_survives_no_memory(void **state) {
    (void)state;
    double y[] = {0}, layer[] = {4, 8}, cells[CELLS] = {1};
    ilsa_mesh *mesh = make_mesh(mesh_def);
    ilsa_stress *stress = make_cells(mesh_def);
    unsigned char before[1024], after[1024];
    ilsai_cell_field_write(&stress->field, before);
    cell_field copy, read;
    allocations_left = 0;
    ilsa_status a = ilsai_cell_field_copy(&stress->field, &copy);
    ilsa_status b = ilsai_cell_field_read(before, sizeof before, &read);
    allocations_left = -1;
    assert_true(a == ILSA_ERR_MEMORY && b == ILSA_ERR_MEMORY && !copy.values && !read.values);
    allocations_left = 0;
    ilsa_status c = ilsa_stress_set_layers(stress, 1, y, layer);
    ilsa_status d = ilsa_stress_set_cells(stress, mesh, cells);
    ilsa_status e = ilsai_cell_field_coarsen(&stress->field, 2, 2);
    allocations_left = -1;
    assert_true(c == ILSA_ERR_MEMORY && d == c && e == c);
    ilsai_cell_field_write(&stress->field, after);
    assert_memory_equal(before, after, ilsai_cell_field_flat_size(&stress->field));
    ilsa_mesh_destroy(&mesh);
    ilsa_stress_destroy(&stress);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_status_has_a_text),
        cmocka_unit_test(version_is_that_of_the_header),
        cmocka_unit_test(messages_are_cut_not_overrun),
        cmocka_unit_test(each_thread_has_its_message),
        cmocka_unit_test(mesh_refuses_bad_definitions),
        cmocka_unit_test(mesh_accepts_the_whole_range),
        cmocka_unit_test(mesh_lives_and_dies),
        cmocka_unit_test(mesh_same_looks_at_everything),
        cmocka_unit_test(cells_hold_their_points),
        cmocka_unit_test(material_refuses_bad_definitions),
        cmocka_unit_test(material_lives_and_dies),
        cmocka_unit_test(rock_gives_the_scaled_parameters),
        cmocka_unit_test(rock_refuses_bad_values),
        cmocka_unit_test(stress_create_and_destroy),
        cmocka_unit_test(stress_sets_refuse_bad_input),
        cmocka_unit_test(stress_kinds_replace_each_other),
        cmocka_unit_test(stress_varies),
        cmocka_unit_test(layers_take_the_mean_over_a_cell),
        cmocka_unit_test(mirrored_layers_fill_mirrored_cells),
        cmocka_unit_test(cells_belong_to_their_mesh),
        cmocka_unit_test(copies_are_independent),
        cmocka_unit_test(coarse_cells_are_means_of_old_ones),
        cmocka_unit_test(coarsening_keeps_a_constant_and_symmetry),
        cmocka_unit_test(coarsening_leaves_other_fields),
        cmocka_unit_test(images_give_the_field_back),
        cmocka_unit_test(damaged_images_do_no_harm),
        cmocka_unit_test(unsound_images_are_refused),
        cmocka_unit_test(creates_survive_no_memory),
        cmocka_unit_test(stress_survives_no_memory),
    };
    return cmocka_run_group_tests_name("handles", tests, NULL, NULL);
}
