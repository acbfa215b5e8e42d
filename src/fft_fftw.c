#include "fft.h"

#include <fftw3.h>
#include <stdlib.h>
#include <string.h>

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
    fftw_plan rows_there, columns_there, columns_back, rows_back;
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
static int plan(fft *f) {
    const unsigned flags = FFTW_ESTIMATE | FFTW_DESTROY_INPUT;
    int mx = 2 * f->cx, my = 2 * f->cy, h = f->cx + 1;
    make_planner_safe();
    f->rows_there =
        fftw_plan_many_dft_r2c(1, &mx, f->cy, f->rows, NULL, 1, mx, f->half, NULL, 1, h, flags);
    f->columns_there = fftw_plan_many_dft(1, &my, h, f->half, NULL, h, 1, f->full, NULL, h, 1,
                                          FFTW_FORWARD, flags);
    f->columns_back = fftw_plan_many_dft(1, &my, h, f->full, NULL, h, 1, f->half, NULL, h, 1,
                                         FFTW_BACKWARD, flags);
    f->rows_back =
        fftw_plan_many_dft_c2r(1, &mx, f->cy, f->half, NULL, 1, h, f->rows, NULL, 1, mx, flags);
    return f->rows_there && f->columns_there && f->columns_back && f->rows_back;
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
    fftw_execute(f->rows_there);
    clear_lower_half(f);
    for (size_t j = 1; j < cy; j++)
        memcpy(f->half + (2 * cy - j) * h, f->half + j * h, h * sizeof *f->half);
    fftw_execute(f->columns_there);
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

static void destroy_plan(fftw_plan p) {
    if (p)
        fftw_destroy_plan(p);
}

void ilsai_fft_destroy(fft **f) {
    if (!*f)
        return;
    destroy_plan((*f)->rows_there);
    destroy_plan((*f)->columns_there);
    destroy_plan((*f)->columns_back);
    destroy_plan((*f)->rows_back);
    fftw_free((*f)->rows);
    fftw_free((*f)->half);
    fftw_free((*f)->full);
    fftw_free((*f)->spectrum);
    free(*f);
    *f = NULL;
}

static void lay_out_box(fft *f, size_t bx, size_t by, const double *w, size_t stride) {
    size_t mx = row_length(f);
    for (size_t j = 0; j < by; j++) {
        double *row = f->rows + j * mx;
        memcpy(row, w + j * stride, bx * sizeof *row);
        memset(row + bx, 0, (mx - bx) * sizeof *row);
    }
    memset(f->rows + by * mx, 0, ((size_t)f->cy - by) * mx * sizeof *f->rows);
}

static void multiply_by_spectrum(fft *f) {
    size_t my = 2 * (size_t)f->cy, h = half_length(f);
    for (size_t j = 0; j < my; j++) {
        const double *factor = f->spectrum + (2 * j <= my ? j : my - j) * h;
        fftw_complex *value = f->full + j * h;
        for (size_t i = 0; i < h; i++) {
            value[i][0] *= factor[i];
            value[i][1] *= factor[i];
        }
    }
}

void ilsai_fft_convolve(fft *f, int bx, int by, const double *w, double *p, size_t stride) {
    lay_out_box(f, (size_t)bx, (size_t)by, w, stride);
    fftw_execute(f->rows_there);
    clear_lower_half(f);
    fftw_execute(f->columns_there);
    multiply_by_spectrum(f);
    fftw_execute(f->columns_back);
    fftw_execute(f->rows_back);
    for (size_t j = 0; j < (size_t)by; j++)
        memcpy(p + j * stride, f->rows + j * row_length(f), (size_t)bx * sizeof *p);
}
