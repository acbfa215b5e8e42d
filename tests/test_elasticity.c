/* The kernel against 80-digit values, the product against a direct sum and against physics. */
#include "check.h"
#include "csv.h"
#include "elastic/dd_kernel.h"
#include "elastic/elasticity.h"
#include "failing.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Kernel */

static void kernel_agrees_with_reference(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/kernel.csv");
    double worst = NOTHING_YET;
    for (size_t n = 0; n < csv_rows(table); n++) {
        long i = (long)csv_get(table, n, "i"), j = (long)csv_get(table, n, "j");
        double dx = csv_get(table, n, "dx"), dy = csv_get(table, n, "dy");
        double truth = csv_get(table, n, "C_over_Eprime");
        worst = worst_of(worst, fabs(ilsai_dd_kernel(i, j, dx, dy) / truth - 1));
    }
    print_message("kernel: %zu entries, worst relative error %.2g\n", csv_rows(table), worst);
    assert_true(csv_rows(table) > 100);
    assert_below(worst, 2e-15);
    csv_free(table);
}

static void kernel_is_even_and_mirrors_exactly(void **state) {
    (void)state;
    static const double aspect[] = {1e-3, 0.25, 0.3, 1, 1.7, 10, 1e3};
    for (size_t a = 0; a < sizeof aspect / sizeof *aspect; a++)
        for (long i = 0; i < 12; i++)
            for (long j = 0; j < 12; j++) {
                double dx = 0.7 * aspect[a], dy = 0.7, c = ilsai_dd_kernel(i, j, dx, dy);
                assert_true(ilsai_dd_kernel(-i, j, dx, dy) == c);
                assert_true(ilsai_dd_kernel(i, -j, dx, dy) == c);
                assert_true(ilsai_dd_kernel(-i, -j, dx, dy) == c);
                assert_true(ilsai_dd_kernel(j, i, dy, dx) == c);
                assert_true(i == 0 && j == 0 ? c > 0 : c < 0);
            }
}

/* C is 1 / length: cells of any size, to the ends of the number range. */
static void kernel_scales_with_length(void **state) {
    (void)state;
    static const double unit[] = {0x1p-900, 0x1p-30, 0x1p40, 0x1p900};
    for (size_t u = 0; u < sizeof unit / sizeof *unit; u++)
        for (long i = 0; i < 5; i++)
            for (long j = 0; j < 5; j++)
                assert_true(ilsai_dd_kernel(i, j, 0.3 * unit[u], 0.7 * unit[u]) * unit[u] ==
                            ilsai_dd_kernel(i, j, 0.3, 0.7));
}

/* A plane that opens everywhere by the same amount feels no pressure: the entries sum to zero. */
static void kernel_sums_to_zero(void **state) {
    (void)state;
    const int n = 400;
    double sum = 0;
    for (int j = -n; j <= n; j++)
        for (int i = -n; i <= n; i++)
            sum += ilsai_dd_kernel(i, j, 1, 1);
    /* What lies outside the square of half side a: the kernel of one cell of that size. */
    double outside = ilsai_dd_kernel(0, 0, 2.0 * n + 1, 2.0 * n + 1);
    print_message("kernel: sum over a square off by %.2g\n", fabs(sum - outside));
    assert_true(fabs(sum - outside) < 1e-13);
}

/* Products */

static elasticity *make(double E_prime, double dx, double dy, ilsa_product method) {
    elasticity *e;
    assert_int_equal(ilsai_elasticity_create(E_prime, dx, dy, method, &e), ILSA_OK);
    return e;
}

static double *random_field(size_t count, uint64_t seed) {
    double *w = malloc(count * sizeof *w);
    assert_non_null(w);
    for (size_t n = 0; n < count; n++)
        w[n] = next_random(&seed);
    return w;
}

/* The methods that this build has. */
static size_t methods(ilsa_product *method) {
    method[0] = ILSA_PRODUCT_BLAS;
    method[1] = ILSA_PRODUCT_FFT;
    return ilsai_elasticity_has_fft() ? 2 : 1;
}

