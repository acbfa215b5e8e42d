/*
 * Allocations that fail on demand, for one test program: its own and those of the library that is
 * linked into it, not those inside shared libraries (some kernels of OpenBLAS do not check theirs).
 * Only where the C library offers its own entries beside malloc, and not under AddressSanitizer
 * or ThreadSanitizer, which have a malloc of their own: there CAN_FAIL is not defined.
 */
#ifndef TESTS_FAILING_MALLOC_H
#define TESTS_FAILING_MALLOC_H

#include <ilsa/export.h>
#include <stdlib.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SANITIZED 1
#endif
#endif

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) &&       \
    !defined(SANITIZED)
#define CAN_FAIL 1

static int allocations_left = -1; /* how many succeed from now on; negative: all */

extern char __executable_start, etext;

static int is_ours(const void *caller) {
    return (const char *)caller >= &__executable_start && (const char *)caller < &etext;
}

static int may_allocate(const void *caller) {
    if (!is_ours(caller)) {
        return 1;
    }
    if (allocations_left > 0) {
        allocations_left--;
        return 1;
    }
    return allocations_left < 0;
}

/* NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): the library's names. */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
/* NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */

ILSA_API void *malloc(size_t size) {
    return may_allocate(__builtin_return_address(0)) ? __libc_malloc(size) : NULL;
}

ILSA_API void *calloc(size_t count, size_t size) {
    return may_allocate(__builtin_return_address(0)) ? __libc_calloc(count, size) : NULL;
}
#endif

/* A request beyond the address space is then refused by AddressSanitizer as it is by malloc. */
/* NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */
ILSA_API const char *__asan_default_options(void);
ILSA_API const char *__asan_default_options(void) {
    return "allocator_may_return_null=1";
}
/* NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */

#endif
