/*
 * What section 5.2 of the paper says of its fractures in three layers of stress, one test per
 * statement: symmetric barriers (5.8), asymmetric barriers (5.9), stress drop (5.10), each with
 * phi = 1e-4, 1e-2 and 1. Cells of H/11; H/21, as in the paper, with $ILSA_LONG.
 *
 * Every number is printed beside its bound. The bounds leave room for a few per cent of numerics.
 */
#include "check.h"
#include "host.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double H = 20, MPa = 1e6;

enum { SYMMETRIC, ASYMMETRIC, DROP, GROUPS };
static const char *const group_name[GROUPS] = {"symmetric", "asymmetric", "drop"};
static const double sigma[GROUPS][3] = {{7.75e6, 7e6, 7.75e6}, /* bottom, middle, top */
                                        {7.25e6, 7e6, 7.75e6},
                                        {6.5e6, 7e6, 7.25e6}};
static const double window[GROUPS][2] = {{155, 45.3}, {112, 90}, {92, 120.5}}; /* half sizes, m */

enum { PHI_LOW, PHI_MIDDLE, PHI_HIGH, PHIS };
static const char *const phi_name[PHIS] = {"1e-4", "1e-2", "1"};
static const double C_prime[PHIS] = {0.521e-5, 1.65e-5, 5.21e-5};

enum { T100, T400, T900, T1800, T3600, TIMES };
static const double times[TIMES] = {100, 400, 900, 1800, 3600};

/* ---- Runs -------------------------------------------------------------------------------------*/

enum { CELLS_MAX = 401, SURVEY_MAX = 2048, STEPS_MAX = 4096 };

/* Cells on a line through the source, which is in the middle one. */
typedef struct line {
    int count;
    double width[CELLS_MAX], pressure[CELLS_MAX];
    unsigned char kind[CELLS_MAX];
} line;

typedef struct instant {
    ilsa_summary s;
    line x, y;
    double y_farthest; /* of the front's point farthest along x */
    int survey_count;
    ilsa_survey_point survey[SURVEY_MAX];
} instant;

typedef struct run {
    const char *group, *phi;
    instant at[TIMES];
    int steps;
    double t[STEPS_MAX], width[STEPS_MAX], efficiency[STEPS_MAX];
} run;

static run runs[GROUPS][PHIS];
static double dx;

static void copy_line(const ilsa_solver *solver, line *l, int count, int start, int stride) {
    assert_true(count <= CELLS_MAX);
    l->count = count;
    for (int i = 0; i < count; i++) {
        const int cell = start + i * stride;
        l->width[i] = host_width(solver)[cell];
        l->pressure[i] = host_pressure(solver)[cell];
        l->kind[i] = host_kind(solver)[cell];
    }
}

/* Where along y the front is farthest along x. */
static double y_of_farthest(ilsa_solver *solver) {
    const ilsa_front_point *front, *best;
    size_t count;
    assert_int_equal(ilsa_get_front(solver, &front, &count), ILSA_OK);
    best = front;
    for (size_t i = 1; i < count; i++)
        best = front[i].x > best->x ? &front[i] : best;
    return best->y;
}

static void copy_instant(ilsa_solver *solver, instant *now) {
    const ilsa_survey_point *survey;
    size_t count;
    ilsa_mesh_def mesh;
    assert_int_equal(ilsa_get_mesh_def(solver, &mesh), ILSA_OK);
    assert_int_equal(ilsa_get_survey(solver, &survey, &count), ILSA_OK);
    assert_true(count > 0 && count <= SURVEY_MAX);
    now->s = host_summary(solver);
    copy_line(solver, &now->x, mesh.nx, mesh.ny / 2 * mesh.nx, 1);
    copy_line(solver, &now->y, mesh.ny, mesh.nx / 2, mesh.nx);
    now->survey_count = (int)count;
    memcpy(now->survey, survey, count * sizeof *survey);
    now->y_farthest = y_of_farthest(solver);
}

