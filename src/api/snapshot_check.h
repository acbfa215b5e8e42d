/* Whether what a snapshot says can be so of a fracture. */
#ifndef ILSAI_SNAPSHOT_CHECK_H
#define ILSAI_SNAPSHOT_CHECK_H

#include "step/fracture.h"

/* Numbers finite and in their ranges, the footprint off the edge of the mesh. */
bool ilsai_snapshot_fracture_is_sound(const fracture *f, const ilsa_mesh_def *mesh);

/* A path through a cell of the mesh: its knots in order, none after now. */
bool ilsai_snapshot_path_is_sound(const tip_path *path, size_t cells, double now);

/* Whether a snapshot holds a field of the table, with or without leak-off. */
bool ilsai_snapshot_has(int row, bool leakoff);

/* The fields of a region as they lie in a snapshot, in the order of the table and not aligned. */
typedef struct snapshot_fields {
    const unsigned char *at;
    box region, footprint;
    bool leakoff;
} snapshot_fields;

/*
 * Whether no cell is wet outside the footprint; channel cells have a width, dry ones none and no
 * pressure; the centres of dry cells lie beyond the front, those of channel cells behind it; survey
 * cells are the channel cells beside others, and there is one.
 */
bool ilsai_snapshot_fields_are_sound(const snapshot_fields *f);

#endif
