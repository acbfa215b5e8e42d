/* Fast marching: against planes, circles, the discrete equation itself and the unfolded march. */
#include "check.h"
#include "failing.h"
#include "front/march.h"
#include <ilsa/solver.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const double untouched = -1234.5;

/* A mesh, the survey_cells on it and what one march makes of them. */
typedef struct scene {
    grid g;
    unsigned char *kind;
    double *level;
    survey_cell *survey_cells;
    int survey_count;
    march *f;
} scene;

static scene make_scene(int nx, int ny, double dx, double dy) {
    ilsa_mesh_def def = {nx, ny, dx, dy};
    size_t cells = (size_t)nx * (size_t)ny;
    scene s = {.g = ilsai_grid(&def, 0, 0), .kind = calloc(cells, 1), .f = ilsai_march_create()};
    s.level = malloc(cells * sizeof *s.level);
    s.survey_cells = malloc(cells * sizeof *s.survey_cells);
    if (!s.kind || !s.level || !s.survey_cells || !s.f) {
        abort();
    }
    for (size_t c = 0; c < cells; c++) {
        s.level[c] = untouched;
    }
    return s;
}

static void free_scene(scene *s) {
    free(s->kind);
    free(s->level);
    free(s->survey_cells);
    ilsai_march_destroy(&s->f);
}

static int cell_count(const scene *s) {
    return s->g.nx * s->g.ny;
}

static double x_of(const scene *s, int cell) {
    return ilsai_grid_x(&s->g, cell % s->g.nx);
}

static double y_of(const scene *s, int cell) {
    return ilsai_grid_y(&s->g, cell / s->g.nx);
}

static survey_cell *add_seed(scene *s, int cell, double T) {
    survey_cell *survey = &s->survey_cells[s->survey_count++];
    *survey = (survey_cell){.cell = cell, .s0 = -T, .h = 1, .s = -T, .V = 0, .w = 1};
    s->kind[cell] = ILSA_CELL_SURVEY;
    return survey;
}

static box whole(const scene *s) {
    return (box){0, s->g.nx - 1, 0, s->g.ny - 1};
}

static const front_cell *march_in(scene *s, box region, double limit, int *count) {
    assert_int_equal(ilsai_march_run(s->f, &s->g, &region, s->kind, s->survey_cells,
                                     s->survey_count, limit, s->level),
                     ILSA_OK);
    return ilsai_march_cells(s->f, count);
}

static const front_cell *march_all(scene *s, double limit, int *count) {
    return march_in(s, whole(s), limit, count);
}

static int same_cell(const front_cell *a, const front_cell *b) {
    return a->cell == b->cell && a->T == b->T && a->cos_a == b->cos_a && a->sin_a == b->sin_a &&
           a->ell == b->ell && a->V == b->V && a->K_num == b->K_num && a->K_den == b->K_den;
}

static int same_cells(const front_cell *a, const front_cell *b, int count) {
    int k = 0;
    while (k < count && same_cell(&a[k], &b[k])) {
        k++;
    }
    return k == count;
}

/* Planes */

/* Seeds with the exact distances of a plane in the rows and columns that it comes from. */
static scene plane_scene(double angle, double dx, double dy) {
    scene s = make_scene(12, 9, dx, dy);
    double cos_a = cos(angle), sin_a = sin(angle);
    int first_i = cos_a >= 0 ? 0 : s.g.nx - 1, first_j = sin_a >= 0 ? 0 : s.g.ny - 1;
    for (int cell = 0; cell < cell_count(&s); cell++) {
        double T = cos_a * x_of(&s, cell) + sin_a * y_of(&s, cell) - 10 * (dx + dy);
        if (cell % s.g.nx == first_i || cell / s.g.nx == first_j) {
            add_seed(&s, cell, T)->V = 3;
        }
    }
    return s;
}

static double worst_of_plane(double angle, double dx, double dy) {
    scene s = plane_scene(angle, dx, dy);
    int count;
    const front_cell *c = march_all(&s, INFINITY, &count);
    double cos_a = cos(angle), sin_a = sin(angle), worst = NOTHING_YET;
    assert_int_equal(count, cell_count(&s) - s.survey_count);
    for (int k = 0; k < count; k++) {
        double x = x_of(&s, c[k].cell), y = y_of(&s, c[k].cell);
        double T = cos_a * x + sin_a * y - 10 * (dx + dy);
        /* the corner furthest behind the march */
        double corner = T - 0.5 * dx * fabs(cos_a) - 0.5 * dy * fabs(sin_a);
        worst = worst_of(worst, fabs(c[k].T - T) / (dx + dy));
        worst = worst_of(worst, fabs(c[k].ell + corner) / (dx + dy));
        worst = worst_of(worst, fabs(c[k].V / 3 - 1));
        assert_true(hypot(c[k].cos_a - fabs(cos_a), c[k].sin_a - fabs(sin_a)) < 1e-10);
        assert_true(s.level[c[k].cell] == c[k].T);
    }
    free_scene(&s);
    return worst;
}

