/*
 * Where the error goes: parts of the method fed with the exact penny-shaped solution, one at a
 * time, as Markdown tables for docs/accuracy.md.
 *
 *     bench_accuracy_parts [marching] [survey] [elasticity]
 */
#include "common_radial.h"

#include "elasticity.h"
#include "front.h"
#include "radial.h"
#include "step.h"
#include "tipcell.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Advance of the front in a step, in cells. */
static const double STEP = 0.4;

/* A circle of cells = 1 / h per radius around the middle cell of n by n; E' = Q = 1. */
typedef struct disc {
    int n;
    double h, R; /* R is the radius; the footprint's may be behind it */
    grid g;
    box footprint;
    unsigned char *kind;
    double *width; /* of cells; 0 in the channel until solved for */
} disc;

static void *allocate(size_t count, size_t size) {
    void *block = calloc(count, size);
    if (!block) {
        fprintf(stderr, "no memory\n");
        exit(EXIT_FAILURE);
    }
    return block;
}

static double radius_of(const disc *d, int cell) {
    return hypot(ilsai_grid_x(&d->g, cell % d->n), ilsai_grid_y(&d->g, cell / d->n));
}

/* The front of radius R in a cell, as the march would see it. */
static tipcell_front front_in(const disc *d, int cell, double R) {
    const double x = fabs(ilsai_grid_x(&d->g, cell % d->n)), r = radius_of(d, cell);
    const double y = fabs(ilsai_grid_y(&d->g, cell / d->n));
    tipcell_front f = {0, r > 0 ? x / r : 1, r > 0 ? y / r : 0, d->h, d->h};
    f.ell = 0.5 * d->h * (f.cos_a + f.sin_a) - (r - R);
    return f;
}

/* Kinds of cells as a step would have them that ended with the footprint of radius R_kind. */
static disc make_disc(double cells, double R, double R_kind) {
    disc d = {.h = R / cells, .R = R};
    d.n = 2 * ((int)ceil(cells) + 5) + 1;
    const ilsa_mesh_def mesh = {d.n, d.n, d.h, d.h};
    const int count = d.n * d.n;
    d.g = ilsai_grid(&mesh, 0, 0);
    d.footprint = (box){d.n, -1, d.n, -1};
    d.kind = allocate((size_t)count, 1);
    d.width = allocate((size_t)count, sizeof *d.width);
    for (int cell = 0; cell < count; cell++) {
        const tipcell_front f = front_in(&d, cell, R_kind);
        if (f.ell <= 1e-4 * d.h)
            continue;
        d.kind[cell] = f.ell < d.h * (f.cos_a + f.sin_a) ? ILSA_CELL_TIP : ILSA_CELL_CHANNEL;
        ilsai_box_add(&d.footprint, cell % d.n, cell / d.n);
    }
    ilsai_step_classify(&d.g, &d.footprint, d.kind);
    return d;
}

static void free_disc(disc *d) {
    free(d->kind);
    free(d->width);
}

/* Error of a radius seen from cells around the front, in parts of it: mean, axis, diagonal. */
typedef struct spread {
    double sum, low, high, axis, diagonal;
    int count, on_axis, on_diagonal;
} spread;

static const spread no_spread = {.low = INFINITY, .high = -INFINITY};

static void add(spread *s, const disc *d, int cell, double error) {
    const double x = fabs(ilsai_grid_x(&d->g, cell % d->n));
    const double y = fabs(ilsai_grid_y(&d->g, cell / d->n));
    const double slope = fmin(x, y) / fmax(x, y);
    s->sum += error;
    s->count++;
    s->low = fmin(s->low, error);
    s->high = fmax(s->high, error);
    if (slope < 0.2) {
        s->axis += error;
        s->on_axis++;
    } else if (slope > 0.7) {
        s->diagonal += error;
        s->on_diagonal++;
    }
}

static void print_spread(const spread *s) {
    printf(" %+.2f | %+.2f | %+.2f |", 100 * s->sum / s->count, 100 * s->axis / s->on_axis,
           100 * s->diagonal / s->on_diagonal);
}

/* ---- Marching ----------------------------------------------------------------------------- */

/*
 * Marches from exact distances; footprint_cells: how far the footprint is behind the front;
 * curved: with the exact curvature of the front.
 */
