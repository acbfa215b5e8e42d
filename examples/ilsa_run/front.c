#include "front.h"

#include "outfile.h"

static int solver_failed(const char *what, ilsa_status status, const ilsa_solver *solver) {
    fprintf(stderr, "ilsa-run: %s: %s: %s\n", what, ilsa_status_text(status),
            ilsa_last_error(solver));
    return 0;
}

static void write_point(FILE *stream, const ilsa_front_point *p, int with_loop) {
    fprintf(stream, "%.10g,%.10g,%.8g,%.6f,%.6f,%.6f", p->x, p->y, p->V, p->regime.N_k,
            p->regime.N_mt, p->regime.N_m);
    if (with_loop)
        fprintf(stream, ",%d", p->loop);
    fputc('\n', stream);
}

/* The points come loop by loop. */
static void write_loops(FILE *stream, const ilsa_front_point *points, size_t count, int several) {
    size_t first = 0;
    for (size_t i = 0; i < count; i++) {
        write_point(stream, &points[i], several);
        if (i + 1 == count || points[i + 1].loop != points[i].loop) {
            write_point(stream, &points[first], several);
            first = i + 1;
        }
    }
}

int front_write(const char *directory, int number, ilsa_solver *solver, int *loops) {
    const ilsa_front_point *points;
    size_t count;
    outfile file;
    char name[NAME_SIZE];
    *loops = 0;
    ilsa_status status = ilsa_get_front(solver, &points, &count);
    if (status)
        return solver_failed("front", status, solver);
    for (size_t i = 0; i < count; i++)
        if (points[i].loop >= *loops)
            *loops = points[i].loop + 1;
    if (!outfile_open(&file, directory, numbered_name(name, "front", number, "csv")))
        return 0;
    fprintf(file.stream, "x,y,V,N_k,N_mt,N_m%s\n", *loops > 1 ? ",loop" : "");
    write_loops(file.stream, points, count, *loops > 1);
    return outfile_close(&file);
}

int survey_write(const char *directory, int number, ilsa_solver *solver) {
    const ilsa_survey_point *points;
    size_t count;
    outfile file;
    char name[NAME_SIZE];
    ilsa_status status = ilsa_get_survey(solver, &points, &count);
    if (status)
        return solver_failed("survey cells", status, solver);
    if (!outfile_open(&file, directory, numbered_name(name, "survey", number, "csv")))
        return 0;
    fputs("x,y,s,w,V,N_k,N_mt,N_m,triangle_x,triangle_y\n", file.stream);
    for (size_t i = 0; i < count; i++) {
        const ilsa_survey_point *p = &points[i];
        fprintf(file.stream, "%.10g,%.10g,%.8g,%.8g,%.8g,%.6f,%.6f,%.6f,%.6f,%.6f\n", p->x, p->y,
                p->s, p->w, p->V, p->regime.N_k, p->regime.N_mt, p->regime.N_m, p->regime.x,
                p->regime.y);
    }
    return outfile_close(&file);
}
