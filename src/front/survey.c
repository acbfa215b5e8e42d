#include "front/survey.h"

#include "base/tuning.h"
#include <math.h>

static int is_open(const ilsa_solver *s, const grid *g, int i, int j, int face) {
    int other = ilsai_grid_neighbour(g, i, j, face);
    return other < 0 || s->field.kind[other] < ILSA_CELL_SURVEY;
}

double ilsai_survey_size(const ilsa_solver *s, const grid *g, int i, int j) {
    int along_x = is_open(s, g, i, j, GRID_LEFT) || is_open(s, g, i, j, GRID_RIGHT);
    int along_y = is_open(s, g, i, j, GRID_DOWN) || is_open(s, g, i, j, GRID_UP);
    return along_x && along_y ? ilsai_grid_h(g) : along_x ? g->dx : g->dy;
}

edge_front ilsai_survey_front(const front_seed *seed) {
    return (edge_front){seed->s, seed->cos_a, seed->sin_a, seed->exponent};
}

jump_depth ilsai_survey_jump_depth(const front_seed *seed, int k) {
    double depth = seed->s + seed->jump[k].depth, soft = ILSAI_JUMP_SOFT * seed->h;
    double part = depth > 0 ? depth / (depth + soft) : 0;
    return (jump_depth){depth * part, part * (2 - part)};
}

double ilsai_survey_jump_width(const front_seed *seed, double s) {
    double sum = 0;
    for (int k = 0; k < seed->jumps; k++) {
        sum += seed->jump[k].height * ilsai_jump_width(s, ilsai_survey_jump_depth(seed, k).value);
    }
    return sum;
}

/* What of the mean width of a cell at distance s from the seed's front no jump has brought. */
static double smooth_width(const ilsa_solver *s, const front_seed *seed, int cell,
                           double distance) {
    double w = s->trial.width[cell];
    return fmax(w - ilsai_survey_jump_width(seed, distance), ILSAI_JUMP_LEFT * w);
}

double ilsai_survey_smooth_slope(const ilsa_solver *s, const front_seed *seed) {
    double w = s->trial.width[seed->cell];
    return smooth_width(s, seed, seed->cell, seed->s) > ILSAI_JUMP_LEFT * w ? 1 : ILSAI_JUMP_LEFT;
}

/*
 * The first term of the width at the centre of a survey cell, and its derivatives by the widths of
 * two cells, which are means.
 */
typedef struct first_term {
    double width;
    double by_cell, by_inner;
} first_term;

static first_term split_width(const ilsa_solver *s, const front_seed *seed) {
    edge_front seen = ilsai_survey_front(seed);
    double mean = ilsai_edge_mean(s->mesh.dx, s->mesh.dy, &seen);
    double w = smooth_width(s, seed, seed->cell, seed->s) / mean;
    first_term out = {w, ilsai_survey_smooth_slope(s, seed) / mean, 0};
    if (seed->inner < 0) {
        return out;
    }
    double deep = seed->s + seed->depth, here = seed->asymptote, there = seed->deep;
    seen.s = deep;
    there *= ilsai_edge_mean(s->mesh.dx, s->mesh.dy, &seen);
    double inner = smooth_width(s, seed, seed->inner, deep);
    if (!(w * there > 0 && inner > 0)) {
        return out; /* a width that Newton's iteration has brought down to nothing */
    }
    double q = inner * here / (w * there);
    double below = deep - q * seed->s, limit = ILSAI_NEXT_TERM_MAX;
    double term = below > 0 ? (q - 1) * seed->s / below : limit;
    double slope = 0; /* d term / d q */
    if (fabs(term) < limit) {
        slope = seed->s * seed->depth / (below * below);
    } else {
        term = term > 0 ? limit : -limit;
    }
    out.width = w / (1 + term);
    out.by_cell *= 1 / (1 + term) + q * slope / ((1 + term) * (1 + term));
    out.by_inner = -w * q * slope / (inner * (1 + term) * (1 + term));
    return out;
}

void ilsai_survey_settle(const ilsa_solver *s, front_seed *seed) {
    double at[] = {seed->s, seed->s + (seed->inner >= 0 ? seed->depth : 0)};
    tip_point point[2] = {{sqrt(at[0]), 0, 0.5, 0},
                          {sqrt(at[1]), 0, 0.5, 0}}; /* at rest, but a factor */
    if (seed->V > 0) {
        ilsai_tip_row(&s->asymptote, seed->V, seed->inner >= 0 ? 2 : 1, at, point);
    }
    seed->asymptote = point[0].w;
    seed->exponent = point[0].exponent;
    seed->deep = point[1].w;
}

double ilsai_survey_width(const ilsa_solver *s, const front_seed *seed) {
    return split_width(s, seed).width;
}

/* One evaluation of (4.9), the second term taken at the distance and velocity that seed has. */
static double distance_for(const ilsa_solver *s, front_seed *seed, double dt) {
    first_term w = split_width(s, seed);
    tip_front at = ilsai_tip_distance_near(&s->asymptote, w.width, seed->s0, dt, seed->s);
    seed->ds_dw = at.ds_dw * w.by_cell;
    seed->ds_inner = at.ds_dw * w.by_inner;
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
double ilsai_survey_distance(const ilsa_solver *s, front_seed *seed, double dt) {
    front_seed at = *seed;
    double value = distance_for(s, &at, dt), limit = ILSAI_SURVEY_SLOPE;
    double close = ILSAI_SURVEY_CLOSE * s->tolerance * at.h;
    double slope = seed->jumps > 0 ? 0 : seed->slope;
    double least = seed->jumps > 0 ? -INFINITY : -limit;
    bracket root = {at.s0, INFINITY};
    int most = seed->jumps > 0 ? ILSAI_SURVEY_GUESSES : ILSAI_SURVEY_SECANTS;
    for (int k = 0; k < most; k++) {
        double last = at.s, straight = fmax(at.s0, last + (value - last) / (1 - slope));
        double next = seed->jumps > 0 ? next_guess(&root, last, value, slope) : straight;
        if (!(fabs(next - last) > close)) {
            break;
        }
        at.s = next;
        at.V = (next - at.s0) / dt;
        ilsai_survey_settle(s, &at);
        double fresh = distance_for(s, &at, dt);
        slope = fmax(least, fmin(limit, (fresh - value) / (next - last)));
        value = fresh;
    }
    seed->slope = fabs(slope) < limit ? slope : 0; /* one at the limit would lead astray */
    seed->ds_dw = at.ds_dw / (1 - slope);
    seed->ds_inner = at.ds_inner / (1 - slope);
    return at.s + (value - at.s) / (1 - slope);
}
