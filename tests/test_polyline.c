/* The front as polylines, and where the summary sees it. */
#include "base/error.h"
#include "check.h"
#include "failing.h"
#include "host.h"
#include "step/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static void check_message(const char *message, const char *part) {
    if (!strstr(message, part))
        fail_msg("message '%s' does not contain '%s'", message, part);
}

typedef struct curve {
    const ilsa_front_point *points;
    size_t count;
} curve;

static curve front_of(ilsa_solver *solver) {
    curve c = {NULL, 0};
    assert_int_equal(ilsa_get_front(solver, &c.points, &c.count), ILSA_OK);
    assert_true(c.count > 0);
    return c;
}

/* The points of one loop. */
static curve loop_of(curve all, int loop) {
    curve c = {NULL, 0};
    for (size_t k = 0; k < all.count; k++)
        if (all.points[k].loop == loop) {
            c.points = c.points ? c.points : &all.points[k];
            c.count++;
        }
    return c;
}

static int loops_of(curve all) {
    return all.points[all.count - 1].loop + 1;
}

/* Positive if counter-clockwise. */
static double area(curve c) {
    double twice = 0;
    for (size_t k = 0; k < c.count; k++) {
        const ilsa_front_point *a = &c.points[k], *b = &c.points[(k + 1) % c.count];
        twice += a->x * b->y - b->x * a->y;
    }
    return 0.5 * twice;
}

/* Loops in one piece each, numbered from 0, the longest first; no two points further apart than one
 * square allows, the last from the first neither. */
static void check_closed(curve all, double dx, double dy) {
    size_t longest = loop_of(all, 0).count, total = 0;
    for (size_t k = 1; k < all.count; k++)
        assert_true(all.points[k].loop == all.points[k - 1].loop ||
                    all.points[k].loop == all.points[k - 1].loop + 1);
    for (int loop = 0; loop < loops_of(all); loop++) {
        curve c = loop_of(all, loop);
        assert_true(c.count >= 3 && c.count <= longest);
        total += c.count;
        for (size_t k = 0; k < c.count; k++) {
            const ilsa_front_point *a = &c.points[k], *b = &c.points[(k + 1) % c.count];
            assert_true(fabs(a->x - b->x) <= dx * (1 + 1e-12));
            assert_true(fabs(a->y - b->y) <= dy * (1 + 1e-12));
        }
    }
    assert_int_equal(all.points[0].loop, 0);
    assert_int_equal(total, all.count);
}

/* Pennies */

static void check_circle(ilsa_solver *solver, double x, double y, double R, double allowed) {
    curve c = front_of(solver);
    double worst = NOTHING_YET;
    check_closed(c, solver->model.mesh.dx, solver->model.mesh.dy);
    assert_int_equal(loops_of(c), 1);
    for (size_t k = 0; k < c.count; k++) {
        const ilsa_front_point *p = &c.points[k];
        worst = worst_of(worst, fabs(hypot(p->x - x, p->y - y) - R));
        assert_true(fabs(p->regime.N_k + p->regime.N_mt + p->regime.N_m - 1) < 1e-12);
        assert_true(fabs(p->V / host_summary(solver).V_max - 1) < 0.3);
    }
    assert_true(fabs(area(c) / (pi * R * R) - 1) < 2 * allowed / R);
    assert_below(worst, allowed);
}

/* The level of a penny is exact: only the chords are off, by h^2 / 8R. */
static void circles_are_circles(void **unused) {
    (void)unused;
    static const double place[][2] = {{0, 0}, {0.05, 0.05}, {0.123, -0.217}, {-0.4, 0.31}};
    static const double radius[] = {0.25, 0.6, 1.01, 1.3};
    for (int n = 0; n < 4; n++)
        for (int k = 0; k < 4; k++) {
            host_scene scene = host_penny(1e-2, 40 + n % 2, 0.1);
            scene.mesh.dy = n == 3 ? 0.09 : 0.1;
            scene.source[0].x = place[n][0];
            scene.source[0].y = place[n][1];
            ilsa_solver *solver = host_started(&scene, radius[k]);
            double chord = 0.1 * 0.1 / (8 * radius[k]);
            check_circle(solver, place[n][0], place[n][1], radius[k], 1.5 * chord);
            ilsa_summary now = host_summary(solver);
            double allowed = 2 * chord;
            assert_true(fabs(now.extent_x_max - place[n][0] - radius[k]) <= allowed);
            assert_true(fabs(place[n][0] - radius[k] - now.extent_x_min) <= allowed);
            assert_true(fabs(now.extent_y_max - place[n][1] - radius[k]) <= allowed);
            assert_true(fabs(place[n][1] - radius[k] - now.extent_y_min) <= allowed);
            ilsa_solver_destroy(&solver);
        }
}

