/*
 * Steps of the far-field stress close behind the front, as where it has just entered a barrier. The
 * asymptote knows one stress; a step of it a distance d behind the front adds a width of its own.
 *
 * For a half-plane whose stress is higher by h between the front and d than further behind, that
 * part of the solution which has no stress intensity is
 *
 *     w = 4 h / (pi E') [(s - d) ln |(s^(1/2) + d^(1/2)) / (s^(1/2) - d^(1/2))| + 2 (s d)^(1/2)],
 *
 * (4/3) s^(3/2) / d^(1/2) of 4 h / (pi E') close to the front: the asymptote rules there alone.
 */
#ifndef ILSAI_STRESS_STEP_H
#define ILSAI_STRESS_STEP_H

/* A step of the stress on the normal through a survey cell. */
typedef struct stress_step {
    double depth;  /* how much further from the front than the cell's centre; negative: nearer */
    double height; /* stress in front of it less that behind, over E' */
} stress_step;

/* The width above and its integral over 0 .. s, for height 1; 0 where s <= 0 or d <= 0. */
double ilsai_stress_step_width(double s, double d);
double ilsai_stress_step_moment(double s, double d);

#endif