static void march(double cells, double footprint_cells, int curved, spread *s) {
    disc d = make_disc(cells, 1, 1 - footprint_cells / cells);
    const int count = d.n * d.n;
    const box all = {0, d.n - 1, 0, d.n - 1};
    front_seed *seeds = allocate((size_t)count, sizeof *seeds);
    double *level = allocate((size_t)count, sizeof *level);
    front *f = ilsai_front_create();
    int seed_count = 0, reached = 0;
    for (int cell = 0; cell < count; cell++)
        if (d.kind[cell] == ILSA_CELL_SURVEY) {
            const double distance = 1 - radius_of(&d, cell);
            seeds[seed_count++] = (front_seed){.cell = cell,
                                               .s0 = distance,
                                               .h = d.h,
                                               .s = distance,
                                               .V = 1,
                                               .w = 1,
                                               .inner = -1,
                                               .curvature = curved ? 1 : 0};
        }
    if (f && ilsai_front_march(f, &d.g, &all, d.kind, seeds, seed_count, 2 * d.h, level) == ILSA_OK)
        for (const front_cell *c = ilsai_front_cells(f, &reached); reached-- > 0; c++)
            if (c->ell > 0)
                add(s, &d, c->cell, radius_of(&d, c->cell) - c->T - 1);
    ilsai_front_destroy(&f);
    free(level);
    free(seeds);
    free_disc(&d);
}

static void marching_row(double cells, double behind, int curved) {
    spread s = no_spread;
    double difference = 0;
    for (int k = 0; k < 10; k++) {
        spread one = no_spread;
        march(cells + 0.1 * k, behind, curved, &one);
        march(cells + 0.1 * k, behind, curved, &s);
        difference += 0.1 * (one.high - one.low);
    }
    printf("| %g | %g | %s |", cells, behind, curved ? "yes" : "no");
    print_spread(&s);
    printf(" %.2f |\n", 100 * difference);
}

static void marching(void) {
    printf("\n### Marching alone\n\nExact distances in the survey cells; the radius that the tip "
           "cells then see, error in %% of it; mean of 10 positions of the front in the cells. "
           "Without the front's curvature the update is the paper's (4.12).\n\n"
           "| cells per radius | footprint behind by, cells | curvature | mean | axis | diagonal | "
           "largest - smallest |\n|---|---|---|---|---|---|---|\n");
    for (double cells = 5; cells <= 80; cells *= 2)
        for (int k = 0; k < 4; k++)
            marching_row(cells, 0.5 * (k % 2), k / 2);
}

/* ---- Survey cells ------------------------------------------------------------------------- */

enum { CASES = 5 };
static const struct {
    penny_law law;
    double time;
} cases[CASES] = {{{"M", 1, 0, 0}, 1},
                  {{"M-tilde", 1, 0, 1}, 100},
                  {{"K", 1, 1, 0}, 1e5},
                  {{"K-tilde", 1e-4, 1, 1}, 100},
                  {{"phi 1e-4, tau 1", 1, 1, 0.1}, 1}};

static radial_solution solution_of(int k) {
    const ilsa_material_def scaled = {1, cases[k].law.mu_prime, cases[k].law.K_prime,
                                      cases[k].law.C_prime};
    radial_solution s;
    if (ilsai_radial_at_time(&scaled, 1, cases[k].time, &s) != ILSA_OK) {
        fprintf(stderr, "%s: no solution\n", cases[k].law.name);
        exit(EXIT_FAILURE);
    }
    return s;
}

/*
 * The radius that a survey cell at `distance` behind the front sees by (4.9) with width w, less the
 * true one, in parts of it; the step moves the front by STEP cells of size h.
 */
static double survey_error(const radial_solution *s, double distance, double w, double h) {
    const double before = 1 - STEP * h / s->R;
    const double dt = s->t - ilsai_radial_arrival(s, before);
    double found = 0, V;
    if (ilsa_tip_distance(&s->scaled, w, distance - STEP * h, dt, &found, &V) != ILSA_OK)
        return NAN;
    return (found - distance) / s->R;
}

