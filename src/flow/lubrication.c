#include "flow/lubrication.h"

#include "base/memory.h"

ilsa_status ilsai_lubrication_reserve(lubrication *l, int count) {
    const grown_array arrays[] = {{&l->flux, GRID_FACES * sizeof *l->flux},
                                  {&l->by_pressure, GRID_FACES * sizeof *l->by_pressure},
                                  {&l->by_width, GRID_FACES * sizeof *l->by_width},
                                  {&l->by_width_across, GRID_FACES * sizeof *l->by_width_across},
                                  ILSAI_GROWN(l->by_own_width)};
    return ilsai_grow((size_t)count, &l->capacity, arrays, sizeof arrays / sizeof *arrays);
}

void ilsai_lubrication_destroy(lubrication *l) {
    ilsai_release(l->flux);
    ilsai_release(l->by_pressure);
    ilsai_release(l->by_width);
    ilsai_release(l->by_width_across);
    ilsai_release(l->by_own_width);
}
