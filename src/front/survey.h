/*
 * The survey cells: where their widths want the front (4.9).
 *
 * Behind a front the width is w_a(s) (1 + b s + ...): w_a is the semi-infinite solution, b comes
 * from the size and shape of the fracture (-1 / (4 R) for a penny under uniform pressure). The
 * ratio of the widths of the survey cell and of the one behind it gives b.
 */
#ifndef ILSAI_SURVEY_H
#define ILSAI_SURVEY_H

#include "elastic/self_term.h"
#include "front/survey_cell.h"
#include <ilsa/material.h>

/* What the distances of survey cells are found from. */
typedef struct survey_widths {
    const ilsa_material_def *tip_material; /* of the asymptote */
    double dx, dy;
    const double *width; /* over the mesh: of the trial */
    double tolerance;    /* of the front, in cells */
} survey_widths;

/* Sets what the asymptote is at a survey cell's distance and V: before any of the functions below.
 */
void ilsai_survey_settle(const survey_widths *widths, survey_cell *survey);

/*
 * How far the survey cell's front is beyond stress step k; 0 before it. Softened: the width of a
 * step begins with the root of its depth, and an iteration on the front would not find its way past
 * it. by_s is its derivative by the survey cell's distance.
 */
typedef struct step_depth {
    double value, by_s;
} step_depth;
step_depth ilsai_survey_step_depth(const survey_cell *survey, int k);

/* Width that the steps of the stress add at a distance s from the survey cell's front. */
double ilsai_survey_step_width(const survey_cell *survey, double s);

/* What of a change of a survey cell's width is not that of its stress steps: 1, but for the least
 * part. */
double ilsai_survey_smooth_slope(const survey_widths *widths, const survey_cell *survey);

/* The front as the survey cell sees it, at the survey cell's distance and V. */
self_term_front ilsai_survey_front(const survey_cell *survey);

/*
 * The width that the asymptote alone would have at the centre of a survey cell, at the survey
 * cell's distance and V.
 */
double ilsai_survey_width(const survey_widths *widths, const survey_cell *survey);

/*
 * The distance at which (4.9) and the term after the asymptote agree for the trial widths; sets the
 * survey's derivatives of that distance by the widths of its cell and of the inner one.
 */
double ilsai_survey_distance(const survey_widths *widths, survey_cell *survey, double dt);

#endif
