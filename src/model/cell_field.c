#include "model/cell_field.h"

#include "base/memory.h"
#include "base/tuning.h"
#include "model/mesh.h"
#include <math.h>
#include <string.h>

static size_t value_count(const cell_field *f) {
    switch (f->kind) {
    case FIELD_LAYERS:
        return 2 * (size_t)f->interfaces + 1;
    case FIELD_CELLS:
        return ilsai_mesh_cells(&f->mesh);
    default:
        return 0;
    }
}

void ilsai_cell_field_clear(cell_field *f) {
    ilsai_release(f->values);
    *f = (cell_field){0};
}

/* ---- Setting ------------------------------------------------------------------------------ */

static ilsa_status check_values(error_text *error, const char *name, const double *values,
                                size_t count) {
    for (size_t n = 0; n < count; n++) {
        if (!isfinite(values[n])) {
            return ilsai_fail(error, ILSA_ERR_VALUE, "%s[%zu] = %g: must be finite", name, n,
                              values[n]);
        }
    }
    return ILSA_OK;
}

static ilsa_status check_increasing(error_text *error, const double *y, size_t count) {
    for (size_t n = 1; n < count; n++) {
        if (!(y[n - 1] < y[n])) {
            return ilsai_fail(error, ILSA_ERR_VALUE, "y[%zu] = %g: must be above y[%zu] = %g", n,
                              y[n], n - 1, y[n - 1]);
        }
    }
    return ILSA_OK;
}

static ilsa_status check_layers(error_text *error, const char *name, int interfaces,
                                const double *y, const double *values) {
    if (interfaces < 1) {
        return ilsai_fail(error, ILSA_ERR_VALUE, "interface_count = %d: must be >= 1", interfaces);
    }
    ILSAI_TRY(check_values(error, "y", y, (size_t)interfaces));
    ILSAI_TRY(check_increasing(error, y, (size_t)interfaces));
    return check_values(error, name, values, (size_t)interfaces + 1);
}

/* Gives *f the content of another field, and the values that stand in two parts at any address. */
static ilsa_status take(cell_field *f, cell_field content, const void *first, size_t first_count,
                        const void *rest) {
    size_t count = value_count(&content);
    content.values = NULL;
    if (count > 0) {
        content.values = ilsai_allocate(count, sizeof *content.values);
        if (!content.values) {
            return ilsai_fail(ilsai_thread_error(), ILSA_ERR_MEMORY, "no memory for a field");
        }
        if (first_count > 0) {
            memcpy(content.values, first, first_count * sizeof *content.values);
        }
        memcpy(content.values + first_count, rest, (count - first_count) * sizeof *content.values);
    }
    ilsai_cell_field_clear(f);
    *f = content;
    return ILSA_OK;
}

ilsa_status ilsai_cell_field_set_uniform(cell_field *f, const char *name, double value) {
    ILSAI_TRY(ilsai_check_finite(ilsai_thread_error(), name, value));
    ilsai_cell_field_clear(f);
    f->uniform = value;
    return ILSA_OK;
}

ilsa_status ilsai_cell_field_set_layers(cell_field *f, const char *name, int interfaces,
                                        const double *y, const double *values) {
    ILSAI_TRY(check_layers(ilsai_thread_error(), name, interfaces, y, values));
    return take(f, (cell_field){.kind = FIELD_LAYERS, .interfaces = interfaces}, y,
                (size_t)interfaces, values);
}

ilsa_status ilsai_cell_field_set_cells(cell_field *f, const char *name, const ilsa_mesh_def *mesh,
                                       const double *values) {
    ILSAI_TRY(check_values(ilsai_thread_error(), name, values, ilsai_mesh_cells(mesh)));
    return take(f, (cell_field){.kind = FIELD_CELLS, .mesh = *mesh}, values, 0, values);
}

ilsa_status ilsai_cell_field_copy(const cell_field *from, cell_field *copy) {
    *copy = (cell_field){0};
    return take(copy, *from, from->values, 0, from->values);
}

/* ---- Values on a mesh --------------------------------------------------------------------- */

static bool any_differs(const double *values, size_t count) {
    for (size_t n = 1; n < count; n++) {
        if (values[n] != values[0])
            return true;
    }
    return false;
}

bool ilsai_cell_field_varies(const cell_field *f) {
    switch (f->kind) {
    case FIELD_LAYERS:
        return any_differs(f->values + f->interfaces, (size_t)f->interfaces + 1);
    case FIELD_CELLS:
        return any_differs(f->values, value_count(f));
    default:
        return false;
    }
}

