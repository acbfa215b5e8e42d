#include "tip/tip_paths.h"

#include "base/memory.h"
#include <stdlib.h>

ilsa_status ilsai_tip_paths_reserve(tip_paths *p, int count) {
    const grown_array arrays[] = {ILSAI_GROWN(p->at)};
    return ilsai_grow((size_t)count, &p->capacity, arrays, 1);
}

void ilsai_tip_paths_destroy(tip_paths *p) {
    ilsai_release(p->at);
    *p = (tip_paths){0};
}

static int by_cell(const void *a, const void *b) {
    int first = ((const tip_path *)a)->cell, second = ((const tip_path *)b)->cell;
    return (first > second) - (first < second);
}

/* Moves the path at a place down a heap of count until the larger cells are above it. */
static void sink(tip_path *at, int place, int count) {
    tip_path moved = at[place];
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

void ilsai_tip_paths_sort(tip_paths *p) {
    for (int k = p->count / 2 - 1; k >= 0; k--) {
        sink(p->at, k, p->count);
    }
    for (int last = p->count - 1; last > 0; last--) {
        tip_path largest = p->at[0];
        p->at[0] = p->at[last];
        p->at[last] = largest;
        sink(p->at, 0, last);
    }
}

const tip_path *ilsai_tip_paths_find(const tip_paths *p, int cell) {
    tip_path key = {.cell = cell};
    return p->count > 0 ? bsearch(&key, p->at, (size_t)p->count, sizeof key, by_cell) : NULL;
}
