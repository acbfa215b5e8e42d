/*
 * What the host says: mesh, material, options, sources and far-field stress.
 *
 * Written by api/ alone, from the definition and by the host's calls between steps; but coarsening
 * doubles the cells, growth adds some, and restoring a snapshot takes rates, stress and cells from
 * it. A step reads.
 */
#ifndef ILSAI_MODEL_H
#define ILSAI_MODEL_H

#include "base/error.h"
#include "base/grid.h"
#include "model/sources.h"
#include "model/stress.h"
#include <ilsa/solver.h>
#include <stdbool.h>

typedef struct model {
    ilsa_solver_def
        options;           /* as given, level = 0 replaced by its default; its pointers are NULL */
    ilsa_mesh_def defined; /* the mesh as given */
    ilsa_mesh_def mesh;    /* as it is now */
    ilsa_material_def material;     /* its viscosity is the fracture's once there is one */
    ilsa_material_def tip_material; /* without the processes that the tip model leaves out */
    bool inviscid;                  /* the material was given without viscosity */
    sources sources;
    cell_field stress;
    double *sigma;                       /* the stress in each cell of the mesh */
    bool sigma_is_uniform;               /* in all cells */
    bool sigma_mirror_x, sigma_mirror_y; /* bit for bit, about x = 0, about y = 0 */
} model;

/* Copies a definition that has been checked. ILSA_ERR_MEMORY; *m is to be destroyed in any case. */
ilsa_status ilsai_model_create(model *m, const ilsa_solver_def *def);
void ilsai_model_destroy(model *m);

/* Sets the viscosity in use: the material's, or the one that stands for none (ilsa/material.h). */
void ilsai_model_set_viscosity(model *m, double mu_prime);

/*
 * Evaluates a stress field on the mesh into sigma, and finds its symmetry. ILSA_ERR_MISMATCH,
 * ILSA_ERR_VALUE, the message is the calling thread's; the model is then as it was.
 */
ilsa_status ilsai_model_fill_stress(model *m);

/* The most cells that the mesh may grow to. */
double ilsai_model_cells_max(const model *m);

/* Whether fluid leaks off at all. */
static inline bool ilsai_model_leaks(const model *m) {
    return m->material.C_prime > 0;
}

/* ILSA_ERR_MISMATCH and a message if the options ask for a symmetry that the model has not. */
ilsa_status ilsai_model_check_symmetry(const model *m, error_text *error);

/* The mesh, folded as far as options, sources and stress allow a fracture with these mirrors. */
grid ilsai_model_grid(const model *m, bool mirror_x, bool mirror_y);

#endif