static double *filled_with_nan(size_t count) {
    double *p = malloc(count * sizeof *p);
    assert_non_null(p);
    for (size_t n = 0; n < count; n++)
        p[n] = NAN;
    return p;
}

static double *product(elasticity *e, int bx, int by, const double *w, size_t stride) {
    double *p = filled_with_nan(stride * (size_t)by);
    assert_int_equal(
        ilsai_elasticity_set_box(e, &(box){0, bx - 1, 0, by - 1}, MIRROR_NONE, MIRROR_NONE),
        ILSA_OK);
    ilsai_elasticity_multiply(e, w, p, stride);
    return p;
}

static mirror_axis axis(int n) {
    static const mirror_axis kinds[] = {MIRROR_NONE, MIRROR_CENTRE, MIRROR_EDGE};
    return kinds[n % 3];
}

/* A box of cells, what it is one side of, and the cells' size. */
typedef struct cells {
    int bx, by;
    mirror_axis about_x, about_y;
    double dx, dy;
} cells;

/* Where cell i and its image stand; how many that are. */
static int places(mirror_axis about, int i, int place[2]) {
    place[0] = i;
    place[1] = about == MIRROR_CENTRE ? -i : -1 - i;
    return about == MIRROR_NONE || place[1] == i ? 1 : 2;
}

static double direct_at(const cells *at, const double *w, size_t stride, int i, int j) {
    double sum = 0;
    int x[2], y[2];
    for (int l = 0; l < at->by; l++)
        for (int k = 0; k < at->bx; k++)
            for (int n = places(at->about_y, l, y); n-- > 0;)
                for (int m = places(at->about_x, k, x); m-- > 0;)
                    sum += ilsai_dd_kernel(i - x[m], j - y[n], at->dx, at->dy) *
                           w[(size_t)l * stride + (size_t)k];
    return sum;
}

/* Largest difference to the direct sum over the largest value. */
static double against_direct_sum(const cells *at, size_t stride, ilsa_product method) {
    elasticity *e = make(1, at->dx, at->dy, method);
    size_t count = stride * (size_t)at->by;
    double *w = random_field(count, 7), *p = filled_with_nan(count);
    double worst = NOTHING_YET, largest = 0;
    assert_int_equal(
        ilsai_elasticity_set_box(e, &(box){0, at->bx - 1, 0, at->by - 1}, at->about_x, at->about_y),
        ILSA_OK);
    ilsai_elasticity_multiply(e, w, p, stride);
    for (int j = 0; j < at->by; j++)
        for (int i = 0; i < (int)stride; i++) {
            double value = p[(size_t)j * stride + (size_t)i];
            if (i >= at->bx) {
                assert_true(isnan(value)); /* nothing is written beside the box */
                continue;
            }
            double truth = direct_at(at, w, stride, i, j);
            worst = worst_of(worst, fabs(value - truth));
            largest = larger_of(largest, fabs(truth));
        }
    free(w);
    free(p);
    ilsai_elasticity_destroy(&e);
    return worst / largest;
}

static void products_agree_with_direct_sum(void **state) {
    (void)state;
    static const int boxes[][2] = {{1, 1},  {1, 9},   {9, 1},   {3, 3},   {8, 8},
                                   {9, 17}, {17, 10}, {33, 31}, {5, 120}, {120, 5}};
    static const double cell[][2] = {{1, 1}, {1, 0.02}, {1, 50}};
    for (size_t c = 0; c < sizeof cell / sizeof *cell; c++) {
        double by_fft = NOTHING_YET, by_blas = NOTHING_YET;
        for (size_t b = 0; b < sizeof boxes / sizeof *boxes; b++) {
            cells at = {boxes[b][0], boxes[b][1], MIRROR_NONE, MIRROR_NONE, cell[c][0], cell[c][1]};
            size_t stride = (size_t)at.bx + 3 * (b % 2);
            by_blas = worst_of(by_blas, against_direct_sum(&at, stride, ILSA_PRODUCT_BLAS));
            if (ilsai_elasticity_has_fft())
                by_fft = worst_of(by_fft, against_direct_sum(&at, stride, ILSA_PRODUCT_FFT));
        }
        print_message("product, cells %g x %g: off the direct sum by %.2g (FFT), %.2g (BLAS)\n",
                      cell[c][0], cell[c][1], by_fft, by_blas);
        if (ilsai_elasticity_has_fft())
            assert_below(by_fft, 1e-12);
        assert_below(by_blas, 1e-12);
    }
}

