/*
 * The solver: one planar fracture on one mesh, stepped by the host's clock.
 *
 * A solver copies the mesh, material, stress and sources that it is created with and owns all that
 * changes afterwards, so those handles may be destroyed or reused at once. Solvers are independent
 * of each other. One thread at a time may use a solver, which has threads of its own only where its
 * definition asks for them. The units are any consistent set in which cell sizes, material
 * parameters, stresses, rates and times are at most 1e60, and at least 1e-60 where they may not be
 * zero: meshes, materials and solvers refuse others when they are made.
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

/*
 * A point source. It feeds the cell that contains it, or, on a common edge, the cells on both
 * sides. The rate is of the whole fracture, both wings.
 */
typedef struct ilsa_source_def {
    double x, y; /* length, on the mesh */
    double rate; /* volume per time, 0 .. 1e60; ilsa_set_rate changes it */
} ilsa_source_def;

/*
 * The asymptote that the width behind the front follows (section 3), in the inversion of survey
 * cells (4.9) and in the volume of tip cells (4.18). The full one is for use; the others show how
 * much it is worth. Flow, leak-off, the start from a penny and the regimes are the material's with
 * each of them: a regime is the place of the full asymptote at a cell's distance and velocity.
 */
typedef enum ilsa_tip_model {
    ILSA_TIP_FULL = 0,                /* toughness, viscosity, leak-off: (3.15) */
    ILSA_TIP_TOUGHNESS_VISCOSITY = 1, /* (3.15) with C' = 0 */
    ILSA_TIP_TOUGHNESS = 2            /* LEFM, (2.6): K' s^(1/2) / E'; K' > 0, else refused */
} ilsa_tip_model;

/* The mirror symmetry of the scene that is used to solve a half or a quarter of it. */
typedef enum ilsa_symmetry {
    ILSA_SYMMETRY_AUTO = 0, /* as far as the sources, the stress and the fracture allow */
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
    const ilsa_stress *stress;      /* NULL: no stress */
    const ilsa_source_def *sources; /* source_count of them, required */
    int source_count;               /* 1 .. 1000; default 0 */
    int level;                      /* 1 fast .. 5 accurate; default 3, for which 0 stands */
    ilsa_tip_model tip;             /* default ILSA_TIP_FULL */
    ilsa_symmetry symmetry;         /* default ILSA_SYMMETRY_AUTO */
    ilsa_front_loop loop;           /* default ILSA_LOOP_COUPLED */
    ilsa_linear_solver linear;      /* default ILSA_LINEAR_AUTO */
    ilsa_product product;           /* default ILSA_PRODUCT_AUTO */
    int coarsen;                    /* 1: ilsa_advance coarsens or grows the mesh at its edge, see
                                       ilsa_advance_one; default 0 */
    int cells_max;        /* the most cells nx ny that the mesh may grow to, 1 .. 2^28; default 0:
                             100000. The mesh of the definition is never too large */
    int threads;          /* 1 .. 64 that a step uses, the caller's included; default 0: as 1 */
    double step_cells;    /* front advance of a suggested step, in cells, 0.01 .. 1; 0: by level */
    double tolerance;     /* of the front, in cells, 1e-12 .. 0.1; 0: by level */
    double dt_max;        /* longest suggested step, time, > 0; 0: no limit */
    double closure_width; /* width that a closed cell keeps, length, > 0; 0: 1e-4 of the largest
                             that the fracture has had */
} ilsa_solver_def;

/*
 * Returns a definition with the defaults above, in which mesh, material, sources and source_count
 * must be set. Zero stands for the default in every option.
 */
ILSA_API ilsa_solver_def ilsa_solver_def_default(void);

/*
 * Makes a solver without a fracture. On success *solver is a new handle owned by the caller, to be
 * destroyed with ilsa_solver_destroy; otherwise *solver is NULL.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE, ILSA_ERR_MEMORY (also where the system gives no more threads),
 * ILSA_ERR_MISMATCH (stress per cell of another mesh, a symmetry that the scene does not have,
 * ILSA_TIP_TOUGHNESS for a material without toughness, a product that the library was built
 * without).
 *
 * A call that gets no memory returns ILSA_ERR_MEMORY, with two exceptions in the libraries below.
 * FFTW ends the process when it cannot plan: the library asks for the memory of a plan first, but
 * another thread may take it in between. OpenBLAS maps a buffer (128 MB in 0.3.21) in the first
 * larger call of a thread while others are in one. Where it gets none it tries for ever, and since
 * 0.3.30 it ends the process. A host that limits its address space should call cblas_dgemm once
 * before it sets the limit.
 */
