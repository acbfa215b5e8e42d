/* Symbol visibility of the public interface. */
#ifndef ILSA_EXPORT_H
#define ILSA_EXPORT_H

#if defined(__GNUC__)
#define ILSA_API __attribute__((visibility("default")))
#else
#define ILSA_API
#endif

#endif
