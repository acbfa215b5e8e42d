#include "model/stress.h"
#include "base/error.h"
#include "base/tuning.h"
#include "model/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Handles */

ilsa_stress_def ilsa_stress_def_default(void) {
    return (ilsa_stress_def){0};
}

static size_t value_count(const ilsa_stress *stress) {
    switch (stress->kind) {
    case STRESS_LAYERS:
        return 2 * (size_t)stress->interfaces + 1;
    case STRESS_CELLS:
        return ilsai_mesh_cells(&stress->mesh);
    default:
        return 0;
    }
}

static ilsa_status no_memory(void) {
    return ilsai_fail(ilsai_thread_error(), ILSA_ERR_MEMORY, "no memory for a stress field");
}

/* A new handle with the content given, its values copied from memory of any alignment. */
static ilsa_stress *make(ilsa_stress content, const void *values) {
    size_t bytes = value_count(&content) * sizeof *content.values;
    ilsa_stress *made = malloc(sizeof *made);
    content.values = bytes ? malloc(bytes) : NULL;
    if (!made || (bytes && !content.values)) {
        free(made);
        free(content.values);
        no_memory();
        return NULL;
    }
    if (bytes)
        memcpy(content.values, values, bytes);
    *made = content;
    return made;
}

ilsa_status ilsa_stress_create(const ilsa_stress_def *def, ilsa_stress **stress) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "stress", stress);
    if (status)
        return status;
    *stress = NULL;
    status = ilsai_check_pointer(error, "def", def);
    if (!status)
        status = ilsai_check_finite(error, "sigma", def->sigma);
    if (status)
        return status;
    *stress = make((ilsa_stress){.kind = STRESS_UNIFORM, .sigma = def->sigma}, NULL);
    return *stress ? ILSA_OK : ILSA_ERR_MEMORY;
}

void ilsa_stress_destroy(ilsa_stress **stress) {
    if (!stress || !*stress)
        return;
    free((*stress)->values);
    free(*stress);
    *stress = NULL;
}

/* Gives the handle the content of another field, whose values it takes over. */
static void take(ilsa_stress *stress, ilsa_stress content) {
    free(stress->values);
    *stress = content;
}

ilsa_status ilsa_stress_set_uniform(ilsa_stress *stress, double sigma) {
    error_text *error = ilsai_thread_error();
    ILSAI_TRY(ilsai_check_pointer(error, "stress", stress));
    ILSAI_TRY(ilsai_check_finite(error, "sigma", sigma));
    take(stress, (ilsa_stress){.kind = STRESS_UNIFORM, .sigma = sigma});
    return ILSA_OK;
}

static ilsa_status check_values(error_text *error, const char *name, const double *values,
                                size_t count) {
    for (size_t n = 0; n < count; n++)
        if (!isfinite(values[n]))
            return ilsai_fail(error, ILSA_ERR_VALUE, "%s[%zu] = %g: must be finite", name, n,
                              values[n]);
    return ILSA_OK;
}

static ilsa_status check_increasing(error_text *error, const double *y, size_t count) {
    for (size_t n = 1; n < count; n++)
        if (!(y[n - 1] < y[n]))
            return ilsai_fail(error, ILSA_ERR_VALUE, "y[%zu] = %g: must be above y[%zu] = %g", n,
                              y[n], n - 1, y[n - 1]);
    return ILSA_OK;
}

static ilsa_status check_layers(error_text *error, int interfaces, const double *y,
                                const double *sigma) {
    if (interfaces < 1)
        return ilsai_fail(error, ILSA_ERR_VALUE, "interface_count = %d: must be >= 1", interfaces);
    ILSAI_TRY(check_values(error, "y", y, (size_t)interfaces));
    ILSAI_TRY(check_increasing(error, y, (size_t)interfaces));
    return check_values(error, "sigma", sigma, (size_t)interfaces + 1);
}

ilsa_status ilsa_stress_set_layers(ilsa_stress *stress, int interface_count, const double *y,
                                   const double *sigma) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "stress", stress);
    if (!status)
        status = ilsai_check_pointer(error, "y", y);
    if (!status)
        status = ilsai_check_pointer(error, "sigma", sigma);
    if (!status)
        status = check_layers(error, interface_count, y, sigma);
    if (status)
        return status;
    size_t count = (size_t)interface_count;
    double *values = malloc((2 * count + 1) * sizeof *values);
    if (!values)
        return no_memory();
    memcpy(values, y, count * sizeof *values);
    memcpy(values + count, sigma, (count + 1) * sizeof *values);
    take(stress,
         (ilsa_stress){.kind = STRESS_LAYERS, .interfaces = interface_count, .values = values});
    return ILSA_OK;
}

