#include "common_radial.h"
#include "common_worst.h"

#include "tip/penny.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char path[] = "tests/data/radial_history.csv";

const penny_case penny_cases[PENNY_CASES] = {
    [PENNY_M] = {{"M", 1, 0, 0}, 1},
    [PENNY_M_TILDE] = {{"M-tilde", 1, 0, 1}, 100},
    [PENNY_K] = {{"K", 1, 1, 0}, 1e5},
    [PENNY_K_TILDE] = {{"K-tilde", 1e-4, 1, 1}, 100},
    [PENNY_MIDDLE] = {{"phi 1e-4, tau 1", 1, 1, 0.1}, 1},
};

static penny table[RADIAL_PHIS][RADIAL_TAUS];
static double slope[RADIAL_PHIS][RADIAL_TAUS]; /* d ln R / d ln tau */
static double phis[RADIAL_PHIS];

static void stop(const char *what) {
    fprintf(stderr, "%s: %s (run from the top of the tree)\n", path, what);
    exit(EXIT_FAILURE);
}

static void load(void) {
    static int loaded;
    char header[512];
    if (loaded)
        return;
    FILE *file = fopen(path, "r");
    if (!file || !fgets(header, sizeof header, file))
        stop("cannot be read");
    for (int k = 0; k < RADIAL_PHIS * RADIAL_TAUS; k++) {
        penny *p = &table[k / RADIAL_TAUS][k % RADIAL_TAUS];
        double phi, V, error;
        /* NOLINTNEXTLINE(cert-err34-c): our own table; a number out of range becomes infinite */
        if (fscanf(file, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &phi, &p->time, &p->R,
                   &p->efficiency, &p->width, &V, &slope[k / RADIAL_TAUS][k % RADIAL_TAUS],
                   &p->width_half, &p->pressure_half, &error) != 10)
            stop("a row is not of ten numbers");
        if (k % RADIAL_TAUS && phi != phis[k / RADIAL_TAUS])
            stop("has not 49 times for each phi");
        phis[k / RADIAL_TAUS] = phi;
    }
    fclose(file);
    loaded = 1;
}

double radial_phi(int phi_index) {
    load();
    return phis[phi_index];
}

penny radial_row(int phi_index, int tau_index) {
    load();
    return table[phi_index][tau_index];
}

penny_law radial_law(double phi) {
    return (penny_law){"", 1, 1, pow(phi, 0.25)};
}

/* Which phi of the table a law is, -1 for none. */
static int phi_of(penny_law law) {
    load();
    for (int k = 0; k < RADIAL_PHIS; k++)
        if (law.mu_prime == 1 && law.K_prime == 1 && law.C_prime == pow(phis[k], 0.25))
            return k;
    return -1;
}

/* Cubic through four values at -1, 0, 1, 2. */
static double cubic(const double f[4], double u) {
    const double a = u + 1, b = u, c = u - 1, d = u - 2;
    return -f[0] * b * c * d / 6 + f[1] * a * c * d / 2 - f[2] * a * b * d / 2 +
           f[3] * a * b * c / 6;
}

/* Cubic Hermite in the logarithms, with the slopes of the table. */
static double radius_between(int phi, int k, double u) {
    const double h = log(table[phi][k + 1].time / table[phi][k].time);
    const double a = log(table[phi][k].R), b = log(table[phi][k + 1].R);
    const double v = 1 - u;
    return exp(a * v * v * (1 + 2 * u) + b * u * u * (3 - 2 * u) +
               h * u * v * (v * slope[phi][k] - u * slope[phi][k + 1]));
}

static penny interpolate(int phi, double time) {
    const double at = 4 * (log10(time) + 6);
    int k = (int)floor(at);
    k = k < 1 ? 1 : k > RADIAL_TAUS - 3 ? RADIAL_TAUS - 3 : k;
    const penny *p = &table[phi][k - 1];
    const double u = at - k;
    penny r = {.time = time, .R = radius_between(phi, k, u)};
    double f[4][4];
    for (int i = 0; i < 4; i++) {
        f[0][i] = log(p[i].efficiency);
        f[1][i] = log(p[i].width);
        f[2][i] = log(p[i].width_half);
        f[3][i] = log(p[i].pressure_half);
    }
    r.efficiency = exp(cubic(f[0], u));
    r.width = exp(cubic(f[1], u));
    r.width_half = exp(cubic(f[2], u));
    r.pressure_half = exp(cubic(f[3], u));
    return r;
}

