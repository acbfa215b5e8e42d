#include "flow/contact.h"

#include <math.h>

/* The width that a cell keeps while it is closed. */
static double kept_width(const contact *c, int cell) {
    double old = c->width_old[cell];
    return old > 0 && old < c->field.closure_width ? old : c->field.closure_width;
}

/* The most that can be retained: the full leak-off but for the fluid that the cell loses by
 * closing. */
static double retained_limit(const contact *c, int k) {
    int cell = c->cells->cell[k];
    if (!c->field.leakoff) {
        return 0;
    }
    double full = fmax(c->field.leakoff[cell] - c->source_change[k], 0);
    return full - fmin(full, fmax(c->width_old[cell] - kept_width(c, cell), 0));
}

static void set_retained(const contact *c, int k, double value) {
    if (c->field.retained) {
        c->field.retained[c->cells->cell[k]] = value;
    }
}

static void set_state(const contact *c, int k, unsigned char state) {
    static const unsigned char unknown[] = {UNKNOWN_WIDTH, UNKNOWN_RETAINED, UNKNOWN_CONTACT,
                                            UNKNOWN_WIDTH};
    int cell = c->cells->cell[k];
    c->field.state[cell] = state;
    c->cells->unknown[k] = unknown[state];
    c->closing_pressure[k] = c->pressure[cell];
}

void ilsai_contact_begin(const contact *c) {
    for (int k = 0; k < c->cells->count; k++) {
        int cell = c->cells->cell[k];
        bool tip = c->cells->unknown[k] == UNKNOWN_PRESSURE;
        unsigned char state = tip ? CONTACT_OPEN : c->field.state[cell];
        double limit = state == CONTACT_OPEN ? 0 : retained_limit(c, k);
        if (state == CONTACT_DRAINING) {
            limit = fmax(fmin(c->field.retained[cell], limit), 0);
        }
        set_retained(c, k, limit);
        if (!tip) {
            set_state(c, k, state);
        }
        if (state != CONTACT_OPEN) {
            c->width[cell] = kept_width(c, cell);
        }
    }
}

/* Closes or drains cell k. The width that is missing up to the closure width is retained. */
static void close_cell(const contact *c, int k, double missing) {
    double limit = retained_limit(c, k);
    bool drains = missing < limit || (c->late && c->field.retained);
    c->width[c->cells->cell[k]] += missing;
    set_retained(c, k, drains ? missing : limit);
    set_state(c, k, drains ? CONTACT_DRAINING : CONTACT_CLOSED);
}

bool ilsai_contact_bound(const contact *c, int k) {
    int cell = c->cells->cell[k];
    if (c->cells->unknown[k] == UNKNOWN_WIDTH) {
        double missing = kept_width(c, cell) - c->width[cell];
        c->field.state[cell] = CONTACT_OPEN;
        if (missing >= 0) {
            close_cell(c, k, missing);
            return true;
        }
    } else if (c->cells->unknown[k] == UNKNOWN_RETAINED && !c->late) {
        double limit = retained_limit(c, k), retained = c->field.retained[cell];
        if (retained < 0 || retained > limit) {
            set_retained(c, k, retained < 0 ? 0 : limit);
            set_state(c, k, retained < 0 ? CONTACT_OPEN : CONTACT_CLOSED);
            return true;
        }
    }
    return false;
}

bool ilsai_contact_opens(const contact *c, int k) {
    return c->pressure[c->cells->cell[k]] > c->stress[k] && !(c->late && !c->field.retained);
}

void ilsai_contact_reopen(const contact *c, int k) {
    bool drains = retained_limit(c, k) > 0 || (c->late && c->field.retained);
    c->pressure[c->cells->cell[k]] = c->stress[k];
    set_state(c, k, drains ? CONTACT_DRAINING : CONTACT_OPENING);
}

double ilsai_contact_violation(const contact *c, int k) {
    if (c->cells->unknown[k] != UNKNOWN_RETAINED) {
        return 0;
    }
    double retained = c->field.retained[c->cells->cell[k]];
    return fmax(-retained, retained - retained_limit(c, k));
}
