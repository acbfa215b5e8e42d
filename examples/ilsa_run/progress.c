#include "progress.h"

#include <stdio.h>
#include <unistd.h>

progress progress_begin(int quiet, double t_start, double t_end) {
    return (progress){!quiet && isatty(STDERR_FILENO), t_start, t_end, -1};
}

static void put_left(double seconds) {
    if (seconds < 90)
        fprintf(stderr, "%.0f s left", seconds);
    else if (seconds < 5400)
        fprintf(stderr, "%.0f min left", seconds / 60);
    else
        fprintf(stderr, "%.1f h left", seconds / 3600);
}

void progress_show(progress *p, double t, long steps, double wall) {
    if (!p->on || wall < p->shown_at + 0.2)
        return;
    double done = (t - p->t_start) / (p->t_end - p->t_start);
    p->shown_at = wall;
    fprintf(stderr, "\r\033[Kt = %.4g of %.4g   step %ld   %.0f %%   ", t, p->t_end, steps,
            100 * done);
    if (done > 0.01)
        put_left(wall * (1 - done) / done);
    fflush(stderr);
}

void progress_end(const progress *p) {
    if (p->on)
        fputs("\r\033[K", stderr);
}
