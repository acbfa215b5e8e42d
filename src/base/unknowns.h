/* The numbered cells of a pass: the representative channel and tip cells, numbered for the solve.
 */
#ifndef ILSAI_UNKNOWNS_H
#define ILSAI_UNKNOWNS_H

#include "base/grid.h"
#include <ilsa/status.h>

/* What the coupled solve finds in an unknowns cell; the width of the others is given. */
enum {
    UNKNOWN_WIDTH,    /* an open channel cell; its pressure follows from the widths */
    UNKNOWN_RETAINED, /* a draining cell: the part of its full leak-off that stays in it */
    UNKNOWN_PRESSURE, /* a tip cell */
    UNKNOWN_CONTACT   /* a closed cell, see contact.h: the pressure */
};

typedef struct unknowns {
    int count;
    size_t capacity;
    int *cell;              /* mesh index of each */
    unsigned char *unknown; /* when set: UNKNOWN_PRESSURE in tip cells, elsewhere UNKNOWN_WIDTH */
    int *neighbour;         /* GRID_FACES per cell: number of the numbered cell there, or -1 */
    int *number;            /* over the mesh: number of the numbered cell, or -1 */
    size_t mesh_cells;
    box footprint;
} unknowns;

ilsa_status ilsai_unknowns_create(unknowns *a, const ilsa_mesh_def *mesh);
void ilsai_unknowns_destroy(unknowns *a);

/*
 * Lists the cells of footprint (the bounding box, images included) that are not empty. The numbers
 * run fastest along the shorter side, which keeps the band of a stencil matrix narrow.
 * ILSA_ERR_MEMORY.
 */
ilsa_status ilsai_unknowns_set(unknowns *a, const grid *g, const box *footprint,
                               const unsigned char *kind);

#endif
