#include "front/geometry.h"

#include "base/fields.h"
#include "base/tuning.h"
#include <math.h>
#include <stdbool.h>

static bool leads_out(const grid *g, const unsigned char *kind, int i, int j, int face) {
    int other = ilsai_grid_neighbour(g, i, j, face);
    return other < 0 || !ilsai_is_channel(kind[other]);
}

double ilsai_geometry_size(const grid *g, const unsigned char *kind, int i, int j) {
    bool along_x = leads_out(g, kind, i, j, GRID_LEFT) || leads_out(g, kind, i, j, GRID_RIGHT);
    bool along_y = leads_out(g, kind, i, j, GRID_DOWN) || leads_out(g, kind, i, j, GRID_UP);
    return along_x && along_y ? ilsai_grid_h(g) : along_x ? g->dx : g->dy;
}

typedef struct vector {
    double x, y;
} vector;

static bool on_mesh(const front_view *v, int i, int j) {
    return i >= 0 && i < v->g->nx && j >= 0 && j < v->g->ny;
}

/* Whether the march has set the level of a cell: not so in the channel behind the survey cells. */
static double level_at(const front_view *v, int i, int j) {
    if (!on_mesh(v, i, j)) {
        return INFINITY;
    }
    int cell = j * v->g->nx + i;
    return v->kind[cell] == ILSA_CELL_CHANNEL ? INFINITY : v->level[cell];
}

/* Slope of the level along one axis from the lower of the two neighbours, 0 if both are higher. */
static double upwind_slope(double here, double below, double above, double d) {
    double lower = fmin(below, above);
    if (!(lower < here)) {
        return 0;
    }
    return (below <= above ? here - below : above - here) / d;
}

/* Normal of the front in a cell outside the channel, pointing outwards; 0 where it is not known. */
static vector normal_in(const front_view *v, int i, int j) {
    double here = level_at(v, i, j);
    vector n = {0, 0};
    if (!isfinite(here)) {
        return n;
    }
    n.x = upwind_slope(here, level_at(v, i - 1, j), level_at(v, i + 1, j), v->g->dx);
    n.y = upwind_slope(here, level_at(v, i, j - 1), level_at(v, i, j + 1), v->g->dy);
    double size = hypot(n.x, n.y);
    return size > 0 ? (vector){n.x / size, n.y / size} : n;
}

/*
 * Mean normal of the cells across the faces by which survey cell (i, j) leads out of the channel.
 * In a row one cell thick the normals of the two fronts oppose each other, and all but rounding
 * would cancel: the normal of one side counts backwards there.
 */
