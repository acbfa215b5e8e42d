#include "elastic/convolution.h"

#include "base/memory.h"
#include <fftw3.h>
#include <stdbool.h>
#include <string.h>

/* Rows or columns that are transformed at a time, whoever does it: the bits depend on it. */
#define FFT_PART 16
/* Cells of the box below which a part is not worth sharing. */
#define FFT_LEAST 500

/* Transforms of one kind, FFT_PART at a time, and what is left over. NULL: there are none. */
typedef struct batch {
    fftw_plan part, rest;
} batch;

/*
 * The 2-D transform is done as rows, then columns, because only the upper cy of the 2 cy padded
 * rows ever hold the box: the others need no row transform, either way (measured: a quarter less
 * time than FFTW's 2-D plans). Columns go from one array to another, which FFTW does faster than
 * in place. They are twice the work of rows, and cost more the longer they are: a box that is
 * higher than wide is turned (up to half of the time).
 */
typedef struct fft {
    bool turned; /* x and y below are y and x of the caller */
    int cx, cy;
    mirror_axis about_x, about_y;
    double *rows;       /* cy x 2 cx: the box, zeros behind it */
    fftw_complex *half; /* 2 cy x (cx + 1): rows transformed */
    fftw_complex *full; /* 2 cy x (cx + 1): rows and columns transformed */
    double *spectrum;   /* by 1 / (4 cx cy), part by part: (cy + 1) x `terms` x columns */
    int terms;
    batch rows_there, columns_there, columns_back, rows_back;
} fft;

/*
 * The spectrum. Without images a coefficient U of the widths is multiplied by the kernel's T(k, l),
 * which is real and even. Images add, in x, sum_k C(i + k) w_k, which is the convolution of the
 * one-sided H(s) = C(s), s = 0 .. 2 cx - 2, with w(-k), so that
 *
 *     P(k, l) = TT U(k, l) + HT U(-k, l) + TH U(k, -l) + HH U(-k, -l)
 *
 * with the spectra of the kernel that is one-sided in x, in y, and in both. As w is real, U(-k, -l)
 * is the conjugate of U(k, l): rows l and 2 cy - l of one column are mixed with each other only, by
 * a symmetric real matrix of 4 x 4 on their real and imaginary parts (u, U of the upper row, v, V
 * of the lower). One mirror leaves TT and two numbers of it, two mirrors leave it full.
 */
enum { IMAGE_R = 1, IMAGE_I, TERMS_PLAIN = 1, TERMS_HALF = 3 };
enum {
    UPPER_RR,
    UPPER_RI,
    UPPER_II,
    LOWER_RR,
    LOWER_RI,
    LOWER_II,
    UPPER_LOWER_RR,
    UPPER_LOWER_RI,
    UPPER_LOWER_IR,
    UPPER_LOWER_II,
    TERMS_QUARTER
};

static int terms_of(mirror_axis about_x, mirror_axis about_y) {
    int mirrors = (about_x != MIRROR_NONE) + (about_y != MIRROR_NONE);
    return mirrors == 0 ? TERMS_PLAIN : mirrors == 1 ? TERMS_HALF : TERMS_QUARTER;
}

static size_t row_length(const fft *f) {
    return 2 * (size_t)f->cx;
}

static size_t half_length(const fft *f) {
    return (size_t)f->cx + 1;
}

static bool allocate(fft *f) {
    size_t cy = (size_t)f->cy;
    f->rows = fftw_alloc_real(cy * row_length(f));
    f->half = fftw_alloc_complex(2 * cy * half_length(f));
    f->full = fftw_alloc_complex(2 * cy * half_length(f));
    f->spectrum = fftw_alloc_real((cy + 1) * (size_t)f->terms * half_length(f));
    return f->rows && f->half && f->full && f->spectrum;
}

/* FFTW's planner has one state for all threads; it may be told more than once. MKL has none. */
static void make_planner_safe(void) {
#ifndef ILSA_FFT_MKL
    fftw_make_planner_thread_safe();
#endif
}

/* Estimated plans are the same in every run, and with them the bits of a product. */
enum { FFT_FLAGS = FFTW_ESTIMATE | FFTW_DESTROY_INPUT };

static fftw_plan plan_rows(fft *f, int count, bool back) {
    int mx = 2 * f->cx, h = f->cx + 1;
    return back ? fftw_plan_many_dft_c2r(1, &mx, count, f->half, NULL, 1, h, f->rows, NULL, 1, mx,
                                         FFT_FLAGS)
                : fftw_plan_many_dft_r2c(1, &mx, count, f->rows, NULL, 1, mx, f->half, NULL, 1, h,
                                         FFT_FLAGS);
}

