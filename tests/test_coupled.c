/* The coupled system (4.4) to (4.8): its Newton matrix and its solution, against residuals worked
 * out cell by cell on the unfolded mesh with the kernel summed directly. */
#include "base/tuning.h"
#include "check.h"
#include "elastic/dd_kernel.h"
#include "failing.h"
#include "flow/newtonian.h"
#include "solve/coupled.h"
#include "solve/gmres.h"
#include "solve/jacobian.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double *zeros(size_t count) {
    double *x = calloc(count > 0 ? count : 1, sizeof *x);
    if (!x) {
        abort();
    }
    return x;
}

/* A fracture on the mesh: its fields are symmetric as mirror says, its grid folded or not. */
typedef struct scene {
    grid g;
    int mirror; /* bit 0: about x = 0, bit 1: about y = 0 */
    size_t cells;
    double E_prime, dt;
    ilsa_material_def material; /* of which the viscosity counts */
    unsigned char *kind;
    double *width, *width_old, *pressure, *sigma, *source_term;
    double *kernel; /* |i|, |j| */
    box footprint;
    sensitivity *sensitivity; /* none unless a test adds them */
    int sensitivity_count;
    elasticity *e;
    coupled *c;
} scene;

static int mirrored(int mirror, int n, int i) {
    return mirror && n - 1 - i > i ? n - 1 - i : i;
}

/* The cell on the positive side. */
static int representative(const scene *s, int cell) {
    int i = mirrored(s->mirror & 1, s->g.nx, cell % s->g.nx);
    int j = mirrored(s->mirror >> 1, s->g.ny, cell / s->g.nx);
    return j * s->g.nx + i;
}

/* The same number in all images of a cell. */
static double noise(const scene *s, int cell, uint64_t salt) {
    uint64_t seed = salt + 7919u * (uint64_t)representative(s, cell);
    next_random(&seed);
    next_random(&seed);
    return next_random(&seed);
}

static void fill_kinds(scene *s, uint64_t salt) {
    s->footprint = (box){s->g.nx, -1, s->g.ny, -1};
    for (int cell = 0; cell < (int)s->cells; cell++) {
        int i = cell % s->g.nx, j = cell / s->g.nx;
        double x = 2 * ilsai_grid_x(&s->g, i) / (s->g.nx * s->g.dx);
        double y = 2 * ilsai_grid_y(&s->g, j) / (s->g.ny * s->g.dy);
        double r = hypot(x, y) + 0.05 * noise(s, cell, salt);
        s->kind[cell] = r < 0.6    ? ILSA_CELL_CHANNEL
                        : r < 0.75 ? ILSA_CELL_SURVEY
                        : r < 0.9  ? ILSA_CELL_TIP
                                   : ILSA_CELL_EMPTY;
        if (s->kind[cell] != ILSA_CELL_EMPTY) {
            ilsai_box_add(&s->footprint, i, j);
        }
        double w = sqrt(fmax(1 - r * r, 0));
        int wet = s->kind[cell] != ILSA_CELL_EMPTY;
        s->width_old[cell] = wet ? w * (1 + 0.05 * noise(s, cell, salt + 1)) : 0;
        s->width[cell] = wet ? w * (1.05 + 0.05 * noise(s, cell, salt + 2)) : 0;
        s->pressure[cell] = 0.4 + 0.1 * noise(s, cell, salt + 3);
        s->sigma[cell] = 0.05 + 0.05 * noise(s, cell, salt + 4);
        s->source_term[cell] =
            0.03 * exp(-20 * (x * x + y * y)) - 0.001 * (1 + noise(s, cell, salt + 5));
    }
}

static scene make_scene(int nx, int ny, int mirror, int folded, uint64_t salt) {
    ilsa_mesh_def def = {nx, ny, 0.5, 0.8};
    scene s = {.g = ilsai_grid(&def, folded & 1, folded >> 1), .mirror = mirror};
    s.cells = (size_t)nx * (size_t)ny;
    s.E_prime = 2;
    s.material.mu_prime = 0.7;
    s.dt = 1.5;
    s.kind = calloc(s.cells, 1);
    s.width = zeros(s.cells);
    s.width_old = zeros(s.cells);
    s.pressure = zeros(s.cells);
    s.sigma = zeros(s.cells);
    s.source_term = zeros(s.cells);
    s.kernel = zeros(s.cells);
    for (int cell = 0; cell < (int)s.cells; cell++) {
        s.kernel[cell] = s.E_prime * ilsai_dd_kernel(cell % nx, cell / nx, def.dx, def.dy);
    }
    assert_non_null(s.kind);
    ilsa_status status =
        ilsai_elasticity_create(s.E_prime, def.dx, def.dy, ILSA_PRODUCT_AUTO, &s.e);
    assert_int_equal(status, ILSA_OK);
    s.c = ilsai_coupled_create(&def);
    assert_non_null(s.c);
    fill_kinds(&s, salt);
    return s;
}

static void free_scene(scene *s) {
    free(s->kind);
    free(s->width);
    free(s->width_old);
    free(s->pressure);
    free(s->sigma);
    free(s->source_term);
    free(s->kernel);
    free(s->sensitivity);
    ilsai_elasticity_destroy(&s->e);
    ilsai_coupled_destroy(&s->c);
}

static int is_channel(const scene *s, int cell) {
    return s->kind[cell] >= ILSA_CELL_SURVEY;
}

/* C w at a cell, entries no further than reach. */
static double elastic_pressure(const scene *s, const double *width, int cell, int reach) {
    int nx = s->g.nx, i = cell % nx, j = cell / nx;
    double sum = 0;
    for (int other = 0; other < (int)s->cells; other++) {
        int di = abs(other % nx - i), dj = abs(other / nx - j);
        if (width[other] != 0 && di <= reach && dj <= reach) {
            sum += s->kernel[dj * nx + di] * width[other];
        }
    }
    return sum;
}

