#include "flow/lubrication.h"

#include "base/memory.h"

ilsa_status ilsai_lubrication_reserve(lubrication *l, int count) {
    const grown_array arrays[] = {ILSAI_GROWN(l->flux), ILSAI_GROWN(l->by_pressure),
                                  ILSAI_GROWN(l->by_width)};
    return ilsai_grow(GRID_FACES * (size_t)count, &l->capacity, arrays,
                      sizeof arrays / sizeof *arrays);
}

void ilsai_lubrication_destroy(lubrication *l) {
    ilsai_release(l->flux);
    ilsai_release(l->by_pressure);
    ilsai_release(l->by_width);
}