/* The plane through two neighbours is the plane: no error but of rounding. */
static void planes_are_exact(void **state) {
    (void)state;
    static const double cell[][2] = {{1, 1}, {0.3, 0.7}, {4, 1}, {1e-3, 2e-3}};
    double worst = NOTHING_YET;
    for (size_t m = 0; m < sizeof cell / sizeof *cell; m++) {
        for (int degrees = 1; degrees < 360; degrees++) {
            if (degrees % 90 != 0) {
                worst = worst_of(worst, worst_of_plane(degrees * pi / 180, cell[m][0], cell[m][1]));
            }
        }
    }
    print_message("planes: worst error %.2g of T, ell and V, in cells\n", worst);
    assert_below(worst, 1e-12);
}

/* A front along an axis: from one side alone, cell by cell. */
static void planes_along_the_axes_are_exact(void **state) {
    (void)state;
    for (int face = 0; face < GRID_FACES; face++) {
        scene s = make_scene(7, 11, 0.5, 2);
        int along_x = face == GRID_LEFT || face == GRID_RIGHT;
        int from = face == GRID_LEFT ? s.g.nx - 1 : face == GRID_DOWN ? s.g.ny - 1 : 0;
        double h = along_x ? s.g.dx : s.g.dy;
        for (int cell = 0; cell < cell_count(&s); cell++) {
            if ((along_x ? cell % s.g.nx : cell / s.g.nx) == from) {
                add_seed(&s, cell, -0.75 * h)->V = 0.1;
            }
        }
        int count;
        const front_cell *c = march_all(&s, INFINITY, &count);
        assert_int_equal(count, cell_count(&s) - s.survey_count);
        for (int k = 0; k < count; k++) {
            int n = along_x ? c[k].cell % s.g.nx : c[k].cell / s.g.nx;
            double T = (abs(n - from) - 0.75) * h;
            assert_true(fabs(c[k].T - T) < 1e-14 && fabs(c[k].ell - (0.5 * h - T)) < 1e-14);
            assert_true(c[k].V == 0.1);
            assert_true(fabs(c[k].cos_a - along_x) < 1e-7 && fabs(c[k].sin_a - !along_x) < 1e-7);
        }
        free_scene(&s);
    }
}

/* What the march reached in a cell; the test fails if it did not. */
static const front_cell *reached(const scene *s, int cell) {
    int count;
    const front_cell *c = ilsai_march_cells(s->f, &count);
    for (int k = 0; k < count; k++) {
        if (c[k].cell == cell) {
            return &c[k];
        }
    }
    fail_msg("cell %d was not reached", cell);
    return NULL;
}

/* A cell between two survey_cells: left of it at T1, below it at T2. */
static scene corner_scene(double dx, double dy, double T1, double T2) {
    scene s = make_scene(3, 3, dx, dy);
    add_seed(&s, 3, T1);
    add_seed(&s, 1, T2);
    return s;
}

/* The paper's own formulae, (4.12) as the errata have it, and (4.13). */
static void two_parents_as_in_the_paper(void **state) {
    (void)state;
    static const double aspect[] = {0.4, 1, 2.5};
    for (size_t m = 0; m < sizeof aspect / sizeof *aspect; m++) {
        for (int n = -9; n <= 9; n++) { /* beyond -dy .. dx the front comes from one side */
            double beta = aspect[m], dx = 0.6, dy = dx / beta;
            double d = 0.1 * n * (n > 0 ? dx : dy), T1 = -0.2, T2 = T1 + d;
            scene s = corner_scene(dx, dy, T1, T2);
            int count;
            march_all(&s, INFINITY, &count);
            const front_cell *c = reached(&s, 4);
            double theta = sqrt(dx * dx * (1 + beta * beta) - beta * beta * d * d);
            double T3 = (T1 + beta * beta * T2 + theta) / (1 + beta * beta);
            double tangent = beta * (theta - d) / (theta + beta * beta * d);
            assert_true(fabs(c->T - T3) < 1e-14);
            assert_true(fabs(c->ell + 0.5 * (T1 + T2)) < 1e-14);
            assert_true(fabs(atan2(c->sin_a, c->cos_a) - atan(tangent)) < 1e-13);
            free_scene(&s);
        }
    }
}

/* Two neighbours further apart than a cell: the one behind the other has no say. */
static void parents_far_apart_give_one_side(void **state) {
    (void)state;
    static const double apart[] = {1.01, 1.5, 3, 30};
    for (size_t n = 0; n < sizeof apart / sizeof *apart; n++) {
        double dx = 0.6, dy = 1.1;
        scene s = corner_scene(dx, dy, -40, -40 + apart[n] * dx);
        scene t = corner_scene(dx, dy, -40 + apart[n] * dy, -40);
        s.survey_cells[0].V = t.survey_cells[1].V = 2;
        int count;
        march_all(&s, INFINITY, &count);
        march_all(&t, INFINITY, &count);
        const front_cell *from_left = reached(&s, 4), *from_below = reached(&t, 4);
        assert_true(from_left->T == -40 + dx && from_left->V == 2);
        assert_true(from_left->cos_a == 1 && from_left->sin_a == 0);
        assert_true(from_below->T == -40 + dy && from_below->V == 2);
        assert_true(from_below->cos_a == 0 && from_below->sin_a == 1);
        free_scene(&s);
        free_scene(&t);
    }
}

/* Circles */

typedef struct circle {
    double x, y, radius;
} circle;

static double circle_level(const circle *c, double x, double y) {
    return hypot(x - c->x, y - c->y) - c->radius;
}

