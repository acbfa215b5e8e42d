/* The numbered cells and the lubrication operator on them, against Poiseuille's law. */
#include "check.h"
#include "failing.h"
#include "flow/contact.h"
#include "flow/newtonian.h"
#include <ilsa/solver.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double dt_over_mu = 0.37;

/* Fields over a mesh, its numbered cells and the operator on them. */
typedef struct scene {
    grid g;
    box footprint;
    unsigned char *kind;
    double *width, *width_old, *pressure, *source_term;
    unknowns a;
    lubrication f;
} scene;

static scene make_scene(int nx, int ny, int mirror_x, int mirror_y) {
    ilsa_mesh_def def = {nx, ny, 0.5, 0.8};
    size_t cells = (size_t)nx * (size_t)ny;
    scene s = {.g = ilsai_grid(&def, mirror_x, mirror_y), .kind = calloc(cells, 1)};
    s.width = calloc(cells, sizeof(double));
    s.width_old = calloc(cells, sizeof(double));
    s.pressure = calloc(cells, sizeof(double));
    s.source_term = calloc(cells, sizeof(double));
    if (!s.kind || !s.width || !s.pressure || !s.source_term) {
        abort();
    }
    assert_int_equal(ilsai_unknowns_create(&s.a, &def), ILSA_OK);
    s.footprint = (box){0, nx - 1, 0, ny - 1};
    return s;
}

static void free_scene(scene *s) {
    free(s->kind);
    free(s->width);
    free(s->width_old);
    free(s->pressure);
    free(s->source_term);
    ilsai_unknowns_destroy(&s->a);
    ilsai_lubrication_destroy(&s->f);
}

static int cell_count(const scene *s) {
    return s->g.nx * s->g.ny;
}

/* Counted from zero, without the mirrors. */
static int mirrored(int mirror, int n, int i) {
    return mirror && n - 1 - i > i ? n - 1 - i : i;
}

/* The same number at (+-x, +-y) where there are mirrors. */
static double noise(const scene *s, int mirror, int cell, uint64_t salt) {
    int i = mirrored(mirror & 1, s->g.nx, cell % s->g.nx);
    int j = mirrored(mirror >> 1, s->g.ny, cell / s->g.nx);
    uint64_t seed = salt + 1000003u * (uint64_t)i + 7919u * (uint64_t)j;
    next_random(&seed);
    next_random(&seed);
    return next_random(&seed);
}

/* A ragged fracture with widths and pressures at random; what is empty holds numbers too. */
static void fill(scene *s, int mirror, uint64_t salt) {
    for (int cell = 0; cell < cell_count(s); cell++) {
        double x = 2 * ilsai_grid_x(&s->g, cell % s->g.nx) / (s->g.nx * s->g.dx);
        double y = 2 * ilsai_grid_y(&s->g, cell / s->g.nx) / (s->g.ny * s->g.dy);
        double r = hypot(x, y) + 0.2 * noise(s, mirror, cell, salt);
        s->kind[cell] = r < 0.7    ? ILSA_CELL_CHANNEL
                        : r < 0.8  ? ILSA_CELL_SURVEY
                        : r < 0.95 ? ILSA_CELL_TIP
                                   : ILSA_CELL_EMPTY;
        s->width[cell] = 1 + 0.9 * noise(s, mirror, cell, salt + 1);
        s->pressure[cell] = 5 + noise(s, mirror, cell, salt + 2);
    }
}

static void set_fluxes(scene *s) {
    const ilsa_material_def material = {.mu_prime = 1};
    const flow_state state = {.g = &s->g,
                              .cells = &s->a,
                              .material = &material,
                              .dt = dt_over_mu,
                              .width = s->width,
                              .width_old = s->width_old,
                              .pressure = s->pressure};
    ilsai_newtonian.set_fluxes(&s->f, &state);
}

/* Lists the numbered cells, sets the operator for widths that stay; gain over the mesh. */
static void work_out(scene *s) {
    double source_term[4000];
    memcpy(s->width_old, s->width, (size_t)cell_count(s) * sizeof *s->width);
    assert_int_equal(ilsai_unknowns_set(&s->a, &s->g, &s->footprint, s->kind), ILSA_OK);
    assert_true(s->a.count < 4000);
    assert_int_equal(ilsai_lubrication_reserve(&s->f, s->a.count), ILSA_OK);
    set_fluxes(s);
    for (int k = 0; k < s->a.count; k++)
        source_term[k] = ilsai_lubrication_inflow(&s->f, k);
    for (int k = 0; k < s->a.count; k++) {
        s->source_term[s->a.cell[k]] = source_term[k];
    }
}

