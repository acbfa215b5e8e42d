/* The fields over the mesh at one time: for ParaView, and along two lines for the figures. */
#ifndef ILSA_RUN_FIELDS_H
#define ILSA_RUN_FIELDS_H

#include <ilsa/ilsa.h>

/* What the solver holds over its mesh now; trigger is NULL in a scene without leak-off. */
typedef struct fields {
    ilsa_mesh_def mesh;
    const double *width, *pressure, *stress, *trigger;
    const unsigned char *kind;
} fields;

/* Each returns 1, or 0 with a message on stderr. */
int fields_get(fields *f, const ilsa_solver *solver);

/* fields_NNN.vti: VTK ImageData with cell data. */
int fields_write_vti(const fields *f, const char *directory, int number);

/*
 * line_x_NNN.csv, line_y_NNN.csv: the row and the column of cells through (x, y), from the first
 * to the last cell of the footprint. The pressure of a dry cell between them is nan.
 */
int fields_write_lines(const fields *f, const char *directory, int number, double x, double y);

#endif
