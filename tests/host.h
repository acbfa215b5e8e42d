/* What the tests of the solver share: scenes from a few numbers, and the state bit for bit. */
#ifndef TESTS_HOST_H
#define TESTS_HOST_H

#include <ilsa/ilsa.h>
#include <stddef.h>

enum { HOST_SOURCES = 4, HOST_LAYERS = 4 };

/* All that a solver is made from. */
typedef struct host_scene {
    ilsa_mesh_def mesh;
    ilsa_material_def material;
    int interfaces; /* 0: uniform stress sigma[0] */
    double interface_y[HOST_LAYERS - 1], sigma[HOST_LAYERS];
    const double *cells; /* NULL, or a stress for every cell */
    int source_count;
    ilsa_source_def source[HOST_SOURCES];
    ilsa_solver_def options; /* its pointers and source_count are set by host_try */
} host_scene;

/*
 * A penny in the scaling (5.1): E' = mu' = K' = Q = 1, C' = phi^(1/4), zero stress, one source at
 * the origin, n by n cells of size h.
 */
host_scene host_penny(double phi, int n, double h);

/* The symmetric three-layer scene of examples/scenes/symmetric_phi1e-2.ini, on nx by ny cells. */
host_scene host_three_layers(int nx, int ny);

/* Makes a solver; everything but the solver is destroyed again. */
ilsa_status host_try(const host_scene *scene, ilsa_solver **solver);

/* The functions below fail the test that runs, with a message, when they cannot do their task. */

ilsa_solver *host_solver(const host_scene *scene);

/* A solver with a penny of the given radius. */
ilsa_solver *host_started(const host_scene *scene, double radius);

ilsa_summary host_summary(const ilsa_solver *solver);

/* Fields over the mesh, as the solver gives them. */
const double *host_width(const ilsa_solver *solver);
const double *host_pressure(const ilsa_solver *solver);
const double *host_trigger(const ilsa_solver *solver);
const unsigned char *host_kind(const ilsa_solver *solver);

/* A step of exactly dt, and count steps of the solver's own choice, which must be accepted. */
void host_step(ilsa_solver *solver, double dt);
void host_steps(ilsa_solver *solver, int count);

/* (injected - fracture - leaked) / injected; the volumes summed over the cells. */
double host_imbalance(const ilsa_solver *solver);

/* Sum of a field over the mesh times the area of a cell. */
double host_integral(const ilsa_solver *solver, const double *field);

/* The image of a solver. */
typedef struct host_image {
    unsigned char *bytes;
    size_t size;
} host_image;

host_image host_save(const ilsa_solver *solver);
void host_restore(ilsa_solver *solver, const host_image *image);
void host_free(host_image *image);

/* Whether two images, or an image and a solver, hold the same bits. */
int host_same(const host_image *a, const host_image *b);
int host_is(const ilsa_solver *solver, const host_image *image);

/* Whether tests are to run at full length: $ILSA_LONG. */
int host_long(void);

#endif
