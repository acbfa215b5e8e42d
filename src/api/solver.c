#include "base/tuning.h"
#include "model/material.h"
#include "step/start.h"
#include "step/state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

ilsa_solver_def ilsa_solver_def_default(void) {
    ilsa_solver_def def = {0};
    def.level = 3;
    return def;
}

static ilsa_status check_number(const char *name, double value, double low, double high) {
    return ilsai_check_range(ilsai_thread_error(), name, value, low, high);
}

/* What is not zero must leave room for products. */
static ilsa_status check_magnitudes(const ilsa_mesh_def *mesh, const ilsa_material_def *material) {
    const double most = ILSAI_MAGNITUDE_MOST, least = ILSAI_MAGNITUDE_LEAST;
    ilsa_status status = check_number("dx", mesh->dx, least, most);
    status = status ? status : check_number("dy", mesh->dy, least, most);
    status = status ? status : check_number("E_prime", material->E_prime, least, most);
    if (material->mu_prime != 0) {
        status = status ? status : check_number("mu_prime", material->mu_prime, least, most);
    }
    status = status ? status : check_number("K_prime", material->K_prime, 0, most);
    return status ? status : check_number("C_prime", material->C_prime, 0, most);
}

static ilsa_status check_options(const ilsa_solver_def *def) {
    ilsa_status status = check_number("source_count", def->source_count, 1, 1000);
    status = status ? status : check_number("level", def->level, 1, ILSAI_LEVELS);
    status = status ? status : check_number("tip", (double)def->tip, 0, 2);
    status = status ? status : check_number("symmetry", (double)def->symmetry, 0, 4);
    status = status ? status : check_number("loop", (double)def->loop, 0, 1);
    status = status ? status : check_number("linear", (double)def->linear, 0, 2);
    status = status ? status : check_number("product", (double)def->product, 0, 2);
    status = status ? status : check_number("coarsen", def->coarsen, 0, 1);
    status = status ? status : check_number("threads", def->threads, 0, ILSAI_THREADS);
    if (def->step_cells != 0) {
        status = status ? status : check_number("step_cells", def->step_cells, 0.01, 1);
    }
    if (def->tolerance != 0) {
        status = status ? status : check_number("tolerance", def->tolerance, 1e-12, 0.1);
    }
    status =
        status ? status : ilsai_check_not_negative(ilsai_thread_error(), "dt_max", def->dt_max);
    return status ? status
                  : ilsai_check_not_negative(ilsai_thread_error(), "closure_width",
                                             def->closure_width);
}

static ilsa_status check_source(const ilsa_mesh_def *mesh, const ilsa_source_def *source) {
    double half_x = 0.5 * mesh->nx * mesh->dx, half_y = 0.5 * mesh->ny * mesh->dy;
    ilsa_status status = check_number("source x", source->x, -half_x, half_x);
    status = status ? status : check_number("source y", source->y, -half_y, half_y);
    return status ? status : check_number("source rate", source->rate, 0, ILSAI_MAGNITUDE_MOST);
}

/* A front without toughness has no width under LEFM. */
static ilsa_status check_tip(const ilsa_solver_def *def) {
    if (def->tip == ILSA_TIP_TOUGHNESS && def->material->def.K_prime == 0) {
        return ilsai_fail(ilsai_thread_error(), ILSA_ERR_MISMATCH,
                          "tip = ILSA_TIP_TOUGHNESS: the material has K_prime = 0: must be > 0");
    }
    return ILSA_OK;
}

static ilsa_status check_def(const ilsa_solver_def *def) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "mesh", def->mesh);
    status = status ? status : ilsai_check_pointer(error, "material", def->material);
    status = status ? status : ilsai_check_pointer(error, "sources", def->sources);
    status = status ? status : check_options(def);
    status = status ? status : check_magnitudes(&def->mesh->def, &def->material->def);
    status = status ? status : check_tip(def);
    for (int k = 0; status == ILSA_OK && k < def->source_count; k++) {
        status = check_source(&def->mesh->def, &def->sources[k]);
    }
    return status;
}

static ilsa_status copy_sources(ilsa_solver *s, const ilsa_solver_def *def) {
    s->sources = calloc((size_t)def->source_count, sizeof *s->sources);
    if (!s->sources) {
        return ILSA_ERR_MEMORY;
    }
    for (int k = 0; k < def->source_count; k++) {
        s->sources[k].def = def->sources[k];
    }
    ilsai_sources_place(s);
    return ILSA_OK;
}

static ilsa_status copy_stress(ilsa_solver *s, const ilsa_stress *stress) {
    if (stress) {
        return ilsai_stress_copy(stress, &s->stress);
    }
    ilsa_stress_def zero = ilsa_stress_def_default();
    return ilsa_stress_create(&zero, &s->stress);
}

/* The material without the processes that the tip model leaves out. */
static ilsa_material_def asymptote_of(const ilsa_material_def *material, ilsa_tip_model tip) {
    ilsa_material_def law = *material;
    law.C_prime = tip == ILSA_TIP_FULL ? law.C_prime : 0;
    law.mu_prime = tip == ILSA_TIP_TOUGHNESS ? 0 : law.mu_prime;
    return law;
}