enum { EVERYWHERE = 1 << 20 };

/* w - w_old - dt A(w) p - S of one cell, (4.3) and (4.4). */
static double residual_at(const scene *s, const double *width, const double *pressure, int cell) {
    int i = cell % s->g.nx, j = cell / s->g.nx;
    const int to[4][2] = {{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}};
    double sum = 0;
    for (int n = 0; n < 4; n++) {
        int other = to[n][1] * s->g.nx + to[n][0];
        if (to[n][0] < 0 || to[n][0] >= s->g.nx || to[n][1] < 0 || to[n][1] >= s->g.ny ||
            s->kind[other] == ILSA_CELL_EMPTY) {
            continue;
        }
        double edge = 0.5 * (width[cell] + width[other]), h = n < 2 ? s->g.dx : s->g.dy;
        double mean = 0.5 * edge + 0.25 * (s->width_old[cell] + s->width_old[other]);
        sum += mean * edge * edge * (pressure[other] - pressure[cell]) /
               (s->material.mu_prime * h * h);
    }
    return width[cell] - s->width_old[cell] - s->dt * sum - s->source_term[cell];
}

/* The sensitivity of a cell's representative, NULL if it has none. */
static const sensitivity *sensitivity_of(const scene *s, int cell) {
    for (int r = 0; r < s->sensitivity_count; r++) {
        if (s->sensitivity[r].cell == representative(s, cell)) {
            return &s->sensitivity[r];
        }
    }
    return NULL;
}

static int is_near(const scene *s, int a, int b) {
    int nx = s->g.nx;
    return abs(a % nx - b % nx) <= 2 && abs(a / nx - b / nx) <= 2;
}

static int is_representative(const scene *s, int cell) {
    return ilsai_grid_fold(&s->g, cell % s->g.nx, cell / s->g.nx) == cell;
}

/* Every tip cell answers to survey cells around it, every fourth survey cell by its source term. */
static void add_responses(scene *s) {
    s->sensitivity = calloc(s->cells, sizeof *s->sensitivity);
    assert_non_null(s->sensitivity);
    for (int cell = 0; cell < (int)s->cells; cell++) {
        int tip = s->kind[cell] == ILSA_CELL_TIP;
        int full = s->kind[cell] == ILSA_CELL_SURVEY && cell % 4 == 0;
        if (!is_representative(s, cell) || (!tip && !full)) {
            continue;
        }
        sensitivity *r = &s->sensitivity[s->sensitivity_count++];
        r->cell = cell;
        for (int from = 0; from < (int)s->cells && r->count < SENSITIVITY_PARENTS; from++) {
            if (s->kind[from] == ILSA_CELL_SURVEY && is_near(s, from, cell) &&
                is_representative(s, from)) {
                r->from[r->count] = from;
                r->width[r->count] = tip ? 0.1 * (1 + noise(s, from, 21)) : 0;
                r->source_term[r->count++] = -0.02 * (1 + noise(s, from, 22));
            }
        }
    }
}

/* The Newton matrix */

typedef struct matrix {
    unknowns a;
    lubrication f;
    jacobian m;
} matrix;

/* Channel pressures of the scene's widths; the matrix at that point. */
static void make_matrix(scene *s, matrix *at) {
    ilsa_mesh_def def = {s->g.nx, s->g.ny, s->g.dx, s->g.dy};
    const box *b = &s->footprint;
    for (int cell = 0; cell < (int)s->cells; cell++) {
        if (is_channel(s, cell)) {
            s->pressure[cell] = s->sigma[cell] + elastic_pressure(s, s->width, cell, EVERYWHERE);
        }
    }
    *at = (matrix){0};
    assert_int_equal(ilsai_unknowns_create(&at->a, &def), ILSA_OK);
    assert_int_equal(ilsai_unknowns_set(&at->a, &s->g, b, s->kind), ILSA_OK);
    assert_int_equal(ilsai_lubrication_reserve(&at->f, at->a.count), ILSA_OK);
    const flow_state state = {.g = &s->g,
                              .cells = &at->a,
                              .material = &s->material,
                              .dt = s->dt,
                              .width = s->width,
                              .width_old = s->width_old,
                              .pressure = s->pressure};
    ilsai_newtonian.set_fluxes(&at->f, &state);
    box part = ilsai_box_fold(&s->g, b);
    assert_int_equal(
        ilsai_elasticity_set_box(s->e, &part, ilsai_grid_about_x(&s->g), ilsai_grid_about_y(&s->g)),
        ILSA_OK);
    at->m = (jacobian){.g = &s->g, .cells = &at->a, .lubrication = &at->f, .elastic = s->e};
    at->m.width = zeros(s->cells);
    at->m.pressure = zeros(s->cells);
    at->m.sensitivity = s->sensitivity;
    at->m.self_correction = zeros((size_t)at->a.count);
    at->m.leakoff_by_fill = zeros((size_t)at->a.count);
    at->m.fill = zeros((size_t)at->a.count);
    for (int k = 0; k < at->a.count; k++) {
        at->m.fill[k] = 1;
    }
    at->m.sensitivity_of = malloc((size_t)at->a.count * sizeof *at->m.sensitivity_of);
    assert_non_null(at->m.sensitivity_of);
    for (int k = 0; k < at->a.count; k++) {
        const sensitivity *r = sensitivity_of(s, at->a.cell[k]);
        at->m.sensitivity_of[k] = r ? (int)(r - s->sensitivity) : -1;
    }
}

static void free_matrix(matrix *at) {
    ilsai_jacobian_destroy(&at->m);
    ilsai_lubrication_destroy(&at->f);
    ilsai_unknowns_destroy(&at->a);
}

