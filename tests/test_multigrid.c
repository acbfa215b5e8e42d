/*
 * The two halves of the preconditioner: one multigrid cycle for flow with springs, and widths from
 * the near field of the elasticity.
 */
#include "check.h"
#include "elastic/dd_kernel.h"
#include "elastic/elasticity.h"
#include "solve/multigrid.h"
#include "solve/near_field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Flow -------------------------------------------------------------------------------------
 */

/* A round footprint in nx by ny cells whose conductance falls with the cube towards the rim. */
static void set_round(multigrid *m, int nx, int ny, double spring, double aspect) {
    assert_int_equal(ilsai_multigrid_shape(m, nx, ny), ILSA_OK);
    multigrid_level *l = &m->level[0];
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            double x = (2 * i + 1.0) / nx - 1, y = (2 * j + 1.0) / ny - 1;
            double x2 = (2 * i + 3.0) / nx - 1, y2 = (2 * j + 3.0) / ny - 1;
            double w = 1 - x * x - y * y, right = 1 - x2 * x2 - y * y, up = 1 - x * x - y2 * y2;
            size_t at = (size_t)(j + 1) * (size_t)l->stride + (size_t)i + 1;
            if (w <= 0)
                continue;
            l->spring[at] = spring;
            l->right[at] = right > 0 ? 1e3 * pow(0.5 * (w + right), 1.5) : 0;
            l->up[at] = up > 0 ? aspect * 1e3 * pow(0.5 * (w + up), 1.5) : 0;
        }
    ilsai_multigrid_build(m);
}

/* out = (d - div c grad) y on level 0. */
static void apply(const multigrid_level *l, const double *y, double *out) {
    for (int j = 0; j < l->ny; j++)
        for (int i = 0; i < l->nx; i++) {
            size_t at = (size_t)(j + 1) * (size_t)l->stride + (size_t)i + 1;
            size_t below = at - (size_t)l->stride, above = at + (size_t)l->stride;
            out[at] = l->spring[at] * y[at] + l->right[at] * (y[at] - y[at + 1]) +
                      l->right[at - 1] * (y[at] - y[at - 1]) + l->up[at] * (y[at] - y[above]) +
                      l->up[below] * (y[at] - y[below]);
        }
}

static size_t size_of(const multigrid_level *l) {
    return (size_t)l->stride * ((size_t)l->ny + 2);
}

static double norm(const double *v, size_t count) {
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += v[k] * v[k];
    return sqrt(sum);
}

/* What is left of the residual of a random right-hand side after some cycles, per cycle. */
static double contraction(multigrid *m) {
    enum { CYCLES = 6 };
    multigrid_level *l = &m->level[0];
    size_t size = size_of(l);
    double *b = calloc(size, sizeof *b), *y = calloc(size, sizeof *y), *r = calloc(size, sizeof *r);
    assert_true(b && y && r);
    for (size_t at = 0; at < size; at++)
        b[at] = l->inverse[at] > 0 ? rand() / (double)RAND_MAX - 0.3 : 0;
    memcpy(r, b, size * sizeof *b);
    double first = norm(r, size);
    for (int k = 0; k < CYCLES; k++) {
        memcpy(l->b, r, size * sizeof *r);
        ilsai_multigrid_cycle(m);
        for (size_t at = 0; at < size; at++)
            y[at] += l->y[at];
        apply(l, y, r);
        for (size_t at = 0; at < size; at++)
            r[at] = b[at] - r[at];
    }
    double factor = pow(norm(r, size) / first, 1.0 / CYCLES);
    free(b);
    free(y);
    free(r);
    return factor;
}

static void cycles_contract_on_any_rectangle(void **state) {
    (void)state;
    static const int side[][2] = {{1, 1}, {2, 1}, {1, 9}, {7, 5}, {33, 32}, {100, 12}, {129, 131}};
    static const double spring[] = {1e-6, 1, 1e4};
    multigrid m = {0};
    srand(3);
    for (size_t k = 0; k < sizeof side / sizeof *side; k++)
        for (int p = 0; p < 3; p++) {
            set_round(&m, side[k][0], side[k][1], spring[p], 1);
            double factor = contraction(&m);
            print_message("%d x %d cells, spring %g: %d levels, residual times %.3f a cycle\n",
                          side[k][0], side[k][1], spring[p], m.levels, factor);
            assert_true(factor < 0.5);
        }
    ilsai_multigrid_destroy(&m);
}

