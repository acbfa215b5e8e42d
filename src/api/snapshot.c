/*
 * The snapshot of a solver: a header, the identity, the fracture, the paths through the tip cells,
 * rates, stress, and the fields of the region around the fracture.
 */
#include <ilsa/snapshot.h>

#include "api/snapshot_check.h"
#include "base/memory.h"
#include "base/tuning.h"
#include "model/mesh.h"
#include "model/options.h"
#include "step/mesh_arrays.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

#define SNAPSHOT_MAGIC "ilsasnap"
enum { SNAPSHOT_LAYOUT = 5 };

typedef struct header {
    char magic[8];
    uint32_t layout, version;
    uint64_t size;     /* of the whole snapshot */
    uint64_t checksum; /* of all that follows the header */
} header;

/* What a solver must share with the one that the snapshot was taken of. */
typedef struct identity {
    ilsa_mesh_def mesh; /* of the definition */
    int source_count, none;
    ilsa_material_def material;
    double option[OPTION_COUNT]; /* in force; 0 where it need not be shared */
} identity;

/* Copies to or from the snapshot, or only counts, depending on the pass. */
typedef struct stream {
    unsigned char *out;
    const unsigned char *in;
    size_t at, size;
    bool failed;
} stream;

static void pass(stream *io, void *data, size_t size) {
    if (io->failed || size > io->size - io->at) {
        io->failed = true;
        return;
    }
    if (io->out) {
        memcpy(io->out + io->at, data, size);
    } else if (io->in) {
        memcpy(data, io->in + io->at, size);
    }
    io->at += size;
}

/* FNV-1a over 8-byte words, the tail by bytes. */
static uint64_t checksum(const unsigned char *data, size_t size) {
    uint64_t hash = 14695981039346656037u, word;
    size_t k = 0;
    for (; k + sizeof word <= size; k += sizeof word) {
        memcpy(&word, data + k, sizeof word);
        hash = (hash ^ word) * 1099511628211u;
        hash ^= hash >> 29;
    }
    for (; k < size; k++) {
        hash = (hash ^ data[k]) * 1099511628211u;
    }
    return hash;
}

/* Every byte of what is written is defined, padding included. */
static identity identify(const ilsa_solver *s) {
    const model *m = &s->model;
    identity id;
    memset(&id, 0, sizeof id);
    id.mesh = m->defined;
    id.source_count = m->sources.count;
    id.material = m->material;
    id.material.mu_prime = m->inviscid ? 0 : m->material.mu_prime;
    for (int k = 0; k < OPTION_COUNT; k++) {
        id.option[k] = ilsai_option_is_kept(k) ? ilsai_option(&m->options, k) : 0;
    }
    id.option[OPTION_step_cells] = s->numerics.step_cells;
    id.option[OPTION_tolerance] = s->numerics.tolerance;
    return id;
}

static bool same_definition(const identity *a, const identity *b) {
    /* Copies of the same bits are meant, and every byte is defined. */
    /* NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c) */
    return memcmp(a, b, sizeof *a) == 0;
}

/* Whether coarsening makes a size of cells from that of the definition: it doubles it. */
static bool is_coarsened(double now, double defined) {
    int times;
    return frexp(now / defined, &times) == 0.5 && times > 0;
}

/* Whether every source is on a mesh, which may have lost cells. */
static bool has_sources(const ilsa_mesh_def *mesh, const sources *s) {
    bool all = true;
    for (int k = 0; k < s->count; k++) {
        all = all && ilsai_source_check(mesh, &s->at[k].def, NULL) == ILSA_OK;
    }
    return all;
}

/* Whether coarsening and growth can have made a mesh from that of a model's definition. */
static bool is_mesh_of(const ilsa_mesh_def *now, const model *m) {
    return ilsai_mesh_check(now, NULL) == ILSA_OK && (now->nx - m->defined.nx) % 2 == 0 &&
           (now->ny - m->defined.ny) % 2 == 0 && has_sources(now, &m->sources) &&
           is_coarsened(now->dx, m->defined.dx) && is_coarsened(now->dy, m->defined.dy) &&
           (double)ilsai_mesh_cells(now) <= ilsai_model_cells_max(m);
}

