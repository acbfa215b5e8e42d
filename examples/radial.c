/*
 * A radial fracture from viscosity to toughness with leak-off: mu' = E' = K' = Q0 = 1 and
 * C' = phi^(1/4), so that time is tau of section 5.1. The radius grows 30-fold; when the mesh is
 * full its cells are made twice as large.
 */
#include <ilsa/ilsa.h>
#include <math.h>
#include <stdio.h>

static ilsa_status make_solver(double phi, ilsa_solver **solver) {
    ilsa_mesh_def cells = ilsa_mesh_def_default();
    ilsa_material_def rock = ilsa_material_def_default();
    ilsa_solver_def def = ilsa_solver_def_default();
    ilsa_source_def well = {.x = 0, .y = 0, .rate = 1};
    ilsa_mesh *mesh = NULL;
    ilsa_material *material = NULL;
    cells.nx = cells.ny = 41;
    cells.dx = cells.dy = 0.015;
    rock.E_prime = rock.mu_prime = rock.K_prime = 1;
    rock.C_prime = pow(phi, 0.25);
    ilsa_status status = ilsa_mesh_create(&cells, &mesh);
    if (status == ILSA_OK)
        status = ilsa_material_create(&rock, &material);
    def.mesh = mesh;
    def.material = material;
    def.sources = &well;
    def.source_count = 1;
    if (status == ILSA_OK)
        status = ilsa_solver_create(&def, solver);
    /* The solver has copies of what it needs. */
    ilsa_mesh_destroy(&mesh);
    ilsa_material_destroy(&material);
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

/* Steps to t_end, on cells twice as large whenever the mesh is full. */
static ilsa_status grow(ilsa_solver *solver, double t_end) {
    double t, dt;
    ilsa_status status = ilsa_get_time(solver, &t);
    while (status == ILSA_OK && t < t_end) {
        status = ilsa_suggest_dt(solver, &dt);
        if (status == ILSA_OK)
            status = step_or_less(solver, fmin(dt, t_end - t));
        if (status == ILSA_MESH_EDGE)
            status = ilsa_coarsen(solver);
        if (status == ILSA_OK)
            status = ilsa_get_time(solver, &t);
    }
    return status;
}

static ilsa_status print_state(const ilsa_solver *solver) {
    ilsa_summary now;
    ilsa_mesh_def mesh;
    ilsa_status status = ilsa_get_summary(solver, &now);
    if (status == ILSA_OK)
        status = ilsa_get_mesh_def(solver, &mesh);
    if (status == ILSA_OK)
        printf("%8g %10.5f %10.5f %12.5f %8.3f %7ld\n", now.time, now.x_max, now.width_source,
               now.efficiency, mesh.dx, now.total.steps);
    return status;
}

int main(void) {
    const double times[] = {0.1, 1, 10, 100, 1000};
    ilsa_solver *solver = NULL;
    ilsa_status status = make_solver(1e-4, &solver);
    if (status == ILSA_OK)
        status = ilsa_start_radial(solver, 0.1);
    printf("     tau     radius      width   efficiency     cell   steps\n");
    for (size_t i = 0; i < sizeof times / sizeof *times && status == ILSA_OK; i++) {
        status = grow(solver, times[i]);
        if (status == ILSA_OK)
            status = print_state(solver);
    }
    if (status != ILSA_OK)
        fprintf(stderr, "radial: %s: %s\n", ilsa_status_text(status), ilsa_last_error(solver));
    ilsa_solver_destroy(&solver);
    return status != ILSA_OK;
}