static vector normal_seen(const front_view *v, int i, int j) {
    static const int side[GRID_FACES][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    vector seen[GRID_FACES] = {{0, 0}}, sum = {0, 0};
    bool out[GRID_FACES] = {false};
    for (int face = 0; face < GRID_FACES; face++) {
        int a = i + side[face][0], b = j + side[face][1];
        if (on_mesh(v, a, b) && !ilsai_is_channel(v->kind[b * v->g->nx + a])) {
            seen[face] = normal_in(v, a, b);
            out[face] = true;
        }
    }
    bool along_x = out[GRID_LEFT] || out[GRID_RIGHT], along_y = out[GRID_DOWN] || out[GRID_UP];
    bool row = (out[GRID_LEFT] && out[GRID_RIGHT] && !along_y) ||
               (out[GRID_DOWN] && out[GRID_UP] && !along_x);
    for (int face = 0; face < GRID_FACES; face++) {
        double sign = row && (face == GRID_RIGHT || face == GRID_UP) ? -1 : 1;
        sum.x += sign * seen[face].x;
        sum.y += sign * seen[face].y;
    }
    double size = hypot(sum.x, sum.y);
    return size > 0 ? (vector){sum.x / size, sum.y / size} : sum;
}

/* Normal equations of a parabola eta = c0 + c1 xi + c2 xi^2. */
typedef struct parabola {
    double m[5], r[3]; /* sums of xi^k, of eta xi^k */
    double least, largest;
} parabola;

static void add_point(parabola *p, double xi, double eta) {
    double power = 1;
    for (int k = 0; k < 5; k++) {
        p->m[k] += power;
        if (k < 3) {
            p->r[k] += eta * power;
        }
        power *= xi;
    }
    p->least = fmin(p->least, xi);
    p->largest = fmax(p->largest, xi);
}

/* -2 c2 over (1 + c1^2)^(3/2), by Cramer's rule; 0 for points that do not settle it. */
static double fitted_curvature(const parabola *p, double span) {
    const double *m = p->m, *r = p->r;
    if (p->m[0] < ILSAI_GEOMETRY_POINTS || p->least > -span || p->largest < span) {
        return 0;
    }
    double det = m[0] * (m[2] * m[4] - m[3] * m[3]) - m[1] * (m[1] * m[4] - m[2] * m[3]) +
                 m[2] * (m[1] * m[3] - m[2] * m[2]);
    double c1 = m[0] * (r[1] * m[4] - m[3] * r[2]) - r[0] * (m[1] * m[4] - m[2] * m[3]) +
                m[2] * (m[1] * r[2] - r[1] * m[2]);
    double c2 = m[0] * (m[2] * r[2] - r[1] * m[3]) - m[1] * (m[1] * r[2] - r[1] * m[2]) +
                r[0] * (m[1] * m[3] - m[2] * m[2]);
    if (!(fabs(det) > 1e-12 * m[0] * m[2] * m[4])) {
        return 0;
    }
    double slope = c1 / det;
    return -2 * c2 / det / pow(1 + slope * slope, 1.5);
}

/* Curvature of the front through the tip cells around the point it has in front of (i, j). */
static double curvature_at(const front_view *v, int i, int j, vector n, double distance) {
    double size = fmax(v->g->dx, v->g->dy), reach = ILSAI_GEOMETRY_REACH * size;
    double x0 = ilsai_grid_x(v->g, i) + distance * n.x;
    double y0 = ilsai_grid_y(v->g, j) + distance * n.y;
    int wx = (int)ceil(reach / v->g->dx) + 1, wy = (int)ceil(reach / v->g->dy) + 1;
    parabola p = {{0}, {0}, INFINITY, -INFINITY};
    for (int b = j - wy; b <= j + wy; b++) {
        for (int a = i - wx; a <= i + wx; a++) {
            if (!on_mesh(v, a, b) || v->kind[b * v->g->nx + a] != ILSA_CELL_TIP) {
                continue;
            }
            vector m = normal_in(v, a, b);
            double level = v->level[b * v->g->nx + a];
            double x = ilsai_grid_x(v->g, a) - level * m.x - x0;
            double y = ilsai_grid_y(v->g, b) - level * m.y - y0;
            double xi = -x * n.y + y * n.x;
            if (m.x * n.x + m.y * n.y > ILSAI_GEOMETRY_ALIKE && fabs(xi) <= reach) {
                add_point(&p, xi, x * n.x + y * n.y);
            }
        }
    }
    double curvature = fitted_curvature(&p, ILSAI_GEOMETRY_SPAN * reach),
           limit = ILSAI_GEOMETRY_CURVATURE / size;
    return fmax(-limit, fmin(limit, curvature));
}

/* Whether a cell can tell the width further in; then its depth behind the survey is set. */
static bool try_inner(const front_view *v, survey_cell *survey, int i, int j, vector n, int di,
                      int dj, unsigned char least) {
    if (!on_mesh(v, i + di, j + dj)) {
        return false;
    }
    int cell = (j + dj) * v->g->nx + i + di;
    double along = -(di * v->g->dx * n.x + dj * v->g->dy * n.y);
    double across = -di * v->g->dx * n.y + dj * v->g->dy * n.x;
    double depth = along - 0.5 * survey->curvature * across * across;
    if (v->kind[cell] < least || !(depth > 0)) {
        return false;
    }
    survey->inner = ilsai_grid_fold(v->g, i + di, j + dj);
    survey->depth = depth;
    return true;
}

/*
 * The cell behind (i, j) along the normal, under the same stress: two cells in if the channel is
 * that deep, else the next one. The width follows the tip's only where the stress has no step.
 */
static void find_inner(const front_view *v, survey_cell *survey, int i, int j, vector n) {
    double cell = v->g->dx * fabs(n.x) + v->g->dy * fabs(n.y);
    double di = -n.x * cell / v->g->dx, dj = -n.y * cell / v->g->dy;
    survey->inner = -1;
    if (!try_inner(v, survey, i, j, n, (int)lround(2 * di), (int)lround(2 * dj),
                   ILSA_CELL_CHANNEL)) {
        try_inner(v, survey, i, j, n, (int)lround(di), (int)lround(dj), ILSA_CELL_SURVEY);
    }
}

/* A walk from the centre of a cell along a ray, from cell to cell. */
typedef struct walk {
    vector ray;
    int i, j;   /* the cell that it is in */
    int kx, ky; /* edges that it has crossed on each axis */
} walk;

/* Distance along the ray from a cell's centre to its k-th next edge, on one axis. */
static double edge_distance(double direction, double size, int k) {
    return direction != 0 ? (k + 0.5) * size / fabs(direction) : INFINITY;
}

/* Goes on into the next cell, which may be off the mesh; returns the distance of the edge before
 * it. */
static double walk_on(const front_view *v, walk *w) {
    double to_x = edge_distance(w->ray.x, v->g->dx, w->kx);
    double to_y = edge_distance(w->ray.y, v->g->dy, w->ky), next = fmin(to_x, to_y);
    w->i += to_x == next ? (w->ray.x > 0 ? 1 : -1) : 0;
    w->j += to_y == next ? (w->ray.y > 0 ? 1 : -1) : 0;
    w->kx += to_x == next;
    w->ky += to_y == next;
    return next;
}

static int cell_of(const front_view *v, const walk *w) {
    return w->j * v->g->nx + w->i;
}

/*
 * The length of the fracture on the normal through (i, j), from front to front; INFINITY where the
 * other front is further than `length` behind the cell.
 */
static double chord_through(const front_view *v, const survey_cell *survey, int i, int j, vector n,
                            double length) {
    walk at = {{-n.x, -n.y}, i, j, 0, 0};
    for (;;) {
        walk last = at;
        if (!(walk_on(v, &at) < length)) {
            return INFINITY;
        }
        if (!on_mesh(v, at.i, at.j) || !ilsai_is_channel(v->kind[cell_of(v, &at)])) {
            double x = (last.i - i) * v->g->dx, y = (last.j - j) * v->g->dy;
            return survey->s0 + hypot(x, y) - v->level[cell_of(v, &last)];
        }
    }
}

/* From 1 where x is under low, smoothly, to 0 where it is over high. */
static double fade(double x, double low, double high) {
    double u = fmax(fmin((x - low) / (high - low), 1), 0);
    return (1 - u) * (1 - u) * (1 + 2 * u);
}

/*
 * The part of a stress step that counts. The width of a step is that of a half-plane: a fracture is
 * one to steps that are close to the front for its own length. And the further a step lies behind
 * the cell, the more of its width is seen in the inner cell.
 */
static double step_weight(const survey_cell *survey, double depth, double cell, double chord) {
    return fade(depth, ILSAI_STRESS_STEP_FULL * cell, ILSAI_STRESS_STEP_REACH * cell) *
           fade((survey->s0 + depth) / chord, ILSAI_STRESS_STEP_NEAR, ILSAI_STRESS_STEP_FAR);
}

/* Notes the stress step between two cells on the ray; height is of the stress nearer to the front.
 */
static void note_step(const front_view *v, survey_cell *survey, double depth, double weight,
                      int ahead, int behind) {
    double height = weight * (v->sigma[ahead] - v->sigma[behind]) / v->E_prime;
    if (height != 0 && survey->step_count < SURVEY_STEPS) {
        survey->step[survey->step_count++] = (stress_step){depth, height};
    }
}

/*
 * The steps of the stress from the centre of (i, j) along n for a length; sign 1: towards the
 * front, -1: away from it.
 */
static void find_steps(const front_view *v, survey_cell *survey, int i, int j, vector n, int sign,
                       double length, double chord) {
    double cell = v->g->dx * fabs(n.x) + v->g->dy * fabs(n.y);
    walk at = {{sign * n.x, sign * n.y}, i, j, 0, 0};
    for (;;) {
        int from = cell_of(v, &at);
        double next = walk_on(v, &at), depth = -sign * next;
        if (!(next < length) || !on_mesh(v, at.i, at.j)) {
            return;
        }
        int to = cell_of(v, &at);
        note_step(v, survey, depth, step_weight(survey, depth, cell, chord), sign > 0 ? to : from,
                  sign > 0 ? from : to);
    }
}

/* Sets the stress steps: behind the cell those that count, in front those that the front may reach
 * in this time step. */
static void set_steps(const front_view *v, survey_cell *survey, int i, int j, vector n) {
    survey->step_count = 0;
    if (n.x != 0 || n.y != 0) {
        double cell = v->g->dx * fabs(n.x) + v->g->dy * fabs(n.y);
        double reach = ILSAI_STRESS_STEP_REACH * cell;
        double chord =
            chord_through(v, survey, i, j, n, (survey->s0 + reach) / ILSAI_STRESS_STEP_FAR);
        find_steps(v, survey, i, j, n, 1, survey->s0 + ILSAI_ADVANCE_MAX * survey->h, chord);
        find_steps(v, survey, i, j, n, -1, reach, chord);
    }
}

void ilsai_geometry_set(const front_view *v, survey_cell *survey_cells, int count) {
    for (int k = 0; k < count; k++) {
        survey_cell *survey = &survey_cells[k];
        int i = survey->cell % v->g->nx, j = survey->cell / v->g->nx;
        vector n = normal_seen(v, i, j);
        survey->cos_a = fabs(n.x);
        survey->sin_a = fabs(n.y);
        survey->curvature = curvature_at(v, i, j, n, survey->s0);
        find_inner(v, survey, i, j, n);
        if (v->sigma) {
            set_steps(v, survey, i, j, n);
        }
    }
}
