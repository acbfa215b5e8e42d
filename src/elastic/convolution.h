/*
 * Convolution of a box of cells, and of its images where it is mirrored, with a kernel that is even
 * in x and in y, by real 2-D transforms of the box.
 * The library is compiled with one of convolution_fftw.c (FFTW, or MKL behind the same calls) and
 * convolution_none.c (none of these may then be called but ilsai_fft_available).
 */
#ifndef ILSAI_CONVOLUTION_H
#define ILSAI_CONVOLUTION_H

#include "base/mirror.h"
#include "base/thread_pool.h"
#include <stddef.h>

typedef struct fft fft;

/* Nonzero if there is a transform. */
int ilsai_fft_available(void);

/*
 * For boxes of up to cx by cy cells, padded to 2 cx by 2 cy, which should have small prime
 * factors. The kernel is given row by row for all offsets that there are, see mirror.h. NULL when
 * memory does not suffice.
 */
fft *ilsai_fft_create(int cx, int cy, mirror_axis about_x, mirror_axis about_y,
                      const double *kernel);
void ilsai_fft_destroy(fft **f);

/*
 * p = kernel * (w and its images) on a box of bx <= cx by by <= cy cells, rows of both arrays
 * stride apart; every bit of p is a function of cx, cy and w. The team shares the work. Allocates
 * nothing.
 */
void ilsai_fft_convolve(fft *f, thread_pool *threads, int bx, int by, const double *w, double *p,
                        size_t stride);

#endif
