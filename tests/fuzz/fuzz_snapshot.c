/*
 * Images that are not what ilsa_snapshot_save wrote: bytes of any kind, or an image with some of
 * its own altered, cut or added, and sealed again with the right checksum. Each is refused and
 * leaves the solver as it was, or is a state that can be read, stepped and saved.
 */
#include "fuzz.h"

#include <stdlib.h>

/* For the header and the checksum, which are its own; the library's copy is then not linked. */
/* NOLINTNEXTLINE(bugprone-suspicious-include) */
#include "api/snapshot.c"

enum { SIZE = 11, EDITS = 12, GROWTH = 64 };

typedef struct subject {
    ilsa_solver *solver;
    unsigned char *image; /* of its own state */
    size_t size;
} subject;

static ilsa_solver *make_solver(int layers) {
    const ilsa_mesh_def mesh_def = {SIZE, SIZE, 1, 1};
    const ilsa_material_def material_def = {1, 1, 1, layers ? 0.3 : 0};
    const ilsa_stress_def stress_def = {0};
    const ilsa_source_def wells[] = {{0, 0, 1}, {1, 0, 0.5}};
    const double y[] = {-1.5, 1.5}, sigma[] = {0.2, 0, 0.1};
    ilsa_mesh *mesh;
    ilsa_material *material;
    ilsa_stress *stress;
    ilsa_solver *solver;
    FUZZ_EXPECT(!ilsa_mesh_create(&mesh_def, &mesh));
    FUZZ_EXPECT(!ilsa_material_create(&material_def, &material));
    FUZZ_EXPECT(!ilsa_stress_create(&stress_def, &stress));
    FUZZ_EXPECT(!layers || !ilsa_stress_set_layers(stress, 2, y, sigma));
    ilsa_solver_def def = ilsa_solver_def_default();
    def.mesh = mesh;
    def.material = material;
    def.stress = stress;
    def.sources = wells;
    def.source_count = layers ? 2 : 1;
    FUZZ_EXPECT(!ilsa_solver_create(&def, &solver) && !ilsa_start_radial(solver, 2.5));
    FUZZ_EXPECT(!ilsa_advance_one(solver, 1e300, NULL));
    ilsa_mesh_destroy(&mesh);
    ilsa_material_destroy(&material);
    ilsa_stress_destroy(&stress);
    return solver;
}

/* Without and with leak-off, layers and a second source; made once. */
static subject *subject_of(int layers) {
    static subject subjects[2];
    subject *s = &subjects[layers];
    if (!s->solver) {
        s->solver = make_solver(layers);
        FUZZ_EXPECT(!ilsa_snapshot_save(s->solver, NULL, &s->size));
        s->image = malloc(s->size);
        FUZZ_EXPECT(s->image && !ilsa_snapshot_save(s->solver, s->image, &s->size));
    }
    return s;
}

static size_t some_place(fuzz_input *in, size_t size) {
    FUZZ_EXPECT(size > 0);
    return (fuzz_byte(in) * (size_t)256 + fuzz_byte(in)) % size;
}

/* Eight bytes at a place: a double at which things break, a whole number, any byte. */
static void edit(fuzz_input *in, unsigned char *image, size_t size) {
    int how = fuzz_choice(in, 4);
    size_t at = some_place(in, size - sizeof(uint64_t));
    double odd = fuzz_odd(in);
    int32_t whole = (int32_t)fuzz_byte(in) - 4;
    if (how < 2)
        at = at / sizeof odd * sizeof odd;
    if (how == 0)
        memcpy(image + at, &odd, sizeof odd);
    else if (how == 1)
        memcpy(image + at + (whole & 4), &whole, sizeof whole);
    else
        image[at] = (unsigned char)whole;
}

/* The image of the subject, altered; sealed again, as a rule. To be freed. */
static unsigned char *altered(fuzz_input *in, const subject *s, size_t *size) {
    unsigned char *image = calloc(1, s->size + GROWTH);
    FUZZ_EXPECT(image);
    memcpy(image, s->image, s->size);
    int sealed = fuzz_choice(in, 16) < 15, length = fuzz_choice(in, 8);
    *size = s->size;
    if (length == 6)
        *size += 1 + (size_t)fuzz_choice(in, GROWTH);
    else if (length == 7)
        *size = sizeof(header) + some_place(in, s->size - sizeof(header));
    for (int k = 0; k < EDITS && in->size > 0 && *size > sizeof(header) + 8; k++)
        edit(in, image + sizeof(header), *size - sizeof(header));
    if (sealed) {
        header head;
        memcpy(&head, image, sizeof head);
        head.size = *size;
        head.checksum = checksum(image + sizeof head, *size - sizeof head);
        memcpy(image, &head, sizeof head);
    }
    unsigned char *exact = realloc(image, *size);
    FUZZ_EXPECT(exact);
    return exact;
}

static int holds(const ilsa_solver *solver, const unsigned char *image, size_t size) {
    size_t now = 0;
    FUZZ_EXPECT(!ilsa_snapshot_save(solver, NULL, &now) && now > 0);
    unsigned char *bytes = malloc(now > 0 ? now : 1);
    FUZZ_EXPECT(bytes && !ilsa_snapshot_save(solver, bytes, &now));
    int same = now == size && memcmp(bytes, image, size) == 0;
    free(bytes);
    return same;
}

static void check_widths(const ilsa_solver *solver) {
    const double *width, *pressure;
    const unsigned char *kind;
    FUZZ_EXPECT(!ilsa_get_width(solver, &width) && !ilsa_get_pressure(solver, &pressure));
    FUZZ_EXPECT(!ilsa_get_cell_kinds(solver, &kind));
    for (int k = 0; k < SIZE * SIZE; k++) {
        FUZZ_EXPECT(width[k] >= 0 && isfinite(width[k]) && isfinite(pressure[k]));
        FUZZ_EXPECT(kind[k] <= ILSA_CELL_CLOSED);
    }
}

/* What was taken for a state is one. */
static void use(ilsa_solver *solver) {
    const ilsa_front_point *points;
    const ilsa_survey_point *survey;
    ilsa_summary summary;
    ilsa_report report;
    size_t count;
    double dt;
    check_widths(solver);
    FUZZ_EXPECT(!ilsa_get_summary(solver, &summary) && isfinite(summary.time));
    FUZZ_EXPECT(!ilsa_get_front(solver, &points, &count));
    FUZZ_EXPECT(!ilsa_get_survey(solver, &survey, &count));
    FUZZ_EXPECT(!ilsa_suggest_dt(solver, &dt) && dt > 0);
    ilsa_status status = ilsa_step(solver, fmin(dt, 1e300), &report);
    FUZZ_EXPECT(status == ILSA_OK || *ilsa_last_error(solver));
    check_widths(solver);
    ilsa_coarsen(solver);
    check_widths(solver);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_input in = {data, size};
    int how = fuzz_choice(&in, 4);
    subject *s = subject_of(how & 1);
    unsigned char *made = how & 2 ? NULL : altered(&in, s, &size);
    const unsigned char *image = made ? made : data;
    ilsa_status status = ilsa_snapshot_restore(s->solver, image, size);
    FUZZ_EXPECT(status == ILSA_OK || status == ILSA_ERR_SNAPSHOT || status == ILSA_ERR_MISMATCH);
    if (status == ILSA_OK)
        use(s->solver);
    else
        FUZZ_EXPECT(*ilsa_last_error(s->solver) && holds(s->solver, s->image, s->size));
    FUZZ_EXPECT(!ilsa_snapshot_restore(s->solver, s->image, s->size));
    free(made);
    return 0;
}
