/* The state on cells twice as large: nothing lost, and the fracture goes on as it did. */
#include "base/error.h"
#include "check.h"
#include "csv.h"
#include "host.h"
#include "model/mesh.h"
#include "step/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void check_message(const char *message, const char *part) {
    if (!strstr(message, part))
        fail_msg("message '%s' does not contain '%s'", message, part);
}

static void coarsen(ilsa_solver *solver) {
    assert_int_equal(ilsa_coarsen(solver), ILSA_OK);
}

/* Scenes: every parity of the counts, oblong cells, with and without leak-off, off centre. */
enum { SCENES = 10 };

static host_scene scene_of(int which) {
    static double cells[42 * 42];
    host_scene scene = host_penny(which % 2 ? 1 : 0, 41 - which % 3, 0.1);
    scene.mesh.ny = 40 + which % 2;
    scene.mesh.dy = which == 3 ? 0.12 : 0.1;
    scene.source[0].x = which == 4 || which == 5 ? 0.27 : 0;
    scene.source[0].y = which == 5 ? -0.4 : 0;
    for (int k = 0; k < scene.mesh.nx * scene.mesh.ny; k++)
        cells[k] = 0.05 * (k % 3) + 0.01 * (k / scene.mesh.nx % 7);
    scene.cells = which == 6 || which == 7 ? cells : NULL;
    scene.interfaces = which == 8 || which == 9;
    scene.interface_y[0] = 0.33;
    scene.sigma[1] = scene.interfaces ? 0.3 : 0;
    return scene;
}

/* Conservation */

static double sum(const ilsa_solver *solver, const double *field) {
    return field ? host_integral(solver, field) : 0;
}

static void volumes_are_kept(void **unused) {
    (void)unused;
    double worst = NOTHING_YET;
    for (int which = 0; which < SCENES; which++) {
        host_scene scene = scene_of(which);
        ilsa_solver *solver = host_started(&scene, 0.9);
        host_steps(solver, 4);
        for (int time = 0; time < 2; time++) {
            ilsa_summary before = host_summary(solver);
            double width = sum(solver, solver->fracture.cells.width);
            double leaked = sum(solver, solver->fracture.cells.leaked);
            coarsen(solver);
            ilsa_summary now = host_summary(solver);
            worst = worst_of(worst, fabs(sum(solver, solver->fracture.cells.width) / width - 1));
            if (leaked > 0)
                worst =
                    worst_of(worst, fabs(sum(solver, solver->fracture.cells.leaked) / leaked - 1));
            assert_true(now.time == before.time);
            assert_true(now.volume_injected == before.volume_injected);
            assert_true(now.volume_fracture == before.volume_fracture);
            assert_true(now.volume_leaked == before.volume_leaked);
            assert_true(fabs(host_imbalance(solver)) <= 1e-12);
            host_steps(solver, 2);
            assert_true(fabs(host_imbalance(solver)) <= 1e-12);
            if (now.extent_x_max - now.extent_x_min < 16 * scene.mesh.dx * (time + 1))
                break;
        }
        ilsa_solver_destroy(&solver);
    }
    print_message("coarsen: volumes off by %.1e\n", worst);
    assert_below(worst, 1e-14);
}

static void the_mesh_is_twice_as_coarse(void **unused) {
    (void)unused;
    for (int which = 0; which < SCENES; which++) {
        host_scene scene = scene_of(which);
        ilsa_solver *solver = host_started(&scene, 0.9);
        coarsen(solver);
        ilsa_mesh_def mesh;
        assert_int_equal(ilsa_get_mesh_def(solver, &mesh), ILSA_OK);
        assert_true(mesh.nx == scene.mesh.nx && mesh.ny == scene.mesh.ny);
        assert_true(mesh.dx == 2 * scene.mesh.dx && mesh.dy == 2 * scene.mesh.dy);
        ilsa_solver_destroy(&solver);
    }
}