/* Weights of a sensitivity times the changes of the unknowns. */
static double answer(const sensitivity *r, const double *weight, const unknowns *a,
                     const double *x) {
    double sum = 0;
    for (int p = 0; r && p < r->count; p++) {
        sum += weight[p] * x[a->number[r->from[p]]];
    }
    return sum;
}

/* The unknowns x as changes over the whole mesh: of widths in channel cells, of tip pressures. */
static void spread(const scene *s, const unknowns *a, const double *x, double *width,
                   double *pressure) {
    memset(width, 0, s->cells * sizeof *width);
    memset(pressure, 0, s->cells * sizeof *pressure);
    for (int cell = 0; cell < (int)s->cells; cell++) {
        int number = a->number[representative(s, cell)];
        if (number >= 0) {
            const sensitivity *r = sensitivity_of(s, cell);
            *(is_channel(s, cell) ? &width[cell] : &pressure[cell]) = x[number];
            width[cell] += r && !is_channel(s, cell) ? answer(r, r->width, a, x) : 0;
        }
    }
}

/* Residual of every numbered cell with the unknowns changed by t x, C cut beyond reach. */
static void residual_along(const scene *s, const unknowns *a, const double *x, double t, int reach,
                           double *out) {
    double *width = zeros(s->cells), *pressure = zeros(s->cells), *change = zeros(s->cells);
    spread(s, a, x, change, pressure);
    for (int cell = 0; cell < (int)s->cells; cell++) {
        if (is_channel(s, cell)) {
            pressure[cell] = elastic_pressure(s, change, cell, reach);
        }
        width[cell] = s->width[cell] + t * change[cell];
        pressure[cell] = s->pressure[cell] + t * pressure[cell];
    }
    for (int k = 0; k < a->count; k++) {
        const sensitivity *r = sensitivity_of(s, a->cell[k]);
        out[k] = residual_at(s, width, pressure, a->cell[k]);
        out[k] -= r ? t * answer(r, r->source_term, a, x) : 0;
    }
    free(width);
    free(pressure);
    free(change);
}

/* Derivative of the residual along x: central differences of two sizes are exact for a quartic. */
static void derivative(const scene *s, const unknowns *a, const double *x, int reach, double *out) {
    size_t n = (size_t)a->count;
    double *r[4];
    static const double t[] = {-0.2, -0.1, 0.1, 0.2};
    for (int k = 0; k < 4; k++) {
        r[k] = zeros(n);
        residual_along(s, a, x, t[k], reach, r[k]);
    }
    for (size_t k = 0; k < n; k++) {
        out[k] = (4 * (r[2][k] - r[1][k]) / 0.2 - (r[3][k] - r[0][k]) / 0.4) / 3;
    }
    for (int k = 0; k < 4; k++) {
        free(r[k]);
    }
}

static double *random_vector(int n, uint64_t seed) {
    double *x = zeros((size_t)n);
    for (int k = 0; k < n; k++) {
        x[k] = next_random(&seed);
    }
    return x;
}

/* Largest difference over the largest value of the second. */
static double relative_difference(int n, const double *x, const double *truth) {
    double worst = NOTHING_YET, largest = 0;
    for (int k = 0; k < n; k++) {
        worst = worst_of(worst, fabs(x[k] - truth[k]));
        largest = larger_of(largest, fabs(truth[k]));
    }
    return worst / largest;
}

/* Sizes even and odd, each mirror: number 0 .. FOLDS - 1. */
enum { FOLDS = 16 };

static scene nth_scene(int n, int folded, uint64_t salt) {
    return make_scene(17 + n / 4 % 2, 13 + n / 8, n % 4, folded ? n % 4 : 0, salt);
}

/* Largest difference of the product to finite differences, and of the dense solution to x. */
static void compare_matrix(int sensitivities, double *product, double *dense) {
    for (int n = 0; n < FOLDS; n++) {
        scene s = nth_scene(n, 1, 5);
        matrix at;
        if (sensitivities) {
            add_responses(&s);
            assert_true(s.sensitivity_count > 5);
        }
        make_matrix(&s, &at);
        int count = at.a.count;
        double *x = random_vector(count, 3), *y = zeros((size_t)count), *d = zeros((size_t)count);
        ilsai_jacobian_multiply(&at.m, x, y);
        derivative(&s, &at.a, x, EVERYWHERE, d);
        *product = worst_of(*product, relative_difference(count, y, d));
        assert_int_equal(at.m.products, 1);
        for (size_t cell = 0; cell < s.cells; cell++) {
            assert_true(at.m.width[cell] == 0); /* ready for the next product */
        }
        assert_int_equal(ilsai_jacobian_set_influence(&at.m), ILSA_OK);
        assert_int_equal(ilsai_jacobian_solve_full(&at.m, d, y), ILSA_OK);
        *dense = worst_of(*dense, relative_difference(count, y, x));
        free(x);
        free(y);
        free(d);
        free_matrix(&at);
        free_scene(&s);
    }
}

static void matrix_is_the_derivative(void **state) {
    (void)state;
    double product = NOTHING_YET, dense = NOTHING_YET;
    compare_matrix(0, &product, &dense);
    print_message("Newton matrix: off by %.2g, solved dense to %.2g\n", product, dense);
    assert_below(product, 1e-12);
    assert_below(dense, 1e-10);
}

/* Tip widths and source terms that answer to the survey widths. */
static void matrix_with_responses_is_the_derivative(void **state) {
    (void)state;
    double product = NOTHING_YET, dense = NOTHING_YET;
    compare_matrix(1, &product, &dense);
    print_message("Newton matrix with sensitivities: off by %.2g, solved dense to %.2g\n", product,
                  dense);
    assert_below(product, 1e-12);
    assert_below(dense, 1e-10);
}

