/*
 * The solver: one planar fracture on one mesh, stepped by the host's clock.
 *
 * A solver copies the mesh, material, stress and sources that it is created with and owns all that
 * changes afterwards, so those handles may be destroyed or reused at once. Solvers are independent
 * of each other; one solver is used by one thread at a time, and has threads of its own only where
 * its definition asks for them. Units are any consistent set in which cell sizes, material
 * parameters, stresses, rates and times are at most 1e60, and at least 1e-60 where they may not be
 * zero.
 */
#ifndef ILSA_SOLVER_H
#define ILSA_SOLVER_H

#include <ilsa/material.h>
#include <ilsa/mesh.h>
#include <ilsa/stress.h>
#include <ilsa/tip.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ilsa_solver ilsa_solver;

/* A point source, held by the cell that contains it. */
typedef struct ilsa_source_def {
    double x, y; /* on the mesh */
    double rate; /* volume per time, >= 0; may be changed by ilsa_set_rate */
} ilsa_source_def;

/*
 * What the width behind the front follows (section 3): in the inversion of survey cells (4.9) and
 * in the volume of tip cells (4.18). Flow and leak-off are the material's whatever the choice. So
 * is the start from a penny, and so are the regimes: they are where the full asymptote is at a
 * cell's distance and velocity. The full one is for use, the others are there to see
 * what it is worth.
 */
typedef enum ilsa_tip_model {
    ILSA_TIP_FULL = 0,                /* toughness, viscosity, leak-off: (3.15) */
    ILSA_TIP_TOUGHNESS_VISCOSITY = 1, /* (3.15) with C' = 0 */
    ILSA_TIP_TOUGHNESS = 2            /* LEFM, (2.6): K' s^(1/2) / E'; K' > 0, else refused */
} ilsa_tip_model;

/* Which mirror symmetry of the scene is used to solve a half or a quarter of it. */
typedef enum ilsa_symmetry {
    ILSA_SYMMETRY_AUTO = 0, /* whatever the sources, the stress and the state allow */
    ILSA_SYMMETRY_NONE = 1,
    ILSA_SYMMETRY_X = 2, /* x -> -x; a scene without it is refused */
    ILSA_SYMMETRY_Y = 3, /* y -> -y */
    ILSA_SYMMETRY_XY = 4 /* both */
} ilsa_symmetry;

/* How the front and the widths of a step find each other. */
typedef enum ilsa_front_loop {
    ILSA_LOOP_COUPLED = 0, /* predicted, then one Newton iteration for both */
    ILSA_LOOP_NESTED =
        1 /* from where it was, widths solved for every place of the front, which is
             then moved to where they want it: the plain algorithm, to compare with */
} ilsa_front_loop;

/* How the Newton system of a step is solved. */
typedef enum ilsa_linear_solver {
    ILSA_LINEAR_AUTO = 0,  /* by the number of unknowns */
    ILSA_LINEAR_GMRES = 1, /* GMRES, preconditioned by multigrid and the near field of elasticity */
    ILSA_LINEAR_DENSE = 2  /* LU of the full matrix */
} ilsa_linear_solver;

/* How the elasticity product is computed. */
typedef enum ilsa_product {
    ILSA_PRODUCT_AUTO = 0, /* FFT where the library was built with it, BLAS otherwise */
    ILSA_PRODUCT_FFT = 1,
    ILSA_PRODUCT_BLAS = 2
} ilsa_product;