/* Layers are averaged over the new cells, values per cell over the old cells under a new one. */
static void stress_follows(void **unused) {
    (void)unused;
    host_scene scene = scene_of(8);
    ilsa_solver *solver = host_started(&scene, 0.9);
    coarsen(solver);
    host_scene twice = scene;
    twice.mesh.dx *= 2;
    twice.mesh.dy *= 2;
    ilsa_solver *direct = host_started(&twice, 0.9);
    const double *a, *b;
    assert_int_equal(ilsa_get_stress(solver, &a), ILSA_OK);
    assert_int_equal(ilsa_get_stress(direct, &b), ILSA_OK);
    assert_memory_equal(a, b, sizeof *a * ilsai_mesh_cells(&scene.mesh));
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&direct);
    scene = scene_of(7);
    solver = host_started(&scene, 0.9);
    host_steps(solver, 2);
    coarsen(solver);
    assert_int_equal(ilsa_get_stress(solver, &a), ILSA_OK);
    /* A cell near the middle of an odd mesh: one old cell and the halves of its neighbours. */
    int nx = scene.mesh.nx, ny = scene.mesh.ny, i = nx / 2, j = ny / 2;
    assert_true(nx % 2 == 0 && ny % 2 == 1);
    double mean = 0;
    for (int c = 0; c < 2; c++)
        for (int r = -1; r <= 1; r++)
            mean += (r ? 0.125 : 0.25) * scene.cells[(j + r) * nx + i + c];
    assert_true(fabs(a[j * nx + i] / mean - 1) < 1e-14);
    ilsa_solver_destroy(&solver);
}

/* Levels, trigger times, paths: against a penny laid on the coarse mesh at once */

typedef struct pair {
    host_scene scene;
    ilsa_solver *coarsened, *direct;
} pair;

static pair make_pair(double phi, int nx, int ny) {
    pair p = {.scene = host_penny(phi, nx, 0.05)};
    p.scene.mesh.ny = ny;
    p.coarsened = host_started(&p.scene, 0.8);
    coarsen(p.coarsened);
    p.scene.mesh.dx *= 2;
    p.scene.mesh.dy *= 2;
    p.direct = host_started(&p.scene, 0.8);
    return p;
}

static void release(pair *p) {
    ilsa_solver_destroy(&p->coarsened);
    ilsa_solver_destroy(&p->direct);
}

static void levels_are_interpolated(void **unused) {
    (void)unused;
    for (int n = 0; n < 4; n++) {
        pair p = make_pair(1, 40 + n % 2, 40 + n / 2);
        const fields *a = &p.coarsened->fracture.cells, *b = &p.direct->fracture.cells;
        double worst = NOTHING_YET, h = p.scene.mesh.dx;
        int other = 0, near = 0;
        for (int k = 0; k < p.scene.mesh.nx * p.scene.mesh.ny; k++) {
            other += (a->kind[k] == ILSA_CELL_EMPTY) != (b->kind[k] == ILSA_CELL_EMPTY);
            if (fabs(b->level[k]) > 1.5 * h)
                continue;
            near++;
            worst = worst_of(worst, fabs(a->level[k] - b->level[k]) / h);
        }
        print_message(
            "coarsen: %d x %d: levels off by %.3f cells, %d of %d cells wet in one only\n",
            p.scene.mesh.nx, p.scene.mesh.ny, worst, other, near);
        assert_below(worst, 0.1);
        assert_true(near > 50 && other < 14);
        ilsa_summary x = host_summary(p.coarsened), y = host_summary(p.direct);
        assert_true(fabs(x.x_max / y.x_max - 1) < 0.005 && fabs(x.y_min / y.y_min - 1) < 0.005);
        release(&p);
    }
}

static void trigger_times_are_interpolated(void **unused) {
    (void)unused;
    for (int n = 0; n < 2; n++) {
        pair p = make_pair(1, 40 + n, 40 + n);
        double worst = NOTHING_YET, time = host_summary(p.direct).time;
        int centre = p.scene.mesh.ny / 2 * p.scene.mesh.nx + p.scene.mesh.nx / 2, passed = 0;
        for (int k = 0; k < p.scene.mesh.nx * p.scene.mesh.ny; k++) {
            double a = p.coarsened->fracture.cells.trigger[k],
                   b = p.direct->fracture.cells.trigger[k];
            int kind = p.coarsened->fracture.cells.kind[k];
            assert_true(kind < ILSA_CELL_SURVEY || a <= time);
            assert_true(kind != ILSA_CELL_EMPTY || isinf(a));
            if (isfinite(a) && isfinite(b) && k != centre) {
                worst = worst_of(worst, fabs(a - b) / time);
                passed++;
            }
        }
        print_message("coarsen: trigger times of %d cells off by %.1e of the time\n", passed,
                      worst);
        assert_true(passed > 150);
        assert_below(worst, n ? 1e-12 : 0.02); /* odd: the centres are old centres */
        release(&p);
    }
}

