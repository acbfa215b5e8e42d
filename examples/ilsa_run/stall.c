#include "stall.h"

#include <math.h>

typedef struct facts {
    ilsa_summary now;
    ilsa_mesh_def mesh;
    const double *stress;
    int across; /* rows of cells in the pay, and whether there is a barrier beside it */
    int barred;
} facts;

/* The last row from the source's on, up or down, that the fluid at the source can hold open. */
static int pay_end(const facts *f, int column, int row, int step) {
    int nx = f->mesh.nx, ny = f->mesh.ny;
    double most = fmax(f->now.pressure_source, f->stress[row * nx + column]);
    while (row + step >= 0 && row + step < ny && f->stress[(row + step) * nx + column] <= most)
        row += step;
    return row;
}

static int cell_at(double place, double size, int n) {
    return (int)fmin(fmax(floor(place / size + 0.5 * n), 0), n - 1);
}

/* The pay: the rows about the source where the fluid can open the rock. */
static void measure_pay(const scene *sc, facts *f) {
    const ilsa_mesh_def *m = &f->mesh;
    int column = cell_at(sc->sources[0].x, m->dx, m->nx);
    int row = cell_at(sc->sources[0].y, m->dy, m->ny);
    int bottom = pay_end(f, column, row, -1), top = pay_end(f, column, row, 1);
    f->across = top - bottom + 1;
    f->barred = bottom > 0 || top < m->ny - 1;
}

static void put_where(const facts *f, const ilsa_report *last, FILE *out) {
    const ilsa_summary *s = &f->now;
    fprintf(out,
            "where: t = %.10g, %ld steps refused at the end, %ld of %ld in all; %d of %d cells "
            "closed; ",
            s->time, last->rejected, s->total.rejected, s->total.steps + s->total.rejected,
            s->closed_cells, s->cells);
    if (f->barred)
        fprintf(out, "%d cells across the pay; ", f->across);
    fprintf(out, "fracture x %.6g .. %.6g, y %.6g .. %.6g on cells of %.6g x %.6g\n",
            s->extent_x_min, s->extent_x_max, s->extent_y_min, s->extent_y_max, f->mesh.dx,
            f->mesh.dy);
}

/* So many times the cells, odd where they were: the middle stays in a cell. */
static double multiplied(double factor, int n) {
    return factor * n + (n % 2);
}

/*
 * Of what a scene can change, smaller cells are what has helped: as many as the mesh that the
 * fracture stands on now, of the size that the scene gave, or of half of it where that is what they
 * are.
 */
static void put_advice(const scene *sc, const facts *f, FILE *out) {
    const ilsa_mesh_def *m = &sc->mesh;
    const ilsa_report *done = &f->now.total;
    double x = done->coarsened ? f->mesh.dx / m->dx : 2;
    double y = done->coarsened ? f->mesh.dy / m->dy : 2;
    fprintf(out, "try: %s:%d: [mesh] nx = %.0f, ny = %.0f", sc->path,
            sc->lines[SECTION_MESH][MESH_NX], x > 1 ? multiplied(x, f->mesh.nx) : f->mesh.nx,
            y > 1 ? multiplied(y, f->mesh.ny) : f->mesh.ny);
    if (done->coarsened)
        fprintf(out, ": so many that they need not be coarsened\n");
    else
        fprintf(out, ", dx = %.6g, dy = %.6g: cells half as large\n", 0.5 * m->dx, 0.5 * m->dy);
}

void stall_write(const scene *sc, const ilsa_solver *solver, const ilsa_report *last, FILE *out) {
    facts f;
    if (ilsa_get_summary(solver, &f.now) || ilsa_get_mesh_def(solver, &f.mesh) ||
        ilsa_get_stress(solver, &f.stress))
        return;
    measure_pay(sc, &f);
    put_where(&f, last, out);
    put_advice(sc, &f, out);
}