/* x_min .. y_max are of the lines through the cell of the first source: chords a little off its
 * middle. */
static void lines_go_through_the_source(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1e-2, 41, 0.1);
    scene.source_count = 2;
    scene.source[0].x = 0.13;
    scene.source[0].y = -0.24;
    scene.source[1] = (ilsa_source_def){0.5, 0.5, 0};
    ilsa_solver *solver = host_started(&scene, 0.9);
    ilsa_summary now = host_summary(solver);
    double half_x = sqrt(0.9 * 0.9 - 0.04 * 0.04), half_y = sqrt(0.9 * 0.9 - 0.03 * 0.03);
    assert_true(fabs(now.x_max - (0.13 + half_x)) < 0.003);
    assert_true(fabs(now.x_min - (0.13 - half_x)) < 0.003);
    assert_true(fabs(now.y_max - (-0.24 + half_y)) < 0.003);
    assert_true(fabs(now.y_min - (-0.24 - half_y)) < 0.003);
    ilsa_solver_destroy(&solver);
    /* Between cells: the mean of the lines on both sides. */
    scene.source[0].x = 0.05;
    scene.source[0].y = 0.05;
    solver = host_started(&scene, 0.9);
    now = host_summary(solver);
    half_x = sqrt(0.9 * 0.9 - 0.05 * 0.05);
    assert_true(fabs(now.x_max - (0.05 + half_x)) < 0.003);
    assert_true(fabs(now.y_min - (0.05 - half_x)) < 0.003);
    const double *width;
    assert_int_equal(ilsa_get_width(solver, &width), ILSA_OK);
    double four = 0.25 * (width[20 * 41 + 20] + width[20 * 41 + 21] + width[21 * 41 + 20] +
                          width[21 * 41 + 21]);
    assert_true(fabs(now.width_source / four - 1) < 1e-14);
    ilsa_solver_destroy(&solver);
}

/* After steps the front is still round, and its ends are those of the summary. */
static void grown_fronts_agree_with_the_summary(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1, 61, 0.05);
    ilsa_solver *solver = host_started(&scene, 0.6);
    host_steps(solver, 10);
    ilsa_summary now = host_summary(solver);
    check_circle(solver, 0, 0, 0.5 * (now.x_max - now.x_min), 0.01);
    curve c = front_of(solver);
    double left = INFINITY, right = -INFINITY, down = INFINITY, up = -INFINITY;
    for (size_t k = 0; k < c.count; k++) {
        left = smaller_of(left, c.points[k].x);
        right = larger_of(right, c.points[k].x);
        down = smaller_of(down, c.points[k].y);
        up = larger_of(up, c.points[k].y);
    }
    assert_true(fabs(left - now.extent_x_min) < 1e-12 && fabs(right - now.extent_x_max) < 1e-12);
    assert_true(fabs(down - now.extent_y_min) < 1e-12 && fabs(up - now.extent_y_max) < 1e-12);
    assert_true(fabs(now.x_max - now.extent_x_max) < 1e-12);
    assert_true(fabs(now.y_min - now.extent_y_min) < 1e-12);
    ilsa_solver_destroy(&solver);
}

