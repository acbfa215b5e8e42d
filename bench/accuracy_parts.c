/*
 * Where the error goes: parts of the method fed with the exact penny-shaped solution, one at a
 * time, as Markdown tables for docs/accuracy.md.
 *
 *     bench_accuracy_parts [marching] [survey] [elasticity] [leakoff]
 */
#include "common_radial.h"
#include "common_worst.h"

#include "elastic/elasticity.h"
#include "front/march.h"
#include "front/survey.h"
#include "step/fracture.h"
#include "tip/penny.h"
#include "tip/tip_cell.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Advance of the front in a step, in cells. */
static const double STEP = 0.4;

/* A circle around the middle one of nx by ny cells dx by dy; E' = Q = 1. */
typedef struct disc {
    int nx, ny;
    double dx, dy, R; /* R is the radius; the footprint's may be behind it */
    grid g;
    box footprint;
    unsigned char *kind;
    double *exact; /* mean widths of survey and tip cells */
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

static int cells_of(const disc *d) {
    return d->nx * d->ny;
}

static double x_of(const disc *d, int cell) {
    return ilsai_grid_x(&d->g, cell % d->nx);
}

static double y_of(const disc *d, int cell) {
    return ilsai_grid_y(&d->g, cell / d->nx);
}

static double radius_of(const disc *d, int cell) {
    return hypot(x_of(d, cell), y_of(d, cell));
}

/* The front of radius R in a cell, as the march would see it. */
static tip_cell_front front_in(const disc *d, int cell, double R) {
    const double r = radius_of(d, cell);
    tip_cell_front f = {.cos_a = r > 0 ? fabs(x_of(d, cell)) / r : 1,
                        .sin_a = r > 0 ? fabs(y_of(d, cell)) / r : 0,
                        .dx = d->dx,
                        .dy = d->dy};
    f.ell = 0.5 * ilsai_march_full(&d->g, f.cos_a, f.sin_a) - (r - R);
    return f;
}

/*
 * `cells` of dx per radius R, aspect = dx / dy; kinds as a step would have them that ended with the
 * footprint of radius R_kind.
 */
static disc make_disc(double cells, double aspect, double R, double R_kind) {
    const int half = (int)ceil(cells) + 5;
    disc d = {.dx = R / cells, .R = R, .nx = 2 * half + 1, .ny = 2 * (int)(half * aspect) + 1};
    d.dy = d.dx / aspect;
    const ilsa_mesh_def mesh = {d.nx, d.ny, d.dx, d.dy};
    const size_t count = (size_t)cells_of(&d);
    d.g = ilsai_grid(&mesh, 0, 0);
    d.footprint = (box){d.nx, -1, d.ny, -1};
    d.kind = allocate(count, 1);
    d.exact = allocate(count, sizeof *d.exact);
    d.width = allocate(count, sizeof *d.width);
    for (int cell = 0; cell < cells_of(&d); cell++) {
        const tip_cell_front f = front_in(&d, cell, R_kind);
        const double full = ilsai_march_full(&d.g, f.cos_a, f.sin_a);
        if (f.ell <= 1e-4 * ilsai_grid_h(&d.g))
            continue;
        d.kind[cell] = f.ell < full ? ILSA_CELL_TIP : ILSA_CELL_CHANNEL;
        ilsai_box_add(&d.footprint, cell % d.nx, cell / d.nx);
    }
    ilsai_fracture_find_survey(&d.g, &d.footprint, d.kind);
    return d;
}

static void free_disc(disc *d) {
    free(d->kind);
    free(d->exact);
    free(d->width);
}

/* Errors seen from cells around the front: mean, near the axes, near the diagonals. */
typedef struct spread {
    double sum, low, high, axis, diagonal;
    int count, on_axis, on_diagonal;
} spread;

static const spread no_spread = {.low = INFINITY, .high = -INFINITY};

static void add(spread *s, const disc *d, int cell, double error) {
    const double x = fabs(x_of(d, cell)), y = fabs(y_of(d, cell));
    const double slope = fmin(x, y) / fmax(x, y);
    s->sum += error;
    s->count++;
    s->low = smaller_of(s->low, error);
    s->high = larger_of(s->high, error);
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

/* Marches from exact distances; curved: with the exact curvature of the front. */
static void march_exactly(double cells, double aspect, int curved, spread *s) {
    disc d = make_disc(cells, aspect, 1, 1 - 0.5 / cells);
    const box all = {0, d.nx - 1, 0, d.ny - 1};
    survey_cell *survey_cells = allocate((size_t)cells_of(&d), sizeof *survey_cells);
    double *level = allocate((size_t)cells_of(&d), sizeof *level);
    march *f = ilsai_march_create();
    int count = 0, reached = 0;
    for (int cell = 0; cell < cells_of(&d); cell++)
        if (d.kind[cell] == ILSA_CELL_SURVEY)
            survey_cells[count++] = (survey_cell){.cell = cell,
                                                  .s = 1 - radius_of(&d, cell),
                                                  .V = 1,
                                                  .w = 1,
                                                  .inner = -1,
                                                  .curvature = curved};
    if (f &&
        ilsai_march_run(f, &d.g, &all, d.kind, survey_cells, count, 2 * d.dx, level) == ILSA_OK)
        for (const front_cell *c = ilsai_march_cells(f, &reached); reached-- > 0; c++)
            if (c->ell > 0)
                add(s, &d, c->cell, radius_of(&d, c->cell) - c->T - 1);
    ilsai_march_destroy(&f);
    free(level);
    free(survey_cells);
    free_disc(&d);
}

static void marching_row(double cells, double aspect, int curved) {
    spread s = no_spread;
    double difference = 0;
    for (int k = 0; k < 10; k++) {
        spread one = no_spread;
        march_exactly(cells + 0.1 * k, aspect, curved, &one);
        march_exactly(cells + 0.1 * k, aspect, curved, &s);
        difference += 0.1 * (one.high - one.low);
    }
    printf("| %g | %g | %s |", cells, aspect, curved ? "yes" : "no");
    print_spread(&s);
    printf(" %.2f |\n", 100 * difference);
}

static void marching(void) {
    printf("\n### Marching\n\nExact distances in the survey cells of a footprint half a cell "
           "behind the front; the radius that the tip cells then see, error in %% of it; mean of "
           "10 positions of the front in the cells. Without the front's curvature the update is "
           "the paper's (4.12).\n\n| cells per radius | dx/dy | curvature | mean | axis | "
           "diagonal | largest - smallest |\n|---|---|---|---|---|---|---|\n");
    for (int cells = 5; cells <= 40; cells *= 2)
        for (int k = 0; k < 4; k++)
            marching_row(cells, 1 + k % 2, k / 2);
}

/* ---- Exact solutions ---------------------------------------------------------------------- */

static penny_solution solution_of(int k) {
    const penny_law law = penny_cases[k].law;
    const ilsa_material_def scaled = {1, law.mu_prime, law.K_prime, law.C_prime};
    penny_solution s;
    if (ilsai_penny_at_time(&scaled, 1, penny_cases[k].time, &s) != ILSA_OK) {
        fprintf(stderr, "%s: no solution\n", penny_cases[k].law.name);
        exit(EXIT_FAILURE);
    }
    return s;
}

/* Mean over a cell around (x, y) of a function of the radius over R, by 64 x 64 midpoints. */
typedef double of_radius(const penny_solution *s, double rho, double until);
static double mean_over(const penny_solution *s, of_radius *f, double until, double x, double y,
                        double dx, double dy) {
    enum { POINTS = 64 };
    double sum = 0;
    for (int k = 0; k < POINTS * POINTS; k++) {
        const int i = k % POINTS, j = k / POINTS;
        const double u = ((i + 0.5) / POINTS - 0.5) * dx;
        const double v = ((j + 0.5) / POINTS - 0.5) * dy;
        sum += f(s, hypot(x + u, y + v) / s->R, until);
    }
    return sum / (POINTS * POINTS);
}

static double width_at(const penny_solution *s, double rho, double until) {
    (void)until;
    return ilsai_penny_width(s, rho);
}

/* ---- Survey cells ------------------------------------------------------------------------- */

/*
 * The radius that a survey cell on the x axis at `distance` behind the front sees, less the true
 * one, in parts of it, from the exact mean widths of it and of the cell two cells behind; the step
 * moves the front by STEP cells of size h.
 */
static double survey_error(const penny_solution *s, double distance, double h, int next_term) {
    const double depth = 2 * h, from = s->R - distance;
    double width[2] = {mean_over(s, width_at, 0, from, 0, h, h),
                       mean_over(s, width_at, 0, from - depth, 0, h, h)};
    const survey_widths widths = {&s->scaled, h, h, width, 0};
    survey_cell survey = {.s0 = distance - STEP * h, .h = h, .cos_a = 1, .s = distance};
    const double dt = s->t - ilsai_penny_arrival(s, 1 - STEP * h / s->R);
    survey.V = STEP * h / dt;
    survey.inner = next_term ? 1 : -1;
    survey.depth = depth;
    return (ilsai_survey_distance(&widths, &survey, dt) - distance) / s->R;
}

static void survey(void) {
    const double distance[] = {0.75, 1, 1.5, 2};
    printf("\n### Survey cells\n\nThe distance that (4.9) gives with the exact mean widths and "
           "the means of the asymptote: error of the radius in %% of it, by the distance of the "
           "cell from the front, in cells; without the next term of the width, with it.\n\n"
           "| case | cells per radius | s = 0.75 | 1 | 1.5 | 2 |\n|---|---|---|---|---|---|\n");
    for (int k = 0; k < PENNY_CASES; k++) {
        const penny_solution s = solution_of(k);
        for (int n = 5; n <= 40; n *= 2) {
            const double cells = n, h = s.R / cells;
            printf("| %s | %g |", penny_cases[k].law.name, cells);
            for (int i = 0; i < 4; i++)
                printf(" %+.2f, %+.2f |", 100 * survey_error(&s, distance[i] * h, h, 0),
                       100 * survey_error(&s, distance[i] * h, h, 1));
            printf("\n");
        }
    }
}

/* ---- Elasticity --------------------------------------------------------------------------- */

static disc exact_disc(const penny_solution *s, double cells, double aspect) {
    disc d = make_disc(cells, aspect, s->R, s->R);
    for (int cell = 0; cell < cells_of(&d); cell++)
        if (d.kind[cell] == ILSA_CELL_TIP || d.kind[cell] == ILSA_CELL_SURVEY)
            d.exact[cell] = mean_over(s, width_at, 0, x_of(&d, cell), y_of(&d, cell), d.dx, d.dy);
    return d;
}

/* Widths of the tip cells: the exact means, or (4.18) with the exact front; 0 elsewhere. */
static void set_tips(disc *d, const penny_solution *s, int by_formula) {
    for (int cell = 0; cell < cells_of(d); cell++) {
        const tip_cell_front f = front_in(d, cell, s->R);
        d->width[cell] = d->kind[cell] != ILSA_CELL_TIP ? 0
                         : by_formula
                             ? ilsai_tip_cell_volume(&s->scaled, s->V, 0, &f) / (d->dx * d->dy)
                             : d->exact[cell];
    }
}

/* What the self terms of the survey cells lack, 0 elsewhere. */
static void find_edges(const disc *d, const penny_solution *s, elasticity *e, double *edge) {
    for (int cell = 0; cell < cells_of(d); cell++)
        if (d->kind[cell] == ILSA_CELL_SURVEY) {
            const tip_cell_front f = front_in(d, cell, s->R);
            const double distance = s->R - radius_of(d, cell);
            const double w = ilsai_asymptote_width(&s->scaled, s->V, distance);
            const self_term_front seen = {distance, f.cos_a, f.sin_a,
                                          ilsai_asymptote_exponent(&s->scaled, s->V, distance, w)};
            edge[cell] = ilsai_elasticity_self_term(e, cell % d->nx, cell / d->nx, &seen).value;
        }
}

/* Pressures from widths: the constant elements and what is added to their self terms. */
typedef struct stiffness {
    elasticity *e;
    double *self_correction;
} stiffness;

static stiffness make_stiffness(const disc *d, const penny_solution *s, int completed) {
    stiffness k = {NULL, allocate((size_t)cells_of(d), sizeof *k.self_correction)};
    if (ilsai_elasticity_create(1, d->dx, d->dy, ILSA_PRODUCT_AUTO, &k.e) ||
        ilsai_elasticity_set_box(k.e, &(box){0, d->nx - 1, 0, d->ny - 1}, MIRROR_NONE,
                                 MIRROR_NONE)) {
        fprintf(stderr, "no elasticity\n");
        exit(EXIT_FAILURE);
    }
    if (completed) {
        ilsai_elasticity_make_self_terms(k.e);
        find_edges(d, s, k.e, k.self_correction);
    }
    return k;
}

static void free_stiffness(stiffness *k) {
    ilsai_elasticity_destroy(&k->e);
    free(k->self_correction);
}

/* Pressures in the channel, 0 elsewhere. */
static void multiply(const disc *d, const stiffness *k, const double *w, double *out) {
    ilsai_elasticity_multiply(k->e, w, out, (size_t)d->nx);
    for (int cell = 0; cell < cells_of(d); cell++)
        out[cell] =
            d->kind[cell] < ILSA_CELL_SURVEY ? 0 : out[cell] + k->self_correction[cell] * w[cell];
}

static double dot(const double *a, const double *b, int count) {
    double sum = 0;
    for (int k = 0; k < count; k++)
        sum += a[k] * b[k];
    return sum;
}

/* Channel widths for the residual r (overwritten), by conjugate gradients. */
static void solve(disc *d, const stiffness *stiff, double *r) {
    const int count = cells_of(d);
    double *p = allocate((size_t)count, sizeof *p), *q = allocate((size_t)count, sizeof *q);
    double rr = dot(r, r, count);
    const double goal = 1e-16 * rr;
    memcpy(p, r, (size_t)count * sizeof *p);
    for (int k = 0; k < 2000 && rr > goal; k++) {
        multiply(d, stiff, p, q);
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
static void open_channel(disc *d, const penny_solution *s, int completed) {
    double *r = allocate((size_t)cells_of(d), sizeof *r);
    stiffness k = make_stiffness(d, s, completed);
    multiply(d, &k, d->width, r);
    for (int cell = 0; cell < cells_of(d); cell++)
        if (d->kind[cell] >= ILSA_CELL_SURVEY)
            r[cell] = ilsai_penny_pressure(s, radius_of(d, cell) / s->R) - r[cell];
    solve(d, &k, r);
    free_stiffness(&k);
    free(r);
}

/* How much wider than exact the survey cells come out, in parts of it. */
static double excess_of(const disc *d, int cell) {
    return d->width[cell] / d->exact[cell] - 1;
}

/* Constant elements alone; self terms completed; these with tip cells of (4.18). */
enum { WAYS = 3 };

static void elasticity_row(int k, double cells, double aspect) {
    const penny_solution s = solution_of(k);
    spread excess[WAYS] = {no_spread, no_spread, no_spread};
    for (int shift = 0; shift < 4; shift++) {
        disc d = exact_disc(&s, cells + 0.25 * shift, aspect);
        for (int way = 0; way < WAYS; way++) {
            set_tips(&d, &s, way == 2);
            open_channel(&d, &s, way > 0);
            for (int cell = 0; cell < cells_of(&d); cell++)
                if (d.kind[cell] == ILSA_CELL_SURVEY)
                    add(&excess[way], &d, cell, excess_of(&d, cell));
        }
        free_disc(&d);
    }
    printf("| %s | %g | %g |", penny_cases[k].law.name, cells, aspect);
    for (int way = 0; way < WAYS; way++)
        print_spread(&excess[way]);
    printf("\n");
    fflush(stdout);
}

enum { BINS = 5 };
static const double bin_end[BINS] = {0.75, 1, 1.25, 1.5, 2.25};

static void add_to_bins(const disc *d, spread bins[BINS]) {
    for (int cell = 0; cell < cells_of(d); cell++) {
        const double distance = (d->R - radius_of(d, cell)) / d->dx;
        int bin = 0;
        if (d->kind[cell] != ILSA_CELL_SURVEY)
            continue;
        while (bin < BINS - 1 && distance >= bin_end[bin])
            bin++;
        add(&bins[bin], d, cell, excess_of(d, cell));
    }
}

static void print_bins(const char *name, spread bins[2][BINS], int diagonal) {
    printf("| %s | %s |", name, diagonal ? "diagonal" : "axis");
    for (int b = 0; b < BINS; b++) {
        const int count = diagonal ? bins[0][b].on_diagonal : bins[0][b].on_axis;
        double mean[2];
        for (int way = 0; way < 2; way++)
            mean[way] = 100 * (diagonal ? bins[way][b].diagonal : bins[way][b].axis) / count;
        if (count)
            printf(" %+.2f, %+.2f |", mean[0], mean[1]);
        else
            printf(" - |");
    }
    printf("\n");
}

static void by_distance(int k) {
    const penny_solution s = solution_of(k);
    spread bins[2][BINS] = {{no_spread, no_spread, no_spread, no_spread, no_spread},
                            {no_spread, no_spread, no_spread, no_spread, no_spread}};
    for (int shift = 0; shift < 8; shift++) {
        disc d = exact_disc(&s, 20 + 0.125 * shift, 1);
        for (int way = 0; way < 2; way++) {
            set_tips(&d, &s, 0);
            open_channel(&d, &s, way);
            add_to_bins(&d, bins[way]);
        }
        free_disc(&d);
    }
    print_bins(penny_cases[k].law.name, bins, 0);
    print_bins(penny_cases[k].law.name, bins, 1);
}

static void elastic(void) {
    printf("\n### Elasticity\n\nThe exact front, the exact pressure in the channel, the exact "
           "volumes of the tip cells: how much wider than the exact solution elasticity makes the "
           "survey cells, mean over each of them, in %% of it; mean of 4 positions of the front in "
           "the cells. C: constant elements alone; C + D: self terms completed beside the front; "
           "last with the tip cells of (4.18).\n\n| case | cells per radius | dx/dy | C: mean | "
           "axis | diagonal | C + D: mean | axis | diagonal | C + D, (4.18): mean | axis | "
           "diagonal |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < PENNY_CASES; k++) {
        for (int cells = 5; cells <= 40; cells *= 2)
            elasticity_row(k, cells, 1);
        for (int cells = 10; cells <= 20; cells *= 2)
            elasticity_row(k, cells, 2);
    }
    printf("\nThe same by the distance of the survey cell from the front, in cells; 20 cells per "
           "radius, exact tips, 8 positions: C, C + D.\n\n"
           "| case | near the | < 0.75 | < 1 | < 1.25 | < 1.5 | more |\n"
           "|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < PENNY_CASES; k++)
        by_distance(k);
}

/* ---- Leak-off of channel cells ------------------------------------------------------------ */

/* Leaked per area at rho from the time `from` on, over 2 C'. */
static double leaked_at(const penny_solution *s, double rho, double from) {
    const double arrival = ilsai_penny_arrival(s, fmin(rho, 1));
    return sqrt(s->t - arrival) - sqrt(fmax(from - arrival, 0));
}

/* What leaks from the full cells once they are full: exact, by the centre, by the mean. */
typedef struct leakage {
    double exact, centre, mean;
} leakage;

static leakage leak_of(const disc *d, const penny_solution *s) {
    leakage sum = {0, 0, 0};
    for (int cell = 0; cell < cells_of(d); cell++) {
        const tip_cell_front f = front_in(d, cell, s->R);
        const double half = 0.5 * ilsai_march_full(&d->g, f.cos_a, f.sin_a), area = d->dx * d->dy;
        const double r = radius_of(d, cell), C = s->scaled.C_prime;
        if (d->kind[cell] < ILSA_CELL_SURVEY)
            continue;
        const double entered = ilsai_penny_arrival(s, fmax(r - half, 0) / s->R);
        const double centre = ilsai_penny_arrival(s, r / s->R);
        const double filled = ilsai_penny_arrival(s, (r + half) / s->R), age = filled - centre;
        const double e = fmin(ilsai_tip_cell_spread(&f, filled - entered), age);
        const double dt = s->t - filled;
        sum.exact += 2 * C * area *
                     mean_over(s, leaked_at, filled, x_of(d, cell), y_of(d, cell), d->dx, d->dy);
        sum.centre += area * ilsai_tip_cell_full_leakoff_step(C, age, dt, 0);
        sum.mean += area * ilsai_tip_cell_full_leakoff_step(C, age, dt, e);
    }
    return sum;
}

static void leakoff(void) {
    const penny_solution s = solution_of(PENNY_M_TILDE);
    const double all = s.Q * s.t * (1 - s.efficiency);
    printf("\n### Leak-off of channel cells\n\nM-tilde with the exact front: what leaks from "
           "channel cells after they have filled, its error in %% of all that has leaked.\n\n"
           "| cells per radius | dx/dy | root at the centre, (4.8) | mean of the root |\n"
           "|---|---|---|---|\n");
    for (int aspect = 1; aspect <= 2; aspect++)
        for (int n = 10; n <= 80; n *= 2) {
            const double cells = n;
            disc d = make_disc(cells, aspect, s.R, s.R);
            const leakage leak = leak_of(&d, &s);
            printf("| %g | %d | %+.2f | %+.2f |\n", cells, aspect,
                   100 * (leak.centre - leak.exact) / all, 100 * (leak.mean - leak.exact) / all);
            free_disc(&d);
        }
}

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        void (*print)(void);
    } tables[] = {
        {"marching", marching}, {"survey", survey}, {"elasticity", elastic}, {"leakoff", leakoff}};
    for (int t = 0; t < 4; t++) {
        int chosen = argc < 2;
        for (int k = 1; k < argc; k++)
            chosen |= strcmp(argv[k], tables[t].name) == 0;
        if (chosen)
            tables[t].print();
    }
    return 0;
}
