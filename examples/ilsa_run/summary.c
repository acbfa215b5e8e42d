#include "summary.h"

#include "outfile.h"

#include <math.h>
#include <string.h>

typedef struct facts {
    ilsa_summary state;
    ilsa_model model;
    ilsa_profile profile;
    ilsa_mesh_def mesh;
} facts;

/* The lines of a text, each under the values of the summary. */
static void put_lines(FILE *s, const char *text) {
    while (*text) {
        size_t length = strcspn(text, "\n");
        fprintf(s, "                      %.*s\n", (int)length, text);
        text += length + (text[length] == '\n');
    }
}

static void put_log(FILE *s, const scene_log *log) {
    fprintf(s, "stress                %s: %d rows, y %.6g .. %.6g; beyond, the end values\n",
            log->file, log->rows, log->bottom, log->top);
}

static void put_run(FILE *s, const scene *sc, const facts *f, ending ended) {
    fprintf(s, "scene                 %s\n", sc->path);
    fprintf(s, "library               libilsa %s\n", ilsa_version_string());
    fprintf(s, "ended                 %s\n", ended.words);
    if (ended.reason)
        put_lines(s, ended.reason);
    fprintf(s, "level                 %d (front moves %.3g cells a step, found to %.2g cells)\n",
            f->model.level, f->model.step_cells, f->model.tolerance);
    fprintf(s, "mesh                  %d x %d cells of %.6g x %.6g", f->mesh.nx, f->mesh.ny,
            f->mesh.dx, f->mesh.dy);
    if (f->state.total.coarsened)
        fprintf(s, ", coarsened %ld times from %.6g x %.6g", f->state.total.coarsened, sc->mesh.dx,
                sc->mesh.dy);
    if (f->state.total.grown)
        fprintf(s, ", grown %ld times from %d x %d cells", f->state.total.grown, sc->mesh.nx,
                sc->mesh.ny);
    fputc('\n', s);
    if (sc->log.file)
        put_log(s, &sc->log);
    fputc('\n', s);
}

static void put_model(FILE *s, const scene *sc, const facts *f) {
    static const char *const part[] = {[ILSA_SYMMETRY_NONE] = "the whole",
                                       [ILSA_SYMMETRY_X] = "one half (x -> -x)",
                                       [ILSA_SYMMETRY_Y] = "one half (y -> -y)",
                                       [ILSA_SYMMETRY_XY] = "one quarter (both axes)"};
    static const char *const tip[] = {[ILSA_TIP_FULL] = "full asymptote",
                                      [ILSA_TIP_TOUGHNESS_VISCOSITY] =
                                          "toughness and viscosity alone",
                                      [ILSA_TIP_TOUGHNESS] = "toughness alone (LEFM)"};
    const ilsa_model *m = &f->model;
    fputs("modelled              elasticity, viscous flow", s);
    fprintf(s, "%s%s%s\n", m->toughness ? ", toughness" : "", m->leak_off ? ", leak-off" : "",
            m->stress_varies ? ", varying stress" : "");
    fputs("left out              ", s);
    if (m->toughness && m->leak_off && m->stress_varies)
        fputs("nothing", s);
    fprintf(s, "%s%s%s\n", m->toughness ? "" : "toughness (zero)  ",
            m->leak_off ? "" : "leak-off (zero)  ",
            m->stress_varies ? "" : "variation of stress (uniform)");
    fprintf(s, "tip                   %s\n", tip[m->tip]);
    fprintf(s, "solved                %s of the fracture\n",
            m->symmetry >= ILSA_SYMMETRY_NONE && m->symmetry <= ILSA_SYMMETRY_XY
                ? part[m->symmetry]
                : part[ILSA_SYMMETRY_NONE]);
    fprintf(s, "elasticity product    %s\n", m->product == ILSA_PRODUCT_FFT ? "FFT" : "BLAS");
    fprintf(s, "threads               %d\n", m->threads);
    fprintf(s, "sources               %d\n\n", sc->source_count);
}

static void put_state(FILE *s, const ilsa_summary *f) {
    double imbalance = f->volume_injected - f->volume_fracture - f->volume_leaked;
    fprintf(s, "time                  %.10g\n", f->time);
    fprintf(s, "through the source    x %.6g .. %.6g, y %.6g .. %.6g\n", f->x_min, f->x_max,
            f->y_min, f->y_max);
    fprintf(s, "whole footprint       x %.6g .. %.6g, y %.6g .. %.6g\n", f->extent_x_min,
            f->extent_x_max, f->extent_y_min, f->extent_y_max);
    fprintf(s, "width at the source   %.6g\n", f->width_source);
    fprintf(s, "pressure there        %.6g\n", f->pressure_source);
    fprintf(s, "volume injected       %.6g\n", f->volume_injected);
    fprintf(s, "  in the fracture     %.6g\n", f->volume_fracture);
    fprintf(s, "  leaked              %.6g\n", f->volume_leaked);
    fprintf(s, "  unaccounted for     %.2g of the injected\n",
            f->volume_injected > 0 ? fabs(imbalance) / f->volume_injected : 0);
    fprintf(s, "efficiency            %.6g\n", f->efficiency);
    fprintf(s, "cells                 %d, of which tip %d, survey %d (at rest %d), closed %d\n\n",
            f->cells, f->tip_cells, f->survey_cells, f->arrested_cells, f->closed_cells);
}

static void put_work(FILE *s, const ilsa_report *total) {
    double steps = total->steps > 0 ? (double)total->steps : 1;
    fprintf(s, "steps                 %ld\n", total->steps);
    fprintf(s, "rejected              %ld\n", total->rejected);
    fprintf(s, "front iterations      %ld (%.1f a step)\n", total->front_iterations,
            (double)total->front_iterations / steps);
    fprintf(s, "Newton iterations     %ld (%.1f a step)\n", total->newton_iterations,
            (double)total->newton_iterations / steps);
    fprintf(s, "Krylov iterations     %ld (%.1f a step)\n", total->krylov_iterations,
            (double)total->krylov_iterations / steps);
    fprintf(s, "elasticity products   %ld (%.1f a step)\n\n", total->elasticity_products,
            (double)total->elasticity_products / steps);
}

static void put_times(FILE *s, const ilsa_profile *p, double wall_s) {
    double library = p->product + p->preconditioner + p->front + p->rest;
    fprintf(s, "wall time             %.2f s\n", wall_s);
    fprintf(s, "  elasticity product  %.2f s\n", p->product);
    fprintf(s, "  preconditioner      %.2f s\n", p->preconditioner);
    fprintf(s, "  front               %.2f s\n", p->front);
    fprintf(s, "  rest of the step    %.2f s\n", p->rest);
    fprintf(s, "  start and output    %.2f s\n", fmax(0, wall_s - library));
}

int summary_write(const char *directory, const scene *sc, const ilsa_solver *solver, ending ended,
                  double wall_s) {
    facts f;
    outfile file;
    if (ilsa_get_summary(solver, &f.state) || ilsa_get_model(solver, &f.model) ||
        ilsa_get_profile(solver, &f.profile) || ilsa_get_mesh_def(solver, &f.mesh)) {
        fprintf(stderr, "ilsa-run: summary: %s\n", ilsa_last_error(solver));
        return 0;
    }
    if (!outfile_open(&file, directory, "summary.txt"))
        return 0;
    put_run(file.stream, sc, &f, ended);
    put_model(file.stream, sc, &f);
    put_state(file.stream, &f.state);
    put_work(file.stream, &f.state.total);
    put_times(file.stream, &f.profile, wall_s);
    return outfile_close(&file);
}
