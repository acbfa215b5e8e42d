#include "common_extremes.h"
#include "common_worst.h"

#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { MOST_ATTEMPTS = 8000, SECONDS = 300, SECONDS_HUNG = 1000 };
static const double balance_allowed = 1e-9, radius_allowed = 0.02;

/* CPU time: a busy machine makes no case hang. */
static double clock_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ---- Verdicts ----------------------------------------------------------------------------- */

int extreme_running(const extreme_trial *t) {
    return t->solver && t->result->verdict == EXTREME_RIGHT;
}

static void end(extreme_trial *t, extreme_verdict verdict, const char *format, va_list arguments) {
    if (t->result->verdict == EXTREME_RIGHT) {
        t->result->verdict = verdict;
        vsnprintf(t->result->what, sizeof t->result->what, format, arguments);
    }
}

void extreme_fail(extreme_trial *t, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    end(t, EXTREME_FAILED, format, arguments);
    va_end(arguments);
}

static void refuse(extreme_trial *t, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    end(t, EXTREME_REFUSED, format, arguments);
    va_end(arguments);
}

/* A status that ends the trial: clear only with a message. */
static void stopped(extreme_trial *t, ilsa_status status, const char *message) {
    if (message[0] == '\0')
        extreme_fail(t, "status %d without a message", status);
    refuse(t, "%s: %s", ilsa_status_text(status), message);
}

/* ---- What must hold after every step ------------------------------------------------------ */

static void check_fields(extreme_trial *t) {
    const double *width, *pressure;
    const unsigned char *kind;
    ilsa_mesh_def m;
    if (ilsa_get_mesh_def(t->solver, &m) || ilsa_get_width(t->solver, &width) ||
        ilsa_get_pressure(t->solver, &pressure) || ilsa_get_cell_kinds(t->solver, &kind)) {
        extreme_fail(t, "no fields: %s", ilsa_last_error(NULL));
        return;
    }
    for (int n = 0; n < m.nx * m.ny; n++) {
        if (!(width[n] >= 0 && isfinite(width[n])))
            extreme_fail(t, "width %g in a cell", width[n]);
        if (!isfinite(pressure[n]))
            extreme_fail(t, "pressure %g in a cell", pressure[n]);
        if (kind[n] == ILSA_CELL_EMPTY && width[n] > 0)
            extreme_fail(t, "width %g outside the footprint", width[n]);
    }
}

static void check_summary(extreme_trial *t) {
    ilsa_summary s;
    if (ilsa_get_summary(t->solver, &s) != ILSA_OK) {
        extreme_fail(t, "no summary: %s", ilsa_last_error(NULL));
        return;
    }
    const double balance = (s.volume_fracture + s.volume_leaked) / s.volume_injected - 1;
    const double numbers[] = {s.x_min,        s.x_max,        s.y_min,           s.y_max,
                              s.extent_x_min, s.extent_x_max, s.extent_y_min,    s.extent_y_max,
                              s.width_source, s.V_max,        s.pressure_source, s.efficiency};
    if (!(fabs(balance) <= balance_allowed))
        extreme_fail(t, "volume balance %.2g at time %g", balance, s.time);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (!isfinite(numbers[k]))
            extreme_fail(t, "number %zu of the summary is %g", k, numbers[k]);
    if (!(s.volume_fracture > 0) || !(s.volume_leaked >= 0))
        extreme_fail(t, "volume %g, leaked %g", s.volume_fracture, s.volume_leaked);
}

static int is_mirrored_x(const extreme_scene *scene) {
    return scene->x == 0 && scene->interfaces == 0 && !scene->stress;
}

/* A uniform scene's footprint is as far to the left as to the right, and no further up than down.
 */