/* The lowest layer that reaches above y0: layers are cut at y[0] < y[1] < ... */
static int first_layer(const cell_field *f, double y0) {
    int low = 0, high = f->interfaces;
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (f->values[middle] > y0) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

double ilsai_cell_field_layer(const cell_field *f, double y) {
    if (f->kind != FIELD_LAYERS) {
        return INFINITY;
    }
    const double *interface_y = f->values, *value = interface_y + f->interfaces;
    int first = first_layer(f, y), last = first;
    while (first > 0 && value[first - 1] == value[first]) {
        first--;
    }
    while (last < f->interfaces && value[last + 1] == value[last]) {
        last++;
    }
    return first > 0 && last < f->interfaces ? interface_y[last] - interface_y[first - 1]
                                             : INFINITY;
}

/*
 * Mean of the layers over y0 .. y1. Summed outwards from the origin, so that mirrored layers give
 * the same bits in mirrored cells; a cell in one layer takes its value as it stands.
 */
static double layer_mean(const cell_field *f, double y0, double y1) {
    const double *y = f->values, *values = y + f->interfaces;
    int first = first_layer(f, y0), last = first;
    while (last < f->interfaces && y[last] < y1) {
        last++;
    }
    if (first == last) {
        return values[first];
    }
    double mean = 0;
    for (int n = 0; n <= last - first; n++) {
        int k = y0 + y1 < 0 ? last - n : first + n;
        double bottom = k == first ? y0 : y[k - 1], top = k == last ? y1 : y[k];
        mean += (top - bottom) / (y1 - y0) * values[k];
    }
    return mean;
}

static void fill_row(double *row, int count, double value) {
    for (int i = 0; i < count; i++) {
        row[i] = value;
    }
}

/* The largest magnitude of the field. */
static double largest(const cell_field *f) {
    double most = fabs(f->uniform);
    for (size_t k = (size_t)f->interfaces; k < value_count(f); k++) {
        most = fmax(most, fabs(f->values[k]));
    }
    return most;
}

ilsa_status ilsai_cell_field_fill(const cell_field *f, const char *name, const ilsa_mesh_def *mesh,
                                  double *out) {
    error_text *error = ilsai_thread_error();
    if (f->kind == FIELD_CELLS && !ilsai_mesh_same(&f->mesh, mesh)) {
        return ilsai_fail(error, ILSA_ERR_MISMATCH,
                          "%s is per cell of a mesh of %d x %d cells of %g x %g: the mesh here "
                          "has %d x %d of %g x %g",
                          name, f->mesh.nx, f->mesh.ny, f->mesh.dx, f->mesh.dy, mesh->nx, mesh->ny,
                          mesh->dx, mesh->dy);
    }
    double most = largest(f);
    if (!(most <= ILSAI_MAGNITUDE_MOST)) {
        return ilsai_fail(error, ILSA_ERR_VALUE, "largest %s = %g: must be 0 .. %g", name, most,
                          ILSAI_MAGNITUDE_MOST);
    }
    if (f->kind == FIELD_CELLS) {
        memcpy(out, f->values, value_count(f) * sizeof *out);
        return ILSA_OK;
    }
    for (int j = 0; j < mesh->ny; j++) {
        double value = f->uniform;
        if (f->kind == FIELD_LAYERS) {
            value = layer_mean(f, ilsai_mesh_edge(mesh->ny, mesh->dy, j),
                               ilsai_mesh_edge(mesh->ny, mesh->dy, j + 1));
        }
        fill_row(out + (size_t)j * (size_t)mesh->nx, mesh->nx, value);
    }
    return ILSA_OK;
}

/* ---- Coarsening and growth
 * --------------------------------------------------------------------------- */

/* One line of equally spaced values in memory. */
typedef struct line {
    const double *value;
    size_t step;
    int count;
} line;

static double at(line old, int i) {
    return old.value[(size_t)(i < 0 ? 0 : i >= old.count ? old.count - 1 : i) * old.step];
}

/*
 * Mean over new cell i, twice as large. An even count: it covers two cells. An odd one: a cell and
 * the halves of its neighbours. Cells that are not there have no weight. Every branch gives equal
 * values back exactly, and mirrored values the mirrored mean.
 */
static double coarse_mean(line old, int i) {
    int n = old.count, c = 2 * i - n / 2;
    if (n % 2 == 0) {
        return 0.5 * at(old, c) + 0.5 * at(old, c + 1);
    }
    double centre = at(old, c), below = at(old, c - 1), above = at(old, c + 1);
    if (c > 0 && c < n - 1) {
        return 0.5 * centre + (0.25 * below + 0.25 * above);
    }
    if (c == 0) {
        return centre + (above / 3 - centre / 3);
    }
    if (c == n - 1) {
        return centre + (below / 3 - centre / 3);
    }
    return centre;
}

static void coarsen_line(line old, int factor, double *new_value) {
    for (int i = 0; i < old.count; i++) {
        new_value[(size_t)i * old.step] = factor == 2 ? coarse_mean(old, i) : at(old, i);
    }
}

ilsa_status ilsai_cell_field_coarsen(cell_field *f, int factor_x, int factor_y) {
    if (f->kind != FIELD_CELLS) {
        return ILSA_OK;
    }
    int nx = f->mesh.nx, ny = f->mesh.ny;
    size_t width = (size_t)nx;
    double *along_x = ilsai_allocate(value_count(f), sizeof *along_x);
    if (!along_x) {
        return ILSA_ERR_MEMORY;
    }
    for (size_t j = 0; j < (size_t)ny; j++) {
        coarsen_line((line){f->values + j * width, 1, nx}, factor_x, along_x + j * width);
    }
    for (size_t i = 0; i < width; i++) {
        coarsen_line((line){along_x + i, width, ny}, factor_y, f->values + i);
    }
    ilsai_release(along_x);
    f->mesh.dx *= factor_x;
    f->mesh.dy *= factor_y;
    return ILSA_OK;
}

ilsa_status ilsai_cell_field_grow(cell_field *f, int columns, int rows) {
    if (f->kind != FIELD_CELLS) {
        return ILSA_OK;
    }
    const ilsa_mesh_def old = f->mesh, mesh = ilsai_mesh_grown(&old, columns, rows);
    double *values = ilsai_allocate(ilsai_mesh_cells(&mesh), sizeof *values);
    if (!values) {
        return ILSA_ERR_MEMORY;
    }
    for (int j = 0; j < mesh.ny; j++) {
        size_t from = (size_t)(j < rows ? 0 : j - rows < old.ny ? j - rows : old.ny - 1);
        line row = {f->values + from * (size_t)old.nx, 1, old.nx};
        for (int i = 0; i < mesh.nx; i++) {
            values[(size_t)j * (size_t)mesh.nx + (size_t)i] = at(row, i - columns);
        }
    }
    ilsai_release(f->values);
    f->values = values;
    f->mesh = mesh;
    return ILSA_OK;
}

/* ---- In a snapshot ------------------------------------------------------------------------ */

typedef struct flat_head {
    int kind, interfaces;
    ilsa_mesh_def mesh;
    double uniform;
} flat_head;

size_t ilsai_cell_field_flat_size(const cell_field *f) {
    return sizeof(flat_head) + value_count(f) * sizeof *f->values;
}

void ilsai_cell_field_write(const cell_field *f, unsigned char *flat) {
    flat_head head;
    memset(&head, 0, sizeof head); /* padding, if there is any, is written too */
    head.kind = (int)f->kind;
    head.interfaces = f->interfaces;
    head.mesh = f->mesh;
    head.uniform = f->uniform;
    memcpy(flat, &head, sizeof head);
    if (f->values) {
        memcpy(flat + sizeof head, f->values, value_count(f) * sizeof *f->values);
    }
}

static ilsa_status malformed(void) {
    return ilsai_fail(ilsai_thread_error(), ILSA_ERR_SNAPSHOT, "malformed field in a snapshot");
}

static bool head_is_sound(const flat_head *head) {
    switch (head->kind) {
    case FIELD_UNIFORM:
        return head->interfaces == 0 && isfinite(head->uniform);
    case FIELD_LAYERS:
        return head->interfaces >= 1;
    case FIELD_CELLS:
        return head->interfaces == 0 && ilsai_mesh_check(&head->mesh, NULL) == ILSA_OK;
    default:
        return false;
    }
}

static bool values_are_sound(const cell_field *f) {
    ilsa_status status = ILSA_OK;
    if (f->kind == FIELD_LAYERS) {
        status = check_layers(NULL, "", f->interfaces, f->values, f->values + f->interfaces);
    } else if (f->kind == FIELD_CELLS) {
        status = check_values(NULL, "", f->values, value_count(f));
    }
    return status == ILSA_OK;
}

ilsa_status ilsai_cell_field_read(const unsigned char *flat, size_t size, cell_field *f) {
    flat_head head;
    *f = (cell_field){0};
    if (size < sizeof head) {
        return malformed();
    }
    memcpy(&head, flat, sizeof head);
    if (!head_is_sound(&head)) {
        return malformed();
    }
    cell_field seen = {.kind = (cell_field_kind)head.kind,
                       .interfaces = head.interfaces,
                       .mesh = head.mesh,
                       .uniform = head.uniform};
    if ((size - sizeof head) / sizeof *seen.values < value_count(&seen)) {
        return malformed();
    }
    ILSAI_TRY(take(f, seen, flat + sizeof head, 0, flat + sizeof head));
    if (!values_are_sound(f)) {
        ilsai_cell_field_clear(f);
        return malformed();
    }
    return ILSA_OK;
}
