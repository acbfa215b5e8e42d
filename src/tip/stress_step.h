/*
 * Stress steps: the width that a step of the far-field stress close behind the front adds to the
 * asymptote. The asymptote knows one stress. A front that has just entered a barrier has a higher
 * stress within a distance d behind it than further back.
 *
 * For a half-plane whose stress is higher by h between the front and d, the part of the width that
 * has no stress intensity is
 *
 *     w = 4 h / (pi E') [(s - d) ln |(s^(1/2) + d^(1/2)) / (s^(1/2) - d^(1/2))| + 2 (s d)^(1/2)].
 *
 * Close to the front it is 4 h / (pi E') times (4/3) s^(3/2) / d^(1/2). That is small against the
 * asymptote, which rules there alone.
 */
#ifndef ILSAI_STRESS_STEP_H
#define ILSAI_STRESS_STEP_H

/* A stress step on the normal through a survey cell. */
typedef struct stress_step {
    double depth;  /* distance from the front less that of the cell's centre */
    double height; /* stress in front of the step less that behind it, over E' */
} stress_step;

/*
 * The width w above at distance s for h / E' = 1, its integral over 0 .. s, and the derivative of
 * that by d. All are 0 where s <= 0 or d <= 0. The integral is d^2 times a function of s / d, so
 * that d times its derivative by d is twice the integral less s w.
 */
typedef struct stress_step_point {
    double width, moment, moment_by_d;
} stress_step_point;
stress_step_point ilsai_stress_step_at(double s, double d);

/* The width alone. */
double ilsai_stress_step_width(double s, double d);

#endif
