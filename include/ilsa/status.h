/* Status codes, one of which every function of libilsa that can fail returns. */
#ifndef ILSA_STATUS_H
#define ILSA_STATUS_H

#include <ilsa/export.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Zero: the call did its work. Positive: the call was right, but the fracture, the mesh or the
 * buffer did not allow it, and another step, mesh or buffer may. Negative: the call cannot be done
 * with these arguments, or there is no memory for it.
 *
 * A call that fails leaves every solver, mesh, material and stress as it was, bit for bit. The
 * exceptions are ilsa_advance, which keeps the steps that it has taken, and ilsa_advance_one, which
 * keeps a mesh that it has coarsened or grown. The counters of work, ilsa_summary.total and
 * ilsa_profile, count refused steps too.
 */
typedef enum ilsa_status {
    ILSA_OK = 0,
    ILSA_STEP_REJECTED = 1,  /* no solution was found for this dt: try a smaller one */
    ILSA_MESH_EDGE = 2,      /* the footprint would leave the mesh: coarsen or grow it */
    ILSA_STEP_TOO_LARGE = 3, /* the front would pass more cells than one step may: a smaller dt */
    ILSA_STALLED = 4,        /* an advance was refused too often, or down to the smallest step */
    ILSA_CLOSED = 5,         /* every cell is closed and nothing is injected: see ilsa_wait */
    ILSA_NO_SPACE = 6,       /* the caller's buffer is too small; the size needed was written */
    ILSA_ERR_NULL = -1,      /* a required pointer is NULL */
    ILSA_ERR_VALUE = -2,     /* an argument is NaN, infinite or out of its range */
    ILSA_ERR_MEMORY = -3,    /* an allocation failed; the call may be made again */
    ILSA_ERR_STATE = -4,     /* the solver's state does not allow the call: no fracture was started,
                                a source injects outside it, or ilsa_wait would miss something */
    ILSA_ERR_MISMATCH = -5,  /* handles or definitions that do not belong together */
    ILSA_ERR_SNAPSHOT = -6,  /* the image is foreign, truncated, altered or of another version */
    ILSA_ERR_NUMERIC = -7    /* reserved: no call returns it */
} ilsa_status;

/* A short English text for a status, never NULL. The text is static. */
ILSA_API const char *ilsa_status_text(ilsa_status status);

#ifdef __cplusplus
}
#endif
#endif