/* Knots between the ends of a path, which must lie near the path of constant velocity. */
static int inner_knots(const ilsa_solver *solver, const tip_path *record) {
    const tip_cell_history *h = &record->history;
    double V = solver->fracture.cells.speed[record->cell];
    int last = h->count - 1;
    for (int k = 1; k < last; k++) {
        double t = h->t[last] - (h->ell[last] - h->ell[k]) / V;
        assert_true(fabs(h->t[k] - t) < 0.15 * h->t[last]);
    }
    return last - 1;
}

/* The paths of the front in the tip cells lead from entering the cell to where the front is. */
static void velocity_histories_are_kept(void **unused) {
    (void)unused;
    for (int n = 0; n < 2; n++) {
        pair p = make_pair(1, 40 + n, 40 + n);
        double time = host_summary(p.direct).time, worst = NOTHING_YET;
        int tips = 0, compared = 0, kept = 0;
        for (int k = 0; k < p.coarsened->fracture.paths.count; k++) {
            const tip_path *a = &p.coarsened->fracture.paths.at[k];
            const tip_path *b = ilsai_tip_paths_find(&p.direct->fracture.paths, a->cell);
            const tip_cell_history *h = &a->history;
            assert_int_equal(p.coarsened->fracture.cells.kind[a->cell], ILSA_CELL_TIP);
            assert_true(k == 0 || a->cell > p.coarsened->fracture.paths.at[k - 1].cell);
            assert_true(h->count >= 2 && h->ell[0] == 0 && h->t[h->count - 1] == time);
            for (int m = 1; m < h->count; m++)
                assert_true(h->t[m] > h->t[m - 1] && h->ell[m] >= h->ell[m - 1]);
            if (b && b->history.ell[b->history.count - 1] > 0.3 * p.scene.mesh.dx) {
                worst = worst_of(worst, fabs(h->t[0] - b->history.t[0]) / time);
                compared++;
            }
            tips++;
            kept += inner_knots(p.coarsened, a);
        }
        assert_int_equal(tips, host_summary(p.coarsened).tip_cells);
        print_message("coarsen: %d of %d tip cells entered up to %.3f of the time off, %d knots\n",
                      compared, tips, worst, kept);
        assert_true(kept > 30);
        assert_true(compared > 20);
        assert_below(worst, 0.1);
        release(&p);
    }
}

/* Velocities: of the survey cells and of the front, on the whole mesh and at its edge. */
static void velocities_are_kept(void **unused) {
    (void)unused;
    for (int n = 0; n < 4; n++) {
        host_scene scene = host_penny(n < 2 ? 0 : 1, 40 + n % 2, 0.05);
        scene.source[0].x = -0.3;
        ilsa_solver *solver = host_started(&scene, 0.5);
        while (ilsa_advance_one(solver, 1e9, NULL) == ILSA_OK) {
        }
        double fastest = host_summary(solver).V_max;
        coarsen(solver);
        assert_true(fabs(host_summary(solver).V_max / fastest - 1) < 0.1);
        for (size_t k = 0; k < ilsai_mesh_cells(&scene.mesh); k++)
            assert_true(isfinite(solver->fracture.cells.speed[k]) &&
                        solver->fracture.cells.speed[k] >= 0);
        const ilsa_front_point *points;
        size_t count;
        assert_int_equal(ilsa_get_front(solver, &points, &count), ILSA_OK);
        for (size_t k = 0; k < count; k++)
            assert_true(points[k].V <= 1.05 * fastest && points[k].V > 0.5 * fastest);
        ilsa_solver_destroy(&solver);
    }
}

/* Going on */

static double interpolate(const csv_table *table, double phi, double tau, const char *column) {
    for (size_t k = 0; k + 1 < csv_rows(table); k++) {
        double t0 = csv_get(table, k, "tau"), t1 = csv_get(table, k + 1, "tau");
        if (csv_get(table, k, "phi") == phi && t0 <= tau && tau < t1) {
            double f = log(tau / t0) / log(t1 / t0);
            double a = log(csv_get(table, k, column)), b = log(csv_get(table, k + 1, column));
            return exp(a + f * (b - a));
        }
    }
    fail_msg("no row for phi = %g, tau = %g", phi, tau);
    return NAN;
}

