#include "fft.h"

#include <fftw3.h>
#include <stdlib.h>
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
 * in place.
 */
struct fft {
    int cx, cy;
    double *rows;       /* cy x 2 cx: the box, zeros behind it */
    fftw_complex *half; /* 2 cy x (cx + 1): rows transformed */
    fftw_complex *full; /* 2 cy x (cx + 1): rows and columns transformed */
    double *spectrum;   /* (cy + 1) x (cx + 1): of the kernel, real and even, by 1 / (4 cx cy) */
    batch rows_there, columns_there, columns_back, rows_back;
};

int ilsai_fft_available(void) {
    return 1;
}

static size_t row_length(const fft *f) {
    return 2 * (size_t)f->cx;
}

static size_t half_length(const fft *f) {
    return (size_t)f->cx + 1;
}

static int allocate(fft *f) {
    size_t cy = (size_t)f->cy;
    f->rows = fftw_alloc_real(cy * row_length(f));
    f->half = fftw_alloc_complex(2 * cy * half_length(f));
    f->full = fftw_alloc_complex(2 * cy * half_length(f));
    f->spectrum = fftw_alloc_real((cy + 1) * half_length(f));
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

static fftw_plan plan_rows(fft *f, int count, int back) {
    int mx = 2 * f->cx, h = f->cx + 1;
    return back ? fftw_plan_many_dft_c2r(1, &mx, count, f->half, NULL, 1, h, f->rows, NULL, 1, mx,
                                         FFT_FLAGS)
                : fftw_plan_many_dft_r2c(1, &mx, count, f->rows, NULL, 1, mx, f->half, NULL, 1, h,
                                         FFT_FLAGS);
}

static fftw_plan plan_columns(fft *f, int count, int back) {
    int my = 2 * f->cy, h = f->cx + 1;
    return fftw_plan_many_dft(1, &my, count, back ? f->full : f->half, NULL, h, 1,
                              back ? f->half : f->full, NULL, h, 1,
                              back ? FFTW_BACKWARD : FFTW_FORWARD, FFT_FLAGS);
}

static int plan_batch(fft *f, batch *b, fftw_plan (*make)(fft *f, int count, int back), int count,
                      int back) {
    int whole = count / FFT_PART, rest = count % FFT_PART;
    b->part = whole ? make(f, FFT_PART, back) : NULL;
    b->rest = rest ? make(f, rest, back) : NULL;
    return (b->part || !whole) && (b->rest || !rest);
}

static int plan(fft *f) {
    make_planner_safe();
    return plan_batch(f, &f->rows_there, plan_rows, f->cy, 0) &&
           plan_batch(f, &f->columns_there, plan_columns, f->cx + 1, 0) &&
           plan_batch(f, &f->columns_back, plan_columns, f->cx + 1, 1) &&
           plan_batch(f, &f->rows_back, plan_rows, f->cy, 1);
}

/* Parts of a batch. */
static int parts_of(int count) {
    return (count + FFT_PART - 1) / FFT_PART;
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

static void clear_lower_half(fft *f) {
    size_t count = (size_t)f->cy * half_length(f);
    memset(f->half + count, 0, count * sizeof *f->half);
}

/* The kernel of row j in wrapped order; offset cx does not occur in a box and counts as zero. */
static void lay_out_kernel_row(const fft *f, const double *kernel, size_t j) {
    size_t cx = (size_t)f->cx, mx = row_length(f);
    double *row = f->rows + j * mx;
    memcpy(row, kernel + j * cx, cx * sizeof *row);
    row[cx] = 0;
    for (size_t i = 1; i < cx; i++)
        row[mx - i] = row[i];
}

/* An even kernel has an even real spectrum: rows 0 .. cy of it are all there is to keep. */
static void transform_kernel(fft *f, const double *kernel) {
    size_t cy = (size_t)f->cy, h = half_length(f);
    for (size_t j = 0; j < cy; j++)
        lay_out_kernel_row(f, kernel, j);
    for (int part = 0; part < parts_of(f->cy); part++)
        rows_there(f, part);
    clear_lower_half(f);
    for (size_t j = 1; j < cy; j++)
        memcpy(f->half + (2 * cy - j) * h, f->half + j * h, h * sizeof *f->half);
    for (int part = 0; part < parts_of(f->cx + 1); part++)
        columns_there(f, part);
    double scale = 1 / (4 * (double)f->cx * (double)f->cy);
    for (size_t n = 0; n < (cy + 1) * h; n++)
        f->spectrum[n] = scale * f->full[n][0];
}

fft *ilsai_fft_create(int cx, int cy, const double *kernel) {
    fft *f = calloc(1, sizeof *f);
    if (!f)
        return NULL;
    f->cx = cx;
    f->cy = cy;
    if (!allocate(f) || !plan(f)) {
        ilsai_fft_destroy(&f);
        return NULL;
    }
    transform_kernel(f, kernel);
    return f;
}

static void destroy_batch(batch *b) {
    if (b->part)
        fftw_destroy_plan(b->part);
    if (b->rest)
        fftw_destroy_plan(b->rest);
}

void ilsai_fft_destroy(fft **f) {
    if (!*f)
        return;
    destroy_batch(&(*f)->rows_there);
    destroy_batch(&(*f)->columns_there);
    destroy_batch(&(*f)->columns_back);
    destroy_batch(&(*f)->rows_back);
    fftw_free((*f)->rows);
    fftw_free((*f)->half);
    fftw_free((*f)->full);
    fftw_free((*f)->spectrum);
    free(*f);
    *f = NULL;
}

/* A product at work. */
typedef struct product {
    fft *f;
    size_t bx, by, stride;
    const double *w;
    double *p;
} product;

/* Rows first .. end - 1 of the box, zeros where it does not reach. */
static void lay_out_rows(const product *c, size_t first, size_t end) {
    size_t mx = row_length(c->f);
    for (size_t j = first; j < end; j++) {
        double *row = c->f->rows + j * mx;
        size_t filled = j < c->by ? c->bx : 0;
        memcpy(row, c->w + j * c->stride, filled * sizeof *row);
        memset(row + filled, 0, (mx - filled) * sizeof *row);
    }
}

static size_t end_of_part(int part, int count) {
    int end = (part + 1) * FFT_PART;
    return (size_t)(end < count ? end : count);
}

static void transform_rows(void *context, int first, int end) {
    const product *c = context;
    for (int part = first; part < end; part++) {
        lay_out_rows(c, (size_t)part * FFT_PART, end_of_part(part, c->f->cy));
        rows_there(c->f, part);
    }
}

/* Columns first .. end - 1. */
static void multiply_by_spectrum(fft *f, size_t first, size_t end) {
    size_t my = 2 * (size_t)f->cy, h = half_length(f);
    for (size_t j = 0; j < my; j++) {
        const double *factor = f->spectrum + (2 * j <= my ? j : my - j) * h;
        fftw_complex *value = f->full + j * h;
        for (size_t i = first; i < end; i++) {
            value[i][0] *= factor[i];
            value[i][1] *= factor[i];
        }
    }
}

/* Zeros into the lower half of columns first .. end - 1. */
static void clear_lower_part(fft *f, size_t first, size_t end) {
    size_t cy = (size_t)f->cy, h = half_length(f);
    for (size_t j = cy; j < 2 * cy; j++)
        memset(f->half + j * h + first, 0, (end - first) * sizeof *f->half);
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

static void transform_back(void *context, int first, int end) {
    const product *c = context;
    for (int part = first; part < end; part++) {
        rows_back(c->f, part);
        size_t last = end_of_part(part, (int)c->by);
        for (size_t j = (size_t)part * FFT_PART; j < last; j++)
            memcpy(c->p + j * c->stride, c->f->rows + j * row_length(c->f), c->bx * sizeof *c->p);
    }
}

void ilsai_fft_convolve(fft *f, team *threads, int bx, int by, const double *w, double *p,
                        size_t stride) {
    product c = {f, (size_t)bx, (size_t)by, stride, w, p};
    int least = 1 + FFT_LEAST / (FFT_PART * f->cx);
    ilsai_team_run(threads, transform_rows, &c, parts_of(f->cy), least);
    ilsai_team_run(threads, convolve_columns, &c, parts_of(f->cx + 1), least);
    ilsai_team_run(threads, transform_back, &c, parts_of(by), least);
}
