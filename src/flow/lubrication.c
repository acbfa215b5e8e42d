#include "flow/lubrication.h"

#include "base/memory.h"
#include "base/tuning.h"

ilsa_status ilsai_lubrication_reserve(lubrication *f, int count) {
    const grown_array arrays[] = {ILSAI_GROWN(f->conductance), ILSAI_GROWN(f->slope)};
    return ilsai_grow(GRID_FACES * (size_t)count, &f->capacity, arrays,
                      sizeof arrays / sizeof *arrays);
}

void ilsai_lubrication_destroy(lubrication *f) {
    ilsai_release(f->conductance);
    ilsai_release(f->slope);
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
