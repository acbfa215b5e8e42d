/* The lubrication operator (4.3) on the numbered cells, and its derivative. */
#ifndef ILSAI_LUBRICATION_H
#define ILSAI_LUBRICATION_H

#include "base/thread_pool.h"
#include "base/unknowns.h"

/* Per numbered cell and face; 0 where there is no numbered cell across, so that no fluid passes. */
typedef struct lubrication {
    double *conductance;  /* dt w^3 / (mu' h^2): width gained per pressure difference */
    double *slope;        /* derivative of that face's gain by the width of either cell */
    size_t capacity;      /* of both arrays: faces */
    thread_pool *threads; /* that share the loops, or NULL */
} lubrication;

ilsa_status ilsai_lubrication_reserve(lubrication *f, int count);
void ilsai_lubrication_destroy(lubrication *f);

/*
 * Sets both from widths, those at the start of the step, and pressures over the mesh. Of the three
 * factors of w^3 one is the mean over the step. Where the front moves on, the flux V w through a
 * face grows with the width during the step and its mean is V w_mean, while the pressure gradient
 * at the end is mu' V / w^2: with w^3 the flux would be too large beside the front by the same part
 * on any mesh.
 */
void ilsai_lubrication_set(lubrication *f, const unknowns *a, const grid *g, const double *width,
                           const double *width_old, const double *pressure,
                           double dt_over_mu_prime);

/* dt [A(w) p] of numbered cell k, for the conductances as they are set. */
static inline double ilsai_lubrication_inflow(const lubrication *f, const unknowns *a,
                                              const double *pressure, int k) {
    double sum = 0, p = pressure[a->cell[k]];
    for (int face = 0; face < GRID_FACES; face++) {
        int at = GRID_FACES * k + face, other = a->neighbour[at];
        if (other >= 0) {
            sum += f->conductance[at] * (pressure[a->cell[other]] - p);
        }
    }
    return sum;
}

#endif