void ilsai_solver_set_viscosity(ilsa_solver *s, double mu_prime) {
    s->now.mu_prime = s->material.mu_prime = mu_prime;
    s->tip_material = asymptote_of(&s->material, s->def.tip);
}

static void set_options(ilsa_solver *s, const ilsa_solver_def *def) {
    static const double step[ILSAI_LEVELS] = ILSAI_LEVEL_STEP;
    static const double tolerance[ILSAI_LEVELS] = ILSAI_LEVEL_TOLERANCE;
    s->def = *def;
    s->def.mesh = NULL;
    s->def.material = NULL;
    s->def.stress = NULL;
    s->def.sources = NULL;
    s->mesh = def->mesh->def;
    s->material = def->material->def;
    s->tip_material = asymptote_of(&s->material, def->tip);
    s->inviscid = s->material.mu_prime == 0;
    s->step_cells = def->step_cells > 0 ? def->step_cells : step[def->level - 1];
    s->tolerance = def->tolerance > 0 ? def->tolerance : tolerance[def->level - 1];
}

static ilsa_status allocate(ilsa_solver *s) {
    size_t count = ilsai_mesh_cells(&s->mesh);
    int leak_off = ilsai_has_leakoff(s);
    s->sigma = malloc(count * sizeof(double));
    s->source_term = malloc(count * sizeof(double));
    s->leak = malloc(count * sizeof(double));
    s->retained = leak_off ? calloc(count, sizeof(double)) : NULL;
    s->contact = calloc(count, 1);
    s->self_correction = malloc(count * sizeof(double));
    s->march = ilsai_march_create();
    s->coupled = ilsai_coupled_create(&s->mesh);
    s->acceleration = ilsai_anderson_create(ILSAI_ANDERSON_DEPTH);
    if (!s->sigma || !s->source_term || !s->leak || (leak_off && !s->retained) || !s->contact ||
        !s->self_correction || !s->march || !s->coupled || !s->acceleration ||
        ilsai_fields_create(&s->field, &s->mesh, leak_off) != ILSA_OK ||
        ilsai_fields_create(&s->trial, &s->mesh, 0) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    return ILSA_OK;
}

static ilsa_status start_threads(ilsa_solver *s) {
    if (s->def.threads > 1) {
        s->threads = ilsai_thread_pool_create(s->def.threads);
        if (!s->threads) {
            return ilsai_fail(ilsai_thread_error(), ILSA_ERR_MEMORY,
                              "no memory for %d threads, or the system allows no more",
                              s->def.threads);
        }
    }
    return ILSA_OK;
}

static ilsa_status build(ilsa_solver *s, const ilsa_solver_def *def) {
    error_text *error = ilsai_thread_error();
    set_options(s, def);
    if (copy_sources(s, def) != ILSA_OK || copy_stress(s, def->stress) != ILSA_OK ||
        allocate(s) != ILSA_OK) {
        return ilsai_fail(error, ILSA_ERR_MEMORY, "no memory for a solver of %d x %d cells",
                          s->mesh.nx, s->mesh.ny);
    }
    ilsa_status status = ilsai_elasticity_create(s->material.E_prime, s->mesh.dx, s->mesh.dy,
                                                 def->product, &s->elastic);
    if (status != ILSA_OK) {
        return ilsai_fail(error, status,
                          status == ILSA_ERR_MISMATCH
                              ? "product: this library was built without an FFT"
                              : "no memory for the elasticity");
    }
    status = ilsai_solver_fill_stress(s);
    status = status ? status : ilsai_symmetry_check(s);
    return status ? status : start_threads(s);
}

ilsa_status ilsa_solver_create(const ilsa_solver_def *def, ilsa_solver **solver) {
    error_text *error = ilsai_thread_error();
    if (!solver) {
        return ilsai_check_pointer(error, "solver", solver);
    }
    *solver = NULL;
    ilsa_status status = ilsai_check_pointer(error, "def", def);
    status = status ? status : check_def(def);
    if (status != ILSA_OK) {
        return status;
    }
    ilsa_solver *s = calloc(1, sizeof *s);
    if (!s) {
        return ilsai_fail(error, ILSA_ERR_MEMORY, "no memory for a solver");
    }
    status = build(s, def);
    if (status != ILSA_OK) {
        ilsa_solver_destroy(&s);
    }
    *solver = s;
    return status;
}

void ilsa_solver_destroy(ilsa_solver **solver) {
    if (!solver || !*solver) {
        return;
    }
    ilsa_solver *s = *solver;
    ilsai_thread_pool_destroy(&s->threads);
    ilsa_stress_destroy(&s->stress);
    ilsai_fields_destroy(&s->field);
    ilsai_fields_destroy(&s->trial);
    ilsai_march_destroy(&s->march);
    ilsai_coupled_destroy(&s->coupled);
    ilsai_anderson_destroy(&s->acceleration);
    ilsai_elasticity_destroy(&s->elastic);
    free(s->sources);
    free(s->tips.at);
    free(s->trial_tips.at);
    free(s->source_term);
    free(s->leak);
    free(s->retained);
    free(s->contact);
    free(s->self_correction);
    free(s->survey_cells);
    free(s->sensitivities);
    free(s->width_slope);
    free(s->distance);
    free(s->next_distance);
    free(s->sigma);
    free(s->front_points);
    free(s->survey_points);
    free(s);
    *solver = NULL;
}

const char *ilsa_last_error(const ilsa_solver *solver) {
    return solver ? solver->error.text : ilsai_thread_error()->text;
}

/*
 * The material that the penny is made with. The viscosity mu' counts as mu' Q E'^3 / (K'^4 R), to
 * the toughness, in a penny of radius R without leak-off, and less with it.
 */
static ilsa_material_def start_material(const ilsa_solver *s) {
    ilsa_material_def m = s->material;
    if (s->inviscid) {
        double R = fmin(s->mesh.dx, s->mesh.dy), Q = s->sources[0].def.rate;
        m.mu_prime =
            exp(log(ILSAI_INVISCID) + 4 * log(m.K_prime) + log(R) - log(Q) - 3 * log(m.E_prime));
    }
    return m;
}

/* Starts from a solution that was found for a radius or a time; what says which and its value. */
static ilsa_status start(ilsa_solver *s, ilsa_status found, const penny_solution *solution,
                         const char *what, double value) {
    if (found != ILSA_OK) {
        return ilsai_fail(&s->error, found, "%s = %g: no penny-shaped fracture can be found", what,
                          value);
    }
    ilsa_status status = ilsai_start_check(s, solution);
    if (status == ILSA_OK) {
        ilsai_start_lay(s, solution);
    }
    return status;
}

static ilsa_status check_start(ilsa_solver *s, const char *what, double value) {
    if (!s) {
        return ilsai_check_pointer(ilsai_thread_error(), "solver", s);
    }
    ilsa_status status = ilsai_check_positive(&s->error, what, value);
    return status ? status
                  : ilsai_check_positive(&s->error, "rate of source 0", s->sources[0].def.rate);
}

ilsa_status ilsa_start_radial(ilsa_solver *solver, double radius) {
    ilsa_status status = check_start(solver, "radius", radius);
    if (status != ILSA_OK) {
        return status;
    }
    penny_solution solution;
    ilsa_material_def material = start_material(solver);
    status = ilsai_penny_at_radius(&material, solver->sources[0].def.rate, radius, &solution);
    return start(solver, status, &solution, "radius", radius);
}

ilsa_status ilsa_start_radial_at(ilsa_solver *solver, double time) {
    ilsa_status status = check_start(solver, "time", time);
    if (status != ILSA_OK) {
        return status;
    }
    penny_solution solution;
    ilsa_material_def material = start_material(solver);
    status = ilsai_penny_at_time(&material, solver->sources[0].def.rate, time, &solution);
    return start(solver, status, &solution, "time", time);
}

ilsa_status ilsa_set_rate(ilsa_solver *solver, int source, double rate) {
    if (!solver) {
        return ilsai_check_pointer(ilsai_thread_error(), "solver", solver);
    }
    if (source < 0 || source >= solver->def.source_count) {
        return ilsai_fail(&solver->error, ILSA_ERR_VALUE, "source = %d: must be 0 .. %d", source,
                          solver->def.source_count - 1);
    }
    ilsa_status status = ilsai_check_range(&solver->error, "rate", rate, 0, ILSAI_MAGNITUDE_MOST);
    if (status == ILSA_OK && solver->sources[source].def.rate != rate) {
        solver->sources[source].def.rate = rate;
        solver->now.dt_limit = INFINITY;
    }
    return status;
}

ilsa_status ilsa_set_stress(ilsa_solver *solver, const ilsa_stress *stress) {
    if (!solver || !stress) {
        error_text *error = solver ? &solver->error : ilsai_thread_error();
        return ilsai_check_pointer(error, solver ? "stress" : "solver", NULL);
    }
    ilsa_stress *fresh, *old = solver->stress;
    ilsa_status status = ilsai_stress_copy(stress, &fresh);
    if (status == ILSA_OK) {
        solver->stress = fresh;
        status = ilsai_solver_fill_stress(solver);
        if (status != ILSA_OK) {
            solver->stress = old;
            old = fresh;
        }
        ilsa_stress_destroy(&old);
    }
    return status == ILSA_OK ? ILSA_OK
                             : ilsai_fail(&solver->error, status, "%s", ilsai_thread_error()->text);
}

ilsa_status ilsa_get_mesh_def(const ilsa_solver *solver, ilsa_mesh_def *def) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "solver", solver);
    status = status ? status : ilsai_check_pointer(error, "def", def);
    if (status == ILSA_OK) {
        *def = solver->mesh;
    }
    return status;
}
