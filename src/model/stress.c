#include "model/stress.h"

#include "base/memory.h"
#include "model/mesh.h"

ilsa_stress_def ilsa_stress_def_default(void) {
    return (ilsa_stress_def){0};
}

ilsa_status ilsa_stress_create(const ilsa_stress_def *def, ilsa_stress **stress) {
    error_text *error = ilsai_thread_error();
    ILSAI_TRY(ilsai_check_pointer(error, "stress", stress));
    *stress = NULL;
    ILSAI_TRY(ilsai_check_pointer(error, "def", def));
    ILSAI_TRY(ilsai_check_finite(error, "sigma", def->sigma));
    ilsa_stress *made = ilsai_allocate_zeroed(1, sizeof *made);
    if (!made) {
        return ilsai_fail(error, ILSA_ERR_MEMORY, "no memory for a stress field");
    }
    made->field.uniform = def->sigma;
    *stress = made;
    return ILSA_OK;
}

void ilsa_stress_destroy(ilsa_stress **stress) {
    if (!stress || !*stress) {
        return;
    }
    ilsai_cell_field_clear(&(*stress)->field);
    ilsai_release(*stress);
    *stress = NULL;
}

ilsa_status ilsa_stress_set_uniform(ilsa_stress *stress, double sigma) {
    ILSAI_TRY(ilsai_check_pointer(ilsai_thread_error(), "stress", stress));
    return ilsai_cell_field_set_uniform(&stress->field, "sigma", sigma);
}

ilsa_status ilsa_stress_set_layers(ilsa_stress *stress, int interface_count, const double *y,
                                   const double *sigma) {
    error_text *error = ilsai_thread_error();
    ILSAI_TRY(ilsai_check_pointer(error, "stress", stress));
    ILSAI_TRY(ilsai_check_pointer(error, "y", y));
    ILSAI_TRY(ilsai_check_pointer(error, "sigma", sigma));
    return ilsai_cell_field_set_layers(&stress->field, "sigma", interface_count, y, sigma);
}

ilsa_status ilsa_stress_set_cells(ilsa_stress *stress, const ilsa_mesh *mesh, const double *sigma) {
    error_text *error = ilsai_thread_error();
    ILSAI_TRY(ilsai_check_pointer(error, "stress", stress));
    ILSAI_TRY(ilsai_check_pointer(error, "mesh", mesh));
    ILSAI_TRY(ilsai_check_pointer(error, "sigma", sigma));
    return ilsai_cell_field_set_cells(&stress->field, "sigma", &mesh->def, sigma);
}
