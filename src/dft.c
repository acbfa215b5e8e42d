#include "dft.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * One direction. On c cells around the origin, s = i - (c - 1) / 2, padded to a period of 2 c, the
 * functions cos(pi k s / c), k = 0 .. c - 1, and sin(pi k s / c), k = 1 .. c, are all there are,
 * and an even kernel multiplies each by a number: its spectrum at k. Cosines see only the even
 * part of the widths and sines the odd part, so that either matrix is c by c / 2.
 */
typedef struct basis {
    int c;
    double *cosine, *sine; /* row k or k - 1, column i < c / 2 */
} basis;

/*
 * Widths go through four arrays. Rows and columns of `folded` are first even, then odd parts;
 * those of `waves` first cosines, then sines; `half_way` has rows of parts and columns of waves.
 */
struct dft {
    basis x, y;
    double *spectrum; /* (cy + 1) by (cx + 1), with the factors of the transform back */
    double *folded;   /* cy by cx */
    double *half_way; /* cy by 2 cx */
    double *waves;    /* 2 cy by 2 cx */
};

static double *alloc_doubles(size_t rows, size_t columns) {
    return malloc(rows * columns * sizeof(double));
}

/* pi n / (2 c), less whole turns. */
static double angle(long n, int c) {
    return 3.14159265358979323846 * (double)(n % (4L * c)) / (2 * c);
}

static int basis_create(basis *b, int c) {
    size_t count = (size_t)c, half = count / 2;
    b->c = c;
    b->cosine = alloc_doubles(count, half);
    b->sine = alloc_doubles(count, half);
    if (!b->cosine || !b->sine)
        return 0;
    for (int k = 0; k < c; k++)
        for (int i = 0; i < c / 2; i++) {
            size_t n = (size_t)k * half + (size_t)i;
            b->cosine[n] = cos(angle((long)k * (2 * i - c + 1), c));
            b->sine[n] = sin(angle((long)(k + 1) * (2 * i - c + 1), c));
        }
    return 1;
}

/* Row k = 0 .. c: what gives the spectrum of an even function from its values at 0 .. c - 1. */
static double *even_transform(int c) {
    double *a = alloc_doubles((size_t)c + 1, (size_t)c);
    if (!a)
        return NULL;
    for (int k = 0; k <= c; k++)
        for (int i = 0; i < c; i++)
            a[(size_t)k * (size_t)c + (size_t)i] = (i ? 2 : 1) * cos(angle(2L * k * i, c));
    return a;
}

/* All products are of whole blocks: C = A B, either transposed. */
static void multiply(CBLAS_TRANSPOSE ta, CBLAS_TRANSPOSE tb, int rows, int columns, int inner,
                     const double *a, int a_step, const double *b, int b_step, double *c,
                     int c_step) {
    cblas_dgemm(CblasRowMajor, ta, tb, rows, columns, inner, 1, a, a_step, b, b_step, 0, c, c_step);
}

/* Waves 0 and c occur once in the period of 2 c, the others twice. */
static double wave_weight(int k, int c) {
    return (k == 0 || k == c ? 1.0 : 2.0) / (2.0 * c);
}

static int make_spectrum(dft *d, const double *kernel) {
    int cx = d->x.c, cy = d->y.c;
    double *ax = even_transform(cx), *ay = even_transform(cy);
    double *half = alloc_doubles((size_t)cy, (size_t)cx + 1);
    int good = ax && ay && half;
    if (good) {
        multiply(CblasNoTrans, CblasTrans, cy, cx + 1, cx, kernel, cx, ax, cx, half, cx + 1);
        multiply(CblasNoTrans, CblasNoTrans, cy + 1, cx + 1, cy, ay, cy, half, cx + 1, d->spectrum,
                 cx + 1);
        double *value = d->spectrum;
        for (int l = 0; l <= cy; l++)
            for (int k = 0; k <= cx; k++)
                *value++ *= wave_weight(k, cx) * wave_weight(l, cy);
    }
    free(ax);
    free(ay);
    free(half);
    return good;
}

dft *ilsai_dft_create(int cx, int cy, const double *kernel) {
    dft *d = calloc(1, sizeof *d);
    if (!d)
        return NULL;
    size_t x = (size_t)cx, y = (size_t)cy;
    d->spectrum = alloc_doubles(y + 1, x + 1);
    d->folded = alloc_doubles(y, x);
    d->half_way = alloc_doubles(y, 2 * x);
    d->waves = alloc_doubles(2 * y, 2 * x);
    if (!d->spectrum || !d->folded || !d->half_way || !d->waves || !basis_create(&d->x, cx) ||
        !basis_create(&d->y, cy) || !make_spectrum(d, kernel))
        ilsai_dft_destroy(&d);
    return d;
}

static void basis_destroy(basis *b) {
    free(b->cosine);
    free(b->sine);
}

void ilsai_dft_destroy(dft **d) {
    if (!*d)
        return;
    basis_destroy(&(*d)->x);
    basis_destroy(&(*d)->y);
    free((*d)->spectrum);
    free((*d)->folded);
    free((*d)->half_way);
    free((*d)->waves);
    free(*d);
    *d = NULL;
}

