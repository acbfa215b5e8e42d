/*
 * Lubrication: the fluid that flows through the faces of the numbered cells in a step, Dontsov and
 * Peirce 2017, (4.3) and (4.4), for any fluid.
 *
 * A fluid is a table with one function, which goes over all faces and sets the arrays below. The
 * coupled solve, its Newton matrix and its preconditioner see these arrays alone. They ask for
 * four things:
 *
 * - A face without a numbered cell across has zeros, so that no fluid passes it.
 * - Seen from the two cells of a face, the fluxes are opposite and the derivatives by_pressure
 *   equal. What one cell loses the other gains.
 * - by_pressure is not negative: fluid flows towards the lower pressure.
 * - by_width is the derivative by the width of either cell. One number is enough for a fluid whose
 *   flux depends on the widths through their mean.
 */
#ifndef ILSAI_LUBRICATION_H
#define ILSAI_LUBRICATION_H

#include "base/thread_pool.h"
#include "base/unknowns.h"
#include <ilsa/material.h>
#include <stdbool.h>
#include <stddef.h>

/* One number per numbered cell and face, at GRID_FACES * cell + face. */
typedef struct lubrication {
    double *flux;        /* volume per area of the cell that enters it in the step */
    double *by_pressure; /* derivative by the pressure across the face less that of the cell */
    double *by_width;
    /* Where cells are closed or drain, see flow/contact.h, fluxes change with the width of the cell
     * that they come from alone as well. */
    bool restrained;         /* whether that is so; the other two are of no meaning without */
    double *by_width_across; /* the derivative by the width of the cell across */
    double *by_own_width;    /* per numbered cell: that of all that it gains by its own width */
    size_t capacity;         /* cells that the arrays have room for */
} lubrication;

/* What a fluid may find its fluxes from. Widths and pressures are over the mesh. */
typedef struct flow_state {
    const grid *g;
    const unknowns *cells;
    const ilsa_material_def *material;
    double dt;
    const double *width, *width_old; /* at the end of the step and at its start */
    const double *pressure;
    thread_pool *threads; /* that share the loops, or NULL */
} flow_state;

/*
 * A fluid that is not Newtonian needs the size of the whole gradient at a face. The component along
 * the normal is the pressure difference across the face. The other one is a mean of the differences
 * that both cells of the face have to their neighbours along the other axis: cells->neighbour leads
 * to these, and their pressures are known. by_pressure is then the derivative with that component
 * held. The Newton matrix leaves out how the flux changes with it, which costs iterations and no
 * accuracy.
 */
typedef struct fluid {
    const char *name;
    void (*set_fluxes)(lubrication *l, const flow_state *state);
} fluid;

/* Makes room for the faces of count numbered cells. ILSA_ERR_MEMORY. */
ilsa_status ilsai_lubrication_reserve(lubrication *l, int count);
void ilsai_lubrication_destroy(lubrication *l);

/* Volume per area that enters numbered cell k in the step: dt A(w) p of (4.4). */
static inline double ilsai_lubrication_inflow(const lubrication *l, int k) {
    double sum = 0;
    for (int face = 0; face < GRID_FACES; face++) {
        sum += l->flux[GRID_FACES * k + face];
    }
    return sum;
}

/* The change of that for changes of the pressures over the mesh, to first order. */
static inline double ilsai_lubrication_inflow_change(const lubrication *l, const unknowns *cells,
                                                     const double *change, int k) {
    double sum = 0, here = change[cells->cell[k]];
    for (int face = 0; face < GRID_FACES; face++) {
        int at = GRID_FACES * k + face, other = cells->neighbour[at];
        if (other >= 0) {
            sum += l->by_pressure[at] * (change[cells->cell[other]] - here);
        }
    }
    return sum;
}

#endif