/* Flags that are none, as a bool must not be read from any byte, fail. */
static void pass_flags(stream *io, fracture *f) {
    uint32_t flags = (uint32_t)f->started | (uint32_t)f->mirror_x << 1 | (uint32_t)f->mirror_y << 2;
    pass(io, &flags, sizeof flags);
    io->failed |= flags > 7 || !(flags & 1);
    f->started = flags & 1;
    f->mirror_x = flags >> 1 & 1;
    f->mirror_y = flags >> 2 & 1;
}

/* The fracture but for its fields and paths, and the longest step allowed. */
static void pass_fracture(stream *io, fracture *f, pace *p) {
    double *numbers[] = {&f->mu_prime,     &f->time,          &f->dt,        &f->injected,
                         &f->leaked,       &f->volume,        &f->leak_rate, &f->width_most,
                         &f->front_change, &f->front_advance, &p->dt_limit};
    int *counts[] = {&f->footprint.x0, &f->footprint.x1, &f->footprint.y0, &f->footprint.y1,
                     &f->unknowns};
    pass_flags(io, f);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        pass(io, numbers[k], sizeof *numbers[k]);
    }
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        pass(io, counts[k], sizeof *counts[k]);
    }
}

/* The fields of a box of the mesh, in the order of the table. */
static void pass_fields(stream *io, const model *m, const box *b, const fields *f) {
    for (int row = 0; row < FIELD_COUNT; row++) {
        if (!ilsai_snapshot_has(row, ilsai_model_leaks(m))) {
            continue;
        }
        char *array = ilsai_field(f, row);
        size_t size = ilsai_field_rows[row].size;
        for (int j = b->y0; j <= b->y1; j++) {
            size_t at = ((size_t)j * (size_t)m->mesh.nx + (size_t)b->x0) * size;
            pass(io, array + at, ilsai_box_columns(b) * size);
        }
    }
}

/* Knots that are not in use are written as zero. */
static void pass_path(stream *io, tip_path *path) {
    tip_path packed;
    memset(&packed, 0, sizeof packed);
    packed.cell = path->cell;
    packed.history.count = path->history.count;
    for (int k = 0; k < path->history.count; k++) {
        packed.history.t[k] = path->history.t[k];
        packed.history.ell[k] = path->history.ell[k];
    }
    pass(io, &packed, sizeof packed);
    *path = packed;
}

static void write_stress(stream *io, const ilsa_solver *s) {
    size_t size = ilsai_cell_field_flat_size(&s->model.stress);
    uint64_t length = size;
    pass(io, &length, sizeof length);
    if (io->out && !io->failed && size <= io->size - io->at) {
        ilsai_cell_field_write(&s->model.stress, io->out + io->at);
    }
    io->failed |= size > io->size - io->at;
    io->at += io->failed ? 0 : size;
}

/* Everything after the header, in the order in which it is read. */
static void write_body(stream *io, const ilsa_solver *s) {
    identity id = identify(s);
    fracture f = s->fracture;
    pace p = s->pace;
    box region = ilsai_fracture_region(&s->model.mesh, &f.footprint);
    int32_t paths = f.paths.count;
    ilsa_mesh_def mesh = s->model.mesh;
    pass(io, &id, sizeof id);
    pass(io, &mesh, sizeof mesh);
    pass_fracture(io, &f, &p);
    for (int k = 0; k < s->model.sources.count; k++) {
        ilsa_source_def def = s->model.sources.at[k].def;
        pass(io, &def, sizeof def);
    }
    write_stress(io, s);
    pass(io, &paths, sizeof paths);
    for (int k = 0; k < f.paths.count; k++) {
        tip_path path = f.paths.at[k];
        pass_path(io, &path);
    }
    pass_fields(io, &s->model, &region, &f.cells);
}

