/*
 * Contact: channel cells whose faces have come together.
 *
 * A closed cell keeps the closure width w_c. Its faces carry the part of the closure stress
 * sigma + C w that the fluid does not carry. The cell opens when the fluid carries all of it. In
 * the step in which it closes, it leaks the fluid that it had above w_c. After that it leaks
 * nothing of its own. Between open and closed a cell drains: the fluid carries the faces, and what
 * the flow brings goes into the rock, up to the full leak-off. See docs/theory.md, section 10.
 *
 *   state     width    pressure           leak-off in the step
 *   open      w > w_c  p = sigma + C w    full
 *   draining  w = w_c  p = sigma + C w    own <= leak-off <= full
 *   closed    w = w_c  p <= sigma + C w   own = min(full, w_old - w_c)
 *
 * The retained leak-off is the full one less that of the table. It is the unknown of a draining
 * cell.
 */
#ifndef ILSAI_CONTACT_H
#define ILSAI_CONTACT_H

#include "base/unknowns.h"
#include <stdbool.h>

/*
 * States of a channel cell. An array of zeros has all cells open. A cell is opening in the one
 * Newton iteration in which it goes from closed to open.
 */
enum { CONTACT_OPEN, CONTACT_DRAINING, CONTACT_CLOSED, CONTACT_OPENING };

/* A cell counts as closed up to this width, over w_c. */
#define CONTACT_TOUCHES 1.001

/* What is kept of contact between the solves of a step. Arrays are over the mesh. */
typedef struct contact_fields {
    double closure_width;  /* w_c */
    unsigned char *state;  /* NULL: cells cannot close */
    const double *leakoff; /* the full leak-off of the step, per area; NULL: nothing leaks */
    double *retained;      /* the part of it that stays in the cell; NULL where nothing leaks */
} contact_fields;

/* What a solve knows of contact. width_old, width and pressure are over the mesh. */
typedef struct contact {
    contact_fields field;
    unknowns *cells;             /* their unknowns follow the states */
    const double *width_old;     /* at the start of the step; a cell that was under w_c keeps it */
    const double *source_change; /* per numbered cell: change of the source term in this solve */
    const double *stress;        /* per numbered cell: the closure stress sigma + C w */
    double *closing_pressure;    /* per numbered cell: pressure when it took on its state */
    double *width, *pressure;
    /*
     * Late in a solve the states settle, because cells that open and close in turn would go on for
     * ever. Cells that would close drain instead, if need be with a leak-off beyond its bounds.
     * Where nothing leaks, closed cells stay closed.
     */
    bool late;
} contact;

/* Whether a channel cell of this width is closed when a step begins. */
static inline bool ilsai_contact_closed(double width, double closure_width) {
    return width <= CONTACT_TOUCHES * closure_width;
}

/* Sets the unknowns, the widths and the retained leak-off of all numbered cells for their states.
 */
void ilsai_contact_begin(const contact *c);

/*
 * Puts open or draining cell k on the bound that a Newton step has taken it past, in the state
 * beyond that bound. Returns whether it was past one.
 */
bool ilsai_contact_bound(const contact *c, int k);

/* Whether closed cell k is to open, because its pressure exceeds the closure stress. */
bool ilsai_contact_opens(const contact *c, int k);

/* Opens closed cell k; where fluid leaks it drains at first. */
void ilsai_contact_reopen(const contact *c, int k);

/* How far the leak-off of draining cell k is beyond its bounds, per area; <= 0 within them. */
double ilsai_contact_violation(const contact *c, int k);

#endif