typedef struct ilsa_solver_def {
    const ilsa_mesh *mesh;          /* required */
    const ilsa_material *material;  /* required */
    const ilsa_stress *stress;      /* NULL: zero stress */
    const ilsa_source_def *sources; /* source_count of them, required */
    int source_count;               /* 1 .. 1000; default 0 */
    int level;                      /* 1 fast .. 5 accurate; default 3 */
    ilsa_tip_model tip;             /* default ILSA_TIP_FULL */
    ilsa_symmetry symmetry;         /* default ILSA_SYMMETRY_AUTO */
    ilsa_front_loop loop;           /* default ILSA_LOOP_COUPLED */
    ilsa_linear_solver linear;      /* default ILSA_LINEAR_AUTO */
    ilsa_product product;           /* default ILSA_PRODUCT_AUTO */
    int coarsen;                    /* 1: ilsa_advance coarsens the mesh at its edge; default 0 */
    int threads;          /* 1 .. 64 that a step uses, the caller's included; default 0: as 1 */
    double step_cells;    /* front advance of a suggested step, in cells, 0.01 .. 1; 0: level */
    double tolerance;     /* of the front, in cells, 1e-12 .. 0.1; 0: by level */
    double dt_max;        /* longest suggested step, time, > 0; 0: no limit */
    double closure_width; /* that a closed cell keeps, length; 0: 1e-4 of the largest ever */
} ilsa_solver_def;

/* A definition with the defaults above; mesh, material and sources must be given. */
ILSA_API ilsa_solver_def ilsa_solver_def_default(void);

/*
 * Makes a solver without a fracture. On success *solver is a new handle owned by the caller, to be
 * destroyed with ilsa_solver_destroy; otherwise *solver is NULL.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE, ILSA_ERR_MEMORY (also where the system gives no more threads),
 * ILSA_ERR_MISMATCH (per-cell stress of another mesh, symmetry asked for that the scene has not,
 * ILSA_TIP_TOUGHNESS for a material that has none, a product that the library was built without).
 *
 * Memory that fails gives ILSA_ERR_MEMORY in every call, with two exceptions in the libraries
 * below. FFTW ends the process when it cannot plan: what a plan needs is asked for first, but
 * another thread may take it in between. OpenBLAS maps a buffer (128 MB in 0.3.21) in the first
 * larger call of a thread while others are in one; refused, it tries for ever, since 0.3.30 it ends
 * the process. Under a limit of the address space call it once (cblas_dgemm) before the limit is
 * set.
 */
ILSA_API ilsa_status ilsa_solver_create(const ilsa_solver_def *def, ilsa_solver **solver);

/* Destroys *solver and sets it to NULL. NULL and *solver == NULL are allowed. */
ILSA_API void ilsa_solver_destroy(ilsa_solver **solver);

/*
 * What went wrong in the last call that failed on this solver, naming the argument and its value;
 * "" when none has. Valid until the next call. NULL gives the message of the last call of this
 * thread that failed with no solver to keep it: a create, a call on a mesh, material or stress, and
 * every call that takes a const solver (it only reads) or NULL for one.
 */
ILSA_API const char *ilsa_last_error(const ilsa_solver *solver);

/*
 * Starts from the penny-shaped fracture of the solver's own material around its first source, at
 * that source's rate (> 0): of the given radius, or at the given time since the start of injection.
 * The clock is set to that solution's time. The radius must be at least 2 cells and the fracture
 * must lie inside the mesh. A fracture that was there before is replaced.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE, ILSA_ERR_MEMORY, ILSA_MESH_EDGE.
 */
ILSA_API ilsa_status ilsa_start_radial(ilsa_solver *solver, double radius);
ILSA_API ilsa_status ilsa_start_radial_at(ilsa_solver *solver, double time);

/* Sets the rate of source 0 .. source_count - 1 from now on, >= 0. ILSA_ERR_NULL, _VALUE. */
ILSA_API ilsa_status ilsa_set_rate(ilsa_solver *solver, int source, double rate);

/* Takes a copy of another stress field from now on. ILSA_ERR_NULL, _VALUE, _MISMATCH, _MEMORY. */
ILSA_API ilsa_status ilsa_set_stress(ilsa_solver *solver, const ilsa_stress *stress);

/* What a step, or an advance of many steps, did. */
typedef struct ilsa_report {
    double time;              /* at the end */
    double dt;                /* of the last accepted step */
    long steps;               /* accepted */
    long rejected;            /* tried and not accepted */
    long front_iterations;    /* passes of the front loop, rejected steps included, as below */
    long newton_iterations;   /* linear systems solved */
    long krylov_iterations;   /* GMRES iterations */
    long elasticity_products; /* products with the elasticity matrix */
    long coarsened;           /* times the mesh was coarsened */
    double front_change;      /* last change of the front in the last step, in cells */
    double front_advance;     /* largest advance of the front in the last step, in cells */
    double seconds;           /* wall time */
} ilsa_report;

