#include "ini_file.h"

#include <ctype.h>
#include <errno.h>
#include <ini.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* inih hands its handler no line numbers unless built so: the reader counts them. */
typedef struct reader {
    FILE *stream;
    ini_file *file;
    char *section;
    int continued; /* this line goes on with the value of the last item */
    int no_memory;
} reader;

static void set_error(ini_file *file, int line, const char *error) {
    if (!file->error) {
        file->error = error;
        file->error_line = line;
    }
}

static void add_item(reader *r, const char *name, const char *value) {
    ini_file *file = r->file;
    ini_item *items = realloc(file->items, (size_t)(file->count + 1) * sizeof *items);
    if (!items) {
        r->no_memory = 1;
        return;
    }
    file->items = items;
    ini_item *item = &items[file->count++];
    item->line = file->lines;
    item->section = strdup(r->section ? r->section : "");
    item->name = name ? strdup(name) : NULL;
    item->value = value ? strdup(value) : NULL;
    if (!item->section || (name && !item->name) || (value && !item->value))
        r->no_memory = 1;
}

static void continue_item(reader *r, const char *more) {
    ini_item *item = &r->file->items[r->file->count - 1];
    size_t length = strlen(item->value), extra = strcspn(more, ";");
    char *value = realloc(item->value, length + extra + 2);
    if (!value) {
        r->no_memory = 1;
        return;
    }
    value[length] = ' ';
    memcpy(value + length + 1, more, extra);
    value[length + 1 + extra] = '\0';
    item->value = value;
}

static int take_pair(void *user, const char *section, const char *name, const char *value) {
    reader *r = user;
    (void)section; /* inih cuts it to 49 characters; the reader has it whole */
    if (r->continued)
        continue_item(r, value);
    else
        add_item(r, name, value);
    return 1;
}

/* Reads one line without its end; longer ones are cut and reported. 0 at the end of the file. */
static int get_line(reader *r, char *line, int size) {
    int length = 0, c;
    while ((c = getc(r->stream)) != EOF && c != '\n') {
        if (c == '\0')
            set_error(r->file, r->file->lines + 1, "not a text file");
        else if (length < size - 1)
            line[length++] = (char)c;
        else
            set_error(r->file, r->file->lines + 1,
                      "line too long; go on with a list on a line that starts with a blank");
    }
    line[length] = '\0';
    if (c == EOF && length == 0)
        return 0;
    r->file->lines++;
    return 1;
}

static void take_heading(reader *r, const char *start) {
    const char *end = strchr(start, ']');
    if (!end || !strchr(";#", end[1 + strspn(end + 1, " \t\r")])) {
        set_error(r->file, r->file->lines, "a heading must be [section]");
        return;
    }
    free(r->section);
    r->section = strndup(start + 1, (size_t)(end - start - 1));
    if (!r->section)
        r->no_memory = 1;
    else
        add_item(r, NULL, NULL);
}

/*
 * inih takes every indented line for a continuation. Headings and keys may be indented here, so
 * they are moved to the margin.
 */
static char *read_line(char *line, int size, void *user) {
    static const char byte_order_mark[] = "\xEF\xBB\xBF";
    reader *r = user;
    if (!get_line(r, line, size))
        return NULL;
    if (r->file->lines == 1 && strncmp(line, byte_order_mark, 3) == 0)
        memmove(line, line + 3, strlen(line + 3) + 1);
    char *start = line + strspn(line, " \t");
    int is_key = memchr(start, '=', strcspn(start, ";")) != NULL;
    r->continued = 0;
    if (*start == '[')
        take_heading(r, start);
    else if (start > line && !is_key)
        r->continued = r->file->count > 0 && r->file->items[r->file->count - 1].name != NULL;
    if (!r->continued)
        memmove(line, start, strlen(start) + 1);
    return line;
}

int ini_file_read(const char *path, ini_file *file) {
    reader r = {.file = file};
    memset(file, 0, sizeof *file);
    r.stream = fopen(path, "r");
    if (!r.stream)
        return 0;
    int bad_line = ini_parse_stream(read_line, &r, take_pair, &r);
    int failed = ferror(r.stream) ? errno : r.no_memory ? ENOMEM : 0;
    fclose(r.stream);
    free(r.section);
    if (bad_line > 0)
        set_error(file, bad_line, "neither [section] nor key = value");
    if (!failed)
        return 1;
    ini_file_free(file);
    errno = failed;
    return 0;
}

void ini_file_free(ini_file *file) {
    for (int i = 0; i < file->count; i++) {
        free(file->items[i].section);
        free(file->items[i].name);
        free(file->items[i].value);
    }
    free(file->items);
    memset(file, 0, sizeof *file);
}
