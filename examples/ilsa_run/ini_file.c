#include "ini_file.h"

#include <ctype.h>
#include <errno.h>
#include <ini.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

/*
 * inih finds names and continuations, and what is neither. It hands its handler no line numbers
 * unless built so, and cuts lines to a buffer of 200 characters: the reader counts the lines, keeps
 * the present one whole and takes the values from it.
 */
typedef struct reader {
    FILE *stream;
    ini_file *file;
    char *section;
    char *text; /* the present line, from its first word to its last */
    size_t room;
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
    size_t length = strlen(item->value), extra = strlen(more);
    char *value = realloc(item->value, length + extra + 2);
    if (!value) {
        r->no_memory = 1;
        return;
    }
    value[length] = ' ';
    memcpy(value + length + 1, more, extra + 1);
    item->value = value;
}

static char *skip_blanks(char *text) {
    return text + strspn(text, " \t\r");
}

static int take_pair(void *user, const char *section, const char *name, const char *value) {
    reader *r = user;
    (void)section; /* inih cuts it to 49 characters, and the value with its line */
    (void)value;
    if (r->continued)
        continue_item(r, r->text);
    else
        add_item(r, name, skip_blanks(r->text + strcspn(r->text, "=:") + 1));
    return 1;
}

static void drop(char *text, size_t count) {
    memmove(text, text + count, strlen(text + count) + 1);
}

/* Where a comment begins: a ; or # at the start or after a blank. */
static size_t comment_start(const char *text) {
    size_t at = strcspn(text, ";#");
    while (text[at] && at > 0 && !strchr(" \t", text[at - 1]))
        at += 1 + strcspn(text + at + 1, ";#");
    return at;
}

/* Reads one line, without its comment and the blanks at its end. 0 at the end of the file. */
static int get_line(reader *r) {
    static const char byte_order_mark[] = "\xEF\xBB\xBF";
    errno = 0;
    ssize_t length = getline(&r->text, &r->room, r->stream);
    if (length < 0) {
        r->no_memory |= errno == ENOMEM;
        return 0;
    }
    r->file->lines++;
    if (strlen(r->text) < (size_t)length)
        set_error(r->file, r->file->lines, "not a text file");
    if (r->file->lines == 1 && strncmp(r->text, byte_order_mark, 3) == 0)
        drop(r->text, 3);
    size_t end = comment_start(r->text);
    while (end > 0 && strchr(" \t\r\n", r->text[end - 1]))
        end--;
    r->text[end] = '\0';
    return 1;
}

static void take_heading(reader *r, const char *start) {
    const char *end = strchr(start, ']');
    if (!end || !strchr(";#", end[1 + strspn(end + 1, " \t")])) {
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
 * they are moved to the margin, and what does continue stands one blank from it.
 */
static char *read_line(char *line, int size, void *user) {
    reader *r = user;
    if (!get_line(r))
        return NULL;
    size_t indent = strspn(r->text, " \t");
    drop(r->text, indent);
    r->continued = 0;
    if (*r->text == '[')
        take_heading(r, r->text);
    else if (indent > 0 && *r->text && !strchr(r->text, '='))
        r->continued = r->file->count > 0 && r->file->items[r->file->count - 1].name != NULL;
    snprintf(line, (size_t)size, "%s%s", r->continued ? " " : "", r->text);
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
    free(r.text);
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