static ilsa_solver *start(int group, int phi, ilsa_symmetry symmetry) {
    const int nx = 2 * (int)(window[group][0] / dx) + 1, ny = 2 * (int)(window[group][1] / dx) + 1;
    host_scene scene = host_three_layers(nx, ny);
    scene.mesh.dx = scene.mesh.dy = dx;
    scene.material.C_prime = C_prime[phi];
    memcpy(scene.sigma, sigma[group], sizeof sigma[group]);
    scene.options.symmetry = symmetry;
    return host_started(&scene, 5);
}

static void follow(ilsa_solver *solver, run *r, double t_end) {
    while (host_summary(solver).time < t_end) {
        const int status = ilsa_advance_one(solver, t_end, NULL);
        if (status != ILSA_OK)
            fail_msg("%s, phi = %s: %s", r->group, r->phi, ilsa_last_error(solver));
        const ilsa_summary s = host_summary(solver);
        assert_true(r->steps < STEPS_MAX);
        r->t[r->steps] = s.time;
        r->width[r->steps] = s.width_source;
        r->efficiency[r->steps++] = s.efficiency;
    }
}

static int run_all(void **state) {
    (void)state;
    dx = H / (host_long() ? 21 : 11);
    for (int g = 0; g < GROUPS; g++)
        for (int p = 0; p < PHIS; p++) {
            ilsa_solver *solver = start(g, p, ILSA_SYMMETRY_AUTO);
            run *r = &runs[g][p];
            r->group = group_name[g];
            r->phi = phi_name[p];
            for (int k = 0; k < TIMES; k++) {
                follow(solver, r, times[k]);
                copy_instant(solver, &r->at[k]);
            }
            ilsa_solver_destroy(&solver);
        }
    return 0;
}

/* ---- Measures ---------------------------------------------------------------------------------*/

static void at_least(double value, double bound, const char *what, const run *r, double t) {
    print_message("  %s, phi = %s, %g s: %s %.4g, at least %.4g\n", r->group, r->phi, t, what,
                  value, bound);
    if (!isfinite(value) || !(value >= bound))
        fail_msg("%s, phi = %s, %g s: %s %.6g < %.6g", r->group, r->phi, t, what, value, bound);
}

static void at_most(double value, double bound, const char *what, const run *r, double t) {
    print_message("  %s, phi = %s, %g s: %s %.4g, at most %.4g\n", r->group, r->phi, t, what, value,
                  bound);
    if (!isfinite(value) || !(value <= bound))
        fail_msg("%s, phi = %s, %g s: %s %.6g > %.6g", r->group, r->phi, t, what, value, bound);
}

/* The value at a distance from the source along a line, linear between cell centres. */
static double along(const line *l, const double *values, double distance) {
    const int centre = l->count / 2;
    const double position = centre + distance / dx;
    const int i = (int)floor(position);
    assert_true(i >= 0 && i + 1 < l->count);
    return values[i] + (position - i) * (values[i + 1] - values[i]);
}

/* Where the opening on a line is largest. */
static double widest(const line *l) {
    const int centre = l->count / 2;
    int best = 0;
    for (int i = 1; i < l->count; i++)
        best = l->width[i] > l->width[best] ? i : best;
    return (best - centre) * dx;
}

/* The first cell on a line, from its upper or its lower end, that is not cut by the front. */
static int outermost(const line *l, int upper) {
    int i = upper ? l->count - 1 : 0;
    while (l->kind[i] != ILSA_CELL_SURVEY && l->kind[i] != ILSA_CELL_CHANNEL)
        i += upper ? -1 : 1;
    return i;
}