static int weight(const scene *s, int cell) {
    int image[4];
    return ilsai_grid_images(&s->g, cell % s->g.nx, cell / s->g.nx, image);
}

/* Active cells */

static void active_cells_are_the_representatives_that_are_not_empty(void **state) {
    (void)state;
    for (int n = 0; n < 16; n++) {
        scene s = make_scene(20 + n / 4 % 2, 16 + n / 8, n % 2, n / 2 % 2);
        fill(&s, n % 4, 9);
        work_out(&s);
        int found = 0;
        for (int cell = 0; cell < cell_count(&s); cell++) {
            int i = cell % s.g.nx, j = cell / s.g.nx, number = s.a.number[cell];
            if (s.kind[cell] == ILSA_CELL_EMPTY || i < s.g.lo_x || j < s.g.lo_y) {
                assert_int_equal(number, -1);
                continue;
            }
            found++;
            assert_true(number >= 0 && number < s.a.count && s.a.cell[number] == cell);
            assert_int_equal(s.a.unknown[number] == UNKNOWN_PRESSURE,
                             s.kind[cell] == ILSA_CELL_TIP);
            for (int face = 0; face < GRID_FACES; face++) {
                int other = ilsai_grid_neighbour(&s.g, i, j, face);
                int expected = other < 0 ? -1 : s.a.number[other];
                assert_int_equal(s.a.neighbour[GRID_FACES * number + face], expected);
            }
        }
        assert_int_equal(found, s.a.count);
        free_scene(&s);
    }
}

/* A full rectangle: the numbers of neighbours differ by the shorter side at most. */
static void numbers_run_along_the_shorter_side(void **state) {
    (void)state;
    static const int size[][2] = {{9, 31}, {31, 9}, {12, 12}};
    for (size_t n = 0; n < sizeof size / sizeof *size; n++) {
        scene s = make_scene(40, 40, 0, 0);
        s.footprint = (box){3, 2 + size[n][0], 5, 4 + size[n][1]};
        memset(s.kind, ILSA_CELL_CHANNEL, (size_t)cell_count(&s));
        work_out(&s);
        int shorter = size[n][0] < size[n][1] ? size[n][0] : size[n][1], widest = 0;
        for (int at = 0; at < GRID_FACES * s.a.count; at++) {
            int distance = abs(s.a.neighbour[at] - at / GRID_FACES);
            widest = s.a.neighbour[at] >= 0 && distance > widest ? distance : widest;
        }
        assert_int_equal(s.a.count, size[n][0] * size[n][1]);
        assert_int_equal(widest, shorter);
        free_scene(&s);
    }
}

static void cells_of_the_last_list_are_forgotten(void **state) {
    (void)state;
    scene s = make_scene(20, 20, 0, 0);
    fill(&s, 0, 1);
    work_out(&s);
    int before = s.a.count;
    memset(s.kind, ILSA_CELL_EMPTY, (size_t)cell_count(&s));
    s.kind[210] = ILSA_CELL_CHANNEL;
    work_out(&s);
    assert_true(before > 100 && s.a.count == 1 && s.a.number[210] == 0);
    for (int cell = 0; cell < cell_count(&s); cell++) {
        assert_true(s.a.number[cell] == -1 || cell == 210);
    }
    assert_true(s.source_term[210] == 0); /* alone: no fluid passes */
    free_scene(&s);
}

/* Lubrication */

/* What one cell loses another gains, images counted. */
static void volume_is_conserved(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    for (int n = 0; n < 16; n++) {
        for (uint64_t salt = 1; salt <= 10; salt++) {
            scene s = make_scene(24 + n / 4 % 2, 18 + n / 8, n % 2, n / 2 % 2);
            double sum = 0, size = 0;
            fill(&s, n % 4, 31 * salt);
            work_out(&s);
            for (int k = 0; k < s.a.count; k++) {
                int cell = s.a.cell[k];
                sum += weight(&s, cell) * s.source_term[cell];
                size += weight(&s, cell) * fabs(s.source_term[cell]);
            }
            worst = worst_of(worst, fabs(sum) / size);
            free_scene(&s);
        }
    }
    print_message("volume: worst sum of gains %.2g of what flows\n", worst);
    assert_below(worst, 1e-15);
}

/* Fluid flows down the pressure: the rate of work is never positive. */
static void flow_dissipates(void **state) {
    (void)state;
    for (uint64_t salt = 1; salt <= 20; salt++) {
        scene s = make_scene(15, 15, 1, 0);
        double work = 0;
        fill(&s, 1, salt);
        work_out(&s);
        for (int k = 0; k < s.a.count; k++) {
            int cell = s.a.cell[k];
            work += weight(&s, cell) * s.source_term[cell] * s.pressure[cell];
        }
        assert_true(work < 0);
        free_scene(&s);
    }
}

