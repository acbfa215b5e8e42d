/*
 * A property over the plane of the fracture: one value, horizontal layers, or a value per cell of a
 * mesh. The far-field stress is one.
 */
#ifndef ILSAI_CELL_FIELD_H
#define ILSAI_CELL_FIELD_H

#include "base/error.h"
#include <ilsa/mesh.h>
#include <stdbool.h>
#include <stddef.h>

typedef enum cell_field_kind { FIELD_UNIFORM, FIELD_LAYERS, FIELD_CELLS } cell_field_kind;

/* All zero: uniform zero, which holds no memory. */
typedef struct cell_field {
    cell_field_kind kind;
    int interfaces;     /* of layers, otherwise 0 */
    ilsa_mesh_def mesh; /* of cells, otherwise zero */
    double uniform;     /* the one value, otherwise 0 */
    double *values;     /* layers: interfaces y, then interfaces + 1 values; cells: nx ny */
} cell_field;

/*
 * Sets a field anew; on failure it stays as it was. name and y_name are what messages, which are
 * the calling thread's, call the values and the interfaces. ILSA_ERR_VALUE, ILSA_ERR_MEMORY.
 */
ilsa_status ilsai_cell_field_set_uniform(cell_field *f, const char *name, double value);
ilsa_status ilsai_cell_field_set_layers(cell_field *f, const char *name, int interfaces,
                                        const double *y, const double *values);
ilsa_status ilsai_cell_field_set_cells(cell_field *f, const char *name, const ilsa_mesh_def *mesh,
                                       const double *values);

/* Makes *copy, which must hold no memory, like another field. ILSA_ERR_MEMORY, *copy is zero. */
ilsa_status ilsai_cell_field_copy(const cell_field *from, cell_field *copy);

/* Releases what the field holds and makes it zero. */
void ilsai_cell_field_clear(cell_field *f);

/* Whether the field has more than one value. */
bool ilsai_cell_field_varies(const cell_field *f);

/*
 * Evaluates the field on a mesh, nx ny values. A cell cut by interfaces takes the mean over its
 * height; layers that mirror each other about y = 0 give values that do so bit for bit.
 * ILSA_ERR_MISMATCH if it is per cell of another mesh, ILSA_ERR_VALUE if a value is too large for a
 * solver; out is then as it was. name is what the message calls the field.
 */
ilsa_status ilsai_cell_field_fill(const cell_field *f, const char *name, const ilsa_mesh_def *mesh,
                                  double *out);

/* The height of the layer that holds y, with neighbours of its value; infinite where it has no end,
 * and where there are no layers. */
double ilsai_cell_field_layer(const cell_field *f, double y);

/*
 * Takes a field per cell to cells that are larger by factors of 1 or 2, the same counts, around the
 * origin: each takes the area-weighted mean of the old cells it covers, or the nearest one's value
 * beyond the old mesh. Other fields need no change. ILSA_ERR_MEMORY, the field is then as it was.
 */
ilsa_status ilsai_cell_field_coarsen(cell_field *f, int factor_x, int factor_y);

/*
 * Takes a field per cell to a mesh with columns more on either side and rows more below and above,
 * each of which takes the value of the nearest cell. Other fields need no change. ILSA_ERR_MEMORY,
 * the field is then as it was.
 */
ilsa_status ilsai_cell_field_grow(cell_field *f, int columns, int rows);

/* Flat form for a snapshot, every byte of which is defined: its size, and writing it. */
size_t ilsai_cell_field_flat_size(const cell_field *f);
void ilsai_cell_field_write(const cell_field *f, unsigned char *flat);

/*
 * Reads the field at the start of size bytes (later ones are not looked at) into *f, which must
 * hold no memory. ILSA_ERR_SNAPSHOT for a malformed or truncated one, ILSA_ERR_MEMORY; *f is then
 * zero.
 */
ilsa_status ilsai_cell_field_read(const unsigned char *flat, size_t size, cell_field *f);

#endif
