#include "flow.h"

#include <stdlib.h>

ilsa_status ilsai_flow_reserve(flow *f, int count) {
    if (count <= f->capacity) {
        return ILSA_OK;
    }
    size_t capacity = (size_t)count + (size_t)count / 2 + 64;
    double *conductance = realloc(f->conductance, GRID_FACES * capacity * sizeof *conductance);
    f->conductance = conductance ? conductance : f->conductance;
    double *slope = realloc(f->slope, GRID_FACES * capacity * sizeof *slope);
    f->slope = slope ? slope : f->slope;
    if (!conductance || !slope) {
        return ILSA_ERR_MEMORY;
    }
    f->capacity = (int)capacity;
    return ILSA_OK;
}

void ilsai_flow_destroy(flow *f) {
    free(f->conductance);
    free(f->slope);
}

void ilsai_flow_set(flow *f, const active *a, const grid *g, const double *width,
                    const double *width_old, const double *pressure, double dt_over_mu_prime) {
    const double scale[GRID_FACES] = {
        dt_over_mu_prime / (g->dx * g->dx), dt_over_mu_prime / (g->dx * g->dx),
        dt_over_mu_prime / (g->dy * g->dy), dt_over_mu_prime / (g->dy * g->dy)};
    for (int k = 0; k < a->count; k++) {
        for (int face = 0; face < GRID_FACES; face++) {
            int at = GRID_FACES * k + face, other = a->neighbour[at];
            f->conductance[at] = f->slope[at] = 0;
            if (other >= 0) {
                int here = a->cell[k], there = a->cell[other];
                double w = 0.5 * (width[here] + width[there]);
                double mean = 0.5 * w + 0.25 * (width_old[here] + width_old[there]);
                f->conductance[at] = scale[face] * mean * w * w;
                f->slope[at] =
                    scale[face] * w * (mean + 0.25 * w) * (pressure[there] - pressure[here]);
            }
        }
    }
}

void ilsai_flow_gain(const flow *f, const active *a, const double *pressure, double *gain) {
    for (int k = 0; k < a->count; k++) {
        double sum = 0, p = pressure[a->cell[k]];
        for (int face = 0; face < GRID_FACES; face++) {
            int at = GRID_FACES * k + face, other = a->neighbour[at];
            if (other >= 0) {
                sum += f->conductance[at] * (pressure[a->cell[other]] - p);
            }
        }
        gain[k] = sum;
    }
}
