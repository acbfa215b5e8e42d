#include "csv.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct csv_table {
    char *path;
    char *text; /* the file, separators replaced by zero bytes */
    size_t columns, rows;
    char **field; /* (rows + 1) x columns, the header first */
};

_Noreturn static void fail(const char *path, const char *what, const char *which) {
    fprintf(stderr, "csv: %s: %s %s\n", path, what, which);
    exit(EXIT_FAILURE);
}

static void *allocate(size_t count, size_t size) {
    void *block = calloc(count > 0 ? count : 1, size);
    if (!block)
        fail("-", "out of", "memory");
    return block;
}

static char *read_text(const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file)
        fail(path, "cannot be", "opened");
    size_t length = 0, room = 1 << 16;
    char *text = allocate(room, 1);
    for (size_t got; (got = fread(text + length, 1, room - length - 1, file)) > 0;) {
        length += got;
        if (length + 1 == room) {
            room *= 2;
            text = realloc(text, room);
            if (!text)
                fail(path, "out of", "memory");
        }
    }
    text[length] = '\0';
    fclose(file);
    return text;
}

static size_t count_char(const char *text, char c) {
    size_t count = 0;
    for (; *text; text++)
        count += (*text == c);
    return count;
}

/* Splits one line in place; returns the start of the next. */
static char *split_line(csv_table *table, char *line, char **field) {
    char *end = line + strcspn(line, "\r\n");
    char *next = end + strspn(end, "\r\n");
    *end = '\0';
    if (count_char(line, ',') + 1 != table->columns)
        fail(table->path, "ragged row:", line);
    for (size_t k = 0; k < table->columns; k++) {
        field[k] = line;
        line += strcspn(line, ",");
        *line++ = '\0';
    }
    return next;
}

csv_table *csv_read(const char *path) {
    csv_table *table = allocate(1, sizeof *table);
    table->path = allocate(strlen(path) + 1, 1);
    memcpy(table->path, path, strlen(path));
    table->text = read_text(path);
    table->columns = 1;
    for (const char *c = table->text; *c && *c != '\n'; c++)
        table->columns += (*c == ',');
    size_t lines = count_char(table->text, '\n') + 1;
    table->field = allocate(lines * table->columns, sizeof *table->field);
    size_t line = 0;
    for (char *next = table->text; *next; line++)
        next = split_line(table, next, table->field + line * table->columns);
    if (line < 2)
        fail(path, "has no", "rows");
    table->rows = line - 1;
    return table;
}

void csv_free(csv_table *table) {
    if (!table)
        return;
    free(table->field);
    free(table->text);
    free(table->path);
    free(table);
}

size_t csv_rows(const csv_table *table) {
    return table->rows;
}

const char *csv_text(const csv_table *table, size_t row, const char *column) {
    if (row >= table->rows)
        fail(table->path, "row out of range, column", column);
    size_t k = 0;
    while (k < table->columns && strcmp(table->field[k], column) != 0)
        k++;
    if (k == table->columns)
        fail(table->path, "no column", column);
    return table->field[(row + 1) * table->columns + k];
}

double csv_get(const csv_table *table, size_t row, const char *column) {
    const char *text = csv_text(table, row, column);
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end)
        fail(table->path, "not a number:", text);
    return value;
}