/* There is nothing but channel two new cells behind the front. */
static void check_channel(const ilsa_solver *solver) {
    const ilsa_mesh_def *mesh = &solver->model.mesh;
    double R = host_summary(solver).extent_x_max;
    for (int j = 0; j < mesh->ny; j++)
        for (int i = 0; i < mesh->nx; i++) {
            double r = hypot(ilsai_mesh_x(mesh, i), ilsai_mesh_y(mesh, j));
            int kind = solver->fracture.cells.kind[j * mesh->nx + i];
            assert_true(r > R - 2.5 * mesh->dx || kind == ILSA_CELL_CHANNEL);
            assert_true(r < R + 1.5 * mesh->dx || kind == ILSA_CELL_EMPTY);
        }
}

/* Levels of the channel are of any age: none of them makes a front again. */
static void channels_stay_channels(void **unused) {
    (void)unused;
    for (int n = 0; n < 4; n++) {
        host_scene scene = host_penny(n < 2 ? 0 : 1, 50 + n % 2, 0.02);
        ilsa_solver *solver = host_started(&scene, 0.3);
        for (int times = 0; times < 3; times++) {
            assert_int_equal(ilsa_advance(solver, 1e9, NULL), ILSA_MESH_EDGE);
            double before = host_summary(solver).x_max;
            coarsen(solver);
            check_channel(solver);
            assert_true(fabs(host_summary(solver).x_max / before - 1) < 0.003);
        }
        ilsa_solver_destroy(&solver);
    }
}

/* Grows to eight times its radius on one number of cells, coarsened on the way by the advance. */
static void check_growth(const csv_table *table, double phi, int n) {
    host_scene scene = host_penny(phi, n, 0.02);
    scene.options.coarsen = 1;
    ilsa_solver *solver = host_started(&scene, 0.3);
    long coarsened = 0;
    double worst = NOTHING_YET, off = NOTHING_YET, last_dx = 0.02;
    double end = host_summary(solver).time;
    while (coarsened < 3) {
        end *= 1.3;
        ilsa_report report;
        assert_int_equal(ilsa_advance(solver, end, &report), ILSA_OK);
        coarsened += report.coarsened;
        ilsa_summary now = host_summary(solver);
        ilsa_mesh_def mesh;
        assert_int_equal(ilsa_get_mesh_def(solver, &mesh), ILSA_OK);
        assert_true(now.time == end && mesh.dx == last_dx * (1 << report.coarsened));
        assert_int_equal(now.total.coarsened, coarsened);
        assert_true(fabs(host_imbalance(solver)) <= 1e-12);
        last_dx = mesh.dx;
        double R =
            0.25 * (now.extent_x_max - now.extent_x_min + now.extent_y_max - now.extent_y_min);
        worst = worst_of(worst, fabs(R / interpolate(table, phi, end, "R") - 1));
        off = worst_of(off, fabs(now.efficiency - interpolate(table, phi, end, "efficiency")));
    }
    ilsa_summary now = host_summary(solver);
    print_message("coarsen: phi %g, %d cells, three times to R = %.3f: R off by %.2f %%, "
                  "efficiency by %.4f\n",
                  phi, n, now.x_max, 100 * worst, off);
    assert_below(worst, 0.01);
    assert_below(off, 0.02);
    ilsa_solver_destroy(&solver);
}

static void growth_goes_on(void **unused) {
    (void)unused;
    csv_table *table = csv_read("tests/data/radial_history.csv");
    check_growth(table, 0, 71);
    check_growth(table, 1e-4, 70);
    check_growth(table, 1e-2, 71);
    check_growth(table, 1, 70);
    csv_free(table);
}

