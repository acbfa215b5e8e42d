#include "fields.h"

#include "base64.h"
#include "outfile.h"

#include <math.h>
#include <stdint.h>

int fields_get(fields *f, const ilsa_solver *solver) {
    ilsa_status status = ilsa_get_mesh_def(solver, &f->mesh);
    if (!status)
        status = ilsa_get_width(solver, &f->width);
    if (!status)
        status = ilsa_get_pressure(solver, &f->pressure);
    if (!status)
        status = ilsa_get_stress(solver, &f->stress);
    if (!status)
        status = ilsa_get_trigger_time(solver, &f->trigger);
    if (!status)
        status = ilsa_get_cell_kinds(solver, &f->kind);
    if (status)
        fprintf(stderr, "ilsa-run: fields: %s: %s\n", ilsa_status_text(status),
                ilsa_last_error(solver));
    return status == ILSA_OK;
}

static size_t cell_count(const fields *f) {
    return (size_t)f->mesh.nx * (size_t)f->mesh.ny;
}

/* VTK reads the byte count and the data as one base64 stream. */
static void begin_array(base64 *b, const char *name, const char *type, size_t bytes) {
    uint64_t header = bytes;
    fprintf(b->stream, "<DataArray type=\"%s\" Name=\"%s\" format=\"binary\">\n", type, name);
    base64_put(b, &header, sizeof header);
}

static void end_array(base64 *b) {
    base64_end(b);
    fputs("\n</DataArray>\n", b->stream);
}

static void put_doubles(base64 *b, const char *name, const fields *f, const double *data) {
    begin_array(b, name, "Float64", cell_count(f) * sizeof *data);
    base64_put(b, data, cell_count(f) * sizeof *data);
    end_array(b);
}

/* Not a number where the front has not been: ParaView leaves such cells out of its colour range. */
static void put_trigger(base64 *b, const fields *f) {
    begin_array(b, "trigger_time", "Float64", cell_count(f) * sizeof(double));
    for (size_t i = 0; i < cell_count(f); i++) {
        double time = isfinite(f->trigger[i]) ? f->trigger[i] : (double)NAN;
        base64_put(b, &time, sizeof time);
    }
    end_array(b);
}

static void put_kinds(base64 *b, const fields *f) {
    begin_array(b, "cell_kind", "UInt8", cell_count(f));
    base64_put(b, f->kind, cell_count(f));
    end_array(b);
}

int fields_write_vti(const fields *f, const char *directory, int number) {
    outfile file;
    char name[NAME_SIZE];
    const ilsa_mesh_def *m = &f->mesh;
    const uint16_t one = 1;
    const char *order = *(const unsigned char *)&one ? "LittleEndian" : "BigEndian";
    if (!outfile_open(&file, directory, numbered_name(name, "fields", number, "vti")))
        return 0;
    FILE *s = file.stream;
    fprintf(s,
            "<?xml version=\"1.0\"?>\n"
            "<!-- cell_kind: 0 outside, 1 tip, 2 survey, 3 channel, 4 closed; trigger_time: NaN "
            "where the front has not been -->\n"
            "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"%s\" "
            "header_type=\"UInt64\">\n"
            "<ImageData WholeExtent=\"0 %d 0 %d 0 0\" Origin=\"%.17g %.17g 0\" "
            "Spacing=\"%.17g %.17g 1\">\n"
            "<Piece Extent=\"0 %d 0 %d 0 0\">\n<CellData Scalars=\"width\">\n",
            order, m->nx, m->ny, -0.5 * m->nx * m->dx, -0.5 * m->ny * m->dy, m->dx, m->dy, m->nx,
            m->ny);
    base64 b = {.stream = s};
    put_doubles(&b, "width", f, f->width);
    put_doubles(&b, "pressure", f, f->pressure);
    put_doubles(&b, "stress", f, f->stress);
    if (f->trigger)
        put_trigger(&b, f);
    put_kinds(&b, f);
    fputs("</CellData>\n</Piece>\n</ImageData>\n</VTKFile>\n", s);
    return outfile_close(&file);
}

/* count cells from index start, stride apart; the first centre is at origin. */
typedef struct line {
    const char *stem, *axis;
    int start, stride, count;
    double origin, spacing;
} line;

static int write_line(const fields *f, const line *l, const char *directory, int number) {
    outfile file;
    char name[NAME_SIZE];
    int first = 0, last = l->count - 1;
    while (first <= last && f->kind[l->start + first * l->stride] == ILSA_CELL_EMPTY)
        first++;
    while (last >= first && f->kind[l->start + last * l->stride] == ILSA_CELL_EMPTY)
        last--;
    if (!outfile_open(&file, directory, numbered_name(name, l->stem, number, "csv")))
        return 0;
    fprintf(file.stream, "%s,width,pressure,stress,cell_kind\n", l->axis);
    for (int i = first; i <= last; i++) {
        int c = l->start + i * l->stride;
        fprintf(file.stream, "%.10g,%.10g,%.10g,%.10g,%d\n", l->origin + i * l->spacing,
                f->width[c], f->kind[c] ? f->pressure[c] : NAN, f->stress[c], f->kind[c]);
    }
    return outfile_close(&file);
}

/* The cell of a place on an axis of n cells; places are on the mesh. */
static int cell_at(double place, double spacing, int n) {
    int i = (int)floor(place / spacing + 0.5 * n);
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

int fields_write_lines(const fields *f, const char *directory, int number, double x, double y) {
    const ilsa_mesh_def *m = &f->mesh;
    int i = cell_at(x, m->dx, m->nx), j = cell_at(y, m->dy, m->ny);
    line along_x = {"line_x", "x", j * m->nx, 1, m->nx, -0.5 * (m->nx - 1) * m->dx, m->dx};
    line along_y = {"line_y", "y", i, m->nx, m->ny, -0.5 * (m->ny - 1) * m->dy, m->dy};
    return write_line(f, &along_x, directory, number) && write_line(f, &along_y, directory, number);
}
