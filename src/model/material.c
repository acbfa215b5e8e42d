#include "model/material.h"

#include "base/memory.h"
#include "base/tuning.h"
#include <math.h>

ilsa_material_def ilsa_material_def_default(void) {
    return (ilsa_material_def){0};
}

ilsa_status ilsai_material_check(const ilsa_material_def *def, error_text *error) {
    ilsa_status status = ilsai_check_positive(error, "E_prime", def->E_prime);
    if (!status)
        status = ilsai_check_not_negative(error, "mu_prime", def->mu_prime);
    if (!status)
        status = ilsai_check_not_negative(error, "K_prime", def->K_prime);
    if (!status && def->mu_prime == 0 && def->K_prime == 0)
        status = ilsai_fail(error, ILSA_ERR_VALUE,
                            "mu_prime = 0: must be > 0 where K_prime = 0, nothing holds the front");
    if (!status)
        status = ilsai_check_not_negative(error, "C_prime", def->C_prime);
    return status;
}

static ilsa_status check_rock(const ilsa_rock *rock, error_text *error) {
    ilsa_status status = ilsai_check_positive(error, "E", rock->E);
    if (!status && !(rock->nu >= 0 && rock->nu <= 0.5))
        status = ilsai_fail(error, ILSA_ERR_VALUE, "nu = %g: must be 0 .. 0.5", rock->nu);
    if (!status)
        status = ilsai_check_not_negative(error, "mu", rock->mu);
    if (!status)
        status = ilsai_check_not_negative(error, "K_Ic", rock->K_Ic);
    if (!status)
        status = ilsai_check_not_negative(error, "C_L", rock->C_L);
    return status;
}

ilsa_status ilsa_material_def_from_rock(const ilsa_rock *rock, ilsa_material_def *def) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "rock", rock);
    if (!status)
        status = ilsai_check_pointer(error, "def", def);
    if (!status)
        status = check_rock(rock, error);
    if (status)
        return status;
    const double pi = 3.14159265358979323846;
    ilsa_material_def scaled = {
        .E_prime = rock->E / (1 - rock->nu * rock->nu),
        .mu_prime = 12 * rock->mu,
        .K_prime = 4 * sqrt(2 / pi) * rock->K_Ic,
        .C_prime = 2 * rock->C_L,
    };
    /* A finite rock may still overflow. */
    status = ilsai_material_check(&scaled, error);
    if (!status)
        *def = scaled;
    return status;
}

/* Products of the parameters and what a solver adds stay in the double range. */
static ilsa_status check_magnitudes(const ilsa_material_def *def, error_text *error) {
    const double most = ILSAI_MAGNITUDE_MOST, least = ILSAI_MAGNITUDE_LEAST;
    ILSAI_TRY(ilsai_check_range(error, "E_prime", def->E_prime, least, most));
    if (def->mu_prime != 0) {
        ILSAI_TRY(ilsai_check_range(error, "mu_prime", def->mu_prime, least, most));
    }
    ILSAI_TRY(ilsai_check_range(error, "K_prime", def->K_prime, 0, most));
    return ilsai_check_range(error, "C_prime", def->C_prime, 0, most);
}

ilsa_status ilsa_material_create(const ilsa_material_def *def, ilsa_material **material) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "material", material);
    if (status)
        return status;
    *material = NULL;
    status = ilsai_check_pointer(error, "def", def);
    if (!status)
        status = ilsai_material_check(def, error);
    if (!status)
        status = check_magnitudes(def, error);
    if (status)
        return status;
    ilsa_material *made = ilsai_allocate(1, sizeof *made);
    if (!made)
        return ilsai_fail(error, ILSA_ERR_MEMORY, "no memory for a material");
    made->def = *def;
    *material = made;
    return ILSA_OK;
}

void ilsa_material_destroy(ilsa_material **material) {
    if (!material)
        return;
    ilsai_release(*material);
    *material = NULL;
}

ilsa_status ilsa_material_get_def(const ilsa_material *material, ilsa_material_def *def) {
    error_text *error = ilsai_thread_error();
    ILSAI_TRY(ilsai_check_pointer(error, "material", material));
    ILSAI_TRY(ilsai_check_pointer(error, "def", def));
    *def = material->def;
    return ILSA_OK;
}
