#include "model/model.h"

#include "base/memory.h"
#include "base/tuning.h"
#include "model/material.h"
#include "model/mesh.h"
#include <math.h>

static ilsa_material_def tip_material(const ilsa_material_def *material, ilsa_tip_model tip) {
    ilsa_material_def ruling = *material;
    ruling.C_prime = tip == ILSA_TIP_FULL ? ruling.C_prime : 0;
    ruling.mu_prime = tip == ILSA_TIP_TOUGHNESS ? 0 : ruling.mu_prime;
    return ruling;
}

void ilsai_model_set_viscosity(model *m, double mu_prime) {
    m->material.mu_prime = mu_prime;
    m->tip_material = tip_material(&m->material, m->options.tip);
}

ilsa_status ilsai_model_create(model *m, const ilsa_solver_def *def) {
    *m = (model){.options = *def,
                 .defined = def->mesh->def,
                 .mesh = def->mesh->def,
                 .material = def->material->def};
    m->options.mesh = NULL;
    m->options.material = NULL;
    m->options.stress = NULL;
    m->options.sources = NULL;
    m->options.level = def->level > 0 ? def->level : ILSAI_LEVEL_DEFAULT;
    m->inviscid = m->material.mu_prime == 0;
    ilsai_model_set_viscosity(m, m->material.mu_prime);
    ILSAI_TRY(ilsai_sources_create(&m->sources, def->sources, def->source_count));
    ilsai_sources_place(&m->sources, &m->mesh);
    if (def->stress) {
        ILSAI_TRY(ilsai_cell_field_copy(&def->stress->field, &m->stress));
    }
    m->sigma = ilsai_allocate(ilsai_mesh_cells(&m->mesh), sizeof *m->sigma);
    return m->sigma ? ILSA_OK : ILSA_ERR_MEMORY;
}

void ilsai_model_destroy(model *m) {
    ilsai_sources_destroy(&m->sources);
    ilsai_cell_field_clear(&m->stress);
    ilsai_release(m->sigma);
    *m = (model){0};
}

double ilsai_model_cells_max(const model *m) {
    double most = m->options.cells_max > 0 ? m->options.cells_max : ILSAI_GROW_CELLS;
    return fmax(most, (double)ilsai_mesh_cells(&m->defined));
}

/* Whether the stress of every cell is that of its mirror image. */
static bool sigma_mirrors(const model *m, bool about_x) {
    int nx = m->mesh.nx, ny = m->mesh.ny;
    for (int j = 0; j < ny; j++) {
        for (int i = 0; i < nx; i++) {
            int other = about_x ? j * nx + (nx - 1 - i) : (ny - 1 - j) * nx + i;
            if (m->sigma[j * nx + i] != m->sigma[other]) {
                return false;
            }
        }
    }
    return true;
}

ilsa_status ilsai_model_fill_stress(model *m) {
    ILSAI_TRY(ilsai_cell_field_fill(&m->stress, "stress", &m->mesh, m->sigma));
    m->sigma_is_uniform = !ilsai_cell_field_varies(&m->stress);
    m->sigma_mirror_x = sigma_mirrors(m, true);
    m->sigma_mirror_y = sigma_mirrors(m, false);
    return ILSA_OK;
}

static bool wants_mirror(const model *m, bool about_x) {
    ilsa_symmetry symmetry = m->options.symmetry;
    return symmetry == ILSA_SYMMETRY_AUTO || symmetry == ILSA_SYMMETRY_XY ||
           symmetry == (about_x ? ILSA_SYMMETRY_X : ILSA_SYMMETRY_Y);
}

static bool has_mirror(const model *m, bool about_x) {
    return (about_x ? m->sigma_mirror_x : m->sigma_mirror_y) &&
           ilsai_sources_mirror(&m->sources, about_x);
}

ilsa_status ilsai_model_check_symmetry(const model *m, error_text *error) {
    for (int about_x = 0; about_x < 2; about_x++) {
        if (m->options.symmetry != ILSA_SYMMETRY_AUTO && wants_mirror(m, about_x) &&
            !has_mirror(m, about_x)) {
            return ilsai_fail(error, ILSA_ERR_MISMATCH,
                              "symmetry about %s = 0 asked for: sources or stress do not have it",
                              about_x ? "x" : "y");
        }
    }
    return ILSA_OK;
}

grid ilsai_model_grid(const model *m, bool mirror_x, bool mirror_y) {
    return ilsai_grid(&m->mesh, mirror_x && wants_mirror(m, true) && has_mirror(m, true),
                      mirror_y && wants_mirror(m, false) && has_mirror(m, false));
}
