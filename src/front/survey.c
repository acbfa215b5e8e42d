#include "front/survey.h"

#include "base/tuning.h"
#include "tip/asymptote.h"
#include <math.h>

self_term_front ilsai_survey_front(const survey_cell *survey) {
    return (self_term_front){survey->s, survey->cos_a, survey->sin_a, survey->exponent};
}

step_depth ilsai_survey_step_depth(const survey_cell *survey, int k) {
    double depth = survey->s + survey->step[k].depth, soft = ILSAI_STRESS_STEP_SOFT * survey->h;
    double part = depth > 0 ? depth / (depth + soft) : 0;
    return (step_depth){depth * part, part * (2 - part)};
}

/* The sum of the widths of the stress steps, each on its own. */
static double sum_of_steps(const survey_cell *survey, double s) {
    double sum = 0;
    for (int k = 0; k < survey->step_count; k++) {
        sum += survey->step[k].height *
               ilsai_stress_step_width(s, ilsai_survey_step_depth(survey, k).value);
    }
    return sum;
}

/*
 * The part of the widths of its stress steps that a survey cell is given, for their sum at
 * its distance: 1 where they add width. A lower stress around the front takes width, w < 0, as if
 * the fluid kept up its pressure there through a neck of any width. It cannot: of w_a + w, with the
 * width w_a of the asymptote, w_a / (1 + |w| / w_a) is left, which is positive for any drop.
 */
static double share_of(const survey_cell *survey, double sum) {
    return sum < 0 ? survey->w_tip / (survey->w_tip - sum) : 1;
}

double ilsai_survey_step_width(const survey_cell *survey, double s) {
    double here = sum_of_steps(survey, survey->s);
    double sum = s == survey->s ? here : sum_of_steps(survey, s);
    return sum != 0 ? share_of(survey, here) * sum : 0;
}

/* What of the mean width of a cell no stress step has brought, which add so much there. */
static double smooth_width(double w, double added) {
    return fmax(w - added, ILSAI_STRESS_STEP_LEFT * w);
}

double ilsai_survey_smooth_slope(const survey_widths *widths, const survey_cell *survey) {
    double w = widths->width[survey->cell];
    return smooth_width(w, survey->step_width) > ILSAI_STRESS_STEP_LEFT * w
               ? 1
               : ILSAI_STRESS_STEP_LEFT;
}

/*
 * The first term of the width at the centre of a survey cell, and its derivatives by the widths of
 * two cells, which are means.
 */
typedef struct first_term {
    double width;
    double by_cell, by_inner;
} first_term;

static first_term split_width(const survey_widths *widths, const survey_cell *survey) {
    self_term_front seen = ilsai_survey_front(survey);
    double mean = ilsai_self_term_mean(widths->dx, widths->dy, &seen);
    double w = smooth_width(widths->width[survey->cell], survey->step_width) / mean;
    first_term out = {w, ilsai_survey_smooth_slope(widths, survey) / mean, 0};
    if (survey->inner < 0) {
        return out;
    }
    double deep = survey->s + survey->depth, here = survey->w_asymptote,
           there = survey->w_asymptote_inner;
    seen.s = deep;
    there *= ilsai_self_term_mean(widths->dx, widths->dy, &seen);
    double added = survey->step_count > 0 ? survey->step_share * sum_of_steps(survey, deep) : 0;
    double inner = smooth_width(widths->width[survey->inner], added);
    if (!(w * there > 0 && inner > 0)) {
        return out; /* a width that Newton's iteration has brought down to nothing */
    }
    double q = inner * here / (w * there);
    double below = deep - q * survey->s, limit = ILSAI_NEXT_TERM_MAX;
    double term = below > 0 ? (q - 1) * survey->s / below : limit;
    double slope = 0; /* d term / d q */
    if (fabs(term) < limit) {
        slope = survey->s * survey->depth / (below * below);
    } else {
        term = term > 0 ? limit : -limit;
    }
    out.width = w / (1 + term);
    out.by_cell *= 1 / (1 + term) + q * slope / ((1 + term) * (1 + term));
    out.by_inner = -w * q * slope / (inner * (1 + term) * (1 + term));
    return out;
}

