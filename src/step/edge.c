#include "step/edge.h"

#include "base/tuning.h"
#include "model/mesh.h"
#include "step/grow.h"
#include <math.h>

enum { BOTH = ILSA_ALONG_X | ILSA_ALONG_Y };

/* The cells between the footprint and the nearer edge of the mesh along an axis. */
static int free_cells(int first, int last, int n) {
    return first < n - 1 - last ? first : n - 1 - last;
}

/* The directions in which the mesh is full; the one with the fewer free cells if there is none. */
static int full_directions(const ilsa_solver *s) {
    const box *b = &s->fracture.footprint;
    int x = free_cells(b->x0, b->x1, s->model.mesh.nx);
    int y = free_cells(b->y0, b->y1, s->model.mesh.ny);
    int full =
        (x <= ILSAI_EDGE_FREE ? ILSA_ALONG_X : 0) | (y <= ILSAI_EDGE_FREE ? ILSA_ALONG_Y : 0);
    return full ? full : x <= y ? ILSA_ALONG_X : ILSA_ALONG_Y;
}

/* Cells across half of the footprint along one axis on cells twice as large. */
static double coarser_half(int first, int last) {
    int across = (last - first + 2) / 2;
    return 0.5 * across;
}

/* The height of the thinnest layer of stress with a source in it. */
static double layer_of_sources(const model *m) {
    double height = INFINITY;
    for (int k = 0; k < m->sources.count; k++) {
        height = fmin(height, ilsai_cell_field_layer(&m->stress, m->sources.at[k].def.y));
    }
    return height;
}

/* Whether coarsening leaves cells enough along x, along y. */
static bool leaves_enough_x(const ilsa_solver *s) {
    const box *b = &s->fracture.footprint;
    return coarser_half(b->x0, b->x1) >= ILSAI_EDGE_CELLS_ACROSS;
}

static bool leaves_enough_y(const ilsa_solver *s) {
    const box *b = &s->fracture.footprint;
    return coarser_half(b->y0, b->y1) >= ILSAI_EDGE_CELLS_ACROSS &&
           layer_of_sources(&s->model) >= ILSAI_EDGE_CELLS_ACROSS * 2 * s->model.mesh.dy;
}

/* Whether cells twice as long along one axis alone are not too oblong, and short enough for the
 * front that runs along it: its radius of curvature is some half of the footprint's width. */
static bool may_be_oblong(const ilsa_solver *s, int direction) {
    const ilsa_mesh_def *m = &s->model.mesh;
    const box *b = &s->fracture.footprint;
    bool x = direction == ILSA_ALONG_X;
    double length = 2 * (x ? m->dx : m->dy), other = x ? m->dy : m->dx;
    double width = x ? (b->y1 - b->y0 + 1) * m->dy : (b->x1 - b->x0 + 1) * m->dx;
    return length <= ILSAI_EDGE_OBLONG * other && width >= ILSAI_EDGE_LENGTHWISE * length;
}

static bool leaves_enough(const ilsa_solver *s, int directions) {
    return directions == BOTH           ? leaves_enough_x(s) && leaves_enough_y(s)
           : directions == ILSA_ALONG_X ? leaves_enough_x(s) && may_be_oblong(s, directions)
                                        : leaves_enough_y(s) && may_be_oblong(s, directions);
}

static ilsa_status coarsen(ilsa_solver *s, int directions, ilsa_report *report) {
    ILSAI_TRY(ilsa_coarsen_along(s, directions));
    ilsa_report *counts[] = {report, &s->total};
    for (int k = 0; k < 2; k++) {
        counts[k]->coarsened++;
        counts[k]->coarsened_x += (directions & ILSA_ALONG_X) != 0;
        counts[k]->coarsened_y += (directions & ILSA_ALONG_Y) != 0;
    }
    return ILSA_OK;
}

/*
 * Cells along an axis that may be taken away on either side: those further from the footprint than
 * half of its size, as long as the sources stay on the mesh.
 */
static int cells_to_spare(const ilsa_solver *s, bool along_x) {
    const ilsa_mesh_def *m = &s->model.mesh;
    const box *b = &s->fracture.footprint;
    int n = along_x ? m->nx : m->ny, first = along_x ? b->x0 : b->y0,
        last = along_x ? b->x1 : b->y1;
    double d = along_x ? m->dx : m->dy;
    double spare = free_cells(first, last, n) - fmax(0.5 * (last - first + 1), ILSAI_EDGE_KEPT);
    for (int k = 0; k < s->model.sources.count; k++) {
        const ilsa_source_def *def = &s->model.sources.at[k].def;
        spare = fmin(spare, 0.5 * n - 1 - fabs(along_x ? def->x : def->y) / d);
    }
    return s->model.stress.kind == FIELD_CELLS || spare < 0 ? 0 : (int)spare;
}