static void survey(void) {
    const double distance[] = {0.75, 1, 1.5, 2};
    printf(
        "\n### Survey cells alone\n\nThe inversion (4.9) of the exact width: error of the radius "
        "in %% of it, by the distance of the cell from the front, in cells. The tip asymptote is "
        "of a half-plane: the penny departs from it in the first order of s/R.\n\n"
        "| case | cells per radius | s = 0.75 | 1 | 1.5 | 2 |\n|---|---|---|---|---|---|\n");
    for (int k = 0; k < CASES; k++) {
        const radial_solution s = solution_of(k);
        for (double cells = 5; cells <= 40; cells *= 2) {
            printf("| %s | %g |", cases[k].law.name, cells);
            for (int i = 0; i < 4; i++) {
                const double h = s.R / cells, at = distance[i] * h;
                const double w = ilsai_radial_width(&s, 1 - at / s.R);
                printf(" %+.2f |", 100 * survey_error(&s, at, w, h));
            }
            printf("\n");
        }
    }
}

/* ---- Elasticity --------------------------------------------------------------------------- */

/* Mean of the exact width over a cell, by 64 x 64 midpoints. */
static double mean_width(const disc *d, const radial_solution *s, int cell) {
    enum { POINTS = 64 };
    double sum = 0;
    for (int k = 0; k < POINTS * POINTS; k++) {
        const double u = ((k % POINTS + 0.5) / POINTS - 0.5) * d->h;
        const double v = ((k / POINTS + 0.5) / POINTS - 0.5) * d->h;
        sum += ilsai_radial_width(
            s, hypot(ilsai_grid_x(&d->g, cell % d->n) + u, ilsai_grid_y(&d->g, cell / d->n) + v) /
                   s->R);
    }
    return sum / (POINTS * POINTS);
}

/* Widths of the tip cells: the exact means, or (4.18) with the exact front. */
static void set_tips(disc *d, const radial_solution *s, int exact) {
    for (int cell = 0; cell < d->n * d->n; cell++)
        if (d->kind[cell] == ILSA_CELL_TIP) {
            const tipcell_front f = front_in(d, cell, s->R);
            d->width[cell] = exact ? mean_width(d, s, cell)
                                   : ilsai_tipcell_volume(&s->scaled, s->V, 0, &f) / (d->h * d->h);
        }
}

/* out = C w in the channel, 0 elsewhere. */
static void multiply(const disc *d, elasticity *e, const double *w, double *out) {
    ilsai_elasticity_multiply(e, w, out, (size_t)d->n);
    for (int cell = 0; cell < d->n * d->n; cell++)
        if (d->kind[cell] < ILSA_CELL_SURVEY)
            out[cell] = 0;
}

static double dot(const double *a, const double *b, int count) {
    double sum = 0;
    for (int k = 0; k < count; k++)
        sum += a[k] * b[k];
    return sum;
}

/* Channel widths for the residual r (overwritten), by conjugate gradients. */
static void solve(disc *d, elasticity *e, double *r) {
    const int count = d->n * d->n;
    double *p = allocate((size_t)count, sizeof *p), *q = allocate((size_t)count, sizeof *q);
    double rr = dot(r, r, count);
    const double goal = 1e-20 * rr;
    memcpy(p, r, (size_t)count * sizeof *p);
    for (int k = 0; k < 2000 && rr > goal; k++) {
        multiply(d, e, p, q);
        const double step = rr / dot(p, q, count);
        for (int i = 0; i < count; i++) {
            d->width[i] += step * p[i];
            r[i] -= step * q[i];
        }
        const double next = dot(r, r, count), beta = next / rr;
        for (int i = 0; i < count; i++)
            p[i] = r[i] + beta * p[i];
        rr = next;
    }
    free(p);
    free(q);
}

/* Channel widths from the exact pressures there and the widths of the tip cells. */
static void open_channel(disc *d, const radial_solution *s) {
    const int count = d->n * d->n;
    double *r = allocate((size_t)count, sizeof *r);
    elasticity *e = NULL;
    if (ilsai_elasticity_create(1, d->h, d->h, ILSA_PRODUCT_AUTO, &e) ||
        ilsai_elasticity_set_box(e, d->n, d->n)) {
        fprintf(stderr, "no elasticity\n");
        exit(EXIT_FAILURE);
    }
    multiply(d, e, d->width, r);
    for (int cell = 0; cell < count; cell++)
        r[cell] = d->kind[cell] >= ILSA_CELL_SURVEY
                      ? ilsai_radial_pressure(s, radius_of(d, cell) / s->R) - r[cell]
                      : 0;
    solve(d, e, r);
    ilsai_elasticity_destroy(&e);
    free(r);
}

