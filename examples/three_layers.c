/*
 * A fracture between three layers of unequal stress, the asymmetric case of section 5.2.2, stepped
 * by the host's own clock. SI units. The front at the end goes to standard output.
 */
#include <ilsa/ilsa.h>
#include <math.h>
#include <stdio.h>

static ilsa_status make_material(ilsa_material **material) {
    ilsa_rock rock = {.E = 9.5e9, .nu = 0.2, .mu = 0.1, .K_Ic = 1e6, .C_L = 0.825e-5};
    ilsa_material_def scaled = ilsa_material_def_default();
    ilsa_status status = ilsa_material_def_from_rock(&rock, &scaled);
    return status == ILSA_OK ? ilsa_material_create(&scaled, material) : status;
}

/* From the bottom layer up. */
static ilsa_status make_stress(ilsa_stress **stress) {
    const double interfaces[] = {-10, 10}, sigma[] = {7.25e6, 7e6, 7.75e6};
    ilsa_stress_def def = ilsa_stress_def_default();
    ilsa_status status = ilsa_stress_create(&def, stress);
    return status == ILSA_OK ? ilsa_stress_set_layers(*stress, 2, interfaces, sigma) : status;
}

static ilsa_status make_mesh(ilsa_mesh **mesh) {
    ilsa_mesh_def def = ilsa_mesh_def_default();
    def.nx = 235;
    def.ny = 189;
    def.dx = def.dy = 20.0 / 21;
    return ilsa_mesh_create(&def, mesh);
}

static ilsa_status make_solver(ilsa_solver **solver) {
    ilsa_solver_def def = ilsa_solver_def_default();
    ilsa_source_def well = {.x = 0, .y = 0, .rate = 0.01};
    ilsa_mesh *mesh = NULL;
    ilsa_material *material = NULL;
    ilsa_stress *stress = NULL;
    ilsa_status status = make_mesh(&mesh);
    if (status == ILSA_OK)
        status = make_material(&material);
    if (status == ILSA_OK)
        status = make_stress(&stress);
    def.mesh = mesh;
    def.material = material;
    def.stress = stress;
    def.sources = &well;
    def.source_count = 1;
    if (status == ILSA_OK)
        status = ilsa_solver_create(&def, solver);
    /* The solver has copies of what it needs. */
    ilsa_mesh_destroy(&mesh);
    ilsa_material_destroy(&material);
    ilsa_stress_destroy(&stress);
    return status;
}

/*
 * Takes dt if the solver accepts it, or half of it, or a quarter, ... A positive status has changed
 * nothing: another step may be tried. Only a full mesh does not depend on the step. A negative
 * status says that the call itself was wrong.
 */
static ilsa_status step_or_less(ilsa_solver *solver, double dt) {
    const double dt_min = 1e-6 * dt;
    ilsa_status status = ilsa_step(solver, dt, NULL);
    while (status > 0 && status != ILSA_MESH_EDGE && dt > dt_min) {
        dt /= 2;
        status = ilsa_step(solver, dt, NULL);
    }
    return status;
}

static ilsa_status grow(ilsa_solver *solver, double t_end) {
    double t, dt;
    ilsa_status status = ilsa_get_time(solver, &t);
    while (status == ILSA_OK && t < t_end) {
        status = ilsa_suggest_dt(solver, &dt);
        if (status == ILSA_OK)
            status = step_or_less(solver, fmin(dt, t_end - t));
        if (status == ILSA_OK)
            status = ilsa_get_time(solver, &t);
    }
    return status;
}

static void print_state(const ilsa_solver *solver) {
    ilsa_summary now;
    if (ilsa_get_summary(solver, &now) == ILSA_OK)
        fprintf(stderr, "%6.0f s: x %.1f .. %.1f m, y %.1f .. %.1f m, %.2f mm, efficiency %.3f\n",
                now.time, now.x_min, now.x_max, now.y_min, now.y_max, 1e3 * now.width_source,
                now.efficiency);
}

static ilsa_status print_front(ilsa_solver *solver) {
    const ilsa_front_point *points;
    size_t count;
    ilsa_status status = ilsa_get_front(solver, &points, &count);
    if (status != ILSA_OK)
        return status;
    printf("x,y,V\n");
    for (size_t i = 0; i < count; i++)
        printf("%.4f,%.4f,%.4e\n", points[i].x, points[i].y, points[i].V);
    return ILSA_OK;
}

int main(void) {
    const double times[] = {100, 400, 900, 1800, 3600};
    ilsa_solver *solver = NULL;
    ilsa_status status = make_solver(&solver);
    if (status == ILSA_OK)
        status = ilsa_start_radial(solver, 5);
    for (size_t i = 0; i < sizeof times / sizeof *times && status == ILSA_OK; i++) {
        status = grow(solver, times[i]);
        print_state(solver);
    }
    if (status == ILSA_OK)
        status = print_front(solver);
    if (status != ILSA_OK)
        fprintf(stderr, "three_layers: %s: %s\n", ilsa_status_text(status),
                ilsa_last_error(solver));
    ilsa_solver_destroy(&solver);
    return status != ILSA_OK;
}
