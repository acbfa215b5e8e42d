/* The paper's fracture between two stress barriers, an hour of injection. SI units. */
#include <ilsa/ilsa.h>
#include <stdio.h>
#include <stdlib.h>

/* Ends the program with a message where a call has failed. */
static void check(ilsa_status status, const ilsa_solver *solver) {
    if (status != ILSA_OK) {
        fprintf(stderr, "%s: %s\n", ilsa_status_text(status), ilsa_last_error(solver));
        exit(EXIT_FAILURE);
    }
}

/* A solver for the scene, which copies mesh, material, stress and sources. */
static ilsa_solver *make_solver(void) {
    const ilsa_mesh_def cells = {.nx = 325, .ny = 95, .dx = 20.0 / 21, .dy = 20.0 / 21};
    const ilsa_rock rock = {.E = 9.5e9, .nu = 0.2, .mu = 0.1, .K_Ic = 1e6, .C_L = 0.825e-5};
    const double interfaces[] = {-10, 10};
    const double sigma[] = {7.75e6, 7e6, 7.75e6};
    const ilsa_source_def well = {.x = 0, .y = 0, .rate = 0.01};
    ilsa_material_def scaled;
    ilsa_stress_def no_stress = ilsa_stress_def_default();
    ilsa_solver_def def = ilsa_solver_def_default();
    ilsa_mesh *mesh;
    ilsa_material *material;
    ilsa_stress *stress;
    ilsa_solver *solver;

    check(ilsa_mesh_create(&cells, &mesh), NULL);
    check(ilsa_material_def_from_rock(&rock, &scaled), NULL);
    check(ilsa_material_create(&scaled, &material), NULL);
    check(ilsa_stress_create(&no_stress, &stress), NULL);
    check(ilsa_stress_set_layers(stress, 2, interfaces, sigma), NULL);
    def.mesh = mesh;
    def.material = material;
    def.stress = stress;
    def.sources = &well;
    def.source_count = 1;
    check(ilsa_solver_create(&def, &solver), NULL);
    ilsa_mesh_destroy(&mesh);
    ilsa_material_destroy(&material);
    ilsa_stress_destroy(&stress);
    return solver;
}

int main(void) {
    const double t_end = 3600;
    ilsa_summary now;
    ilsa_solver *solver = make_solver();

    check(ilsa_start_radial(solver, 5), solver);
    check(ilsa_get_summary(solver, &now), solver);
    while (now.time < t_end) {
        double dt;
        check(ilsa_suggest_dt(solver, &dt), solver);
        if (dt > t_end - now.time) {
            dt = t_end - now.time;
        }
        ilsa_status status = ilsa_step(solver, dt, NULL);
        while ((status == ILSA_STEP_REJECTED || status == ILSA_STEP_TOO_LARGE) && dt > 1e-3) {
            dt /= 2; /* a refused step changes nothing: half of it may do */
            status = ilsa_step(solver, dt, NULL);
        }
        check(status, solver);
        check(ilsa_get_summary(solver, &now), solver);
    }
    printf("t %g s, x %g m, y %g m, w %g m\n", now.time, now.x_max, now.y_max, now.width_source);
    ilsa_solver_destroy(&solver);
    return 0;
}