static ilsa_status save(const ilsa_solver *solver, void *buffer, size_t *size) {
    error_text *error = ilsai_thread_error();
    ILSAI_TRY(ilsai_check_pointer(error, "solver", solver));
    ILSAI_TRY(ilsai_check_pointer(error, "size", size));
    ILSAI_TRY(ilsai_fracture_check(&solver->fracture, error));
    stream count = {.at = sizeof(header), .size = SIZE_MAX};
    write_body(&count, solver);
    size_t room = *size;
    *size = count.at;
    if (!buffer) {
        return ILSA_OK;
    }
    if (room < count.at) {
        return ilsai_fail(error, ILSA_NO_SPACE, "the buffer has %zu bytes: must have %zu", room,
                          count.at);
    }
    stream io = {.out = buffer, .at = sizeof(header), .size = count.at};
    write_body(&io, solver);
    header head = {
        .layout = SNAPSHOT_LAYOUT, .version = (uint32_t)ilsa_version_number(), .size = count.at};
    memcpy(head.magic, SNAPSHOT_MAGIC, sizeof head.magic);
    head.checksum = checksum(io.out + sizeof head, count.at - sizeof head);
    memcpy(buffer, &head, sizeof head);
    return ILSA_OK;
}

ilsa_status ilsa_snapshot_save(const ilsa_solver *solver, void *buffer, size_t *size) {
    return ilsai_fail_reading(save(solver, buffer, size));
}

static ilsa_status check_header(ilsa_solver *s, const unsigned char *image, size_t size) {
    header head;
    if (size < sizeof head) {
        return ilsai_fail(&s->error, ILSA_ERR_SNAPSHOT, "a snapshot of %zu bytes is truncated",
                          size);
    }
    memcpy(&head, image, sizeof head);
    if (memcmp(head.magic, SNAPSHOT_MAGIC, sizeof head.magic) != 0) {
        return ilsai_fail(&s->error, ILSA_ERR_SNAPSHOT, "this is not a snapshot of a solver");
    }
    if (head.layout != SNAPSHOT_LAYOUT || head.version != (uint32_t)ilsa_version_number()) {
        return ilsai_fail(&s->error, ILSA_ERR_SNAPSHOT,
                          "the snapshot is of version %u, layout %u: must be %d, %d",
                          (unsigned)head.version, (unsigned)head.layout, ilsa_version_number(),
                          SNAPSHOT_LAYOUT);
    }
    if (head.size != size || head.checksum != checksum(image + sizeof head, size - sizeof head)) {
        return ilsai_fail(&s->error, ILSA_ERR_SNAPSHOT, "the snapshot is truncated or altered");
    }
    return ILSA_OK;
}

/* What is read, or made for it, before the solver is touched. */
typedef struct incoming {
    fracture fracture; /* without fields */
    pace pace;
    ilsa_source_def *sources;
    model model;         /* the solver's, with mesh, stress and sigma of the snapshot */
    elasticity *elastic; /* for another cell size, NULL where it is the solver's */
    mesh_arrays arrays;  /* for other counts of cells, nothing where they are the solver's */
} incoming;

static void release(incoming *from) {
    ilsai_tip_paths_destroy(&from->fracture.paths);
    ilsai_release(from->sources);
    ilsai_cell_field_clear(&from->model.stress);
    ilsai_release(from->model.sigma);
    ilsai_elasticity_destroy(&from->elastic);
    ilsai_mesh_arrays_destroy(&from->arrays);
}