/* Means over the survey cells with y in low .. high. */
static ilsa_tip_regime mean_regime(const instant *now, double low, double high) {
    ilsa_tip_regime sum = {0};
    int count = 0;
    for (int i = 0; i < now->survey_count; i++)
        if (now->survey[i].y >= low && now->survey[i].y <= high) {
            sum.N_k += now->survey[i].regime.N_k;
            sum.N_mt += now->survey[i].regime.N_mt;
            sum.N_m += now->survey[i].regime.N_m;
            count++;
        }
    assert_true(count > 0);
    sum.N_k /= count;
    sum.N_mt /= count;
    sum.N_m /= count;
    return sum;
}

/* The front's velocity seen from the highest or the lowest survey cell, the nearest to x = 0. */
static double end_velocity(const instant *now, int upper) {
    const ilsa_survey_point *best = now->survey;
    for (const ilsa_survey_point *p = best; p < now->survey + now->survey_count; p++) {
        const double higher = upper ? p->y - best->y : best->y - p->y;
        if (higher > 0 || (higher == 0 && fabs(p->x) < fabs(best->x)))
            best = p;
    }
    return best->V;
}

/* ---- 5.2.1 Symmetric barriers: Figs. 8 to 10 --------------------------------------------------*/

/* The whole fracture is solved, so that the mirrored halves could differ. */
static void symmetric_footprint_is_mirrored(void **state) {
    (void)state;
    static run r = {.group = "symmetric", .phi = "1e-2"};
    static instant now;
    ilsa_solver *solver = start(SYMMETRIC, PHI_MIDDLE, ILSA_SYMMETRY_NONE);
    follow(solver, &r, times[T900]);
    copy_instant(solver, &now);
    ilsa_solver_destroy(&solver);
    double skew = NOTHING_YET;
    for (int i = 0; i < now.x.count; i++)
        skew = worst_of(skew, fabs(now.x.width[i] - now.x.width[now.x.count - 1 - i]));
    for (int i = 0; i < now.y.count; i++)
        skew = worst_of(skew, fabs(now.y.width[i] - now.y.width[now.y.count - 1 - i]));
    const ilsa_summary *s = &now.s;
    at_most(fabs(s->x_max + s->x_min) / dx, 0.01, "left against right, cells", &r, s->time);
    at_most(fabs(s->y_max + s->y_min) / dx, 0.01, "up against down, cells", &r, s->time);
    at_most(skew / s->width_source, 0.001, "width against its mirror image", &r, s->time);
}

static double length_of(const ilsa_summary *s) {
    return s->x_max - s->x_min;
}

static double height_of(const ilsa_summary *s) {
    return s->y_max - s->y_min;
}

/* A fracture without barriers would stay round. */
static void symmetric_is_longer_than_high(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++)
        for (int k = T400; k < TIMES; k++) {
            const run *r = &runs[SYMMETRIC][p];
            const ilsa_summary *s = &r->at[k].s;
            at_least(length_of(s) / height_of(s), k < T3600 ? 1.3 : 2.5, "length / height", r,
                     times[k]);
        }
}

/* "The fracture grows monotonically with time": the footprints of Fig. 8 lie well inside another.
 */
static void symmetric_grows(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++)
        for (int k = 1; k < TIMES; k++) {
            const run *r = &runs[SYMMETRIC][p];
            const ilsa_summary *s = &r->at[k].s, *before = &r->at[k - 1].s;
            at_least(length_of(s) / length_of(before), 1.2, "length / that before", r, times[k]);
            at_least(height_of(s) / height_of(before), 1.08, "height / that before", r, times[k]);
            at_least(s->width_source / before->width_source, 1.05, "width / that before", r,
                     times[k]);
        }
}

/* Beyond y = H / 2 the opening is less than that of an ellipse as high, without barriers. */
static void symmetric_barriers_suppress_width(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++)
        for (int k = T900; k < TIMES; k++) {
            const run *r = &runs[SYMMETRIC][p];
            const instant *now = &r->at[k];
            const double y = 0.75 * H, ellipse = sqrt(1 - pow(y / now->s.y_max, 2));
            at_most(along(&now->y, now->y.width, y) / now->s.width_source / ellipse, 0.7,
                    "width at 3/4 H over the ellipse's", r, times[k]);
        }
}