/*
 * Every fifth channel cell closed, every seventh draining; of the tip cells a third that no fluid
 * reaches, a third at a bound of their pressure.
 */
static void close_some(matrix *at) {
    int count = at->a.count;
    double *openness = zeros((size_t)count), *slope = zeros((size_t)count);
    for (int k = 0; k < count; k++) {
        openness[k] = 1;
        if (at->a.unknown[k] == UNKNOWN_WIDTH && (k % 5 == 0 || k % 7 == 0)) {
            openness[k] = k % 5 == 0 ? 0 : 0.3;
            slope[k] = 1e5;
        } else if (at->a.unknown[k] == UNKNOWN_PRESSURE && k % 3 != 0) {
            at->a.unknown[k] = k % 3 == 1 ? UNKNOWN_NONE : UNKNOWN_FILL;
            at->m.fill[k] = k % 3 == 1 ? 1 : 0.4;
            at->m.leakoff_by_fill[k] = k % 3 == 1 ? 0 : 0.7;
        }
    }
    ilsai_contact_restrain(&at->f, &at->a, openness, slope);
    free(openness);
    free(slope);
}

/* With closed cells the product, the full matrix and the preconditioner are of one system. */
static void closed_cells_are_in_matrix_and_preconditioner(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    int most = 0;
    for (int n = 0; n < FOLDS; n++) {
        scene s = nth_scene(n, 1, 8);
        matrix at;
        add_responses(&s);
        make_matrix(&s, &at);
        close_some(&at);
        int count = at.a.count;
        double *x = random_vector(count, 9), *b = zeros((size_t)count), *y = zeros((size_t)count);
        ilsai_jacobian_multiply(&at.m, x, b);
        assert_int_equal(ilsai_jacobian_set_influence(&at.m), ILSA_OK);
        assert_int_equal(ilsai_jacobian_solve_full(&at.m, b, y), ILSA_OK);
        worst = worst_of(worst, relative_difference(count, y, x));
        assert_int_equal(ilsai_jacobian_set_preconditioner(&at.m), ILSA_OK);
        gmres *krylov = ilsai_gmres_create(60);
        assert_int_equal(ilsai_gmres_reserve(krylov, (size_t)count), ILSA_OK);
        gmres_result result = ilsai_gmres_solve(krylov, (size_t)count, ilsai_jacobian_multiply,
                                                ilsai_jacobian_precondition, &at.m, b, y, 1e-8, 60);
        assert_true(result.converged);
        most = result.iterations > most ? result.iterations : most;
        ilsai_gmres_destroy(&krylov);
        free(x);
        free(b);
        free(y);
        free_matrix(&at);
        free_scene(&s);
    }
    print_message("Newton matrix with closed cells: dense off by %.2g, at most %d iterations\n",
                  worst, most);
    /* Tip cells among others that no fluid reaches hang on a soft spring: 1.3e-7 measured. */
    assert_below(worst, 1e-6);
}

/* Widths of cells at random are products that a wrong neighbour or image would not survive. */
static void product_is_linear(void **state) {
    (void)state;
    scene s = nth_scene(3, 1, 6);
    matrix at;
    make_matrix(&s, &at);
    int n = at.a.count;
    double *x = random_vector(n, 1), *y = random_vector(n, 2), *sum = zeros((size_t)n);
    double *mx = zeros((size_t)n), *my = zeros((size_t)n), *msum = zeros((size_t)n);
    for (int k = 0; k < n; k++) {
        sum[k] = 2 * x[k] - 3 * y[k];
    }
    ilsai_jacobian_multiply(&at.m, x, mx);
    ilsai_jacobian_multiply(&at.m, y, my);
    ilsai_jacobian_multiply(&at.m, sum, msum);
    for (int k = 0; k < n; k++) {
        mx[k] = 2 * mx[k] - 3 * my[k];
    }
    assert_below(relative_difference(n, mx, msum), 1e-14);
    free(x);
    free(y);
    free(sum);
    free(mx);
    free(my);
    free(msum);
    free_matrix(&at);
    free_scene(&s);
}

/* The preconditioner is one linear operator, and GMRES needs few iterations with it. */
static void preconditioner_is_linear_and_serves(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    int most = 0;
    for (int n = 0; n < FOLDS; n++) {
        scene s = nth_scene(n, 1, 7);
        matrix at;
        make_matrix(&s, &at);
        int count = at.a.count;
        size_t size = (size_t)count;
        double *x = random_vector(count, 4), *y = random_vector(count, 5), *sum = zeros(size);
        double *px = zeros(size), *py = zeros(size), *psum = zeros(size);
        assert_int_equal(ilsai_jacobian_set_preconditioner(&at.m), ILSA_OK);
        ilsai_jacobian_precondition(&at.m, x, px);
        ilsai_jacobian_precondition(&at.m, y, py);
        for (int k = 0; k < count; k++) {
            sum[k] = 3 * x[k] - 0.5 * y[k];
            px[k] = 3 * px[k] - 0.5 * py[k];
        }
        ilsai_jacobian_precondition(&at.m, sum, psum);
        worst = worst_of(worst, relative_difference(count, psum, px));
        gmres *krylov = ilsai_gmres_create(60);
        assert_int_equal(ilsai_gmres_reserve(krylov, size), ILSA_OK);
        gmres_result result = ilsai_gmres_solve(krylov, size, ilsai_jacobian_multiply,
                                                ilsai_jacobian_precondition, &at.m, x, y, 1e-6, 60);
        assert_true(result.converged);
        most = result.iterations > most ? result.iterations : most;
        ilsai_gmres_destroy(&krylov);
        free(x);
        free(y);
        free(sum);
        free(px);
        free(py);
        free(psum);
        free_matrix(&at);
        free_scene(&s);
    }
    print_message("preconditioner: linear to %.2g, at most %d iterations to 1e-6\n", worst, most);
    assert_below(worst, 1e-12);
    assert_true(most < 40);
}