/* The largest level over the corners of a cell: below zero when the cell is full. */
static double corner_level(const scene *s, const circle *c, int cell, int farthest) {
    double best = farthest ? INFINITY : -INFINITY;
    for (int n = 0; n < 4; n++) {
        double x = x_of(s, cell) + (n % 2 - 0.5) * s->g.dx;
        double y = y_of(s, cell) + (n / 2 - 0.5) * s->g.dy;
        double level = circle_level(c, x, y);
        best = farthest ? fmin(best, level) : fmax(best, level);
    }
    return best;
}

/* Full cells are channel cells, those beside a cell that is not are the survey_cells. */
static void fill_circle(scene *s, const circle *c, double curvature) {
    for (int cell = 0; cell < cell_count(s); cell++) {
        int full = corner_level(s, c, cell, 0) <= 0;
        s->kind[cell] = full ? ILSA_CELL_CHANNEL : ILSA_CELL_EMPTY;
    }
    for (int cell = 0; cell < cell_count(s); cell++) {
        int rim = 0, i = cell % s->g.nx, j = cell / s->g.nx;
        for (int face = 0; face < GRID_FACES; face++) {
            int other = ilsai_grid_neighbour(&s->g, i, j, face);
            rim |= other >= 0 && s->kind[other] == ILSA_CELL_EMPTY;
        }
        if (s->kind[cell] != ILSA_CELL_EMPTY && rim) {
            double T = circle_level(c, x_of(s, cell), y_of(s, cell));
            add_seed(s, cell, T)->curvature = curvature;
        }
    }
}

typedef struct circle_errors {
    double T, ell, angle; /* lengths and radians */
} circle_errors;

/* Errors in the cells that the circle crosses, n cells to the radius along x. */
static circle_errors circle_errors_at(int n, double aspect, double curvature) {
    circle c = {0.013, -0.007, 1};
    double dx = 1.0 / n, dy = dx / aspect;
    scene s = make_scene(2 * n + 12, 2 * (int)(n * aspect) + 13, dx, dy);
    circle_errors worst = {NOTHING_YET, NOTHING_YET, NOTHING_YET};
    int count;
    fill_circle(&s, &c, curvature);
    const front_cell *cell = march_all(&s, 2 * hypot(dx, dy), &count);
    for (int k = 0; k < count; k++) {
        double x = x_of(&s, cell[k].cell), y = y_of(&s, cell[k].cell);
        double corner = corner_level(&s, &c, cell[k].cell, 1);
        if (corner < 0) {
            double angle = atan2(fabs(y - c.y), fabs(x - c.x));
            double error = atan2(cell[k].sin_a, cell[k].cos_a) - angle;
            worst.T = worst_of(worst.T, fabs(cell[k].T - circle_level(&c, x, y)));
            worst.ell = worst_of(worst.ell, fabs(cell[k].ell + corner));
            worst.angle = worst_of(worst.angle, fabs(error));
        }
    }
    assert_true(count > n);
    free_scene(&s);
    return worst;
}

/* Few cells are marched, over each the front turns by h / R: second order in T and ell, first in
 * the normal. */
static void circles_converge(void **state) {
    (void)state;
    static const double aspect[] = {1, 0.5, 3};
    for (size_t m = 0; m < sizeof aspect / sizeof *aspect; m++) {
        circle_errors last = {INFINITY, INFINITY, INFINITY};
        for (int n = 10; n <= 160; n *= 2) {
            circle_errors e = circle_errors_at(n, aspect[m], 0);
            double h = (aspect[m] < 1 ? 1 / aspect[m] : 1) / n;
            print_message("circle, dx/dy %g, %3d cells: T off by %.2g cells, ell %.2g, "
                          "normal %.2g\n",
                          aspect[m], n, e.T / h, e.ell / h, e.angle);
            assert_true(e.T < 0.8 * h * h && e.ell < 0.8 * h * h && e.angle < 0.8 * h);
            assert_true(e.T < 0.4 * last.T && e.ell < 0.4 * last.ell);
            last = e;
        }
    }
}

/* With the curvature known T is of third order, and ell and the normal gain by it. */
static void curvature_sharpens_circles(void **state) {
    (void)state;
    static const double aspect[] = {1, 0.5, 3};
    for (size_t m = 0; m < sizeof aspect / sizeof *aspect; m++) {
        for (int n = 10; n <= 160; n *= 2) {
            circle_errors plain = circle_errors_at(n, aspect[m], 0);
            circle_errors e = circle_errors_at(n, aspect[m], 1);
            double h = (aspect[m] < 1 ? 1 / aspect[m] : 1) / n;
            print_message("circle with curvature, dx/dy %g, %3d cells: T off by %.2g cells, "
                          "ell %.2g, normal %.2g\n",
                          aspect[m], n, e.T / h, e.ell / h, e.angle);
            assert_true(e.T < 0.6 * h * h * h && e.T < 0.15 * plain.T);
            assert_true(e.ell < 0.6 * plain.ell && e.angle < 0.95 * plain.angle);
        }
    }
}

/* The discrete equation */

