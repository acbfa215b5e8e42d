/*
 * The convolution of fft.h on BLAS alone: the transforms are products with dense matrices of
 * cosines and sines. Of order cells^1.5 instead of cells log(cells), at the speed of dgemm: one to
 * three times the time of the FFT up to 100 by 100 cells, some ten times at 250 by 250.
 */
#ifndef ILSAI_CONVOLUTION_BLAS_H
#define ILSAI_CONVOLUTION_BLAS_H

#include "base/mirror.h"
#include <stddef.h>

typedef struct dft dft;

/*
 * For boxes of up to cx by cy cells, both even. The kernel is given row by row for all offsets that
 * there are, see mirror.h. NULL when memory does not suffice (cx^2 + cy^2 + 8 cx cy numbers,
 * mirrored twice the squares and up to 11 cx cy).
 */
dft *ilsai_dft_create(int cx, int cy, mirror_axis about_x, mirror_axis about_y,
                      const double *kernel);
void ilsai_dft_destroy(dft **d);

/*
 * p = kernel * (w and its images) on a box of bx <= cx by by <= cy cells, rows stride apart.
 * Allocates nothing.
 */
void ilsai_dft_convolve(dft *d, int bx, int by, const double *w, double *p, size_t stride);

#endif