/* The solution */

static coupled_problem pose(scene *s, ilsa_linear_solver linear, double tolerance) {
    return (coupled_problem){.g = &s->g,
                             .elastic = s->e,
                             .footprint = s->footprint,
                             .kind = s->kind,
                             .sigma = s->sigma,
                             .width_old = s->width_old,
                             .source_term = s->source_term,
                             .sensitivity = s->sensitivity,
                             .sensitivity_count = s->sensitivity_count,
                             .width = s->width,
                             .pressure = s->pressure,
                             .dt = s->dt,
                             .fluid = &ilsai_newtonian,
                             .material = &s->material,
                             .linear = linear,
                             .tolerance = tolerance};
}

static int is_image(const scene *s, int cell) {
    return ilsai_grid_fold(&s->g, cell % s->g.nx, cell / s->g.nx) != cell;
}

/* Solves and brings the pressures up to date, without the images; they are filled in here. */
static coupled_counts solve(scene *s, ilsa_linear_solver linear, double tolerance) {
    coupled_counts counts = {0, 0, 0, 0, 0};
    coupled_problem problem = pose(s, linear, tolerance);
    for (int cell = 0; cell < (int)s->cells; cell++) {
        s->width[cell] = is_image(s, cell) ? NAN : s->width[cell];
    }
    assert_int_equal(ilsai_coupled_solve(s->c, &problem, &counts), ILSA_OK);
    ilsai_coupled_pressure(s->c, &problem, &counts);
    for (int cell = 0; cell < (int)s->cells; cell++) {
        if (is_image(s, cell)) {
            assert_true(isnan(s->width[cell])); /* nothing is written there */
            s->width[cell] = s->width[representative(s, cell)];
            s->pressure[cell] = s->pressure[representative(s, cell)];
        }
    }
    return counts;
}

/* Largest of the residual over all numbered cells, and of p - sigma - C w, both as parts of the
 * largest width and pressure. */
static double worst_residual(const scene *s) {
    double balance = NOTHING_YET, elastic = NOTHING_YET, w = 0, p = 0;
    for (int cell = 0; cell < (int)s->cells; cell++) {
        if (s->kind[cell] == ILSA_CELL_EMPTY) {
            continue;
        }
        w = larger_of(w, s->width[cell]);
        balance = worst_of(balance, fabs(residual_at(s, s->width, s->pressure, cell)));
        if (is_channel(s, cell)) {
            double C_w = elastic_pressure(s, s->width, cell, EVERYWHERE);
            p = larger_of(p, fabs(s->pressure[cell]));
            elastic = worst_of(elastic, fabs(s->pressure[cell] - s->sigma[cell] - C_w));
        }
    }
    return worst_of(balance / w, elastic / p);
}

static const ilsa_linear_solver solvers[] = {ILSA_LINEAR_DENSE, ILSA_LINEAR_GMRES};

/* Channel cells by their widths, tip cells by their pressures: every cell's volume balances. */
static void solution_satisfies_the_equations(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    long most = 0;
    for (int n = 0; n < 2 * FOLDS; n++) {
        scene s = nth_scene(n / 2, 1, 10 + (uint64_t)n);
        coupled_counts counts = solve(&s, solvers[n % 2], 1e-11);
        worst = worst_of(worst, worst_residual(&s));
        most = counts.newton > most ? counts.newton : most;
        free_scene(&s);
    }
    print_message("solution: worst residual %.2g, at most %ld Newton iterations\n", worst, most);
    assert_below(worst, 1e-10);
    assert_true(most < ILSAI_NEWTON_MAX / 2);
}

/* What the tip has been given stays, all widths are positive. */
static void only_channel_widths_change(void **state) {
    (void)state;
    for (int n = 0; n < FOLDS; n++) {
        scene s = nth_scene(n, 1, 40), before = nth_scene(n, 1, 40);
        solve(&s, ILSA_LINEAR_AUTO, 1e-6);
        int changed = 0;
        for (int cell = 0; cell < (int)s.cells; cell++) {
            if (is_channel(&s, cell)) {
                assert_true(s.width[cell] > 0);
                changed += s.width[cell] != before.width[cell];
            } else {
                assert_true(s.width[cell] == before.width[cell]);
            }
        }
        assert_true(changed > 20);
        free_scene(&s);
        free_scene(&before);
    }
}

static double width_difference(const scene *s, const scene *truth) {
    return relative_difference((int)s->cells, s->width, truth->width);
}

/* Tip widths and source terms end where the sensitivities say, and every cell balances with them.
 */
static double worst_with_responses(const scene *s, const scene *before) {
    double worst = NOTHING_YET;
    for (int cell = 0; cell < (int)s->cells; cell++) {
        const sensitivity *r = sensitivity_of(s, cell);
        double width = 0, gain = 0;
        for (int p = 0; r && p < r->count; p++) {
            double change = s->width[r->from[p]] - before->width[r->from[p]];
            width += r->width[p] * change;
            gain += r->source_term[p] * change;
        }
        if (s->kind[cell] == ILSA_CELL_TIP) {
            worst = worst_of(worst, fabs(s->width[cell] - before->width[cell] - width));
        }
        if (s->kind[cell] != ILSA_CELL_EMPTY) {
            double balance = residual_at(s, s->width, s->pressure, cell);
            worst = worst_of(worst, fabs(balance - gain));
        }
    }
    return worst;
}