/* Seeds on a ragged line around the middle, more than consistent with any front. */
static scene ragged_scene(int nx, int ny, double dx, double dy, uint64_t survey) {
    scene s = make_scene(nx, ny, dx, dy);
    for (int cell = 0; cell < cell_count(&s); cell++) {
        double r = hypot(x_of(&s, cell) / (0.25 * nx * dx), y_of(&s, cell) / (0.25 * ny * dy));
        if (r < 0.8) {
            s.kind[cell] = ILSA_CELL_CHANNEL;
        } else if (r < 1.1) {
            survey_cell *from = add_seed(&s, cell, -(dx + dy) * (1.5 + 1.2 * next_random(&survey)));
            from->V = 2 + next_random(&survey);
            from->w = 2 + next_random(&survey);
        }
    }
    return s;
}

static double level_at(const scene *s, int i, int j) {
    if (i < 0 || i >= s->g.nx || j < 0 || j >= s->g.ny) {
        return INFINITY;
    }
    int cell = ilsai_grid_cell(&s->g, i, j);
    return s->kind[cell] == ILSA_CELL_CHANNEL ? INFINITY : s->level[cell];
}

/* ((T - a) / dx)^2 over what is positive + the same along y - 1, for the smaller neighbours. */
static double slope_excess(double T, double a, double b, double dx, double dy) {
    double p = fmax(T - a, 0) / dx, q = fmax(T - b, 0) / dy;
    return p * p + q * q - 1;
}

/* What the neighbours make of a cell, by bisection. */
static double bisected(const scene *s, int i, int j) {
    double a = fmin(level_at(s, i - 1, j), level_at(s, i + 1, j));
    double b = fmin(level_at(s, i, j - 1), level_at(s, i, j + 1));
    double low = fmin(a, b), high = low + s->g.dx + s->g.dy;
    if (!isfinite(low)) {
        return INFINITY;
    }
    for (int n = 0; n < 100; n++) {
        double middle = 0.5 * (low + high);
        *(slope_excess(middle, a, b, s->g.dx, s->g.dy) > 0 ? &high : &low) = middle;
    }
    return high;
}

/* Every reached cell answers to its final neighbours, no other cell would come within the limit. */
static double worst_of_equation(const scene *s, double limit) {
    double worst = NOTHING_YET, h = s->g.dx + s->g.dy;
    for (int cell = 0; cell < cell_count(s); cell++) {
        if (s->kind[cell] >= ILSA_CELL_SURVEY) {
            continue;
        }
        double T = s->level[cell], truth = bisected(s, cell % s->g.nx, cell / s->g.nx);
        if (isfinite(T)) {
            assert_true(T <= limit);
            worst = worst_of(worst, fabs(T - truth) / h);
        } else {
            assert_true(truth > limit - 1e-12 * h);
        }
    }
    return worst;
}

static void every_cell_answers_to_its_neighbours(void **state) {
    (void)state;
    static const double aspect[] = {1, 0.3, 4};
    double worst = NOTHING_YET;
    for (uint64_t n = 0; n < 60; n++) {
        double dy = aspect[n % 3], limit = n % 2 ? INFINITY : 4.0 * (double)(n % 5);
        scene s = ragged_scene(31, 26, 1, dy, n + 1);
        int count;
        march_all(&s, limit, &count);
        worst = worst_of(worst, worst_of_equation(&s, limit));
        free_scene(&s);
    }
    print_message("discrete eikonal equation: worst difference to bisection %.2g cells\n", worst);
    assert_below(worst, 1e-11);
}

static void curve(scene *s, double curvature, uint64_t survey) {
    for (int k = 0; k < s->survey_count; k++) {
        s->survey_cells[k].curvature = curvature * next_random(&survey);
    }
}

/* Cells come in the order of T, after the neighbours that they come from. */
static void cells_come_after_their_parents(void **state) {
    (void)state;
    for (uint64_t n = 0; n < 20; n++) {
        scene s = ragged_scene(30, 30, 1, 0.7, n + 1);
        curve(&s, 0.05 * (double)n, n);
        int count, *order = calloc((size_t)cell_count(&s), sizeof *order);
        const front_cell *c = march_all(&s, INFINITY, &count);
        for (int k = 0; k < count; k++) {
            int i = c[k].cell % s.g.nx, j = c[k].cell / s.g.nx, parents = 0;
            assert_true(k == 0 || c[k].T >= c[k - 1].T);
            for (int face = 0; face < GRID_FACES; face++) {
                int other = ilsai_grid_neighbour(&s.g, i, j, face);
                int there = other >= 0 && s.kind[other] != ILSA_CELL_CHANNEL;
                int is_seed = there && s.kind[other] == ILSA_CELL_SURVEY;
                parents += there && s.level[other] <= c[k].T && (is_seed || order[other] > 0);
            }
            assert_true(parents > 0);
            assert_int_equal(order[c[k].cell], 0); /* never twice */
            order[c[k].cell] = k + 1;
        }
        free(order);
        free_scene(&s);
    }
}

/* A front that hardly curves is hardly different from a straight one. */
static void curvature_enters_smoothly(void **state) {
    (void)state;
    double tiny = 1e-7, worst = NOTHING_YET;
    for (uint64_t n = 0; n < 10; n++) {
        scene s = ragged_scene(30, 30, 1, 0.7, n + 1), t = ragged_scene(30, 30, 1, 0.7, n + 1);
        int count, same;
        curve(&s, tiny, n);
        march_all(&s, INFINITY, &count);
        march_all(&t, INFINITY, &same);
        assert_int_equal(count, same);
        for (int cell = 0; cell < cell_count(&s); cell++) {
            double off = s.level[cell] - t.level[cell];
            worst = s.level[cell] == untouched ? worst : worst_of(worst, fabs(off));
        }
        free_scene(&s);
        free_scene(&t);
    }
    print_message("curvature %g changes T by %.2g\n", tiny, worst);
    assert_true(worst > 0);
    assert_below(worst, 30 * tiny);
}