static fftw_plan plan_columns(fft *f, int count, bool back) {
    int my = 2 * f->cy, h = f->cx + 1;
    return fftw_plan_many_dft(1, &my, count, back ? f->full : f->half, NULL, h, 1,
                              back ? f->half : f->full, NULL, h, 1,
                              back ? FFTW_BACKWARD : FFTW_FORWARD, FFT_FLAGS);
}

static bool plan_batch(fft *f, batch *b, fftw_plan (*make)(fft *f, int count, bool back), int count,
                       bool back) {
    int whole = count / FFT_PART, rest = count % FFT_PART;
    b->part = whole ? make(f, FFT_PART, back) : NULL;
    b->rest = rest ? make(f, rest, back) : NULL;
    return (b->part || !whole) && (b->rest || !rest);
}

/*
 * FFTW's planner ends the process where it gets no memory, so what it needs is asked for first and
 * given back to it. Measured: 340 kB in the first plans of a process, and 37 bytes for each point
 * of the longest transform.
 */
#define FFT_PLANNER_BYTES         ((size_t)512 << 10)
#define FFT_PLANNER_BYTES_A_POINT ((size_t)64)

static bool planner_has_memory(const fft *f) {
    size_t points = 2 * ((size_t)f->cx + (size_t)f->cy);
    void *volatile room = ilsai_allocate(FFT_PLANNER_BYTES + FFT_PLANNER_BYTES_A_POINT * points, 1);
    bool there = room != NULL;
    ilsai_release(room);
    return there;
}

static bool plan(fft *f) {
    if (!planner_has_memory(f)) {
        return false;
    }
    make_planner_safe();
    return plan_batch(f, &f->rows_there, plan_rows, f->cy, false) &&
           plan_batch(f, &f->columns_there, plan_columns, f->cx + 1, false) &&
           plan_batch(f, &f->columns_back, plan_columns, f->cx + 1, true) &&
           plan_batch(f, &f->rows_back, plan_rows, f->cy, true);
}

/* Parts of a batch. */
static int parts_of(int count) {
    return (count + FFT_PART - 1) / FFT_PART;
}

static size_t end_of_part(int part, int count) {
    int end = (part + 1) * FFT_PART;
    return (size_t)(end < count ? end : count);
}

/* The plan of a part, which starts at *first. */
static fftw_plan part_plan(const batch *b, int part, int count, size_t *first) {
    *first = (size_t)part * FFT_PART;
    return count - part * FFT_PART >= FFT_PART ? b->part : b->rest;
}

static void rows_there(fft *f, int part) {
    size_t first;
    fftw_plan p = part_plan(&f->rows_there, part, f->cy, &first);
    fftw_execute_dft_r2c(p, f->rows + first * row_length(f), f->half + first * half_length(f));
}

static void rows_back(fft *f, int part) {
    size_t first;
    fftw_plan p = part_plan(&f->rows_back, part, f->cy, &first);
    fftw_execute_dft_c2r(p, f->half + first * half_length(f), f->rows + first * row_length(f));
}

static void columns_there(fft *f, int part) {
    size_t first;
    fftw_plan p = part_plan(&f->columns_there, part, f->cx + 1, &first);
    fftw_execute_dft(p, f->half + first, f->full + first);
}

static void columns_back(fft *f, int part) {
    size_t first;
    fftw_plan p = part_plan(&f->columns_back, part, f->cx + 1, &first);
    fftw_execute_dft(p, f->full + first, f->half + first);
}

/* Numbers of an array of the caller's, by column i and row j of the transform: at i * x + j * y. */
typedef struct steps {
    size_t x, y;
} steps;

static steps steps_of(const fft *f, size_t stride) {
    return f->turned ? (steps){stride, 1} : (steps){1, stride};
}

static void gather(double *row, const double *from, size_t step, size_t count) {
    for (size_t i = 0; i < count; i++) {
        row[i] = from[i * step];
    }
}

/*
 * A row of the kernel, or of its one-sided part, in wrapped order. Offset cx does not occur in a
 * box, nor 2 cx - 1 between a cell and an image: they count as zero.
 */
static void lay_out_kernel_row(const fft *f, const double *kernel, size_t step, bool one_sided,
                               double *row) {
    size_t cx = (size_t)f->cx, mx = row_length(f);
    if (one_sided) {
        gather(row, kernel + (f->about_x == MIRROR_EDGE) * step, step, mx - 1);
        row[mx - 1] = 0;
        return;
    }
    gather(row, kernel, step, cx);
    row[cx] = 0;
    for (size_t i = 1; i < cx; i++) {
        row[mx - i] = row[i];
    }
}

