/* Result files, written whole: under a name ending in .part, which is dropped at the end. */
#ifndef ILSA_RUN_OUTFILE_H
#define ILSA_RUN_OUTFILE_H

#include <stdio.h>

typedef struct outfile {
    FILE *stream;
    char *path, *part; /* NULL when not open */
    long flushed;      /* bytes that outfile_flush has seen written */
} outfile;

/*
 * Each returns 1 when all is well; otherwise 0, and stderr has said which file cannot be written
 * and why. Of a file that fails the part that has been flushed stays, under its final name; if
 * there is none, nothing does.
 */
int outfile_open(outfile *file, const char *directory, const char *name);
int outfile_flush(outfile *file); /* what has been written so far can be read in NAME.part */
int outfile_close(outfile *file);

/* Whether all that was printed on stdout has been written; if not, stderr has said so. */
int output_written(void);

/*
 * Opens the standard streams that the caller has closed, so that no result file takes their place.
 * Writing to them fails.
 */
void output_guard(void);

/* Makes a directory and those above it. */
int directory_make(const char *path);

/* Removes the results of an earlier run from a directory. */
void directory_clear(const char *path);

/* "front_007.csv" for ("front", 7, "csv"): the name stands in a buffer of the caller. */
enum { NAME_SIZE = 64 };
const char *numbered_name(char *name, const char *stem, int number, const char *extension);

#endif
