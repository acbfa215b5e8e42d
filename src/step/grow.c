/*
 * The fracture moved to a mesh of more cells of the same size, as many on either side, so that the
 * origin stays where it is. Each cell keeps what it holds, bit for bit.
 */
#include "step/grow.h"

#include "base/memory.h"
#include "model/mesh.h"
#include "step/mesh_arrays.h"
#include <string.h>

/* The larger mesh while it is being made. */
typedef struct grown {
    int columns, rows; /* added on either side; negative: taken away */
    model model;       /* the solver's, with mesh, stress and sigma of its own */
    mesh_arrays arrays;
} grown;

static int moved(const grown *g, int nx, int cell) {
    return (cell / nx + g->rows) * g->model.mesh.nx + cell % nx + g->columns;
}

/* The cells that the fracture may have touched, as far as they are on both meshes. */
static box common_region(const grown *g, const ilsa_solver *s) {
    const ilsa_mesh_def *mesh = &s->model.mesh;
    box b = ilsai_fracture_region(mesh, &s->fracture.footprint);
    box common = {-g->columns, mesh->nx - 1 + g->columns, -g->rows, mesh->ny - 1 + g->rows};
    return (box){b.x0 > common.x0 ? b.x0 : common.x0, b.x1 < common.x1 ? b.x1 : common.x1,
                 b.y0 > common.y0 ? b.y0 : common.y0, b.y1 < common.y1 ? b.y1 : common.y1};
}

static void copy_fields(const grown *g, const fields *from, int nx, const box *region) {
    for (int row = 0; row < FIELD_COUNT; row++) {
        const char *source = ilsai_field(from, row);
        char *target = ilsai_field(&g->arrays.fracture, row);
        size_t size = ilsai_field_rows[row].size;
        for (int j = region->y0; source && j <= region->y1; j++) {
            int cell = j * nx + region->x0;
            memcpy(target + (size_t)moved(g, nx, cell) * size, source + (size_t)cell * size,
                   ilsai_box_columns(region) * size);
        }
    }
}

static ilsa_status make(grown *g, const ilsa_solver *s) {
    const ilsa_mesh_def *mesh = &g->model.mesh;
    ILSAI_TRY(ilsai_cell_field_copy(&s->model.stress, &g->model.stress));
    ILSAI_TRY(ilsai_cell_field_grow(&g->model.stress, g->columns, g->rows));
    g->model.sigma = ilsai_allocate(ilsai_mesh_cells(mesh), sizeof *g->model.sigma);
    if (!g->model.sigma) {
        return ILSA_ERR_MEMORY;
    }
    ILSAI_TRY(ilsai_model_fill_stress(&g->model));
    return ilsai_mesh_arrays_create(&g->arrays, mesh, ilsai_model_leaks(&s->model));
}

/* The solver takes the larger mesh over, and leaves what it had in g to be released. */
static void exchange(ilsa_solver *s, grown *g) {
    fracture *f = &s->fracture;
    int nx = s->model.mesh.nx;
    box region = common_region(g, s);
    copy_fields(g, &f->cells, nx, &region);
    for (int k = 0; k < f->paths.count; k++) {
        f->paths.at[k].cell = moved(g, nx, f->paths.at[k].cell);
    }
    f->footprint = (box){f->footprint.x0 + g->columns, f->footprint.x1 + g->columns,
                         f->footprint.y0 + g->rows, f->footprint.y1 + g->rows};
    ilsai_mesh_arrays_exchange(&g->arrays, s);
    model old = s->model;
    s->model = g->model;
    g->model = old;
    ilsai_sources_place(&s->model.sources, &s->model.mesh);
}

static void release(grown *g) {
    ilsai_cell_field_clear(&g->model.stress);
    ilsai_release(g->model.sigma);
    ilsai_mesh_arrays_destroy(&g->arrays);
}

static ilsa_status check(ilsa_solver *s, int columns, int rows) {
    ILSAI_TRY(ilsai_fracture_check(&s->fracture, &s->error));
    ILSAI_TRY(ilsai_check_range(&s->error, "columns", columns, 0, ILSAI_MESH_COUNT_MOST));
    ILSAI_TRY(ilsai_check_range(&s->error, "rows", rows, 0, ILSAI_MESH_COUNT_MOST));
    ilsa_mesh_def mesh = ilsai_mesh_grown(&s->model.mesh, columns, rows);
    ILSAI_TRY(ilsai_mesh_check(&mesh, &s->error));
    double most = ilsai_model_cells_max(&s->model);
    if ((double)mesh.nx * mesh.ny > most) {
        return ilsai_fail(&s->error, ILSA_ERR_VALUE,
                          "a mesh of %d x %d cells: cells_max allows %.0f", mesh.nx, mesh.ny, most);
    }
    return ILSA_OK;
}

ilsa_status ilsai_grow_mesh(ilsa_solver *s, int columns, int rows) {
    grown g = {.columns = columns, .rows = rows, .model = s->model};
    g.model.mesh = ilsai_mesh_grown(&s->model.mesh, columns, rows);
    g.model.stress = (cell_field){0};
    g.model.sigma = NULL;
    ilsa_status status = make(&g, s);
    if (status == ILSA_OK) {
        exchange(s, &g);
    }
    release(&g);
    return status == ILSA_OK ? ILSA_OK
                             : ilsai_fail(&s->error, status, "no memory for a larger mesh");
}

ilsa_status ilsa_grow(ilsa_solver *solver, int columns, int rows) {
    if (!solver) {
        return ilsai_check_pointer(ilsai_thread_error(), "solver", solver);
    }
    ILSAI_TRY(check(solver, columns, rows));
    return ilsai_grow_mesh(solver, columns, rows);
}
