/*
 * The survey cells: where their widths want the front (4.9).
 *
 * Behind a front the width is w_a(s) (1 + b s + ...): w_a is the semi-infinite solution, b comes
 * from the size and shape of the fracture (-1 / (4 R) for a penny under uniform pressure). The
 * ratio of the widths of the survey cell and of the one behind it gives b.
 */
#ifndef ILSAI_SURVEY_H
#define ILSAI_SURVEY_H

#include "step/state.h"

/* Cell size along the normal that survey cell (i, j) sees: of the faces that lead out of the
 * channel. */
double ilsai_survey_size(const ilsa_solver *s, const grid *g, int i, int j);

/* Sets what the asymptote is at a survey's distance and V: before any of the functions below. */
void ilsai_survey_settle(const ilsa_solver *s, survey_cell *survey);

/*
 * How far the survey's front is beyond jump k; 0 before it. Softened: the width of a jump begins
 * with the root of its depth, and an iteration on the front would not find its way past it. by_s is
 * its derivative by the survey's distance.
 */
typedef struct step_depth {
    double value, by_s;
} step_depth;
step_depth ilsai_survey_step_depth(const survey_cell *survey, int k);

/* Width that the jumps of the stress add at a distance s from the survey's front. */
double ilsai_survey_step_width(const survey_cell *survey, double s);

/* What of a change of a survey cell's width is not that of its jumps: 1, but for the least part. */
double ilsai_survey_smooth_slope(const ilsa_solver *s, const survey_cell *survey);

/* The front as the survey cell sees it, at the survey's distance and V. */
self_term_front ilsai_survey_front(const survey_cell *survey);

/*
 * The width that the asymptote alone would have at the centre of a survey cell, at the survey's
 * distance and V.
 */
double ilsai_survey_width(const ilsa_solver *s, const survey_cell *survey);

/*
 * The distance at which (4.9) and the term after the asymptote agree for the trial widths; sets the
 * survey's derivatives of that distance by the widths of its cell and of the inner one.
 */
double ilsai_survey_distance(const ilsa_solver *s, survey_cell *survey, double dt);

#endif