/*
 * Takes one step of exactly dt > 0 by backward Euler (4.4). Where the width would fall under the
 * closure width a cell closes: it keeps that width, its faces carry what of the closure stress the
 * fluid does not, it leaks what it had and then nothing, and it opens again when the pressure of
 * the fluid exceeds the closure stress. The front before closed cells rests. Any status other than
 * ILSA_OK leaves the solver bit for bit as it was: ILSA_STEP_REJECTED, ILSA_STEP_TOO_LARGE,
 * ILSA_MESH_EDGE, ILSA_CLOSED, ILSA_ERR_NULL, ILSA_ERR_VALUE, ILSA_ERR_STATE, ILSA_ERR_MEMORY,
 * ILSA_ERR_NUMERIC. report may be NULL; it is written in any case but for NULL solvers.
 */
ILSA_API ilsa_status ilsa_step(ilsa_solver *solver, double dt, ilsa_report *report);

/* The step that moves the front by step_cells cells, from the last velocities; at most dt_max. */
ILSA_API ilsa_status ilsa_suggest_dt(const ilsa_solver *solver, double *dt);

/*
 * One accepted step of the solver's own choice that does not pass t_limit > time, rejected steps
 * tried again with half the step; coarsens at the mesh edge if the definition says so. The last
 * step before t_limit lands exactly on it. The statuses of ilsa_step, and ILSA_STALLED.
 */
ILSA_API ilsa_status ilsa_advance_one(ilsa_solver *solver, double t_limit, ilsa_report *report);

/*
 * As many such steps as it takes to land exactly on t_end > time. On a status other than ILSA_OK
 * the solver stands at the last accepted step. report sums over the steps; it may be NULL.
 */
ILSA_API ilsa_status ilsa_advance(ilsa_solver *solver, double t_end, ilsa_report *report);

/*
 * Lets time pass up to t > time in a fracture where nothing happens: every cell is closed and
 * nothing is injected, which a step answers with ILSA_CLOSED. Only the clock moves.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE, ILSA_ERR_STATE where something would happen.
 */
ILSA_API ilsa_status ilsa_wait(ilsa_solver *solver, double t);

/*
 * Moves the state to cells twice as large, the same number of cells: volume and leaked volume are
 * conserved to rounding, trigger times and velocity histories carried over (end of section 5.1).
 * ILSA_ERR_NULL, ILSA_ERR_STATE, ILSA_ERR_VALUE (footprint under 4 of the new cells across),
 * ILSA_ERR_MEMORY. All pointers handed out before are invalid afterwards.
 */
ILSA_API ilsa_status ilsa_coarsen(ilsa_solver *solver);

/* The mesh that the solver stands on now, changed only by ilsa_coarsen and snapshots. */
ILSA_API ilsa_status ilsa_get_mesh_def(const ilsa_solver *solver, ilsa_mesh_def *def);

/* Time since the start of injection. ILSA_ERR_NULL; ILSA_ERR_STATE without a fracture, as below. */
ILSA_API ilsa_status ilsa_get_time(const ilsa_solver *solver, double *time);

/*
 * Fields over the mesh, read without a copy: nx * ny values, owned by the solver, valid until the
 * next call that changes it. Width: 0 outside the footprint; in a tip cell the cell's mean.
 * Pressure: of the fluid, total (not net), in closed cells that of what is caught in them; in cells
 * outside the footprint 0.
 * Stress: the far-field stress the solver uses.
 */
ILSA_API ilsa_status ilsa_get_width(const ilsa_solver *solver, const double **width);
ILSA_API ilsa_status ilsa_get_pressure(const ilsa_solver *solver, const double **pressure);
ILSA_API ilsa_status ilsa_get_stress(const ilsa_solver *solver, const double **stress);