/* Fall of pressure from H / 4, beyond the source's own peak, over the net pressure at H / 4. */
static double pressure_fall(const line *l, double to) {
    const double p = along(l, l->pressure, H / 4);
    return (p - along(l, l->pressure, to)) / (p - 7 * MPa);
}

/*
 * Nearly constant along y within the layer, and up to 0.8 of the height once the fracture is long,
 * against the fall along x up to 0.8 of the length.
 */
static void symmetric_pressure_is_constant_along_y(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++)
        for (int k = T900; k < TIMES; k++) {
            const run *r = &runs[SYMMETRIC][p];
            const instant *now = &r->at[k];
            const double x_fall = pressure_fall(&now->x, 0.8 * now->s.x_max);
            const double layer_fall = pressure_fall(&now->y, 0.5 * H);
            at_most(layer_fall, 0.05, "fall of net pressure along y to H/2", r, times[k]);
            at_most(layer_fall / x_fall, 0.15, "the same over the fall along x", r, times[k]);
            if (k >= T1800)
                at_most(pressure_fall(&now->y, 0.8 * now->s.y_max) / x_fall, 0.4,
                        "fall along y to 0.8 of the height over that along x", r, times[k]);
        }
}

/* The cells within the layer drive the length, those in the barriers the height. */
static void symmetric_front_has_several_regimes(void **state) {
    (void)state;
    double leak_off = 0;
    for (int p = 0; p < PHIS; p++) {
        const run *r = &runs[SYMMETRIC][p];
        const instant *now = &r->at[T3600];
        const ilsa_tip_regime all = mean_regime(now, -HUGE_VAL, HUGE_VAL);
        const ilsa_tip_regime ahead = mean_regime(now, -0.4 * H, 0.4 * H);
        const ilsa_tip_regime above = mean_regime(now, 0.5 * H, HUGE_VAL);
        at_least(all.N_mt - leak_off, 0.1, "leak-off share N_mt above that of less leak-off", r,
                 3600);
        at_least(above.N_k - ahead.N_k, 0.05, "toughness share N_k, barrier less layer", r, 3600);
        leak_off = all.N_mt;
    }
}

/* More leak-off: shorter, lower, narrower, less efficient. Figs. 10 and 15. */
static void leak_off_makes_smaller(void **state) {
    (void)state;
    for (int g = SYMMETRIC; g <= ASYMMETRIC; g++)
        for (int p = 1; p < PHIS; p++)
            for (int k = 0; k < TIMES; k++) {
                const run *r = &runs[g][p];
                const ilsa_summary *s = &r->at[k].s, *less = &runs[g][p - 1].at[k].s;
                const double bound = k < T3600 ? 0.995 : 0.95;
                at_most(length_of(s) / length_of(less), bound, "length ratio", r, times[k]);
                at_most(height_of(s) / height_of(less), bound, "height ratio", r, times[k]);
                at_most(s->width_source / less->width_source, 0.995, "width ratio", r, times[k]);
                at_most(s->efficiency / less->efficiency, 0.95, "efficiency ratio", r, times[k]);
            }
}

/* ---- 5.2.2 Asymmetric barriers: Figs. 11 to 15 ------------------------------------------------*/

static void asymmetric_grows_into_weaker_barrier(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++)
        for (int k = T400; k < TIMES; k++) {
            const run *r = &runs[ASYMMETRIC][p];
            const ilsa_summary *s = &r->at[k].s;
            at_least(-s->y_min / s->y_max, k < T3600 ? 1.15 : 2, "down / up", r, times[k]);
        }
}

