/* A small reader for the comma-separated reference tables: one header row, no quoting. */
#ifndef TESTS_CSV_H
#define TESTS_CSV_H

#include <stddef.h>

typedef struct csv_table csv_table;

/*
 * The functions below end the test program with a message on stderr when the file cannot be read,
 * a row is ragged, a column does not exist, a row is out of range or a field is not a number: a
 * test must not pass because its data are missing.
 */

/* Reads a table; path is relative to the working directory, e.g. "tests/data/gdelta.csv". */
csv_table *csv_read(const char *path);

/* Releases a table; NULL is allowed. */
void csv_free(csv_table *table);

/* Number of data rows, without the header. */
size_t csv_rows(const csv_table *table);

/* A field as a number ("nan" and "inf" included); row 0 is the first after the header. */
double csv_get(const csv_table *table, size_t row, const char *column);

/* A field as text, owned by the table. */
const char *csv_text(const csv_table *table, size_t row, const char *column);

#endif