/* Boxes of one cell, that fill their transform or not, long ones; axes of every kind. */
static void mirrored_products_count_the_images(void **state) {
    (void)state;
    static const int boxes[][2] = {{1, 1},  {1, 9},   {9, 1},   {8, 8},  {10, 16},
                                   {9, 17}, {24, 20}, {25, 23}, {3, 60}, {60, 3}};
    ilsa_product method[2];
    for (size_t m = methods(method); m-- > 0;)
        for (int kind = 1; kind < 9; kind++) {
            double worst = NOTHING_YET;
            for (size_t b = 0; b < sizeof boxes / sizeof *boxes; b++) {
                cells at = {boxes[b][0],    boxes[b][1], axis(kind),
                            axis(kind / 3), 1,           b % 3 ? 1 : 0.4};
                size_t stride = (size_t)at.bx + 3 * (b % 2);
                worst = worst_of(worst, against_direct_sum(&at, stride, method[m]));
            }
            print_message("product, axes %d, %d: off the direct sum with images by %.2g (%s)\n",
                          kind % 3, kind / 3, worst,
                          method[m] == ILSA_PRODUCT_FFT ? "FFT" : "BLAS");
            assert_below(worst, 1e-14);
        }
}

/* Symmetric widths on the whole of a mirrored box. */
static double *unfold(const cells *at, const double *w, int nx, int ny) {
    double *all = malloc((size_t)nx * (size_t)ny * sizeof *all);
    assert_non_null(all);
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            int k = i - (nx - at->bx), l = j - (ny - at->by);
            k = k >= 0 ? k : at->about_x == MIRROR_CENTRE ? -k : -1 - k;
            l = l >= 0 ? l : at->about_y == MIRROR_CENTRE ? -l : -1 - l;
            all[j * nx + i] = w[l * at->bx + k];
        }
    return all;
}

/* A half or a quarter of a fracture: the product is that of the whole. */
static void mirrored_product_is_that_of_the_whole(void **state) {
    (void)state;
    enum { bx = 61, by = 40, count = bx * by };
    ilsa_product method[2];
    for (size_t m = methods(method); m-- > 0;)
        for (int kind = 1; kind < 9; kind++) {
            cells at = {bx, by, axis(kind), axis(kind / 3), 1, 1};
            int nx = at.about_x ? 2 * bx - (at.about_x == MIRROR_CENTRE) : bx;
            int ny = at.about_y ? 2 * by - (at.about_y == MIRROR_CENTRE) : by;
            elasticity *e = make(1, 1, 1, method[m]);
            double *w = random_field(count, 17), *all = unfold(&at, w, nx, ny), p[count];
            double *whole = product(e, nx, ny, all, (size_t)nx), worst = NOTHING_YET, largest = 0;
            assert_int_equal(
                ilsai_elasticity_set_box(e, &(box){0, bx - 1, 0, by - 1}, at.about_x, at.about_y),
                ILSA_OK);
            ilsai_elasticity_multiply(e, w, p, bx);
            for (int n = 0; n < count; n++) {
                double truth = whole[(n / bx + ny - by) * nx + n % bx + nx - bx];
                worst = worst_of(worst, fabs(p[n] - truth));
                largest = larger_of(largest, fabs(truth));
            }
            print_message("product, axes %d, %d, %d x %d of %d x %d: off by %.2g\n", kind % 3,
                          kind / 3, bx, by, nx, ny, worst / largest);
            assert_below(worst, 1e-14 * largest);
            free(w);
            free(all);
            free(whole);
            ilsai_elasticity_destroy(&e);
        }
}

