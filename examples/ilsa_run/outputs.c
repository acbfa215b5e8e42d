#include "outputs.h"

#include "fields.h"
#include "front.h"
#include "outfile.h"

#include <stdlib.h>
#include <string.h>

static int write_pvd(const outputs *o, const char *directory) {
    outfile file;
    char name[NAME_SIZE];
    if (!outfile_open(&file, directory, "run.pvd"))
        return 0;
    fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
          file.stream);
    for (int i = 0; i < o->count; i++)
        fprintf(file.stream, "<DataSet timestep=\"%.15g\" part=\"0\" file=\"%s\"/>\n",
                o->list[i].time, numbered_name(name, "fields", i + 1, "vti"));
    fputs("</Collection>\n</VTKFile>\n", file.stream);
    return outfile_close(&file);
}

/* The scene's name without directory and extension; gnuplot's quotes are left out of it. */
static void put_name(FILE *stream, const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.'), *end = dot && dot > name ? dot : name + strlen(name);
    fputs("scene = \"", stream);
    for (; name < end; name++)
        if (!strchr("\"\\", *name))
            fputc(*name, stream);
    fputs("\"\n", stream);
}

static void put_list(FILE *stream, const char *name, const double *values, int count) {
    fprintf(stream, "%s = \"", name);
    for (int i = 0; i < count; i++)
        fprintf(stream, "%.10g ", values[i]);
    fputs("\"\n", stream);
}

static int write_plot(const outputs *o, const char *directory, const scene *sc) {
    outfile file;
    if (!outfile_open(&file, directory, "plot.gp"))
        return 0;
    FILE *s = file.stream;
    fputs("# What figures.sh has to know of this run.\n", s);
    put_name(s, sc->path);
    fprintf(s, "units = \"%s\"\nsource_x = %.10g\nsource_y = %.10g\noutputs = %d\n",
            sc->laboratory ? "SI" : "none", sc->sources[0].x, sc->sources[0].y, o->count);
    fputs("times = \"", s);
    for (int i = 0; i < o->count; i++)
        fprintf(s, "%.6g ", o->list[i].time);
    fputs("\"\ncell_dx = \"", s);
    for (int i = 0; i < o->count; i++)
        fprintf(s, "%.10g ", o->list[i].mesh.dx);
    fputs("\"\ncell_dy = \"", s);
    for (int i = 0; i < o->count; i++)
        fprintf(s, "%.10g ", o->list[i].mesh.dy);
    fputs("\"\nloops = \"", s);
    for (int i = 0; i < o->count; i++)
        fprintf(s, "%d ", o->list[i].loops);
    fputs("\"\n", s);
    /* The half cells of a log are no interfaces to be drawn. */
    int interfaces = sc->log.file ? 0 : sc->interface_count;
    put_list(s, "interfaces", sc->interfaces, interfaces);
    put_list(s, "sigma", sc->sigma, interfaces + 1);
    return outfile_close(&file);
}

static output *add_output(outputs *o) {
    output *list = realloc(o->list, (size_t)(o->count + 1) * sizeof *list);
    if (!list) {
        fputs("ilsa-run: out of memory\n", stderr);
        return NULL;
    }
    o->list = list;
    list[o->count] = (output){0};
    return &list[o->count++];
}

int outputs_write(outputs *o, const char *directory, const scene *sc, ilsa_solver *solver) {
    fields f;
    output *now = add_output(o);
    const scene_source *source = &sc->sources[0];
    if (!now || ilsa_get_time(solver, &now->time) || !fields_get(&f, solver))
        return 0;
    now->mesh = f.mesh;
    return fields_write_vti(&f, directory, o->count) &&
           fields_write_lines(&f, directory, o->count, source->x, source->y) &&
           front_write(directory, o->count, solver, &now->loops) &&
           survey_write(directory, o->count, solver) && write_pvd(o, directory) &&
           write_plot(o, directory, sc);
}

void outputs_free(outputs *o) {
    free(o->list);
    *o = (outputs){0};
}
