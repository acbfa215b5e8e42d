/* Status codes: what every fallible function of libilsa returns. */
#ifndef ILSA_STATUS_H
#define ILSA_STATUS_H

#include <ilsa/export.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * 0: done. Positive: nothing was changed, try otherwise. Negative: the call or the handle cannot
 * be used as it stands; nothing was changed either.
 */
typedef enum ilsa_status {
    ILSA_OK = 0,
    ILSA_STEP_REJECTED = 1, /* no solution was found for this dt: try a smaller one */
    ILSA_MESH_EDGE = 2,     /* the footprint would leave the mesh: coarsen, or take a larger mesh */
    ILSA_STEP_TOO_LARGE = 3, /* the front would pass more cells than one step may: a smaller dt */
    ILSA_STALLED = 4,        /* advance: steps are refused down to the smallest, or without end */
    ILSA_CLOSED = 5,         /* every cell is closed and nothing is injected: see ilsa_wait */
    ILSA_NO_SPACE = 6,       /* the caller's buffer is too small; the size needed was written */
    ILSA_ERR_NULL = -1,      /* a required pointer is NULL */
    ILSA_ERR_VALUE = -2,     /* an argument is NaN, infinite or out of its range */
    ILSA_ERR_MEMORY = -3,    /* an allocation failed */
    ILSA_ERR_STATE = -4,     /* the call needs a fracture: start one first */
    ILSA_ERR_MISMATCH = -5,  /* handles or definitions that do not belong together */
    ILSA_ERR_SNAPSHOT = -6,  /* the image is foreign, truncated, altered or of another version */
    ILSA_ERR_NUMERIC = -7    /* a factorisation or transform failed inside the library */
} ilsa_status;

/* A short English text for a status; never NULL. The text is static. */
ILSA_API const char *ilsa_status_text(ilsa_status status);

#ifdef __cplusplus
}
#endif
#endif