/* Growth downwards slows that upwards, whose regime comes closer to the k vertex. */
static void asymmetric_slows_upward_growth(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++)
        for (int k = T900; k < TIMES; k++) {
            const run *r = &runs[ASYMMETRIC][p];
            const instant *now = &r->at[k], *symmetric = &runs[SYMMETRIC][p].at[k];
            at_most(now->s.y_max / symmetric->s.y_max, 0.95, "up / that between equal barriers", r,
                    times[k]);
            const double up = mean_regime(now, 0.5 * H, HUGE_VAL).N_k;
            at_least(up - mean_regime(symmetric, 0.5 * H, HUGE_VAL).N_k, 0.03,
                     "upper N_k above that between equal barriers", r, times[k]);
            at_least(up - mean_regime(now, -HUGE_VAL, -0.5 * H).N_k, 0.04,
                     "upper N_k above lower N_k", r, times[k]);
        }
}

/* "Substantially wider within the weaker stress barrier, while the pressure is smaller." */
static void asymmetric_is_wider_in_weaker_barrier(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++) {
        const run *r = &runs[ASYMMETRIC][p];
        const line *l = &r->at[T3600].y;
        const double y = 0.65 * H;
        at_least(along(l, l->width, -y) / along(l, l->width, y), 2, "width in lower / in upper", r,
                 3600);
        at_least((along(l, l->pressure, y) - along(l, l->pressure, -y)) / MPa, 0.01,
                 "pressure in upper - in lower, MPa", r, 3600);
    }
}

static void asymmetric_opening_is_shifted_down(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++)
        for (int k = T1800; k < TIMES; k++) {
            const run *r = &runs[ASYMMETRIC][p];
            at_most(widest(&r->at[k].y), -0.08 * H, "y of the widest cell, m", r, times[k]);
        }
}

/* The extent at y = 0 is "slightly smaller" than that of the footprint, which lies below. */
static void asymmetric_is_longest_below_source(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++) {
        const run *r = &runs[ASYMMETRIC][p];
        const ilsa_summary *s = &r->at[T3600].s;
        at_least(s->extent_x_max / s->x_max - 1, 0.0002, "extent / half-length - 1", r, 3600);
        at_most(s->extent_x_max / s->x_max - 1, 0.03, "extent / half-length - 1", r, 3600);
        at_most(r->at[T3600].y_farthest, -0.02 * H, "y of the farthest point along x, m", r, 3600);
    }
}

/* Figs. 10 and 15 are alike, "there is a noticeable quantitative difference". */
static void asymmetric_differs_from_symmetric(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++) {
        const run *r = &runs[ASYMMETRIC][p];
        const ilsa_summary *s = &r->at[T3600].s, *symmetric = &runs[SYMMETRIC][p].at[T3600].s;
        at_most(length_of(s) / length_of(symmetric), 0.85, "length / symmetric", r, 3600);
        at_least(height_of(s) / height_of(symmetric), 1.15, "height / symmetric", r, 3600);
        at_most(s->width_source / symmetric->width_source, 0.92, "width / symmetric", r, 3600);
    }
}

/* ---- 5.2.3 Stress drop: Figs. 16 to 20 --------------------------------------------------------*/

static void drop_grows_downwards(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++) {
        const run *r = &runs[DROP][p];
        const ilsa_summary *s = &r->at[T3600].s;
        at_least(-s->y_min / s->y_max, 3, "down / up", r, 3600);
    }
}

/* In the last half hour the top hardly moves, while the bottom goes on. */
static void drop_arrests_top(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++) {
        const run *r = &runs[DROP][p];
        const instant *before = &r->at[T1800], *now = &r->at[T3600];
        const double down = before->s.y_min - now->s.y_min, up = now->s.y_max - before->s.y_max;
        at_least(down, 0.4 * H, "growth down in the last half hour, m", r, 3600);
        at_most(up / down, p < PHI_HIGH ? 0.002 : 0.03, "growth up / growth down", r, 3600);
        at_most(end_velocity(now, 1) / end_velocity(now, 0), p < PHI_HIGH ? 0 : 0.05,
                "V at the top / at the bottom", r, 3600);
        at_least(mean_regime(now, 0.5 * H, HUGE_VAL).N_k, p < PHI_HIGH ? 0.95 : 0.5,
                 "upper N_k, which is 1 at V = 0,", r, 3600);
    }
}