/*
 * When the front passed the centre of each cell; infinite where it has not. *trigger is NULL when
 * the material has no leak-off, which keeps no such times.
 */
ILSA_API ilsa_status ilsa_get_trigger_time(const ilsa_solver *solver, const double **trigger);

/* What a cell is; the values of ilsa_get_cell_kinds. */
enum { ILSA_CELL_EMPTY = 0, ILSA_CELL_TIP = 1, ILSA_CELL_SURVEY = 2, ILSA_CELL_CHANNEL = 3 };

/* The kind of each of the nx * ny cells; survey cells are channel cells with a tip neighbour. */
ILSA_API ilsa_status ilsa_get_cell_kinds(const ilsa_solver *solver, const unsigned char **kind);

/* A point of the front. */
typedef struct ilsa_front_point {
    double x, y;            /* position */
    double V;               /* normal velocity over the last step, >= 0 */
    ilsa_tip_regime regime; /* of the survey cell nearest */
    int loop;               /* closed curves are numbered from 0, the longest first */
} ilsa_front_point;

/*
 * The front as closed polylines, counter-clockwise around fluid, the first point not repeated:
 * count points, owned by the solver, valid until the next call on it. Computed on demand, the
 * state itself is not changed. ILSA_ERR_NULL, ILSA_ERR_STATE, ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_get_front(ilsa_solver *solver, const ilsa_front_point **points,
                                    size_t *count);

/* A survey cell: where the tip asymptote ties the width to the front. */
typedef struct ilsa_survey_point {
    int cell;               /* index into the mesh arrays */
    double x, y;            /* centre */
    double s;               /* distance to the front */
    double w;               /* width */
    double V;               /* velocity of the front seen from this cell, >= 0 */
    ilsa_tip_regime regime; /* place in the parametric triangle */
} ilsa_survey_point;

/* The survey cells: as ilsa_get_front. */
ILSA_API ilsa_status ilsa_get_survey(ilsa_solver *solver, const ilsa_survey_point **points,
                                     size_t *count);

/* Numbers that describe the whole fracture. */
typedef struct ilsa_summary {
    double time;
    double x_min, x_max, y_min, y_max; /* where the front crosses the lines through source 0 */
    double extent_x_min, extent_x_max, extent_y_min, extent_y_max; /* of the whole footprint */
    double width_source, pressure_source;                          /* in the cell of source 0 */
    double volume_injected, volume_fracture, volume_leaked;
    double efficiency;                                  /* volume_fracture / volume_injected */
    double V_max;                                       /* fastest point of the front */
    int cells, tip_cells, survey_cells, arrested_cells; /* survey cells at rest: V = 0 */
    int closed_cells;     /* survey and channel cells whose faces touch */
    double closure_width; /* the width that such cells keep */
    int unknowns;         /* of the last step: after symmetry */
    ilsa_report total;    /* since the start; seconds, steps and iterations summed */
} ilsa_summary;

ILSA_API ilsa_status ilsa_get_summary(const ilsa_solver *solver, ilsa_summary *summary);

/* What the scene made the solver model, and what it left out. */
typedef struct ilsa_model {
    int leak_off, toughness, stress_varies; /* 0 or 1 */
    ilsa_tip_model tip;                     /* as in the definition */
    ilsa_symmetry symmetry;                 /* used now: NONE, X, Y or XY */
    ilsa_product product;                   /* FFT or BLAS */
    int level;
    int threads;                  /* 1 .. 64 */
    double step_cells, tolerance; /* as set by the level or the definition */
} ilsa_model;

ILSA_API ilsa_status ilsa_get_model(const ilsa_solver *solver, ilsa_model *model);

/* Wall time since the start, by phase, seconds. */
typedef struct ilsa_profile {
    double product;        /* elasticity products */
    double preconditioner; /* assembling, factoring and applying it; dense solves */
    double front;          /* survey distances, fast marching, tip cells */
    double rest;
} ilsa_profile;

ILSA_API ilsa_status ilsa_get_profile(const ilsa_solver *solver, ilsa_profile *profile);

#ifdef __cplusplus
}
#endif
#endif
