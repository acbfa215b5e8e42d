/* The stress field as the solver sees it: values per cell, coarsening, its image in a snapshot. */
#ifndef ILSAI_STRESS_H
#define ILSAI_STRESS_H

#include <ilsa/stress.h>
#include <stddef.h>

typedef enum stress_kind { STRESS_UNIFORM, STRESS_LAYERS, STRESS_CELLS } stress_kind;

struct ilsa_stress {
    stress_kind kind;
    int interfaces;     /* of layers, otherwise 0 */
    ilsa_mesh_def mesh; /* of cells, otherwise zero */
    double sigma;       /* uniform, otherwise 0 */
    double *values;     /* layers: interfaces y, then interfaces + 1 stresses; cells: nx ny */
};

/*
 * Where these fail, the message is the calling thread's.
 * ILSA_ERR_MEMORY, *copy is NULL.
 */
ilsa_status ilsai_stress_copy(const ilsa_stress *from, ilsa_stress **copy);

/* Nonzero if the field has more than one value. */
int ilsai_stress_varies(const ilsa_stress *stress);

/*
 * The field on a mesh, nx ny values. A cell cut by interfaces takes the mean over its height;
 * layers that mirror each other about y = 0 give values that do so bit for bit.
 * ILSA_ERR_MISMATCH if it is per cell of another mesh, ILSA_ERR_VALUE if a value is too large for
 * a solver; sigma is then as it was.
 */
ilsa_status ilsai_stress_fill(const ilsa_stress *stress, const ilsa_mesh_def *mesh, double *sigma);

/*
 * A field per cell goes to cells twice as large, the same counts, around the origin: each takes
 * the area-weighted mean of the old cells it covers, or the nearest one's value beyond the old
 * mesh. Other fields need no change. ILSA_ERR_MEMORY, the field is then as it was.
 */
ilsa_status ilsai_stress_coarsen(ilsa_stress *stress);

/* Flat image, for the same build on the same kind of machine: every byte of it is defined. */
size_t ilsai_stress_image_size(const ilsa_stress *stress);
void ilsai_stress_write(const ilsa_stress *stress, unsigned char *image);

/*
 * The field of the image at the start of size bytes (what follows it is not looked at).
 * ILSA_ERR_SNAPSHOT for a malformed or truncated one, ILSA_ERR_MEMORY; *stress is then NULL.
 */
ilsa_status ilsai_stress_read(const unsigned char *image, size_t size, ilsa_stress **stress);

#endif