ilsa_status ilsa_stress_set_cells(ilsa_stress *stress, const ilsa_mesh *mesh, const double *sigma) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "stress", stress);
    if (!status)
        status = ilsai_check_pointer(error, "mesh", mesh);
    if (!status)
        status = ilsai_check_pointer(error, "sigma", sigma);
    if (!status)
        status = check_values(error, "sigma", sigma, ilsai_mesh_cells(&mesh->def));
    if (status)
        return status;
    size_t bytes = ilsai_mesh_cells(&mesh->def) * sizeof(double);
    double *values = malloc(bytes);
    if (!values)
        return no_memory();
    memcpy(values, sigma, bytes);
    take(stress, (ilsa_stress){.kind = STRESS_CELLS, .mesh = mesh->def, .values = values});
    return ILSA_OK;
}

ilsa_status ilsai_stress_copy(const ilsa_stress *from, ilsa_stress **copy) {
    *copy = make(*from, from->values);
    return *copy ? ILSA_OK : ILSA_ERR_MEMORY;
}

/* Values on a mesh */

static int any_differs(const double *values, size_t count) {
    for (size_t n = 1; n < count; n++)
        if (values[n] != values[0])
            return 1;
    return 0;
}

int ilsai_stress_varies(const ilsa_stress *stress) {
    switch (stress->kind) {
    case STRESS_LAYERS:
        return any_differs(stress->values + stress->interfaces, (size_t)stress->interfaces + 1);
    case STRESS_CELLS:
        return any_differs(stress->values, value_count(stress));
    default:
        return 0;
    }
}

/* The lowest layer that reaches above y0: layers are cut at y[0] < y[1] < ... */
static int first_layer(const ilsa_stress *stress, double y0) {
    int low = 0, high = stress->interfaces;
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (stress->values[middle] > y0)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/*
 * Mean of the layers over y0 .. y1. Summed outwards from the origin, so that mirrored layers give
 * the same bits in mirrored cells; a cell in one layer takes its value as it stands.
 */
static double layer_mean(const ilsa_stress *stress, double y0, double y1) {
    const double *y = stress->values, *sigma = y + stress->interfaces;
    int first = first_layer(stress, y0), last = first;
    while (last < stress->interfaces && y[last] < y1)
        last++;
    if (first == last)
        return sigma[first];
    double mean = 0;
    for (int n = 0; n <= last - first; n++) {
        int k = y0 + y1 < 0 ? last - n : first + n;
        double bottom = k == first ? y0 : y[k - 1], top = k == last ? y1 : y[k];
        mean += (top - bottom) / (y1 - y0) * sigma[k];
    }
    return mean;
}

static void fill_row(double *row, int count, double value) {
    for (int i = 0; i < count; i++)
        row[i] = value;
}

/* The largest magnitude of the field. */
static double largest(const ilsa_stress *stress) {
    double most = fabs(stress->sigma);
    for (size_t k = (size_t)stress->interfaces; k < value_count(stress); k++)
        most = fmax(most, fabs(stress->values[k]));
    return most;
}

ilsa_status ilsai_stress_fill(const ilsa_stress *stress, const ilsa_mesh_def *mesh, double *sigma) {
    if (stress->kind == STRESS_CELLS && !ilsai_mesh_same(&stress->mesh, mesh))
        return ilsai_fail(ilsai_thread_error(), ILSA_ERR_MISMATCH,
                          "stress is per cell of a mesh of %d x %d cells of %g x %g: the mesh here "
                          "has %d x %d of %g x %g",
                          stress->mesh.nx, stress->mesh.ny, stress->mesh.dx, stress->mesh.dy,
                          mesh->nx, mesh->ny, mesh->dx, mesh->dy);
    ilsa_status status = ilsai_check_range(ilsai_thread_error(), "largest stress", largest(stress),
                                           0, ILSAI_MAGNITUDE_MOST);
    if (status)
        return status;
    if (stress->kind == STRESS_CELLS) {
        memcpy(sigma, stress->values, value_count(stress) * sizeof *sigma);
        return ILSA_OK;
    }
    for (int j = 0; j < mesh->ny; j++) {
        double value = stress->sigma;
        if (stress->kind == STRESS_LAYERS)
            value = layer_mean(stress, ilsai_mesh_edge(mesh->ny, mesh->dy, j),
                               ilsai_mesh_edge(mesh->ny, mesh->dy, j + 1));
        fill_row(sigma + (size_t)j * (size_t)mesh->nx, mesh->nx, value);
    }
    return ILSA_OK;
}

/* Coarsening */

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
    if (n % 2 == 0)
        return 0.5 * at(old, c) + 0.5 * at(old, c + 1);
    double centre = at(old, c), below = at(old, c - 1), above = at(old, c + 1);
    if (c > 0 && c < n - 1)
        return 0.5 * centre + (0.25 * below + 0.25 * above);
    if (c == 0)
        return centre + (above / 3 - centre / 3);
    if (c == n - 1)
        return centre + (below / 3 - centre / 3);
    return centre;
}