static void responses_are_followed(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    for (int n = 0; n < 2 * FOLDS; n++) {
        scene s = nth_scene(n / 2, 1, 44), before = nth_scene(n / 2, 1, 44);
        add_responses(&s);
        solve(&s, solvers[n % 2], 1e-11);
        worst = worst_of(worst, worst_with_responses(&s, &before));
        assert_true(width_difference(&s, &before) > 1e-3);
        free_scene(&s);
        free_scene(&before);
    }
    print_message("solution with sensitivities: worst residual %.2g\n", worst);
    assert_below(worst, 1e-9);
}

/* Injected = stored, summed over the whole mesh. */
static void volume_balances(void **state) {
    (void)state;
    for (int n = 0; n < FOLDS; n++) {
        scene s = nth_scene(n, 1, 41);
        solve(&s, ILSA_LINEAR_GMRES, 1e-10);
        double stored = 0, gained = 0, size = 0;
        for (int cell = 0; cell < (int)s.cells; cell++) {
            if (s.kind[cell] != ILSA_CELL_EMPTY) {
                stored += s.width[cell] - s.width_old[cell];
                gained += s.source_term[cell];
                size += s.width[cell];
            }
        }
        assert_true(fabs(stored - gained) < 1e-10 * size);
        free_scene(&s);
    }
}

static double pressure_difference(const scene *s, const scene *truth) {
    double worst = NOTHING_YET, largest = 0;
    for (size_t cell = 0; cell < s->cells; cell++) {
        if (s->kind[cell] != ILSA_CELL_EMPTY) {
            worst = worst_of(worst, fabs(s->pressure[cell] - truth->pressure[cell]));
            largest = larger_of(largest, fabs(truth->pressure[cell]));
        }
    }
    return worst / largest;
}

static void dense_and_iterative_agree(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    for (int n = 0; n < FOLDS; n++) {
        scene dense = nth_scene(n, 1, 50), iterative = nth_scene(n, 1, 50);
        coupled_counts by_dense = solve(&dense, ILSA_LINEAR_DENSE, 1e-12);
        coupled_counts by_gmres = solve(&iterative, ILSA_LINEAR_GMRES, 1e-12);
        assert_true(by_dense.krylov == 0 && by_gmres.krylov > 0);
        worst = worst_of(worst, width_difference(&iterative, &dense));
        worst = worst_of(worst, pressure_difference(&iterative, &dense));
        free_scene(&dense);
        free_scene(&iterative);
    }
    print_message("dense against iterative: %.2g\n", worst);
    assert_below(worst, 1e-9);
}

static void folded_solution_is_the_unfolded_one(void **state) {
    (void)state;
    double worst = NOTHING_YET;
    for (int n = 0; n < 2 * FOLDS; n++) {
        scene folded = nth_scene(n / 2, 1, 60), whole = nth_scene(n / 2, 0, 60);
        solve(&folded, solvers[n % 2], 1e-12);
        int count = ilsai_coupled_unknowns(folded.c);
        solve(&whole, ILSA_LINEAR_DENSE, 1e-12);
        worst = worst_of(worst, width_difference(&folded, &whole));
        worst = worst_of(worst, pressure_difference(&folded, &whole));
        int parts = (n / 2 & 1 ? 2 : 1) * (n / 2 & 2 ? 2 : 1);
        assert_true(count * parts >= ilsai_coupled_unknowns(whole.c));
        assert_true(parts == 1 || count < ilsai_coupled_unknowns(whole.c));
        free_scene(&folded);
        free_scene(&whole);
    }
    print_message("folded against unfolded: %.2g\n", worst);
    assert_below(worst, 1e-9);
}

/* Widths and tip pressures that hold still: found again from a disturbed guess. */
static void fluid_at_rest_stays_at_rest(void **state) {
    (void)state;
    scene s = nth_scene(3, 1, 70), rest = nth_scene(3, 1, 70);
    memset(s.source_term, 0, s.cells * sizeof *s.source_term);
    for (int cell = 0; cell < (int)s.cells; cell++) { /* stress that makes the pressure even */
        int wet = s.kind[cell] != ILSA_CELL_EMPTY;
        s.sigma[cell] = wet ? 3 - elastic_pressure(&rest, rest.width, cell, EVERYWHERE) : 0;
        s.width_old[cell] = rest.width[cell];
        s.width[cell] *= is_channel(&s, cell) ? 1 + 0.3 * noise(&s, cell, 5) : 1;
    }
    solve(&s, ILSA_LINEAR_GMRES, 1e-12);
    assert_below(width_difference(&s, &rest), 1e-10);
    for (int cell = 0; cell < (int)s.cells; cell++) {
        assert_true(s.kind[cell] == ILSA_CELL_EMPTY || fabs(s.pressure[cell] - 3) < 1e-9);
    }
    free_scene(&s);
    free_scene(&rest);
}

/* Given enough time the fluid finds one pressure, in the tip cells too. */
static void long_step_evens_the_pressure(void **state) {
    (void)state;
    for (int n = 0; n < 2; n++) {
        scene s = nth_scene(8, 1, 71);
        double low = INFINITY, high = -INFINITY;
        s.dt = 1e7;
        solve(&s, solvers[n], 1e-9);
        for (int cell = 0; cell < (int)s.cells; cell++) {
            if (s.kind[cell] != ILSA_CELL_EMPTY) {
                low = smaller_of(low, s.pressure[cell]);
                high = larger_of(high, s.pressure[cell]);
            }
        }
        assert_true(low > 0 && high - low < 1e-5 * high);
        free_scene(&s);
    }
}

