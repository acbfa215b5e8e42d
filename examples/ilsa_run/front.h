/* The front and the survey cells that hold it, as tables. */
#ifndef ILSA_RUN_FRONT_H
#define ILSA_RUN_FRONT_H

#include <ilsa/ilsa.h>

/*
 * front_NNN.csv: closed polylines, the first point repeated last, with a column loop when there
 * are several. survey_NNN.csv: the survey cells and their place in the parametric triangle.
 * 1, or 0 with a message on stderr. *loops is the number of polylines.
 */
int front_write(const char *directory, int number, ilsa_solver *solver, int *loops);
int survey_write(const char *directory, int number, ilsa_solver *solver);

#endif
