#include "step/accept.h"

#include "base/tuning.h"
#include <math.h>

/* Trigger times of the cells whose centres the front has passed in the step. */
static void set_triggers(fracture *f, const trial *t, const front_cell *reached, int count) {
    for (int k = 0; k < count; k++) {
        double *trigger = &f->cells.trigger[reached[k].cell];
        if (reached[k].T <= 0 && !isfinite(*trigger)) {
            double since = reached[k].V > 0 ? -reached[k].T / reached[k].V : 0;
            *trigger = f->time + (since < t->dt ? t->dt - since : 0);
        }
    }
}

/* How unevenly in time the front has passed the cells that it has filled in the step. */
static void set_spreads(fracture *f, const trial *t, const front_cell *reached, int count) {
    const tip_paths *paths = &t->tips.paths;
    for (int k = 0, r = 0; k < count && r < paths->count; k++) {
        const front_cell *c = &reached[k];
        if (paths->at[r].cell != c->cell) {
            continue;
        }
        const tip_path *path = &paths->at[r++];
        if (t->cells.kind[c->cell] != ILSA_CELL_TIP) {
            tip_cell_front at = {c->ell, c->cos_a, c->sin_a, t->g.dx, t->g.dy};
            double over = c->ell - ilsai_march_full(&t->g, c->cos_a, c->sin_a);
            double since = c->V > 0 ? fmin(fmax(over, 0) / c->V, t->dt) : 0;
            double filled = f->time + t->dt - since;
            double spread = ilsai_tip_cell_spread(&at, filled - path->history.t[0]);
            double age = filled - f->cells.trigger[c->cell];
            f->cells.spread[c->cell] = fmax(fmin(spread, age), 0);
        }
    }
}

static void add_leaked(fracture *f, const trial *t) {
    box part = ilsai_box_fold(&t->g, &t->tips.footprint);
    for (int j = part.y0; j <= part.y1; j++) {
        for (int i = part.x0; i <= part.x1; i++) {
            int cell = ilsai_grid_cell(&t->g, i, j);
            f->cells.leaked[cell] += ilsai_trial_leaked_from(t, cell);
        }
    }
}

/* Keeps the paths through the cells that are still tip cells, and gives their images the same. */
static void keep_paths(fracture *f, trial *t) {
    tip_paths old = f->paths, *paths = &t->tips.paths;
    int image[4], kept = 0;
    for (int k = 0; k < paths->count; k++) {
        if (t->cells.kind[paths->at[k].cell] == ILSA_CELL_TIP) {
            paths->at[kept++] = paths->at[k];
        }
    }
    paths->count = kept;
    for (int k = 0; k < kept; k++) {
        int cell = paths->at[k].cell;
        int images = ilsai_grid_images(&t->g, cell % t->g.nx, cell / t->g.nx, image);
        for (int m = 1; m < images; m++) {
            paths->at[paths->count] = paths->at[k];
            paths->at[paths->count++].cell = image[m];
        }
    }
    ilsai_tip_paths_sort(paths);
    f->paths = *paths;
    *paths = old;
}

/* Cells that a pass has wetted and a later one has not keep no pressure. */
static void clear_dry(trial *t, const box *part) {
    for (int j = part->y0; j <= part->y1; j++) {
        for (int i = part->x0; i <= part->x1; i++) {
            int cell = ilsai_grid_cell(&t->g, i, j);
            if (t->cells.kind[cell] == ILSA_CELL_EMPTY) {
                t->cells.pressure[cell] = 0;
            }
        }
    }
}

void ilsai_accept(fracture *f, trial *t, const model *m, const numerics *n, double time_after) {
    int count;
    const front_cell *reached = ilsai_march_cells(n->march, &count);
    box part = ilsai_box_fold(&t->g, &t->region);
    clear_dry(t, &part);
    for (int k = 0; k < t->survey_count; k++) {
        t->cells.speed[t->survey_cells[k].cell] = t->survey_cells[k].V;
    }
    ilsai_fracture_find_survey(&t->g, &part, t->cells.kind);
    if (ilsai_model_leaks(m)) {
        set_triggers(f, t, reached, count);
        set_spreads(f, t, reached, count);
        add_leaked(f, t);
        keep_paths(f, t);
    }
    ilsai_fields_copy(&f->cells, &t->cells, t->g.nx, &t->region);
    ilsai_fields_unfold(&f->cells, &t->g, &t->region);
    f->footprint = t->tips.footprint;
    f->mirror_x = f->mirror_x && t->g.mirror_x;
    f->mirror_y = f->mirror_y && t->g.mirror_y;
    f->leak_rate = (t->leaked - f->leaked) / t->dt;
    f->injected = t->injected;
    f->leaked = t->leaked;
    f->volume = t->volume;
    f->width_most = t->width_most;
    f->unknowns = ilsai_coupled_unknowns(n->coupled);
    f->front_advance = ilsai_trial_advance(t);
    f->front_change = t->change;
    f->dt = t->dt;
    f->time = time_after;
}

void ilsai_accept_wait(fracture *f, double time) {
    f->time = time;
}