/* Transforms cy rows of the kernel, row `first` and those that follow, into the upper half. */
static void transform_kernel_rows(fft *f, const double *kernel, size_t first, bool one_sided) {
    size_t cy = (size_t)f->cy, mx = row_length(f);
    size_t columns = (size_t)ilsai_mirror_offsets(f->about_x, f->cx);
    size_t end = (size_t)ilsai_mirror_offsets(f->about_y, f->cy);
    steps at = steps_of(f, f->turned ? end : columns);
    for (size_t j = 0; j < cy; j++) {
        double *row = f->rows + j * mx;
        if (first + j < end) {
            lay_out_kernel_row(f, kernel + (first + j) * at.y, at.x, one_sided, row);
        } else {
            memset(row, 0, mx * sizeof *row);
        }
    }
    for (int part = 0; part < parts_of(f->cy); part++) {
        rows_there(f, part);
    }
}

/* The spectrum of the kernel into `full`, one-sided in x, in y, or not. */
static void transform_kernel(fft *f, const double *kernel, bool one_sided_x, bool one_sided_y) {
    size_t cy = (size_t)f->cy, h = half_length(f);
    size_t first = one_sided_y && f->about_y == MIRROR_EDGE ? 1 : 0;
    fftw_complex *lower = f->half + cy * h;
    if (one_sided_y) {
        transform_kernel_rows(f, kernel, cy + first, one_sided_x);
        memcpy(lower, f->half, cy * h * sizeof *lower);
    }
    transform_kernel_rows(f, kernel, first, one_sided_x);
    if (!one_sided_y) {
        memset(lower, 0, h * sizeof *lower);
        for (size_t j = 1; j < cy; j++) {
            memcpy(f->half + (2 * cy - j) * h, f->half + j * h, h * sizeof *lower);
        }
    }
    for (int part = 0; part < parts_of(f->cx + 1); part++) {
        columns_there(f, part);
    }
}

/*
 * Adds what the spectrum in `full` contributes to the matrix, given its coefficients in the upper
 * and the lower row. It multiplies conjugates if it is one-sided in x, and goes from row to row if
 * it is so in one direction only.
 */
static void add_to_matrix(double *m, size_t step, bool one_sided_x, bool one_sided_y,
                          const double *upper, const double *lower) {
    double sign = one_sided_x ? -1 : 1;
    if (one_sided_x != one_sided_y) {
        m[UPPER_LOWER_RR * step] += upper[0];
        m[UPPER_LOWER_II * step] += sign * upper[0];
        m[UPPER_LOWER_RI * step] -= sign * upper[1];
        m[UPPER_LOWER_IR * step] += upper[1];
        return;
    }
    m[UPPER_RR * step] += upper[0];
    m[UPPER_II * step] += sign * upper[0];
    m[LOWER_RR * step] += lower[0];
    m[LOWER_II * step] += sign * lower[0];
    if (one_sided_x) {
        m[UPPER_RI * step] += upper[1];
        m[LOWER_RI * step] += lower[1];
    }
}

/* Where row l of the spectrum of the part of columns that starts at first begins. */
static double *spectrum_row(const fft *f, size_t first, size_t columns, size_t l) {
    return f->spectrum + (size_t)f->terms * (first * ((size_t)f->cy + 1) + l * columns);
}

static void add_spectrum_row(fft *f, bool one_sided_x, bool one_sided_y, size_t l) {
    size_t h = half_length(f), mirrored = l ? 2 * (size_t)f->cy - l : 0;
    double scale = 1 / (4 * (double)f->cx * (double)f->cy);
    for (size_t k = 0; k < h; k++) {
        size_t first = k - k % FFT_PART, end = end_of_part((int)(k / FFT_PART), f->cx + 1);
        double *m = spectrum_row(f, first, end - first, l) + (k - first);
        double *up = f->full[l * h + k], *low = f->full[mirrored * h + k];
        double upper[2] = {scale * up[0], scale * up[1]};
        if (f->terms == TERMS_QUARTER) {
            double lower[2] = {scale * low[0], scale * low[1]};
            add_to_matrix(m, end - first, one_sided_x, one_sided_y, upper, lower);
        } else if (one_sided_x || one_sided_y) {
            m[IMAGE_R * (end - first)] = upper[0];
            m[IMAGE_I * (end - first)] = upper[1];
        } else {
            m[0] = upper[0];
        }
    }
}

