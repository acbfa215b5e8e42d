#include "field.h"

#include "../../examples/ilsa_run/model.h"
#include "../../examples/ilsa_run/stress_log.h"
#include "../common_worst.h"

#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* ---- One run -------------------------------------------------------------------------------- */

static void wrong(field_result *r, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void wrong(field_result *r, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(r->what, sizeof r->what, format, arguments);
    va_end(arguments);
    r->verdict = FIELD_WRONG;
}

static double cpu_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The middle of the mesh stays in the middle of a cell, or on an edge between two. */
static int halved(int n) {
    return 2 * n + n % 2;
}

static void change(const field_case *run, scene *sc) {
    unsigned long long seed = 1;
    for (int k = 0; k < run->finer; k++) {
        sc->mesh.nx = halved(sc->mesh.nx);
        sc->mesh.ny = halved(sc->mesh.ny);
        sc->mesh.dx *= 0.5;
        sc->mesh.dy *= 0.5;
    }
    for (int k = 0; k <= sc->interface_count; k++) {
        seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
        sc->sigma[k] *= 1 + run->stress_noise * ((double)(seed >> 33) * 0x1p-30 - 1);
    }
    sc->radius *= 1 + run->radius_part;
    sc->time *= 1 + run->radius_part;
    sc->mesh.dx *= 1 + run->cell_part;
    sc->mesh.dy *= 1 + run->cell_part;
    if (run->level)
        sc->options.level = run->level;
}

/* The worst of a step: its balance, pressures, widths. */
static void judge(field_result *r, const ilsa_solver *solver) {
    const double *width, *pressure;
    const unsigned char *kind;
    ilsa_mesh_def m;
    const ilsa_summary *s = &r->end;
    if (ilsa_get_summary(solver, &r->end) || ilsa_get_mesh_def(solver, &m) ||
        ilsa_get_width(solver, &width) || ilsa_get_pressure(solver, &pressure) ||
        ilsa_get_cell_kinds(solver, &kind)) {
        wrong(r, "nothing can be read");
        return;
    }
    for (int k = 0; k < m.nx * m.ny && r->verdict != FIELD_WRONG; k++) {
        if (kind[k] == ILSA_CELL_EMPTY)
            continue;
        r->least_pressure = smaller_of(r->least_pressure, pressure[k]);
        r->most_pressure = larger_of(r->most_pressure, pressure[k]);
        if (!(width[k] >= 0))
            wrong(r, "width %g m in cell (%d, %d)", width[k], k % m.nx, k / m.nx);
        if (!(fabs(pressure[k]) <= FIELD_PRESSURE))
            wrong(r, "pressure %g Pa in cell (%d, %d) at t = %g", pressure[k], k % m.nx, k / m.nx,
                  s->time);
    }
    double balance =
        fabs(s->volume_injected - s->volume_fracture - s->volume_leaked) / s->volume_injected;
    r->balance = larger_of(r->balance, balance);
    if (!(balance <= FIELD_BALANCE))
        wrong(r, "volumes %g off balance at t = %g", balance, s->time);
}

/* Net pressure at the source and cells across its layer, or across the wet part of it. */
static void measure_end(field_result *r, const scene *sc, const ilsa_solver *solver) {
    const double *stress;
    ilsa_mesh_def m;
    if (ilsa_get_mesh_def(solver, &m) || ilsa_get_stress(solver, &stress))
        return;
    double y = sc->sources[0].y, bottom = r->end.extent_y_min, top = r->end.extent_y_max;
    for (int k = 0; k < sc->interface_count; k++) {
        if (sc->interfaces[k] <= y)
            bottom = fmax(bottom, sc->interfaces[k]);
        else
            top = fmin(top, sc->interfaces[k]);
    }
    int i = (int)floor(sc->sources[0].x / m.dx + 0.5 * m.nx);
    int j = (int)floor(y / m.dy + 0.5 * m.ny);
    r->dx = m.dx;
    r->dy = m.dy;
    r->across = (top - bottom) / m.dy;
    r->net_pressure = r->end.pressure_source - stress[j * m.nx + i];
}

static ilsa_status step(const scene *sc, ilsa_solver *solver, double t) {
    double limit = fmin(sc->t_end, scene_next_change(sc, t));
    ilsa_status status = ilsa_advance_one(solver, limit, NULL);
    if (status == ILSA_CLOSED)
        status = ilsa_wait(solver, limit);
    double now;
    if (!status)
        status = ilsa_get_time(solver, &now);
    return status ? status : model_set_rates(sc, solver, now);
}

static void run_solver(const field_case *run, const scene *sc, ilsa_solver *solver,
                       field_result *r) {
    double limit = run->seconds > 0 ? run->seconds : FIELD_SECONDS;
    ilsa_status status = ILSA_OK;
    judge(r, solver);
    while (!status && r->verdict != FIELD_WRONG && r->end.time < sc->t_end) {
        status = step(sc, solver, r->end.time);
        if (!status)
            judge(r, solver);
        if (cpu_seconds() > limit && r->end.time < sc->t_end)
            wrong(r, "over %g CPU s at t = %g of %g", limit, r->end.time, sc->t_end);
    }
    ilsa_get_summary(solver, &r->end);
    if (status == ILSA_MESH_EDGE && !sc->options.coarsen)
        r->verdict = FIELD_EDGE;
    else if (status)
        wrong(r, "t = %g of %g: %s", r->end.time, sc->t_end, ilsa_last_error(solver));
    measure_end(r, sc, solver);
}

static void run_one(const field_case *run, field_result *r) {
    scene sc;
    ilsa_solver *solver = NULL;
    *r = (field_result){.least_pressure = INFINITY, .most_pressure = -INFINITY};
    if (!scene_read(run->file, &sc, stderr)) {
        wrong(r, "the scene is refused");
        return;
    }
    change(run, &sc);
    if (!stress_log_take(&sc, stderr) || model_start(&sc, &solver) != EXIT_DONE)
        wrong(r, "the scene is refused");
    else
        run_solver(run, &sc, solver, r);
    r->seconds = cpu_seconds();
    ilsa_solver_destroy(&solver);
    scene_free(&sc);
}

/* ---- Many runs ------------------------------------------------------------------------------ */

/* A process at work, and the end of the pipe that its result comes through. */
typedef struct worker {
    pid_t process;
    int result, run;
} worker;

enum { MOST_WORKERS = 64 };

static void work(const field_case *run, int result) {
    field_result r;
    double limit = run->seconds > 0 ? run->seconds : FIELD_SECONDS;
    struct rlimit cpu = {(rlim_t)(2 * limit + 1), (rlim_t)(2 * limit + 2)};
    setrlimit(RLIMIT_CPU, &cpu); /* for a step that does not end */
    run_one(run, &r);
    _exit(write(result, &r, sizeof r) == (ssize_t)sizeof r ? 0 : 1);
}

static int start(const field_case *runs, int run, worker *w) {
    int ends[2];
    if (pipe(ends))
        return 0;
    w->run = run;
    w->result = ends[0];
    fflush(NULL);
    w->process = fork();
    if (w->process == 0) {
        close(ends[0]);
        work(&runs[run], ends[1]);
    }
    close(ends[1]);
    if (w->process < 0)
        close(ends[0]);
    return w->process > 0;
}

static void finish(const worker *w, field_result *r) {
    int status = 0;
    if (read(w->result, r, sizeof *r) != (ssize_t)sizeof *r) {
        memset(r, 0, sizeof *r);
        wrong(r, "no result");
    }
    close(w->result);
    waitpid(w->process, &status, 0);
    if (WIFSIGNALED(status))
        wrong(r, "ended by signal %d", WTERMSIG(status));
}

void field_run(const field_case *runs, field_result *results, int count, field_shown *shown,
               void *user) {
    worker workers[MOST_WORKERS];
    struct pollfd waited[MOST_WORKERS];
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    int most = (int)fmax(fmin((double)processors, MOST_WORKERS), 1);
    for (int next = 0, busy = 0; next < count || busy > 0;) {
        if (next < count && busy < most) {
            if (start(runs, next, &workers[busy])) {
                busy++;
            } else {
                wrong(&results[next], "no process");
            }
            next++;
            continue;
        }
        for (int k = 0; k < busy; k++)
            waited[k] = (struct pollfd){.fd = workers[k].result, .events = POLLIN};
        poll(waited, (nfds_t)busy, -1);
        for (int k = busy - 1; k >= 0; k--) {
            if (!waited[k].revents)
                continue;
            worker w = workers[k];
            workers[k] = workers[--busy];
            finish(&w, &results[w.run]);
            if (shown)
                shown(&runs[w.run], &results[w.run], user);
        }
    }
}
