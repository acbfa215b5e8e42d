#include "step/numerics.h"

#include "base/tuning.h"

static ilsa_status start_threads(numerics *n, int threads, error_text *error) {
    if (threads > 1) {
        n->threads = ilsai_thread_pool_create(threads);
        if (!n->threads) {
            return ilsai_fail(error, ILSA_ERR_MEMORY,
                              "no memory for %d threads, or the system allows no more", threads);
        }
    }
    return ILSA_OK;
}

ilsa_status ilsai_numerics_create(numerics *n, const model *m, error_text *error) {
    static const double step[ILSAI_LEVELS] = ILSAI_LEVEL_STEP;
    static const double tolerance[ILSAI_LEVELS] = ILSAI_LEVEL_TOLERANCE;
    const ilsa_solver_def *options = &m->options;
    *n = (numerics){0};
    n->step_cells = options->step_cells > 0 ? options->step_cells : step[options->level - 1];
    n->tolerance = options->tolerance > 0 ? options->tolerance : tolerance[options->level - 1];
    n->march = ilsai_march_create();
    n->coupled = ilsai_coupled_create(&m->mesh);
    n->acceleration = ilsai_anderson_create(ILSAI_ANDERSON_DEPTH);
    if (!n->march || !n->coupled || !n->acceleration) {
        return ilsai_fail(error, ILSA_ERR_MEMORY, "no memory for a solver of %d x %d cells",
                          m->mesh.nx, m->mesh.ny);
    }
    ilsa_status status = ilsai_elasticity_create(m->material.E_prime, m->mesh.dx, m->mesh.dy,
                                                 options->product, &n->elastic);
    if (status != ILSA_OK) {
        return ilsai_fail(error, status,
                          status == ILSA_ERR_MISMATCH
                              ? "product: this library was built without an FFT"
                              : "no memory for the elasticity");
    }
    return start_threads(n, options->threads, error);
}

void ilsai_numerics_destroy(numerics *n) {
    ilsai_thread_pool_destroy(&n->threads);
    ilsai_march_destroy(&n->march);
    ilsai_coupled_destroy(&n->coupled);
    ilsai_anderson_destroy(&n->acceleration);
    ilsai_elasticity_destroy(&n->elastic);
}
