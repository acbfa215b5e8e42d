/*
 * The fixed rectangular mesh in the plane of the fracture.
 *
 * It has nx by ny cells of dx by dy and is centred on the origin; x points to the right and y
 * points up. Cell (i, j), 0 <= i < nx, 0 <= j < ny, has its centre at x = (i - (nx - 1) / 2) dx, y
 * = (j - (ny - 1) / 2) dy, where the divisions are not rounded. Every array over the mesh holds
 * cell (i, j) at index j * nx + i, so that rows follow each other from the lowest up.
 */
#ifndef ILSA_MESH_H
#define ILSA_MESH_H

#include <ilsa/status.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ilsa_mesh ilsa_mesh;

typedef struct ilsa_mesh_def {
    int nx, ny;    /* cells along x and y, 3 .. 1000000 each, at most 2^28 together; default 0 */
    double dx, dy; /* cell sizes, length, 1e-60 .. 1e60; dx / dy within 1e-3 .. 1e3; default 0 */
} ilsa_mesh_def;

/* Returns a definition of zeros, in which nx, ny, dx and dy must be set. */
ILSA_API ilsa_mesh_def ilsa_mesh_def_default(void);

/*
 * Makes a mesh. On success *mesh is a new handle, owned by the caller, to be destroyed with
 * ilsa_mesh_destroy; otherwise *mesh is NULL.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE, ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_mesh_create(const ilsa_mesh_def *def, ilsa_mesh **mesh);

/* Destroys *mesh and sets it to NULL. mesh == NULL and *mesh == NULL are allowed. */
ILSA_API void ilsa_mesh_destroy(ilsa_mesh **mesh);

/* Writes the definition that the mesh was made with. ILSA_ERR_NULL. */
ILSA_API ilsa_status ilsa_mesh_get_def(const ilsa_mesh *mesh, ilsa_mesh_def *def);

#ifdef __cplusplus
}
#endif
#endif
