/* The kinds of extremes and their cases. */
#include "common_extremes.h"
#include "common_worst.h"

#include <math.h>

/* ---- Scenes ------------------------------------------------------------------------------- */

/* A penny of 5 cells that is one of 10 at a time, in uniform stress. */
static extreme_scene penny_scene(penny_law law, double end) {
    return (extreme_scene){.law = law, .end = end, .first = 5, .last = 10, .aspect = 1, .room = 14};
}

static extreme_scene vertex_scene(int which) {
    return penny_scene(penny_cases[which].law, penny_cases[which].time);
}

/* The same with room to go astray; where it leaves the mesh it has arrived too. */
static extreme_scene wide_scene(int which) {
    extreme_scene s = vertex_scene(which);
    s.room = 25;
    s.to_edge = 1;
    return s;
}

static void grow(extreme_trial *t) {
    extreme_go(t, t->scene.end);
}

static void grow_round(extreme_trial *t) {
    grow(t);
    extreme_check_radius(t);
}

/* The pressure of the channel cells: the same to a hundredth but for what a mesh leaves. */
static void grow_uniform(extreme_trial *t) {
    const double *pressure;
    const unsigned char *kind;
    double low = INFINITY, high = 0;
    ilsa_mesh_def m;
    grow_round(t);
    if (!extreme_running(t))
        return;
    if (ilsa_get_pressure(t->solver, &pressure) || ilsa_get_cell_kinds(t->solver, &kind) ||
        ilsa_get_mesh_def(t->solver, &m)) {
        extreme_fail(t, "no fields");
        return;
    }
    for (int n = 0; n < m.nx * m.ny; n++)
        if (kind[n] == ILSA_CELL_CHANNEL) {
            low = smaller_of(low, pressure[n]);
            high = larger_of(high, pressure[n]);
        }
    if (!(high < 1.001 * low))
        extreme_fail(t, "net pressure from %g to %g", low, high);
}

/* ---- The parametric space ----------------------------------------------------------------- */

static void parametric_space(extreme_sweep *sweep) {
    static const double phi[] = {0, 1e-12, 1e-6, 1, 1e6, 1e12};
    for (size_t k = 0; k < sizeof phi / sizeof *phi; k++)
        for (int decade = -9; decade <= 9; decade++) {
            const extreme_scene s = penny_scene(radial_law(phi[k]), pow(10, decade));
            extreme_case(sweep, &s, grow_round, 0, "phi %g, tau 1e%d", phi[k], decade);
        }
}

static void vanishing_parts(extreme_sweep *sweep) {
    for (int decade = -9; decade <= 9; decade += 3) {
        const double time = pow(10, decade);
        const extreme_scene no_toughness = penny_scene((penny_law){"", 1, 0, 1}, time);
        const extreme_scene no_leak_off = penny_scene((penny_law){"", 1, 1, 0}, 3 * time);
        const extreme_scene neither = penny_scene((penny_law){"", 1, 0, 0}, time);
        extreme_case(sweep, &no_toughness, grow_round, 0, "K' = 0, C' = 1, t = 1e%d", decade);
        extreme_case(sweep, &no_leak_off, grow_round, 0, "C' = 0, K' = 1, t = 3e%d", decade);
        extreme_case(sweep, &neither, grow_round, 0, "K' = C' = 0, t = 1e%d", decade);
    }
}

/* Without viscosity the net pressure is the same everywhere, and the radius that of the K vertex.
 */
static void no_viscosity(extreme_sweep *sweep) {
    static const double C_prime[] = {0, 1e-3, 0.1, 1, 10};
    for (size_t k = 0; k < sizeof C_prime / sizeof *C_prime; k++)
        for (int decade = -6; decade <= 6; decade += 3) {
            extreme_scene s = penny_scene((penny_law){"", 0, 1, C_prime[k]}, pow(10, decade));
            extreme_case(sweep, &s, grow_uniform, 0, "C' = %g, t = 1e%d", C_prime[k], decade);
            s.whole = 1;
            s.x = s.y = 0.3;
            extreme_case(sweep, &s, grow, 0, "C' = %g, t = 1e%d, off its cell's centre", C_prime[k],
                         decade);
        }
}