/* The tolerance is the error that is left; with inexact linear solves, about. */
static void tolerance_bounds_the_error(void **state) {
    (void)state;
    static const double tolerance[] = {1e-2, 1e-3, 1e-5, 1e-8};
    for (size_t t = 0; t < sizeof tolerance / sizeof *tolerance; t++) {
        double worst[2] = {NOTHING_YET, NOTHING_YET};
        for (int n = 0; n < 2 * FOLDS; n++) {
            scene s = nth_scene(n / 2, 1, 80), sharp = nth_scene(n / 2, 1, 80);
            solve(&s, solvers[n % 2], tolerance[t]);
            solve(&sharp, ILSA_LINEAR_DENSE, 1e-13);
            worst[n % 2] = worst_of(worst[n % 2], width_difference(&s, &sharp) / tolerance[t]);
            free_scene(&s);
            free_scene(&sharp);
        }
        print_message("tolerance %g: worst error of width %.2g of it dense, %.2g iterative\n",
                      tolerance[t], worst[0], worst[1]);
        assert_below(worst[0], 1);
        assert_below(worst[1], 1.5);
    }
}

/* The scene in other units, by powers of two. */
static void change_units(scene *s, double width, double length, double stress, double time) {
    s->g.dx *= length;
    s->g.dy *= length;
    s->dt *= time;
    s->material.mu_prime *= stress * time * width * width / (length * length);
    ilsai_elasticity_destroy(&s->e);
    ilsa_status status = ilsai_elasticity_create(s->E_prime * stress * length / width, s->g.dx,
                                                 s->g.dy, ILSA_PRODUCT_AUTO, &s->e);
    assert_int_equal(status, ILSA_OK);
    for (size_t cell = 0; cell < s->cells; cell++) {
        s->width[cell] *= width;
        s->width_old[cell] *= width;
        s->source_term[cell] *= width;
        s->sigma[cell] *= stress;
        s->pressure[cell] *= stress;
    }
}

/* Worst difference between two scenes once the units of the second are taken away. */
static double unit_difference(const scene *s, const scene *t, double width, double stress) {
    double worst = NOTHING_YET;
    for (size_t cell = 0; cell < s->cells; cell++) {
        if (s->kind[cell] != ILSA_CELL_EMPTY) {
            worst = worst_of(worst, fabs(t->width[cell] / width - s->width[cell]));
            worst = worst_of(worst, fabs(t->pressure[cell] / stress - s->pressure[cell]));
        }
    }
    return worst;
}

/* The same bits. */
static void any_units(void **state) {
    (void)state;
    static const double width[] = {0x1p-11, 0x1p20, 0x1p-30}, stress[] = {0x1p21, 0x1p-30, 0x1p30};
    for (int n = 0; n < 6; n++) {
        scene s = nth_scene(2, 1, 90), t = nth_scene(2, 1, 90);
        change_units(&t, width[n / 2], 0x1p4, stress[n / 2], 0x1p12);
        solve(&s, solvers[n % 2], 1e-11);
        solve(&t, solvers[n % 2], 1e-11);
        double off = unit_difference(&s, &t, width[n / 2], stress[n / 2]);
        print_message("units of width %g, of stress %g: %s off by %.2g\n", width[n / 2],
                      stress[n / 2], n % 2 ? "iterative" : "dense", off);
        assert_true(off == 0);
        free_scene(&s);
        free_scene(&t);
    }
}

static void counts_are_added_to(void **state) {
    (void)state;
    scene s = nth_scene(0, 1, 91);
    coupled_counts counts = {100, 200, 300, 400, 500};
    coupled_problem problem = pose(&s, ILSA_LINEAR_GMRES, 1e-6);
    assert_int_equal(ilsai_coupled_solve(s.c, &problem, &counts), ILSA_OK);
    assert_true(counts.newton > 100 && counts.newton < 115);
    assert_true(counts.krylov > 200);
    assert_true(counts.products - 300 >= counts.newton - 100 + counts.krylov - 200);
    assert_true(counts.seconds_product > 400 && counts.seconds_preconditioner > 500);
    long products = counts.products;
    ilsai_coupled_pressure(s.c, &problem, &counts);
    assert_int_equal(counts.products, products + 1);
    free_scene(&s);
}

/* A solve is that of a new handle to the last bit, whatever was solved before. */
static void solves_use_nothing_of_the_last(void **state) {
    (void)state;
    scene s = make_scene(24, 20, 0, 0, 103), other = make_scene(24, 20, 0, 0, 103);
    scene alone = make_scene(24, 20, 0, 0, 103);
    coupled_counts counts = {0, 0, 0, 0, 0};
    other.dt = 0.02;
    coupled_problem before = pose(&other, ILSA_LINEAR_GMRES, 1e-6);
    coupled_problem problem = pose(&s, ILSA_LINEAR_GMRES, 1e-6);
    coupled_problem plain = pose(&alone, ILSA_LINEAR_GMRES, 1e-6);
    assert_int_equal(ilsai_coupled_solve(s.c, &before, &counts), ILSA_OK);
    assert_int_equal(ilsai_coupled_solve(s.c, &problem, &counts), ILSA_OK);
    assert_int_equal(ilsai_coupled_solve(alone.c, &plain, &counts), ILSA_OK);
    assert_memory_equal(s.width, alone.width, s.cells * sizeof *s.width);
    assert_memory_equal(s.pressure, alone.pressure, s.cells * sizeof *s.pressure);
    free_scene(&s);
    free_scene(&other);
    free_scene(&alone);
}

/* What cannot be solved */

static ilsa_status status_of(scene *s, ilsa_linear_solver linear) {
    coupled_counts counts = {0, 0, 0, 0, 0};
    coupled_problem problem = pose(s, linear, 1e-6);
    return ilsai_coupled_solve(s->c, &problem, &counts);
}

typedef void spoiler(scene *s);

static int middle(const scene *s) {
    return s->g.ny / 2 * s->g.nx + s->g.nx / 2;
}

static void spoil_width(scene *s) {
    s->width[middle(s)] = NAN;
}

static void spoil_gain(scene *s) {
    s->source_term[middle(s)] = INFINITY;
}

static void spoil_pressure(scene *s) {
    for (size_t cell = 0; cell < s->cells; cell++) {
        s->pressure[cell] = NAN;
    }
}

