#include <ilsa/version.h>

#define TEXT(number)   #number
#define EXPAND(number) TEXT(number)

int ilsa_version_number(void) {
    return 10000 * ILSA_VERSION_MAJOR + 100 * ILSA_VERSION_MINOR + ILSA_VERSION_PATCH;
}

const char *ilsa_version_string(void) {
    return EXPAND(ILSA_VERSION_MAJOR) "." EXPAND(ILSA_VERSION_MINOR) "." EXPAND(ILSA_VERSION_PATCH);
}
