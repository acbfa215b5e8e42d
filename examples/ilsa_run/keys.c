#include "keys.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* clang-format off: a table */
#define ANY                                                                                        \
    -INFINITY, INFINITY, 0, {                                                                      \
        NULL                                                                                       \
    }
#define POSITIVE                                                                                   \
    0, INFINITY, 1, {                                                                              \
        NULL                                                                                       \
    }
#define NOT_NEG                                                                                    \
    0, INFINITY, 0, {                                                                              \
        NULL                                                                                       \
    }

/* The options of the library are keys of their sections, after the sections' own. */
#define OPTION_KIND_WHOLE  KEY_WHOLE
#define OPTION_KIND_CHOICE KEY_CHOICE
#define OPTION_KIND_NUMBER KEY_NUMBER
#define OPTION_ROW(member, kind, least, most, ...)                                                 \
    {                                                                                              \
#member, OPTION_KIND_##kind, least, most, OPTION_KIND_##kind == KEY_NUMBER, {              \
            __VA_ARGS__                                                                            \
        }                                                                                          \
    }
#define OPTION_OF_NONE(...)
#define ILSA_OPTION(member, kind, least, most, kept, section, ...)                                 \
    OPTION_OF_##section(OPTION_ROW(member, kind, least, most, __VA_ARGS__))

const section_def sections[SECTION_COUNT] = {
    {"material",
     0,
     {{"E", KEY_NUMBER, POSITIVE},
      {"nu", KEY_NUMBER, 0, 0.5, 0, {NULL}},
      {"mu", KEY_NUMBER, NOT_NEG},
      {"K_Ic", KEY_NUMBER, NOT_NEG},
      {"C_L", KEY_NUMBER, NOT_NEG},
      {"E_prime", KEY_NUMBER, POSITIVE},
      {"mu_prime", KEY_NUMBER, NOT_NEG},
      {"K_prime", KEY_NUMBER, NOT_NEG},
      {"C_prime", KEY_NUMBER, NOT_NEG}}},
    {"mesh",
     0,
     {
         {"nx", KEY_WHOLE, 3, 1000000, 0, {NULL}},
         {"ny", KEY_WHOLE, 3, 1000000, 0, {NULL}},
         {"dx", KEY_NUMBER, POSITIVE},
         {"dy", KEY_NUMBER, POSITIVE},
#define OPTION_OF_MESH(...) __VA_ARGS__,
#define OPTION_OF_RUN(...)
#include <ilsa/options.def>
#undef OPTION_OF_MESH
#undef OPTION_OF_RUN
     }},
    {"stress",
     0,
     {{"sigma", KEY_LIST, ANY},
      {"interfaces", KEY_LIST, ANY},
      {"profile", KEY_FILE, ANY},
      {"origin_depth", KEY_NUMBER, ANY}}},
    {"injection",
     1,
     {{"rate", KEY_NUMBER, NOT_NEG},
      {"schedule", KEY_SCHEDULE, NOT_NEG},
      {"x", KEY_NUMBER, ANY},
      {"y", KEY_NUMBER, ANY}}},
    {"initial", 0, {{"radius", KEY_NUMBER, POSITIVE}, {"time", KEY_NUMBER, POSITIVE}}},
    {"run",
     0,
     {
         {"t_end", KEY_NUMBER, POSITIVE},
         {"output_times", KEY_LIST, POSITIVE},
         {"dt_initial", KEY_NUMBER, POSITIVE},
#define OPTION_OF_MESH(...)
#define OPTION_OF_RUN(...) __VA_ARGS__,
#include <ilsa/options.def>
     }},
};
/* clang-format on */

static const char *skip_blanks(const char *text) {
    return text + strspn(text, " \t\r");
}

/* Reads a finite number and the blanks around it. */
static int read_number(const char **text, double *number) {
    char *end;
    *number = strtod(*text, &end);
    if (end == *text || !isfinite(*number))
        return 0;
    *text = skip_blanks(end);
    return 1;
}

/* What is wrong with a number, or NULL. A key that has no use for 0 has none for what is nearly. */
static const char *check_range(const key_def *key, double number) {
    if (!(number <= key->max && (key->above_min ? number > key->min : number >= key->min)))
        return "";
    if (fabs(number) > MAGNITUDE_MOST)
        return "beyond 1e60; ";
    return key->above_min && number < MAGNITUDE_LEAST ? "under 1e-60; " : NULL;
}

