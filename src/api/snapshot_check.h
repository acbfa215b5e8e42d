/* Whether what an image of a solver says can be the state of one. */
#ifndef ILSAI_SNAPSHOT_CHECK_H
#define ILSAI_SNAPSHOT_CHECK_H

#include "step/state.h"

/* Flags 0 or 1, numbers finite and in their ranges, the footprint off the edge of the mesh. */
int ilsai_snapshot_state_is_sound(const state *now, const ilsa_mesh_def *mesh);

/* A path in a cell of the mesh: its knots in order, none after now. */
int ilsai_snapshot_record_is_sound(const tip_record *record, size_t cells, double now);

/*
 * The fields of a region as they lie in an image, one after the other and not aligned: width,
 * pressure, level, speed, kind, and with leak-off trigger, spread, leaked.
 */
typedef struct snapshot_fields {
    const unsigned char *at;
    box region, footprint;
    int leak_off;
} snapshot_fields;

/*
 * No cell is wet outside the footprint; channel cells have a width, dry ones none and no pressure;
 * the centres of dry cells lie beyond the front, those of channel cells behind it; survey cells are
 * those at the rim of the channel, and there is one.
 */
int ilsai_snapshot_fields_are_sound(const snapshot_fields *f);

#endif
