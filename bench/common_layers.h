/* The scenes of examples/scenes, as tables: each run through the public interface alone. */
#ifndef BENCH_COMMON_LAYERS_H
#define BENCH_COMMON_LAYERS_H

#include <ilsa/ilsa.h>

/* Section 5.2: SI units, layers of 20 m height, rate 0.01 m^3/s, penny of 5 m to begin with. */
typedef struct layer_scene {
    const char *name;
    double sigma[3]; /* bottom, middle, top */
    double C_prime;
    int nx, ny; /* at H/21 */
} layer_scene;

enum { LAYER_SYMMETRIC_PHI1 = 2, LAYER_DROP_PHI1 = 8, LAYER_SCENES = 9, LAYER_TIMES = 5 };
extern const layer_scene layer_scenes[LAYER_SCENES];
extern const double layer_times[LAYER_TIMES];

/* Cells of H / cells in the same window as at H/21; counts even where cells is, so that the
 * interfaces lie on cell edges. */
ilsa_mesh_def layer_mesh(const layer_scene *scene, int cells);

/* The rock and the fluid. */
ilsa_material_def layer_material(const layer_scene *scene);

/* A solver that is started on such cells. NULL and a message on stderr if it fails. */
ilsa_solver *layer_start(const layer_scene *scene, int cells);

/* The same from another penny, with another tip model. */
typedef struct layer_how {
    ilsa_tip_model tip;
    double rate, radius; /* of the source at first, of the penny */
} layer_how;
ilsa_solver *layer_start_as(const layer_scene *scene, int cells, const layer_how *how);

/* As ilsa_advance, with steps of one part of those that the solver suggests. */
ilsa_status layer_advance(ilsa_solver *solver, double time, int pieces);

/* Section 5.1, Figs. 4 and 5: E' = mu' = K' = Q = 1, 41 x 41 cells, a penny of 5 cells. */
typedef struct fig_scene {
    const char *name;
    double C_prime, dx, time;
} fig_scene;

enum { FIG_SCENES = 7 };
extern const fig_scene fig_scenes[FIG_SCENES];
ilsa_solver *fig_start(const fig_scene *scene);

#endif
