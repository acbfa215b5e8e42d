#include "fuzz.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void fuzz_broken(const char *file, int line, const char *promise, const char *note) {
    fprintf(stderr, "%s:%d: not kept: %s%s%s\n", file, line, promise, note ? ": " : "",
            note ? note : "");
    abort();
}

unsigned fuzz_byte(fuzz_input *in) {
    if (in->size == 0)
        return 0;
    in->size--;
    return *in->data++;
}

int fuzz_choice(fuzz_input *in, int count) {
    return (int)(fuzz_byte(in) % (unsigned)count);
}

double fuzz_odd(fuzz_input *in) {
    static const double odd[] = {
        0.0,    -0.0,   1.0,     -1.0,    NAN,      INFINITY, -INFINITY,   1e300,
        -1e300, 1e-300, -1e-300, DBL_MAX, -DBL_MAX, DBL_MIN,  5e-324,      -5e-324,
        1e150,  1e-150, 1e100,   1e-100,  1e30,     1e-30,    1e16,        1e-16,
        1e9,    1e-9,   1e3,     1e-3,    0.5,      2.0,      DBL_EPSILON, 1.0 + DBL_EPSILON};
    return odd[fuzz_choice(in, (int)(sizeof odd / sizeof *odd))];
}

double fuzz_between(fuzz_input *in, double low, double high) {
    return low * exp(log(high / low) * (double)fuzz_byte(in) / 255.0);
}