static void make_spectrum(fft *f, const double *kernel) {
    size_t count = ((size_t)f->cy + 1) * (size_t)f->terms * half_length(f);
    memset(f->spectrum, 0, count * sizeof *f->spectrum);
    int last_x = f->about_x == MIRROR_NONE ? 0 : 1, last_y = f->about_y == MIRROR_NONE ? 0 : 1;
    for (int y = 0; y <= last_y; y++) {
        for (int x = 0; x <= last_x; x++) {
            transform_kernel(f, kernel, x == 1, y == 1);
            for (size_t l = 0; l <= (size_t)f->cy; l++) {
                add_spectrum_row(f, x == 1, y == 1, l);
            }
        }
    }
}

static void destroy_batch(batch *b) {
    if (b->part) {
        fftw_destroy_plan(b->part);
    }
    if (b->rest) {
        fftw_destroy_plan(b->rest);
    }
}

static void destroy(void *made) {
    fft *f = made;
    destroy_batch(&f->rows_there);
    destroy_batch(&f->columns_there);
    destroy_batch(&f->columns_back);
    destroy_batch(&f->rows_back);
    fftw_free(f->rows);
    fftw_free(f->half);
    fftw_free(f->full);
    fftw_free(f->spectrum);
    ilsai_release(f);
}

static void *create(int cx, int cy, mirror_axis about_x, mirror_axis about_y,
                    const double *kernel) {
    fft *f = ilsai_allocate_zeroed(1, sizeof *f);
    if (!f) {
        return NULL;
    }
    if (cy > cx) {
        *f = (fft){.turned = true, .cx = cy, .cy = cx, .about_x = about_y, .about_y = about_x};
    } else {
        *f = (fft){.cx = cx, .cy = cy, .about_x = about_x, .about_y = about_y};
    }
    f->terms = terms_of(about_x, about_y);
    if (!allocate(f) || !plan(f)) {
        destroy(f);
        return NULL;
    }
    make_spectrum(f, kernel);
    return f;
}

/* A product at work. */
typedef struct product {
    fft *f;
    size_t bx, by;
    steps at;
    const double *w;
    double *p;
} product;

/*
 * Rows first .. end - 1 of the box, zeros where it does not reach. A cell on an axis is met twice,
 * as itself and as its image.
 */
static void lay_out_rows(const product *c, size_t first, size_t end) {
    size_t mx = row_length(c->f);
    for (size_t j = first; j < end; j++) {
        double *row = c->f->rows + j * mx;
        size_t filled = j < c->by ? c->bx : 0;
        gather(row, c->w + j * c->at.y, c->at.x, filled);
        memset(row + filled, 0, (mx - filled) * sizeof *row);
        if (c->f->about_x == MIRROR_CENTRE) {
            row[0] *= 0.5;
        }
        for (size_t i = 0; i < filled && j == 0 && c->f->about_y == MIRROR_CENTRE; i++) {
            row[i] *= 0.5;
        }
    }
}

static void transform_rows(void *context, int first, int end) {
    const product *c = context;
    for (int part = first; part < end; part++) {
        lay_out_rows(c, (size_t)part * FFT_PART, end_of_part(part, c->f->cy));
        rows_there(c->f, part);
    }
}

/* `count` coefficients of two rows, which are the same one if it is its own image. */
typedef void multiply_rows(const double *m, size_t count, fftw_complex *upper, fftw_complex *lower);

static void multiply_plain(const double *m, size_t count, fftw_complex *upper,
                           fftw_complex *lower) {
    for (size_t i = 0; i < count; i++) {
        upper[i][0] *= m[i];
        upper[i][1] *= m[i];
    }
    for (size_t i = 0; i < count && lower != upper; i++) {
        lower[i][0] *= m[i];
        lower[i][1] *= m[i];
    }
}

static void multiply_mirrored_x(const double *m, size_t count, fftw_complex *upper,
                                fftw_complex *lower) {
    const double *re = m + IMAGE_R * count, *im = m + IMAGE_I * count;
    for (size_t i = 0; i < count; i++) {
        double ur = upper[i][0], ui = upper[i][1], lr = lower[i][0], li = lower[i][1];
        lower[i][0] = m[i] * lr + re[i] * ur + im[i] * ui;
        lower[i][1] = m[i] * li + im[i] * ur - re[i] * ui;
        upper[i][0] = m[i] * ur + re[i] * lr + im[i] * li;
        upper[i][1] = m[i] * ui + im[i] * lr - re[i] * li;
    }
}

