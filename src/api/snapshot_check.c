#include "api/snapshot_check.h"

#include "base/tuning.h"
#include <math.h>
#include <string.h>

static bool is_within(double value, double least) {
    return value >= least && value <= FIELD_MOST;
}

static bool is_inside(const box *b, const ilsa_mesh_def *mesh) {
    return b->x0 >= 1 && b->x0 <= b->x1 && b->x1 < mesh->nx - 1 && b->y0 >= 1 && b->y0 <= b->y1 &&
           b->y1 < mesh->ny - 1;
}

bool ilsai_snapshot_fracture_is_sound(const fracture *f, const ilsa_mesh_def *mesh) {
    return is_within(f->time, ILSAI_MAGNITUDE_LEAST) && is_within(f->injected, 0) &&
           is_within(f->leaked, 0) && f->volume > 0 && is_within(f->volume, 0) &&
           is_within(f->front_change, 0) && is_within(f->front_advance, 0) && is_within(f->dt, 0) &&
           f->unknowns >= 0 && isfinite(f->leak_rate) && f->width_most > 0 &&
           is_within(f->width_most, 0) && is_inside(&f->footprint, mesh);
}

bool ilsai_snapshot_path_is_sound(const tip_path *path, size_t cells, double now) {
    const tip_cell_history *h = &path->history;
    bool sound = path->cell >= 0 && (size_t)path->cell < cells && h->count >= 1 &&
                 h->count <= TIP_CELL_KNOTS;
    for (int k = 0; sound && k < h->count; k++) {
        double t = k > 0 ? h->t[k - 1] : 0, ell = k > 0 ? h->ell[k - 1] : 0;
        sound = h->t[k] >= t && h->t[k] <= now && is_within(h->ell[k], ell);
    }
    return sound;
}

static size_t count_of(const snapshot_fields *f) {
    return ilsai_box_columns(&f->region) * ilsai_box_rows(&f->region);
}

/* The k-th value of a field; each lies behind those that stand before it in the table. */
static double value_of(const snapshot_fields *f, int row, size_t k) {
    const unsigned char *at = f->at;
    for (int before = 0; before < row; before++) {
        at += ilsai_snapshot_has(before, f->leakoff) ? count_of(f) * ilsai_field_rows[before].size
                                                     : 0;
    }
    if (ilsai_field_rows[row].size == 1) {
        return at[k];
    }
    double value;
    memcpy(&value, at + k * sizeof value, sizeof value);
    return value;
}

static int kind_of(const snapshot_fields *f, size_t k) {
    return (int)value_of(f, FIELD_kind, k);
}

bool ilsai_snapshot_has(int row, bool leakoff) {
    int owner = ilsai_field_rows[row].owner;
    return (owner & FIELD_FRACTURE) && (leakoff || !(owner & FIELD_LEAKOFF));
}

/* Every value is the one of cells that the fracture has not reached, or in its range. */
static bool values_are_sound(const snapshot_fields *f, size_t k) {
    for (int row = 0; row < FIELD_COUNT; row++) {
        const field_row *r = &ilsai_field_rows[row];
        double value = ilsai_snapshot_has(row, f->leakoff) ? value_of(f, row, k) : r->empty;
        if (value != r->empty && !is_within(value, r->least)) {
            return false;
        }
    }
    return kind_of(f, k) <= ILSA_CELL_CHANNEL;
}

/* A tip cell may hold nothing: one that the front has just touched. */
static bool wet_is_sound(const snapshot_fields *f, size_t k) {
    double level = value_of(f, FIELD_level, k);
    bool tip = kind_of(f, k) == ILSA_CELL_TIP;
    return isfinite(level) && (tip || (value_of(f, FIELD_width, k) > 0 && level < 0));
}

static bool dry_is_sound(const snapshot_fields *f, size_t k) {
    return value_of(f, FIELD_width, k) == 0 && value_of(f, FIELD_pressure, k) == 0 &&
           value_of(f, FIELD_level, k) > 0;
}

/* The footprint lies inside the region, so that its cells have all their neighbours. */
static bool channel_is_sound(const snapshot_fields *f, size_t k) {
    size_t row = ilsai_box_columns(&f->region);
    bool beside_tip =
        kind_of(f, k - 1) < ILSA_CELL_SURVEY || kind_of(f, k + 1) < ILSA_CELL_SURVEY ||
        kind_of(f, k - row) < ILSA_CELL_SURVEY || kind_of(f, k + row) < ILSA_CELL_SURVEY;
    return kind_of(f, k) == (beside_tip ? ILSA_CELL_SURVEY : ILSA_CELL_CHANNEL);
}

bool ilsai_snapshot_fields_are_sound(const snapshot_fields *f) {
    bool sound = true, survey = false;
    size_t k = 0;
    for (int j = f->region.y0; sound && j <= f->region.y1; j++) {
        for (int i = f->region.x0; sound && i <= f->region.x1; i++, k++) {
            bool inside = i >= f->footprint.x0 && i <= f->footprint.x1 && j >= f->footprint.y0 &&
                          j <= f->footprint.y1;
            int kind = kind_of(f, k);
            sound = values_are_sound(f, k) && (kind == ILSA_CELL_EMPTY || inside) &&
                    (kind == ILSA_CELL_EMPTY ? dry_is_sound(f, k) : wet_is_sound(f, k)) &&
                    (kind < ILSA_CELL_SURVEY || channel_is_sound(f, k));
            survey |= kind == ILSA_CELL_SURVEY;
        }
    }
    return sound && survey;
}