static void advance_coarsens_only_if_told(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1e-2, 41, 0.05);
    ilsa_solver *solver = host_started(&scene, 0.8);
    ilsa_report report;
    assert_int_equal(ilsa_advance(solver, 1e9, &report), ILSA_MESH_EDGE);
    assert_int_equal(report.coarsened, 0);
    ilsa_mesh_def mesh;
    assert_int_equal(ilsa_get_mesh_def(solver, &mesh), ILSA_OK);
    assert_true(mesh.dx == 0.05);
    scene.options.coarsen = 1;
    ilsa_solver *other = host_started(&scene, 0.8);
    while (mesh.dx == 0.05) {
        assert_int_equal(ilsa_advance_one(other, 1e9, &report), ILSA_OK);
        assert_int_equal(ilsa_get_mesh_def(other, &mesh), ILSA_OK);
        assert_true(report.coarsened == (mesh.dx == 0.1) && report.steps == 1);
    }
    assert_true(host_summary(other).time > host_summary(solver).time);
    ilsa_solver_destroy(&solver);
    ilsa_solver_destroy(&other);
}

static int mirrors(const ilsa_solver *solver, const double *field) {
    int nx = solver->model.mesh.nx, ny = solver->model.mesh.ny, same = 1;
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            double here = field[j * nx + i];
            same &= here == field[j * nx + nx - 1 - i] && here == field[(ny - 1 - j) * nx + i];
        }
    return same;
}

static void symmetric_states_stay_symmetric(void **unused) {
    (void)unused;
    for (int n = 0; n < 4; n++) {
        host_scene scene = host_penny(1, 50 + n % 2, 0.05);
        scene.mesh.ny = 50 + n / 2;
        ilsa_solver *solver = host_started(&scene, 0.6);
        host_steps(solver, 6);
        coarsen(solver);
        for (int k = 0; k < 3; k++) {
            ilsa_model used;
            assert_int_equal(ilsa_get_model(solver, &used), ILSA_OK);
            assert_int_equal(used.symmetry, ILSA_SYMMETRY_XY);
            assert_true(mirrors(solver, solver->fracture.cells.width));
            assert_true(mirrors(solver, solver->fracture.cells.level));
            assert_true(mirrors(solver, solver->fracture.cells.speed));
            assert_true(mirrors(solver, solver->fracture.cells.trigger));
            assert_true(mirrors(solver, solver->fracture.cells.leaked));
            host_steps(solver, 1);
        }
        ilsa_solver_destroy(&solver);
    }
}

/* Along one direction */

static void coarsen_along(ilsa_solver *solver, int directions) {
    assert_int_equal(ilsa_coarsen_along(solver, directions), ILSA_OK);
}

/* Cells become longer along the direction asked for alone, and what was in them stays. */
static void one_direction_is_coarsened_alone(void **unused) {
    (void)unused;
    double worst = NOTHING_YET;
    for (int which = 0; which < SCENES; which++)
        for (int direction = ILSA_ALONG_X; direction <= ILSA_ALONG_Y; direction++) {
            host_scene scene = scene_of(which);
            ilsa_solver *solver = host_started(&scene, 0.9);
            host_steps(solver, 4);
            ilsa_summary before = host_summary(solver);
            double width = sum(solver, solver->fracture.cells.width);
            double leaked = sum(solver, solver->fracture.cells.leaked);
            coarsen_along(solver, direction);
            ilsa_mesh_def mesh;
            assert_int_equal(ilsa_get_mesh_def(solver, &mesh), ILSA_OK);
            assert_true(mesh.nx == scene.mesh.nx && mesh.ny == scene.mesh.ny);
            assert_true(mesh.dx == scene.mesh.dx * (direction == ILSA_ALONG_X ? 2 : 1));
            assert_true(mesh.dy == scene.mesh.dy * (direction == ILSA_ALONG_Y ? 2 : 1));
            worst = worst_of(worst, fabs(sum(solver, solver->fracture.cells.width) / width - 1));
            if (leaked > 0)
                worst =
                    worst_of(worst, fabs(sum(solver, solver->fracture.cells.leaked) / leaked - 1));
            ilsa_summary now = host_summary(solver);
            assert_true(now.volume_fracture == before.volume_fracture && now.time == before.time);
            assert_true(fabs(now.extent_x_max / before.extent_x_max - 1) < 0.01);
            assert_true(fabs(now.extent_y_max / before.extent_y_max - 1) < 0.01);
            host_steps(solver, 2);
            assert_true(fabs(host_imbalance(solver)) <= 1e-12);
            ilsa_solver_destroy(&solver);
        }
    print_message("coarsen: along one direction: volumes off by %.1e\n", worst);
    assert_below(worst, 1e-14);
}

