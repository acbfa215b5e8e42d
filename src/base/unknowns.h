/*
 * The numbered cells of a pass: the representative channel and tip cells, to each of which the
 * coupled solve has one unknown and one volume balance.
 */
#ifndef ILSAI_UNKNOWNS_H
#define ILSAI_UNKNOWNS_H

#include "base/grid.h"
#include <ilsa/status.h>
#include <stddef.h>

/* What the coupled solve finds in a numbered cell. */
enum {
    UNKNOWN_WIDTH,    /* a channel cell: the width, from which the pressure follows */
    UNKNOWN_PRESSURE, /* a tip cell: the pressure; the front gives the width */
    UNKNOWN_FILL,     /* a tip cell whose pressure is at a bound: the width, see solve/coupled.h */
    UNKNOWN_NONE      /* a tip cell that no fluid reaches: the width is given, and the pressure
                         follows from the widths */
};

typedef struct unknowns {
    int count;
    size_t capacity;
    int *cell;              /* mesh cell of each numbered cell */
    unsigned char *unknown; /* set to UNKNOWN_PRESSURE in tip cells, which solve/coupled.c
                               changes, elsewhere to UNKNOWN_WIDTH */
    int *neighbour;         /* GRID_FACES per numbered cell: the numbered cell across, or -1 */
    int *number;            /* over the mesh: the number of each cell, or -1 */
    size_t mesh_cells;
    box footprint;
} unknowns;

ilsa_status ilsai_unknowns_create(unknowns *u, const ilsa_mesh_def *mesh);
void ilsai_unknowns_destroy(unknowns *u);

/*
 * Numbers the cells of the footprint, a bounding box with images included, that are not empty. The
 * numbers run fastest along the shorter side, so that neighbours have numbers close to each other.
 * ILSA_ERR_MEMORY.
 */
ilsa_status ilsai_unknowns_set(unknowns *u, const grid *g, const box *footprint,
                               const unsigned char *kind);

#endif
