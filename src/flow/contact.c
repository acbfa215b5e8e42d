#include "flow/contact.h"

/* The cell that the fluid in face `at` of numbered cell k comes from, the same from both sides. */
static int upstream(const lubrication *l, int k, int at, int other) {
    return l->flux[at] > 0 || (l->flux[at] == 0 && other < k) ? other : k;
}

/* Holds back the fluid in face `at` of numbered cell k, which leads to another. */
static void restrain_face(lubrication *l, int k, int at, int other, const double *openness,
                          const double *slope) {
    int from = upstream(l, k, at, other);
    bool passes = openness[k] > 0 && openness[other] > 0;
    double by_upstream = l->flux[at] * slope[from];
    if (from == k) {
        l->by_own_width[k] += by_upstream;
    } else {
        l->by_width_across[at] = by_upstream;
    }
    l->flux[at] *= openness[from];
    l->by_pressure[at] *= openness[from];
    l->by_width[at] *= passes ? openness[from] : 0;
}

void ilsai_contact_restrain(lubrication *l, const unknowns *cells, const double *openness,
                            const double *slope) {
    l->restrained = true;
    for (int k = 0; k < cells->count; k++) {
        l->by_own_width[k] = 0;
        for (int face = 0; face < GRID_FACES; face++) {
            int at = GRID_FACES * k + face, other = cells->neighbour[at];
            l->by_width_across[at] = 0;
            if (other < 0) {
                continue;
            }
            if (cells->unknown[k] == UNKNOWN_NONE || cells->unknown[other] == UNKNOWN_NONE) {
                l->flux[at] = l->by_pressure[at] = l->by_width[at] = 0;
            } else if (openness[k] < 1 || openness[other] < 1) {
                restrain_face(l, k, at, other, openness, slope);
            }
        }
    }
}