/* Normals have length one, and lie between the axes. */
static void normals_are_unit_vectors(void **state) {
    (void)state;
    scene s = ragged_scene(41, 37, 1, 2.5, 77);
    curve(&s, 0.3, 1);
    int count;
    const front_cell *c = march_all(&s, INFINITY, &count);
    for (int k = 0; k < count; k++) {
        assert_true(c[k].cos_a >= 0 && c[k].sin_a >= 0);
        assert_true(fabs(hypot(c[k].cos_a, c[k].sin_a) - 1) < 1e-13);
        double full = ilsai_march_full(&s.g, c[k].cos_a, c[k].sin_a);
        assert_true(fabs(full - s.g.dx * c[k].cos_a - s.g.dy * c[k].sin_a) < 1e-14);
        assert_true(fabs(c[k].ell + c[k].T - 0.5 * full) < 1e-12);
    }
    free_scene(&s);
}

/* Limits */

static void seeds_and_channel_are_kept(void **state) {
    (void)state;
    scene s = ragged_scene(25, 25, 1, 1, 5);
    int count;
    march_all(&s, 3, &count);
    int survey_cells = 0, infinite = 0, channel = 0;
    for (int cell = 0; cell < cell_count(&s); cell++) {
        if (s.kind[cell] == ILSA_CELL_CHANNEL) {
            channel++;
            assert_true(s.level[cell] == untouched);
        } else if (s.kind[cell] == ILSA_CELL_SURVEY) {
            assert_int_equal(s.survey_cells[survey_cells].cell, cell);
            assert_true(s.level[cell] == -s.survey_cells[survey_cells++].s);
        } else {
            infinite += s.level[cell] == INFINITY;
        }
    }
    assert_int_equal(survey_cells, s.survey_count);
    assert_true(infinite > 50);
    assert_int_equal(count + infinite + survey_cells + channel, cell_count(&s));
    free_scene(&s);
}

/* A smaller limit reaches fewer cells and gives them the same values. */
static void limit_cuts_the_march(void **state) {
    (void)state;
    scene far = ragged_scene(40, 40, 1, 1.3, 8), near = ragged_scene(40, 40, 1, 1.3, 8);
    int far_count, near_count;
    const front_cell *f = march_all(&far, INFINITY, &far_count);
    static const double limits[] = {-100, -1, 0, 2, 7.5};
    for (size_t n = 0; n < sizeof limits / sizeof *limits; n++) {
        const front_cell *c = march_all(&near, limits[n], &near_count);
        assert_true(near_count < far_count && f[near_count].T > limits[n]);
        assert_true(near_count == 0 || f[near_count - 1].T <= limits[n]);
        assert_true(same_cells(c, f, near_count));
        for (int k = 0; k < far_count; k++) {
            assert_true(near.level[f[k].cell] == (k < near_count ? f[k].T : INFINITY));
        }
    }
    int again;
    const front_cell *c = march_all(&near, f[9].T, &again); /* the limit itself is within */
    assert_true(again >= 10 && c[9].T == f[9].T);
    free_scene(&far);
    free_scene(&near);
}

/* Nothing outside the region is read or written. */
static void region_bounds_the_march(void **state) {
    (void)state;
    scene s = ragged_scene(30, 28, 1, 1, 15), t = ragged_scene(30, 28, 1, 1, 15);
    box region = {2, 26, 4, 22};
    int count, other_count;
    march_in(&s, region, INFINITY, &count);
    for (int cell = 0; cell < cell_count(&t); cell++) { /* the same as walls around the region */
        int i = cell % t.g.nx, j = cell / t.g.nx;
        int inside = i >= region.x0 && i <= region.x1 && j >= region.y0 && j <= region.y1;
        assert_true(inside || s.level[cell] == untouched);
        t.kind[cell] = inside ? t.kind[cell] : ILSA_CELL_CHANNEL;
    }
    march_all(&t, INFINITY, &other_count);
    assert_int_equal(count, other_count);
    assert_memory_equal(s.level, t.level, (size_t)cell_count(&s) * sizeof *s.level);
    free_scene(&s);
    free_scene(&t);
}

/* Cells behind channel cells are reached around them, closed-in cells not at all. */
static void closed_in_cells_are_not_reached(void **state) {
    (void)state;
    scene s = make_scene(9, 9, 1, 1);
    add_seed(&s, ilsai_grid_cell(&s.g, 1, 4), -1);
    for (int n = 3; n <= 7; n++) { /* a ring of channel cells around (5, 5) */
        for (int m = 3; m <= 7; m++) {
            if (n == 3 || n == 7 || m == 3 || m == 7) {
                s.kind[ilsai_grid_cell(&s.g, n, m)] = ILSA_CELL_CHANNEL;
            }
        }
    }
    int count;
    march_all(&s, INFINITY, &count);
    assert_int_equal(count, 81 - 1 - 25);
    assert_true(s.level[ilsai_grid_cell(&s.g, 5, 5)] == INFINITY);
    assert_true(isfinite(s.level[ilsai_grid_cell(&s.g, 8, 8)]));
    free_scene(&s);
}

