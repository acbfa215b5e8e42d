#include "model/mesh.h"

#include <stdlib.h>

enum { CELLS_MIN = 3, CELLS_MAX = 1000000, CELLS_TOTAL_MAX = 1 << 28 };

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

ilsa_status ilsai_mesh_check(const ilsa_mesh_def *def, error_text *error) {
    ilsa_status status = check_count(error, "nx", def->nx);
    if (!status)
        status = check_count(error, "ny", def->ny);
    if (!status)
        status = check_total(error, def);
    if (!status)
        status = ilsai_check_positive(error, "dx", def->dx);
    if (!status)
        status = ilsai_check_positive(error, "dy", def->dy);
    if (!status)
        status = check_aspect(error, def);
    return status;
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
    ilsa_mesh *made = malloc(sizeof *made);
    if (!made)
        return ilsai_fail(error, ILSA_ERR_MEMORY, "no memory for a mesh");
    made->def = *def;
    *mesh = made;
    return ILSA_OK;
}

void ilsa_mesh_destroy(ilsa_mesh **mesh) {
    if (!mesh)
        return;
    free(*mesh);
    *mesh = NULL;
}

ilsa_status ilsa_mesh_get_def(const ilsa_mesh *mesh, ilsa_mesh_def *def) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "mesh", mesh);
    if (!status)
        status = ilsai_check_pointer(error, "def", def);
    if (!status)
        *def = mesh->def;
    return status;
}
