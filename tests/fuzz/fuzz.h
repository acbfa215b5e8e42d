/*
 * What the fuzzers share. Each is a file with one LLVMFuzzerTestOneInput: `make fuzz` links it with
 * libFuzzer, `make check` with replay.c, which feeds it the files of its corpus.
 */
#ifndef TESTS_FUZZ_H
#define TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* The fuzzer itself: 0, or it does not return. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Ends the program with a message where a promise of the code under test is not kept. */
#define FUZZ_EXPECT(promise) ((promise) ? (void)0 : fuzz_broken(__FILE__, __LINE__, #promise, NULL))
void fuzz_broken(const char *file, int line, const char *promise, const char *note)
    __attribute__((noreturn));

/* An input that is read as a row of choices; 0 when it is used up. */
typedef struct fuzz_input {
    const uint8_t *data;
    size_t size;
} fuzz_input;

unsigned fuzz_byte(fuzz_input *in);

/* 0 .. count - 1 */
int fuzz_choice(fuzz_input *in, int count);

/* One of the values at which things break: NaN, infinities, zeros, subnormals, 1e+-300, ... */
double fuzz_odd(fuzz_input *in);

/* low .. high, evenly in its logarithm; both > 0 */
double fuzz_between(fuzz_input *in, double low, double high);

#endif
