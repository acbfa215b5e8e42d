/* history.csv: a row per accepted step. */
#ifndef ILSA_RUN_HISTORY_H
#define ILSA_RUN_HISTORY_H

#include "outfile.h"

#include <ilsa/ilsa.h>

/* Each returns 1, or 0 when the file cannot be written (stderr has said so). */
int history_open(outfile *file, const char *directory);
int history_row(outfile *file, const ilsa_summary *s, const ilsa_report *step, double wall_s);

#endif