static void no_fluid_passes_the_rim(void **state) {
    (void)state;
    scene s = make_scene(20, 20, 0, 0);
    fill(&s, 0, 3);
    work_out(&s);
    double before[400];
    memcpy(before, s.source_term, sizeof before);
    int rim = 0;
    for (int cell = 0; cell < cell_count(&s); cell++) {
        if (s.kind[cell] == ILSA_CELL_EMPTY) {
            s.width[cell] = 1e6;
            s.pressure[cell] = NAN;
        }
    }
    work_out(&s);
    assert_memory_equal(before, s.source_term, sizeof before);
    for (int at = 0; at < GRID_FACES * s.a.count; at++) {
        if (s.a.neighbour[at] < 0) {
            assert_true(s.f.by_pressure[at] == 0 && s.f.by_width[at] == 0);
            rim++;
        } else {
            assert_true(s.f.by_pressure[at] > 0);
        }
    }
    assert_true(rim > 50);
    free_scene(&s);
}

static void even_pressure_moves_nothing(void **state) {
    (void)state;
    scene s = make_scene(20, 20, 0, 1);
    fill(&s, 2, 3);
    for (int cell = 0; cell < cell_count(&s); cell++) {
        s.pressure[cell] = 123.456;
    }
    work_out(&s);
    for (int cell = 0; cell < cell_count(&s); cell++) {
        assert_true(s.source_term[cell] == 0);
    }
    for (int at = 0; at < GRID_FACES * s.a.count; at++) {
        assert_true(s.f.by_width[at] == 0);
    }
    free_scene(&s);
}

/* Poiseuille: per length of front q = w^3 / mu' times the fall of pressure; divergence of q. */
static void uniform_width_gives_the_analytic_flux(void **state) {
    (void)state;
    double w = 0.7, px = 3, py = -2, pxx = 0.4, pyy = 1.1, scale = dt_over_mu * w * w * w;
    scene s = make_scene(14, 11, 0, 0);
    for (int cell = 0; cell < cell_count(&s); cell++) {
        double x = ilsai_grid_x(&s.g, cell % s.g.nx), y = ilsai_grid_y(&s.g, cell / s.g.nx);
        s.kind[cell] = ILSA_CELL_CHANNEL;
        s.width[cell] = w;
        s.pressure[cell] = 10 + px * x + py * y + 0.5 * pxx * x * x + 0.5 * pyy * y * y;
    }
    work_out(&s);
    for (int cell = 0; cell < cell_count(&s); cell++) {
        int i = cell % s.g.nx, j = cell / s.g.nx;
        double x = ilsai_grid_x(&s.g, i), y = ilsai_grid_y(&s.g, j);
        double east = i == s.g.nx - 1 ? 0 : px + pxx * (x + 0.5 * s.g.dx);
        double west = i == 0 ? 0 : px + pxx * (x - 0.5 * s.g.dx);
        double north = j == s.g.ny - 1 ? 0 : py + pyy * (y + 0.5 * s.g.dy);
        double south = j == 0 ? 0 : py + pyy * (y - 0.5 * s.g.dy);
        double gain = scale * ((east - west) / s.g.dx + (north - south) / s.g.dy);
        assert_true(fabs(s.source_term[cell] - gain) < 1e-12);
    }
    free_scene(&s);
}

/* Across a face the width is the mean of both sides, (4.3). */
static void edge_width_is_the_mean(void **state) {
    (void)state;
    scene s = make_scene(5, 5, 0, 0);
    static const int pair[][2] = {{12, 13}, {12, 17}};
    static const double h[] = {0.5, 0.8};
    for (int n = 0; n < 2; n++) {
        memset(s.kind, ILSA_CELL_EMPTY, 25);
        int a = pair[n][0], b = pair[n][1];
        s.kind[a] = ILSA_CELL_CHANNEL;
        s.kind[b] = ILSA_CELL_TIP;
        s.width[a] = 1.2;
        s.width[b] = 0.2;
        s.pressure[a] = 9;
        s.pressure[b] = 5;
        work_out(&s);
        double gain = dt_over_mu * 0.343 * 4 / (h[n] * h[n]);
        assert_true(fabs(s.source_term[b] - gain) < 1e-14 && s.source_term[a] == -s.source_term[b]);
    }
    free_scene(&s);
}

