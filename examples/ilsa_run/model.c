#include "model.h"

#include "reason.h"

#include <stdlib.h>

typedef struct parts {
    ilsa_mesh *mesh;
    ilsa_material *material;
    ilsa_stress *stress;
    ilsa_source_def *sources;
} parts;

static void parts_free(parts *p) {
    ilsa_mesh_destroy(&p->mesh);
    ilsa_material_destroy(&p->material);
    ilsa_stress_destroy(&p->stress);
    free(p->sources);
}

static ilsa_status make_stress(const scene *sc, ilsa_stress **stress) {
    ilsa_stress_def def = ilsa_stress_def_default();
    def.sigma = sc->sigma[0];
    ilsa_status status = ilsa_stress_create(&def, stress);
    if (!status && sc->interface_count > 0)
        status = ilsa_stress_set_layers(*stress, sc->interface_count, sc->interfaces, sc->sigma);
    return status;
}

static ilsa_status make_sources(const scene *sc, ilsa_source_def **sources) {
    *sources = malloc((size_t)sc->source_count * sizeof **sources);
    if (!*sources)
        return ILSA_ERR_MEMORY;
    for (int i = 0; i < sc->source_count; i++)
        (*sources)[i] = (ilsa_source_def){
            .x = sc->sources[i].x, .y = sc->sources[i].y, .rate = sc->sources[i].rates[0]};
    return ILSA_OK;
}

static ilsa_status make_parts(const scene *sc, parts *p) {
    ilsa_status status = ilsa_mesh_create(&sc->mesh, &p->mesh);
    if (!status)
        status = ilsa_material_create(&sc->material, &p->material);
    if (!status)
        status = make_stress(sc, &p->stress);
    if (!status)
        status = make_sources(sc, &p->sources);
    return status;
}

static ilsa_status make_solver(const scene *sc, const parts *p, ilsa_solver **solver) {
    ilsa_solver_def def = sc->options;
    def.mesh = p->mesh;
    def.material = p->material;
    def.stress = p->stress;
    def.sources = p->sources;
    def.source_count = sc->source_count;
    return ilsa_solver_create(&def, solver);
}

/* What the library finds wrong with a scene that passed our own checks, said of a key. */
static int refused(const scene *sc, int section, int key, const char *note, ilsa_status status,
                   const ilsa_solver *solver) {
    scene_error(sc, stderr, section, key, "%s: %s", note, ilsa_last_error(solver));
    return status == ILSA_ERR_VALUE || status == ILSA_ERR_MISMATCH || status == ILSA_MESH_EDGE
               ? EXIT_BAD_SCENE
               : EXIT_RUN_FAILED;
}

/* The penny follows from its radius or time, from the material and from the rate. */
static int refused_start(const scene *sc, ilsa_status status, const ilsa_solver *solver) {
    char note[160];
    int by_radius = sc->radius > 0;
    snprintf(note, sizeof note, " = %.10g, with [material] of line %d and the rate of line %d",
             by_radius ? sc->radius : sc->time, sc->headings[SECTION_MATERIAL],
             sc->sources[0].line);
    return refused(sc, SECTION_INITIAL, by_radius ? INITIAL_RADIUS : INITIAL_TIME, note, status,
                   solver);
}

static int start_fracture(const scene *sc, ilsa_solver *solver) {
    double t;
    ilsa_status status = sc->radius > 0 ? ilsa_start_radial(solver, sc->radius)
                                        : ilsa_start_radial_at(solver, sc->time);
    if (status)
        return refused_start(sc, status, solver);
    status = ilsa_get_time(solver, &t);
    if (!status && !scene_check_start(sc, t, stderr))
        return EXIT_BAD_SCENE;
    if (!status)
        status = model_set_rates(sc, solver, t);
    if (status)
        return refused(sc, SECTION_INJECTION, INJECTION_RATE, "", status, solver);
    return reason_outside(sc, solver, stderr) ? EXIT_BAD_SCENE : EXIT_DONE;
}

int model_start(const scene *sc, ilsa_solver **solver) {
    parts p = {0};
    int exit_status = EXIT_DONE;
    *solver = NULL;
    ilsa_status status = make_parts(sc, &p);
    if (!status)
        status = make_solver(sc, &p, solver);
    if (status == ILSA_ERR_MISMATCH)
        exit_status = refused(sc, SECTION_MESH, MESH_symmetry,
                              ": must be one that stress and sources have, or auto", status, NULL);
    else if (status)
        exit_status = refused(sc, SECTION_MESH, MESH_NX, "", status, NULL);
    else
        exit_status = start_fracture(sc, *solver);
    parts_free(&p);
    if (exit_status)
        ilsa_solver_destroy(solver);
    return exit_status;
}

ilsa_status model_set_rates(const scene *sc, ilsa_solver *solver, double t) {
    ilsa_status status = ILSA_OK;
    for (int i = 0; i < sc->source_count && !status; i++)
        status = ilsa_set_rate(solver, i, scene_rate(&sc->sources[i], t));
    return status;
}
