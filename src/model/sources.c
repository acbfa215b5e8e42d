#include "model/sources.h"

#include "base/memory.h"
#include "base/tuning.h"
#include "model/mesh.h"
#include <math.h>

ilsa_status ilsai_source_check(const ilsa_mesh_def *mesh, const ilsa_source_def *def,
                               error_text *error) {
    double half_x = 0.5 * mesh->nx * mesh->dx, half_y = 0.5 * mesh->ny * mesh->dy;
    ILSAI_TRY(ilsai_check_range(error, "source x", def->x, -half_x, half_x));
    ILSAI_TRY(ilsai_check_range(error, "source y", def->y, -half_y, half_y));
    return ilsai_check_range(error, "source rate", def->rate, 0, ILSAI_MAGNITUDE_MOST);
}

ilsa_status ilsai_sources_create(sources *s, const ilsa_source_def *defs, int count) {
    s->at = ilsai_allocate_zeroed((size_t)count, sizeof *s->at);
    if (!s->at) {
        return ILSA_ERR_MEMORY;
    }
    s->count = count;
    for (int k = 0; k < count; k++) {
        s->at[k].def = defs[k];
    }
    return ILSA_OK;
}

void ilsai_sources_destroy(sources *s) {
    ilsai_release(s->at);
    *s = (sources){0};
}

/* The one or two columns (rows) that hold a coordinate: two where it lies on their common edge. */
static int columns_at(double x, double d, int n, int at[2]) {
    double u = x / d + 0.5 * n; /* in cells from the lower edge of the mesh */
    double edge = floor(u + 0.5);
    bool inner = edge > 0 && edge < n;
    if (inner && fabs(u - edge) < ILSAI_EDGE_CELLS) {
        at[0] = (int)edge - 1;
        at[1] = (int)edge;
        return 2;
    }
    at[0] = ilsai_mesh_locate(n, d, x);
    return 1;
}

void ilsai_sources_place(sources *s, const ilsa_mesh_def *mesh) {
    for (int k = 0; k < s->count; k++) {
        point_source *from = &s->at[k];
        int column[2], row[2];
        int columns = columns_at(from->def.x, mesh->dx, mesh->nx, column);
        int rows = columns_at(from->def.y, mesh->dy, mesh->ny, row);
        from->count = 0;
        for (int b = 0; b < rows; b++) {
            for (int a = 0; a < columns; a++) {
                from->cell[from->count] = row[b] * mesh->nx + column[a];
                from->part[from->count++] = 1.0 / (columns * rows);
            }
        }
    }
}

double ilsai_sources_rate(const sources *s) {
    double rate = 0;
    for (int k = 0; k < s->count; k++) {
        rate += s->at[k].def.rate;
    }
    return rate;
}

/* How many sources of the rate of `like` stand at (x, y). */
static int count_like(const sources *s, const ilsa_source_def *like, double x, double y) {
    int count = 0;
    for (int k = 0; k < s->count; k++) {
        const ilsa_source_def *def = &s->at[k].def;
        count += def->rate == like->rate && def->x == x && def->y == y;
    }
    return count;
}

/* Sources may share a place, so that it takes as many images as there are sources there. */
bool ilsai_sources_mirror(const sources *s, bool about_x) {
    bool mirror = true;
    for (int k = 0; k < s->count && mirror; k++) {
        const ilsa_source_def *def = &s->at[k].def;
        double x = about_x ? -def->x : def->x, y = about_x ? def->y : -def->y;
        mirror = count_like(s, def, x, y) == count_like(s, def, def->x, def->y);
    }
    return mirror;
}