ILSA_API ilsa_status ilsa_solver_create(const ilsa_solver_def *def, ilsa_solver **solver);

/* Destroys *solver and sets it to NULL. solver == NULL and *solver == NULL are allowed. */
ILSA_API void ilsa_solver_destroy(ilsa_solver **solver);

/*
 * Returns the message of the last call that failed, which names the argument, its value and its
 * range; "" if none has failed. It is valid until the next call.
 *
 * A call that takes a solver which it may change leaves its message with the solver. Every other
 * call leaves it with the calling thread: a create, a call on a mesh, material or stress, and the
 * getters, ilsa_suggest_dt and ilsa_snapshot_save, which take a const solver. The answer for a
 * solver is the thread's message where the last call of this thread that failed took a const
 * solver, and the solver's own otherwise. The answer for NULL is always the thread's.
 */
ILSA_API const char *ilsa_last_error(const ilsa_solver *solver);

/*
 * Starts from the penny-shaped fracture of the solver's own material around its first source, at
 * that source's rate, which must be > 0. The fracture has the given radius, or is that of the given
 * time since the start of injection; the clock is set to its time. The radius must be at least 2
 * cells and the fracture must lie inside the mesh. A fracture that was there before is replaced.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE, ILSA_ERR_MEMORY, ILSA_MESH_EDGE.
 */
ILSA_API ilsa_status ilsa_start_radial(ilsa_solver *solver, double radius);
ILSA_API ilsa_status ilsa_start_radial_at(ilsa_solver *solver, double time);

/*
 * Sets the rate of source 0 .. source_count - 1 from now on, volume per time of the whole fracture,
 * 0 .. 1e60. ILSA_ERR_NULL, ILSA_ERR_VALUE.
 */
ILSA_API ilsa_status ilsa_set_rate(ilsa_solver *solver, int source, double rate);

/*
 * Takes a copy of another stress field from now on. ILSA_ERR_NULL, ILSA_ERR_VALUE,
 * ILSA_ERR_MISMATCH, ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_set_stress(ilsa_solver *solver, const ilsa_stress *stress);

/* The work of a step, or of an advance of many steps, and where it ended. */
typedef struct ilsa_report {
    double time;              /* of the fracture, at the end */
    double dt;                /* of the last accepted step */
    long steps;               /* accepted */
    long rejected;            /* tried and not accepted; ILSA_CLOSED tries nothing */
    long front_iterations;    /* passes of the front loop; this and the next three count those of
                                 rejected steps too */
    long newton_iterations;   /* linear systems solved */
    long krylov_iterations;   /* GMRES iterations */
    long elasticity_products; /* products with the elasticity matrix */
    long coarsened;           /* times the mesh was coarsened at its edge, along x, y or both */
    long coarsened_x, coarsened_y; /* times along x, times along y */
    long grown;                    /* times cells were added there */
    double front_change;           /* last change of the front in the last step, in cells */
    double front_advance;          /* largest advance of the front in the last step, in cells */
    double seconds;                /* wall time */
} ilsa_report;

/*
 * Takes one step of exactly dt > 0 by backward Euler (4.4). A cell closes where its width would
 * fall below the closure width. A closed cell keeps a film of that width, which carries the closure
 * stress and neither leaks nor flows out. The cell opens again when the pressure of the fluid
 * beside it exceeds the closure stress. The front before closed cells rests. Any status other than
 * ILSA_OK leaves the solver bit for bit as it was. report may be NULL; it is written whenever the
 * solver is not NULL. ILSA_STEP_REJECTED, ILSA_STEP_TOO_LARGE, ILSA_MESH_EDGE, ILSA_CLOSED,
 * ILSA_ERR_NULL, ILSA_ERR_VALUE, ILSA_ERR_STATE, ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_step(ilsa_solver *solver, double dt, ilsa_report *report);

/*
 * Writes the step that the solver would take next: the fastest point of the front moves by
 * step_cells cells at its velocity in the last step. Four bounds may make it shorter.
 * - It is at most a tenth of the time so far, which is the step of a front at rest.
 * - A fracture that empties, because less than half of the fluid that leaks is injected, loses at
 *   most a tenth of its volume at the rates of the last step. One that is filled again while cells
 *   are closed gains at most as much as it has.
 * - After an advance was refused a step it is at most half of that one. The bound grows by 1.5 with
 *   every step that is accepted, and a new rate, a start or a coarsening lifts it.
 * - It is at most dt_max of the definition.
 * ILSA_ERR_NULL, ILSA_ERR_STATE.
 */
