/* The paths of the front through the tip cells: where it was since it entered each. */
#ifndef ILSAI_TIP_PATHS_H
#define ILSAI_TIP_PATHS_H

#include "tip/tip_cell.h"
#include <ilsa/status.h>
#include <stddef.h>

typedef struct tip_path {
    int cell;
    tip_cell_history history;
} tip_path;

typedef struct tip_paths {
    tip_path *at; /* in increasing order of cell once sorted */
    int count;
    size_t capacity;
} tip_paths;

/* Room for count paths, those present kept. ILSA_ERR_MEMORY. */
ilsa_status ilsai_tip_paths_reserve(tip_paths *p, int count);
void ilsai_tip_paths_destroy(tip_paths *p);

/* Sorts by cell, without asking for memory. */
void ilsai_tip_paths_sort(tip_paths *p);

/* The path through a cell of sorted paths, NULL if there is none. */
const tip_path *ilsai_tip_paths_find(const tip_paths *p, int cell);

#endif
