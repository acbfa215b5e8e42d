#include "draft.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* Of a value that may be a log of thousands of layers. */
enum { SHOWN = 100 };

static void begin_error(draft *d, int line, const char *section_name, const char *key,
                        const char *text) {
    d->error_count++;
    fprintf(d->errors, "%s:", d->path);
    if (line > 0)
        fprintf(d->errors, "%d:", line);
    if (section_name)
        fprintf(d->errors, " [%s]", section_name);
    if (key)
        fprintf(d->errors, " %s", key);
    if (text)
        fprintf(d->errors, strlen(text) > SHOWN ? " = %.*s..." : " = %.*s", SHOWN, text);
    fputs(section_name ? ": " : " ", d->errors);
}

void draft_error(draft *d, int line, const char *section_name, const char *key, const char *text,
                 const char *format, ...) {
    va_list arguments;
    begin_error(d, line, section_name, key, text);
    va_start(arguments, format);
    vfprintf(d->errors, format, arguments);
    va_end(arguments);
    fputc('\n', d->errors);
}

void draft_range_error(draft *d, const section *s, int key, const char *format, ...) {
    const key_value *value = &s->values[key];
    va_list arguments;
    begin_error(d, value->line, s->name, s->def->keys[key].name, value->text);
    fputs("must be ", d->errors);
    va_start(arguments, format);
    vfprintf(d->errors, format, arguments);
    va_end(arguments);
    fputc('\n', d->errors);
}

/* 2 for "injection.2" and "injection"; 2 .. 1000 without leading zeros, 0 for anything else. */
static long section_number(const char *name, const char *stem) {
    size_t length = strlen(stem);
    if (strncmp(name, stem, length) != 0 || name[length] != '.')
        return 0;
    const char *digits = name + length + 1;
    size_t count = strspn(digits, "0123456789");
    long number = count > 0 && count <= 4 ? strtol(digits, NULL, 10) : 0;
    return !digits[count] && digits[0] != '0' && number >= 2 && number <= 1000 ? number : 0;
}

static const section_def *find_def(const char *name) {
    for (int i = 0; i < SECTION_COUNT; i++)
        if (strcmp(sections[i].name, name) == 0 ||
            (sections[i].numbered && section_number(name, sections[i].name)))
            return &sections[i];
    return NULL;
}

static int find_key(const section_def *def, const char *name) {
    for (int i = 0; i < KEYS_MAX && def->keys[i].name; i++)
        if (strcmp(def->keys[i].name, name) == 0)
            return i;
    return -1;
}

section *draft_section(const draft *d, const char *name) {
    for (int i = 0; i < d->count; i++)
        if (strcmp(d->sections[i].name, name) == 0)
            return &d->sections[i];
    return NULL;
}

static void take_heading(draft *d, const ini_item *item) {
    const section_def *def = find_def(item->section);
    const section *before = draft_section(d, item->section);
    if (!def)
        draft_error(d, item->line, item->section, NULL, NULL,
                    "unknown section; must be material, mesh, stress, injection, injection.2 .. "
                    "injection.1000, initial or run");
    else if (before)
        draft_error(d, item->line, item->section, NULL, NULL, "given twice, first on line %d",
                    before->line);
    if (!def || before)
        return;
    section *more = realloc(d->sections, (size_t)(d->count + 1) * sizeof *more);
    if (!more) {
        draft_error(d, item->line, item->section, NULL, NULL, "out of memory");
        return;
    }
    d->sections = more;
    d->sections[d->count++] = (section){.name = item->section,
                                        .def = def,
                                        .number = section_number(item->section, def->name),
                                        .line = item->line};
}

static void unknown_key(draft *d, const ini_item *item, const section_def *def) {
    char names[200] = "";
    size_t used = 0;
    for (int i = 0; i < KEYS_MAX && def->keys[i].name; i++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "",
                                 def->keys[i].name);
    draft_error(d, item->line, item->section, item->name, item->value,
                "unknown key; must be one of %s", names);
}

static void take_key(draft *d, const ini_item *item) {
    section *s = draft_section(d, item->section);
    if (!*item->section)
        draft_error(d, item->line, NULL, NULL, NULL, "%s stands before the first [section]",
                    item->name);
    if (!s)
        return; /* an unknown section, reported at its heading */
    int key = find_key(s->def, item->name);
    if (key < 0) {
        unknown_key(d, item, s->def);
        return;
    }
    key_value *value = &s->values[key];
    if (value->line) {
        draft_error(d, item->line, item->section, item->name, item->value,
                    "given twice, first on line %d", value->line);
        return;
    }
    value->line = item->line;
    value->text = item->value;
    const char *wrong = key_read(&s->def->keys[key], item->value, value);
    if (wrong) {
        char range[160], place[40] = "";
        key_kind kind = s->def->keys[key].kind;
        key_range(&s->def->keys[key], range, sizeof range);
        if (strlen(item->value) > SHOWN && (kind == KEY_LIST || kind == KEY_SCHEDULE))
            snprintf(place, sizeof place, "entry %d: ", value->count + 1);
        draft_error(d, item->line, item->section, item->name, item->value, "%s%smust be %s", place,
                    wrong, range);
    }
}

void draft_read(draft *d, const char *path, FILE *errors) {
    *d = (draft){.path = path, .errors = errors};
    if (!ini_file_read(path, &d->file)) {
        draft_error(d, 0, NULL, NULL, NULL, "%s", strerror(errno));
        return;
    }
    if (d->file.error) {
        /* What follows may be misread. */
        draft_error(d, d->file.error_line, NULL, NULL, NULL, "%s", d->file.error);
        return;
    }
    for (int i = 0; i < d->file.count; i++) {
        if (d->file.items[i].name)
            take_key(d, &d->file.items[i]);
        else
            take_heading(d, &d->file.items[i]);
    }
}

void draft_free(draft *d) {
    for (int i = 0; i < d->count; i++)
        for (int k = 0; k < KEYS_MAX; k++)
            free(d->sections[i].values[k].numbers);
    free(d->sections);
    ini_file_free(&d->file);
}

int draft_has(const section *s, int key) {
    return s->values[key].line > 0;
}

int draft_require(draft *d, const section *s, int key) {
    char range[160];
    if (draft_has(s, key))
        return 1;
    key_range(&s->def->keys[key], range, sizeof range);
    draft_error(d, s->line, s->name, s->def->keys[key].name, NULL, "missing; must be %s", range);
    return 0;
}
