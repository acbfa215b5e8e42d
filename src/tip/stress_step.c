#include "tip/stress_step.h"

#include <math.h>

static const double four_over_pi = 1.2732395447351628;

/* ln |(1 + u) / (1 - u)| times (1 - u^2), which is 0 at u = 1. */
static double damped_logarithm(double u) {
    double gap = fabs(1 - u);
    return gap > 0 ? (1 - u) * (1 + u) * log((1 + u) / gap) : 0;
}

/* In u = (s / d)^(1/2); the bracket and the integral's lose digits below this and are u^3, u^5. */
#define STRESS_STEP_CLOSE 1e-3

static double width_bracket(double u, double damped) {
    return u < STRESS_STEP_CLOSE ? 4.0 / 3 * u * u * u : 2 * u - damped;
}

static double moment_bracket(double u, double damped) {
    double u3 = u * u * u;
    return u < STRESS_STEP_CLOSE ? 4.0 / 15 * u3 * u * u
                                 : 0.25 * (1 - u) * (1 + u) * damped - 0.5 * u + 5.0 / 6 * u3;
}

double ilsai_stress_step_width(double s, double d) {
    if (!(s > 0 && d > 0)) {
        return 0;
    }
    double u = sqrt(s / d);
    return four_over_pi * d * width_bracket(u, damped_logarithm(u));
}

stress_step_point ilsai_stress_step_at(double s, double d) {
    if (!(s > 0 && d > 0)) {
        return (stress_step_point){0};
    }
    double u = sqrt(s / d), damped = damped_logarithm(u);
    double width = four_over_pi * d * width_bracket(u, damped);
    double moment = 2 * four_over_pi * d * d * moment_bracket(u, damped);
    return (stress_step_point){width, moment, (2 * moment - s * width) / d};
}