static void fft_and_blas_agree_on_a_large_box(void **state) {
    (void)state;
    enum { bx = 150, by = 130, count = bx * by };
    elasticity *one = make(3e10, 2, 2.5, ILSA_PRODUCT_AUTO);
    elasticity *other = make(3e10, 2, 2.5, ILSA_PRODUCT_BLAS);
    double *w = random_field(count, 3), worst = NOTHING_YET, largest = 0;
    double *p = product(one, bx, by, w, bx), *q = product(other, bx, by, w, bx);
    for (int n = 0; n < count; n++) {
        worst = worst_of(worst, fabs(p[n] - q[n]));
        largest = larger_of(largest, fabs(q[n]));
    }
    print_message("product, %d x %d: FFT and BLAS differ by %.2g\n", bx, by, worst / largest);
    assert_below(worst, 1e-13 * largest);
    free(w);
    free(p);
    free(q);
    ilsai_elasticity_destroy(&one);
    ilsai_elasticity_destroy(&other);
}

static double dot(const double *a, const double *b, size_t count) {
    double sum = 0;
    for (size_t n = 0; n < count; n++)
        sum += a[n] * b[n];
    return sum;
}

/* Reciprocity, and strain energy above zero for any opening. */
static void product_is_symmetric_and_positive(void **state) {
    (void)state;
    enum { bx = 37, by = 22, count = bx * by };
    ilsa_product method[2];
    for (size_t m = methods(method); m-- > 0;) {
        elasticity *e = make(1, 1, 1.5, method[m]);
        double *u = random_field(count, 1), *v = random_field(count, 2);
        double *Cu = product(e, bx, by, u, bx), *Cv = product(e, bx, by, v, bx);
        double gap = fabs(dot(v, Cu, count) - dot(u, Cv, count));
        print_message("product: v C u - u C v = %.2g of u C u\n", gap / dot(u, Cu, count));
        assert_true(dot(u, Cu, count) > 0 && dot(v, Cv, count) > 0);
        assert_true(gap < 1e-13 * dot(u, Cu, count));
        free(u);
        free(v);
        free(Cu);
        free(Cv);
        ilsai_elasticity_destroy(&e);
    }
}

/* A patch of opening somewhere else in the box gives the same pressures around it. */
static void product_is_translation_invariant(void **state) {
    (void)state;
    enum { bx = 40, by = 30, side = 6, patch_count = side * side, count = bx * by };
    ilsa_product method[2];
    for (size_t m = methods(method); m-- > 0;) {
        elasticity *e = make(1, 1, 1, method[m]);
        double *patch = random_field(patch_count, 5), worst = NOTHING_YET;
        double *near = calloc(count, sizeof *near), *far = calloc(count, sizeof *far);
        for (int j = 0; j < side; j++)
            for (int i = 0; i < side; i++) {
                near[(j + 1) * bx + i + 2] = patch[j * side + i];
                far[(j + 21) * bx + i + 31] = patch[j * side + i];
            }
        double *p = product(e, bx, by, near, bx), *q = product(e, bx, by, far, bx);
        for (int j = 0; j < 10; j++)
            for (int i = 0; i < 11; i++)
                worst = worst_of(worst, fabs(p[j * bx + i] - q[(j + 20) * bx + i + 29]));
        print_message("product: moved patch differs by %.2g of the self term\n",
                      worst / ilsai_elasticity_self_entry(e, 0, 0));
        assert_below(worst, 1e-14);
        free(patch);
        free(near);
        free(far);
        free(p);
        free(q);
        ilsai_elasticity_destroy(&e);
    }
}