/* Cells to be added on either side of n where there are `others` along the other axis: half of what
 * there are, or as many as are allowed; 0 where that is too few to be worth it. */
static int cells_to_add(const model *m, int n, int others) {
    double most = fmin(ilsai_model_cells_max(m) / others, ILSAI_MESH_COUNT_MOST);
    int add = (int)fmin(0.5 * n, floor(0.5 * (most - n)));
    return add >= ILSAI_EDGE_ADDED ? add : 0;
}

static ilsa_status change_counts(ilsa_solver *s, int columns, int rows, ilsa_report *report) {
    ILSAI_TRY(ilsai_grow_mesh(s, columns, rows));
    report->grown++;
    s->total.grown++;
    return ILSA_OK;
}

/* Adds cells in the full directions; one that cannot be enlarged stays for the next time.
 * ILSA_MESH_EDGE where that is none. */
static ilsa_status grow(ilsa_solver *s, int full, ilsa_report *report) {
    const ilsa_mesh_def *mesh = &s->model.mesh;
    int columns = full & ILSA_ALONG_X ? cells_to_add(&s->model, mesh->nx, mesh->ny) : 0;
    int rows = full & ILSA_ALONG_Y ? cells_to_add(&s->model, mesh->ny, mesh->nx + 2 * columns) : 0;
    return columns == 0 && rows == 0 ? ILSA_MESH_EDGE : change_counts(s, columns, rows, report);
}

/* Adds cells in the one full direction in the place of some that lie idle in the other. */
static ilsa_status shift_cells(ilsa_solver *s, int full, ilsa_report *report) {
    const ilsa_mesh_def *mesh = &s->model.mesh;
    int spare = full == BOTH ? 0 : cells_to_spare(s, full == ILSA_ALONG_Y);
    bool x = full == ILSA_ALONG_X;
    int more = x ? cells_to_add(&s->model, mesh->nx, mesh->ny - 2 * spare)
                 : cells_to_add(&s->model, mesh->ny, mesh->nx - 2 * spare);
    return spare == 0 || more == 0 ? ILSA_MESH_EDGE
                                   : change_counts(s, x ? more : -spare, x ? -spare : more, report);
}

/* What to coarsen where cells may not be added: both directions where that leaves enough across the
 * footprint, at the cost of the layer; otherwise the full direction that has more. */
static int least_harm(const ilsa_solver *s, int full) {
    const box *b = &s->fracture.footprint;
    if (coarser_half(b->x0, b->x1) >= ILSAI_EDGE_CELLS_ACROSS &&
        coarser_half(b->y0, b->y1) >= ILSAI_EDGE_CELLS_ACROSS) {
        return BOTH;
    }
    return full != BOTH ? full : b->x1 - b->x0 >= b->y1 - b->y0 ? ILSA_ALONG_X : ILSA_ALONG_Y;
}

/* Where the fracture is, and what to try. */
static ilsa_status nothing_left(ilsa_solver *s, int full) {
    const ilsa_mesh_def *m = &s->model.mesh;
    const box *b = &s->fracture.footprint;
    bool x = full & ILSA_ALONG_X;
    double low = x ? ilsai_mesh_edge(m->nx, m->dx, b->x0) : ilsai_mesh_edge(m->ny, m->dy, b->y0);
    double high =
        x ? ilsai_mesh_edge(m->nx, m->dx, b->x1 + 1) : ilsai_mesh_edge(m->ny, m->dy, b->y1 + 1);
    return ilsai_fail(
        &s->error, ILSA_MESH_EDGE,
        "the footprint, %s %g .. %g, reaches the edge of the mesh of %d x %d cells%s",
        x ? "x" : "y", low, high, m->nx, m->ny,
        s->model.options.coarsen
            ? ", and is too narrow to be coarsened: a larger cells_max, or larger cells"
            : ": more cells, or coarsen = 1");
}

ilsa_status ilsai_edge_pass(ilsa_solver *s, ilsa_report *report) {
    int full = full_directions(s);
    if (!s->model.options.coarsen) {
        return nothing_left(s, full);
    }
    if (leaves_enough(s, BOTH)) {
        return coarsen(s, BOTH, report);
    }
    for (int direction = ILSA_ALONG_X; direction <= ILSA_ALONG_Y; direction++) {
        if (full & direction && leaves_enough(s, direction)) {
            return coarsen(s, direction, report);
        }
    }
    ilsa_status status = grow(s, full, report);
    int directions = least_harm(s, full);
    if (status == ILSA_MESH_EDGE && directions != BOTH) {
        status = shift_cells(s, full, report);
    }
    if (status == ILSA_MESH_EDGE) {
        status = coarsen(s, directions, report);
    }
    return status == ILSA_ERR_VALUE ? nothing_left(s, full) : status;
}
