/* A stress log as an engineer exports it: a table of two columns, depth or height and stress. */
#ifndef ILSA_RUN_PROFILE_H
#define ILSA_RUN_PROFILE_H

#include <stdio.h>

/* In m and Pa, or in the scene's own units where the table has none. */
typedef struct profile {
    int downward;          /* place is a depth, else a height y */
    int count;             /* rows, 2 or more */
    double *place, *sigma; /* the places rise */
} profile;

/*
 * Reads a table from a stream; path is its name in messages. It has a first row of names and units,
 * "y (m), sigma (Pa)", then a row for each place, up or down. Comma, semicolon or tab stand between
 * the columns, a comma may stand for the decimal point where it does not; a # begins a comment.
 * What is wrong goes to errors, with file and line; the result is then 0.
 */
int profile_read(FILE *stream, const char *path, profile *p, FILE *errors);

void profile_free(profile *p);

#endif
