#include "reason.h"

#include "stall.h"

#include <math.h>

/* The cells along one axis that hold a place: two where it lies on their common edge. */
typedef struct span {
    int first, last;
} span;

static span cells_at(double place, double size, int n) {
    double u = place / size + 0.5 * n, edge = floor(u + 0.5);
    if (edge > 0 && edge < n && fabs(u - edge) < 1e-9)
        return (span){(int)edge - 1, (int)edge};
    int cell = (int)fmin(fmax(floor(u), 0), n - 1);
    return (span){cell, cell};
}

static int is_outside(const scene_source *source, const ilsa_mesh_def *m,
                      const unsigned char *kind) {
    span x = cells_at(source->x, m->dx, m->nx), y = cells_at(source->y, m->dy, m->ny);
    for (int j = y.first; j <= y.last; j++)
        for (int i = x.first; i <= x.last; i++)
            if (kind[j * m->nx + i] == ILSA_CELL_EMPTY)
                return 1;
    return 0;
}

int reason_outside(const scene *sc, const ilsa_solver *solver, FILE *out) {
    ilsa_mesh_def mesh;
    const unsigned char *kind;
    double t;
    int count = 0;
    if (ilsa_get_mesh_def(solver, &mesh) || ilsa_get_cell_kinds(solver, &kind) ||
        ilsa_get_time(solver, &t))
        return 0;
    for (int i = 0; i < sc->source_count; i++) {
        const scene_source *source = &sc->sources[i];
        char name[SOURCE_NAME_SIZE];
        if (scene_rate(source, t) == 0 || !is_outside(source, &mesh, kind))
            continue;
        fprintf(out,
                "%s:%d: %s at (%.10g, %.10g) is not in the fracture at time %.10g%s, when it "
                "injects %.10g\n",
                sc->path, source->line, scene_source_name(name, i), source->x, source->y, t,
                sc->laboratory ? " s" : "", scene_rate(source, t));
        count++;
    }
    return count;
}

/* Margins that differ by less, in cells, are the same: rounding is not to choose an axis. */
static const double margin_alike = 1e-6;

/* Cells from the footprint to the nearer edge of the mesh along one axis. */
static double margin(double low, double high, double size, int n) {
    return 0.5 * n - fmax(-low, high) / size;
}

static void at_edge(const scene *sc, const ilsa_solver *solver, FILE *out) {
    ilsa_summary now;
    ilsa_mesh_def m;
    if (ilsa_get_summary(solver, &now) || ilsa_get_mesh_def(solver, &m))
        return;
    double in_x = margin(now.extent_x_min, now.extent_x_max, m.dx, m.nx);
    double in_y = margin(now.extent_y_min, now.extent_y_max, m.dy, m.ny);
    scene_error(sc, out, SECTION_MESH, in_x <= in_y + margin_alike ? MESH_NX : MESH_NY,
                ": the fracture has come to the edge of the mesh, x %.6g .. %.6g, y %.6g .. %.6g; "
                "give %s",
                now.extent_x_min, now.extent_x_max, now.extent_y_min, now.extent_y_max,
                sc->options.coarsen ? "larger cells, or a larger cells_max for more of them"
                                    : "more cells, or [run] coarsen = yes");
}

void reason_write(const scene *sc, const ilsa_solver *solver, ilsa_status status,
                  const ilsa_report *last, FILE *out) {
    if (status == ILSA_ERR_STATE)
        reason_outside(sc, solver, out);
    else if (status == ILSA_MESH_EDGE)
        at_edge(sc, solver, out);
    else if (status == ILSA_STALLED)
        stall_write(sc, solver, last, out);
}
