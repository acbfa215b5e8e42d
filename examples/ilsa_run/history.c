#include "history.h"

int history_open(outfile *file, const char *directory) {
    if (!outfile_open(file, directory, "history.csv"))
        return 0;
    fputs("t,dt,x_min,x_max,y_min,y_max,extent_x_min,extent_x_max,extent_y_min,extent_y_max,"
          "width_source,pressure_source,volume_injected,volume_fracture,volume_leaked,efficiency,"
          "cells,tip_cells,front_iterations,newton_iterations,krylov_iterations,"
          "elasticity_products,rejected,coarsened_x,coarsened_y,grown,wall_s\n",
          file->stream);
    return outfile_flush(file);
}

int history_row(outfile *file, const ilsa_summary *s, const ilsa_report *step, double wall_s) {
    const double numbers[] = {s->time,
                              step->dt,
                              s->x_min,
                              s->x_max,
                              s->y_min,
                              s->y_max,
                              s->extent_x_min,
                              s->extent_x_max,
                              s->extent_y_min,
                              s->extent_y_max,
                              s->width_source,
                              s->pressure_source,
                              s->volume_injected,
                              s->volume_fracture,
                              s->volume_leaked,
                              s->efficiency};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        fprintf(file->stream, "%.15g,", numbers[i]);
    fprintf(file->stream, "%d,%d,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%ld,%.3f\n", s->cells, s->tip_cells,
            step->front_iterations, step->newton_iterations, step->krylov_iterations,
            step->elasticity_products, step->rejected, step->coarsened_x, step->coarsened_y,
            step->grown, wall_s);
    return outfile_flush(file);
}