/* Even and odd part of `count` <= c widths, zeros behind them. */
static void fold_row(const double *w, size_t count, size_t c, double *part) {
    for (size_t i = 0; i < c / 2; i++) {
        double low = i < count ? w[i] : 0, high = c - 1 - i < count ? w[c - 1 - i] : 0;
        part[i] = low + high;
        part[c / 2 + i] = low - high;
    }
}

static void unfold_row(const double *part, size_t count, size_t c, double *p) {
    for (size_t i = 0; i < c / 2; i++) {
        if (i < count)
            p[i] = part[i] + part[c / 2 + i];
        if (c - 1 - i < count)
            p[c - 1 - i] = part[i] - part[c / 2 + i];
    }
}

/* Rows j and cy - 1 - j of one array: their sum and difference, rows j and cy / 2 + j of another.
 */
static void fold_rows(const double *row, size_t cy, size_t length, double *part) {
    for (size_t j = 0; j < cy / 2; j++)
        for (size_t i = 0; i < length; i++) {
            double low = row[j * length + i], high = row[(cy - 1 - j) * length + i];
            part[j * length + i] = low + high;
            part[(cy / 2 + j) * length + i] = low - high;
        }
}

static void unfold_rows(const double *part, size_t cy, size_t length, double *row) {
    for (size_t j = 0; j < cy / 2; j++)
        for (size_t i = 0; i < length; i++) {
            double even = part[j * length + i], odd = part[(cy / 2 + j) * length + i];
            row[j * length + i] = even + odd;
            row[(cy - 1 - j) * length + i] = even - odd;
        }
}

static void to_waves(dft *d) {
    int cx = d->x.c, cy = d->y.c, hx = cx / 2, hy = cy / 2, mx = 2 * cx;
    const double *odd_rows = d->half_way + (size_t)hy * (size_t)mx;
    double *sine_rows = d->waves + (size_t)cy * (size_t)mx;
    multiply(CblasNoTrans, CblasTrans, cy, cx, hx, d->folded, cx, d->x.cosine, hx, d->half_way, mx);
    multiply(CblasNoTrans, CblasTrans, cy, cx, hx, d->folded + hx, cx, d->x.sine, hx,
             d->half_way + cx, mx);
    multiply(CblasNoTrans, CblasNoTrans, cy, mx, hy, d->y.cosine, hy, d->half_way, mx, d->waves,
             mx);
    multiply(CblasNoTrans, CblasNoTrans, cy, mx, hy, d->y.sine, hy, odd_rows, mx, sine_rows, mx);
}

static void from_waves(dft *d) {
    int cx = d->x.c, cy = d->y.c, hx = cx / 2, hy = cy / 2, mx = 2 * cx;
    double *odd_rows = d->half_way + (size_t)hy * (size_t)mx;
    const double *sine_rows = d->waves + (size_t)cy * (size_t)mx;
    multiply(CblasTrans, CblasNoTrans, hy, mx, cy, d->y.cosine, hy, d->waves, mx, d->half_way, mx);
    multiply(CblasTrans, CblasNoTrans, hy, mx, cy, d->y.sine, hy, sine_rows, mx, odd_rows, mx);
    multiply(CblasNoTrans, CblasNoTrans, cy, hx, cx, d->half_way, mx, d->x.cosine, hx, d->folded,
             cx);
    multiply(CblasNoTrans, CblasNoTrans, cy, hx, cx, d->half_way + cx, mx, d->x.sine, hx,
             d->folded + hx, cx);
}

/* The four kinds of waves share one spectrum: sines stand one wave number further on. */
static void multiply_by_spectrum(dft *d) {
    size_t cx = (size_t)d->x.c, cy = (size_t)d->y.c;
    for (size_t row = 0; row < 2 * cy; row++) {
        const double *factor = d->spectrum + (row < cy ? row : row - cy + 1) * (cx + 1);
        double *cosine = d->waves + row * 2 * cx, *sine = cosine + cx;
        for (size_t k = 0; k < cx; k++) {
            cosine[k] *= factor[k];
            sine[k] *= factor[k + 1];
        }
    }
}

void ilsai_dft_convolve(dft *d, int bx, int by, const double *w, double *p, size_t stride) {
    size_t cx = (size_t)d->x.c, cy = (size_t)d->y.c, rows = (size_t)by, columns = (size_t)bx;
    double *row = d->half_way; /* free before the transforms and after them */
    for (size_t j = 0; j < rows; j++)
        fold_row(w + j * stride, columns, cx, row + j * cx);
    memset(row + rows * cx, 0, (cy - rows) * cx * sizeof *row);
    fold_rows(row, cy, cx, d->folded);
    to_waves(d);
    multiply_by_spectrum(d);
    from_waves(d);
    unfold_rows(d->folded, cy, cx, row);
    for (size_t j = 0; j < rows; j++)
        unfold_row(row + j * cx, columns, cx, p + j * stride);
}
