#include "step/solver.h"
#include "base/memory.h"
#include "base/tuning.h"
#include "model/material.h"
#include "model/mesh.h"
#include "model/options.h"
#include "step/start.h"

#include <math.h>

ilsa_solver_def ilsa_solver_def_default(void) {
    ilsa_solver_def def = {0};
    def.level = ILSAI_LEVEL_DEFAULT;
    return def;
}

/* A front without toughness has no width under LEFM. */
static ilsa_status check_tip(const ilsa_solver_def *def, error_text *error) {
    if (def->tip == ILSA_TIP_TOUGHNESS && def->material->def.K_prime == 0) {
        return ilsai_fail(error, ILSA_ERR_MISMATCH,
                          "tip = ILSA_TIP_TOUGHNESS: the material has K_prime = 0: must be > 0");
    }
    return ILSA_OK;
}

static ilsa_status check_def(const ilsa_solver_def *def, error_text *error) {
    ILSAI_TRY(ilsai_check_pointer(error, "def", def));
    ILSAI_TRY(ilsai_check_pointer(error, "mesh", def->mesh));
    ILSAI_TRY(ilsai_check_pointer(error, "material", def->material));
    ILSAI_TRY(ilsai_check_pointer(error, "sources", def->sources));
    ILSAI_TRY(ilsai_check_range(error, "source_count", def->source_count, 1, ILSAI_SOURCES));
    ILSAI_TRY(ilsai_options_check(def, error));
    ILSAI_TRY(check_tip(def, error));
    for (int k = 0; k < def->source_count; k++) {
        ILSAI_TRY(ilsai_source_check(&def->mesh->def, &def->sources[k], error));
    }
    return ILSA_OK;
}

/* Fills a solver of zeros; what has been made by a failure is destroyed with it. */
static ilsa_status build(ilsa_solver *s, const ilsa_solver_def *def, error_text *error) {
    s->handed_out.kind = ilsai_allocate_zeroed(ilsai_mesh_cells(&def->mesh->def), 1);
    if (!s->handed_out.kind || ilsai_model_create(&s->model, def) != ILSA_OK ||
        ilsai_fracture_create(&s->fracture, &s->model) != ILSA_OK ||
        ilsai_trial_create(&s->trial, &s->model) != ILSA_OK) {
        return ilsai_fail(error, ILSA_ERR_MEMORY, "no memory for a solver of %d x %d cells",
                          def->mesh->def.nx, def->mesh->def.ny);
    }
    ILSAI_TRY(ilsai_model_fill_stress(&s->model));
    ILSAI_TRY(ilsai_model_check_symmetry(&s->model, error));
    return ilsai_numerics_create(&s->numerics, &s->model, error);
}

ilsa_status ilsa_solver_create(const ilsa_solver_def *def, ilsa_solver **solver) {
    error_text *error = ilsai_thread_error();
    if (!solver) {
        return ilsai_check_pointer(error, "solver", solver);
    }
    *solver = NULL;
    ILSAI_TRY(check_def(def, error));
    ilsa_solver *s = ilsai_allocate_zeroed(1, sizeof *s);
    if (!s) {
        return ilsai_fail(error, ILSA_ERR_MEMORY, "no memory for a solver");
    }
    ilsa_status status = build(s, def, error);
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
    ilsai_numerics_destroy(&s->numerics);
    ilsai_trial_destroy(&s->trial);
    ilsai_fracture_destroy(&s->fracture);
    ilsai_model_destroy(&s->model);
    ilsai_release(s->handed_out.front);
    ilsai_release(s->handed_out.survey);
    ilsai_release(s->handed_out.kind);
    ilsai_release(s);
    *solver = NULL;
}

const char *ilsa_last_error(const ilsa_solver *solver) {
    return solver && !ilsai_reading_failed() ? solver->error.text : ilsai_thread_error()->text;
}

/*
 * The material that the penny is made with. The viscosity mu' counts as mu' Q E'^3 / (K'^4 R), to
 * the toughness, in a penny of radius R without leak-off, and less with it.
 */
static ilsa_material_def start_material(const model *m) {
    ilsa_material_def start = m->material;
    if (m->inviscid) {
        double R = fmin(m->mesh.dx, m->mesh.dy), Q = m->sources.at[0].def.rate;
        start.mu_prime = exp(log(ILSAI_INVISCID) + 4 * log(start.K_prime) + log(R) - log(Q) -
                             3 * log(start.E_prime));
    }
    return start;
}

/* Finds the penny of a radius, or of a time. */
typedef ilsa_status find_penny(const ilsa_material_def *material, double rate, double value,
                               penny_solution *solution);

/* Starts from the penny that has a value of what the name says. */
static ilsa_status start(ilsa_solver *s, const char *name, double value, find_penny *find) {
    if (!s) {
        return ilsai_check_pointer(ilsai_thread_error(), "solver", s);
    }
    double rate = s->model.sources.at[0].def.rate;
    ILSAI_TRY(ilsai_check_positive(&s->error, name, value));
    ILSAI_TRY(ilsai_check_positive(&s->error, "rate of source 0", rate));
    penny_solution solution;
    ilsa_material_def material = start_material(&s->model);
    ilsa_status status = find(&material, rate, value, &solution);
    if (status != ILSA_OK) {
        return ilsai_fail(&s->error, status, "%s = %g: no penny-shaped fracture can be found", name,
                          value);
    }
    ILSAI_TRY(ilsai_start_check(s, &solution));
    ilsai_start_lay(s, &solution);
    return ILSA_OK;
}

ilsa_status ilsa_start_radial(ilsa_solver *solver, double radius) {
    return start(solver, "radius", radius, ilsai_penny_at_radius);
}

ilsa_status ilsa_start_radial_at(ilsa_solver *solver, double time) {
    return start(solver, "time", time, ilsai_penny_at_time);
}

ilsa_status ilsa_set_rate(ilsa_solver *solver, int source, double rate) {
    if (!solver) {
        return ilsai_check_pointer(ilsai_thread_error(), "solver", solver);
    }
    sources *all = &solver->model.sources;
    if (source < 0 || source >= all->count) {
        return ilsai_fail(&solver->error, ILSA_ERR_VALUE, "source = %d: must be 0 .. %d", source,
                          all->count - 1);
    }
    ILSAI_TRY(ilsai_check_range(&solver->error, "rate", rate, 0, ILSAI_MAGNITUDE_MOST));
    if (all->at[source].def.rate != rate) {
        all->at[source].def.rate = rate;
        solver->pace.dt_limit = INFINITY;
    }
    return ILSA_OK;
}

ilsa_status ilsa_set_stress(ilsa_solver *solver, const ilsa_stress *stress) {
    if (!solver || !stress) {
        error_text *error = solver ? &solver->error : ilsai_thread_error();
        return ilsai_check_pointer(error, solver ? "stress" : "solver", NULL);
    }
    model *m = &solver->model;
    cell_field old = m->stress;
    ilsa_status status = ilsai_cell_field_copy(&stress->field, &m->stress);
    status = status ? status : ilsai_model_fill_stress(m);
    if (status != ILSA_OK) {
        ilsai_cell_field_clear(&m->stress);
        m->stress = old;
        return ilsai_fail(&solver->error, status, "%s", ilsai_thread_error()->text);
    }
    ilsai_cell_field_clear(&old);
    return ILSA_OK;
}
