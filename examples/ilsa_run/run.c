#include "run.h"

#include "history.h"
#include "model.h"
#include "outputs.h"
#include "progress.h"
#include "reason.h"
#include "summary.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static volatile sig_atomic_t caught;

static void catch_signal(int number) {
    caught = number;
}

/*
 * A second signal ends the program at once. A full file, and output that nobody reads, must be
 * errors, not signals.
 */
static void catch_signals(void) {
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = catch_signal;
    action.sa_flags = (int)SA_RESETHAND;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
}

typedef struct run {
    const scene *sc;
    const char *directory;
    ilsa_solver *solver;
    outfile history;
    outputs out;
    progress bar;
    struct timespec began;
    double t;
    long steps;
    int next_output;    /* of the scene's output times */
    int unsaved;        /* steps since the last output */
    int writing_failed; /* stderr has said so */
    ilsa_report last;   /* of the last advance */
} run;

static double wall_seconds(const run *r) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)(now.tv_sec - r->began.tv_sec) + 1e-9 * (double)(now.tv_nsec - r->began.tv_nsec);
}

/* Up to where the next step may go. */
static double step_limit(const run *r) {
    const scene *sc = r->sc;
    double limit = fmin(sc->t_end, scene_next_change(sc, r->t));
    if (r->next_output < sc->output_count)
        limit = fmin(limit, sc->output_times[r->next_output]);
    if (r->steps == 0 && sc->dt_initial > 0)
        limit = fmin(limit, r->t + sc->dt_initial);
    return limit;
}

static void save(run *r) {
    progress_end(&r->bar);
    if (!outputs_write(&r->out, r->directory, r->sc, r->solver))
        r->writing_failed = 1;
    r->unsaved = 0;
}

static ilsa_status take_step(run *r) {
    ilsa_summary now;
    ilsa_status status = ilsa_advance_one(r->solver, step_limit(r), &r->last);
    if (status == ILSA_CLOSED)
        status = ilsa_wait(r->solver, step_limit(r));
    if (!status)
        status = ilsa_get_summary(r->solver, &now);
    if (status)
        return status;
    r->t = now.time;
    r->steps++;
    r->unsaved = 1;
    if (!history_row(&r->history, &now, &r->last, wall_seconds(r)))
        r->writing_failed = 1;
    progress_show(&r->bar, r->t, r->steps, wall_seconds(r));
    if (r->next_output < r->sc->output_count && r->t >= r->sc->output_times[r->next_output]) {
        r->next_output++;
        save(r);
    }
    return model_set_rates(r->sc, r->solver, r->t);
}

/* How the run ended, in words. */
static void put_ending(const run *r, ilsa_status status, char *text, size_t size) {
    if (r->writing_failed)
        snprintf(text, size, "failed at t = %.10g: a result file could not be written", r->t);
    else if (status == ILSA_ERR_STATE)
        snprintf(text, size, "failed at t = %.10g of %.10g: a source injects outside the fracture",
                 r->t, r->sc->t_end);
    else if (status)
        snprintf(text, size, "failed at t = %.10g of %.10g: %s: %s", r->t, r->sc->t_end,
                 ilsa_status_text(status), ilsa_last_error(r->solver));
    else if (r->t < r->sc->t_end)
        snprintf(text, size, "stopped by %s at t = %.10g of %.10g",
                 caught == SIGINT ? "Ctrl-C" : "SIGTERM", r->t, r->sc->t_end);
    else
        snprintf(text, size, "done");
}

/* What the scene has to do with it, in lines of their own; to be freed. NULL: there is nothing. */
static char *find_reason(const run *r, ilsa_status status) {
    char *reason = NULL;
    size_t size = 0;
    FILE *text = status ? open_memstream(&reason, &size) : NULL;
    if (!text)
        return NULL;
    reason_write(r->sc, r->solver, status, &r->last, text);
    fclose(text);
    return reason;
}

/* The closing line; 0 with a message if it cannot be written. */
static int put_done(const run *r) {
    printf("t = %.10g in %ld steps and %.1f s; results in %s\n", r->t, r->steps, wall_seconds(r),
           r->directory);
    return output_written();
}

/* Says how the run ended on the terminal, unless all is well and quiet; the exit status. */
static int conclude(const run *r, ilsa_status status, int quiet, const char *ended,
                    const char *reason) {
    int done = !r->writing_failed && !status && r->t >= r->sc->t_end;
    if (done)
        return quiet || put_done(r) ? EXIT_DONE : EXIT_RUN_FAILED;
    fprintf(stderr, "ilsa-run: %s; what was reached is in %s\n%s", ended, r->directory,
            reason ? reason : "");
    return r->writing_failed || status ? EXIT_RUN_FAILED : 128 + caught;
}

static int run_steps(run *r, int quiet) {
    char ended[1200];
    ilsa_status status = ILSA_OK;
    while (!status && !caught && !r->writing_failed && r->t < r->sc->t_end)
        status = take_step(r);
    if (r->unsaved && (status || caught || r->writing_failed))
        save(r);
    if (r->history.stream && !outfile_close(&r->history))
        r->writing_failed = 1;
    progress_end(&r->bar);
    put_ending(r, status, ended, sizeof ended);
    char *reason = find_reason(r, status);
    if (!summary_write(r->directory, r->sc, r->solver, (ending){ended, reason}, wall_seconds(r))) {
        r->writing_failed = 1;
        put_ending(r, status, ended, sizeof ended);
    }
    int exit_status = conclude(r, status, quiet, ended, reason);
    free(reason);
    return exit_status;
}

int run_scene(const scene *sc, const char *directory, int quiet) {
    run r = {.sc = sc, .directory = directory};
    int exit_status;
    clock_gettime(CLOCK_MONOTONIC, &r.began);
    exit_status = model_start(sc, &r.solver);
    if (exit_status)
        return exit_status;
    catch_signals();
    ilsa_get_time(r.solver, &r.t);
    r.bar = progress_begin(quiet, r.t, sc->t_end);
    if (directory_make(directory)) {
        directory_clear(directory);
        exit_status = history_open(&r.history, directory) ? run_steps(&r, quiet) : EXIT_RUN_FAILED;
    } else {
        exit_status = EXIT_RUN_FAILED;
    }
    outputs_free(&r.out);
    ilsa_solver_destroy(&r.solver);
    return exit_status;
}