static penny of_solution(const penny_solution *s) {
    penny p = {.time = s->t, .R = s->R, .efficiency = s->efficiency};
    p.width = ilsai_penny_width(s, 0);
    p.width_half = ilsai_penny_width(s, 0.5);
    p.pressure_half = ilsai_penny_pressure(s, 0.5);
    return p;
}

static void check(ilsa_status status) {
    if (status != ILSA_OK) {
        fprintf(stderr, "penny-shaped solution: %s\n", ilsa_status_text(status));
        exit(EXIT_FAILURE);
    }
}

/* The M vertex: tests/data/radial_vertices.csv, in its own scales. */
static penny viscosity_vertex(double time) {
    return (penny){.time = time,
                   .R = 6.9783755229992e-01 * pow(time, 4.0 / 9),
                   .efficiency = 1,
                   .width = 1.1932560029246 * pow(time, 1.0 / 9),
                   .width_half = 9.0225020028353e-01 * pow(time, 1.0 / 9),
                   .pressure_half = 6.1953807844031e-01 * pow(time, -1.0 / 3)};
}

penny radial_reference(penny_law law, double time) {
    const ilsa_material_def scaled = {1, law.mu_prime, law.K_prime, law.C_prime};
    const int phi = phi_of(law);
    penny_solution s;
    if (phi >= 0 && time >= 2e-6 && time <= 5e5)
        return interpolate(phi, time);
    if (law.mu_prime == 1 && law.K_prime == 0 && law.C_prime == 0)
        return viscosity_vertex(time);
    check(ilsai_penny_at_time(&scaled, 1, time, &s));
    return of_solution(&s);
}

double radial_time_of(penny_law law, double R) {
    const ilsa_material_def scaled = {1, law.mu_prime, law.K_prime, law.C_prime};
    penny_solution s;
    check(ilsai_penny_at_radius(&scaled, 1, R, &s));
    return s.t;
}

penny radial_error(const penny *found, const penny *reference) {
    return (penny){.time = found->time,
                   .R = found->R / reference->R - 1,
                   .efficiency = found->efficiency - reference->efficiency,
                   .width = found->width / reference->width - 1,
                   .width_half = found->width_half / reference->width_half - 1,
                   .pressure_half = found->pressure_half / reference->pressure_half - 1};
}

static ilsa_solver *failed(const char *what, ilsa_solver *solver) {
    fprintf(stderr, "%s: %s\n", what, ilsa_last_error(solver));
    ilsa_solver_destroy(&solver);
    return NULL;
}

static ilsa_solver *create(const radial_def *def) {
    const ilsa_material_def scaled = {1, def->law.mu_prime, def->law.K_prime, def->law.C_prime};
    const ilsa_source_def well = {.rate = def->rate > 0 ? def->rate : 1};
    const int half = (int)ceil(def->mesh_cells) + 2;
    const ilsa_mesh_def grid = {2 * half + 1, 2 * (int)ceil(half * def->aspect) + 1, def->dx,
                                def->dx / def->aspect};
    ilsa_solver_def d = ilsa_solver_def_default();
    ilsa_mesh *mesh = NULL;
    ilsa_material *material = NULL;
    ilsa_solver *solver = NULL;
    ilsa_status status = ilsa_mesh_create(&grid, &mesh);
    status = status ? status : ilsa_material_create(&scaled, &material);
    d.mesh = mesh;
    d.material = material;
    d.sources = &well;
    d.source_count = 1;
    d.step_cells = def->step_cells;
    d.level = def->level ? def->level : d.level;
    d.coarsen = def->coarsen;
    d.tip = def->tip;
    status = status ? status : ilsa_solver_create(&d, &solver);
    ilsa_mesh_destroy(&mesh);
    ilsa_material_destroy(&material);
    return status ? failed("create", NULL) : solver;
}

ilsa_solver *radial_start(const radial_def *def, double R) {
    ilsa_solver *solver = create(def);
    return solver && ilsa_start_radial(solver, R) ? failed("start", solver) : solver;
}

ilsa_solver *radial_start_at(penny_law law, double time, double largest) {
    const double R = radial_reference(law, time).R;
    const radial_def def = {
        .law = law, .dx = 2 * R / largest, .aspect = 1, .mesh_cells = largest, .coarsen = 1};
    return radial_start(&def, R);
}

