/* The version of libilsa; the Makefile reads it from here. */
#ifndef ILSA_VERSION_H
#define ILSA_VERSION_H

#include <ilsa/export.h>

#define ILSA_VERSION_MAJOR 0
#define ILSA_VERSION_MINOR 1
#define ILSA_VERSION_PATCH 0

#ifdef __cplusplus
extern "C" {
#endif

/* 10000 * major + 100 * minor + patch of the library that is linked. */
ILSA_API int ilsa_version_number(void);

/* "major.minor.patch" of the library that is linked. The text is static. */
ILSA_API const char *ilsa_version_string(void);

#ifdef __cplusplus
}
#endif
#endif
