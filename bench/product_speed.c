/*
 * Wall time of one elasticity product by box size: FFT, BLAS, direct sum; of a half and a quarter
 * of the box by FFT, where it is symmetric; and of a new box.
 */
#include "base/clock.h"
#include "common_worst.h"
#include "elastic/dd_kernel.h"
#include "elastic/elasticity.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

enum { REPEATS = 5, DIRECT_CELLS_MAX = 20000, BLAS_CELLS_MAX = 70000 };
static const double SECONDS = 0.02; /* of each repeat; the best one counts */

/* The kernel over all offsets of a box, -bx < i < bx: the direct sum reads lines of it. */
typedef struct direct {
    int bx, by;
    double *kernel;
} direct;

static double *alloc_doubles(size_t count) {
    double *values = malloc(count * sizeof *values);
    if (!values) {
        fprintf(stderr, "no memory\n");
        exit(1);
    }
    return values;
}

static direct make_direct(int bx, int by) {
    int width = 2 * bx - 1, height = 2 * by - 1;
    direct d = {bx, by, alloc_doubles((size_t)width * (size_t)height)};
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            d.kernel[j * width + i] = ilsai_dd_kernel(i - bx + 1, j - by + 1, 1, 1);
    return d;
}

static void multiply_direct(const direct *d, const double *w, double *p) {
    ptrdiff_t bx = d->bx, by = d->by, width = 2 * bx - 1;
    for (ptrdiff_t j = 0; j < by; j++)
        for (ptrdiff_t i = 0; i < bx; i++) {
            double sum = 0;
            for (ptrdiff_t l = 0; l < by; l++) {
                const double *line = d->kernel + (l - j + by - 1) * width + bx - 1 - i;
                for (ptrdiff_t k = 0; k < bx; k++)
                    sum += line[k] * w[l * bx + k];
            }
            p[j * bx + i] = sum;
        }
}

/* What is timed: a product by e, or by d where e is NULL. */
typedef struct subject {
    elasticity *e;
    const direct *d;
    const double *w;
    double *p;
    size_t stride;
} subject;

static void run(const subject *s) {
    if (s->e)
        ilsai_elasticity_multiply(s->e, s->w, s->p, s->stride);
    else
        multiply_direct(s->d, s->w, s->p);
}

/* Seconds per product. */
static double time_of(const subject *s) {
    double best = INFINITY;
    run(s);
    for (int r = 0; r < REPEATS; r++) {
        double start = ilsai_clock(), now;
        int count = 0;
        do {
            run(s);
            count++;
            now = ilsai_clock();
        } while (now - start < SECONDS);
        best = fmin(best, (now - start) / count);
    }
    return best;
}

static elasticity *make(ilsa_product method) {
    elasticity *e;
    if (ilsai_elasticity_create(1, 1, 1, method, &e)) {
        fprintf(stderr, "no memory\n");
        exit(1);
    }
    return e;
}

/* Milliseconds of a product by a method, and of making ready for the box. */
static double time_box(ilsa_product method, subject s, int bx, int by, mirror_axis about_x,
                       mirror_axis about_y, double *ready) {
    s.e = make(method);
    double start = ilsai_clock();
    if (ilsai_elasticity_set_box(s.e, &(box){0, bx - 1, 0, by - 1}, about_x, about_y)) {
        ilsai_elasticity_destroy(&s.e);
        return NAN;
    }
    *ready = 1e3 * (ilsai_clock() - start);
    double seconds = time_of(&s);
    ilsai_elasticity_destroy(&s.e);
    return 1e3 * seconds;
}

static double time_method(ilsa_product method, subject s, int bx, int by, double *ready) {
    return time_box(method, s, bx, by, MIRROR_NONE, MIRROR_NONE, ready);
}

/* The axis through cells or between them; the part of n that is to be solved for. */
static mirror_axis axis_of(int n) {
    return n % 2 ? MIRROR_CENTRE : MIRROR_EDGE;
}

