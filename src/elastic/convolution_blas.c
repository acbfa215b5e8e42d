#include "elastic/convolution.h"

#include "base/memory.h"
#include <cblas.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

/*
 * The convolution on BLAS alone: the transforms are products with dense matrices of cosines and
 * sines. The work is of order cells^1.5 where that of an FFT is of order cells log(cells), but runs
 * at the speed of dgemm: one to three times the time of the FFT up to 100 by 100 cells, some ten
 * times at 250 by 250. Memory is cx^2 + cy^2 + 8 cx cy numbers; with mirrors the squares are twice
 * as large and the last term is up to 11 cx cy.
 *
 * One direction of c cells, padded to a period. Without an axis the period is 2 c, and around the
 * origin, s = i - (c - 1) / 2, the functions cos(pi k s / c), k = 0 .. c - 1, and sin(pi k s / c),
 * k = 1 .. c, are all there are; an even kernel multiplies each by a number: its spectrum at k.
 * Cosines see only the even part of the widths and sines the odd part, so that either matrix is c
 * by c / 2. With an axis there are cosines only, 2 c by c, of the distance s to it: their period is
 * what the cells and their images fill, twice.
 */
typedef struct basis {
    int c, half_period;
    mirror_axis about;
    int blocks;       /* of waves: cosines, then sines if there are any */
    int waves, parts; /* of a block */
    double *matrix;   /* block by block, row by wave, column by part */
} basis;

/*
 * Widths go through four arrays. Rows and columns of `folded` are parts, those of `waves` waves,
 * both block by block; `half_way` has rows of parts and columns of waves.
 */
typedef struct dft {
    basis x, y;
    double *spectrum; /* by wave numbers 0 .. half_period, with the factors of the transform back */
    double *folded;   /* cy by cx */
    double *half_way; /* cy by 2 cx */
    double *waves;    /* 2 cy by 2 cx */
} dft;

static double *alloc_doubles(size_t rows, size_t columns) {
    return ilsai_allocate(rows * columns, sizeof(double));
}

/* pi n / (2 c), less whole turns. */
static double angle(long n, int c) {
    return 3.14159265358979323846 * (double)(n % (4L * c)) / (2 * c);
}

/* Twice the coordinate of cell i. */
static long place(const basis *b, int i) {
    return b->about == MIRROR_NONE ? 2L * i - b->c + 1 : 2L * i + (b->about == MIRROR_EDGE);
}

/* Where block n begins: its waves, its parts, its matrix. */
static size_t first_wave(const basis *b, int n) {
    return (size_t)n * (size_t)b->waves;
}

static size_t first_part(const basis *b, int n) {
    return (size_t)n * (size_t)b->parts;
}

static double *block(const basis *b, int n) {
    return b->matrix + first_wave(b, n) * (size_t)b->parts;
}

static bool basis_create(basis *b, int c, mirror_axis about) {
    b->c = c;
    b->about = about;
    b->half_period = about == MIRROR_NONE ? c : 2 * c - (about == MIRROR_CENTRE);
    b->blocks = about == MIRROR_NONE ? 2 : 1;
    b->waves = 2 * c / b->blocks;
    b->parts = c / b->blocks;
    b->matrix = alloc_doubles(2 * (size_t)c, (size_t)b->parts);
    if (!b->matrix) {
        return false;
    }
    double *value = b->matrix;
    for (int n = 0; n < b->blocks; n++) {
        for (int k = n; k < b->waves + n; k++) {
            for (int i = 0; i < b->parts; i++) {
                double turn = angle(k * place(b, i), b->half_period);
                *value++ = n == 0 ? cos(turn) : sin(turn);
            }
        }
    }
    return true;
}

