#include "model/mesh.h"

#include "base/memory.h"
#include "base/tuning.h"

enum { CELLS_MIN = 3, CELLS_MAX = ILSAI_MESH_COUNT_MOST, CELLS_TOTAL_MAX = 1 << 28 };

ilsa_mesh_def ilsa_mesh_def_default(void) {
    return (ilsa_mesh_def){0};
}

static ilsa_status check_count(error_text *error, const char *name, int n) {
    if (n < CELLS_MIN || n > CELLS_MAX)
        return ilsai_fail(error, ILSA_ERR_VALUE, "%s = %d: must be %d .. %d", name, n,
                          (int)CELLS_MIN, (int)CELLS_MAX);
    return ILSA_OK;
}

static ilsa_status check_total(error_text *error, const ilsa_mesh_def *def) {
    if ((double)def->nx * def->ny > CELLS_TOTAL_MAX)
        return ilsai_fail(error, ILSA_ERR_VALUE, "nx ny = %d x %d: must be at most %d cells",
                          def->nx, def->ny, (int)CELLS_TOTAL_MAX);
    return ILSA_OK;
}

static ilsa_status check_aspect(error_text *error, const ilsa_mesh_def *def) {
    double aspect = def->dx / def->dy;
    if (!(aspect >= 1e-3 && aspect <= 1e3))
        return ilsai_fail(error, ILSA_ERR_VALUE, "dx / dy = %g / %g = %g: must be 1e-3 .. 1e3",
                          def->dx, def->dy, aspect);
    return ILSA_OK;
}

static ilsa_status check_size(error_text *error, const char *name, double d) {
    return ilsai_check_range(error, name, d, ILSAI_MAGNITUDE_LEAST, ILSAI_MAGNITUDE_MOST);
}

ilsa_status ilsai_mesh_check(const ilsa_mesh_def *def, error_text *error) {
    ILSAI_TRY(check_count(error, "nx", def->nx));
    ILSAI_TRY(check_count(error, "ny", def->ny));
    ILSAI_TRY(check_total(error, def));
    ILSAI_TRY(check_size(error, "dx", def->dx));
    ILSAI_TRY(check_size(error, "dy", def->dy));
    return check_aspect(error, def);
}

ilsa_status ilsa_mesh_create(const ilsa_mesh_def *def, ilsa_mesh **mesh) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "mesh", mesh);
    if (status)
        return status;
    *mesh = NULL;
    status = ilsai_check_pointer(error, "def", def);
    if (!status)
        status = ilsai_mesh_check(def, error);
    if (status)
        return status;
    ilsa_mesh *made = ilsai_allocate(1, sizeof *made);
    if (!made)
        return ilsai_fail(error, ILSA_ERR_MEMORY, "no memory for a mesh");
    made->def = *def;
    *mesh = made;
    return ILSA_OK;
}

void ilsa_mesh_destroy(ilsa_mesh **mesh) {
    if (!mesh)
        return;
    ilsai_release(*mesh);
    *mesh = NULL;
}

ilsa_status ilsa_mesh_get_def(const ilsa_mesh *mesh, ilsa_mesh_def *def) {
    error_text *error = ilsai_thread_error();
    ILSAI_TRY(ilsai_check_pointer(error, "mesh", mesh));
    ILSAI_TRY(ilsai_check_pointer(error, "def", def));
    *def = mesh->def;
    return ILSA_OK;
}
