#include "api/snapshot_check.h"
#include "base/tuning.h"

#include <math.h>
#include <string.h>

/* More than anything that a state can come to from the magnitudes that a solver takes. */
static const double MOST = 1e200;

static int is_flag(int value) {
    return value == 0 || value == 1;
}

static int is_within(double value, double least) {
    return value >= least && value <= MOST;
}

static int is_inside(const box *b, const ilsa_mesh_def *mesh) {
    return b->x0 >= 1 && b->x0 <= b->x1 && b->x1 < mesh->nx - 1 && b->y0 >= 1 && b->y0 <= b->y1 &&
           b->y1 < mesh->ny - 1;
}

int ilsai_snapshot_state_is_sound(const state *now, const ilsa_mesh_def *mesh) {
    return now->started == 1 && is_flag(now->mirror_x) && is_flag(now->mirror_y) &&
           is_within(now->time, ILSAI_MAGNITUDE_LEAST) && now->dt_limit > 0 &&
           is_within(now->injected, 0) && is_within(now->leaked, 0) && now->fracture > 0 &&
           is_within(now->fracture, 0) && is_within(now->front_change, 0) &&
           is_within(now->front_advance, 0) && is_within(now->dt, 0) && now->unknowns >= 0 &&
           isfinite(now->leak_rate) && now->width_most > 0 && is_within(now->width_most, 0) &&
           is_inside(&now->footprint, mesh);
}

int ilsai_snapshot_record_is_sound(const tip_record *record, size_t cells, double now) {
    const tip_cell_history *h = &record->history;
    int sound = record->cell >= 0 && (size_t)record->cell < cells && h->count >= 1 &&
                h->count <= TIP_CELL_KNOTS;
    for (int k = 0; sound && k < h->count; k++) {
        double t = k > 0 ? h->t[k - 1] : 0, ell = k > 0 ? h->ell[k - 1] : 0;
        sound = h->t[k] >= t && h->t[k] <= now && is_within(h->ell[k], ell);
    }
    return sound;
}

enum { WIDTH, PRESSURE, LEVEL, SPEED, NUMBERS, TRIGGER = NUMBERS, SPREAD, LEAKED };

static size_t count_of(const snapshot_fields *f) {
    return ilsai_box_columns(&f->region) * ilsai_box_rows(&f->region);
}

static double number(const snapshot_fields *f, int which, size_t k) {
    size_t count = count_of(f), kinds = which < NUMBERS ? 0 : count;
    double value;
    memcpy(&value, f->at + kinds + ((size_t)which * count + k) * sizeof value, sizeof value);
    return value;
}

static int kind_of(const snapshot_fields *f, size_t k) {
    return f->at[NUMBERS * count_of(f) * sizeof(double) + k];
}

/* A tip cell may hold nothing: one that the front has just touched. */
static int wet_is_sound(const snapshot_fields *f, size_t k) {
    double level = number(f, LEVEL, k);
    int kind = kind_of(f, k);
    return (kind == ILSA_CELL_TIP || number(f, WIDTH, k) > 0) && is_within(level, -MOST) &&
           (kind == ILSA_CELL_TIP || level < 0);
}

static int dry_is_sound(const snapshot_fields *f, size_t k) {
    return number(f, WIDTH, k) == 0 && number(f, PRESSURE, k) == 0 && number(f, LEVEL, k) > 0;
}

static int leak_is_sound(const snapshot_fields *f, size_t k) {
    return number(f, TRIGGER, k) >= 0 && is_within(number(f, SPREAD, k), 0) &&
           is_within(number(f, LEAKED, k), 0);
}

static int cell_is_sound(const snapshot_fields *f, size_t k) {
    int kind = kind_of(f, k);
    return kind <= ILSA_CELL_CHANNEL && is_within(number(f, WIDTH, k), 0) &&
           is_within(fabs(number(f, PRESSURE, k)), 0) && is_within(number(f, SPEED, k), 0) &&
           (kind == ILSA_CELL_EMPTY ? dry_is_sound(f, k) : wet_is_sound(f, k)) &&
           (!f->leak_off || leak_is_sound(f, k));
}

/* The footprint lies inside the region, so that its cells have all their neighbours. */
static int rim_is_sound(const snapshot_fields *f, size_t k) {
    size_t row = ilsai_box_columns(&f->region);
    int rim = kind_of(f, k - 1) < ILSA_CELL_SURVEY || kind_of(f, k + 1) < ILSA_CELL_SURVEY ||
              kind_of(f, k - row) < ILSA_CELL_SURVEY || kind_of(f, k + row) < ILSA_CELL_SURVEY;
    return kind_of(f, k) == (rim ? ILSA_CELL_SURVEY : ILSA_CELL_CHANNEL);
}

int ilsai_snapshot_fields_are_sound(const snapshot_fields *f) {
    int sound = 1, survey = 0;
    size_t k = 0;
    for (int j = f->region.y0; sound && j <= f->region.y1; j++) {
        for (int i = f->region.x0; sound && i <= f->region.x1; i++, k++) {
            int inside = i >= f->footprint.x0 && i <= f->footprint.x1 && j >= f->footprint.y0 &&
                         j <= f->footprint.y1;
            int kind = kind_of(f, k);
            sound = cell_is_sound(f, k) && (kind == ILSA_CELL_EMPTY || inside) &&
                    (kind < ILSA_CELL_SURVEY || rim_is_sound(f, k));
            survey |= kind == ILSA_CELL_SURVEY;
        }
    }
    return sound && survey;
}
