/*
 * What a build of the library computes: widths and net pressures of the channel, distances of the
 * survey cells to the front and the time, of every scene of bench/speed after some steps, all
 * digits. tests/same_answer.sh compares builds by it.
 *
 * bench_answer [dense|blas|threads]: by dense solves, products without FFT, or with two threads.
 */
#include "common_speed.h"

#include <stdio.h>
#include <string.h>

enum { CELLS = 11, STEPS = 20 };

static int print_fields(const char *scene, const ilsa_solver *solver) {
    ilsa_mesh_def m;
    const double *width, *pressure, *sigma;
    const unsigned char *kind;
    if (ilsa_get_mesh_def(solver, &m) || ilsa_get_width(solver, &width) ||
        ilsa_get_pressure(solver, &pressure) || ilsa_get_stress(solver, &sigma) ||
        ilsa_get_cell_kinds(solver, &kind))
        return 1;
    for (int k = 0; k < m.nx * m.ny; k++) {
        if (kind[k] != ILSA_CELL_EMPTY)
            printf("%s,width,%d,%.17g\n", scene, k, width[k]);
        if (kind[k] >= ILSA_CELL_SURVEY)
            printf("%s,pressure,%d,%.17g\n", scene, k, pressure[k] - sigma[k]);
    }
    return 0;
}

static int print_front(const char *scene, ilsa_solver *solver) {
    const ilsa_survey_point *survey;
    size_t count;
    double time;
    if (ilsa_get_survey(solver, &survey, &count) || ilsa_get_time(solver, &time))
        return 1;
    for (size_t k = 0; k < count; k++)
        printf("%s,front,%d,%.17g\n", scene, survey[k].cell, survey[k].s);
    printf("%s,time,0,%.17g\n", scene, time);
    return 0;
}

static int run(const speed_scene *scene, const ilsa_solver_def *how) {
    ilsa_solver *solver = speed_start(scene, CELLS, how);
    if (!solver)
        return 1;
    ilsa_status status = ILSA_OK;
    for (int k = 0; k < STEPS && status == ILSA_OK; k++)
        status = ilsa_advance_one(solver, 1e300, NULL);
    if (status != ILSA_OK)
        fprintf(stderr, "%s: %s\n", scene->name, ilsa_last_error(solver));
    const int failed =
        status != ILSA_OK || print_fields(scene->name, solver) || print_front(scene->name, solver);
    ilsa_solver_destroy(&solver);
    return failed;
}

int main(int argc, char **argv) {
    const char *way = argc > 1 ? argv[1] : "";
    ilsa_solver_def how = ilsa_solver_def_default();
    how.tolerance = 1e-11;
    how.linear = strcmp(way, "dense") == 0 ? ILSA_LINEAR_DENSE : ILSA_LINEAR_GMRES;
    how.product = strcmp(way, "blas") == 0 ? ILSA_PRODUCT_BLAS : ILSA_PRODUCT_AUTO;
    how.threads = strcmp(way, "threads") == 0 ? 2 : 1;
    int failed = 0;
    for (int k = 0; k < SPEED_SCENES; k++) {
        const speed_scene scene = speed_scene_of(k);
        failed |= run(&scene, &how);
    }
    return failed;
}
