#include "failing.h"

#include <errno.h>
#include <pthread.h>
#include <stdlib.h>

_Thread_local int allocations_left = -1;
_Thread_local int one_allocation_fails = 0;
_Thread_local int allocations_failed = 0;

static int may_allocate(void) {
    int may = allocations_left != 0;
    allocations_left -= allocations_left > 0;
    allocations_failed += !may;
    allocations_left = !may && one_allocation_fails ? -1 : allocations_left;
    return may;
}

/* NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): the linker's names. */
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*start)(void *), void *argument);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*start)(void *), void *argument);

void *__wrap_malloc(size_t size) {
    return may_allocate() ? __real_malloc(size) : NULL;
}

void *__wrap_calloc(size_t count, size_t size) {
    return may_allocate() ? __real_calloc(count, size) : NULL;
}

void *__wrap_realloc(void *old, size_t size) {
    return may_allocate() ? __real_realloc(old, size) : NULL;
}

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*start)(void *), void *argument) {
    return may_allocate() ? __real_pthread_create(thread, attributes, start, argument) : EAGAIN;
}

/* A request beyond the address space is then refused by AddressSanitizer as it is by malloc. */
__attribute__((visibility("default"))) const char *__asan_default_options(void);
const char *__asan_default_options(void) {
    return "allocator_may_return_null=1";
}

/* Weak: a library that was built without an FFT is not linked with FFTW. */
#if __has_include(<fftw3.h>)
#include <fftw3.h>

#define WEAK __attribute__((weak))
WEAK double *__real_fftw_alloc_real(size_t count);
WEAK fftw_complex *__real_fftw_alloc_complex(size_t count);
WEAK fftw_plan __real_fftw_plan_many_dft(int rank, const int *n, int count, fftw_complex *in,
                                         const int *in_box, int in_stride, int in_next,
                                         fftw_complex *out, const int *out_box, int out_stride,
                                         int out_next, int sign, unsigned flags);
WEAK fftw_plan __real_fftw_plan_many_dft_r2c(int rank, const int *n, int count, double *in,
                                             const int *in_box, int in_stride, int in_next,
                                             fftw_complex *out, const int *out_box, int out_stride,
                                             int out_next, unsigned flags);
WEAK fftw_plan __real_fftw_plan_many_dft_c2r(int rank, const int *n, int count, fftw_complex *in,
                                             const int *in_box, int in_stride, int in_next,
                                             double *out, const int *out_box, int out_stride,
                                             int out_next, unsigned flags);
double *__wrap_fftw_alloc_real(size_t count);
fftw_complex *__wrap_fftw_alloc_complex(size_t count);
fftw_plan __wrap_fftw_plan_many_dft(int rank, const int *n, int count, fftw_complex *in,
                                    const int *in_box, int in_stride, int in_next,
                                    fftw_complex *out, const int *out_box, int out_stride,
                                    int out_next, int sign, unsigned flags);
fftw_plan __wrap_fftw_plan_many_dft_r2c(int rank, const int *n, int count, double *in,
                                        const int *in_box, int in_stride, int in_next,
                                        fftw_complex *out, const int *out_box, int out_stride,
                                        int out_next, unsigned flags);
fftw_plan __wrap_fftw_plan_many_dft_c2r(int rank, const int *n, int count, fftw_complex *in,
                                        const int *in_box, int in_stride, int in_next, double *out,
                                        const int *out_box, int out_stride, int out_next,
                                        unsigned flags);

double *__wrap_fftw_alloc_real(size_t count) {
    return may_allocate() ? __real_fftw_alloc_real(count) : NULL;
}

fftw_complex *__wrap_fftw_alloc_complex(size_t count) {
    return may_allocate() ? __real_fftw_alloc_complex(count) : NULL;
}

fftw_plan __wrap_fftw_plan_many_dft(int rank, const int *n, int count, fftw_complex *in,
                                    const int *in_box, int in_stride, int in_next,
                                    fftw_complex *out, const int *out_box, int out_stride,
                                    int out_next, int sign, unsigned flags) {
    return may_allocate()
               ? __real_fftw_plan_many_dft(rank, n, count, in, in_box, in_stride, in_next, out,
                                           out_box, out_stride, out_next, sign, flags)
               : NULL;
}

fftw_plan __wrap_fftw_plan_many_dft_r2c(int rank, const int *n, int count, double *in,
                                        const int *in_box, int in_stride, int in_next,
                                        fftw_complex *out, const int *out_box, int out_stride,
                                        int out_next, unsigned flags) {
    return may_allocate()
               ? __real_fftw_plan_many_dft_r2c(rank, n, count, in, in_box, in_stride, in_next, out,
                                               out_box, out_stride, out_next, flags)
               : NULL;
}

fftw_plan __wrap_fftw_plan_many_dft_c2r(int rank, const int *n, int count, fftw_complex *in,
                                        const int *in_box, int in_stride, int in_next, double *out,
                                        const int *out_box, int out_stride, int out_next,
                                        unsigned flags) {
    return may_allocate()
               ? __real_fftw_plan_many_dft_c2r(rank, n, count, in, in_box, in_stride, in_next, out,
                                               out_box, out_stride, out_next, flags)
               : NULL;
}
#endif
/* NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */
