/* The solver's own data: what changes, what a step works with, and what stays. */
#ifndef ILSAI_STATE_H
#define ILSAI_STATE_H

#include "base/error.h"
#include "base/grid.h"
#include "elastic/elasticity.h"
#include "front/march.h"
#include "model/mesh.h"
#include "model/stress.h"
#include "solve/anderson.h"
#include "solve/coupled.h"
#include "tip/tip_cell.h"
#include <ilsa/ilsa.h>

/* Fields over the mesh. Cells out of reach: width, pressure, speed, leaked 0; level infinite. */
typedef struct fields {
    double *width;
    double *pressure; /* total fluid pressure */
    double *level;    /* signed distance to the front; in old channel cells what it last was */
    double *speed;    /* of the front, where it is or last was seen from the cell */
    double *trigger;  /* time at which the front passed the centre; only with leak-off */
    double *spread;   /* of the trigger time over the cell, see tipcell.h; only with leak-off */
    double *leaked;   /* volume leaked per area so far; only with leak-off */
    unsigned char *kind;
} fields;

/* Where the front has been in a tip cell; kept only with leak-off. */
typedef struct tip_record {
    int cell;
    tip_cell_history history;
} tip_record;

typedef struct tip_records {
    tip_record *at; /* in increasing order of cell */
    int count, capacity;
} tip_records;

/* All that a step changes, and all that a snapshot keeps besides the fields. */
typedef struct state {
    int started;
    int mirror_x, mirror_y; /* the fields are symmetric about x = 0, about y = 0 */
    double mu_prime;        /* viscosity: the material's, or what stands for none */
    double time;
    double dt_limit;                   /* longest step that the last rejection still allows */
    double injected, leaked, fracture; /* volumes */
    double front_change, front_advance;
    double dt;
    double leak_rate;  /* volume per time leaked in the last step */
    double width_most; /* the largest width so far */
    box footprint;     /* of the wet cells */
    int unknowns;
} state;

/* The cells that a point source feeds, and the part each takes. */
typedef struct point_source {
    ilsa_source_def def;
    int count;
    int cell[4];
    double part[4];
} point_source;

struct ilsa_solver {
    ilsa_mesh_def mesh;         /* as it is now */
    ilsa_material_def material; /* its viscosity is now.mu_prime once there is a fracture */
    int inviscid;               /* the material was given without viscosity */
    ilsa_material_def
        tip_material; /* the part of it that rules the width behind the front: the tip model */
    ilsa_stress *stress;
    point_source *sources;
    ilsa_solver_def def; /* options; its pointers are NULL */
    double step_cells, tolerance;
    tip_cell_velocity velocity; /* of the front that leak-off at it counts with */
    int stress_mirror_x, stress_mirror_y;

    state now;
    fields field;
    tip_records tips;

    /* work done with this handle, accepted or not; no part of the state */
    ilsa_report total;
    ilsa_profile profile;
    double crawl_time; /* since when refusals are counted */
    long crawl_refused;

    /* one step at work */
    grid g;
    box region;   /* cells that the step may touch */
    fields trial; /* trial.trigger and trial.leaked are unused: both change on acceptance */
    tip_records trial_tips;
    double *self_correction;    /* what the self terms of channel cells lack beside the march */
    double *source_term, *leak; /* per area in this step: S of (4.4), and the leaked part of it */
    double *retained;           /* what of leak does not, see contact.h; only with leak-off */
    unsigned char *contact;     /* which channel cells are closed, see contact.h */
    survey_cell *survey_cells;
    double *distance, *next_distance;
    int survey_count, survey_cell_capacity;
    sensitivity
        *sensitivities;  /* of survey cells, and of cells that the march reached, in this pass */
    double *width_slope; /* of each cell that the march reached: what an advance adds to its width;
                           of one at rest what its stress intensity has brought */
    int sensitivity_count, sensitivity_capacity;
    box trial_footprint;

    double *sigma;
    march *march;
    coupled *coupled;
    elasticity *elastic;
    anderson *acceleration;
    thread_pool *threads; /* that share the loops; NULL: the caller's own alone */
    error_text error;

    ilsa_front_point *front_points;
    size_t front_capacity;
    ilsa_survey_point *survey_points;
    size_t survey_capacity;
};

/* Fields: allocation, and setting every cell to empty. */
ilsa_status ilsai_fields_create(fields *f, const ilsa_mesh_def *mesh, int leak_off);
void ilsai_fields_destroy(fields *f);
void ilsai_fields_clear(fields *f, size_t count);
void ilsai_fields_clear_box(fields *f, const ilsa_mesh_def *mesh, const box *b);

/* Room for count records, those present kept. */
ilsa_status ilsai_asymptote_records_reserve(tip_records *r, int count);
/* The record of a cell, NULL if none. */
const tip_record *ilsai_asymptote_records_find(const tip_records *r, int cell);
void ilsai_asymptote_records_sort(tip_records *r);

/* ILSA_ERR_STATE and a message unless a fracture has been started. */
ilsa_status ilsai_check_started(const ilsa_solver *s, error_text *error);

/* The viscosity from now on: the material's, or what stands for none (see material.h). */
void ilsai_solver_set_viscosity(ilsa_solver *s, double mu_prime);

/* Cells and parts of every source on the mesh as it is now. */
void ilsai_sources_place(ilsa_solver *s);

/* Which mirrors the stress field has; fills s->sigma. ILSA_ERR_MISMATCH. */
ilsa_status ilsai_solver_fill_stress(ilsa_solver *s);

/* ILSA_ERR_MISMATCH and the thread's message if symmetry is asked for that the scene has not. */
ilsa_status ilsai_symmetry_check(const ilsa_solver *s);

/* The grid of the next step: folded as far as definition, sources, stress and state allow. */
grid ilsai_solver_grid(const ilsa_solver *s);

static inline int ilsai_has_leakoff(const ilsa_solver *s) {
    return s->material.C_prime > 0;
}

/* Cells around the footprint that a step may touch: the advance and the band of distances. */
box ilsai_solver_region(const ilsa_solver *s, const box *footprint);

/* Volume per time injected by all sources. */
double ilsai_injection_rate(const ilsa_solver *s);

/* Width of a closed cell, see contact.h, and the channel cells that are wider, or not. */
double ilsai_closure_width(const ilsa_solver *s);
int ilsai_open_cells(const ilsa_solver *s);
int ilsai_closed_cells(const ilsa_solver *s);

/* Distance beyond the front up to which levels are kept. */
double ilsai_solver_band(const ilsa_solver *s);

#endif