static void multiply_mirrored_y(const double *m, size_t count, fftw_complex *upper,
                                fftw_complex *lower) {
    const double *re = m + IMAGE_R * count, *im = m + IMAGE_I * count;
    for (size_t i = 0; i < count; i++) {
        double ur = upper[i][0], ui = upper[i][1], lr = lower[i][0], li = lower[i][1];
        lower[i][0] = m[i] * lr + re[i] * ur + im[i] * ui;
        lower[i][1] = m[i] * li + re[i] * ui - im[i] * ur;
        upper[i][0] = m[i] * ur + re[i] * lr - im[i] * li;
        upper[i][1] = m[i] * ui + re[i] * li + im[i] * lr;
    }
}

static void multiply_quarter(const double *m, size_t count, fftw_complex *upper,
                             fftw_complex *lower) {
    for (size_t i = 0; i < count; i++) {
        const double *a = m + i;
        double ur = upper[i][0], ui = upper[i][1], lr = lower[i][0], li = lower[i][1];
        lower[i][0] = a[UPPER_LOWER_RR * count] * ur + a[UPPER_LOWER_IR * count] * ui +
                      a[LOWER_RR * count] * lr + a[LOWER_RI * count] * li;
        lower[i][1] = a[UPPER_LOWER_RI * count] * ur + a[UPPER_LOWER_II * count] * ui +
                      a[LOWER_RI * count] * lr + a[LOWER_II * count] * li;
        upper[i][0] = a[UPPER_RR * count] * ur + a[UPPER_RI * count] * ui +
                      a[UPPER_LOWER_RR * count] * lr + a[UPPER_LOWER_RI * count] * li;
        upper[i][1] = a[UPPER_RI * count] * ur + a[UPPER_II * count] * ui +
                      a[UPPER_LOWER_IR * count] * lr + a[UPPER_LOWER_II * count] * li;
    }
}

static multiply_rows *multiplication(const fft *f) {
    return f->terms == TERMS_PLAIN     ? multiply_plain
           : f->terms == TERMS_QUARTER ? multiply_quarter
           : f->about_x == MIRROR_NONE ? multiply_mirrored_y
                                       : multiply_mirrored_x;
}

/* Columns first .. end - 1. */
static void multiply_by_spectrum(fft *f, size_t first, size_t end) {
    size_t cy = (size_t)f->cy, h = half_length(f), columns = end - first;
    multiply_rows *multiply = multiplication(f);
    for (size_t l = 0; l <= cy; l++) {
        multiply(spectrum_row(f, first, columns, l), columns, f->full + l * h + first,
                 f->full + (l ? 2 * cy - l : 0) * h + first);
    }
}

/* Zeros into the lower half of columns first .. end - 1. */
static void clear_lower_part(fft *f, size_t first, size_t end) {
    size_t cy = (size_t)f->cy, h = half_length(f);
    for (size_t j = cy; j < 2 * cy; j++) {
        memset(f->half + j * h + first, 0, (end - first) * sizeof *f->half);
    }
}

static void convolve_columns(void *context, int first, int end) {
    fft *f = ((const product *)context)->f;
    for (int part = first; part < end; part++) {
        size_t from = (size_t)part * FFT_PART, to = end_of_part(part, f->cx + 1);
        clear_lower_part(f, from, to);
        columns_there(f, part);
        multiply_by_spectrum(f, from, to);
        columns_back(f, part);
    }
}

static void scatter(double *to, size_t step, const double *row, size_t count) {
    for (size_t i = 0; i < count; i++) {
        to[i * step] = row[i];
    }
}

static void transform_back(void *context, int first, int end) {
    const product *c = context;
    for (int part = first; part < end; part++) {
        rows_back(c->f, part);
        size_t last = end_of_part(part, (int)c->by);
        for (size_t j = (size_t)part * FFT_PART; j < last; j++) {
            scatter(c->p + j * c->at.y, c->at.x, c->f->rows + j * row_length(c->f), c->bx);
        }
    }
}

static void apply(void *made, thread_pool *threads, int bx, int by, const double *w, double *p,
                  size_t stride) {
    fft *f = made;
    int columns = f->turned ? by : bx, rows = f->turned ? bx : by;
    product c = {f, (size_t)columns, (size_t)rows, steps_of(f, stride), w, p};
    int least = 1 + FFT_LEAST / (FFT_PART * f->cx);
    ilsai_thread_pool_run(threads, transform_rows, &c, parts_of(f->cy), least);
    ilsai_thread_pool_run(threads, convolve_columns, &c, parts_of(f->cx + 1), least);
    ilsai_thread_pool_run(threads, transform_back, &c, parts_of(rows), least);
}

static const convolution_method method = {"fft", create, apply, destroy};
const convolution_method *const ilsai_convolution_fft = &method;