ILSA_API ilsa_status ilsa_suggest_dt(const ilsa_solver *solver, double *dt);

/*
 * Takes one accepted step of the solver's own choice, which does not pass t_limit > time; the last
 * one before t_limit lands exactly on it. A rejected step is tried again with half of its length.
 *
 * With coarsen = 1 of the definition it makes room at the edge of the mesh, and the report says
 * what it did. The first of these that can be done is:
 * - to coarsen both directions, or the one that is full, where 10 of the new cells stay across half
 *   of the footprint and, along y, across the layer of stress that a source is in; cells become at
 *   most 4 to 1 oblong so, and 5 of the longer ones stay across the footprint;
 * - to add cells in the full directions, as many as there are, or as cells_max allows;
 * - to coarsen both directions where 10 cells stay across half of the footprint, though not across
 *   the layer;
 * - to add cells in the full direction and take as many away in the other, far from the footprint,
 *   if the stress is not per cell;
 * - to coarsen the full direction, as ilsa_coarsen_along can.
 * Where nothing is left the status is ILSA_MESH_EDGE. The mesh stays what it became if no step is
 * accepted afterwards, and any other failure leaves the solver as it was.
 *
 * ILSA_STALLED when steps are refused down to 1e-12 of the time, or 400 of them while the time
 * grows by a tenth; and the statuses of ilsa_step.
 */
ILSA_API ilsa_status ilsa_advance_one(ilsa_solver *solver, double t_limit, ilsa_report *report);

/*
 * Takes as many such steps as it needs to land exactly on t_end > time. On a status other than
 * ILSA_OK the solver stands at the last accepted step. report, which may be NULL, is the sum over
 * the steps. The statuses of ilsa_advance_one.
 */
ILSA_API ilsa_status ilsa_advance(ilsa_solver *solver, double t_end, ilsa_report *report);

/*
 * Lets time pass up to t > time in a fracture where nothing happens, because every cell is closed
 * and nothing is injected; a step would return ILSA_CLOSED there. Only the clock moves.
 * ILSA_ERR_NULL, ILSA_ERR_VALUE; ILSA_ERR_STATE without a fracture, and where a cell is open or a
 * source injects.
 */
ILSA_API ilsa_status ilsa_wait(ilsa_solver *solver, double t);

/*
 * Moves the fracture to cells twice as large, and as many (end of section 5.1). Volume and leaked
 * volume are conserved to rounding, and trigger times and the paths of the front through tip cells
 * are carried over. The footprint must be 4 of the new cells across. All pointers handed out before
 * are invalid afterwards.
 * ILSA_ERR_NULL, ILSA_ERR_STATE, ILSA_ERR_VALUE, ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_coarsen(ilsa_solver *solver);

/* Directions of the mesh, which may be added up. */
enum { ILSA_ALONG_X = 1, ILSA_ALONG_Y = 2 };

/*
 * Coarsens along x, y or both: cells become twice as long in the directions given, and stay as they
 * are in the others. The footprint must be 4 of the new cells across in the directions given, and
 * dx / dy must stay within 1e-3 .. 1e3. With both directions it is ilsa_coarsen, with its statuses.
 */
ILSA_API ilsa_status ilsa_coarsen_along(ilsa_solver *solver, int directions);

