/*
 * The whole state of a solver in memory, with which a host takes steps back.
 *
 * An image holds the clock, the fields, the front, the rates, the stress and the cell size. It
 * serves the same build of the library on the same kind of machine.
 */
#ifndef ILSA_SNAPSHOT_H
#define ILSA_SNAPSHOT_H

#include <ilsa/solver.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Writes an image of the solver's state into a buffer. *size is read and written: it holds the
 * bytes that the buffer has, and on return the bytes of the image. With buffer == NULL it is
 * written alone, so that a first call tells how large a buffer is needed. A buffer that is too
 * small is left as it was, and *size holds the bytes that are needed. ILSA_ERR_NULL,
 * ILSA_ERR_STATE, ILSA_NO_SPACE.
 */
ILSA_API ilsa_status ilsa_snapshot_save(const ilsa_solver *solver, void *buffer, size_t *size);

/*
 * Puts a solver into the state of an image, which must be of a solver of the same definition; the
 * number of threads alone may differ. Stepping on gives the bits that the first solver would give.
 * Any status but ILSA_OK leaves the solver as it was: ILSA_ERR_NULL, ILSA_ERR_SNAPSHOT for an image
 * that is foreign, truncated or altered, ILSA_ERR_MISMATCH for one of another definition,
 * ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_snapshot_restore(ilsa_solver *solver, const void *buffer, size_t size);

#ifdef __cplusplus
}
#endif
#endif
