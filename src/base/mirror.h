/*
 * A box of cells that is one side of a mirror image: where the axis lies, seen from the first
 * column (or row) of the box.
 */
#ifndef ILSAI_MIRROR_H
#define ILSAI_MIRROR_H

typedef enum mirror_axis {
    MIRROR_NONE,
    MIRROR_CENTRE, /* through the centres of the first cells, which are their own images */
    MIRROR_EDGE    /* along the outer edges of the first cells */
} mirror_axis;

/* How many offsets, from 0 on, the c cells of a box can have among each other and to images. */
static inline int ilsai_mirror_offsets(mirror_axis m, int c) {
    return m == MIRROR_NONE ? c : 2 * c;
}

/* How many cells cell i stands for: itself, and its image where that is another cell. */
static inline int ilsai_mirror_count(mirror_axis m, int i) {
    return m == MIRROR_EDGE || (m == MIRROR_CENTRE && i > 0) ? 2 : 1;
}

#endif
