#include "step/fracture.h"

#include "base/tuning.h"
#include "flow/contact.h"
#include "model/mesh.h"
#include <math.h>

ilsa_status ilsai_fracture_create(fracture *f, const model *m) {
    *f = (fracture){0};
    return ilsai_fields_create(&f->cells, ilsai_mesh_cells(&m->mesh), FIELD_FRACTURE,
                               ilsai_model_leaks(m));
}

void ilsai_fracture_destroy(fracture *f) {
    ilsai_fields_destroy(&f->cells);
    ilsai_tip_paths_destroy(&f->paths);
}

ilsa_status ilsai_fracture_check(const fracture *f, error_text *error) {
    return f->started
               ? ILSA_OK
               : ilsai_fail(error, ILSA_ERR_STATE, "no fracture yet: call ilsa_start_radial first");
}

void ilsai_fracture_clear(fracture *f, const ilsa_mesh_def *mesh) {
    if (f->started) {
        box old = ilsai_fracture_region(mesh, &f->footprint);
        ilsai_fields_clear(&f->cells, mesh->nx, &old);
    }
}

double ilsai_fracture_band(const ilsa_mesh_def *mesh) {
    return ILSAI_BAND * hypot(mesh->dx, mesh->dy);
}

box ilsai_fracture_region(const ilsa_mesh_def *mesh, const box *footprint) {
    double reach = ilsai_fracture_band(mesh) + ILSAI_ADVANCE_MAX * fmax(mesh->dx, mesh->dy);
    grid flat = ilsai_grid(mesh, 0, 0);
    return ilsai_box_widen(&flat, footprint, 3 + (int)ceil(reach / mesh->dx),
                           3 + (int)ceil(reach / mesh->dy));
}

void ilsai_fracture_find_survey(const grid *g, const box *part, unsigned char *kind) {
    for (int j = part->y0; j <= part->y1; j++) {
        for (int i = part->x0; i <= part->x1; i++) {
            int cell = ilsai_grid_cell(g, i, j);
            bool beside_tip = false;
            if (!ilsai_is_channel(kind[cell])) {
                continue;
            }
            for (int face = 0; face < GRID_FACES; face++) {
                int other = ilsai_grid_neighbour(g, i, j, face);
                beside_tip |= other < 0 || !ilsai_is_channel(kind[other]);
            }
            kind[cell] = beside_tip ? ILSA_CELL_SURVEY : ILSA_CELL_CHANNEL;
        }
    }
}

double ilsai_fracture_closure_width(const fracture *f, const model *m) {
    return m->options.closure_width > 0 ? m->options.closure_width : ILSAI_CLOSURE * f->width_most;
}

static int count_channel(const fracture *f, const model *m, bool closed) {
    const box *b = &f->footprint;
    double closure = ilsai_fracture_closure_width(f, m);
    int count = 0;
    for (int j = b->y0; j <= b->y1; j++) {
        for (int i = b->x0; i <= b->x1; i++) {
            int cell = j * m->mesh.nx + i;
            count += ilsai_is_channel(f->cells.kind[cell]) &&
                     ilsai_contact_closed(f->cells.width[cell], closure) == closed;
        }
    }
    return count;
}

int ilsai_fracture_open_cells(const fracture *f, const model *m) {
    return count_channel(f, m, false);
}

int ilsai_fracture_closed_cells(const fracture *f, const model *m) {
    return count_channel(f, m, true);
}