static void product_scales_with_modulus(void **state) {
    (void)state;
    enum { bx = 19, by = 23, count = bx * by };
    ilsa_product method[2];
    for (size_t m = methods(method); m-- > 0;) {
        elasticity *one = make(1, 1, 1, method[m]), *stiff = make(0x1p35, 1, 1, method[m]);
        double *w = random_field(count, 9);
        double *p = product(one, bx, by, w, bx), *q = product(stiff, bx, by, w, bx);
        for (int n = 0; n < count; n++)
            assert_true(q[n] == 0x1p35 * p[n]);
        free(w);
        free(p);
        free(q);
        ilsai_elasticity_destroy(&one);
        ilsai_elasticity_destroy(&stiff);
    }
}

/* Whatever boxes came before, a box gives the same bits. */
static void product_has_no_memory(void **state) {
    (void)state;
    static const int other[][2] = {{7, 7}, {60, 9}, {28, 31}, {25, 32}, {100, 100}};
    enum { bx = 27, by = 31, count = bx * by };
    ilsa_product method[2];
    for (size_t m = methods(method); m-- > 0;) {
        elasticity *e = make(1, 1, 1, method[m]);
        double *w = random_field(count, 11), *p = product(e, bx, by, w, bx);
        for (size_t b = 0; b < sizeof other / sizeof *other; b++) {
            size_t stride = (size_t)other[b][0];
            double *v = random_field(stride * (size_t)other[b][1], 12);
            double *q = product(e, other[b][0], other[b][1], v, stride);
            assert_int_equal(ilsai_elasticity_set_box(e, &(box){0, bx - 1, 0, by - 1}, axis((int)b),
                                                      axis((int)b + 1)),
                             ILSA_OK);
            double *again = product(e, bx, by, w, bx);
            assert_memory_equal(p, again, count * sizeof *p);
            free(v);
            free(q);
            free(again);
        }
        free(w);
        free(p);
        ilsai_elasticity_destroy(&e);
    }
}

/* A product after one with NaN and infinities is not contaminated. */
static void product_forgets_bad_numbers(void **state) {
    (void)state;
    enum { bx = 20, by = 20, count = bx * by };
    ilsa_product method[2];
    for (size_t m = methods(method); m-- > 0;) {
        elasticity *e = make(1, 1, 1, method[m]);
        double *w = random_field(count, 13), *bad = random_field(count, 14);
        double *p = product(e, bx, by, w, bx);
        bad[5] = NAN;
        bad[99] = INFINITY;
        free(product(e, bx, by, bad, bx));
        double *again = product(e, bx, by, w, bx);
        assert_memory_equal(p, again, count * sizeof *p);
        free(w);
        free(bad);
        free(p);
        free(again);
        ilsai_elasticity_destroy(&e);
    }
}

static void entries_are_the_kernel(void **state) {
    (void)state;
    ilsa_product method[2];
    for (size_t m = methods(method); m-- > 0;) {
        elasticity *e = make(8, 1, 1, method[m]);
        assert_int_equal(
            ilsai_elasticity_set_box(e, &(box){3, 11, 4, 9}, MIRROR_EDGE, MIRROR_CENTRE), ILSA_OK);
        for (int j = -10; j <= 10; j++)
            for (int i = -17; i <= 17; i++)
                assert_true(ilsai_elasticity_entry(e, i, j, 0, 0) ==
                            8 * ilsai_dd_kernel(i, j, 1, 1));
        assert_int_equal(e->product, method[m]);
        assert_int_equal(ilsai_elasticity_set_box(e, &(box){0, 10, 0, 5}, MIRROR_NONE, MIRROR_NONE),
                         ILSA_OK);
        for (int j = -5; j <= 5; j++)
            for (int i = -10; i <= 10; i++)
                assert_true(ilsai_elasticity_entry(e, i, j, 0, 0) ==
                            8 * ilsai_dd_kernel(i, j, 1, 1));
        assert_true(ilsai_elasticity_entry(e, 3, 5, 0, 0) == ilsai_elasticity_entry(e, 1, 6, 6, 3));
        ilsai_elasticity_destroy(&e);
    }
}