static void spoil_dt(scene *s) {
    s->dt = 0;
}

static void spoil_viscosity(scene *s) {
    s->material.mu_prime = NAN;
}

/* A tip cell that no fluid can reach has no pressure. */
static void lone_tip_cell(scene *s) {
    s->kind[0] = ILSA_CELL_TIP;
    s->width[0] = 0.1;
    s->footprint.x0 = s->footprint.y0 = 0;
}

/* Nothing but tip cells: no width to solve for. */
static void no_channel(scene *s) {
    for (size_t cell = 0; cell < s->cells; cell++) {
        s->kind[cell] = s->kind[cell] == ILSA_CELL_EMPTY ? ILSA_CELL_EMPTY : ILSA_CELL_TIP;
    }
}

/* More is taken out than there is. */
static void drained(scene *s) {
    for (size_t cell = 0; cell < s->cells; cell++) {
        s->source_term[cell] = -2 * s->width_old[cell];
    }
}

/* A status that leaves the step to be tried otherwise, and the handle good for the next. */
static void what_cannot_be_solved_is_refused(void **state) {
    (void)state;
    static spoiler *const spoilers[] = {spoil_width,     spoil_gain,    spoil_pressure, spoil_dt,
                                        spoil_viscosity, lone_tip_cell, no_channel,     drained};
    for (size_t n = 0; n < sizeof spoilers / sizeof *spoilers; n++) {
        for (int l = 0; l < 2; l++) {
            scene s = nth_scene(0, 1, 110), good = nth_scene(0, 1, 110);
            spoilers[n](&s);
            ilsa_status status = status_of(&s, solvers[l]);
            if (status != ILSA_STEP_REJECTED) {
                fail_msg("spoiler %zu, solver %d: status %d", n, l, (int)status);
            }
            for (size_t cell = 0; spoilers[n] == drained && cell < s.cells; cell++) {
                assert_true(!is_channel(&s, (int)cell) || s.width[cell] > 0);
            }
            coupled *used = s.c;
            s.c = good.c;
            good.c = used;
            solve(&good, solvers[l], 1e-9);
            assert_below(worst_residual(&good), 1e-7);
            free_scene(&s);
            free_scene(&good);
        }
    }
}

/* The smallest fracture: one channel cell between four tip cells, by hand. */
static void five_cells_by_hand(void **state) {
    (void)state;
    for (int folded = 0; folded < 4; folded++) {
        scene s = make_scene(7, 7, 3, folded, 1);
        memset(s.kind, ILSA_CELL_EMPTY, s.cells);
        memset(s.width, 0, s.cells * sizeof *s.width);
        static const int tip[] = {23, 25, 17, 31};
        s.kind[24] = ILSA_CELL_SURVEY;
        s.footprint = (box){2, 4, 2, 4};
        double gain = 0, old = s.width_old[24];
        for (int n = 0; n < 4; n++) {
            s.kind[tip[n]] = ILSA_CELL_TIP;
            s.width[tip[n]] = 0.3;
            gain += s.source_term[tip[n]] + s.width_old[tip[n]] - 0.3;
        }
        s.width[24] = 1;
        gain += s.source_term[24];
        solve(&s, ILSA_LINEAR_AUTO, 1e-12);
        assert_true(fabs(s.width[24] - old - gain) < 1e-12); /* what is left is the middle's */
        assert_below(worst_residual(&s), 1e-9);
        free_scene(&s);
    }
}

/* Memory */

static void no_memory_is_reported(void **state) {
    (void)state;
    for (int l = 0; l < 2; l++) {
        int failures = 0;
        ilsa_status status = ILSA_ERR_MEMORY;
        scene s = nth_scene(0, 1, 120), t = nth_scene(0, 1, 120);
        while (status == ILSA_ERR_MEMORY && failures < 200) {
            memcpy(s.width, t.width, s.cells * sizeof *s.width);
            memcpy(s.pressure, t.pressure, s.cells * sizeof *s.pressure);
            allocations_left = failures++;
            status = status_of(&s, solvers[l]);
            allocations_left = -1;
        }
        assert_int_equal(status, ILSA_OK);
        assert_true(failures > 5);
        status_of(&t, solvers[l]);
        assert_true(width_difference(&s, &t) == 0);
        free_scene(&s);
        free_scene(&t);
    }
    ilsa_mesh_def def = {9, 9, 1, 1};
    for (int allowed = 0; allowed < 5; allowed++) {
        allocations_left = allowed;
        coupled *none = ilsai_coupled_create(&def);
        allocations_left = -1;
        assert_null(none);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrix_is_the_derivative),
        cmocka_unit_test(matrix_with_responses_is_the_derivative),
        cmocka_unit_test(closed_cells_are_in_matrix_and_preconditioner),
        cmocka_unit_test(product_is_linear),
        cmocka_unit_test(preconditioner_is_linear_and_serves),
        cmocka_unit_test(solution_satisfies_the_equations),
        cmocka_unit_test(only_channel_widths_change),
        cmocka_unit_test(responses_are_followed),
        cmocka_unit_test(volume_balances),
        cmocka_unit_test(dense_and_iterative_agree),
        cmocka_unit_test(folded_solution_is_the_unfolded_one),
        cmocka_unit_test(fluid_at_rest_stays_at_rest),
        cmocka_unit_test(long_step_evens_the_pressure),
        cmocka_unit_test(tolerance_bounds_the_error),
        cmocka_unit_test(any_units),
        cmocka_unit_test(counts_are_added_to),
        cmocka_unit_test(solves_use_nothing_of_the_last),
        cmocka_unit_test(what_cannot_be_solved_is_refused),
        cmocka_unit_test(five_cells_by_hand),
        cmocka_unit_test(no_memory_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