/*
 * Adds cells of the same size: `columns` on the left and as many on the right, `rows` below and as
 * many above, so that the mesh stays around the origin, sources where they are, and symmetry what
 * it is. The fracture stays as it is, bit for bit, and goes on as it would have on the larger mesh
 * from the start. Layers of stress go on into the new cells; with a stress per cell each takes the
 * value of the nearest cell that there was. Cells outside the fracture cost memory
 * (docs/embedding.md) and no time. All pointers handed out before are invalid afterwards, and cells
 * have other indices. ILSA_ERR_NULL, ILSA_ERR_STATE, ILSA_ERR_VALUE for a negative count or a mesh
 * of more cells than cells_max or ilsa_mesh_create allows, ILSA_ERR_MEMORY.
 */
ILSA_API ilsa_status ilsa_grow(ilsa_solver *solver, int columns, int rows);

/*
 * Writes the mesh that the solver stands on now. Coarsening and growth change it, and so does a
 * snapshot that was taken on other cells. ILSA_ERR_NULL.
 */
ILSA_API ilsa_status ilsa_get_mesh_def(const ilsa_solver *solver, ilsa_mesh_def *def);

/*
 * Writes the time since the start of injection. ILSA_ERR_NULL; ILSA_ERR_STATE without a fracture,
 * as in all getters below.
 */
ILSA_API ilsa_status ilsa_get_time(const ilsa_solver *solver, double *time);

/*
 * Fields over the mesh, read without a copy: nx * ny values, owned by the solver and valid until
 * the next call that changes it. Row j = 0 is the lowest; y points up.
 *
 * The width is 0 outside the footprint, and in a tip cell its mean over the whole cell, so that
 * widths times the area of a cell add up to the volume. The pressure is the total pressure of the
 * fluid, not the net one. In a closed cell it is the closure stress, which is the far-field stress
 * and what the widths of all cells add to it there. Outside the footprint it is 0. The stress is
 * the far-field stress that the solver uses.
 */
ILSA_API ilsa_status ilsa_get_width(const ilsa_solver *solver, const double **width);
ILSA_API ilsa_status ilsa_get_pressure(const ilsa_solver *solver, const double **pressure);
ILSA_API ilsa_status ilsa_get_stress(const ilsa_solver *solver, const double **stress);

/*
 * The time at which the front passed the centre of each cell, infinite where it has not. *trigger
 * is NULL when the material has no leak-off: only leak-off needs these times.
 */
ILSA_API ilsa_status ilsa_get_trigger_time(const ilsa_solver *solver, const double **trigger);

/*
 * The kinds of a cell. The front crosses a tip cell; channel cells are full, and a survey cell is a
 * channel cell with a tip cell or the edge of the footprint beside it. A channel cell whose faces
 * touch is closed, beside a tip cell too: its width is the closure width, and its pressure is the
 * closure stress, see ilsa_get_pressure.
 */
enum {
    ILSA_CELL_EMPTY = 0,
    ILSA_CELL_TIP = 1,
    ILSA_CELL_SURVEY = 2,
    ILSA_CELL_CHANNEL = 3,
    ILSA_CELL_CLOSED = 4
};

/* The kind of each of the nx * ny cells; read as the fields are. */
ILSA_API ilsa_status ilsa_get_cell_kinds(const ilsa_solver *solver, const unsigned char **kind);

/* A point of the front. */
typedef struct ilsa_front_point {
    double x, y;            /* position */
    double V;               /* normal velocity over the last step, >= 0 */
    ilsa_tip_regime regime; /* of the nearest survey cell */
    int loop;               /* number of its closed curve, from 0, the longest first */
} ilsa_front_point;

/*
 * The front as closed polylines, counter-clockwise around the fluid, whose first points are not
 * repeated: count points, owned by the solver and valid until the next call on it. They are
 * computed on demand, and the fracture is not changed; but the solver is not const, so that a
 * message is left with it. ILSA_ERR_NULL, ILSA_ERR_STATE, ILSA_ERR_MEMORY.
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

/* The survey cells, read as the front is by ilsa_get_front. */
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
    int closed_cells;     /* survey and channel cells whose faces touch: ILSA_CELL_CLOSED */
    double closure_width; /* the width that closed cells keep */
    int unknowns;         /* of the last step: after symmetry */
    ilsa_report total;    /* since the start; seconds, steps and iterations summed */
} ilsa_summary;

ILSA_API ilsa_status ilsa_get_summary(const ilsa_solver *solver, ilsa_summary *summary);

/* The processes that the scene made the solver model, and the settings that it uses. */
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
