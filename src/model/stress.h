/* The far-field stress as the library sees it: a field over the plane of the fracture. */
#ifndef ILSAI_STRESS_H
#define ILSAI_STRESS_H

#include "model/cell_field.h"
#include <ilsa/stress.h>

struct ilsa_stress {
    cell_field field;
};

#endif
