/*
 * Boxes of cells that are one side of a mirror image: where the axis lies, seen from the first
 * column (or row) of the box.
 */
#ifndef ILSAI_MIRROR_H
#define ILSAI_MIRROR_H

/* None; through the centres of the first cells, which are their own images; along their edges. */
typedef enum mirror_axis { MIRROR_NONE, MIRROR_CENTRE, MIRROR_EDGE } mirror_axis;

/* Offsets 0, 1, ... that cells of a box of c have among each other and to images. */
static inline int ilsai_mirror_offsets(mirror_axis m, int c) {
    return m == MIRROR_NONE ? c : 2 * c;
}

/* Cells that cell i stands for: itself, and its image if that is another one. */
static inline int ilsai_mirror_count(mirror_axis m, int i) {
    return m == MIRROR_EDGE || (m == MIRROR_CENTRE && i > 0) ? 2 : 1;
}

#endif
