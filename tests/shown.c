#include "shown.h"
#include "../bench/common_layers.h"
#include "check.h"

#include <stdlib.h>
#include <string.h>

static shown layered(const layer_scene *from, int cells) {
    shown s = {.name = from->name, .radius = 5, .end = layer_times[LAYER_TIMES - 1]};
    s.scene = (host_scene){.mesh = layer_mesh(from, cells), .material = layer_material(from)};
    s.scene.interfaces = 2;
    s.scene.interface_y[0] = -10;
    s.scene.interface_y[1] = 10;
    memcpy(s.scene.sigma, from->sigma, sizeof from->sigma);
    s.scene.source_count = 1;
    s.scene.source[0].rate = 0.01;
    s.scene.options = ilsa_solver_def_default();
    return s;
}

static shown radial(const fig_scene *from) {
    shown s = {.name = from->name, .radius = 5 * from->dx, .end = from->time};
    s.scene = host_penny(0, 41, from->dx);
    s.scene.material.C_prime = from->C_prime;
    return s;
}

shown shown_scene(int which, int cells) {
    return which < SHOWN_LAYERED ? layered(&layer_scenes[which], cells)
                                 : radial(&fig_scenes[which - SHOWN_LAYERED]);
}

shown shown_in_units(const shown *s, shown_units u) {
    const double L = u.length, T = u.time, stress = u.force / (L * L);
    shown out = *s;
    host_scene *scene = &out.scene;
    out.radius *= L;
    out.end *= T;
    scene->mesh.dx *= L;
    scene->mesh.dy *= L;
    scene->material.E_prime *= stress;
    scene->material.mu_prime *= stress * T;
    scene->material.K_prime *= stress * sqrt(L);
    scene->material.C_prime *= L / sqrt(T);
    for (int k = 0; k < HOST_LAYERS; k++)
        scene->sigma[k] *= stress;
    for (int k = 0; k < scene->interfaces; k++)
        scene->interface_y[k] *= L;
    for (int k = 0; k < scene->source_count; k++) {
        scene->source[k].x *= L;
        scene->source[k].y *= L;
        scene->source[k].rate *= L * L * L / T;
    }
    scene->options.dt_max *= T;
    return out;
}

static void turn_point(int turn, double *x, double *y) {
    const double u = turn & 4 ? *y : *x, v = turn & 4 ? *x : *y;
    *x = turn & 1 ? -u : u;
    *y = turn & 2 ? -v : v;
}

static ilsa_mesh_def turned_mesh(const ilsa_mesh_def *m, int turn) {
    return turn & 4 ? (ilsa_mesh_def){m->ny, m->nx, m->dy, m->dx} : *m;
}

int shown_turned_cell(const ilsa_mesh_def *mesh, int turn, int cell) {
    const ilsa_mesh_def m = turned_mesh(mesh, turn);
    int i = cell % mesh->nx, j = cell / mesh->nx;
    if (turn & 4) {
        const int k = i;
        i = j;
        j = k;
    }
    i = turn & 1 ? m.nx - 1 - i : i;
    j = turn & 2 ? m.ny - 1 - j : j;
    return j * m.nx + i;
}

shown shown_turned(const shown *s, int turn, double **cells) {
    shown out = *s;
    const ilsa_mesh_def *m = &s->scene.mesh;
    const int count = m->nx * m->ny;
    *cells = malloc((size_t)count * sizeof **cells);
    assert_non_null(*cells);
    for (int k = 0; k < count; k++)
        (*cells)[shown_turned_cell(m, turn, k)] =
            s->scene.cells ? s->scene.cells[k] : s->scene.sigma[0];
    out.scene.mesh = turned_mesh(m, turn);
    out.scene.cells = *cells;
    for (int k = 0; k < s->scene.source_count; k++)
        turn_point(turn, &out.scene.source[k].x, &out.scene.source[k].y);
    return out;
}

static const ilsa_survey_point *survey_of(ilsa_solver *solver, size_t *count) {
    const ilsa_survey_point *points;
    assert_int_equal(ilsa_get_survey(solver, &points, count), ILSA_OK);
    return points;
}

static const double *stress_of(const ilsa_solver *solver) {
    const double *sigma;
    assert_int_equal(ilsa_get_stress(solver, &sigma), ILSA_OK);
    return sigma;
}

/* Of widths and pressures; INFINITY where a cell is of another kind. */
static void compare_fields(const ilsa_mesh_def *m, const ilsa_solver *a, const ilsa_solver *b,
                           shown_units u, int turn, shown_difference *d) {
    const double *wa = host_width(a), *wb = host_width(b), stress = u.force / u.length / u.length;
    const double *pa = host_pressure(a), *pb = host_pressure(b), *sigma = stress_of(a);
    const unsigned char *ka = host_kind(a), *kb = host_kind(b);
    double width = 0, pressure = 0;
    for (int k = 0; k < m->nx * m->ny; k++) {
        const int other = shown_turned_cell(m, turn, k);
        if (ka[k] != kb[other])
            *d = (shown_difference){INFINITY, INFINITY, INFINITY, INFINITY};
        width = larger_of(width, wa[k]);
        d->width = worst_of(d->width, fabs(wb[other] / u.length - wa[k]));
        if (ka[k] < ILSA_CELL_SURVEY)
            continue;
        pressure = larger_of(pressure, fabs(pa[k] - sigma[k]));
        d->pressure = worst_of(d->pressure, fabs(pb[other] / stress - pa[k]));
    }
    d->width /= width;
    d->pressure /= pressure;
}

/* Of distances, in the smaller cell size. */
static void compare_front(const ilsa_mesh_def *m, ilsa_solver *a, ilsa_solver *b, shown_units u,
                          int turn, shown_difference *d) {
    size_t count_a, count_b;
    const ilsa_survey_point *at = survey_of(a, &count_a), *bt = survey_of(b, &count_b);
    double *distance = malloc((size_t)m->nx * (size_t)m->ny * sizeof *distance);
    assert_non_null(distance);
    if (count_a != count_b)
        d->front = INFINITY;
    for (size_t k = 0; k < count_b; k++)
        distance[bt[k].cell] = bt[k].s / u.length;
    for (size_t k = 0; k < count_a && d->front < INFINITY; k++) {
        const double other = distance[shown_turned_cell(m, turn, at[k].cell)];
        d->front = worst_of(d->front, fabs(other - at[k].s) / fmin(m->dx, m->dy));
    }
    free(distance);
}

shown_difference shown_compare(ilsa_solver *a, ilsa_solver *b, shown_units u, int turn) {
    ilsa_mesh_def mesh;
    shown_difference d = SHOWN_NOTHING_YET;
    assert_int_equal(ilsa_get_mesh_def(a, &mesh), ILSA_OK);
    compare_fields(&mesh, a, b, u, turn, &d);
    if (!(d.width < INFINITY))
        return d;
    compare_front(&mesh, a, b, u, turn, &d);
    d.time = relative(host_summary(b).time / u.time, host_summary(a).time);
    return d;
}

shown_difference shown_worse(shown_difference a, shown_difference b) {
    return (shown_difference){worst_of(a.width, b.width), worst_of(a.pressure, b.pressure),
                              worst_of(a.front, b.front), worst_of(a.time, b.time)};
}

double shown_largest(shown_difference d) {
    return worst_of(worst_of(d.width, d.pressure), worst_of(d.front, d.time));
}