/* In the layer of low stress, once the fracture is mature; at the source before. */
static void drop_is_widest_in_low_stress(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++) {
        const run *r = &runs[DROP][p];
        at_most(fabs(widest(&r->at[T100].y)), 0.1 * H, "distance of the widest cell, m", r, 100);
        for (int k = T900; k < TIMES; k++)
            at_most(widest(&r->at[k].y), -0.6 * H, "y of the widest cell, m", r, times[k]);
    }
}

/* In the top it goes to that layer's stress; where it is at rest the fall to the tip goes away. */
static void drop_pressure_in_the_top(void **state) {
    (void)state;
    const double top = sigma[DROP][2];
    for (int p = 0; p < PHIS; p++) {
        const run *r = &runs[DROP][p];
        const line *early = &r->at[T100].y, *late = &r->at[T3600].y;
        const double p_late = late->pressure[outermost(late, 1)];
        const double p_early = early->pressure[outermost(early, 1)];
        const double fall_early = along(early, early->pressure, 0.25 * H) - p_early;
        const double fall_late = along(late, late->pressure, 0.25 * H) - p_late;
        at_most(fabs(p_late - top) / MPa, 0.1, "|p in the top - sigma_3|, MPa", r, 3600);
        if (p < PHI_HIGH)
            at_most(fall_late / fall_early, 0.7,
                    "fall from H/4 to the top's last cell, late / early", r, 3600);
    }
}

/* Above the stress in the low layer and falling downwards, far from that in the top. */
static void drop_pressure_in_the_bottom(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++) {
        const run *r = &runs[DROP][p];
        const instant *now = &r->at[T3600];
        const int centre = now->y.count / 2;
        double least = HUGE_VAL, rise = NOTHING_YET;
        for (int i = outermost(&now->y, 0) + 1; (centre - i) * dx > 0.5 * H; i++) {
            least = smaller_of(least, now->y.pressure[i] - sigma[DROP][0]);
            rise = worst_of(rise, now->y.pressure[i] - now->y.pressure[i + 1]);
        }
        const double low = along(&now->y, now->y.pressure, 0.8 * now->s.y_min);
        at_least(least / MPa, 0.02, "least p - sigma_1 in the low layer, MPa", r, 3600);
        at_most(rise / MPa, 0, "largest rise of p from a cell to the one below, MPa", r, 3600);
        at_least((along(&now->y, now->y.pressure, -0.5 * H) - low) / MPa, 0.1,
                 "fall of p through the low layer, MPa", r, 3600);
        at_least((now->y.pressure[outermost(&now->y, 1)] - low) / MPa, 0.3,
                 "p in the top - in the bottom, MPa", r, 3600);
    }
}

static int widest_step(const run *r) {
    int best = 0;
    for (int i = 1; i < r->steps; i++)
        best = r->width[i] > r->width[best] ? i : best;
    return best;
}

/* It rises to a maximum, then falls to a plateau. Between barriers it rises to the end. */
static void drop_wellbore_width_has_maximum(void **state) {
    (void)state;
    for (int p = 0; p < PHIS; p++) {
        const run *r = &runs[DROP][p];
        const int best = widest_step(r);
        const double end = r->at[T3600].s.width_source, fall = r->width[best] - end;
        at_least(r->t[best], 100, "time of the largest width, s,", r, 3600);
        at_most(r->t[best], 600, "time of the largest width, s,", r, 3600);
        at_least(fall / r->width[best], 0.025, "fall from it to the end / largest width", r, 3600);
        at_most((r->at[T1800].s.width_source - end) / fall, 0.4,
                "last half hour's part of the fall", r, 3600);
        at_most(fabs(r->at[T1800].s.width_source / end - 1), 0.025, "|width / that at the end - 1|",
                r, 1800);
        for (int g = SYMMETRIC; g <= ASYMMETRIC; g++)
            at_least(runs[g][p].t[widest_step(&runs[g][p])], 3500, "time of the largest width, s,",
                     &runs[g][p], 3600);
    }
}