/* How much wider the survey cells are than the exact solution there, in parts of it. */
static void compare(const disc *d, const radial_solution *s, spread *excess) {
    for (int cell = 0; cell < d->n * d->n; cell++)
        if (d->kind[cell] == ILSA_CELL_SURVEY) {
            const double w = ilsai_radial_width(s, radius_of(d, cell) / s->R);
            add(excess, d, cell, d->width[cell] / w - 1);
        }
}

static void elasticity_row(int k, double cells) {
    const radial_solution s = solution_of(k);
    spread excess[2] = {no_spread, no_spread};
    for (int shift = 0; shift < 4; shift++)
        for (int formula = 0; formula < 2; formula++) {
            disc d = make_disc(cells + 0.25 * shift, s.R, s.R);
            set_tips(&d, &s, !formula);
            open_channel(&d, &s);
            compare(&d, &s, &excess[formula]);
            free_disc(&d);
        }
    printf("| %s | %g |", cases[k].law.name, cells);
    for (int formula = 0; formula < 2; formula++)
        print_spread(&excess[formula]);
    printf("\n");
    fflush(stdout);
}

enum { BINS = 6 };
static const double bin_end[BINS] = {0.75, 1, 1.25, 1.5, 1.75, 2.25};

static void add_to_bins(const disc *d, const radial_solution *s, spread bins[BINS]) {
    for (int cell = 0; cell < d->n * d->n; cell++) {
        const double r = radius_of(d, cell), distance = (s->R - r) / d->h;
        int bin = 0;
        if (d->kind[cell] != ILSA_CELL_SURVEY)
            continue;
        while (bin < BINS - 1 && distance >= bin_end[bin])
            bin++;
        add(&bins[bin], d, cell, d->width[cell] / ilsai_radial_width(s, r / s->R) - 1);
    }
}

static void by_distance(int k) {
    const radial_solution s = solution_of(k);
    spread bins[BINS] = {no_spread, no_spread, no_spread, no_spread, no_spread, no_spread};
    for (int shift = 0; shift < 8; shift++) {
        disc d = make_disc(40 + 0.125 * shift, s.R, s.R);
        set_tips(&d, &s, 1);
        open_channel(&d, &s);
        add_to_bins(&d, &s, bins);
        free_disc(&d);
    }
    for (int diagonal = 0; diagonal < 2; diagonal++) {
        printf("| %s | %s |", cases[k].law.name, diagonal ? "diagonal" : "axis");
        for (int b = 0; b < BINS; b++) {
            const int count = diagonal ? bins[b].on_diagonal : bins[b].on_axis;
            if (count)
                printf(" %+.2f |", 100 * (diagonal ? bins[b].diagonal : bins[b].axis) / count);
            else
                printf(" - |");
        }
        printf("\n");
    }
}

static void elastic(void) {
    printf(
        "\n### Elasticity alone\n\nThe exact front, the exact pressure in the channel, the exact "
        "volumes of the tip cells or those of (4.18): how much wider than the exact solution "
        "elasticity makes the survey cells, in %% of their width. Mean of 4 positions of the "
        "front in the cells.\n\n| case | cells per radius | exact tips: mean | axis | diagonal "
        "| tips of (4.18): mean | axis | diagonal |\n|---|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < CASES; k++)
        for (double cells = 5; cells <= 80; cells *= 2)
            elasticity_row(k, cells);
    printf("\nThe same by the distance of the survey cell from the front, in cells; 40 cells per "
           "radius, exact tips, 8 positions.\n\n"
           "| case | near the | < 0.75 | < 1 | < 1.25 | < 1.5 | < 1.75 | more |\n"
           "|---|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < CASES; k++)
        by_distance(k);
}

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        void (*print)(void);
    } tables[] = {{"marching", marching}, {"survey", survey}, {"elasticity", elastic}};
    for (int t = 0; t < 3; t++) {
        int chosen = argc < 2;
        for (int k = 1; k < argc; k++)
            chosen |= strcmp(argv[k], tables[t].name) == 0;
        if (chosen)
            tables[t].print();
    }
    return 0;
}
