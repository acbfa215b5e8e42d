#include "flow/lubrication.h"

#include "base/tuning.h"
#include <stdlib.h>

ilsa_status ilsai_lubrication_reserve(lubrication *f, int count) {
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

void ilsai_lubrication_destroy(lubrication *f) {
    free(f->conductance);
    free(f->slope);
}

/* What the loops over the numbered cells need. */
typedef struct setting {
    lubrication *f;
    const unknowns *a;
    const double *width, *width_old, *pressure;
    double scale[GRID_FACES];
} setting;

static void set_faces(void *context, int first, int end) {
    const setting *s = context;
    for (int k = first; k < end; k++) {
        for (int face = 0; face < GRID_FACES; face++) {
            int at = GRID_FACES * k + face, other = s->a->neighbour[at];
            s->f->conductance[at] = s->f->slope[at] = 0;
            if (other >= 0) {
                int here = s->a->cell[k], there = s->a->cell[other];
                double w = 0.5 * (s->width[here] + s->width[there]);
                double mean = 0.5 * w + 0.25 * (s->width_old[here] + s->width_old[there]);
                double rise = s->pressure[there] - s->pressure[here];
                s->f->conductance[at] = s->scale[face] * mean * w * w;
                s->f->slope[at] = s->scale[face] * w * (mean + 0.25 * w) * rise;
            }
        }
    }
}

void ilsai_lubrication_set(lubrication *f, const unknowns *a, const grid *g, const double *width,
                           const double *width_old, const double *pressure,
                           double dt_over_mu_prime) {
    double along_x = dt_over_mu_prime / (g->dx * g->dx);
    double along_y = dt_over_mu_prime / (g->dy * g->dy);
    setting s = {f, a, width, width_old, pressure, {along_x, along_x, along_y, along_y}};
    ilsai_thread_pool_run(f->threads, set_faces, &s, a->count, ILSAI_SHARE_CELLS);
}