static void check_shape(extreme_trial *t) {
    ilsa_summary s;
    const ilsa_front_point *p;
    size_t count;
    if (ilsa_get_summary(t->solver, &s) || ilsa_get_front(t->solver, &p, &count)) {
        extreme_fail(t, "no front: %s", ilsa_last_error(t->solver));
        return;
    }
    for (size_t i = 0; i < count; i++)
        if (!isfinite(p[i].x) || !isfinite(p[i].y) || !(p[i].V >= 0))
            extreme_fail(t, "point of the front (%g, %g), V %g", p[i].x, p[i].y, p[i].V);
    const double lean = (s.extent_x_max + s.extent_x_min) / t->cell;
    if (is_mirrored_x(&t->scene) && !(fabs(lean) < 0.05))
        extreme_fail(t, "leans by %g cells", lean);
}

/* ---- Steps -------------------------------------------------------------------------------- */

/* The state's image, to compare with after a refusal. */
static void keep(extreme_trial *t, void **image, size_t *size) {
    size_t room = 0;
    if (ilsa_snapshot_save(t->solver, NULL, &room) != ILSA_OK) {
        extreme_fail(t, "no image: %s", ilsa_last_error(NULL));
        return;
    }
    void *larger = realloc(*image, room);
    *image = larger ? larger : *image;
    *size = room;
    if (!larger || ilsa_snapshot_save(t->solver, *image, size) != ILSA_OK)
        extreme_fail(t, "no image");
}

static void check_unaltered(extreme_trial *t) {
    void *image = NULL;
    size_t size = 0;
    keep(t, &image, &size);
    if (extreme_running(t) &&
        (!image || size != t->image_size || memcmp(image, t->image, size) != 0))
        extreme_fail(t, "the state was altered by a refused step");
    free(image);
}

static void count_attempts(extreme_trial *t, const ilsa_report *report) {
    t->result->steps += report->steps;
    t->result->refused += report->rejected;
    if (t->result->steps + t->result->refused > MOST_ATTEMPTS)
        extreme_fail(t, "more than %d attempts, at time %g", MOST_ATTEMPTS, report->time);
    if (clock_now() > t->deadline)
        extreme_fail(t, "more than %d s, at time %g, after %ld steps and %ld refused ones", SECONDS,
                     report->time, t->result->steps, t->result->refused);
}

static void check_step(extreme_trial *t, const ilsa_report *report) {
    count_attempts(t, report);
    if (t->status == ILSA_OK) {
        check_fields(t);
        check_summary(t);
    } else {
        check_unaltered(t);
        if (ilsa_last_error(t->solver)[0] == '\0')
            extreme_fail(t, "status %d without a message", t->status);
    }
}

double extreme_time(const extreme_trial *t) {
    double now = NAN;
    (void)ilsa_get_time(t->solver, &now);
    return now;
}

void extreme_go(extreme_trial *t, double time) {
    while (extreme_running(t) && t->status == ILSA_OK && extreme_time(t) < time) {
        ilsa_report report;
        keep(t, &t->image, &t->image_size);
        t->status = ilsa_advance_one(t->solver, time, &report);
        check_step(t, &report);
        if (t->status == ILSA_CLOSED)
            t->status =
                ilsa_wait(t->solver, time); /* an end as good as any; refused if it is none */
    }
    if (t->status == ILSA_MESH_EDGE && t->scene.to_edge)
        return;
    if (t->status != ILSA_OK)
        stopped(t, t->status, ilsa_last_error(t->solver));
}

ilsa_status extreme_step(extreme_trial *t, double dt) {
    ilsa_report report;
    if (!extreme_running(t))
        return ILSA_ERR_STATE;
    keep(t, &t->image, &t->image_size);
    const ilsa_status status = t->status = ilsa_step(t->solver, dt, &report);
    check_step(t, &report);
    t->status = ILSA_OK;
    return status;
}

void extreme_set_rate(extreme_trial *t, double rate) {
    if (extreme_running(t) && ilsa_set_rate(t->solver, 0, rate) != ILSA_OK)
        extreme_fail(t, "rate %g: %s", rate, ilsa_last_error(t->solver));
}

