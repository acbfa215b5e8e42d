/* The image of a solver: a header, the state, the fields of its region, tip paths, rates, stress.
 */
#include <ilsa/snapshot.h>

#include "api/snapshot_check.h"
#include "base/tuning.h"
#include "step/state.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define SNAPSHOT_MAGIC "ilsasnap"
enum { SNAPSHOT_LAYOUT = 3 };

typedef struct header {
    char magic[8];
    uint32_t layout, version;
    uint64_t size;     /* of the whole image */
    uint64_t checksum; /* of all that follows the header */
} header;

/* What a solver must share with the one that the image was taken of. */
typedef struct identity {
    int nx, ny, source_count, level;
    double dx, dy; /* as they were; coarsening doubles them */
    ilsa_material_def material;
    double step_cells, tolerance, dt_max, closure_width;
    int coarsen, tip, symmetry, loop, linear, product;
} identity;

/* Copies to or from the image, or only counts, depending on the pass. */
typedef struct stream {
    unsigned char *out;
    const unsigned char *in;
    size_t at, size;
    int failed;
} stream;

static void pass(stream *io, void *data, size_t size) {
    if (io->failed || size > io->size - io->at) {
        io->failed = 1;
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
    identity id;
    memset(&id, 0, sizeof id);
    id.nx = s->mesh.nx;
    id.ny = s->mesh.ny;
    id.dx = s->mesh.dx;
    id.dy = s->mesh.dy;
    id.source_count = s->def.source_count;
    id.level = s->def.level;
    id.material = s->material;
    id.material.mu_prime = s->inviscid ? 0 : s->material.mu_prime;
    id.step_cells = s->step_cells;
    id.tolerance = s->tolerance;
    id.dt_max = s->def.dt_max;
    id.closure_width = s->def.closure_width;
    id.coarsen = s->def.coarsen;
    id.tip = (int)s->def.tip;
    id.symmetry = (int)s->def.symmetry;
    id.loop = (int)s->def.loop;
    id.linear = (int)s->def.linear;
    id.product = (int)s->def.product;
    return id;
}

/* The same definition, however often either has been coarsened, which doubles dx and dy. */
static int same_definition(const identity *a, const identity *b) {
    identity like = *a;
    int times;
    like.dx = b->dx;
    like.dy = b->dy;
    /* Copies of the same bits are meant, and every byte is defined. */
    /* NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c) */
    return memcmp(&like, b, sizeof like) == 0 && frexp(a->dx / b->dx, &times) == 0.5 &&
           a->dx / b->dx == a->dy / b->dy;
}

static void pass_state(stream *io, state *now) {
    state packed;
    memset(&packed, 0, sizeof packed);
    packed.started = now->started;
    packed.mirror_x = now->mirror_x;
    packed.mirror_y = now->mirror_y;
    packed.mu_prime = now->mu_prime;
    packed.time = now->time;
    packed.dt_limit = now->dt_limit;
    packed.injected = now->injected;
    packed.leaked = now->leaked;
    packed.fracture = now->fracture;
    packed.front_change = now->front_change;
    packed.front_advance = now->front_advance;
    packed.dt = now->dt;
    packed.leak_rate = now->leak_rate;
    packed.width_most = now->width_most;
    packed.footprint = now->footprint;
    packed.unknowns = now->unknowns;
    pass(io, &packed, sizeof packed);
    *now = packed;
}

static void pass_rows(stream *io, const ilsa_solver *s, const box *b, void *field, size_t size) {
    size_t length = (size_t)(b->x1 - b->x0 + 1) * size;
    for (int j = b->y0; j <= b->y1; j++) {
        size_t at = ((size_t)j * (size_t)s->mesh.nx + (size_t)b->x0) * size;
        pass(io, (char *)field + at, length);
    }
}

static void pass_fields(stream *io, const ilsa_solver *s, const box *b, const fields *f) {
    pass_rows(io, s, b, f->width, sizeof *f->width);
    pass_rows(io, s, b, f->pressure, sizeof *f->pressure);
    pass_rows(io, s, b, f->level, sizeof *f->level);
    pass_rows(io, s, b, f->speed, sizeof *f->speed);
    pass_rows(io, s, b, f->kind, sizeof *f->kind);
    if (f->trigger) {
        pass_rows(io, s, b, f->trigger, sizeof *f->trigger);
        pass_rows(io, s, b, f->spread, sizeof *f->spread);
        pass_rows(io, s, b, f->leaked, sizeof *f->leaked);
    }
}

/* Knots that are not in use are written as zero. */
static void pass_record(stream *io, tip_record *record) {
    tip_record packed;
    memset(&packed, 0, sizeof packed);
    packed.cell = record->cell;
    packed.history.count = record->history.count;
    for (int k = 0; k < record->history.count; k++) {
        packed.history.t[k] = record->history.t[k];
        packed.history.ell[k] = record->history.ell[k];
    }
    pass(io, &packed, sizeof packed);
    *record = packed;
}

static void write_stress(stream *io, const ilsa_solver *s) {
    size_t size = ilsai_stress_image_size(s->stress);
    uint64_t length = size;
    pass(io, &length, sizeof length);
    if (io->out && !io->failed && size <= io->size - io->at) {
        ilsai_stress_write(s->stress, io->out + io->at);
    }
    io->failed |= size > io->size - io->at;
    io->at += io->failed ? 0 : size;
}

/* Everything after the header; the same order as read_body. */
static void write_body(stream *io, const ilsa_solver *s) {
    identity id = identify(s);
    state now = s->now;
    box region = ilsai_solver_region(s, &s->now.footprint);
    int32_t tips = s->tips.count;
    pass(io, &id, sizeof id);
    pass_state(io, &now);
    for (int k = 0; k < s->def.source_count; k++) {
        ilsa_source_def def = s->sources[k].def;
        pass(io, &def, sizeof def);
    }
    write_stress(io, s);
    pass(io, &tips, sizeof tips);
    for (int k = 0; k < s->tips.count; k++) {
        tip_record record = s->tips.at[k];
        pass_record(io, &record);
    }
    pass_fields(io, s, &region, &s->field);
}

ilsa_status ilsa_snapshot_save(const ilsa_solver *solver, void *buffer, size_t *size) {
    error_text *error = ilsai_thread_error();
    ilsa_status status = ilsai_check_pointer(error, "solver", solver);
    status = status ? status : ilsai_check_pointer(error, "size", size);
    status = status ? status : ilsai_check_started(solver, error);
    if (status != ILSA_OK) {
        return status;
    }
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

/* What is read before the solver is touched. */
typedef struct incoming {
    state now;
    ilsa_mesh_def mesh;
    ilsa_source_def *sources;
    ilsa_stress *stress;
    tip_records tips;
} incoming;

static void release(incoming *from) {
    free(from->sources);
    ilsa_stress_destroy(&from->stress);
    free(from->tips.at);
}

/* Rates change, places do not. */
static ilsa_status read_sources(stream *io, const ilsa_solver *s, incoming *from) {
    size_t count = (size_t)s->def.source_count, size = count * sizeof *from->sources;
    from->sources = calloc(count, sizeof *from->sources);
    if (!from->sources) {
        return ILSA_ERR_MEMORY;
    }
    pass(io, from->sources, size);
    for (int k = 0; k < s->def.source_count && !io->failed; k++) {
        const ilsa_source_def *own = &s->sources[k].def, *seen = &from->sources[k];
        if (seen->x != own->x || seen->y != own->y) {
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
    ilsa_status status = ilsai_stress_read(io->in + io->at, (size_t)length, &from->stress);
    io->at += (size_t)length;
    return status;
}

static ilsa_status read_tips(stream *io, const ilsa_solver *s, incoming *from) {
    int32_t count = 0;
    pass(io, &count, sizeof count);
    size_t left = io->size - io->at;
    if (io->failed || count < 0 || (size_t)count > left / sizeof(tip_record)) {
        return ILSA_ERR_SNAPSHOT;
    }
    if (ilsai_asymptote_records_reserve(&from->tips, count) != ILSA_OK) {
        return ILSA_ERR_MEMORY;
    }
    for (from->tips.count = 0; from->tips.count < count; from->tips.count++) {
        tip_record *record = &from->tips.at[from->tips.count];
        memcpy(record, io->in + io->at, sizeof *record);
        io->at += sizeof *record;
        int after = from->tips.count > 0 ? record[-1].cell : -1;
        if (record->cell <= after ||
            !ilsai_snapshot_record_is_sound(record, ilsai_mesh_cells(&s->mesh), from->now.time)) {
            return ILSA_ERR_SNAPSHOT;
        }
    }
    return ILSA_OK;
}

/* The material's, or where it has none one that can stand for it. */
static int is_viscosity(const ilsa_solver *s, double mu_prime) {
    return s->inviscid ? isfinite(mu_prime) && mu_prime > 0 : mu_prime == s->material.mu_prime;
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
    from->mesh = (ilsa_mesh_def){id.nx, id.ny, id.dx, id.dy};
    pass(io, &from->now, sizeof from->now);
    if (io->failed || !ilsai_snapshot_state_is_sound(&from->now, &from->mesh) ||
        !is_viscosity(s, from->now.mu_prime)) {
        return ILSA_ERR_SNAPSHOT;
    }
    ilsa_status status = read_sources(io, s, from);
    status = status ? status : read_stress(io, from);
    return status ? status : read_tips(io, s, from);
}

/* The fields of the image must fill what is left of it exactly, and be those of a fracture. */
static int fields_fit(const ilsa_solver *s, const stream *io, const box *region,
                      const box *footprint) {
    stream count = {.at = io->at, .size = SIZE_MAX};
    snapshot_fields seen = {io->in + io->at, *region, *footprint, ilsai_has_leakoff(s)};
    pass_fields(&count, s, region, &s->field);
    return count.at == io->size && ilsai_snapshot_fields_are_sound(&seen);
}

/* An elasticity for another cell size, NULL if the size is the same. */
static ilsa_status other_elasticity(const ilsa_solver *s, const ilsa_mesh_def *mesh,
                                    elasticity **e) {
    *e = NULL;
    return ilsai_mesh_same(mesh, &s->mesh) ? ILSA_OK
                                           : ilsai_elasticity_create(s->material.E_prime, mesh->dx,
                                                                     mesh->dy, s->def.product, e);
}

static void adopt(ilsa_solver *s, incoming *from, elasticity *e, stream *io) {
    if (s->now.started) {
        box old = ilsai_solver_region(s, &s->now.footprint);
        ilsai_fields_clear_box(&s->field, &s->mesh, &old);
    }
    if (e) {
        ilsai_elasticity_destroy(&s->elastic);
        s->elastic = e;
    }
    ilsa_stress *stress = s->stress;
    tip_records tips = s->tips;
    s->mesh = from->mesh;
    s->now = from->now;
    ilsai_solver_set_viscosity(s, from->now.mu_prime);
    s->stress = from->stress;
    s->tips = from->tips;
    from->stress = stress;
    from->tips = tips;
    for (int k = 0; k < s->def.source_count; k++) {
        s->sources[k].def.rate = from->sources[k].rate;
    }
    ilsai_sources_place(s);
    box region = ilsai_solver_region(s, &s->now.footprint);
    pass_fields(io, s, &region, &s->field);
}

/* Takes over what was read. The stress of an image fits its own mesh, so filling cannot fail. */
static ilsa_status finish(ilsa_solver *s, incoming *from, stream *io) {
    elasticity *e;
    ilsa_solver like = *s;
    like.mesh = from->mesh;
    box region = ilsai_solver_region(&like, &from->now.footprint);
    if (!fields_fit(&like, io, &region, &from->now.footprint) ||
        ilsai_stress_fill(from->stress, &from->mesh, s->source_term) != ILSA_OK) {
        return ILSA_ERR_SNAPSHOT;
    }
    ilsa_status status = other_elasticity(s, &from->mesh, &e);
    if (status == ILSA_OK) {
        adopt(s, from, e, io);
        status = ilsai_solver_fill_stress(s);
    }
    return status;
}

ilsa_status ilsa_snapshot_restore(ilsa_solver *solver, const void *buffer, size_t size) {
    if (!solver || !buffer) {
        error_text *error = solver ? &solver->error : ilsai_thread_error();
        return ilsai_check_pointer(error, solver ? "buffer" : "solver", NULL);
    }
    ilsa_status status = check_header(solver, buffer, size);
    if (status != ILSA_OK) {
        return status;
    }
    incoming from = {0};
    stream io = {.in = buffer, .at = sizeof(header), .size = size};
    status = read_head(&io, solver, &from);
    status = status ? status : finish(solver, &from, &io);
    release(&from);
    return status == ILSA_OK ? ILSA_OK
           : status == ILSA_ERR_MISMATCH
               ? ilsai_fail(&solver->error, status,
                            "the snapshot is of a solver with another definition")
           : status == ILSA_ERR_MEMORY
               ? ilsai_fail(&solver->error, status, "no memory to restore a snapshot")
               : ilsai_fail(&solver->error, status, "the snapshot is malformed");
}
