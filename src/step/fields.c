#include "step/state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

ilsa_status ilsai_fields_create(fields *f, const ilsa_mesh_def *mesh, int leak_off) {
    size_t count = ilsai_mesh_cells(mesh);
    memset(f, 0, sizeof *f);
    f->width = malloc(count * sizeof(double));
    f->pressure = malloc(count * sizeof(double));
    f->level = malloc(count * sizeof(double));
    f->speed = malloc(count * sizeof(double));
    f->kind = malloc(count);
    if (leak_off) {
        f->trigger = malloc(count * sizeof(double));
        f->spread = malloc(count * sizeof(double));
        f->leaked = malloc(count * sizeof(double));
    }
    if (!f->width || !f->pressure || !f->level || !f->speed || !f->kind ||
        (leak_off && (!f->trigger || !f->spread || !f->leaked))) {
        ilsai_fields_destroy(f);
        return ILSA_ERR_MEMORY;
    }
    ilsai_fields_clear(f, count);
    return ILSA_OK;
}

void ilsai_fields_destroy(fields *f) {
    free(f->width);
    free(f->pressure);
    free(f->level);
    free(f->speed);
    free(f->trigger);
    free(f->spread);
    free(f->leaked);
    free(f->kind);
    memset(f, 0, sizeof *f);
}

static void clear_range(fields *f, size_t first, size_t count) {
    memset(f->width + first, 0, count * sizeof(double));
    memset(f->pressure + first, 0, count * sizeof(double));
    memset(f->speed + first, 0, count * sizeof(double));
    memset(f->kind + first, ILSA_CELL_EMPTY, count);
    for (size_t k = first; k < first + count; k++) {
        f->level[k] = INFINITY;
    }
    if (f->trigger) {
        memset(f->leaked + first, 0, count * sizeof(double));
        memset(f->spread + first, 0, count * sizeof(double));
        for (size_t k = first; k < first + count; k++) {
            f->trigger[k] = INFINITY;
        }
    }
}

void ilsai_fields_clear(fields *f, size_t count) {
    clear_range(f, 0, count);
}

void ilsai_fields_clear_box(fields *f, const ilsa_mesh_def *mesh, const box *b) {
    for (int j = b->y0; j <= b->y1; j++) {
        clear_range(f, (size_t)j * (size_t)mesh->nx + (size_t)b->x0, ilsai_box_columns(b));
    }
}

ilsa_status ilsai_asymptote_records_reserve(tip_records *r, int count) {
    if (count <= r->capacity) {
        return ILSA_OK;
    }
    size_t capacity = (size_t)count + (size_t)count / 2 + 16;
    tip_record *at = realloc(r->at, capacity * sizeof *at);
    if (!at) {
        return ILSA_ERR_MEMORY;
    }
    r->at = at;
    r->capacity = (int)capacity;
    return ILSA_OK;
}

static int by_cell(const void *a, const void *b) {
    int p = ((const tip_record *)a)->cell, q = ((const tip_record *)b)->cell;
    return (p > q) - (p < q);
}

/* Moves the record at a place down a heap of count until the larger cells are above it. */
static void sink(tip_record *at, int place, int count) {
    tip_record moved = at[place];
    for (int child = 2 * place + 1; child < count; child = 2 * place + 1) {
        child += child + 1 < count && at[child + 1].cell > at[child].cell;
        if (at[child].cell <= moved.cell) {
            break;
        }
        at[place] = at[child];
        place = child;
    }
    at[place] = moved;
}

/* In place: qsort may ask for memory. */
void ilsai_asymptote_records_sort(tip_records *r) {
    for (int k = r->count / 2 - 1; k >= 0; k--) {
        sink(r->at, k, r->count);
    }
    for (int last = r->count - 1; last > 0; last--) {
        tip_record largest = r->at[0];
        r->at[0] = r->at[last];
        r->at[last] = largest;
        sink(r->at, 0, last);
    }
}

const tip_record *ilsai_asymptote_records_find(const tip_records *r, int cell) {
    tip_record key = {.cell = cell};
    return r->count > 0 ? bsearch(&key, r->at, (size_t)r->count, sizeof key, by_cell) : NULL;
}