ilsa_status radial_advance(ilsa_solver *solver, double time, long attempts) {
    double now = 0;
    ilsa_status status = ilsa_get_time(solver, &now);
    while (status == ILSA_OK && now < time) {
        ilsa_report report;
        if (attempts <= 0)
            return ILSA_STALLED;
        status = ilsa_advance_one(solver, time, &report);
        attempts -= report.steps + report.rejected;
        now = report.time;
    }
    return status;
}

/* The radius where the piece of front from a to b crosses the ray through (x, y), 0 if it does not.
 */
static double on_ray(const ilsa_front_point *a, const ilsa_front_point *b, double x, double y) {
    const double ca = x * a->y - y * a->x, cb = x * b->y - y * b->x;
    if ((ca > 0) == (cb > 0) || x * a->x + y * a->y <= 0)
        return 0;
    const double f = ca / (ca - cb);
    return hypot(a->x + f * (b->x - a->x), a->y + f * (b->y - a->y));
}

radial_front radial_measure(ilsa_solver *solver) {
    const ilsa_front_point *f;
    size_t count;
    radial_front r = {.low = HUGE_VAL};
    double sum = 0, turn = 0;
    if (ilsa_get_front(solver, &f, &count) != ILSA_OK)
        return r;
    for (size_t i = 0; i < count; i++) {
        const ilsa_front_point *a = &f[i], *b = &f[i + 1 < count ? i + 1 : 0];
        const double ra = hypot(a->x, a->y), rb = hypot(b->x, b->y);
        const double angle = asin((a->x * b->y - a->y * b->x) / (ra * rb));
        r.low = smaller_of(r.low, ra);
        r.high = larger_of(r.high, ra);
        r.axis = larger_of(r.axis, on_ray(a, b, 1, 0));
        r.diagonal = larger_of(r.diagonal, on_ray(a, b, 1, 1));
        sum += 0.5 * (ra + rb) * angle;
        turn += angle;
    }
    r.mean = sum / turn;
    return r;
}

/* A field on the x axis, through four cells. */
static double on_axis(const ilsa_mesh_def *m, const double *field, double x) {
    const double at = x / m->dx + 0.5 * (m->nx - 1);
    const int i = (int)floor(at);
    return cubic(field + (size_t)(m->ny / 2) * (size_t)m->nx + i - 1, at - i);
}

penny radial_state(ilsa_solver *solver) {
    const double *width, *pressure;
    ilsa_summary s;
    ilsa_mesh_def m;
    penny p = {0};
    if (ilsa_get_summary(solver, &s) || ilsa_get_mesh_def(solver, &m) ||
        ilsa_get_width(solver, &width) || ilsa_get_pressure(solver, &pressure))
        return p;
    p.time = s.time;
    p.R = radial_measure(solver).mean;
    p.efficiency = s.efficiency;
    p.width = s.width_source;
    p.width_half = on_axis(&m, width, 0.5 * p.R);
    p.pressure_half = on_axis(&m, pressure, 0.5 * p.R);
    return p;
}

static void finish(radial_growth *g, ilsa_solver *solver, penny_law law) {
    ilsa_summary s = {0};
    ilsa_get_summary(solver, &s);
    g->state = radial_state(solver);
    g->reference = radial_reference(law, g->state.time);
    g->balance = (s.volume_fracture + s.volume_leaked) / s.volume_injected - 1;
    g->total = s.total;
}

radial_growth radial_grow(const penny_case *c, double cells, double aspect, double step_cells) {
    const double R = radial_reference(c->law, c->time).R;
    const radial_def def = {.law = c->law,
                            .dx = R / cells,
                            .aspect = aspect,
                            .mesh_cells = 1.1 * cells + 1,
                            .step_cells = step_cells};
    radial_growth g = {.status = ILSA_ERR_STATE};
    ilsa_solver *solver = radial_start(&def, 0.5 * R);
    if (!solver)
        return g;
    ilsa_report report = {0};
    g.status = ILSA_OK;
    while (g.status == ILSA_OK && report.time < c->time) {
        g.status = ilsa_advance_one(solver, c->time, &report);
        g.front = radial_measure(solver);
        if (g.front.mean > 0.8 * R)
            g.roundness = larger_of(g.roundness, (g.front.high - g.front.low) / g.front.mean);
    }
    finish(&g, solver, c->law);
    ilsa_solver_destroy(&solver);
    return g;
}

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double radial_median(double *values, int count) {
    if (count == 0)
        return NAN;
    qsort(values, (size_t)count, sizeof *values, compare);
    return count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}
