#include "survey.h"

#include "tuning.h"
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

/* The first term of the width at a survey cell, and its derivatives by the widths of two cells. */
typedef struct first_term {
    double width;
    double by_cell, by_inner;
} first_term;

static first_term split_width(const ilsa_solver *s, const front_seed *seed) {
    double w = s->trial.width[seed->cell];
    first_term out = {w, 1, 0};
    if (seed->inner < 0) {
        return out;
    }
    double deep = seed->s + seed->depth, here = sqrt(seed->s), there = sqrt(deep);
    if (seed->V > 0) {
        here = ilsai_tip_width(&s->asymptote, seed->V, seed->s);
        there = ilsai_tip_width(&s->asymptote, seed->V, deep);
    }
    double inner = s->trial.width[seed->inner], q = inner * here / (w * there);
    double below = deep - q * seed->s, limit = ILSAI_NEXT_TERM_MAX;
    double term = below > 0 ? (q - 1) * seed->s / below : limit;
    double slope = seed->s * seed->depth / (below * below); /* d term / d q */
    if (!(fabs(term) < limit)) {
        term = term > 0 ? limit : -limit;
        slope = 0;
    }
    out.width = w / (1 + term);
    out.by_cell = 1 / (1 + term) + q * slope / ((1 + term) * (1 + term));
    out.by_inner = -w * q * slope / (inner * (1 + term) * (1 + term));
    return out;
}

double ilsai_survey_width(const ilsa_solver *s, const front_seed *seed) {
    return split_width(s, seed).width;
}

/* One evaluation of (4.9), the second term taken at the distance and velocity that seed has. */
static double distance_for(const ilsa_solver *s, front_seed *seed, double dt) {
    first_term w = split_width(s, seed);
    tip_front at = ilsai_tip_distance(&s->asymptote, w.width, seed->s0, dt);
    seed->ds_dw = at.ds_dw * w.by_cell;
    seed->ds_inner = at.ds_dw * w.by_inner;
    return at.s;
}

double ilsai_survey_distance(const ilsa_solver *s, front_seed *seed, double dt) {
    front_seed at = *seed;
    double value = distance_for(s, &at, dt), slope = 0, limit = ILSAI_SURVEY_SLOPE;
    for (int k = 0; k < ILSAI_SURVEY_SECANTS; k++) {
        double last = at.s, next = fmax(at.s0, last + (value - last) / (1 - slope));
        if (!(fabs(next - last) > ILSAI_SURVEY_CLOSE * at.h)) {
            break;
        }
        at.s = next;
        at.V = (next - at.s0) / dt;
        double fresh = distance_for(s, &at, dt);
        slope = fmax(-limit, fmin(limit, (fresh - value) / (next - last)));
        value = fresh;
    }
    seed->ds_dw = at.ds_dw / (1 - slope);
    seed->ds_inner = at.ds_inner / (1 - slope);
    return at.s + (value - at.s) / (1 - slope);
}
