#include "common_layers.h"

#include <math.h>
#include <stdio.h>

static const double height = 20; /* H of the middle layer */

#define SYMMETRIC                                                                                  \
    { 7.75e6, 7e6, 7.75e6 }
#define ASYMMETRIC                                                                                 \
    { 7.25e6, 7e6, 7.75e6 }
#define DROP                                                                                       \
    { 6.5e6, 7e6, 7.25e6 }

const layer_scene layer_scenes[LAYER_SCENES] = {
    {"symmetric_phi1e-4", SYMMETRIC, 0.521e-5, 325, 95},
    {"symmetric_phi1e-2", SYMMETRIC, 1.65e-5, 325, 95},
    {"symmetric_phi1", SYMMETRIC, 5.21e-5, 325, 95},
    {"asymmetric_phi1e-4", ASYMMETRIC, 0.521e-5, 235, 189},
    {"asymmetric_phi1e-2", ASYMMETRIC, 1.65e-5, 235, 189},
    {"asymmetric_phi1", ASYMMETRIC, 5.21e-5, 235, 189},
    {"drop_phi1e-4", DROP, 0.521e-5, 193, 253},
    {"drop_phi1e-2", DROP, 1.65e-5, 193, 253},
    {"drop_phi1", DROP, 5.21e-5, 193, 253},
};

const double layer_times[LAYER_TIMES] = {100, 400, 900, 1800, 3600};

const fig_scene fig_scenes[FIG_SCENES] = {
    {"radial_fig4a", 0.031622776601683791, 0.035, 0.67},
    {"radial_fig4b", 1, 0.015, 0.22},
    {"radial_fig4c", 0.031622776601683791, 0.33, 170},
    {"radial_fig5a", 0.031622776601683791, 0.073, 3.8},
    {"radial_fig5b", 1, 0.0062, 0.019},
    {"radial_fig5c", 1, 0.11, 220},
    {"radial_fig5d", 0.1, 0.08, 6.1},
};

/* What a solver is made of: handles of which it takes copies. */
typedef struct parts {
    ilsa_mesh *mesh;
    ilsa_material *material;
    ilsa_stress *stress;
} parts;

static ilsa_solver *create(parts *p, ilsa_status status, const layer_how *how) {
    const ilsa_source_def well = {.rate = how->rate};
    ilsa_solver_def d = ilsa_solver_def_default();
    ilsa_solver *solver = NULL;
    d.mesh = p->mesh;
    d.material = p->material;
    d.stress = p->stress;
    d.sources = &well;
    d.source_count = 1;
    d.tip = how->tip;
    status = status ? status : ilsa_solver_create(&d, &solver);
    status = status ? status : ilsa_start_radial(solver, how->radius);
    if (status != ILSA_OK) {
        fprintf(stderr, "start: %s\n", ilsa_last_error(solver));
        ilsa_solver_destroy(&solver);
    }
    ilsa_mesh_destroy(&p->mesh);
    ilsa_material_destroy(&p->material);
    ilsa_stress_destroy(&p->stress);
    return solver;
}

/* A count of cells at H/21 on other cells: of the same parity as cells. */
static int count_of(int at_21, int cells) {
    const int count = (int)ceil(at_21 * cells / 21.0);
    return count + (count - cells) % 2;
}

ilsa_mesh_def layer_mesh(const layer_scene *scene, int cells) {
    const double dx = height / cells;
    return (ilsa_mesh_def){count_of(scene->nx, cells), count_of(scene->ny, cells), dx, dx};
}

ilsa_material_def layer_material(const layer_scene *scene) {
    const ilsa_rock rock = {9.5e9, 0.2, 0.1, 1e6, 0.5 * scene->C_prime};
    ilsa_material_def scaled = ilsa_material_def_default();
    (void)ilsa_material_def_from_rock(&rock, &scaled);
    return scaled;
}

ilsa_solver *layer_start_as(const layer_scene *scene, int cells, const layer_how *how) {
    const double interfaces[] = {-0.5 * height, 0.5 * height};
    const ilsa_mesh_def grid = layer_mesh(scene, cells);
    const ilsa_material_def scaled = layer_material(scene);
    const ilsa_stress_def zero = ilsa_stress_def_default();
    parts p = {0};
    ilsa_status status = ilsa_mesh_create(&grid, &p.mesh);
    status = status ? status : ilsa_material_create(&scaled, &p.material);
    status = status ? status : ilsa_stress_create(&zero, &p.stress);
    status = status ? status : ilsa_stress_set_layers(p.stress, 2, interfaces, scene->sigma);
    return create(&p, status, how);
}

ilsa_solver *layer_start(const layer_scene *scene, int cells) {
    return layer_start_as(scene, cells, &(layer_how){ILSA_TIP_FULL, 0.01, 5});
}

ilsa_status layer_advance(ilsa_solver *solver, double time, int pieces) {
    double now = 0, dt = 0;
    ilsa_status status = ilsa_get_time(solver, &now);
    while (status == ILSA_OK && now < time) {
        status = ilsa_suggest_dt(solver, &dt);
        status = status ? status : ilsa_advance(solver, fmin(now + dt / pieces, time), NULL);
        status = status ? status : ilsa_get_time(solver, &now);
    }
    return status;
}

ilsa_solver *fig_start(const fig_scene *scene) {
    const ilsa_mesh_def grid = {41, 41, scene->dx, scene->dx};
    const ilsa_material_def scaled = {1, 1, 1, scene->C_prime};
    parts p = {0};
    ilsa_status status = ilsa_mesh_create(&grid, &p.mesh);
    status = status ? status : ilsa_material_create(&scaled, &p.material);
    return create(&p, status, &(layer_how){ILSA_TIP_FULL, 1, 5 * scene->dx});
}
