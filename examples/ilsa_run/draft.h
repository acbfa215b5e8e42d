/* A scene as it was typed: sections with the values of their keys, each checked by itself. */
#ifndef ILSA_RUN_DRAFT_H
#define ILSA_RUN_DRAFT_H

#include "ini_file.h"
#include "keys.h"

#include <stdio.h>

typedef struct section {
    const char *name; /* "injection.2" */
    const section_def *def;
    long number; /* 2 for injection.2, 0 without a number */
    int line;    /* of its heading */
    key_value values[KEYS_MAX];
} section;

typedef struct draft {
    const char *path;
    FILE *errors;
    int error_count;
    ini_file file;
    section *sections;
    int count;
} draft;

/* Reads a file; what is wrong goes to errors and is counted. */
void draft_read(draft *d, const char *path, FILE *errors);

void draft_free(draft *d);

/* The section of a name, or NULL. */
section *draft_section(const draft *d, const char *name);

/*
 * Reports "file:line: [section] key = text: ..." and counts it. line 0: none; key or text may be
 * NULL.
 */
void draft_error(draft *d, int line, const char *section_name, const char *key, const char *text,
                 const char *format, ...) __attribute__((format(printf, 6, 7)));

/* The same about one key of a section, ending in ": must be RANGE". */
void draft_range_error(draft *d, const section *s, int key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Whether a key was given; if not, and it is required, that is reported. */
int draft_has(const section *s, int key);
int draft_require(draft *d, const section *s, int key);

#endif
