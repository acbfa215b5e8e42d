#include "flow/newtonian.h"

#include "base/tuning.h"

/* A loop over the numbered cells. */
typedef struct loop {
    lubrication *l;
    const flow_state *state;
    double scale[GRID_FACES]; /* dt / (mu' h^2), h the distance of the centres across the face */
} loop;

static void set_cells(void *context, int first, int end) {
    const loop *c = context;
    const flow_state *s = c->state;
    for (int k = first; k < end; k++) {
        for (int face = 0; face < GRID_FACES; face++) {
            int at = GRID_FACES * k + face, other = s->cells->neighbour[at];
            c->l->flux[at] = c->l->by_pressure[at] = c->l->by_width[at] = 0;
            if (other >= 0) {
                int here = s->cells->cell[k], there = s->cells->cell[other];
                double w = 0.5 * (s->width[here] + s->width[there]);
                double mean = 0.5 * w + 0.25 * (s->width_old[here] + s->width_old[there]);
                double rise = s->pressure[there] - s->pressure[here];
                double conductance = c->scale[face] * mean * w * w;
                c->l->flux[at] = conductance * rise;
                c->l->by_pressure[at] = conductance;
                c->l->by_width[at] = c->scale[face] * w * (mean + 0.25 * w) * rise;
            }
        }
    }
}

static void set_fluxes(lubrication *l, const flow_state *state) {
    const grid *g = state->g;
    double dt_over_mu = state->dt / state->material->mu_prime;
    double along_x = dt_over_mu / (g->dx * g->dx), along_y = dt_over_mu / (g->dy * g->dy);
    loop c = {l, state, {along_x, along_x, along_y, along_y}};
    ilsai_thread_pool_run(state->threads, set_cells, &c, state->cells->count, ILSAI_SHARE_CELLS);
}

const fluid ilsai_newtonian = {"newtonian", set_fluxes};
