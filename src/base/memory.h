/*
 * Memory: the one place where the library asks the system for it, and arrays that grow.
 *
 * Every allocation of the library goes through these functions, so that a host's own allocator can
 * be put behind them in one place. What FFTW and OpenBLAS allocate for themselves does not.
 */
#ifndef ILSAI_MEMORY_H
#define ILSAI_MEMORY_H

#include <ilsa/status.h>
#include <stddef.h>

/*
 * Room for count elements of size bytes, zeroed by the second. NULL where there is none or the
 * product overflows. Room for nothing is a pointer that can be released like any other.
 */
void *ilsai_allocate(size_t count, size_t size);
void *ilsai_allocate_zeroed(size_t count, size_t size);

/* Releases what one of the above, or ilsai_grow, has given. NULL is allowed. */
void ilsai_release(void *memory);

/* One of the arrays that grow together. */
typedef struct grown_array {
    void *pointer; /* address of the pointer to the first element, which may hold NULL */
    size_t size;   /* of an element */
} grown_array;

/* The array that a pointer variable or member stands for. */
#define ILSAI_GROWN(pointer)                                                                       \
    { &(pointer), sizeof *(pointer) }

/*
 * Makes room for count elements in each of the arrays, which share *capacity. What they hold stays;
 * room beyond the old capacity is not initialised. The new capacity is half as large again as what
 * is asked for, so that arrays that grow by steps are moved seldom. ILSA_ERR_MEMORY: arrays may
 * have been moved, *capacity and what they hold are as before.
 */
ilsa_status ilsai_grow(size_t count, size_t *capacity, const grown_array *arrays, size_t number);

#endif