/* The regime of a point is that of a survey cell than which none is nearer. */
static void regimes_are_of_the_nearest_survey_cell(void **unused) {
    (void)unused;
    host_scene scene = host_three_layers(61, 61); /* the front is faster along the layers */
    ilsa_solver *solver = host_started(&scene, 15);
    host_steps(solver, 20);
    curve c = front_of(solver);
    const ilsa_survey_point *survey;
    size_t count;
    double low = INFINITY, high = -INFINITY;
    assert_int_equal(ilsa_get_survey(solver, &survey, &count), ILSA_OK);
    for (size_t k = 0; k < c.count; k++) {
        const ilsa_front_point *p = &c.points[k];
        double least = INFINITY;
        int same = 0;
        for (size_t n = 0; n < count; n++)
            least = smaller_of(least, hypot(survey[n].x - p->x, survey[n].y - p->y));
        for (size_t n = 0; n < count; n++)
            same += hypot(survey[n].x - p->x, survey[n].y - p->y) < least * (1 + 1e-9) &&
                    survey[n].regime.N_k == p->regime.N_k && survey[n].regime.x == p->regime.x &&
                    survey[n].regime.y == p->regime.y;
        assert_true(same > 0);
        low = smaller_of(low, p->regime.N_k);
        high = larger_of(high, p->regime.N_k);
    }
    assert_above(high - low, 0.05); /* it matters which */
    ilsa_solver_destroy(&solver);
}

/* Reading changes nothing, and reading again gives the same. */
static void reading_changes_nothing(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_solver *solver = host_started(&scene, 0.9);
    host_image before = host_save(solver);
    curve a = front_of(solver);
    ilsa_front_point *copy = malloc(a.count * sizeof *copy);
    assert_non_null(copy);
    memcpy(copy, a.points, a.count * sizeof *copy);
    curve b = front_of(solver);
    assert_true(a.count == b.count);
    for (size_t k = 0; k < b.count; k++)
        assert_true(copy[k].x == b.points[k].x && copy[k].y == b.points[k].y &&
                    copy[k].V == b.points[k].V && copy[k].loop == b.points[k].loop);
    assert_true(host_is(solver, &before));
    free(copy);
    host_free(&before);
    ilsa_solver_destroy(&solver);
}

/* Shapes that are drawn into the level of a solver */

enum { SIDE = 61, HALF = 30, CELLS = SIDE * SIDE };
static const double h = 0.1;

typedef double (*shape)(double x, double y);

static double disc(double x, double y, double R) {
    return hypot(x, y) - R;
}

static ilsa_solver *drawn(shape level) {
    host_scene scene = host_penny(0, SIDE, h);
    ilsa_solver *solver = host_started(&scene, 0.5);
    box wet = {SIDE, -1, SIDE, -1};
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            int cell = j * SIDE + i;
            double T = level(h * (i - HALF), h * (j - HALF));
            solver->fracture.cells.level[cell] = T;
            solver->fracture.cells.kind[cell] = T <= 0 ? ILSA_CELL_SURVEY : ILSA_CELL_EMPTY;
            solver->fracture.cells.width[cell] = solver->fracture.cells.speed[cell] = T <= 0;
            if (T <= 0)
                ilsai_box_add(&wet, i, j);
        }
    solver->fracture.footprint = wet;
    return solver;
}

static double ring(double x, double y) {
    return fmax(disc(x, y, 2.3), 0.8 - hypot(x, y));
}

/* Fluid on the left: the outer curve counter-clockwise, the hole clockwise. */
static void rings_have_two_loops(void **unused) {
    (void)unused;
    ilsa_solver *solver = drawn(ring);
    curve all = front_of(solver);
    check_closed(all, h, h);
    assert_int_equal(loops_of(all), 2);
    assert_true(fabs(area(loop_of(all, 0)) / (pi * 2.3 * 2.3) - 1) < 0.01);
    assert_true(fabs(area(loop_of(all, 1)) / -(pi * 0.8 * 0.8) - 1) < 0.01);
    ilsa_summary now = host_summary(solver);
    assert_true(fabs(now.extent_x_max - 2.3) < 0.01 && fabs(now.extent_y_min + 2.3) < 0.01);
    ilsa_solver_destroy(&solver);
}

/* A disc that the lines through the source cross at a slant. */
static double slanted(double x, double y) {
    return disc(x - 0.7, y - 0.9, 1.5);
}