/* Penny and ellipse: the opening under uniform pressure gives the pressure back. */

/* Largest relative error of the pressure over the cells within half the semi-axes. */
static double ellipse_error(double a, double b, double w0, double cell) {
    int mx = (int)ceil(a / cell), my = (int)ceil(b / cell), nx = 2 * mx + 1, ny = 2 * my + 1;
    double *w = malloc((size_t)nx * (size_t)ny * sizeof *w), worst = NOTHING_YET;
    assert_non_null(w);
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            double x = (i - mx) * cell / a, y = (j - my) * cell / b;
            w[j * nx + i] = w0 * sqrt(fmax(0, 1 - x * x - y * y));
        }
    elasticity *e = make(1, cell, cell, ILSA_PRODUCT_AUTO);
    double *p = product(e, nx, ny, w, (size_t)nx);
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            double x = (i - mx) * cell / a, y = (j - my) * cell / b;
            if (x * x + y * y < 0.25)
                worst = worst_of(worst, fabs(p[j * nx + i] - 1));
        }
    free(w);
    free(p);
    ilsai_elasticity_destroy(&e);
    return worst;
}

/* At least first order in the cell size: the error halves with it, or better. */
static void check_convergence(double a, double b, double w0) {
    double last = INFINITY;
    for (int n = 10; n <= 80; n *= 2) {
        double error = ellipse_error(a, b, w0, b / n);
        print_message("semi-axes %g, %g, %2d cells to the smaller: pressure off by %.2g %%\n", a, b,
                      n, 100 * error);
        assert_below(error, 0.08 / n);
        assert_true(error < 0.55 * last);
        last = error;
    }
}

static void penny_gives_its_pressure_back(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/penny_uniform_pressure.csv");
    int pennies = 0;
    for (size_t n = 0; n < csv_rows(table); n++)
        if (csv_get(table, n, "rho") == 0) {
            double R = csv_get(table, n, "R"), p = csv_get(table, n, "p_over_Eprime");
            double w0 = csv_get(table, n, "w") / p;
            assert_true(fabs(w0 - 8 * R / pi) < 1e-14 * w0);
            check_convergence(R, R, w0);
            pennies++;
        }
    assert_true(pennies > 0);
    csv_free(table);
}

static void ellipse_gives_its_pressure_back(void **state) {
    (void)state;
    csv_table *table = csv_read("tests/data/ellipse_uniform_pressure.csv");
    double last = 0;
    for (size_t n = 0; n < csv_rows(table); n++) {
        double a = csv_get(table, n, "a"), b = csv_get(table, n, "b");
        if (a == last)
            continue;
        last = a;
        check_convergence(a, b, csv_get(table, n, "w0"));
    }
    csv_free(table);
}

/* Handles */

static void create_refuses_what_is_not_built(void **state) {
    (void)state;
    elasticity *e = (elasticity *)&e;
    ilsa_status status = ilsai_elasticity_create(1, 1, 1, ILSA_PRODUCT_FFT, &e);
    assert_int_equal(status, ilsai_elasticity_has_fft() ? ILSA_OK : ILSA_ERR_MISMATCH);
    assert_true(!e == !ilsai_elasticity_has_fft());
    if (e)
        assert_int_equal(e->product, ILSA_PRODUCT_FFT);
    ilsai_elasticity_destroy(&e);
    assert_null(e);
    ilsai_elasticity_destroy(&e);
}

/* Handles are independent: threads that make boxes and products at once get the serial bits. */
enum { SIDE = 24, BOXES = 12 };

static double checksum(int side) {
    size_t count = (size_t)side * (size_t)side;
    elasticity *e = make(1, 1, 1, ILSA_PRODUCT_AUTO);
    double *w = random_field(count, 16), *p = product(e, side, side, w, (size_t)side), sum = 0;
    for (size_t n = 0; n < count; n++)
        sum += (double)(n + 1) * p[n];
    free(w);
    free(p);
    ilsai_elasticity_destroy(&e);
    return sum;
}