/* Rates change, places do not. */
static ilsa_status read_sources(stream *io, const sources *own, incoming *from) {
    size_t count = (size_t)own->count;
    from->sources = ilsai_allocate_zeroed(count, sizeof *from->sources);
    if (!from->sources) {
        return ILSA_ERR_MEMORY;
    }
    pass(io, from->sources, count * sizeof *from->sources);
    for (int k = 0; k < own->count && !io->failed; k++) {
        const ilsa_source_def *def = &own->at[k].def, *seen = &from->sources[k];
        if (seen->x != def->x || seen->y != def->y) {
            return ILSA_ERR_MISMATCH;
        }
        if (!(seen->rate >= 0 && seen->rate <= ILSAI_MAGNITUDE_MOST)) {
            return ILSA_ERR_SNAPSHOT;
        }
    }
    return ILSA_OK;
}

static ilsa_status read_stress(stream *io, incoming *from) {
    uint64_t length = 0;
    pass(io, &length, sizeof length);
    if (io->failed || length > io->size - io->at) {
        return ILSA_ERR_SNAPSHOT;
    }
    ilsa_status status =
        ilsai_cell_field_read(io->in + io->at, (size_t)length, &from->model.stress);
    io->at += (size_t)length;
    return status;
}

static ilsa_status read_paths(stream *io, incoming *from) {
    tip_paths *paths = &from->fracture.paths;
    int32_t count = 0;
    pass(io, &count, sizeof count);
    size_t left = io->size - io->at, cells = ilsai_mesh_cells(&from->model.mesh);
    if (io->failed || count < 0 || (size_t)count > left / sizeof(tip_path)) {
        return ILSA_ERR_SNAPSHOT;
    }
    ILSAI_TRY(ilsai_tip_paths_reserve(paths, count));
    for (paths->count = 0; paths->count < count; paths->count++) {
        tip_path *path = &paths->at[paths->count];
        memcpy(path, io->in + io->at, sizeof *path);
        io->at += sizeof *path;
        int after = paths->count > 0 ? path[-1].cell : -1;
        if (path->cell <= after ||
            !ilsai_snapshot_path_is_sound(path, cells, from->fracture.time)) {
            return ILSA_ERR_SNAPSHOT;
        }
    }
    return ILSA_OK;
}

/* Whether it is the material's viscosity, or where that has none one that can stand for it. */
static bool is_viscosity(const model *m, double mu_prime) {
    return m->inviscid ? isfinite(mu_prime) && mu_prime > 0 : mu_prime == m->material.mu_prime;
}

/* Reads all but the fields; *io is left at them. */
static ilsa_status read_head(stream *io, const ilsa_solver *s, incoming *from) {
    identity id, own = identify(s);
    pass(io, &id, sizeof id);
    if (io->failed) {
        return ILSA_ERR_SNAPSHOT;
    }
    if (!same_definition(&id, &own)) {
        return ILSA_ERR_MISMATCH;
    }
    from->model = s->model;
    from->model.stress = (cell_field){0};
    from->model.sigma = NULL;
    pass(io, &from->model.mesh, sizeof from->model.mesh);
    if (io->failed || !is_mesh_of(&from->model.mesh, &s->model)) {
        return ILSA_ERR_SNAPSHOT;
    }
    pass_fracture(io, &from->fracture, &from->pace);
    if (io->failed || !(from->pace.dt_limit > 0) ||
        !ilsai_snapshot_fracture_is_sound(&from->fracture, &from->model.mesh) ||
        !is_viscosity(&s->model, from->fracture.mu_prime)) {
        return ILSA_ERR_SNAPSHOT;
    }
    ILSAI_TRY(read_sources(io, &s->model.sources, from));
    ILSAI_TRY(read_stress(io, from));
    return read_paths(io, from);
}

/* The fields of the snapshot must fill what is left of it exactly, and be those of a fracture. */
static bool fields_fit(const stream *io, const incoming *from, const box *region) {
    bool leaks = ilsai_model_leaks(&from->model);
    snapshot_fields seen = {io->in + io->at, *region, from->fracture.footprint, leaks};
    size_t bytes = 0;
    for (int row = 0; row < FIELD_COUNT; row++) {
        bytes += ilsai_snapshot_has(row, leaks) ? ilsai_field_rows[row].size : 0;
    }
    return io->size - io->at == ilsai_box_columns(region) * ilsai_box_rows(region) * bytes &&
           ilsai_snapshot_fields_are_sound(&seen);
}

