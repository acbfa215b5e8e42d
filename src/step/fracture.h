/*
 * The fracture: what is so at the end of the last accepted step, and all that a snapshot keeps of
 * it.
 *
 * Written by step/accept.c at the end of a step, and by start, coarsening and restore, which lay
 * another. A step that is refused has not written here.
 */
#ifndef ILSAI_FRACTURE_H
#define ILSAI_FRACTURE_H

#include "base/error.h"
#include "base/fields.h"
#include "model/model.h"
#include "tip/tip_paths.h"

typedef struct fracture {
    bool started;
    bool mirror_x, mirror_y; /* the fields are symmetric about x = 0, about y = 0 */
    double mu_prime;         /* viscosity: the material's, or the one that stands for none */
    double time;
    double dt;                          /* of the last step */
    double injected, leaked, volume;    /* volumes: injected = leaked + volume, of the fracture */
    double leak_rate;                   /* volume per time leaked in the last step */
    double width_most;                  /* the largest width so far */
    double front_change, front_advance; /* of the last step, in cells, see ilsa_report */
    box footprint;                      /* of the wet cells */
    int unknowns;                       /* of the last step */
    fields cells;
    tip_paths paths; /* through the tip cells; none without leak-off */
} fracture;

/* No fracture on a mesh of so many cells. ILSA_ERR_MEMORY. */
ilsa_status ilsai_fracture_create(fracture *f, const model *m);
void ilsai_fracture_destroy(fracture *f);

/* ILSA_ERR_STATE and a message unless a fracture has been started. */
ilsa_status ilsai_fracture_check(const fracture *f, error_text *error);

/* Empties the region of a fracture, so that another can be laid. */
void ilsai_fracture_clear(fracture *f, const ilsa_mesh_def *mesh);

/* The cells around a footprint that a step may touch: the advance and the band of distances. */
box ilsai_fracture_region(const ilsa_mesh_def *mesh, const box *footprint);

/* The distance beyond the front up to which levels are kept. */
double ilsai_fracture_band(const ilsa_mesh_def *mesh);

/* Tells survey cells, beside an empty or tip cell, from channel cells behind them, in a box. */
void ilsai_fracture_find_survey(const grid *g, const box *part, unsigned char *kind);

/* The width that a closed cell keeps, and the channel cells that are wider, or not. */
double ilsai_fracture_closure_width(const fracture *f, const model *m);
int ilsai_fracture_open_cells(const fracture *f, const model *m);
int ilsai_fracture_closed_cells(const fracture *f, const model *m);

#endif
