#include "elastic/convolution.h"

int ilsai_fft_available(void) {
    return 0;
}

fft *ilsai_fft_create(int cx, int cy, mirror_axis about_x, mirror_axis about_y,
                      const double *kernel) {
    (void)cx;
    (void)cy;
    (void)about_x;
    (void)about_y;
    (void)kernel;
    return NULL;
}

void ilsai_fft_destroy(fft **f) {
    *f = NULL;
}

void ilsai_fft_convolve(fft *f, thread_pool *threads, int bx, int by, const double *w, double *p,
                        size_t stride) {
    (void)f;
    (void)threads;
    (void)bx;
    (void)by;
    (void)w;
    (void)p;
    (void)stride;
}