/* Ratio of the largest to the least over phi, less 1. */
static double spread(int group, int k) {
    double low = HUGE_VAL, high = 0;
    for (int p = 0; p < PHIS; p++) {
        low = smaller_of(low, runs[group][p].at[k].s.width_source);
        high = larger_of(high, runs[group][p].at[k].s.width_source);
    }
    return high / low - 1;
}

static void drop_wellbore_width_ignores_leak_off(void **state) {
    (void)state;
    for (int k = T400; k < TIMES; k++) {
        at_most(spread(DROP, k), 0.04, "spread of width over phi", &runs[DROP][PHI_HIGH], times[k]);
        at_most(spread(DROP, k) / spread(SYMMETRIC, k), 0.4, "the same over that of symmetric",
                &runs[DROP][PHI_HIGH], times[k]);
    }
}

/* ---- All --------------------------------------------------------------------------------------*/

static void efficiency_falls(void **state) {
    (void)state;
    for (int g = 0; g < GROUPS; g++)
        for (int p = 0; p < PHIS; p++) {
            const run *r = &runs[g][p];
            double rise = NOTHING_YET;
            for (int i = 1; i < r->steps; i++)
                rise = worst_of(rise, r->efficiency[i] - r->efficiency[i - 1]);
            at_most(rise, 0, "largest change of efficiency in a step", r, 3600);
            for (int k = 0; p > 0 && k < TIMES; k++)
                at_most(r->at[k].s.efficiency - runs[g][p - 1].at[k].s.efficiency, -0.05,
                        "efficiency less that of less leak-off", r, times[k]);
        }
}

/* "All very similar despite the drastic change in geometry." */
static void efficiency_is_alike_in_all_groups(void **state) {
    (void)state;
    for (int g = ASYMMETRIC; g < GROUPS; g++)
        for (int p = 0; p < PHIS; p++)
            for (int k = 0; k < TIMES; k++)
                at_most(fabs(runs[g][p].at[k].s.efficiency - runs[SYMMETRIC][p].at[k].s.efficiency),
                        0.07, "|efficiency - symmetric|", &runs[g][p], times[k]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(symmetric_footprint_is_mirrored),
        cmocka_unit_test(symmetric_is_longer_than_high),
        cmocka_unit_test(symmetric_grows),
        cmocka_unit_test(symmetric_barriers_suppress_width),
        cmocka_unit_test(symmetric_pressure_is_constant_along_y),
        cmocka_unit_test(symmetric_front_has_several_regimes),
        cmocka_unit_test(leak_off_makes_smaller),
        cmocka_unit_test(asymmetric_grows_into_weaker_barrier),
        cmocka_unit_test(asymmetric_slows_upward_growth),
        cmocka_unit_test(asymmetric_is_wider_in_weaker_barrier),
        cmocka_unit_test(asymmetric_opening_is_shifted_down),
        cmocka_unit_test(asymmetric_is_longest_below_source),
        cmocka_unit_test(asymmetric_differs_from_symmetric),
        cmocka_unit_test(drop_grows_downwards),
        cmocka_unit_test(drop_arrests_top),
        cmocka_unit_test(drop_is_widest_in_low_stress),
        cmocka_unit_test(drop_pressure_in_the_top),
        cmocka_unit_test(drop_pressure_in_the_bottom),
        cmocka_unit_test(drop_wellbore_width_has_maximum),
        cmocka_unit_test(drop_wellbore_width_ignores_leak_off),
        cmocka_unit_test(efficiency_falls),
        cmocka_unit_test(efficiency_is_alike_in_all_groups),
    };
    return cmocka_run_group_tests_name("layers", tests, run_all, NULL);
}
