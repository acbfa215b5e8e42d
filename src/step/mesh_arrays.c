#include "step/mesh_arrays.h"

#include "base/memory.h"
#include "model/mesh.h"

ilsa_status ilsai_mesh_arrays_create(mesh_arrays *a, const ilsa_mesh_def *mesh, bool leaks) {
    size_t cells = ilsai_mesh_cells(mesh);
    *a = (mesh_arrays){0};
    ILSAI_TRY(ilsai_fields_create(&a->fracture, cells, FIELD_FRACTURE, leaks));
    ILSAI_TRY(ilsai_fields_create(&a->trial, cells, FIELD_TRIAL, leaks));
    a->coupled = ilsai_coupled_create(mesh);
    a->kind = ilsai_allocate_zeroed(cells, sizeof *a->kind);
    return a->coupled && a->kind ? ILSA_OK : ILSA_ERR_MEMORY;
}

void ilsai_mesh_arrays_destroy(mesh_arrays *a) {
    ilsai_fields_destroy(&a->fracture);
    ilsai_fields_destroy(&a->trial);
    ilsai_coupled_destroy(&a->coupled);
    ilsai_release(a->kind);
}

void ilsai_mesh_arrays_exchange(mesh_arrays *a, ilsa_solver *s) {
    mesh_arrays old = {s->fracture.cells, s->trial.cells, s->numerics.coupled, s->handed_out.kind};
    s->fracture.cells = a->fracture;
    s->trial.cells = a->trial;
    s->numerics.coupled = a->coupled;
    s->handed_out.kind = a->kind;
    *a = old;
}
