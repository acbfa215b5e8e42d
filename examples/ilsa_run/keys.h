/* The keys that a scene file may hold, and how their values are read. */
#ifndef ILSA_RUN_KEYS_H
#define ILSA_RUN_KEYS_H

#include <stddef.h>
#include <stdio.h>

typedef enum key_kind {
    KEY_NUMBER,
    KEY_WHOLE,    /* a whole number */
    KEY_LIST,     /* a, b, ... */
    KEY_SCHEDULE, /* t:a, t:b, ... the times from 0 up */
    KEY_CHOICE,   /* one of several words */
    KEY_FILE      /* the path of a file */
} key_kind;

typedef struct key_def {
    const char *name;
    key_kind kind;
    double min, max; /* of each number; infinite: no limit */
    int above_min;   /* min itself is excluded */
    const char *words[6];
} key_def;

enum { KEYS_MAX = 12 };

typedef struct section_def {
    const char *name;
    int numbered; /* [name.2], [name.3], ... may follow */
    key_def keys[KEYS_MAX];
} section_def;

/* The places of the keys in their sections. */
enum {
    SECTION_MATERIAL,
    SECTION_MESH,
    SECTION_STRESS,
    SECTION_INJECTION,
    SECTION_INITIAL,
    SECTION_RUN,
    SECTION_COUNT
};
enum {
    MATERIAL_E,
    MATERIAL_NU,
    MATERIAL_MU,
    MATERIAL_K_IC,
    MATERIAL_C_L,
    MATERIAL_E_PRIME,
    MATERIAL_MU_PRIME,
    MATERIAL_K_PRIME,
    MATERIAL_C_PRIME
};
enum {
    MESH_NX,
    MESH_NY,
    MESH_DX,
    MESH_DY,
#define OPTION_OF_MESH(member) MESH_##member,
#define OPTION_OF_RUN(member)
#define OPTION_OF_NONE(member)
#define ILSA_OPTION(member, kind, least, most, kept, section, ...) OPTION_OF_##section(member)
#include <ilsa/options.def>
#undef OPTION_OF_MESH
#undef OPTION_OF_RUN
};
enum { STRESS_SIGMA, STRESS_INTERFACES, STRESS_PROFILE, STRESS_ORIGIN_DEPTH };
enum { INJECTION_RATE, INJECTION_SCHEDULE, INJECTION_X, INJECTION_Y };
enum { INITIAL_RADIUS, INITIAL_TIME };
enum {
    RUN_T_END,
    RUN_OUTPUT_TIMES,
    RUN_DT_INITIAL,
#define OPTION_OF_MESH(member)
#define OPTION_OF_RUN(member) RUN_##member,
#include <ilsa/options.def>
#undef ILSA_OPTION
#undef OPTION_OF_MESH
#undef OPTION_OF_RUN
#undef OPTION_OF_NONE
};

extern const section_def sections[SECTION_COUNT];

/* The largest magnitude that the library takes, and the smallest that it takes for what is not 0.
 */
#define MAGNITUDE_MOST  1e60
#define MAGNITUDE_LEAST 1e-60

/* A value as read. */
typedef struct key_value {
    int line;         /* 0: the key was not given */
    const char *text; /* as in the file */
    double number;    /* NUMBER, WHOLE; CHOICE: the place of the word */
    double *numbers;  /* LIST: count values; SCHEDULE: count pairs t, a */
    int count;        /* of a text that is refused: those before the wrong one */
} key_value;

/*
 * Reads text into value. NULL: done; otherwise what is wrong with it ("" when it is out of range).
 * numbers is to be freed by the caller.
 */
const char *key_read(const key_def *key, const char *text, key_value *value);

/* What a key's value must be: "> 0", "in 0 .. 0.5", "yes or no". */
void key_range(const key_def *key, char *text, size_t size);

/* Prints all sections and keys with their ranges. */
void keys_print(FILE *stream);

#endif