static void lines_cross_the_front_at_a_slant(void **unused) {
    (void)unused;
    ilsa_solver *solver = drawn(slanted);
    ilsa_summary now = host_summary(solver);
    double half_x = sqrt(1.5 * 1.5 - 0.9 * 0.9), half_y = sqrt(1.5 * 1.5 - 0.7 * 0.7);
    assert_true(fabs(now.x_max - (0.7 + half_x)) < 0.02 * h);
    assert_true(fabs(now.x_min - (0.7 - half_x)) < 0.02 * h);
    assert_true(fabs(now.y_max - (0.9 + half_y)) < 0.02 * h);
    assert_true(fabs(now.y_min - (0.9 - half_y)) < 0.02 * h);
    ilsa_solver_destroy(&solver);
}

/* From below: the smallest, the largest, the middle one. */
static double three_discs(double x, double y) {
    double a = disc(x + 1.5, y + 2, 0.35), b = disc(x - 1, y, 1.2), c = disc(x + 1, y - 1.9, 0.7);
    return fmin(a, fmin(b, c));
}

static void the_longest_loop_comes_first(void **unused) {
    (void)unused;
    ilsa_solver *solver = drawn(three_discs);
    curve all = front_of(solver);
    check_closed(all, h, h);
    assert_int_equal(loops_of(all), 3);
    assert_true(fabs(area(loop_of(all, 0)) / (pi * 1.2 * 1.2) - 1) < 0.02);
    double rest = area(loop_of(all, 1)) + area(loop_of(all, 2));
    assert_true(fabs(rest / (pi * (0.35 * 0.35 + 0.7 * 0.7)) - 1) < 0.04);
    ilsa_solver_destroy(&solver);
}

/* One cell, with a level of 0 at its very centre on the left. */
static double one_cell(double x, double y) {
    return fmax(fabs(x), fabs(y)) < 0.5 * h ? -0.5 * h : fmax(fabs(x), fabs(y)) - 0.5 * h;
}

static void a_single_cell_is_a_diamond(void **unused) {
    (void)unused;
    ilsa_solver *solver = drawn(one_cell);
    curve all = front_of(solver);
    check_closed(all, h, h);
    assert_true(all.count == 4 && fabs(area(all) - 0.5 * h * h) < 1e-12);
    ilsa_solver_destroy(&solver);
}

/* Two cells that touch at a corner, and the two other ways round. */
static double corner(double x, double y) {
    return fmin(one_cell(x, y), one_cell(x - h, y - h));
}

static double other_corner(double x, double y) {
    return corner(-x, y);
}

static void fluid_that_touches_at_a_corner_stays_apart(void **unused) {
    (void)unused;
    const shape shapes[] = {corner, other_corner};
    for (int k = 0; k < 2; k++) {
        ilsa_solver *solver = drawn(shapes[k]);
        curve all = front_of(solver);
        check_closed(all, h, h);
        assert_int_equal(loops_of(all), 2);
        assert_true(fabs(area(loop_of(all, 0)) - 0.5 * h * h) < 1e-12);
        assert_true(fabs(area(loop_of(all, 1)) - 0.5 * h * h) < 1e-12);
        ilsa_solver_destroy(&solver);
    }
}

/* A checkerboard inside a disc: as many saddles as there can be. */
static double checkerboard(double x, double y) {
    long i = lround(x / h), j = lround(y / h);
    return disc(x, y, 1.5) < 0 && (i + j) % 2 == 0 ? -0.03 : 0.05;
}

static void every_saddle_is_resolved(void **unused) {
    (void)unused;
    ilsa_solver *solver = drawn(checkerboard);
    curve all = front_of(solver);
    check_closed(all, h, h);
    int cells = 0;
    for (int k = 0; k < CELLS; k++)
        cells += solver->fracture.cells.level[k] <= 0;
    assert_int_equal(loops_of(all), cells);
    assert_int_equal(all.count, 4 * (size_t)cells);
    ilsa_solver_destroy(&solver);
}

/* The level at cell centres is zero, and infinite beyond. */
static double square_to_infinity(double x, double y) {
    double side = fmax(fabs(x), fabs(y));
    return side < 1 - 0.5 * h ? -0.5 : side < 1 + 0.5 * h ? 0 : INFINITY;
}