static const char *read_single(const key_def *key, const char *text, key_value *value) {
    if (!read_number(&text, &value->number) || *text)
        return "not a number; ";
    if (key->kind == KEY_WHOLE && value->number != floor(value->number))
        return "not a whole number; ";
    return check_range(key, value->number);
}

static const char *read_choice(const key_def *key, const char *text, key_value *value) {
    for (int i = 0; key->words[i]; i++) {
        if (strcmp(text, key->words[i]) == 0) {
            value->number = i;
            return NULL;
        }
    }
    return "";
}

/* One entry of a list, or one pair of a schedule. */
static const char *read_entry(const key_def *key, const char **text, double *entry) {
    int schedule = key->kind == KEY_SCHEDULE;
    if (schedule) {
        if (!read_number(text, entry++) || **text != ':')
            return "not pairs t:Q; ";
        if (fabs(entry[-1]) > MAGNITUDE_MOST)
            return "beyond 1e60; ";
        ++*text;
    }
    if (!read_number(text, entry) || (**text && **text != ','))
        return schedule ? "not pairs t:Q; " : "not a list of numbers; ";
    return check_range(key, *entry);
}

static int times_rise_from_zero(const key_value *schedule) {
    const double *pair = schedule->numbers;
    if (pair[0] != 0)
        return 0;
    for (int i = 1; i < schedule->count; i++, pair += 2)
        if (pair[2] <= pair[0])
            return 0;
    return 1;
}

static const char *read_list(const key_def *key, const char *text, key_value *value) {
    size_t width = key->kind == KEY_SCHEDULE ? 2 : 1, commas = 0;
    for (const char *c = text; *c; c++)
        commas += *c == ',';
    value->numbers = malloc((commas + 1) * width * sizeof *value->numbers);
    if (!value->numbers)
        return "out of memory; ";
    for (;;) {
        const char *error = read_entry(key, &text, value->numbers + width * (size_t)value->count);
        if (error)
            return error;
        value->count++;
        if (!*text)
            break;
        text++;
    }
    return key->kind == KEY_SCHEDULE && !times_rise_from_zero(value) ? "" : NULL;
}

const char *key_read(const key_def *key, const char *text, key_value *value) {
    switch (key->kind) {
    case KEY_CHOICE:
        return read_choice(key, text, value);
    case KEY_FILE:
        return *text ? NULL : "";
    case KEY_LIST:
    case KEY_SCHEDULE:
        return read_list(key, text, value);
    default:
        return read_single(key, text, value);
    }
}

static void number_range(const key_def *key, char *text, size_t size) {
    if (isfinite(key->max))
        snprintf(text, size, "in %.10g .. %.10g", key->min, key->max);
    else if (isfinite(key->min))
        snprintf(text, size, "%s %.10g", key->above_min ? ">" : ">=", key->min);
    else
        snprintf(text, size, "finite");
}

void key_range(const key_def *key, char *text, size_t size) {
    char range[80];
    number_range(key, range, sizeof range);
    if (key->kind == KEY_LIST)
        snprintf(text, size, "numbers separated by commas, each %s", range);
    else if (key->kind == KEY_SCHEDULE)
        snprintf(text, size, "t:Q, t:Q, ... with the first t = 0, t rising and Q %s", range);
    else if (key->kind == KEY_WHOLE)
        snprintf(text, size, "a whole number %s", range);
    else if (key->kind == KEY_NUMBER)
        snprintf(text, size, "%s", range);
    else if (key->kind == KEY_FILE)
        snprintf(text, size, "the path of a file, from the directory of the scene on");
    if (key->kind != KEY_CHOICE)
        return;
    size_t used = (size_t)snprintf(text, size, "%s", key->words[0]);
    for (int i = 1; key->words[i] && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s",
                                 key->words[i + 1] ? ", " : " or ", key->words[i]);
}

void keys_print(FILE *stream) {
    char range[160];
    for (int i = 0; i < SECTION_COUNT; i++) {
        const section_def *s = &sections[i];
        fprintf(stream, "  [%s]%s\n", s->name,
                s->numbered ? ", a second source in [injection.2], and so on" : "");
        for (int k = 0; k < KEYS_MAX && s->keys[k].name; k++) {
            key_range(&s->keys[k], range, sizeof range);
            fprintf(stream, "    %-13s %s\n", s->keys[k].name, range);
        }
    }
}