/* The reference has no solution without viscosity, but one for any that is not felt. */
static penny_law reference_law(penny_law law) {
    const double unfelt = 1e-9;
    law.mu_prime = law.mu_prime > 0 ? law.mu_prime : unfelt * pow(law.K_prime, 4);
    return law;
}

void extreme_check_radius(extreme_trial *t) {
    if (!extreme_running(t))
        return;
    const double found = radial_measure(t->solver).mean;
    const double R = radial_reference(reference_law(t->scene.law), extreme_time(t)).R;
    t->result->error_R = found / R - 1;
    if (!(fabs(t->result->error_R) <= radius_allowed))
        extreme_fail(t, "radius off by %+.2f %%", 100 * t->result->error_R);
}

/* ---- Making a scene ----------------------------------------------------------------------- */

static ilsa_mesh_def mesh_of(const extreme_trial *t) {
    const extreme_scene *s = &t->scene;
    const double dx = s->aspect < 1 ? t->cell * s->aspect : t->cell, dy = dx / s->aspect;
    return (ilsa_mesh_def){2 * (int)ceil(s->room * t->cell / dx) + 1,
                           2 * (int)ceil(s->room * t->cell / dy) + 1, dx, dy};
}

static ilsa_status set_cells(const extreme_trial *t, const ilsa_mesh *mesh, ilsa_stress *stress) {
    const ilsa_mesh_def m = mesh_of(t);
    double *sigma = malloc((size_t)m.nx * (size_t)m.ny * sizeof *sigma);
    for (int n = 0; sigma && n < m.nx * m.ny; n++) {
        const int i = n % m.nx, j = n / m.nx;
        const double x = (i - 0.5 * (m.nx - 1)) * m.dx / t->cell;
        const double y = (j - 0.5 * (m.ny - 1)) * m.dy / t->cell;
        sigma[n] = t->unit * t->scene.scale * t->scene.stress(x, y);
    }
    const ilsa_status status = sigma ? ilsa_stress_set_cells(stress, mesh, sigma) : ILSA_ERR_MEMORY;
    free(sigma);
    return status;
}

static ilsa_status set_stress(const extreme_trial *t, const ilsa_mesh *mesh, ilsa_stress *stress) {
    const extreme_scene *s = &t->scene;
    double y[EXTREME_INTERFACES], sigma[EXTREME_INTERFACES + 1];
    if (s->stress)
        return set_cells(t, mesh, stress);
    for (int k = 0; k <= s->interfaces; k++) {
        sigma[k] = s->sigma[k] * t->unit;
        if (k < s->interfaces)
            y[k] = s->interface_y[k] * t->cell;
    }
    return s->interfaces ? ilsa_stress_set_layers(stress, s->interfaces, y, sigma) : ILSA_OK;
}

static ilsa_status create(extreme_trial *t) {
    const extreme_scene *s = &t->scene;
    const ilsa_material_def scaled = {1, s->law.mu_prime, s->law.K_prime, s->law.C_prime};
    const ilsa_source_def well = {s->x * t->cell, s->y * t->cell, 1};
    const ilsa_stress_def zero = ilsa_stress_def_default();
    const ilsa_mesh_def grid = mesh_of(t);
    ilsa_solver_def d = ilsa_solver_def_default();
    ilsa_mesh *mesh = NULL;
    ilsa_material *material = NULL;
    ilsa_stress *stress = NULL;
    ilsa_status status = ilsa_mesh_create(&grid, &mesh);
    status = status ? status : ilsa_material_create(&scaled, &material);
    status = status ? status : ilsa_stress_create(&zero, &stress);
    status = status ? status : set_stress(t, mesh, stress);
    d.mesh = mesh;
    d.material = material;
    d.stress = stress;
    d.sources = &well;
    d.source_count = 1;
    d.symmetry = s->whole ? ILSA_SYMMETRY_NONE : ILSA_SYMMETRY_AUTO;
    d.coarsen = s->coarsen;
    status = status ? status : ilsa_solver_create(&d, &t->solver);
    ilsa_mesh_destroy(&mesh);
    ilsa_material_destroy(&material);
    ilsa_stress_destroy(&stress);
    return status;
}