/* Row k = 0 .. c: what gives the spectrum of an even function from its values at 0 .. c - 1. */
static double *even_transform(int c) {
    double *a = alloc_doubles((size_t)c + 1, (size_t)c);
    if (!a) {
        return NULL;
    }
    for (int k = 0; k <= c; k++) {
        for (int i = 0; i < c; i++) {
            a[(size_t)k * (size_t)c + (size_t)i] = (i ? 2 : 1) * cos(angle(2L * k * i, c));
        }
    }
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

static bool make_spectrum(dft *d, const double *kernel) {
    int cx = d->x.half_period, cy = d->y.half_period;
    int row = ilsai_mirror_offsets(d->x.about, d->x.c);
    double *ax = even_transform(cx), *ay = even_transform(cy);
    double *half = alloc_doubles((size_t)cy, (size_t)cx + 1);
    bool good = ax && ay && half;
    if (good) {
        multiply(CblasNoTrans, CblasTrans, cy, cx + 1, cx, kernel, row, ax, cx, half, cx + 1);
        multiply(CblasNoTrans, CblasNoTrans, cy + 1, cx + 1, cy, ay, cy, half, cx + 1, d->spectrum,
                 cx + 1);
        double *value = d->spectrum;
        for (int l = 0; l <= cy; l++) {
            for (int k = 0; k <= cx; k++) {
                *value++ *= wave_weight(k, cx) * wave_weight(l, cy);
            }
        }
    }
    ilsai_release(ax);
    ilsai_release(ay);
    ilsai_release(half);
    return good;
}

static bool allocate(dft *d) {
    size_t x = (size_t)d->x.c, y = (size_t)d->y.c;
    d->spectrum = alloc_doubles((size_t)d->y.half_period + 1, (size_t)d->x.half_period + 1);
    d->folded = alloc_doubles(y, x);
    d->half_way = alloc_doubles(y, 2 * x);
    d->waves = alloc_doubles(2 * y, 2 * x);
    return d->spectrum && d->folded && d->half_way && d->waves;
}

static void destroy(void *made) {
    dft *d = made;
    ilsai_release(d->x.matrix);
    ilsai_release(d->y.matrix);
    ilsai_release(d->spectrum);
    ilsai_release(d->folded);
    ilsai_release(d->half_way);
    ilsai_release(d->waves);
    ilsai_release(d);
}

static void *create(int cx, int cy, mirror_axis about_x, mirror_axis about_y,
                    const double *kernel) {
    dft *d = ilsai_allocate_zeroed(1, sizeof *d);
    if (!d) {
        return NULL;
    }
    if (!basis_create(&d->x, cx, about_x) || !basis_create(&d->y, cy, about_y) || !allocate(d) ||
        !make_spectrum(d, kernel)) {
        destroy(d);
        return NULL;
    }
    return d;
}

/*
 * `count` <= c widths, zeros behind them: their even and odd part; with an axis, with their images.
 */
static void fold_row(const basis *b, const double *w, size_t count, double *part) {
    size_t c = (size_t)b->c;
    if (b->about != MIRROR_NONE) {
        for (size_t i = 0; i < c; i++) {
            part[i] = i < count ? ilsai_mirror_count(b->about, (int)i) * w[i] : 0;
        }
        return;
    }
    for (size_t i = 0; i < c / 2; i++) {
        double low = i < count ? w[i] : 0, high = c - 1 - i < count ? w[c - 1 - i] : 0;
        part[i] = low + high;
        part[c / 2 + i] = low - high;
    }
}

static void unfold_row(const basis *b, const double *part, size_t count, double *p) {
    size_t c = (size_t)b->c;
    if (b->about != MIRROR_NONE) {
        memcpy(p, part, count * sizeof *p);
        return;
    }
    for (size_t i = 0; i < c / 2; i++) {
        if (i < count) {
            p[i] = part[i] + part[c / 2 + i];
        }
        if (c - 1 - i < count) {
            p[c - 1 - i] = part[i] - part[c / 2 + i];
        }
    }
}

/*
 * Rows j and c - 1 - j of one array: their sum and difference, rows j and c / 2 + j of another.
 * With an axis: row j with its image.
 */
static void fold_rows(const basis *b, const double *row, size_t length, double *part) {
    size_t c = (size_t)b->c;
    for (size_t j = 0; b->about != MIRROR_NONE && j < c; j++) {
        for (size_t i = 0; i < length; i++) {
            part[j * length + i] = ilsai_mirror_count(b->about, (int)j) * row[j * length + i];
        }
    }
    for (size_t j = 0; b->about == MIRROR_NONE && j < c / 2; j++) {
        for (size_t i = 0; i < length; i++) {
            double low = row[j * length + i], high = row[(c - 1 - j) * length + i];
            part[j * length + i] = low + high;
            part[(c / 2 + j) * length + i] = low - high;
        }
    }
}

static void unfold_rows(const basis *b, const double *part, size_t length, double *row) {
    size_t c = (size_t)b->c;
    if (b->about != MIRROR_NONE) {
        memcpy(row, part, c * length * sizeof *row);
        return;
    }
    for (size_t j = 0; j < c / 2; j++) {
        for (size_t i = 0; i < length; i++) {
            double even = part[j * length + i], odd = part[(c / 2 + j) * length + i];
            row[j * length + i] = even + odd;
            row[(c - 1 - j) * length + i] = even - odd;
        }
    }
}

static void to_waves(dft *d) {
    const basis *x = &d->x, *y = &d->y;
    int step = 2 * x->c;
    for (int n = 0; n < x->blocks; n++) {
        multiply(CblasNoTrans, CblasTrans, y->c, x->waves, x->parts, d->folded + first_part(x, n),
                 x->c, block(x, n), x->parts, d->half_way + first_wave(x, n), step);
    }
    for (int n = 0; n < y->blocks; n++) {
        multiply(CblasNoTrans, CblasNoTrans, y->waves, step, y->parts, block(y, n), y->parts,
                 d->half_way + first_part(y, n) * (size_t)step, step,
                 d->waves + first_wave(y, n) * (size_t)step, step);
    }
}

static void from_waves(dft *d) {
    const basis *x = &d->x, *y = &d->y;
    int step = 2 * x->c;
    for (int n = 0; n < y->blocks; n++) {
        multiply(CblasTrans, CblasNoTrans, y->parts, step, y->waves, block(y, n), y->parts,
                 d->waves + first_wave(y, n) * (size_t)step, step,
                 d->half_way + first_part(y, n) * (size_t)step, step);
    }
    for (int n = 0; n < x->blocks; n++) {
        multiply(CblasNoTrans, CblasNoTrans, y->c, x->parts, x->waves,
                 d->half_way + first_wave(x, n), step, block(x, n), x->parts,
                 d->folded + first_part(x, n), x->c);
    }
}

/* All kinds of waves share one spectrum: sines stand one wave number further on. */
static void multiply_by_spectrum(dft *d) {
    const basis *x = &d->x, *y = &d->y;
    double *value = d->waves;
    for (int row = 0; row < 2 * y->c; row++) {
        int l = row < y->waves ? row : row - y->waves + 1;
        const double *factor = d->spectrum + (size_t)l * ((size_t)x->half_period + 1);
        for (int n = 0; n < x->blocks; n++) {
            for (int k = 0; k < x->waves; k++) {
                *value++ *= factor[k + n];
            }
        }
    }
}

/* One thread does all of it. */
static void apply(void *made, thread_pool *threads, int bx, int by, const double *w, double *p,
                  size_t stride) {
    dft *d = made;
    (void)threads;
    size_t cx = (size_t)d->x.c, cy = (size_t)d->y.c, rows = (size_t)by, columns = (size_t)bx;
    double *row = d->half_way; /* free before the transforms and after them */
    for (size_t j = 0; j < rows; j++) {
        fold_row(&d->x, w + j * stride, columns, row + j * cx);
    }
    memset(row + rows * cx, 0, (cy - rows) * cx * sizeof *row);
    fold_rows(&d->y, row, cx, d->folded);
    to_waves(d);
    multiply_by_spectrum(d);
    from_waves(d);
    unfold_rows(&d->y, d->folded, cx, row);
    for (size_t j = 0; j < rows; j++) {
        unfold_row(&d->x, row + j * cx, columns, p + j * stride);
    }
}

static const convolution_method method = {"blas", create, apply, destroy};
const convolution_method *const ilsai_convolution_blas = &method;
