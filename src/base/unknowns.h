/*
 * The numbered cells of a pass: the representative channel and tip cells, to each of which the
 * coupled solve has one unknown and one volume balance.
 */
#ifndef ILSAI_UNKNOWNS_H
#define ILSAI_UNKNOWNS_H

#include "base/grid.h"
#include <ilsa/status.h>
#include <stddef.h>

/*
 * What the coupled solve finds in a numbered cell. From UNKNOWN_PRESSURE on it is a pressure; but
 * for UNKNOWN_WIDTH the width is given.
 */
enum {
    UNKNOWN_WIDTH,    /* an open channel cell; its pressure follows from the widths */
    UNKNOWN_RETAINED, /* a draining cell: the part of its full leak-off that stays in it */
    UNKNOWN_PRESSURE, /* a tip cell */
    UNKNOWN_CONTACT   /* a closed cell: the pressure, which its faces make up for */
};

typedef struct unknowns {
    int count;
    size_t capacity;
    int *cell;              /* mesh cell of each numbered cell */
    unsigned char *unknown; /* set to UNKNOWN_PRESSURE in tip cells, elsewhere to UNKNOWN_WIDTH;
                               flow/contact.h changes the latter */
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
