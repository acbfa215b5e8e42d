#include "base/unknowns.h"

#include "base/error.h"
#include "base/memory.h"
#include <ilsa/solver.h>
#include <string.h>

ilsa_status ilsai_unknowns_create(unknowns *u, const ilsa_mesh_def *mesh) {
    memset(u, 0, sizeof *u);
    u->mesh_cells = (size_t)mesh->nx * (size_t)mesh->ny;
    u->number = ilsai_allocate(u->mesh_cells, sizeof *u->number);
    if (!u->number) {
        return ILSA_ERR_MEMORY;
    }
    for (size_t k = 0; k < u->mesh_cells; k++) {
        u->number[k] = -1;
    }
    return ILSA_OK;
}

void ilsai_unknowns_destroy(unknowns *u) {
    ilsai_release(u->cell);
    ilsai_release(u->unknown);
    ilsai_release(u->neighbour);
    ilsai_release(u->number);
    memset(u, 0, sizeof *u);
}

static void forget(unknowns *u) {
    for (int k = 0; k < u->count; k++) {
        u->number[u->cell[k]] = -1;
    }
    u->count = 0;
}

static void add(unknowns *u, int cell, unsigned char kind) {
    if (kind != ILSA_CELL_EMPTY) {
        u->cell[u->count] = cell;
        u->unknown[u->count] = kind == ILSA_CELL_TIP ? UNKNOWN_PRESSURE : UNKNOWN_WIDTH;
        u->number[cell] = u->count++;
    }
}

static void number_cells(unknowns *u, const grid *g, const unsigned char *kind, const box *part) {
    if (part->x1 - part->x0 > part->y1 - part->y0) {
        for (int i = part->x0; i <= part->x1; i++) {
            for (int j = part->y0; j <= part->y1; j++) {
                int cell = ilsai_grid_cell(g, i, j);
                add(u, cell, kind[cell]);
            }
        }
    } else {
        for (int j = part->y0; j <= part->y1; j++) {
            for (int i = part->x0; i <= part->x1; i++) {
                int cell = ilsai_grid_cell(g, i, j);
                add(u, cell, kind[cell]);
            }
        }
    }
}

static void find_neighbours(unknowns *u, const grid *g) {
    for (int k = 0; k < u->count; k++) {
        int i = u->cell[k] % g->nx, j = u->cell[k] / g->nx;
        for (int face = 0; face < GRID_FACES; face++) {
            int cell = ilsai_grid_neighbour(g, i, j, face);
            u->neighbour[GRID_FACES * k + face] = cell < 0 ? -1 : u->number[cell];
        }
    }
}

ilsa_status ilsai_unknowns_set(unknowns *u, const grid *g, const box *footprint,
                               const unsigned char *kind) {
    box part = ilsai_box_fold(g, footprint);
    const grown_array arrays[] = {ILSAI_GROWN(u->cell),
                                  ILSAI_GROWN(u->unknown),
                                  {&u->neighbour, GRID_FACES * sizeof *u->neighbour}};
    forget(u);
    ILSAI_TRY(ilsai_grow(ilsai_box_columns(&part) * ilsai_box_rows(&part), &u->capacity, arrays,
                         sizeof arrays / sizeof *arrays));
    u->footprint = *footprint;
    number_cells(u, g, kind, &part);
    find_neighbours(u, g);
    return ILSA_OK;
}
