/*
 * Contact: channel cells whose faces have come together. A closed cell keeps a smallest width, its
 * faces carry what of the closure stress sigma + C w the fluid does not, and it opens again when
 * the fluid carries all of it. It leaks what it had more than that width when it closed, then
 * nothing; what the flow brings it beyond what carries the faces leaks too, up to the full rate.
 *
 *   open      w > w_c   p = sigma + C w   leak = full
 *   draining  w = w_c   p = sigma + C w   own <= leak <= full
 *   closed    w = w_c   p <= sigma + C w  leak = own = min(full, w_old - w_c)
 */
#ifndef ILSAI_CONTACT_H
#define ILSAI_CONTACT_H

#include "base/unknowns.h"
#include <stdbool.h>

/* States of a channel cell; an array of zeros has all of them open. */
enum { CONTACT_OPEN, CONTACT_DRAINING, CONTACT_CLOSED, CONTACT_OPENING /* in this iteration */ };

/* Width over w_c up to which a cell counts as closed. */
#define CONTACT_TOUCHES 1.001

/* What of contact is kept between the solves of a step. Arrays are over the mesh. */
typedef struct contact_fields {
    double closure_width; /* w_c */
    unsigned char *state; /* NULL: cells cannot close */
    const double *leak;   /* per area in the step at the full rate; NULL: nothing leaks */
    double *retained;     /* the part of leak that does not; NULL as leak */
} contact_fields;

/* What a solve knows of it. Arrays are over the mesh but for shift. */
typedef struct contact {
    contact_fields field;
    unknowns *cells;             /* their unknowns follow the states */
    const double *old;           /* widths at the start of the step; a cell under w_c keeps that */
    const double *source_change; /* per numbered cell: change of the source terms in this solve */
    const double *stress;        /* per numbered cell: sigma + C w */
    double *closing_pressure;    /* per numbered cell: pressure with which it closed or began */
    double *width, *pressure;
    /*
     * Cells that open and close in turn would go on for ever: late in a solve they drain, beyond
     * the bounds if need be; where nothing leaks those that are closed stay so.
     */
    bool late;
} contact;

/* Whether a step finds a channel cell of this width closed. */
static inline bool ilsai_contact_closed(double width, double closure_width) {
    return width <= CONTACT_TOUCHES * closure_width;
}

/* The unknowns, widths and reliefs that the states call for. */
void ilsai_contact_begin(const contact *c);

/*
 * After a change of the widths and reliefs: active channel cell k closes, drains or opens if it has
 * passed a bound, on which it is put. Returns whether it has.
 */
bool ilsai_contact_bound(const contact *c, int k);

/* Whether the pressure of closed cell k exceeds the closure stress, and the cell may open. */
bool ilsai_contact_opens(const contact *c, int k);

/* Opens such a cell. */
void ilsai_contact_reopen(const contact *c, int k);

/* By how much what leaks from a cell that drains is beyond its bounds, per area. */
double ilsai_contact_violation(const contact *c, int k);

#endif