static int part_of(int n) {
    return (n + 1) / 2;
}

/* Milliseconds; the sums in p serve as the truth. */
static double time_direct(subject s, int bx, int by) {
    direct d = make_direct(bx, by);
    s.d = &d;
    double seconds = time_of(&s);
    free(d.kernel);
    return 1e3 * seconds;
}

static double largest_difference(const double *p, const double *q, int count) {
    double difference = 0, largest = 0;
    for (int n = 0; n < count; n++) {
        difference = larger_of(difference, fabs(p[n] - q[n]));
        largest = larger_of(largest, fabs(q[n]));
    }
    return difference / largest;
}

static void print_cell(double value, const char *format) {
    if (isnan(value))
        printf("%11s", "-");
    else
        printf(format, value);
}

/* Of the halves and a quarter; p is overwritten. */
static void print_parts(subject s, int bx, int by) {
    int hx = part_of(bx), hy = part_of(by);
    mirror_axis x = axis_of(bx), y = axis_of(by);
    double half_x = NAN, half_y = NAN, quarter = NAN, ready;
    if (ilsai_elasticity_has_fft()) {
        half_x = time_box(ILSA_PRODUCT_FFT, s, hx, by, x, MIRROR_NONE, &ready);
        half_y = time_box(ILSA_PRODUCT_FFT, s, bx, hy, MIRROR_NONE, y, &ready);
        quarter = time_box(ILSA_PRODUCT_FFT, s, hx, hy, x, y, &ready);
    }
    print_cell(half_x, "%11.4f");
    print_cell(half_y, "%11.4f");
    print_cell(quarter, "%11.4f");
}

static void print_row(int bx, int by) {
    int count = bx * by;
    double *w = alloc_doubles((size_t)count), *p = alloc_doubles((size_t)count);
    double *truth = alloc_doubles((size_t)count);
    for (int n = 0; n < count; n++)
        w[n] = sin(n * (double)n);
    double fft = NAN, blas = NAN, sum = NAN, error = NAN, ready = NAN, blas_ready;
    if (count <= DIRECT_CELLS_MAX)
        sum = time_direct((subject){.w = w, .p = truth, .stride = (size_t)bx}, bx, by);
    subject s = {.w = w, .p = p, .stride = (size_t)bx};
    if (count <= BLAS_CELLS_MAX)
        blas = time_method(ILSA_PRODUCT_BLAS, s, bx, by, &blas_ready);
    if (ilsai_elasticity_has_fft())
        fft = time_method(ILSA_PRODUCT_FFT, s, bx, by, &ready);
    if (!isnan(sum))
        error = largest_difference(p, truth, count);
    printf("%5d x %-5d%9d", bx, by, count);
    print_cell(fft, "%11.4f");
    print_parts(s, bx, by);
    print_cell(blas, "%11.4f");
    print_cell(sum, "%11.3f");
    print_cell(error, "%11.1e");
    print_cell(ready, "%11.2f");
    printf("\n");
    free(w);
    free(p);
    free(truth);
}

int main(void) {
    static const int size[][2] = {{12, 12},   {16, 16},   {24, 24},   {32, 32},    {48, 48},
                                  {64, 64},   {80, 80},   {96, 96},   {112, 112},  {128, 128},
                                  {160, 160}, {192, 192}, {256, 256}, {384, 384},  {512, 512},
                                  {32, 128},  {128, 32},  {20, 400},  {400, 20},   {33, 33},
                                  {49, 49},   {65, 65},   {97, 97},   {1000, 1000}};
    printf(
        "milliseconds per product; off: FFT (BLAS where there is none) against the direct sum\n");
    printf("%13s%9s%11s%11s%11s%11s%11s%11s%11s%11s\n", "box", "cells", "FFT", "half, x", "half, y",
           "quarter", "BLAS", "direct", "off", "new box");
    for (size_t b = 0; b < sizeof size / sizeof *size; b++)
        print_row(size[b][0], size[b][1]);
    return 0;
}
