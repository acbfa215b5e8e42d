/* The material as the library sees it. */
#ifndef ILSAI_MATERIAL_H
#define ILSAI_MATERIAL_H

#include "base/error.h"
#include <ilsa/material.h>

struct ilsa_material {
    ilsa_material_def def;
};

/* ILSA_OK, or ILSA_ERR_VALUE and a message. */
ilsa_status ilsai_material_check(const ilsa_material_def *def, error_text *error);

#endif
