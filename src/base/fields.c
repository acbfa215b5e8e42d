#include "base/fields.h"

#include "base/memory.h"
#include <string.h>

const field_row ilsai_field_rows[FIELD_COUNT] = {
#define FIELD(name, type, empty, owner, coarsened, least)                                          \
    {#name, sizeof(type), empty, owner, coarsened, least},
#include "base/fields.def"
#undef FIELD
};

/* Where each pointer stands in the structure. */
static const size_t places[FIELD_COUNT] = {
#define FIELD(name, type, empty, owner, coarsened, least) offsetof(fields, name),
#include "base/fields.def"
#undef FIELD
};

void *ilsai_field(const fields *f, int row) {
    void *array;
    memcpy(&array, (const char *)f + places[row], sizeof array);
    return array;
}

static void set_field(fields *f, int row, void *array) {
    memcpy((char *)f + places[row], &array, sizeof array);
}

static void empty_cells(const fields *f, int row, size_t first, size_t count) {
    void *array = ilsai_field(f, row);
    const field_row *r = &ilsai_field_rows[row];
    if (!array) {
        return;
    }
    if (r->empty == 0) {
        memset((char *)array + first * r->size, 0, count * r->size);
        return;
    }
    for (size_t k = first; k < first + count; k++) {
        memcpy((char *)array + k * sizeof r->empty, &r->empty, sizeof r->empty);
    }
}

ilsa_status ilsai_fields_create(fields *f, size_t cells, int owner, bool leakoff) {
    memset(f, 0, sizeof *f);
    for (int row = 0; row < FIELD_COUNT; row++) {
        const field_row *r = &ilsai_field_rows[row];
        if (!(r->owner & owner) || ((r->owner & FIELD_LEAKOFF) && !leakoff)) {
            continue;
        }
        set_field(f, row, ilsai_allocate(cells, r->size));
        if (!ilsai_field(f, row)) {
            ilsai_fields_destroy(f);
            return ILSA_ERR_MEMORY;
        }
        empty_cells(f, row, 0, cells);
    }
    return ILSA_OK;
}

void ilsai_fields_destroy(fields *f) {
    for (int row = 0; row < FIELD_COUNT; row++) {
        ilsai_release(ilsai_field(f, row));
    }
    memset(f, 0, sizeof *f);
}

void ilsai_fields_clear(fields *f, int nx, const box *b) {
    for (int row = 0; row < FIELD_COUNT; row++) {
        for (int j = b->y0; j <= b->y1; j++) {
            empty_cells(f, row, (size_t)j * (size_t)nx + (size_t)b->x0, ilsai_box_columns(b));
        }
    }
}

void ilsai_fields_copy(fields *to, const fields *from, int nx, const box *b) {
    for (int row = 0; row < FIELD_COUNT; row++) {
        char *target = ilsai_field(to, row);
        const char *source = ilsai_field(from, row);
        size_t size = ilsai_field_rows[row].size;
        for (int j = b->y0; target && source && j <= b->y1; j++) {
            size_t at = ((size_t)j * (size_t)nx + (size_t)b->x0) * size;
            memcpy(target + at, source + at, ilsai_box_columns(b) * size);
        }
    }
}

/* Gives the cells before the axis x = 0 in row j the values of their images. */
static void unfold_row(char *array, size_t size, const grid *g, const box *b, int j) {
    for (int i = b->x0; i <= b->x1 && i < g->lo_x; i++) {
        size_t cell = (size_t)ilsai_grid_cell(g, i, j), from = (size_t)ilsai_grid_fold(g, i, j);
        memcpy(array + cell * size, array + from * size, size);
    }
}

void ilsai_fields_unfold(fields *f, const grid *g, const box *b) {
    size_t columns = ilsai_box_columns(b);
    for (int row = 0; row < FIELD_COUNT; row++) {
        char *array = ilsai_field(f, row);
        size_t size = ilsai_field_rows[row].size;
        for (int j = b->y1; array && j >= b->y0; j--) {
            if (j >= g->lo_y) {
                unfold_row(array, size, g, b, j);
            } else {
                size_t to = (size_t)ilsai_grid_cell(g, b->x0, j);
                size_t from = (size_t)ilsai_grid_cell(g, b->x0, g->ny - 1 - j);
                memcpy(array + to * size, array + from * size, columns * size);
            }
        }
    }
}
