/*
 * Contact: channel cells whose faces have come together.
 *
 * A closed cell keeps a film of fluid of the closure width w_c, which cannot be squeezed out. As in
 * every channel cell its pressure is sigma + C w: the film carries the closure stress. What leaks
 * from a cell and what flows out of it is multiplied by its openness m(w), which rises from 0 at
 * w_c to 1 a thousandth above. What flows in is not held back, so that a cell opens where the fluid
 * beside it exceeds the closure stress. See docs/theory.md, section 10.
 *
 *   cell      width                  leak-off and outflow   inflow
 *   open      w >= 1.001 w_c         all                    all
 *   draining  w_c < w < 1.001 w_c    m(w) of it             all
 *   closed    w = w_c                none                   all
 */
#ifndef ILSAI_CONTACT_H
#define ILSAI_CONTACT_H

#include "flow/lubrication.h"
#include <stdbool.h>

/*
 * What a cell is when a step begins. An array of zeros has all cells open. A tip cell is cut off
 * where the front rests in it before closed cells.
 */
enum { CONTACT_OPEN, CONTACT_CLOSED, CONTACT_CUT_OFF };

/* A cell counts as closed up to this width, over w_c. */
#define CONTACT_TOUCHES 1.001

/* What is kept of contact between the solves of a step. Arrays are over the mesh. */
typedef struct contact_fields {
    double closure_width;       /* w_c */
    const unsigned char *state; /* NULL: cells cannot close */
    const double *leakoff;      /* the full leak-off of the step, per area; NULL: nothing leaks */
    double *retained;           /* the part of it that stays in the cell; NULL: nothing leaks */
} contact_fields;

/* Whether a channel cell of this width is closed. */
static inline bool ilsai_contact_closed(double width, double closure_width) {
    return width <= CONTACT_TOUCHES * closure_width;
}

/* The least width of a channel cell: w_c, or the width at the start of the step if that is less. */
static inline double ilsai_contact_least(double width_old, double closure_width) {
    return width_old > 0 && width_old < closure_width ? width_old : closure_width;
}

/* How far above its least width a cell is open. */
static inline double ilsai_contact_band(double closure_width) {
    return (CONTACT_TOUCHES - 1) * closure_width;
}

/* The openness m of a channel cell. */
static inline double ilsai_contact_openness(double width, double least, double closure_width) {
    double m = (width - least) / ilsai_contact_band(closure_width);
    return m < 0 ? 0 : m < 1 ? m : 1;
}

/*
 * What numbered cell k gains by the flow if it is open, before the flow is restrained: other cells
 * give what their openness lets out.
 */
double ilsai_contact_gain(const lubrication *l, const unknowns *cells, const double *openness,
                          int k);

/*
 * The flow into a cell that opens is large for its width until the pressures on both sides have
 * met. Where the derivative by the width exceeds this part of what elasticity and storage answer
 * with, it would turn Newton's step around.
 */
#define CONTACT_CALM 0.5

/* Takes the flow of numbered cell k not to depend on its width where that is so. self is the entry
 * of the elasticity between the cell and itself. */
void ilsai_contact_calm(lubrication *l, const unknowns *cells, int k, double self);

/*
 * Multiplies what flows out of every numbered cell by its openness; slope is the derivative of that
 * by the width. Both are per numbered cell. No fluid passes to or from a cell whose unknown is
 * UNKNOWN_NONE.
 */
void ilsai_contact_restrain(lubrication *l, const unknowns *cells, const double *openness,
                            const double *slope);

#endif
