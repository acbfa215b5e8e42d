/* The whole state of a solver in memory: how a host takes steps back. */
#ifndef ILSA_SNAPSHOT_H
#define ILSA_SNAPSHOT_H

#include <ilsa/solver.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Writes the solver's state into buffer[0 .. *size). Call it with buffer == NULL to learn *size,
 * then with a buffer of at least that size; on return *size is the number of bytes of the image.
 * The image serves the same build of the library on the same kind of machine.
 * ILSA_ERR_NULL, ILSA_ERR_STATE, ILSA_NO_SPACE (*size is set to what is needed).
 */
ILSA_API ilsa_status ilsa_snapshot_save(const ilsa_solver *solver, void *buffer, size_t *size);

/*
 * Puts a solver of the same definition into the state of an image: clock, fields, front, rates,
 * stress, cell size. Stepping on gives the same bits. Anything but ILSA_OK leaves the solver as it
 * was: ILSA_ERR_NULL, ILSA_ERR_SNAPSHOT (foreign, truncated, altered), ILSA_ERR_MISMATCH (of a
 * solver of another definition), ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_snapshot_restore(ilsa_solver *solver, const void *buffer, size_t size);

#ifdef __cplusplus
}
#endif
#endif
