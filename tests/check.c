#include "check.h"

double worst_of(double worst, double error) {
    return larger_of(worst, error > NOTHING_YET ? error : NAN);
}

double relative(double value, double reference) {
    return reference != 0 ? fabs(value / reference - 1) : fabs(value);
}

void check_below(double value, double bound, const char *what, const char *file, int line) {
    if (!(isfinite(value) && isfinite(bound) && value <= bound)) {
        print_error("%s is %.17g and not at most %.17g\n", what, value, bound);
        _fail(file, line);
    }
}

void check_above(double value, double bound, const char *what, const char *file, int line) {
    if (!(isfinite(value) && isfinite(bound) && value >= bound)) {
        print_error("%s is %.17g and not at least %.17g\n", what, value, bound);
        _fail(file, line);
    }
}

void check_near(double value, double expected, double error, const char *what, const char *file,
                int line) {
    if (!(isfinite(error) && error >= 0 &&
          (value == expected || fabs(value - expected) <= error))) {
        print_error("%s is %.17g and not %.17g to %.2g\n", what, value, expected, error);
        _fail(file, line);
    }
}

double next_random(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) * 0x1p-52 - 1;
}

double uniform(void) {
    static uint64_t seed = 17;
    return 0.5 * (next_random(&seed) + 1);
}