/* ---- Mesh and step ------------------------------------------------------------------------ */

static void oblong_cells(extreme_sweep *sweep) {
    static const double aspect[] = {0.1, 0.2, 0.5, 2, 5, 10};
    for (int which = 0; which < PENNY_CASES; which++)
        for (size_t k = 0; k < sizeof aspect / sizeof *aspect; k++) {
            extreme_scene s = vertex_scene(which);
            s.aspect = aspect[k];
            extreme_case(sweep, &s, grow_round, 0, "%s, dx/dy %g", s.law.name, aspect[k]);
        }
}

static void starts(extreme_sweep *sweep) {
    static const double first[] = {2, 3, 100};
    for (int which = 0; which < PENNY_CASES; which++)
        for (size_t k = 0; k < sizeof first / sizeof *first; k++) {
            extreme_scene s = vertex_scene(which);
            s.first = first[k];
            s.last = first[k] < 10 ? 10 : first[k] + 2;
            s.room = s.last + 4;
            extreme_case(sweep, &s, grow_round, 0, "%s from %g cells", s.law.name, first[k]);
        }
}

/* Ten steps that ask for so many cells of advance, then on. */
static void ask(extreme_trial *t) {
    double dt = 0;
    extreme_go(t, t->start * 1.1);
    for (int k = 0; k < 10 && extreme_running(t); k++) {
        if (ilsa_suggest_dt(t->solver, &dt) != ILSA_OK)
            extreme_fail(t, "no suggestion: %s", ilsa_last_error(NULL));
        /* the suggestion of the default level is half a cell */
        dt *= 2 * t->parameter;
        if (extreme_time(t) + dt < t->scene.end || t->parameter > 2)
            (void)extreme_step(t, dt);
    }
    grow_round(t);
}

static void steps_asked_for(extreme_sweep *sweep) {
    for (int which = 0; which < PENNY_CASES; which++)
        for (int decade = -4; decade <= 2; decade++) {
            const extreme_scene s = vertex_scene(which);
            extreme_case(sweep, &s, ask, pow(10, decade), "%s, 1e%d cells", s.law.name, decade);
        }
}

/* Where in its cell the source is, in cells; and close to the edge of a mesh that coarsens. */
static void sources(extreme_sweep *sweep) {
    static const double at[][2] = {{0.5, 0},           {0.5, 0.5},      {0.5 - 1e-12, 0},
                                   {0.5 - 1e-6, 0.2},  {0.5 + 1e-6, 0}, {0.49, 0.49},
                                   {0.5 - 1e-9, -0.5}, {0.25, -0.25}};
    for (int which = 0; which < PENNY_CASES; which += 2)
        for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
            extreme_scene s = vertex_scene(which);
            s.x = at[k][0];
            s.y = at[k][1];
            extreme_case(sweep, &s, grow, 0, "%s, at (%.12g, %.12g) of its cell", s.law.name, s.x,
                         s.y);
        }
    for (int which = 0; which < PENNY_CASES; which += 2) {
        extreme_scene s = vertex_scene(which);
        s.first = 8;
        s.last = 12;
        s.room = 20;
        s.x = 10;
        s.y = -10;
        s.coarsen = 1;
        extreme_case(sweep, &s, grow, 0, "%s, beside the mesh's edge", s.law.name);
    }
}

/* ---- Stress ------------------------------------------------------------------------------- */

static const int layered[] = {PENNY_M, PENNY_K, PENNY_MIDDLE, PENNY_K_TILDE};
enum { LAYERED = sizeof layered / sizeof *layered };

static void barriers(extreme_sweep *sweep) {
    for (int n = 0; n < LAYERED; n++)
        for (int decade = -2; decade <= 3; decade++) {
            extreme_scene s = wide_scene(layered[n]);
            s.interfaces = 2;
            s.interface_y[0] = -6.5;
            s.interface_y[1] = 6.5;
            s.sigma[0] = s.sigma[2] = pow(10, decade);
            extreme_case(sweep, &s, grow, 0, "%s, barriers of 1e%d p", s.law.name, decade);
        }
}

