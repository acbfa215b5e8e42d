/* One line on the terminal that says how far the run is. */
#ifndef ILSA_RUN_PROGRESS_H
#define ILSA_RUN_PROGRESS_H

typedef struct progress {
    int on; /* stderr is a terminal and --quiet was not given */
    double t_start, t_end;
    double shown_at; /* wall time */
} progress;

progress progress_begin(int quiet, double t_start, double t_end);

/* Shows time, step, percent and time left, a few times a second. wall: seconds since the start. */
void progress_show(progress *p, double t, long steps, double wall);

/* Wipes the line, so that a message may take its place. */
void progress_end(const progress *p);

#endif