static void zeros_and_infinities_are_finite_points(void **unused) {
    (void)unused;
    ilsa_solver *solver = drawn(square_to_infinity);
    curve all = front_of(solver);
    check_closed(all, h, h);
    assert_int_equal(loops_of(all), 1);
    for (size_t k = 0; k < all.count; k++)
        assert_near(larger_of(fabs(all.points[k].x), fabs(all.points[k].y)), 1, 1e-12);
    assert_true(area(all) > 3.9 && area(all) < 4.0001);
    ilsa_summary now = host_summary(solver);
    assert_true(fabs(now.extent_x_max - 1) < 1e-12 && fabs(now.y_min + 1) < 1e-12);
    ilsa_solver_destroy(&solver);
}

/* Bad calls */

static void bad_calls_are_refused(void **unused) {
    (void)unused;
    host_scene scene = host_penny(0, 41, 0.1);
    ilsa_solver *solver = host_solver(&scene);
    const ilsa_front_point *points = NULL;
    const ilsa_survey_point *survey = NULL;
    size_t count = 7;
    assert_int_equal(ilsa_get_front(solver, &points, &count), ILSA_ERR_STATE);
    check_message(ilsa_last_error(solver), "ilsa_start_radial");
    assert_int_equal(ilsa_get_survey(solver, &survey, &count), ILSA_ERR_STATE);
    assert_int_equal(ilsa_get_front(NULL, &points, &count), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "solver");
    assert_int_equal(ilsa_get_survey(NULL, &survey, &count), ILSA_ERR_NULL);
    assert_int_equal(ilsa_start_radial(solver, 0.9), ILSA_OK);
    assert_int_equal(ilsa_get_front(solver, NULL, &count), ILSA_ERR_NULL);
    check_message(ilsa_last_error(solver), "points");
    assert_int_equal(ilsa_get_survey(solver, NULL, &count), ILSA_ERR_NULL);
    check_message(ilsa_last_error(solver), "points");
    assert_int_equal(ilsa_get_front(solver, &points, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(solver), "count");
    assert_int_equal(ilsa_get_survey(solver, &survey, NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(solver), "count");
    assert_true(!points && !survey && count == 7);
    ilsa_solver_destroy(&solver);
}

static void no_memory_is_reported(void **unused) {
    (void)unused;
    host_scene scene = host_penny(0, 81, 0.1);
    ilsa_solver *solver = host_started(&scene, 3);
    const ilsa_front_point *points = NULL;
    const ilsa_survey_point *survey = NULL;
    size_t count = 7;
    for (int most = 0; most < 3; most++) {
        allocations_left = most;
        ilsa_status status = ilsa_get_front(solver, &points, &count);
        allocations_left = -1;
        assert_int_equal(status, ILSA_ERR_MEMORY);
        check_message(ilsa_last_error(solver), "no memory");
    }
    allocations_left = 0;
    ilsa_status status = ilsa_get_survey(solver, &survey, &count);
    allocations_left = -1;
    assert_int_equal(status, ILSA_ERR_MEMORY);
    assert_true(!points && !survey && count == 7);
    check_circle(solver, 0, 0, 3, 0.001);
    ilsa_solver_destroy(&solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(circles_are_circles),
        cmocka_unit_test(lines_go_through_the_source),
        cmocka_unit_test(grown_fronts_agree_with_the_summary),
        cmocka_unit_test(regimes_are_of_the_nearest_survey_cell),
        cmocka_unit_test(reading_changes_nothing),
        cmocka_unit_test(rings_have_two_loops),
        cmocka_unit_test(lines_cross_the_front_at_a_slant),
        cmocka_unit_test(the_longest_loop_comes_first),
        cmocka_unit_test(a_single_cell_is_a_diamond),
        cmocka_unit_test(fluid_that_touches_at_a_corner_stays_apart),
        cmocka_unit_test(every_saddle_is_resolved),
        cmocka_unit_test(zeros_and_infinities_are_finite_points),
        cmocka_unit_test(bad_calls_are_refused),
        cmocka_unit_test(no_memory_is_reported),
    };
    return cmocka_run_group_tests_name("contour", tests, NULL, NULL);
}
