#include "host.h"
#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void stop(const char *what, ilsa_status status, const char *message) {
    fail_msg("%s: %s: %s", what, ilsa_status_text(status), message);
}

host_scene host_penny(double phi, int n, double h) {
    host_scene scene = {.mesh = {n, n, h, h}, .source_count = 1};
    scene.material = (ilsa_material_def){1, 1, 1, sqrt(sqrt(phi))};
    scene.source[0].rate = 1;
    scene.options = ilsa_solver_def_default();
    return scene;
}

host_scene host_three_layers(int nx, int ny) {
    const ilsa_rock rock = {.E = 9.5e9, .nu = 0.2, .mu = 0.1, .K_Ic = 1e6, .C_L = 0.825e-5};
    host_scene scene = {.mesh = {nx, ny, 20.0 / 21, 20.0 / 21}, .source_count = 1};
    scene.interfaces = 2;
    scene.interface_y[0] = -10;
    scene.interface_y[1] = 10;
    scene.sigma[0] = scene.sigma[2] = 7.75e6;
    scene.sigma[1] = 7e6;
    scene.source[0].rate = 0.01;
    scene.options = ilsa_solver_def_default();
    ilsa_status status = ilsa_material_def_from_rock(&rock, &scene.material);
    if (status)
        stop("rock", status, ilsa_last_error(NULL));
    return scene;
}

static ilsa_status make_stress(const host_scene *scene, const ilsa_mesh *mesh, ilsa_stress **out) {
    ilsa_stress_def def = {scene->sigma[0]};
    ilsa_status status = ilsa_stress_create(&def, out);
    if (!status && scene->interfaces > 0)
        status = ilsa_stress_set_layers(*out, scene->interfaces, scene->interface_y, scene->sigma);
    if (!status && scene->cells)
        status = ilsa_stress_set_cells(*out, mesh, scene->cells);
    return status;
}

ilsa_status host_try(const host_scene *scene, ilsa_solver **solver) {
    ilsa_solver_def def = scene->options;
    ilsa_mesh *mesh = NULL;
    ilsa_material *material = NULL;
    ilsa_stress *stress = NULL;
    *solver = NULL;
    ilsa_status status = ilsa_mesh_create(&scene->mesh, &mesh);
    status = status ? status : ilsa_material_create(&scene->material, &material);
    status = status ? status : make_stress(scene, mesh, &stress);
    def.mesh = mesh;
    def.material = material;
    def.stress = stress;
    def.sources = scene->source;
    def.source_count = scene->source_count;
    status = status ? status : ilsa_solver_create(&def, solver);
    ilsa_mesh_destroy(&mesh);
    ilsa_material_destroy(&material);
    ilsa_stress_destroy(&stress);
    return status;
}

ilsa_solver *host_solver(const host_scene *scene) {
    ilsa_solver *solver;
    ilsa_status status = host_try(scene, &solver);
    if (status)
        stop("create", status, ilsa_last_error(NULL));
    return solver;
}

ilsa_solver *host_started(const host_scene *scene, double radius) {
    ilsa_solver *solver = host_solver(scene);
    ilsa_status status = ilsa_start_radial(solver, radius);
    if (status)
        stop("start", status, ilsa_last_error(solver));
    return solver;
}

ilsa_summary host_summary(const ilsa_solver *solver) {
    ilsa_summary summary;
    ilsa_status status = ilsa_get_summary(solver, &summary);
    if (status)
        stop("summary", status, ilsa_last_error(NULL));
    return summary;
}

static const double *field_of(const ilsa_solver *solver, const char *what,
                              ilsa_status (*get)(const ilsa_solver *, const double **)) {
    const double *field = NULL;
    ilsa_status status = get(solver, &field);
    if (status)
        stop(what, status, ilsa_last_error(NULL));
    return field;
}

const double *host_width(const ilsa_solver *solver) {
    return field_of(solver, "width", ilsa_get_width);
}

const double *host_pressure(const ilsa_solver *solver) {
    return field_of(solver, "pressure", ilsa_get_pressure);
}

const double *host_trigger(const ilsa_solver *solver) {
    return field_of(solver, "trigger time", ilsa_get_trigger_time);
}

const unsigned char *host_kind(const ilsa_solver *solver) {
    const unsigned char *kind = NULL;
    ilsa_status status = ilsa_get_cell_kinds(solver, &kind);
    if (status)
        stop("footprint", status, ilsa_last_error(NULL));
    return kind;
}

void host_step(ilsa_solver *solver, double dt) {
    ilsa_status status = ilsa_step(solver, dt, NULL);
    if (status)
        stop("step", status, ilsa_last_error(solver));
}

void host_steps(ilsa_solver *solver, int count) {
    for (int k = 0; k < count; k++) {
        ilsa_status status = ilsa_advance_one(solver, 1e300, NULL);
        if (status)
            stop("advance", status, ilsa_last_error(solver));
    }
}

double host_integral(const ilsa_solver *solver, const double *field) {
    ilsa_mesh_def mesh;
    ilsa_status status = ilsa_get_mesh_def(solver, &mesh);
    if (status)
        stop("mesh", status, ilsa_last_error(NULL));
    double sum = 0;
    for (int k = 0; k < mesh.nx * mesh.ny; k++)
        sum += field[k];
    return sum * mesh.dx * mesh.dy;
}

double host_imbalance(const ilsa_solver *solver) {
    ilsa_summary now = host_summary(solver);
    double fracture = host_integral(solver, host_width(solver));
    return (now.volume_injected - fracture - now.volume_leaked) / now.volume_injected;
}

host_image host_save(const ilsa_solver *solver) {
    host_image image = {NULL, 0};
    ilsa_status status = ilsa_snapshot_save(solver, NULL, &image.size);
    image.bytes = malloc(image.size + 1);
    if (!status && image.bytes)
        status = ilsa_snapshot_save(solver, image.bytes, &image.size);
    if (status || !image.bytes)
        stop("save", status, ilsa_last_error(NULL));
    return image;
}

void host_restore(ilsa_solver *solver, const host_image *image) {
    ilsa_status status = ilsa_snapshot_restore(solver, image->bytes, image->size);
    if (status)
        stop("restore", status, ilsa_last_error(solver));
}

void host_free(host_image *image) {
    free(image->bytes);
    *image = (host_image){NULL, 0};
}

int host_same(const host_image *a, const host_image *b) {
    return a->size == b->size && memcmp(a->bytes, b->bytes, a->size) == 0;
}

int host_is(const ilsa_solver *solver, const host_image *image) {
    host_image now = host_save(solver);
    int same = host_same(&now, image);
    host_free(&now);
    return same;
}

int host_long(void) {
    const char *value = getenv("ILSA_LONG");
    return value && *value;
}
