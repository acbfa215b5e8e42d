#include "profile.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/types.h>

typedef struct unit {
    const char *name;
    double factor; /* to m or Pa */
} unit;

static const unit lengths[] = {{"m", 1},       {"km", 1e3},    {"cm", 1e-2}, {"mm", 1e-3},
                               {"ft", 0.3048}, {"in", 0.0254}, {"-", 1},     {NULL, 0}};
static const unit stresses[] = {{"Pa", 1},
                                {"kPa", 1e3},
                                {"MPa", 1e6},
                                {"GPa", 1e9},
                                {"bar", 1e5},
                                {"psi", 6894.757293168361},
                                {"ksi", 6894757.293168361},
                                {"-", 1},
                                {NULL, 0}};

typedef struct column {
    char name[40]; /* as in the file, for messages */
    double factor;
} column;

typedef struct reader {
    const char *path;
    FILE *stream, *errors;
    profile *p;
    char *text; /* the present line */
    size_t room;
    int line;
    int row_line; /* of the last row taken */
    char separator;
    column place, sigma;
    double shown; /* the last place as it stands in the file */
    int capacity;
} reader;

static int fail(const reader *r, const char *format, ...) __attribute__((format(printf, 2, 3)));

static int fail(const reader *r, const char *format, ...) {
    va_list arguments;
    fprintf(r->errors, "%s:%d: ", r->path, r->line);
    va_start(arguments, format);
    vfprintf(r->errors, format, arguments);
    va_end(arguments);
    fputc('\n', r->errors);
    return 0;
}

/* What concerns the file and not a line of it. */
static int fail_whole(const reader *r, int error) {
    fprintf(r->errors, "%s: %s\n", r->path, strerror(error));
    return 0;
}

/* Without the blanks around it, and the quotes that spreadsheets put there. */
static char *trim(char *text) {
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\r\n\"", text[length - 1]))
        text[--length] = '\0';
    return text + strspn(text, " \t\"");
}

/* Reads the next line that holds something. 1, 0 at the end of the file, -1 with a message. */
static int next_line(reader *r) {
    ssize_t length;
    errno = 0;
    while ((length = getline(&r->text, &r->room, r->stream)) >= 0) {
        r->line++;
        if (strlen(r->text) < (size_t)length) {
            fail(r, "not a text file");
            return -1;
        }
        if (r->line == 1 && strncmp(r->text, "\xEF\xBB\xBF", 3) == 0)
            memmove(r->text, r->text + 3, (size_t)length - 2);
        r->text[strcspn(r->text, "#")] = '\0';
        if (r->text[strspn(r->text, " \t\r\n")])
            return 1;
    }
    if (errno == 0 && !ferror(r->stream))
        return 0;
    fail_whole(r, errno ? errno : EIO);
    return -1;
}

/* Cuts the line in two at its separator. */
static int split(reader *r, char **first, char **second) {
    int columns = 1;
    char *end = strchr(r->text, r->separator);
    for (const char *c = r->text; *c; c++)
        columns += *c == r->separator;
    if (!end || columns != 2)
        return fail(r, "%d column%s; must be 2, depth or y and stress", columns,
                    columns == 1 ? "" : "s");
    *end = '\0';
    *first = trim(r->text);
    *second = trim(end + 1);
    return 1;
}

static const unit *find_unit(const unit *units, const char *name) {
    while (units->name && strcasecmp(units->name, name) != 0)
        units++;
    return units->name ? units : NULL;
}

static int unknown_unit(const reader *r, const char *heading, const unit *units) {
    char names[100] = "";
    size_t used = 0;
    for (; units->name; units++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "",
                                 units->name);
    return fail(r,
                "%.60s: no unit that is known; a name and one of %s must stand there, as in "
                "\"y (m), sigma (Pa)\"; - is the scene's own",
                heading, names);
}

/* "name (unit)" or "name [unit]" */
static int read_heading(const reader *r, char *heading, const unit *units, column *c) {
    char *open = strpbrk(heading, "(["), *close = open ? strpbrk(open, ")]") : NULL;
    if (!close || close[1])
        return unknown_unit(r, heading, units);
    char name[sizeof c->name];
    snprintf(name, sizeof name, "%.*s", (int)(close - open - 1), open + 1);
    const unit *found = find_unit(units, trim(name));
    if (!found)
        return unknown_unit(r, heading, units);
    snprintf(name, sizeof name, "%.*s", (int)(open - heading), heading);
    snprintf(c->name, sizeof c->name, "%s", trim(name));
    c->factor = found->factor;
    return 1;
}

