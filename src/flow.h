/* The lubrication operator (4.3) on the active cells, and its derivative. */
#ifndef ILSAI_FLOW_H
#define ILSAI_FLOW_H

#include "active.h"

/* Per active cell and face; 0 where there is no active cell across, so that no fluid passes. */
typedef struct flow {
    double *conductance; /* dt w^3 / (mu' h^2): width gained per pressure difference */
    double *slope;       /* derivative of that face's gain by the width of either cell */
    int capacity;
} flow;

ilsa_status ilsai_flow_reserve(flow *f, int count);
void ilsai_flow_destroy(flow *f);

/* Sets both from widths and pressures over the mesh. */
void ilsai_flow_set(flow *f, const active *a, const grid *g, const double *width,
                    const double *pressure, double dt_over_mu_prime);

/* gain[k] = dt [A(w) p] of active cell k, for the conductances as they are set. */
void ilsai_flow_gain(const flow *f, const active *a, const double *pressure, double *gain);

#endif