static void drops(extreme_sweep *sweep) {
    static const double depth[] = {0.1, 0.3, 1, 3, 10, 100};
    for (int n = 0; n < LAYERED; n++)
        for (size_t k = 0; k < sizeof depth / sizeof *depth; k++) {
            extreme_scene s = wide_scene(layered[n]);
            s.interfaces = 1;
            s.interface_y[0] = 6.5;
            s.sigma[1] = -depth[k];
            extreme_case(sweep, &s, grow, 0, "%s, a drop of %g p", s.law.name, depth[k]);
        }
}

static void thin_layers(extreme_sweep *sweep) {
    static const double stress[] = {-10, -1, -0.1, 0.1, 1, 10, 100};
    for (int n = 0; n < LAYERED; n++)
        for (size_t k = 0; k < sizeof stress / sizeof *stress; k++) {
            extreme_scene s = wide_scene(layered[n]);
            s.interfaces = 2;
            s.interface_y[0] = 6.5;
            s.interface_y[1] = 7.5;
            s.sigma[1] = stress[k];
            extreme_case(sweep, &s, grow, 0, "%s, a cell thick, %g p", s.law.name, stress[k]);
        }
}

static void layers_off_the_edges(extreme_sweep *sweep) {
    static const double off[] = {0.01, 0.25, 0.5, 0.9};
    for (int n = 0; n < LAYERED; n++)
        for (size_t k = 0; k < sizeof off / sizeof *off; k++)
            for (int decade = -1; decade <= 1; decade++) {
                extreme_scene s = wide_scene(layered[n]);
                s.interfaces = 2;
                s.interface_y[0] = -6.5 - off[k];
                s.interface_y[1] = 5.5 + off[k];
                s.sigma[0] = pow(10, decade);
                s.sigma[2] = 0.5 * s.sigma[0];
                extreme_case(sweep, &s, grow, 0, "%s, %g off, 1e%d p", s.law.name, off[k], decade);
            }
}

/* Discs of high stress above and below, that leave a waist. */
static double discs(double x, double y) {
    return hypot(x, fabs(y) - 11) < 5.2;
}

/* One beside the source, that the front goes around. */
static double island(double x, double y) {
    return hypot(x - 9, y) < 1.7;
}

static void waists(extreme_sweep *sweep) {
    for (int n = 0; n < LAYERED; n++)
        for (int decade = 0; decade <= 3; decade++) {
            extreme_scene s = wide_scene(layered[n]);
            s.last = 16;
            s.room = 36;
            s.stress = discs;
            s.scale = pow(10, decade);
            extreme_case(sweep, &s, grow, 0, "%s, discs of 1e%d p", s.law.name, decade);
        }
}

static int loops(const extreme_trial *t) {
    const ilsa_front_point *p;
    size_t count;
    int last = 0;
    if (ilsa_get_front(t->solver, &p, &count) != ILSA_OK)
        return 0;
    for (size_t k = 0; k < count; k++)
        last = p[k].loop > last ? p[k].loop : last;
    return last + 1;
}

static void go_around(extreme_trial *t) {
    grow(t);
    if (extreme_running(t) && loops(t) < 2)
        extreme_fail(t, "has not closed around the island");
}

/* Viscous fluid goes around; a tough rock's fracture may leave the island on one side. */
static void islands(extreme_sweep *sweep) {
    static const int law[] = {PENNY_M, PENNY_MIDDLE, PENNY_M_TILDE, PENNY_K, PENNY_K_TILDE};
    const int viscous = 2;
    static const double height[] = {3, 10, 30, 100, 1000};
    for (size_t k = 0; k < sizeof height / sizeof *height; k++)
        for (int n = 0; n < 5; n++) {
            extreme_scene s = wide_scene(law[n]);
            s.last = 18;
            s.room = 40;
            s.stress = island;
            s.scale = height[k];
            extreme_case(sweep, &s, n < viscous ? go_around : grow, 0, "%s, an island of %g p",
                         s.law.name, height[k]);
        }
}

/* ---- Rate --------------------------------------------------------------------------------- */