static int read_headings(reader *r) {
    char *first = NULL, *second = NULL;
    r->separator = (char)(strchr(r->text, '\t') ? '\t' : strchr(r->text, ';') ? ';' : ',');
    if (!split(r, &first, &second))
        return 0;
    if (!read_heading(r, first, lengths, &r->place) ||
        !read_heading(r, second, stresses, &r->sigma))
        return 0;
    r->p->downward =
        strcasecmp(r->place.name, "depth") == 0 || strcasecmp(r->place.name, "TVD") == 0;
    return r->p->downward || strcasecmp(r->place.name, "y") == 0
               ? 1
               : fail(r, "%s: the first column must be y (upwards), depth or TVD (downwards)",
                      r->place.name);
}

static int read_number(const reader *r, const column *c, char *text, double *number) {
    char *end, *comma = r->separator == ',' ? NULL : strchr(text, ',');
    if (comma)
        *comma = '.';
    *number = strtod(text, &end);
    if (end == text || *end || !isfinite(*number))
        return fail(r, "%s = %.60s: not a number", c->name, text);
    return fabs(*number * c->factor) <= 1e60 ? 1
                                             : fail(r, "%s = %.60s: beyond 1e60", c->name, text);
}

/* Loggers write these where they have measured nothing. */
static int is_missing(double sigma) {
    static const double marks[] = {-999.25, -9999.25, -999, -9999};
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
        if (sigma == marks[i])
            return 1;
    return 0;
}

static int make_room(double **values, size_t count) {
    double *more = realloc(*values, count * sizeof *more);
    if (more)
        *values = more;
    return more != NULL;
}

static int add_row(reader *r, double place, double sigma) {
    profile *p = r->p;
    if (p->count == r->capacity) {
        int capacity = 2 * r->capacity + 64;
        if (!make_room(&p->place, (size_t)capacity) || !make_room(&p->sigma, (size_t)capacity))
            return fail(r, "out of memory");
        r->capacity = capacity;
    }
    p->place[p->count] = place;
    p->sigma[p->count++] = sigma;
    return 1;
}

/* Places rise, or fall, all the way. */
static int keeps_on(const reader *r, double place) {
    const profile *p = r->p;
    double last = p->count ? p->place[p->count - 1] : 0;
    int rises = p->count < 2 || p->place[1] > p->place[0];
    return p->count == 0 || (place != last && (p->count == 1 || (place > last) == rises));
}

static int read_row(reader *r) {
    char *first = NULL, *second = NULL;
    double place, sigma;
    if (!split(r, &first, &second) || !read_number(r, &r->place, first, &place) ||
        !read_number(r, &r->sigma, second, &sigma))
        return 0;
    if (is_missing(sigma))
        return fail(r, "%s = %g: marks what was not measured; such rows must be left out",
                    r->sigma.name, sigma);
    if (!keeps_on(r, place * r->place.factor))
        return fail(r, "%s = %.15g after %.15g on line %d: must rise from row to row, or fall",
                    r->place.name, place, r->shown, r->row_line);
    r->shown = place;
    r->row_line = r->line;
    return add_row(r, place * r->place.factor, sigma * r->sigma.factor);
}

static void reverse(double *values, int count) {
    for (int i = 0, k = count - 1; i < k; i++, k--) {
        double value = values[i];
        values[i] = values[k];
        values[k] = value;
    }
}

static int read_table(reader *r) {
    int more = next_line(r);
    if (more == 0)
        return fail(r, "empty; must begin with names and units, as in \"y (m), sigma (Pa)\"");
    if (more < 0 || !read_headings(r))
        return 0;
    while ((more = next_line(r)) > 0)
        if (!read_row(r))
            return 0;
    if (more < 0)
        return 0;
    if (r->p->count < 2)
        return fail(r, "%d row%s below the names; must be 2 or more", r->p->count,
                    r->p->count == 1 ? "" : "s");
    if (r->p->place[0] > r->p->place[1]) {
        reverse(r->p->place, r->p->count);
        reverse(r->p->sigma, r->p->count);
    }
    return 1;
}

int profile_read(FILE *stream, const char *path, profile *p, FILE *errors) {
    reader r = {.path = path, .stream = stream, .errors = errors, .p = p};
    *p = (profile){0};
    int good = read_table(&r);
    free(r.text);
    if (!good)
        profile_free(p);
    return good;
}

void profile_free(profile *p) {
    free(p->place);
    free(p->sigma);
    *p = (profile){0};
}