static void coarsen_line(line old, double *new_value) {
    for (int i = 0; i < old.count; i++)
        new_value[(size_t)i * old.step] = coarse_mean(old, i);
}

ilsa_status ilsai_stress_coarsen(ilsa_stress *stress) {
    if (stress->kind != STRESS_CELLS)
        return ILSA_OK;
    int nx = stress->mesh.nx, ny = stress->mesh.ny;
    size_t width = (size_t)nx;
    double *along_x = malloc(value_count(stress) * sizeof *along_x);
    if (!along_x)
        return no_memory();
    for (size_t j = 0; j < (size_t)ny; j++)
        coarsen_line((line){stress->values + j * width, 1, nx}, along_x + j * width);
    for (size_t i = 0; i < width; i++)
        coarsen_line((line){along_x + i, width, ny}, stress->values + i);
    free(along_x);
    stress->mesh.dx *= 2;
    stress->mesh.dy *= 2;
    return ILSA_OK;
}

/* Images */

typedef struct image_head {
    int kind, interfaces;
    ilsa_mesh_def mesh;
    double sigma;
} image_head;

size_t ilsai_stress_image_size(const ilsa_stress *stress) {
    return sizeof(image_head) + value_count(stress) * sizeof *stress->values;
}

void ilsai_stress_write(const ilsa_stress *stress, unsigned char *image) {
    image_head head;
    memset(&head, 0, sizeof head); /* padding, if there is any, is part of the image */
    head.kind = (int)stress->kind;
    head.interfaces = stress->interfaces;
    head.mesh = stress->mesh;
    head.sigma = stress->sigma;
    memcpy(image, &head, sizeof head);
    if (stress->values)
        memcpy(image + sizeof head, stress->values, value_count(stress) * sizeof *stress->values);
}

static ilsa_status malformed(void) {
    return ilsai_fail(ilsai_thread_error(), ILSA_ERR_SNAPSHOT, "malformed image of a stress field");
}

static int head_is_sound(const image_head *head) {
    switch (head->kind) {
    case STRESS_UNIFORM:
        return head->interfaces == 0 && isfinite(head->sigma);
    case STRESS_LAYERS:
        return head->interfaces >= 1;
    case STRESS_CELLS:
        return head->interfaces == 0 && ilsai_mesh_check(&head->mesh, NULL) == ILSA_OK;
    default:
        return 0;
    }
}

static int values_are_sound(const ilsa_stress *stress) {
    if (!stress->values)
        return 1;
    if (stress->kind == STRESS_LAYERS)
        return check_layers(NULL, stress->interfaces, stress->values,
                            stress->values + stress->interfaces) == ILSA_OK;
    return check_values(NULL, "sigma", stress->values, value_count(stress)) == ILSA_OK;
}

ilsa_status ilsai_stress_read(const unsigned char *image, size_t size, ilsa_stress **stress) {
    image_head head;
    *stress = NULL;
    if (size < sizeof head)
        return malformed();
    memcpy(&head, image, sizeof head);
    if (!head_is_sound(&head))
        return malformed();
    ilsa_stress seen = {.kind = (stress_kind)head.kind,
                        .interfaces = head.interfaces,
                        .mesh = head.mesh,
                        .sigma = head.sigma};
    if (size - sizeof head < value_count(&seen) * sizeof *seen.values)
        return malformed();
    ilsa_stress *made = make(seen, image + sizeof head);
    if (!made)
        return ILSA_ERR_MEMORY;
    if (!values_are_sound(made)) {
        ilsa_stress_destroy(&made);
        return malformed();
    }
    *stress = made;
    return ILSA_OK;
}