/* Lengths and stresses of the scene, the solver, and the penny in it. */
static void start(extreme_trial *t) {
    const extreme_scene *s = &t->scene;
    const penny_law law = reference_law(s->law);
    t->cell = radial_reference(law, s->end).R / s->last;
    t->start = radial_time_of(law, s->first * t->cell);
    t->unit = radial_reference(law, t->start).pressure_half;
    t->status = create(t);
    if (t->status != ILSA_OK)
        stopped(t, t->status, ilsa_last_error(NULL));
    t->status = t->status ? t->status : ilsa_start_radial(t->solver, s->first * t->cell);
    if (t->status != ILSA_OK && t->solver)
        stopped(t, t->status, ilsa_last_error(t->solver));
}

static void run(extreme_result *result, const extreme_scene *scene, extreme_script *script,
                double parameter) {
    const double began = clock_now();
    extreme_trial t = {
        .scene = *scene, .parameter = parameter, .result = result, .deadline = began + SECONDS};
    start(&t);
    if (extreme_running(&t))
        check_fields(&t);
    if (extreme_running(&t))
        script(&t);
    if (extreme_running(&t))
        check_shape(&t);
    result->seconds = clock_now() - began;
    ilsa_solver_destroy(&t.solver);
    free(t.image);
}

/* ---- A process for each case -------------------------------------------------------------- */

static void read_result(int from, pid_t child, extreme_result *result) {
    int state = 0;
    const ssize_t got = read(from, result, sizeof *result);
    waitpid(child, &state, 0);
    if (got == (ssize_t)sizeof *result && WIFEXITED(state) && WEXITSTATUS(state) == 0)
        return;
    *result = (extreme_result){.verdict = EXTREME_FAILED};
    if (WIFSIGNALED(state) && WTERMSIG(state) == SIGALRM)
        snprintf(result->what, sizeof result->what, "hung: no answer within %d s", SECONDS_HUNG);
    else
        snprintf(result->what, sizeof result->what, "crashed: %s %d",
                 WIFSIGNALED(state) ? "signal" : "exit status",
                 WIFSIGNALED(state) ? WTERMSIG(state) : WEXITSTATUS(state));
}

static void run_apart(extreme_result *result, const extreme_scene *scene, extreme_script *script,
                      double parameter) {
    int ends[2];
    fflush(NULL);
    if (pipe(ends) != 0) {
        perror("pipe");
        exit(EXIT_FAILURE);
    }
    const pid_t child = fork();
    if (child == 0) {
        extreme_result own = {0};
        close(ends[0]);
        alarm(SECONDS_HUNG);
        run(&own, scene, script, parameter);
        exit(write(ends[1], &own, sizeof own) == (ssize_t)sizeof own ? 0 : 1);
    }
    close(ends[1]);
    if (child < 0) {
        perror("fork");
        exit(EXIT_FAILURE);
    }
    read_result(ends[0], child, result);
    close(ends[0]);
}

void extreme_case(extreme_sweep *sweep, const extreme_scene *scene, extreme_script *script,
                  double parameter, const char *format, ...) {
    char name[120];
    va_list arguments;
    extreme_result result = {0};
    if (sweep->offered++ % sweep->stride != 0)
        return;
    va_start(arguments, format);
    vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    run_apart(&result, scene, script, parameter);
    sweep->cases++;
    sweep->count[result.verdict]++;
    sweep->seconds += result.seconds;
    sweep->worst_R = larger_of(sweep->worst_R, fabs(result.error_R));
    if (sweep->shown)
        sweep->shown(sweep, name, &result);
}

extreme_sweep extreme_sweep_over(const extreme_kind *kind, int stride,
                                 void (*shown)(const extreme_sweep *, const char *,
                                               const extreme_result *)) {
    extreme_sweep sweep = {.kind = kind, .stride = stride, .shown = shown};
    kind->cases(&sweep);
    return sweep;
}