/* Of the three factors of the width one is the mean over the step, from dry on. */
static void one_factor_is_the_mean_over_the_step(void **state) {
    (void)state;
    scene s = make_scene(5, 5, 0, 0);
    s.kind[12] = s.kind[13] = ILSA_CELL_CHANNEL;
    s.width[12] = 0.8;
    s.width[13] = 0.6;
    s.pressure[12] = 2;
    s.pressure[13] = 1;
    work_out(&s);
    double before = s.f.by_pressure[GRID_FACES * s.a.number[12] + GRID_RIGHT];
    for (int dry = 0; dry < 2; dry++) {
        s.width_old[12] = 0.4;
        s.width_old[13] = dry ? 0 : 0.2;
        set_fluxes(&s);
        double now = s.f.by_pressure[GRID_FACES * s.a.number[12] + GRID_RIGHT];
        double mean = 0.5 * (0.7 + 0.5 * (0.4 + s.width_old[13]));
        assert_true(fabs(now / before - mean / 0.7) < 1e-15);
    }
    free_scene(&s);
}

/* Gain of one face as the operator has it. */
static double face_gain(scene *s, int at) {
    set_fluxes(s);
    int here = s->a.cell[at / GRID_FACES], there = s->a.cell[s->a.neighbour[at]];
    assert_true(s->f.flux[at] == s->f.by_pressure[at] * (s->pressure[there] - s->pressure[here]));
    return s->f.flux[at];
}

/* Central difference, exact for a cubic with two step sizes. */
static double difference(scene *s, int at, double *width, double h) {
    double w = *width, d[2];
    for (int n = 0; n < 2; n++) {
        *width = w + h * (n + 1);
        d[n] = face_gain(s, at);
        *width = w - h * (n + 1);
        d[n] = (d[n] - face_gain(s, at)) / (2 * h * (n + 1));
    }
    *width = w;
    return (4 * d[0] - d[1]) / 3;
}

static void slope_is_the_derivative(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    scene s = make_scene(12, 10, 0, 0);
    fill(&s, 0, 13);
    work_out(&s);
    for (int at = 0; at < GRID_FACES * s.a.count; at++) {
        if (s.a.neighbour[at] < 0) {
            continue;
        }
        double slope = s.f.by_width[at];
        int here = s.a.cell[at / GRID_FACES], there = s.a.cell[s.a.neighbour[at]];
        worst = worst_of(worst, fabs(difference(&s, at, &s.width[here], 0.05) - slope));
        worst = worst_of(worst, fabs(difference(&s, at, &s.width[there], 0.05) - slope));
        face_gain(&s, at);
    }
    print_message("slope: worst difference to finite differences %.2g\n", worst);
    assert_below(worst, 1e-12);
    free_scene(&s);
}

static void folded_gain_is_the_unfolded_one(void **state) {
    (void)state;
    for (int n = 0; n < 16; n++) {
        scene part = make_scene(24 + n / 4 % 2, 18 + n / 8, n % 2, n / 2 % 2);
        scene all = make_scene(24 + n / 4 % 2, 18 + n / 8, 0, 0);
        fill(&part, n % 4, 8);
        fill(&all, n % 4, 8);
        work_out(&part);
        work_out(&all);
        int stood_for = 0;
        for (int k = 0; k < part.a.count; k++) {
            int cell = part.a.cell[k];
            stood_for += weight(&part, cell);
            assert_true(fabs(part.source_term[cell] - all.source_term[cell]) < 1e-14);
        }
        assert_int_equal(stood_for, all.a.count);
        free_scene(&part);
        free_scene(&all);
    }
}

/* Memory */

static void no_memory_is_reported(void **state) {
    (void)state;
    scene s = make_scene(30, 30, 0, 0);
    fill(&s, 0, 4);
    for (int allowed = 0; allowed < 3; allowed++) {
        allocations_left = allowed;
        ilsa_status status = ilsai_unknowns_set(&s.a, &s.g, &s.footprint, s.kind);
        allocations_left = -1;
        assert_int_equal(status, ILSA_ERR_MEMORY);
        assert_int_equal(s.a.count, 0);
    }
    for (int allowed = 0; allowed < 2; allowed++) {
        allocations_left = allowed;
        ilsa_status status = ilsai_lubrication_reserve(&s.f, 900);
        allocations_left = -1;
        assert_int_equal(status, ILSA_ERR_MEMORY);
    }
    ilsa_mesh_def def = {30, 30, 1, 1};
    unknowns none;
    allocations_left = 0;
    ilsa_status status = ilsai_unknowns_create(&none, &def);
    allocations_left = -1;
    assert_int_equal(status, ILSA_ERR_MEMORY);
    ilsai_unknowns_destroy(&none);
    work_out(&s);
    assert_true(s.a.count > 100);
    free_scene(&s);
}