/* A survey cell that is no survey belongs to the channel: the march goes around it. */
static void survey_cells_are_not_entered(void **state) {
    (void)state;
    scene s = make_scene(7, 5, 1, 1);
    int other = ilsai_grid_cell(&s.g, 3, 2), count;
    add_seed(&s, ilsai_grid_cell(&s.g, 1, 2), -1);
    s.kind[other] = ILSA_CELL_SURVEY;
    const front_cell *c = march_all(&s, INFINITY, &count);
    assert_int_equal(count, 35 - 2);
    assert_true(s.level[other] == untouched);
    for (int k = 0; k < count; k++) {
        assert_true(c[k].cell != other);
    }
    free_scene(&s);
}

static void no_seeds_reach_nothing(void **state) {
    (void)state;
    scene s = make_scene(5, 5, 1, 1);
    int count;
    march_all(&s, INFINITY, &count);
    assert_int_equal(count, 0);
    for (int cell = 0; cell < 25; cell++) {
        assert_true(s.level[cell] == INFINITY);
    }
    free_scene(&s);
}

/* Velocity and stress intensity */

static void uniform_velocity_stays_uniform(void **state) {
    (void)state;
    scene s = ragged_scene(50, 50, 1, 0.4, 4);
    curve(&s, 0.3, 2);
    for (int k = 0; k < s.survey_count; k++) {
        s.survey_cells[k].V = 0.37;
    }
    int count;
    const front_cell *c = march_all(&s, INFINITY, &count);
    for (int k = 0; k < count; k++) {
        assert_true(fabs(c[k].V - 0.37) < 1e-13);
    }
    free_scene(&s);
}

/* V is what T loses in time when every survey moves on with its own V: central differences, of
 * second order where the same parents keep their say. */
static void velocity_is_the_change_of_distance(void **state) {
    (void)state;
    double eps = 1e-6, worst = NOTHING_YET;
    int compared = 0;
    for (uint64_t n = 0; n < 10; n++) {
        scene s = ragged_scene(30, 30, 1, 0.8, n + 100),
              before = ragged_scene(30, 30, 1, 0.8, n + 100);
        scene after = ragged_scene(30, 30, 1, 0.8, n + 100);
        for (int k = 0; k < s.survey_count; k++) {
            before.survey_cells[k].s -= eps * s.survey_cells[k].V;
            after.survey_cells[k].s += eps * s.survey_cells[k].V;
        }
        int count, same;
        march_all(&before, INFINITY, &same);
        march_all(&after, INFINITY, &same);
        const front_cell *c = march_all(&s, INFINITY, &count);
        for (int k = 0; k < count; k++) {
            double V = (before.level[c[k].cell] - after.level[c[k].cell]) / (2 * eps);
            int axis = c[k].cos_a < 1e-3 || c[k].sin_a < 1e-3; /* where parents come and go */
            worst = axis ? worst : worst_of(worst, fabs(V - c[k].V));
            compared += !axis;
        }
        free_scene(&s);
        free_scene(&before);
        free_scene(&after);
    }
    print_message("velocity: %d cells, worst difference to finite differences %.2g\n", compared,
                  worst);
    assert_true(compared > 2000);
    assert_below(worst, 1e-4);
}

/* Each cell knows the survey_cells that its level comes from, and how much each: as many as it can
 * keep, their velocities by these parts are its own. */
static void parents_weigh_as_the_derivative(void **state) {
    (void)state;
    int compared = 0;
    for (uint64_t n = 0; n < 10; n++) {
        scene s = ragged_scene(30, 30, 1, 0.8, n + 100);
        int count;
        const front_cell *c = march_all(&s, INFINITY, &count);
        for (int k = 0; k < count; k++) {
            const front_parents *from = &c[k].from;
            double V = 0, sum = 0;
            assert_true(from->count >= 1 && from->count <= FRONT_PARENTS);
            for (int p = 0; p < from->count; p++) {
                assert_true(from->weight[p] > 0);
                sum += from->weight[p];
                V += from->weight[p] * s.survey_cells[from->survey[p]].V;
                for (int q = 0; q < p; q++) {
                    assert_true(from->survey[p] != from->survey[q]);
                }
            }
            assert_true(fabs(sum - 1) < 1e-14);
            if (from->count < FRONT_PARENTS) { /* none was dropped */
                assert_true(fabs(V - c[k].V) < 1e-13);
                compared += from->count > 1;
            }
        }
        free_scene(&s);
    }
    assert_true(compared > 300);
}

static void stress_intensity_of_two_parents(void **state) {
    (void)state;
    double w1 = 0.3, w2 = 0.5, s1 = 0.8, s2 = 0.65;
    scene s = corner_scene(1, 1, -s1, -s2);
    s.survey_cells[0].w = w1;
    s.survey_cells[1].w = w2;
    int count;
    march_all(&s, INFINITY, &count);
    const front_cell *c = reached(&s, 4);
    double truth = (w1 * sqrt(s1) + w2 * sqrt(s2)) / (s1 + s2); /* (4.19) */
    assert_true(fabs(c->K_num / c->K_den / truth - 1) < 1e-15);
    const front_cell *beside = reached(&s, 6); /* from one parent alone: w = K s^(1/2) */
    assert_true(fabs(beside->K_num / beside->K_den * sqrt(s1) / w1 - 1) < 1e-15);
    free_scene(&s);
}

