#include "common_speed.h"

#include "common_layers.h"
#include "common_radial.h"
#include "step/solver.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double layer_height = 20;

/* Discs of high stress, SI: they touch neither each other nor the penny. */
static const double disc_centre = 20, disc_radius = 11, disc_stress = 8.5e6, rock_stress = 7e6;

static speed_scene radial(const char *name, penny_law law, double time) {
    const double R = radial_reference(law, time).R;
    return (speed_scene){.name = name,
                         .material = {1, law.mu_prime, law.K_prime, law.C_prime},
                         .rate = 1,
                         .length = R,
                         .end = time,
                         .start = 0.5 * R,
                         .half_x = 1,
                         .half_y = 1};
}

static speed_scene layered(const char *name, const layer_scene *layers) {
    const ilsa_rock rock = {9.5e9, 0.2, 0.1, 1e6, 0.5 * layers->C_prime};
    speed_scene s = {.name = name,
                     .rate = 0.01,
                     .length = layer_height,
                     .end = 3600,
                     .start = 5,
                     .half_x = layers->nx / 42.0,
                     .half_y = layers->ny / 42.0,
                     .stress = SPEED_LAYERS};
    memcpy(s.sigma, layers->sigma, sizeof s.sigma);
    (void)ilsa_material_def_from_rock(&rock, &s.material);
    return s;
}

static speed_scene hourglass(void) {
    speed_scene s = layered("hourglass", &layer_scenes[1]);
    s.stress = SPEED_DISCS;
    s.length = 30;
    s.start = 6;
    s.half_y = s.half_x;
    return s;
}

speed_scene speed_scene_of(int which) {
    switch (which) {
    case SPEED_M:
        return radial("radial m", (penny_law){"", 1, 0, 0}, 1);
    case SPEED_K:
        return radial("radial k", (penny_law){"", 1, 1, 0}, 1e5);
    case SPEED_M_TILDE:
        return radial("radial m-tilde", (penny_law){"", 1, 0, 1}, 100);
    case SPEED_MIDDLE:
        return radial("radial middle", (penny_law){"", 1, 1, 0.1}, 1);
    case SPEED_SYMMETRIC:
        return layered("symmetric", &layer_scenes[1]);
    case SPEED_ASYMMETRIC:
        return layered("asymmetric", &layer_scenes[4]);
    case SPEED_DROP:
        return layered("drop", &layer_scenes[7]);
    default:
        return hourglass();
    }
}

/* Part of a cell that lies in one of the discs, by a grid of points. */
static double in_disc(double x, double y, double dx) {
    enum { POINTS = 8 };
    int inside = 0;
    for (int j = 0; j < POINTS; j++)
        for (int i = 0; i < POINTS; i++) {
            const double u = x + dx * ((i + 0.5) / POINTS - 0.5);
            const double v = fabs(y + dx * ((j + 0.5) / POINTS - 0.5));
            inside += hypot(u, v - disc_centre) < disc_radius;
        }
    return inside / (double)(POINTS * POINTS);
}

/* The discs, mirrored bit for bit. */
static ilsa_status set_discs(ilsa_stress *stress, const ilsa_mesh *mesh) {
    ilsa_mesh_def m;
    ilsa_status status = ilsa_mesh_get_def(mesh, &m);
    double *sigma = malloc((size_t)m.nx * (size_t)m.ny * sizeof *sigma);
    for (int n = 0; sigma && n < m.nx * m.ny; n++) {
        const int i = n % m.nx, j = n / m.nx;
        const double x = fabs(i - 0.5 * (m.nx - 1)) * m.dx;
        const double y = fabs(j - 0.5 * (m.ny - 1)) * m.dy;
        sigma[n] = rock_stress + in_disc(x, y, m.dx) * (disc_stress - rock_stress);
    }
    status = status ? status : sigma ? ILSA_OK : ILSA_ERR_MEMORY;
    status = status ? status : ilsa_stress_set_cells(stress, mesh, sigma);
    free(sigma);
    return status;
}

static ilsa_status set_stress(ilsa_stress *stress, const ilsa_mesh *mesh, const speed_scene *s) {
    const double interfaces[] = {-0.5 * layer_height, 0.5 * layer_height};
    switch (s->stress) {
    case SPEED_LAYERS:
        return ilsa_stress_set_layers(stress, 2, interfaces, s->sigma);
    case SPEED_DISCS:
        return set_discs(stress, mesh);
    default:
        return ILSA_OK;
    }
}

/* Odd, so that the source is in a cell's centre; room for the band around the front. */
static int count_of(double half, int cells) {
    return 2 * (int)ceil(half * cells + 8) + 1;
}

ilsa_solver *speed_start(const speed_scene *scene, int cells, const ilsa_solver_def *how) {
    const double dx = scene->length / cells;
    const ilsa_mesh_def cells_of = {count_of(scene->half_x, cells), count_of(scene->half_y, cells),
                                    dx, dx};
    const ilsa_stress_def zero = ilsa_stress_def_default();
    const ilsa_source_def well = {.rate = scene->rate};
    ilsa_solver_def d = *how;
    ilsa_mesh *mesh = NULL;
    ilsa_material *material = NULL;
    ilsa_stress *stress = NULL;
    ilsa_solver *solver = NULL;
    ilsa_status status = ilsa_mesh_create(&cells_of, &mesh);
    status = status ? status : ilsa_material_create(&scene->material, &material);
    status = status ? status : ilsa_stress_create(&zero, &stress);
    status = status ? status : set_stress(stress, mesh, scene);
    d.mesh = mesh;
    d.material = material;
    d.stress = stress;
    d.sources = how->source_count ? how->sources : &well;
    d.source_count = how->source_count ? how->source_count : 1;
    status = status ? status : ilsa_solver_create(&d, &solver);
    status = status ? status : ilsa_start_radial(solver, scene->start);
    if (status != ILSA_OK) {
        fprintf(stderr, "%s: %s\n", scene->name, ilsa_last_error(solver));
        ilsa_solver_destroy(&solver);
    }
    ilsa_mesh_destroy(&mesh);
    ilsa_material_destroy(&material);
    ilsa_stress_destroy(&stress);
    return solver;
}

/* An image serves solvers of its own definition: this one passes for such meanwhile. */
ilsa_status speed_copy_state(ilsa_solver *to, const ilsa_solver *from) {
    const ilsa_solver_def own = to->model.options;
    size_t size = 0;
    ilsa_status status = ilsa_snapshot_save(from, NULL, &size);
    void *image = status == ILSA_OK ? malloc(size) : NULL;
    if (!image)
        return status ? status : ILSA_ERR_MEMORY;
    status = ilsa_snapshot_save(from, image, &size);
    to->model.options = from->model.options;
    status = status ? status : ilsa_snapshot_restore(to, image, size);
    to->model.options = own;
    free(image);
    return status;
}

double speed_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void speed_one_thread(void) {
    const char *threads = getenv("OPENBLAS_NUM_THREADS");
    if (!threads || strcmp(threads, "1") != 0) {
        fprintf(stderr, "set OPENBLAS_NUM_THREADS=1: CPU times are those of one thread\n");
        exit(2);
    }
}
