/*
 * Convolution of a box of cells with a kernel that is even in x and in y, by real 2-D transforms.
 * The library is compiled with one of fft_fftw.c (FFTW, or MKL behind the same calls) and
 * fft_none.c (none of these may then be called but ilsai_fft_available).
 */
#ifndef ILSAI_FFT_H
#define ILSAI_FFT_H

#include "team.h"
#include <stddef.h>

typedef struct fft fft;

/* Nonzero if there is a transform. */
int ilsai_fft_available(void);

/*
 * For boxes of up to cx by cy cells, padded to 2 cx by 2 cy, which should have small prime
 * factors. kernel[j * cx + i] belongs to offsets (+-i, +-j). NULL when memory does not suffice.
 */
fft *ilsai_fft_create(int cx, int cy, const double *kernel);
void ilsai_fft_destroy(fft **f);

/*
 * p = kernel * w on a box of bx <= cx by by <= cy cells, rows of both arrays stride apart; every
 * bit of p is a function of cx, cy and w. The team shares the work. Allocates nothing.
 */
void ilsai_fft_convolve(fft *f, team *threads, int bx, int by, const double *w, double *p,
                        size_t stride);

#endif
