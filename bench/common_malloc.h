/*
 * Allocations counted, for the one program that includes this: everybody's on the heap, shared
 * libraries' too. Only where the C library offers its own entries beside malloc, and not under
 * AddressSanitizer; elsewhere the counts stay 0.
 */
#ifndef BENCH_COMMON_MALLOC_H
#define BENCH_COMMON_MALLOC_H

#include <ilsa/export.h>
#include <stddef.h>
#include <stdlib.h>

/* Since the program began. */
typedef struct heap_counts {
    long calls;   /* that gave memory */
    size_t bytes; /* asked for */
    size_t live;  /* in use now */
} heap_counts;
static heap_counts heap;

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(SANITIZED)
#define COUNTS_HEAP 1
#include <errno.h>
#include <malloc.h>

/* NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): the library's names. */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *old, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);
extern void __libc_free(void *old);
/* NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */

static void *counted(void *got, size_t size) {
    heap.calls += got != NULL;
    heap.bytes += got ? size : 0;
    heap.live += malloc_usable_size(got);
    return got;
}

ILSA_API void *malloc(size_t size) {
    return counted(__libc_malloc(size), size);
}

ILSA_API void *calloc(size_t count, size_t size) {
    return counted(__libc_calloc(count, size), count * size);
}

ILSA_API void *realloc(void *old, size_t size) {
    const size_t before = malloc_usable_size(old);
    void *got = __libc_realloc(old, size);
    heap.live -= got ? before : 0;
    return counted(got, size);
}

ILSA_API void *memalign(size_t alignment, size_t size) {
    return counted(__libc_memalign(alignment, size), size);
}

ILSA_API int posix_memalign(void **got, size_t alignment, size_t size) {
    *got = memalign(alignment, size);
    return *got ? 0 : ENOMEM;
}

ILSA_API void *aligned_alloc(size_t alignment, size_t size) {
    return memalign(alignment, size);
}

ILSA_API void free(void *old) {
    heap.live -= malloc_usable_size(old);
    __libc_free(old);
}
#endif

#endif