/* Survey widths of one stress intensity give that one everywhere, any between least and largest. */
static void stress_intensity_is_a_mean(void **state) {
    (void)state;
    for (uint64_t n = 0; n < 10; n++) {
        scene s = ragged_scene(40, 33, 1, 1.6, n + 3);
        double low = INFINITY, high = 0;
        int count;
        for (int k = 0; k < s.survey_count; k++) {
            double K = s.survey_cells[k].w / sqrt(s.survey_cells[k].s);
            low = smaller_of(low, K);
            high = larger_of(high, K);
        }
        const front_cell *c = march_all(&s, INFINITY, &count);
        for (int k = 0; k < count; k++) {
            double K = c[k].K_num / c[k].K_den;
            assert_true(K >= low * (1 - 1e-14) && K <= high * (1 + 1e-14));
        }
        for (int k = 0; k < s.survey_count; k++) {
            s.survey_cells[k].w = 1.7 * sqrt(s.survey_cells[k].s);
        }
        c = march_all(&s, INFINITY, &count);
        for (int k = 0; k < count; k++) {
            assert_true(fabs(c[k].K_num / c[k].K_den - 1.7) < 1e-13);
        }
        free_scene(&s);
    }
}

/* Folding */

/* Noise that is the same at (+-x, +-y) where the mirrors ask for it. */
static double mirrored_noise(const scene *s, int mirror_x, int mirror_y, int cell, uint64_t salt) {
    int i = cell % s->g.nx, j = cell / s->g.nx;
    int mi = s->g.nx - 1 - i, mj = s->g.ny - 1 - j;
    i = mirror_x && mi > i ? mi : i;
    j = mirror_y && mj > j ? mj : j;
    uint64_t survey = salt + 1000003u * (uint64_t)i + 7919u * (uint64_t)j;
    next_random(&survey);
    next_random(&survey);
    return next_random(&survey);
}

/* A scene with the mirrors; folded: with the representatives of its survey_cells alone. */
static scene mirrored_scene(int nx, int ny, int mirror_x, int mirror_y, int folded, uint64_t salt,
                            double curvature) {
    scene s = make_scene(nx, ny, 1, 0.8);
    ilsa_mesh_def def = {nx, ny, 1, 0.8};
    s.g = folded ? ilsai_grid(&def, mirror_x, mirror_y) : s.g;
    for (int cell = 0; cell < cell_count(&s); cell++) {
        double r = hypot(x_of(&s, cell) / 7, y_of(&s, cell) / 6);
        s.kind[cell] = r < 0.8 ? ILSA_CELL_CHANNEL : r < 1.1 ? ILSA_CELL_SURVEY : ILSA_CELL_EMPTY;
        int i = cell % nx, j = cell / nx;
        if (s.kind[cell] == ILSA_CELL_SURVEY && i >= s.g.lo_x && j >= s.g.lo_y) {
            double a = mirrored_noise(&s, mirror_x, mirror_y, cell, salt);
            survey_cell *survey = add_seed(&s, cell, -7 * (1.3 - r) - 0.8 * a);
            survey->V = 2 + mirrored_noise(&s, mirror_x, mirror_y, cell, salt + 1);
            survey->w = 2 + mirrored_noise(&s, mirror_x, mirror_y, cell, salt + 2);
            survey->curvature = curvature * mirrored_noise(&s, mirror_x, mirror_y, cell, salt + 3);
        }
    }
    return s;
}

/* Of place, normal and velocity. */
static double difference(const front_cell *a, const front_cell *b) {
    double worst = worst_of(fabs(a->T - b->T), fabs(a->ell - b->ell));
    worst = worst_of(worst, fabs(a->V - b->V));
    return worst_of(worst, worst_of(fabs(a->cos_a - b->cos_a), fabs(a->sin_a - b->sin_a)));
}

static double stress_intensity_difference(const front_cell *a, const front_cell *b) {
    return fabs(a->K_num / a->K_den - b->K_num / b->K_den);
}

typedef double comparison(const front_cell *a, const front_cell *b);

/* Largest difference between the folded march and the unfolded one; counts the cells. */
static double fold_difference(comparison *compare, double curvature, int nx, int ny, int mirror,
                              uint64_t salt) {
    int mirror_x = mirror & 1, mirror_y = mirror >> 1, count, folded_count, image[4], stood_for = 0;
    scene all = mirrored_scene(nx, ny, mirror_x, mirror_y, 0, salt, curvature);
    scene part = mirrored_scene(nx, ny, mirror_x, mirror_y, 1, salt, curvature);
    march_all(&all, 5, &count);
    const front_cell *c = march_all(&part, 5, &folded_count);
    double worst = NOTHING_YET;
    for (int k = 0; k < folded_count; k++) {
        int images = ilsai_grid_images(&part.g, c[k].cell % nx, c[k].cell / nx, image);
        stood_for += images;
        for (int m = 0; m < images; m++) {
            worst = worst_of(worst, compare(&c[k], reached(&all, image[m])));
        }
    }
    assert_int_equal(stood_for, count);
    free_scene(&all);
    free_scene(&part);
    return worst;
}

