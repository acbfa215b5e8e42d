#include "model/options.h"

#include <math.h>

typedef struct option_row {
    const char *name;
    double least, most;
    bool kept;
} option_row;

static const option_row rows[OPTION_COUNT] = {
#define ILSA_OPTION(member, kind, least, most, kept, section, ...) {#member, least, most, kept},
#include <ilsa/options.def>
#undef ILSA_OPTION
};

double ilsai_option(const ilsa_solver_def *def, int option) {
    const double values[OPTION_COUNT] = {
#define ILSA_OPTION(member, kind, least, most, kept, section, ...) (double)def->member,
#include <ilsa/options.def>
#undef ILSA_OPTION
    };
    return values[option];
}

bool ilsai_option_is_kept(int option) {
    return rows[option].kept;
}

const char *ilsai_option_name(int option) {
    return rows[option].name;
}

ilsa_status ilsai_options_check(const ilsa_solver_def *def, error_text *error) {
    for (int k = 0; k < OPTION_COUNT; k++) {
        double value = ilsai_option(def, k);
        if (value != 0) {
            ILSAI_TRY(
                isfinite(rows[k].most)
                    ? ilsai_check_range(error, rows[k].name, value, rows[k].least, rows[k].most)
                    : ilsai_check_not_negative(error, rows[k].name, value));
        }
    }
    return ILSA_OK;
}
