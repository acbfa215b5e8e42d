/* What surrounds the fracture on the mesh as it is now: sources, stress, symmetry, region. */
#include "base/tuning.h"
#include "step/state.h"

#include <math.h>

ilsa_status ilsai_check_started(const ilsa_solver *s, error_text *error) {
    return s->now.started
               ? ILSA_OK
               : ilsai_fail(error, ILSA_ERR_STATE, "no fracture yet: call ilsa_start_radial first");
}

/* The one or two columns (rows) that hold a coordinate: two where it lies on their common edge. */
static int columns_at(double x, double d, int n, int at[2]) {
    double u = x / d + 0.5 * n; /* in cells from the lower edge of the mesh */
    double edge = floor(u + 0.5);
    int inner = edge > 0 && edge < n;
    if (inner && fabs(u - edge) < ILSAI_EDGE_CELLS) {
        at[0] = (int)edge - 1;
        at[1] = (int)edge;
        return 2;
    }
    at[0] = ilsai_mesh_locate(n, d, x);
    return 1;
}

void ilsai_sources_place(ilsa_solver *s) {
    for (int k = 0; k < s->def.source_count; k++) {
        point_source *from = &s->sources[k];
        int column[2], row[2];
        int nx = columns_at(from->def.x, s->mesh.dx, s->mesh.nx, column);
        int ny = columns_at(from->def.y, s->mesh.dy, s->mesh.ny, row);
        from->count = 0;
        for (int b = 0; b < ny; b++) {
            for (int a = 0; a < nx; a++) {
                from->cell[from->count] = row[b] * s->mesh.nx + column[a];
                from->part[from->count++] = 1.0 / (nx * ny);
            }
        }
    }
}

/* Whether the stress is the same in every cell and its mirror image. */
static int stress_mirrors(const ilsa_solver *s, int about_x) {
    int nx = s->mesh.nx, ny = s->mesh.ny;
    for (int j = 0; j < ny; j++) {
        for (int i = 0; i < nx; i++) {
            int other = about_x ? j * nx + (nx - 1 - i) : (ny - 1 - j) * nx + i;
            if (s->sigma[j * nx + i] != s->sigma[other]) {
                return 0;
            }
        }
    }
    return 1;
}

ilsa_status ilsai_solver_fill_stress(ilsa_solver *s) {
    ilsa_status status = ilsai_stress_fill(s->stress, &s->mesh, s->sigma);
    if (status == ILSA_OK) {
        s->stress_mirror_x = stress_mirrors(s, 1);
        s->stress_mirror_y = stress_mirrors(s, 0);
    }
    return status;
}

/* How many sources of the rate of a stand at (x, y). */
static int sources_like(const ilsa_solver *s, const ilsa_source_def *a, double x, double y) {
    int count = 0;
    for (int k = 0; k < s->def.source_count; k++) {
        const ilsa_source_def *b = &s->sources[k].def;
        count += b->rate == a->rate && b->x == x && b->y == y;
    }
    return count;
}

/* Whether every source has an image of the same rate; sources may share a place. */
static int sources_mirror(const ilsa_solver *s, int about_x) {
    int mirror = 1;
    for (int k = 0; k < s->def.source_count && mirror; k++) {
        const ilsa_source_def *a = &s->sources[k].def;
        double x = about_x ? -a->x : a->x, y = about_x ? a->y : -a->y;
        mirror = sources_like(s, a, x, y) == sources_like(s, a, a->x, a->y);
    }
    return mirror;
}

static int wants_mirror(const ilsa_solver *s, int about_x) {
    ilsa_symmetry symmetry = s->def.symmetry;
    return symmetry == ILSA_SYMMETRY_AUTO || symmetry == ILSA_SYMMETRY_XY ||
           symmetry == (about_x ? ILSA_SYMMETRY_X : ILSA_SYMMETRY_Y);
}

static int scene_mirrors(const ilsa_solver *s, int about_x) {
    return (about_x ? s->stress_mirror_x : s->stress_mirror_y) && sources_mirror(s, about_x);
}

ilsa_status ilsai_symmetry_check(const ilsa_solver *s) {
    for (int about_x = 0; about_x < 2; about_x++) {
        if (s->def.symmetry != ILSA_SYMMETRY_AUTO && wants_mirror(s, about_x) &&
            !scene_mirrors(s, about_x)) {
            return ilsai_fail(ilsai_thread_error(), ILSA_ERR_MISMATCH,
                              "symmetry about %s = 0 asked for: sources or stress do not have it",
                              about_x ? "x" : "y");
        }
    }
    return ILSA_OK;
}

grid ilsai_solver_grid(const ilsa_solver *s) {
    int mirror_x = s->now.mirror_x && wants_mirror(s, 1) && scene_mirrors(s, 1);
    int mirror_y = s->now.mirror_y && wants_mirror(s, 0) && scene_mirrors(s, 0);
    return ilsai_grid(&s->mesh, mirror_x, mirror_y);
}

double ilsai_injection_rate(const ilsa_solver *s) {
    double rate = 0;
    for (int k = 0; k < s->def.source_count; k++) {
        rate += s->sources[k].def.rate;
    }
    return rate;
}

double ilsai_closure_width(const ilsa_solver *s) {
    return s->def.closure_width > 0 ? s->def.closure_width : ILSAI_CLOSURE * s->now.width_most;
}

static int count_channel(const ilsa_solver *s, int closed) {
    const box *b = &s->now.footprint;
    double closure = ilsai_closure_width(s);
    int count = 0;
    for (int j = b->y0; j <= b->y1; j++) {
        for (int i = b->x0; i <= b->x1; i++) {
            int cell = j * s->mesh.nx + i;
            count += s->field.kind[cell] >= ILSA_CELL_SURVEY &&
                     ilsai_contact_closed(s->field.width[cell], closure) == closed;
        }
    }
    return count;
}

int ilsai_open_cells(const ilsa_solver *s) {
    return count_channel(s, 0);
}

int ilsai_closed_cells(const ilsa_solver *s) {
    return count_channel(s, 1);
}

double ilsai_solver_band(const ilsa_solver *s) {
    return ILSAI_BAND * hypot(s->mesh.dx, s->mesh.dy);
}

box ilsai_solver_region(const ilsa_solver *s, const box *footprint) {
    double reach = ilsai_solver_band(s) + ILSAI_ADVANCE_MAX * fmax(s->mesh.dx, s->mesh.dy);
    grid flat = ilsai_grid(&s->mesh, 0, 0);
    return ilsai_box_widen(&flat, footprint, 3 + (int)ceil(reach / s->mesh.dx),
                           3 + (int)ceil(reach / s->mesh.dy));
}
