#include "base/unknowns.h"

#include "base/error.h"
#include "base/memory.h"
#include <ilsa/solver.h>
#include <string.h>

ilsa_status ilsai_unknowns_create(unknowns *a, const ilsa_mesh_def *mesh) {
    memset(a, 0, sizeof *a);
    a->mesh_cells = (size_t)mesh->nx * (size_t)mesh->ny;
    a->number = ilsai_allocate(a->mesh_cells, sizeof *a->number);
    if (!a->number) {
        return ILSA_ERR_MEMORY;
    }
    for (size_t k = 0; k < a->mesh_cells; k++) {
        a->number[k] = -1;
    }
    return ILSA_OK;
}

void ilsai_unknowns_destroy(unknowns *a) {
    ilsai_release(a->cell);
    ilsai_release(a->unknown);
    ilsai_release(a->neighbour);
    ilsai_release(a->number);
    memset(a, 0, sizeof *a);
}

static void forget(unknowns *a) {
    for (int k = 0; k < a->count; k++) {
        a->number[a->cell[k]] = -1;
    }
    a->count = 0;
}

static void add(unknowns *a, int cell, unsigned char kind) {
    if (kind != ILSA_CELL_EMPTY) {
        a->cell[a->count] = cell;
        a->unknown[a->count] = kind == ILSA_CELL_TIP ? UNKNOWN_PRESSURE : UNKNOWN_WIDTH;
        a->number[cell] = a->count++;
    }
}

static void number_cells(unknowns *a, const grid *g, const unsigned char *kind, const box *part) {
    if (part->x1 - part->x0 > part->y1 - part->y0) {
        for (int i = part->x0; i <= part->x1; i++) {
            for (int j = part->y0; j <= part->y1; j++) {
                int cell = ilsai_grid_cell(g, i, j);
                add(a, cell, kind[cell]);
            }
        }
    } else {
        for (int j = part->y0; j <= part->y1; j++) {
            for (int i = part->x0; i <= part->x1; i++) {
                int cell = ilsai_grid_cell(g, i, j);
                add(a, cell, kind[cell]);
            }
        }
    }
}

static void find_neighbours(unknowns *a, const grid *g) {
    for (int k = 0; k < a->count; k++) {
        int i = a->cell[k] % g->nx, j = a->cell[k] / g->nx;
        for (int face = 0; face < GRID_FACES; face++) {
            int cell = ilsai_grid_neighbour(g, i, j, face);
            a->neighbour[GRID_FACES * k + face] = cell < 0 ? -1 : a->number[cell];
        }
    }
}

ilsa_status ilsai_unknowns_set(unknowns *a, const grid *g, const box *footprint,
                               const unsigned char *kind) {
    box part = ilsai_box_fold(g, footprint);
    const grown_array arrays[] = {ILSAI_GROWN(a->cell),
                                  ILSAI_GROWN(a->unknown),
                                  {&a->neighbour, GRID_FACES * sizeof *a->neighbour}};
    forget(a);
    ILSAI_TRY(ilsai_grow(ilsai_box_columns(&part) * ilsai_box_rows(&part), &a->capacity, arrays,
                         sizeof arrays / sizeof *arrays));
    a->footprint = *footprint;
    number_cells(a, g, kind, &part);
    find_neighbours(a, g);
    return ILSA_OK;
}