/* Levels, trigger times and their spread: against a penny laid on the oblong cells at once. */
static void one_direction_finds_the_front(void **unused) {
    (void)unused;
    for (int n = 0; n < 4; n++) {
        int along_x = n % 2 == 0;
        pair p = {.scene = host_penny(1, 40 + n / 2, 0.05)};
        p.coarsened = host_started(&p.scene, 0.8);
        coarsen_along(p.coarsened, along_x ? ILSA_ALONG_X : ILSA_ALONG_Y);
        *(along_x ? &p.scene.mesh.dx : &p.scene.mesh.dy) *= 2;
        p.direct = host_started(&p.scene, 0.8);
        const fields *a = &p.coarsened->fracture.cells, *b = &p.direct->fracture.cells;
        double level = NOTHING_YET, spread = NOTHING_YET, trigger = NOTHING_YET;
        double time = host_summary(p.direct).time, h = 0.05;
        int passed = 0;
        for (int k = 0; k < p.scene.mesh.nx * p.scene.mesh.ny; k++) {
            if (fabs(b->level[k]) < 3 * h)
                level = worst_of(level, fabs(a->level[k] - b->level[k]) / h);
            if (a->kind[k] < ILSA_CELL_SURVEY || b->kind[k] < ILSA_CELL_SURVEY)
                continue;
            double r = hypot(ilsai_mesh_x(&p.scene.mesh, k % p.scene.mesh.nx),
                             ilsai_mesh_y(&p.scene.mesh, k / p.scene.mesh.nx));
            trigger = worst_of(trigger, fabs(a->trigger[k] - b->trigger[k]) / time);
            if (r > 0.2) { /* further in the fracture passed a cell in a time like its age */
                spread = worst_of(spread, fabs(a->spread[k] / b->spread[k] - 1));
                passed++;
            }
        }
        print_message("coarsen: along %s: levels off by %.3f cells, trigger times by %.1e of the "
                      "time, spreads by %.2f\n",
                      along_x ? "x" : "y", level, trigger, spread);
        assert_true(passed > 150);
        assert_below(level, 0.1);
        assert_below(trigger, 0.02);
        assert_below(spread, 0.3);
        release(&p);
    }
}

/* A penny grows on as it would on square cells, on cells of 2 to 1 and of 1 to 2. */
static void one_direction_goes_on(void **unused) {
    (void)unused;
    csv_table *table = csv_read("tests/data/radial_history.csv");
    for (int n = 0; n < 4; n++) {
        double phi = n < 2 ? 1e-2 : 1;
        host_scene scene = host_penny(phi, 71, 0.04);
        ilsa_solver *solver = host_started(&scene, 0.6);
        while (host_summary(solver).extent_x_max < 1)
            host_steps(solver, 1);
        coarsen_along(solver, n % 2 ? ILSA_ALONG_X : ILSA_ALONG_Y);
        while (host_summary(solver).extent_x_max < 1.2)
            host_steps(solver, 1);
        ilsa_summary now = host_summary(solver);
        double R = interpolate(table, phi, now.time, "R");
        double efficiency = interpolate(table, phi, now.time, "efficiency");
        print_message("coarsen: one direction, phi %g: R off by %.2f %% and %.2f %%\n", phi,
                      100 * (now.extent_x_max / R - 1), 100 * (now.extent_y_max / R - 1));
        assert_true(fabs(now.extent_x_max / R - 1) < 0.01);
        assert_true(fabs(now.extent_y_max / R - 1) < 0.01);
        assert_true(fabs(now.efficiency - efficiency) < 0.01);
        ilsa_solver_destroy(&solver);
    }
    csv_free(table);
}

static void symmetric_states_stay_symmetric_along_one(void **unused) {
    (void)unused;
    for (int n = 0; n < 4; n++) {
        host_scene scene = host_penny(1, 50 + n % 2, 0.05);
        ilsa_solver *solver = host_started(&scene, 0.6);
        host_steps(solver, 6);
        coarsen_along(solver, n / 2 ? ILSA_ALONG_X : ILSA_ALONG_Y);
        for (int k = 0; k < 3; k++) {
            ilsa_model used;
            assert_int_equal(ilsa_get_model(solver, &used), ILSA_OK);
            assert_int_equal(used.symmetry, ILSA_SYMMETRY_XY);
            assert_true(mirrors(solver, solver->fracture.cells.width));
            assert_true(mirrors(solver, solver->fracture.cells.trigger));
            assert_true(mirrors(solver, solver->fracture.cells.spread));
            host_steps(solver, 1);
        }
        ilsa_solver_destroy(&solver);
    }
}

