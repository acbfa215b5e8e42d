/*
 * Convolution of a box of cells, and of its images where it is one side of a mirror image, with a
 * kernel that is even in x and in y. The product of a translation-invariant elasticity rests on it.
 *
 * Each way to compute it is a table of functions. There are two: transforms by FFTW, or by MKL
 * behind FFTW's calls (convolution_fftw.c), and matrix products by BLAS (convolution_blas.c). The
 * Makefile compiles convolution_none.c in the place of the first where there is no FFT.
 */
#ifndef ILSAI_CONVOLUTION_H
#define ILSAI_CONVOLUTION_H

#include "base/mirror.h"
#include "base/thread_pool.h"
#include <stddef.h>

typedef struct convolution_method {
    const char *name;

    /*
     * Makes ready for boxes of up to cx by cy cells. Both are even, and an FFT is fast where they
     * have small prime factors. The kernel is given row by row for all offsets that cells of such a
     * box have among each other and to images, see base/mirror.h. NULL when memory does not
     * suffice.
     */
    void *(*create)(int cx, int cy, mirror_axis about_x, mirror_axis about_y, const double *kernel);

    /*
     * Sets p to the convolution of the kernel with w and its images, on a box of bx <= cx by
     * by <= cy cells. Rows of w and of p are stride numbers apart. Every bit of p is a function of
     * cx, cy, the axes, the kernel and w. The threads may share the work. Allocates nothing.
     */
    void (*apply)(void *made, thread_pool *threads, int bx, int by, const double *w, double *p,
                  size_t stride);

    /* Releases what create has made. */
    void (*destroy)(void *made);
} convolution_method;

/* NULL where the library was built without an FFT. */
extern const convolution_method *const ilsai_convolution_fft;

extern const convolution_method *const ilsai_convolution_blas;

#endif
