/* Fields over the mesh, as the table fields.def lists them, and loops over that table. */
#ifndef ILSAI_FIELDS_H
#define ILSAI_FIELDS_H

#include "base/grid.h"
#include <ilsa/solver.h>
#include <math.h>
#include <stdbool.h>

/* More than any number of a fracture can come to from the magnitudes that a solver takes. */
#define FIELD_MOST 1e200

/* Who has a field; FIELD_LEAKOFF: only where the material leaks off. */
enum { FIELD_FRACTURE = 1, FIELD_TRIAL = 2, FIELD_LEAKOFF = 4 };

/* How a cell takes a field over from the cells of half its size that it covers. */
typedef enum coarsening {
    COARSEN_SUM,      /* per area: a quarter of the sum over the cells covered */
    COARSEN_WET_MEAN, /* the mean of those that are wet */
    COARSEN_CENTRE,   /* its value at the new centre */
    COARSEN_BY_FRONT, /* from where the front is in the new cell */
    COARSEN_NOT       /* no part of the fracture */
} coarsening;

/* Each an array over the mesh, NULL where the owner of the fields does not have it. */
typedef struct fields {
#define FIELD(name, type, empty, owner, coarsened, least) type *name;
#include "base/fields.def"
#undef FIELD
} fields;

enum {
#define FIELD(name, type, empty, owner, coarsened, least) FIELD_##name,
#include "base/fields.def"
#undef FIELD
    FIELD_COUNT
};

/* A row of the table. */
typedef struct field_row {
    const char *name;
    size_t size;  /* of a value: a double, or a byte */
    double empty; /* value in a cell that the fracture has not reached */
    int owner;
    coarsening coarsened;
    double least;
} field_row;

extern const field_row ilsai_field_rows[FIELD_COUNT];

/* The array of a row, NULL if the fields do not have it. */
void *ilsai_field(const fields *f, int row);

/* Makes the fields of one owner for a number of cells, all empty. ILSA_ERR_MEMORY. */
ilsa_status ilsai_fields_create(fields *f, size_t cells, int owner, bool leakoff);
void ilsai_fields_destroy(fields *f);

/* Empties the cells of a box of a mesh of nx columns. */
void ilsai_fields_clear(fields *f, int nx, const box *b);

/* Copies the cells of a box, in every field that both have. */
void ilsai_fields_copy(fields *to, const fields *from, int nx, const box *b);

/* Gives the mirror images of the representative cells in a box, as symmetric as the grid, their
 * values. */
void ilsai_fields_unfold(fields *f, const grid *g, const box *b);

/* Whether a cell of this kind is full: a survey cell or one behind them. */
static inline bool ilsai_is_channel(unsigned char kind) {
    return kind >= ILSA_CELL_SURVEY;
}

#endif