/* Refused */

static void bad_calls_are_refused(void **unused) {
    (void)unused;
    host_scene scene = host_penny(1, 41, 0.1);
    assert_int_equal(ilsa_coarsen(NULL), ILSA_ERR_NULL);
    check_message(ilsa_last_error(NULL), "solver");
    ilsa_solver *solver = host_solver(&scene);
    assert_int_equal(ilsa_coarsen(solver), ILSA_ERR_STATE);
    check_message(ilsa_last_error(solver), "ilsa_start_radial");
    ilsa_mesh_def mesh;
    assert_int_equal(ilsa_get_mesh_def(solver, &mesh), ILSA_OK);
    assert_true(mesh.dx == 0.1);
    assert_int_equal(ilsa_start_radial(solver, 0.28), ILSA_OK);
    host_image before = host_save(solver);
    assert_int_equal(ilsa_coarsen(solver), ILSA_ERR_VALUE);
    check_message(ilsa_last_error(solver), "cells across");
    assert_true(host_is(solver, &before));
    while (host_summary(solver).x_max < 0.5)
        host_steps(solver, 1);
    coarsen(solver);
    host_free(&before);
    before = host_save(solver);
    assert_int_equal(ilsa_coarsen(solver), ILSA_ERR_VALUE);
    assert_true(host_is(solver, &before));
    host_free(&before);
    ilsa_solver_destroy(&solver);
}

static void directions_that_are_none_are_refused(void **unused) {
    (void)unused;
    static const int none[] = {0, -1, 4, 7};
    host_scene scene = host_penny(1, 41, 0.1);
    ilsa_solver *solver = host_solver(&scene);
    assert_int_equal(ilsa_coarsen_along(NULL, ILSA_ALONG_X), ILSA_ERR_NULL);
    assert_int_equal(ilsa_coarsen_along(solver, ILSA_ALONG_X), ILSA_ERR_STATE);
    assert_int_equal(ilsa_start_radial(solver, 0.9), ILSA_OK);
    host_image before = host_save(solver);
    for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
        assert_int_equal(ilsa_coarsen_along(solver, none[k]), ILSA_ERR_VALUE);
        check_message(ilsa_last_error(solver), "directions = ");
        assert_true(host_is(solver, &before));
    }
    coarsen_along(solver, ILSA_ALONG_X);
    host_free(&before);
    before = host_save(solver);
    /* Along x there are 10 cells, then 6. */
    while (ilsa_coarsen_along(solver, ILSA_ALONG_X) == ILSA_OK) {
        host_free(&before);
        before = host_save(solver);
    }
    check_message(ilsa_last_error(solver), "cells across");
    assert_true(host_is(solver, &before));
    host_free(&before);
    ilsa_solver_destroy(&solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volumes_are_kept),
        cmocka_unit_test(the_mesh_is_twice_as_coarse),
        cmocka_unit_test(stress_follows),
        cmocka_unit_test(levels_are_interpolated),
        cmocka_unit_test(trigger_times_are_interpolated),
        cmocka_unit_test(velocity_histories_are_kept),
        cmocka_unit_test(velocities_are_kept),
        cmocka_unit_test(channels_stay_channels),
        cmocka_unit_test(growth_goes_on),
        cmocka_unit_test(advance_coarsens_only_if_told),
        cmocka_unit_test(symmetric_states_stay_symmetric),
        cmocka_unit_test(one_direction_is_coarsened_alone),
        cmocka_unit_test(one_direction_finds_the_front),
        cmocka_unit_test(one_direction_goes_on),
        cmocka_unit_test(symmetric_states_stay_symmetric_along_one),
        cmocka_unit_test(bad_calls_are_refused),
        cmocka_unit_test(directions_that_are_none_are_refused),
    };
    return cmocka_run_group_tests_name("coarsen", tests, NULL, NULL);
}
