/* Scenes and clock of the programs that measure speed. */
#ifndef BENCH_COMMON_SPEED_H
#define BENCH_COMMON_SPEED_H

#include <ilsa/ilsa.h>

/* What presses on the fracture: nothing, layers, or a disc above and one below the source. */
typedef enum speed_stress { SPEED_UNIFORM, SPEED_LAYERS, SPEED_DISCS } speed_stress;

/* A fracture that is grown on cells of a size given by a count. */
typedef struct speed_scene {
    const char *name;
    ilsa_material_def material;
    double rate;
    double length;         /* what cells are counted over: the radius at the end, the layer */
    double end;            /* time at that radius; layered: an hour */
    double start;          /* radius of the penny */
    double half_x, half_y; /* of the mesh, in lengths */
    speed_stress stress;
    double sigma[3]; /* of layers, bottom, middle, top */
} speed_scene;

/*
 * Radial, E' = Q = 1, from half the radius on: the M, K and M-tilde vertices and the middle of the
 * triangle (phi = 1e-4, tau = 1). In SI units, layers of 20 m with phi = 1e-2; and the same rock
 * with discs of high stress, between which the footprint has a waist.
 */
enum {
    SPEED_M,
    SPEED_K,
    SPEED_M_TILDE,
    SPEED_MIDDLE,
    SPEED_SYMMETRIC,
    SPEED_ASYMMETRIC,
    SPEED_DROP,
    SPEED_HOURGLASS,
    SPEED_SCENES
};
speed_scene speed_scene_of(int which);

/*
 * A solver that stands at the penny, on square cells of length / cells; of how only level,
 * symmetry, loop, linear are read, and the sources if it has any. NULL and a message on stderr if
 * it fails.
 */
ilsa_solver *speed_start(const speed_scene *scene, int cells, const ilsa_solver_def *how);

/* Puts a solver of the same scene, made with other options, into the state of another. */
ilsa_status speed_copy_state(ilsa_solver *to, const ilsa_solver *from);

/* CPU time of the process, seconds. */
double speed_clock(void);

/* Ends the program, with a message, unless OpenBLAS has been told to run on one thread. */
void speed_one_thread(void);

#endif
