#include "flow/contact.h"

double ilsai_contact_gain(const lubrication *l, const unknowns *cells, const double *openness,
                          int k) {
    double sum = 0;
    for (int face = 0; face < GRID_FACES; face++) {
        int at = GRID_FACES * k + face, other = cells->neighbour[at];
        sum += l->flux[at] > 0 ? l->flux[at] * openness[other] : l->flux[at];
    }
    return sum;
}

void ilsai_contact_calm(lubrication *l, const unknowns *cells, int k, double self) {
    double by_width = 0, stiffness = 1;
    for (int face = 0; face < GRID_FACES; face++) {
        by_width += l->by_width[GRID_FACES * k + face];
        stiffness += self * l->by_pressure[GRID_FACES * k + face];
    }
    for (int face = 0; face < GRID_FACES && by_width > CONTACT_CALM * stiffness; face++) {
        int at = GRID_FACES * k + face, other = cells->neighbour[at];
        l->by_width[at] = 0;
        for (int back = 0; other >= 0 && back < GRID_FACES; back++) {
            int from = GRID_FACES * other + back;
            l->by_width[from] *= cells->neighbour[from] != k;
        }
    }
}

/* The cell that the fluid in face `at` of numbered cell k comes from, the same from both sides. */
static int upstream(const lubrication *l, int k, int at, int other) {
    return l->flux[at] > 0 || (l->flux[at] == 0 && other < k) ? other : k;
}

/* Holds back the fluid in face `at` of numbered cell k, which leads to another. */
static void restrain_face(lubrication *l, int k, int at, int other, const double *openness,
                          const double *slope) {
    int from = upstream(l, k, at, other);
    double by_upstream = l->flux[at] * slope[from];
    if (from == k) {
        l->by_own_width[k] += by_upstream;
    } else {
        l->by_width_across[at] = by_upstream;
    }
    l->flux[at] *= openness[from];
    l->by_pressure[at] *= openness[from];
    l->by_width[at] *= openness[from];
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