/* Contact */

/* The restrained inflow of every numbered cell, where each has an openness. */
static void restrain(scene *s, const double *openness, double *inflow) {
    double slope[400];
    for (int k = 0; k < s->a.count; k++) {
        slope[k] = openness[k] < 1;
    }
    set_fluxes(s);
    ilsai_contact_restrain(&s->f, &s->a, openness, slope);
    for (int k = 0; k < s->a.count; k++) {
        inflow[k] = ilsai_lubrication_inflow(&s->f, k);
    }
}

/* Every third cell closed, every seventh draining; none of their volume is lost. */
static void closed_cells_take_fluid_in_and_give_none(void **state) {
    (void)state;
    double openness[400] = {0}, inflow[400] = {0}, moved[400] = {0};
    double sum = 0, size = 0, worst = NOTHING_YET;
    scene s = make_scene(12, 10, 0, 0);
    fill(&s, 0, 13);
    work_out(&s);
    assert_true(s.a.count < 400);
    for (int k = 0; k < s.a.count; k++) {
        openness[k] = k % 3 == 0 ? 0 : k % 7 == 0 ? 0.3 : 1;
    }
    restrain(&s, openness, inflow);
    for (int k = 0; k < s.a.count; k++) {
        sum += inflow[k];
        size += fabs(inflow[k]);
        for (int face = 0; face < GRID_FACES; face++) {
            assert_true(openness[k] > 0 || s.f.flux[GRID_FACES * k + face] >= 0);
        }
    }
    assert_below(fabs(sum) / size, 1e-15);
    for (int k = 0; k < s.a.count; k++) {
        if (openness[k] == 1) {
            continue;
        }
        openness[k] += 0.5;
        restrain(&s, openness, moved);
        openness[k] -= 0.5;
        restrain(&s, openness, inflow);
        worst = worst_of(worst, fabs((moved[k] - inflow[k]) / 0.5 - s.f.by_own_width[k]));
        for (int face = 0; face < GRID_FACES; face++) {
            int other = s.a.neighbour[GRID_FACES * k + face];
            for (int back = 0; other >= 0 && back < GRID_FACES; back++) {
                int at = GRID_FACES * other + back;
                double change = (moved[other] - inflow[other]) / 0.5;
                worst = s.a.neighbour[at] != k
                            ? worst
                            : worst_of(worst, fabs(change - s.f.by_width_across[at]));
            }
        }
    }
    print_message("contact: derivatives by the openness off by %.2g\n", worst);
    assert_below(worst, 1e-12);
    free_scene(&s);
}

/* A cell of no width between wide ones, sucked at: the derivative would turn Newton's step. */
static void flow_into_an_opening_cell_is_calm(void **state) {
    (void)state;
    scene s = make_scene(12, 10, 0, 0);
    fill(&s, 0, 13);
    work_out(&s);
    int k = s.a.count / 2, calm = 0;
    s.width[s.a.cell[k]] = s.width_old[s.a.cell[k]] = 0;
    s.pressure[s.a.cell[k]] = -1e6;
    for (int turn = 0; turn < 2; turn++) {
        double kept = 0, self = turn ? 1e12 : 0;
        set_fluxes(&s);
        ilsai_contact_calm(&s.f, &s.a, k, self);
        for (int face = 0; face < GRID_FACES; face++) {
            kept += fabs(s.f.by_width[GRID_FACES * k + face]);
        }
        calm += turn ? kept > 0 : kept == 0;
        assert_true(ilsai_lubrication_inflow(&s.f, k) > 0);
    }
    assert_int_equal(calm, 2);
    free_scene(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(active_cells_are_the_representatives_that_are_not_empty),
        cmocka_unit_test(numbers_run_along_the_shorter_side),
        cmocka_unit_test(cells_of_the_last_list_are_forgotten),
        cmocka_unit_test(volume_is_conserved),
        cmocka_unit_test(flow_dissipates),
        cmocka_unit_test(no_fluid_passes_the_rim),
        cmocka_unit_test(even_pressure_moves_nothing),
        cmocka_unit_test(uniform_width_gives_the_analytic_flux),
        cmocka_unit_test(edge_width_is_the_mean),
        cmocka_unit_test(one_factor_is_the_mean_over_the_step),
        cmocka_unit_test(slope_is_the_derivative),
        cmocka_unit_test(folded_gain_is_the_unfolded_one),
        cmocka_unit_test(no_memory_is_reported),
        cmocka_unit_test(closed_cells_take_fluid_in_and_give_none),
        cmocka_unit_test(flow_into_an_opening_cell_is_calm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
