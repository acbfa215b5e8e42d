/* The options of a solver, as the table ilsa/options.def lists them. */
#ifndef ILSAI_OPTIONS_H
#define ILSAI_OPTIONS_H

#include "base/error.h"
#include <ilsa/solver.h>
#include <stdbool.h>

enum {
#define ILSA_OPTION(member, kind, least, most, kept, section, ...) OPTION_##member,
#include <ilsa/options.def>
#undef ILSA_OPTION
    OPTION_COUNT
};

/* ILSA_OK, or ILSA_ERR_VALUE and a message that names the first option out of its range. */
ilsa_status ilsai_options_check(const ilsa_solver_def *def, error_text *error);

/* The value of an option, by its place in the table. */
double ilsai_option(const ilsa_solver_def *def, int option);

/* Whether a snapshot can be restored only where the option has the value it was taken with. */
bool ilsai_option_is_kept(int option);

/* The name of an option. */
const char *ilsai_option_name(int option);

#endif
