/* The paper's fracture between two stress barriers, an hour of injection. SI units. */
#include <ilsa/ilsa.h>
#include <stdio.h>
int main(void) {
    ilsa_mesh_def cells = {.nx = 325, .ny = 95, .dx = 20.0 / 21, .dy = 20.0 / 21};
    ilsa_rock lab = {.E = 9.5e9, .nu = 0.2, .mu = 0.1, .K_Ic = 1e6, .C_L = 0.825e-5};
    double interfaces[] = {-10, 10}, sigma[] = {7.75e6, 7e6, 7.75e6}, dt;
    ilsa_material_def prime;
    ilsa_mesh *mesh;
    ilsa_material *rock;
    ilsa_stress *stress;
    ilsa_solver *solver;
    ilsa_summary now = {0};
    if (ilsa_mesh_create(&cells, &mesh) || ilsa_material_def_from_rock(&lab, &prime) ||
        ilsa_material_create(&prime, &rock) || ilsa_stress_create(&(ilsa_stress_def){0}, &stress) ||
        ilsa_stress_set_layers(stress, 2, interfaces, sigma))
        return 1;
    ilsa_solver_def def = ilsa_solver_def_default();
    def.mesh = mesh, def.material = rock, def.stress = stress;
    def.sources = &(ilsa_source_def){.x = 0, .y = 0, .rate = 0.01}, def.source_count = 1;
    if (ilsa_solver_create(&def, &solver) || ilsa_start_radial(solver, 5))
        return 1;
    for (ilsa_suggest_dt(solver, &dt); now.time < 3600; ilsa_get_summary(solver, &now))
        if (ilsa_step(solver, dt < 3600 - now.time ? dt : 3600 - now.time, NULL) == ILSA_OK)
            ilsa_suggest_dt(solver, &dt);
        else if ((dt /= 2) < 1e-3) /* refused, and nothing was changed: try half of it */
            return 1;
    printf("t %g s, x %g m, y %g m, w %g m\n", now.time, now.x_max, now.y_max, now.width_source);
    ilsa_solver_destroy(&solver);
}