/* Cells a hundred times as long as wide: joined along the strong faces first. */
static void cycles_contract_on_oblong_cells(void **state) {
    (void)state;
    multigrid m = {0};
    for (double aspect = 1e-4; aspect < 2e4; aspect *= 100) {
        set_round(&m, 60, 50, 1, aspect);
        double factor = contraction(&m);
        print_message("faces %g to 1: residual times %.3f a cycle\n", aspect, factor);
        assert_true(factor < 0.6);
    }
    ilsai_multigrid_destroy(&m);
}

/* Springs alone: a constant pressure is nearly found at once, and dry cells have none. */
static void nothing_in_dry_cells(void **state) {
    (void)state;
    multigrid m = {0};
    set_round(&m, 20, 21, 1, 1);
    multigrid_level *l = &m.level[0];
    for (size_t at = 0; at < size_of(l); at++)
        l->b[at] = l->spring[at];
    ilsai_multigrid_cycle(&m);
    for (size_t at = 0; at < size_of(l); at++) {
        assert_true(l->inverse[at] > 0 || l->y[at] == 0);
        assert_true(l->inverse[at] == 0 || fabs(l->y[at] - 1) < 0.1);
    }
    ilsai_multigrid_destroy(&m);
}

/* ---- Near field -------------------------------------------------------------------------------
 */

/* Widths x, pressures from them by the stencil, widths again; images as mirror says. */
static double near_error(int nx, int ny, double aspect, int mirror) {
    near_field f = {0};
    assert_int_equal(ilsai_near_field_shape(&f, nx, ny), ILSA_OK);
    f.about_x = f.about_y = mirror < 0 ? MIRROR_NONE : mirror == 0 ? MIRROR_EDGE : MIRROR_CENTRE;
    f.self = ilsai_dd_kernel(0, 0, 1, aspect);
    f.beside = ilsai_dd_kernel(1, 0, 1, aspect);
    f.above = ilsai_dd_kernel(0, 1, 1, aspect);
    f.corner = ilsai_dd_kernel(1, 1, 1, aspect);
    size_t stride = (size_t)f.stride, size = stride * ((size_t)ny + 2);
    double *x = calloc(size, sizeof *x), error = NOTHING_YET, most = 0;
    assert_non_null(x);
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            size_t at = (size_t)(j + 1) * stride + (size_t)i + 1;
            f.open[at] = i + 2 * j < 2 * nx;
            f.extra[at] = (i + j) % 7 == 0 ? 0.15 * f.self : 0;
            x[at] = f.open[at] * (rand() / (double)RAND_MAX);
        }
    for (size_t j = 1; mirror >= 0 && j <= (size_t)ny; j++)
        x[j * stride] = x[j * stride + 1 + (size_t)mirror];
    if (mirror >= 0)
        memcpy(x, x + (1 + (size_t)mirror) * stride, stride * sizeof *x);
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            size_t at = (size_t)(j + 1) * stride + (size_t)i + 1, up = at + stride,
                   down = at - stride;
            f.y[at] =
                f.open[at] * ((f.self + f.extra[at]) * x[at] + f.beside * (x[at - 1] + x[at + 1]) +
                              f.above * (x[up] + x[down]) +
                              f.corner * (x[up - 1] + x[up + 1] + x[down - 1] + x[down + 1]));
        }
    ilsai_near_field_solve(&f);
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            size_t at = (size_t)(j + 1) * stride + (size_t)i + 1;
            error = worst_of(error, fabs(f.x[at] - x[at]));
            most = larger_of(most, x[at]);
            assert_true(f.open[at] > 0 || f.x[at] == 0);
        }
    free(x);
    ilsai_near_field_destroy(&f);
    return error / most;
}

static void near_field_gives_widths_back(void **state) {
    (void)state;
    static const double aspect[] = {1, 0.5, 3, 0.1};
    for (int k = 0; k < 4; k++)
        for (int mirror = -1; mirror <= 1; mirror++) {
            double error = near_error(30, 23, aspect[k], mirror);
            print_message("dy/dx = %g, images %d: widths to %.3f\n", aspect[k], mirror, error);
            assert_below(error, aspect[k] == 1 ? 0.1 : 0.5);
        }
    assert_below(near_error(1, 1, 1, -1), 0.2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cycles_contract_on_any_rectangle),
        cmocka_unit_test(cycles_contract_on_oblong_cells),
        cmocka_unit_test(nothing_in_dry_cells),
        cmocka_unit_test(near_field_gives_widths_back),
    };
    return cmocka_run_group_tests_name("multigrid", tests, NULL, NULL);
}
