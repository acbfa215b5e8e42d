#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Elements of room beyond the half that a growing array takes more than it is asked for. */
#define MEMORY_MORE 16

static size_t bytes_of(size_t count, size_t size) {
    size_t bytes = count > 0 && size > SIZE_MAX / count ? SIZE_MAX : count * size;
    return bytes > 0 ? bytes : 1;
}

void *ilsai_allocate(size_t count, size_t size) {
    return malloc(bytes_of(count, size));
}

void *ilsai_allocate_zeroed(size_t count, size_t size) {
    return calloc(1, bytes_of(count, size));
}

void ilsai_release(void *memory) {
    free(memory);
}

ilsa_status ilsai_grow(size_t count, size_t *capacity, const grown_array *arrays, size_t number) {
    if (count <= *capacity) {
        return ILSA_OK;
    }
    size_t more = count / 2 + MEMORY_MORE;
    size_t room = count <= SIZE_MAX - more ? count + more : SIZE_MAX;
    for (size_t k = 0; k < number; k++) {
        void *old, *fresh;
        memcpy(&old, arrays[k].pointer, sizeof old);
        fresh = realloc(old, bytes_of(room, arrays[k].size));
        if (!fresh) {
            return ILSA_ERR_MEMORY;
        }
        memcpy(arrays[k].pointer, &fresh, sizeof fresh);
    }
    *capacity = room;
    return ILSA_OK;
}
