/* As failing_malloc.h, and realloc fails on demand too. */
#ifndef TESTS_FAILING_REALLOC_H
#define TESTS_FAILING_REALLOC_H

#include "failing_malloc.h"

#ifdef CAN_FAIL
/* NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): the library's names. */
extern void *__libc_realloc(void *old, size_t size);
/* NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */

ILSA_API void *realloc(void *old, size_t size) {
    return may_allocate(__builtin_return_address(0)) ? __libc_realloc(old, size) : NULL;
}
#endif

#endif
