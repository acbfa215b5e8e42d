/* A scene file as it stands: headings and keys in order, each with its line. */
#ifndef ILSA_RUN_INI_FILE_H
#define ILSA_RUN_INI_FILE_H

/* A heading [section] (name and value NULL) or a key of the heading before it. */
typedef struct ini_item {
    int line;
    char *section; /* "" before the first heading */
    char *name;
    char *value; /* continuation lines joined by a blank */
} ini_item;

typedef struct ini_file {
    ini_item *items;
    int count;
    int lines;         /* of the whole file */
    const char *error; /* what is wrong with error_line, or NULL */
    int error_line;
} ini_file;

/*
 * Reads a file. 1: read, though perhaps with an error set; 0: it cannot be read, errno says why.
 * Lines are of any length. One that starts with a blank and has no '=' continues the value above
 * it; a ; or # at the start of a line or after a blank begins a comment.
 */
int ini_file_read(const char *path, ini_file *file);

void ini_file_free(ini_file *file);

#endif