static void *all_checksums(void *sums) {
    for (int n = 0; n < BOXES; n++)
        ((double *)sums)[n] = checksum(SIDE + 7 * n);
    return NULL;
}

static void threads_do_not_disturb_each_other(void **state) {
    (void)state;
    enum { THREADS = 4 };
    pthread_t thread[THREADS];
    double serial[BOXES], parallel[THREADS][BOXES];
    for (int t = 0; t < THREADS; t++)
        assert_int_equal(pthread_create(&thread[t], NULL, all_checksums, parallel[t]), 0);
    for (int t = 0; t < THREADS; t++)
        assert_int_equal(pthread_join(thread[t], NULL), 0);
    all_checksums(serial);
    for (int t = 0; t < THREADS; t++)
        assert_memory_equal(parallel[t], serial, sizeof serial);
}

/* After a refused box the one before is still in use. */
static void no_memory_keeps_the_box(void **state) {
    (void)state;
    enum { bx = 20, by = 15, count = bx * by };
    ilsa_product method[2];
    for (size_t m = methods(method); m-- > 0;) {
        elasticity *e = make(1, 1, 1, method[m]);
        double *w = random_field(count, 15), *p = product(e, bx, by, w, bx), again[count];
        assert_int_equal(
            ilsai_elasticity_set_box(e, &(box){1, 1 << 30, 1, 1 << 30}, MIRROR_NONE, MIRROR_NONE),
            ILSA_ERR_MEMORY);
        ilsai_elasticity_multiply(e, w, again, bx);
        assert_memory_equal(p, again, sizeof again);
        int failures = 0;
        ilsa_status status = ILSA_ERR_MEMORY;
        while (status != ILSA_OK) {
            allocations_left = failures++;
            status = ilsai_elasticity_set_box(e, &(box){0, 39, 0, 49}, MIRROR_NONE, MIRROR_NONE);
            allocations_left = -1;
            if (status != ILSA_OK) {
                assert_int_equal(status, ILSA_ERR_MEMORY);
                ilsai_elasticity_multiply(e, w, again, bx);
                assert_memory_equal(p, again, sizeof again);
            }
        }
        assert_true(failures > 8);
        elasticity *none = e;
        allocations_left = 0;
        status = ilsai_elasticity_create(1, 1, 1, method[m], &none);
        allocations_left = -1;
        assert_int_equal(status, ILSA_ERR_MEMORY);
        assert_null(none);
        free(w);
        free(p);
        ilsai_elasticity_destroy(&e);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernel_agrees_with_reference),
        cmocka_unit_test(kernel_is_even_and_mirrors_exactly),
        cmocka_unit_test(kernel_scales_with_length),
        cmocka_unit_test(kernel_sums_to_zero),
        cmocka_unit_test(products_agree_with_direct_sum),
        cmocka_unit_test(mirrored_products_count_the_images),
        cmocka_unit_test(mirrored_product_is_that_of_the_whole),
        cmocka_unit_test(fft_and_blas_agree_on_a_large_box),
        cmocka_unit_test(product_is_symmetric_and_positive),
        cmocka_unit_test(product_is_translation_invariant),
        cmocka_unit_test(product_scales_with_modulus),
        cmocka_unit_test(product_has_no_memory),
        cmocka_unit_test(product_forgets_bad_numbers),
        cmocka_unit_test(entries_are_the_kernel),
        cmocka_unit_test(penny_gives_its_pressure_back),
        cmocka_unit_test(ellipse_gives_its_pressure_back),
        cmocka_unit_test(create_refuses_what_is_not_built),
        cmocka_unit_test(threads_do_not_disturb_each_other),
        cmocka_unit_test(no_memory_keeps_the_box),
    };
    return cmocka_run_group_tests_name("elasticity", tests, NULL, NULL);
}