/* Makes what the solver needs for the mesh and the stress of the snapshot. */
static ilsa_status prepare(const ilsa_solver *s, incoming *from) {
    const ilsa_mesh_def *mesh = &from->model.mesh;
    from->model.sigma = ilsai_allocate(ilsai_mesh_cells(mesh), sizeof *from->model.sigma);
    if (!from->model.sigma) {
        return ILSA_ERR_MEMORY;
    }
    if (ilsai_model_fill_stress(&from->model) != ILSA_OK) {
        return ILSA_ERR_SNAPSHOT; /* a stress per cell of another mesh, or beyond any */
    }
    if (mesh->nx != s->model.mesh.nx || mesh->ny != s->model.mesh.ny) {
        ILSAI_TRY(ilsai_mesh_arrays_create(&from->arrays, mesh, ilsai_model_leaks(&s->model)));
    }
    if (mesh->dx == s->model.mesh.dx && mesh->dy == s->model.mesh.dy) {
        return ILSA_OK;
    }
    return ilsai_elasticity_create(s->model.material.E_prime, mesh->dx, mesh->dy,
                                   s->model.options.product, &from->elastic);
}

/* Takes over what was read and made; the solver's own goes to `from` to be released. */
static void adopt(ilsa_solver *s, incoming *from, const box *region, stream *io) {
    model old_model = s->model;
    tip_paths old_paths = s->fracture.paths;
    ilsai_fracture_clear(&s->fracture, &s->model.mesh);
    if (from->elastic) {
        elasticity *old_elastic = s->numerics.elastic;
        s->numerics.elastic = from->elastic;
        from->elastic = old_elastic;
    }
    if (from->arrays.coupled) {
        ilsai_mesh_arrays_exchange(&from->arrays, s);
    }
    from->fracture.cells = s->fracture.cells;
    s->fracture = from->fracture;
    s->pace.dt_limit = from->pace.dt_limit;
    s->model = from->model;
    ilsai_model_set_viscosity(&s->model, s->fracture.mu_prime);
    for (int k = 0; k < s->model.sources.count; k++) {
        s->model.sources.at[k].def.rate = from->sources[k].rate;
    }
    ilsai_sources_place(&s->model.sources, &s->model.mesh);
    pass_fields(io, &s->model, region, &s->fracture.cells);
    from->fracture.paths = old_paths;
    from->model = old_model;
}

static ilsa_status restore(ilsa_solver *s, stream *io, incoming *from) {
    ILSAI_TRY(read_head(io, s, from));
    box region = ilsai_fracture_region(&from->model.mesh, &from->fracture.footprint);
    if (!fields_fit(io, from, &region)) {
        return ILSA_ERR_SNAPSHOT;
    }
    ILSAI_TRY(prepare(s, from));
    adopt(s, from, &region, io);
    return ILSA_OK;
}

ilsa_status ilsa_snapshot_restore(ilsa_solver *solver, const void *buffer, size_t size) {
    if (!solver || !buffer) {
        error_text *error = solver ? &solver->error : ilsai_thread_error();
        return ilsai_check_pointer(error, solver ? "buffer" : "solver", NULL);
    }
    ILSAI_TRY(check_header(solver, buffer, size));
    incoming from = {0};
    stream io = {.in = buffer, .at = sizeof(header), .size = size};
    ilsa_status status = restore(solver, &io, &from);
    release(&from);
    return status == ILSA_OK ? ILSA_OK
           : status == ILSA_ERR_MISMATCH
               ? ilsai_fail(&solver->error, status,
                            "the snapshot is of a solver with another definition")
           : status == ILSA_ERR_MEMORY
               ? ilsai_fail(&solver->error, status, "no memory to restore a snapshot")
               : ilsai_fail(&solver->error, status, "the snapshot is malformed");
}