void ilsai_survey_settle(const survey_widths *widths, survey_cell *survey) {
    double at[] = {survey->s, survey->s + (survey->inner >= 0 ? survey->depth : 0)};
    asymptote_point point[2] = {{sqrt(at[0]), 0, 0.5, 0},
                                {sqrt(at[1]), 0, 0.5, 0}}; /* at rest, but a factor */
    if (survey->V > 0) {
        ilsai_asymptote_row(widths->tip_material, survey->V, survey->inner >= 0 ? 2 : 1, at, point);
    }
    survey->w_asymptote = point[0].w;
    survey->w_tip = survey->V > 0 ? point[0].w
                                  : widths->tip_material->K_prime * sqrt(survey->s) /
                                        widths->tip_material->E_prime;
    survey->exponent = point[0].exponent;
    survey->w_asymptote_inner = point[1].w;
    double sum = survey->step_count > 0 ? sum_of_steps(survey, survey->s) : 0;
    survey->step_share = share_of(survey, sum);
    survey->step_width = sum != 0 ? survey->step_share * sum : 0;
}

double ilsai_survey_width(const survey_widths *widths, const survey_cell *survey) {
    return split_width(widths, survey).width;
}

/* One evaluation of (4.9), the second term taken at the distance and velocity that survey has. */
static double distance_for(const survey_widths *widths, survey_cell *survey, double dt) {
    first_term w = split_width(widths, survey);
    asymptote_front at =
        ilsai_asymptote_distance_near(widths->tip_material, w.width, survey->s0, dt, survey->s);
    survey->ds_dw = at.ds_dw * w.by_cell;
    survey->ds_inner = at.ds_dw * w.by_inner;
    return at.s;
}

/* The root of F(s) = s between what has been seen on both sides of it. */
typedef struct bracket {
    double low, high;
} bracket;

/* From s, where F(s) is value, along the slope; halfway where that leaves the bracket. */
static double next_guess(bracket *b, double s, double value, double slope) {
    double next = s + (value - s) / (1 - slope);
    *(value > s ? &b->low : &b->high) = s;
    return next > b->low && next < b->high ? next
           : isfinite(b->high)             ? 0.5 * (b->low + b->high)
                                           : fmax(next, b->low);
}

/*
 * A front that has just passed a step of the stress into a barrier leaves the less for the
 * asymptote the further it goes: F falls as steeply as the step is high, which takes more guesses.
 */
double ilsai_survey_distance(const survey_widths *widths, survey_cell *survey, double dt) {
    survey_cell at = *survey;
    double value = distance_for(widths, &at, dt), limit = ILSAI_SURVEY_SLOPE;
    double close = ILSAI_SURVEY_CLOSE * widths->tolerance * at.h;
    double slope = survey->step_count > 0 ? 0 : survey->slope;
    double least = survey->step_count > 0 ? -INFINITY : -limit;
    bracket root = {at.s0, INFINITY};
    int most = survey->step_count > 0 ? ILSAI_SURVEY_GUESSES : ILSAI_SURVEY_SECANTS;
    for (int k = 0; k < most; k++) {
        double last = at.s, straight = fmax(at.s0, last + (value - last) / (1 - slope));
        double next = survey->step_count > 0 ? next_guess(&root, last, value, slope) : straight;
        if (!(fabs(next - last) > close)) {
            break;
        }
        at.s = next;
        at.V = (next - at.s0) / dt;
        ilsai_survey_settle(widths, &at);
        double fresh = distance_for(widths, &at, dt);
        slope = fmax(least, fmin(limit, (fresh - value) / (next - last)));
        value = fresh;
    }
    survey->slope = fabs(slope) < limit ? slope : 0; /* one at the limit would lead astray */
    survey->ds_dw = at.ds_dw / (1 - slope);
    survey->ds_inner = at.ds_inner / (1 - slope);
    return at.s + (value - at.s) / (1 - slope);
}
