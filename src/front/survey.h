/*
 * The inversion of the survey cells: the distance of the front from their widths, Dontsov and
 * Peirce 2017, (4.9).
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

/* Sets width and exponent of the asymptote, and what the stress steps add, for the distance and
 * velocity that the survey cell has. The functions below need them. */
void ilsai_survey_settle(const survey_widths *widths, survey_cell *survey);

/*
 * How far the front of a survey cell is beyond stress step k; 0 before it. The depth is softened:
 * the width of a step begins with the root of its depth, and an iteration on the front would not
 * find its way past the step. by_s is the derivative by the distance of the front.
 */
typedef struct step_depth {
    double value, by_s;
} step_depth;
step_depth ilsai_survey_step_depth(const survey_cell *survey, int k);

/* Width that the stress steps add at a distance s behind the front of a survey cell. */
double ilsai_survey_step_width(const survey_cell *survey, double s);

/*
 * Derivative of the width that the stress steps leave to the asymptote by the width of the survey
 * cell: 1, or less where the steps take all but the least part.
 */
double ilsai_survey_smooth_slope(const survey_widths *widths, const survey_cell *survey);

/* The front as a straight line, as the self term of a survey cell sees it. */
self_term_front ilsai_survey_front(const survey_cell *survey);

/* Width that the asymptote alone would have at the centre of a survey cell. */
double ilsai_survey_width(const survey_widths *widths, const survey_cell *survey);

/*
 * Distance at which (4.9) and the term after the asymptote agree for the widths of the trial. Sets
 * the derivatives of that distance by the widths of the survey cell and of its inner cell.
 */
double ilsai_survey_distance(const survey_widths *widths, survey_cell *survey, double dt);

#endif
