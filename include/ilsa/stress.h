/*
 * The far-field stress normal to the plane of the fracture, positive in compression: one value,
 * horizontal layers, or a value per cell. A solver takes stresses of -1e60 .. 1e60.
 */
#ifndef ILSA_STRESS_H
#define ILSA_STRESS_H

#include <ilsa/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ilsa_stress ilsa_stress;

typedef struct ilsa_stress_def {
    double sigma; /* uniform stress to begin with, finite; default 0 */
} ilsa_stress_def;

/* Returns a definition of zero stress. */
ILSA_API ilsa_stress_def ilsa_stress_def_default(void);

/*
 * Makes a uniform stress field. On success *stress is a new handle owned by the caller, to be
 * destroyed with ilsa_stress_destroy; otherwise *stress is NULL.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE, ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_stress_create(const ilsa_stress_def *def, ilsa_stress **stress);

/* Destroys *stress and sets it to NULL. stress == NULL and *stress == NULL are allowed. */
ILSA_API void ilsa_stress_destroy(ilsa_stress **stress);

/* Sets one finite value everywhere. ILSA_ERR_NULL, ILSA_ERR_VALUE. */
ILSA_API ilsa_status ilsa_stress_set_uniform(ilsa_stress *stress, double sigma);

/*
 * Sets horizontal layers: interface_count >= 1 interfaces at y[0] < y[1] < ..., and
 * interface_count + 1 stresses sigma[] from the bottom layer up; y points up. A cell cut by an
 * interface takes the mean over its height. Both arrays are copied.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE (not finite, not increasing, no interface), ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_stress_set_layers(ilsa_stress *stress, int interface_count,
                                            const double *y, const double *sigma);

/*
 * Sets a value per cell of a mesh, sigma[j * nx + i], finite. The array is copied. A solver on
 * another mesh refuses the stress with ILSA_ERR_MISMATCH.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE, ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_stress_set_cells(ilsa_stress *stress, const ilsa_mesh *mesh,
                                           const double *sigma);

#ifdef __cplusplus
}
#endif
#endif