/* Even and odd counts, each mirror and both. */
static double worst_fold_difference(comparison *compare, double curvature) {
    static const int size[][2] = {{31, 29}, {30, 28}, {31, 28}, {30, 29}};
    double worst = NOTHING_YET;
    for (int n = 0; n < 4; n++) {
        for (int mirror = 1; mirror < 4; mirror++) {
            for (uint64_t salt = 1; salt <= 10; salt++) {
                worst = worst_of(worst, fold_difference(compare, curvature, size[n][0], size[n][1],
                                                        mirror, 97 * salt));
            }
        }
    }
    return worst;
}

static void folded_march_is_the_unfolded_one(void **state) {
    (void)state;
    double worst = worst_fold_difference(difference, 0);
    print_message("folded against unfolded: worst difference %.2g\n", worst);
    assert_below(worst, 1e-12);
}

/* A cell beside the axis and its mirror image have the same level: to the one that comes second
 * the other must not be a parent, whichever way the cosine, which is zero, is rounded. */
static void folded_march_with_curvature_is_the_unfolded_one(void **state) {
    (void)state;
    double worst = worst_fold_difference(difference, 0.3);
    print_message("folded against unfolded: with curvature off by %.2g\n", worst);
    assert_below(worst, 1e-12);
}

static void folded_stress_intensity_is_the_unfolded_one(void **state) {
    (void)state;
    double worst = worst_fold_difference(stress_intensity_difference, 0);
    print_message("folded against unfolded: stress intensity off by %.2g\n", worst);
    assert_below(worst, 1e-12);
}

/* The handle */

static void one_handle_serves_many_marches(void **state) {
    (void)state;
    static const int size[] = {20, 60, 12, 61, 20};
    march *used = ilsai_march_create();
    assert_non_null(used);
    for (size_t n = 0; n < sizeof size / sizeof *size; n++) {
        scene fresh = ragged_scene(size[n], size[n], 1, 1, 6);
        int count, used_count;
        const front_cell *c = march_all(&fresh, 6, &count);
        box region = whole(&fresh);
        ilsai_march_run(used, &fresh.g, &region, fresh.kind, fresh.survey_cells, fresh.survey_count,
                        6, fresh.level);
        const front_cell *d = ilsai_march_cells(used, &used_count);
        assert_int_equal(count, used_count);
        assert_true(same_cells(c, d, count));
        free_scene(&fresh);
    }
    ilsai_march_destroy(&used);
    assert_null(used);
    ilsai_march_destroy(&used);
}

static void no_memory_is_reported(void **state) {
    (void)state;
    scene s = ragged_scene(60, 60, 1, 1, 6), t = ragged_scene(60, 60, 1, 1, 6);
    box region = whole(&s);
    int count, again, failures = 0;
    ilsa_status status = ILSA_ERR_MEMORY;
    const front_cell *c = march_all(&t, 20, &count);
    while (status == ILSA_ERR_MEMORY && failures < 100) {
        allocations_left = failures++;
        status = ilsai_march_run(s.f, &s.g, &region, s.kind, s.survey_cells, s.survey_count, 20,
                                 s.level);
        allocations_left = -1;
    }
    assert_int_equal(status, ILSA_OK);
    assert_true(failures > 4);
    const front_cell *d = ilsai_march_cells(s.f, &again);
    assert_int_equal(count, again);
    assert_true(same_cells(c, d, count));
    allocations_left = 0;
    march *none = ilsai_march_create();
    allocations_left = -1;
    assert_null(none);
    free_scene(&s);
    free_scene(&t);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_are_exact),
        cmocka_unit_test(planes_along_the_axes_are_exact),
        cmocka_unit_test(two_parents_as_in_the_paper),
        cmocka_unit_test(parents_far_apart_give_one_side),
        cmocka_unit_test(circles_converge),
        cmocka_unit_test(curvature_sharpens_circles),
        cmocka_unit_test(every_cell_answers_to_its_neighbours),
        cmocka_unit_test(cells_come_after_their_parents),
        cmocka_unit_test(curvature_enters_smoothly),
        cmocka_unit_test(normals_are_unit_vectors),
        cmocka_unit_test(seeds_and_channel_are_kept),
        cmocka_unit_test(limit_cuts_the_march),
        cmocka_unit_test(region_bounds_the_march),
        cmocka_unit_test(closed_in_cells_are_not_reached),
        cmocka_unit_test(survey_cells_are_not_entered),
        cmocka_unit_test(no_seeds_reach_nothing),
        cmocka_unit_test(uniform_velocity_stays_uniform),
        cmocka_unit_test(velocity_is_the_change_of_distance),
        cmocka_unit_test(parents_weigh_as_the_derivative),
        cmocka_unit_test(stress_intensity_of_two_parents),
        cmocka_unit_test(stress_intensity_is_a_mean),
        cmocka_unit_test(folded_march_is_the_unfolded_one),
        cmocka_unit_test(folded_march_with_curvature_is_the_unfolded_one),
        cmocka_unit_test(folded_stress_intensity_is_the_unfolded_one),
        cmocka_unit_test(one_handle_serves_many_marches),
        cmocka_unit_test(no_memory_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