/* To another rate, until as much again is in, or for as long again. */
static void change_rate(extreme_trial *t) {
    extreme_go(t, t->start * 1.2);
    const double now = extreme_time(t), factor = t->parameter;
    extreme_set_rate(t, factor);
    extreme_go(t, now + (factor > 1 ? now / factor : now));
}

/* There and back, step by step. */
static void change_rates(extreme_trial *t) {
    double dt = 0;
    extreme_go(t, t->start * 1.2);
    for (int k = 0; k < 6 && extreme_running(t); k++) {
        extreme_set_rate(t, k % 2 ? 1 : t->parameter);
        (void)ilsa_suggest_dt(t->solver, &dt);
        extreme_go(t, extreme_time(t) + dt / fmax(t->parameter, 1));
    }
    extreme_set_rate(t, 1);
    extreme_go(t, t->scene.end);
}

static void rates(extreme_sweep *sweep) {
    static const double factor[] = {1e-6, 1e-3, 0.1, 10, 1e3, 1e6};
    for (int which = 0; which < PENNY_CASES; which++)
        for (size_t k = 0; k < sizeof factor / sizeof *factor; k++) {
            const extreme_scene s = wide_scene(which);
            extreme_case(sweep, &s, change_rate, factor[k], "%s, rate times %g", s.law.name,
                         factor[k]);
            extreme_case(sweep, &s, change_rates, factor[k], "%s, rate times %g and back",
                         s.law.name, factor[k]);
        }
}

/* Shut in for so many times the time so far. */
static void shut_in(extreme_trial *t) {
    extreme_go(t, t->start * 1.5);
    extreme_set_rate(t, 0);
    extreme_go(t, extreme_time(t) * (1 + t->parameter));
}

static void shut_in_and_restart(extreme_trial *t) {
    shut_in(t);
    extreme_set_rate(t, 1);
    const double now = extreme_time(t);
    extreme_go(t, now + fmax(0.5 * t->start, t->scene.end - now));
}

static void shut_ins(extreme_sweep *sweep) {
    static const double span[] = {1e-3, 0.1, 1, 100};
    for (int which = 0; which < PENNY_CASES; which++)
        for (size_t k = 0; k < sizeof span / sizeof *span; k++) {
            const extreme_scene s = wide_scene(which);
            extreme_case(sweep, &s, shut_in, span[k], "%s, shut in for %g t", s.law.name, span[k]);
            extreme_case(sweep, &s, shut_in_and_restart, span[k], "%s, shut in for %g t, restarted",
                         s.law.name, span[k]);
        }
}

/* ------------------------------------------------------------------------------------------- */

const extreme_kind extreme_kinds[] = {
    {"parametric space", "tau 1e-9 .. 1e9, phi 0 .. 1e12, radial", parametric_space},
    {"vanishing parts", "K' = 0, C' = 0, both, at nine decades of time, radial", vanishing_parts},
    {"no viscosity", "mu' = 0 with toughness, radial, pressure uniform to 0.1 %", no_viscosity},
    {"oblong cells", "dx/dy 0.1 .. 10, radial", oblong_cells},
    {"starts", "from 2, 3 and 100 cells, radial", starts},
    {"steps asked for", "1e-4 .. 100 cells in one step, radial", steps_asked_for},
    {"sources", "on and beside edges and corners of cells; beside the mesh's edge", sources},
    {"barriers", "stress up by 0.01 .. 1000 net pressures from one cell to the next", barriers},
    {"drops", "stress down by 0.1 .. 100 net pressures from one cell to the next", drops},
    {"thin layers", "a layer one cell thick, -10 .. 100 net pressures", thin_layers},
    {"layers off the edges", "interfaces anywhere in a cell, 0.1 .. 10 net pressures",
     layers_off_the_edges},
    {"waists", "a footprint in the shape of an hourglass", waists},
    {"islands", "a front that meets itself behind an island of high stress", islands},
    {"rates", "times 1e-6 .. 1e6 between two steps, and back", rates},
    {"shut-ins", "rate 0 for 1e-3 .. 100 times the time so far, and a restart", shut_ins},
};
const int extreme_kind_count = sizeof extreme_kinds / sizeof *extreme_kinds;
