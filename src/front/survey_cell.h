/*
 * A survey cell: a channel cell with a tip cell beside it, whose width tells where the front is.
 *
 * A step makes its survey cells from the fracture as it finds it, and each pass moves their fronts.
 */
#ifndef ILSAI_SURVEY_CELL_H
#define ILSAI_SURVEY_CELL_H

#include "tip/stress_step.h"

/* More than the edges that a ray crosses where stress steps are looked for, but in cells of very
 * unlike sides. */
enum { SURVEY_STEPS = 24 };

typedef struct survey_cell {
    /* Set when the step begins, from the fracture, and valid through all passes. */
    int cell;            /* mesh index */
    double s0;           /* distance from the centre to the front at the start of the step */
    double h;            /* size of the cell along the normal */
    double cos_a, sin_a; /* normal of the front, reflected into 0 .. pi/2 */
    double curvature;    /* of the front, positive where it is convex; 0: not known */
    int inner;           /* cell behind, whose width gives the term after the asymptote; -1: none */
    double depth;        /* how much further from the front the inner cell is */
    int step_count;      /* steps of the stress on the normal through the cell */
    stress_step step[SURVEY_STEPS];

    /* Set when a pass places the front, and valid until the next pass does. */
    double s;                 /* distance to the front */
    double V;                 /* velocity of the front, (s - s0) / dt */
    double w_asymptote;       /* width of the asymptote at s */
    double w_tip;             /* the same; of a front at rest the width that toughness gives */
    double exponent;          /* d ln w / d ln s of the asymptote at s */
    double w_asymptote_inner; /* width of the asymptote at the inner cell */
    double step_share;        /* part of the widths of its stress steps that it is given */
    double step_width;        /* what they add at s with this part */
    double w;                 /* width by which the march takes the front's velocity on */

    /* Set when a pass inverts the widths of the coupled solve, and read by the next pass. */
    double ds_dw;    /* derivative of the distance by the width of the cell */
    double ds_inner; /* derivative of the distance by the width of the inner cell */
    double slope;    /* of the distance (4.9) by the one that its second term is taken at */
} survey_cell;

#endif
