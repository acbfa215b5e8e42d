/* Runs the example programs in a directory of the test's own. */
#ifndef TESTS_PROGRAM_H
#define TESTS_PROGRAM_H

#include <stddef.h>

/* The functions below end the test program with a message on stderr when they cannot do their task.
 */

/* A fresh directory, the same at every call; removed when the test program ends. */
const char *program_directory(void);

/* The path of a file in it; valid until the fourth call after this one. */
const char *program_path(const char *name);

void program_write(const char *name, const char *text);

/* The whole file, which need not exist: NULL then. To be freed. */
char *program_read(const char *name);

int program_exists(const char *name);

/*
 * Runs a shell command line in the test's directory, "ilsa-run" at its head standing for the
 * program under test. Its exit status; what it wrote on both streams goes to output.
 */
int program_run(const char *command, char *output, size_t size);

/* The path of the program under test. */
const char *program_ilsa_run(void);

#endif
