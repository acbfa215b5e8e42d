/* How a failed call says what was wrong with it. */
#ifndef ILSAI_ERROR_H
#define ILSAI_ERROR_H

#include <ilsa/status.h>
#include <stdbool.h>

/* Makes a call that returns a status. The calling function returns any status but ILSA_OK. */
#define ILSAI_TRY(call)                                                                            \
    do {                                                                                           \
        const ilsa_status tried_status = (call);                                                   \
        if (tried_status != ILSA_OK) {                                                             \
            return tried_status;                                                                   \
        }                                                                                          \
    } while (0)

typedef struct error_text {
    char text[256];
} error_text;

/*
 * Writes the message into *error (NULL: nowhere) and returns the status, so that a check reads
 * `return ilsai_fail(...)`. Messages name the argument, its value and the valid range. They may be
 * made from the text that they replace.
 */
ilsa_status ilsai_fail(error_text *error, ilsa_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The message of the calling thread, for creates and for handles that hold no message. */
error_text *ilsai_thread_error(void);

/*
 * Calls that only read a solver cannot leave their message with it: the thread's holds it, and is
 * the one to be shown until a later call of the thread fails. Returns the status.
 */
ilsa_status ilsai_fail_reading(ilsa_status status);
/* Whether the last failure of the calling thread was of such a call. */
bool ilsai_reading_failed(void);

/* ILSA_OK or ILSA_ERR_VALUE with the message "name = value: must be ...". */
ilsa_status ilsai_check_finite(error_text *error, const char *name, double value);
ilsa_status ilsai_check_positive(error_text *error, const char *name, double value);
ilsa_status ilsai_check_not_negative(error_text *error, const char *name, double value);
/* ILSA_OK or ILSA_ERR_VALUE with the message "name = value: must be low .. high". */
ilsa_status ilsai_check_range(error_text *error, const char *name, double value, double low,
                              double high);

/* ILSA_OK or ILSA_ERR_NULL with the message "name is NULL". */
ilsa_status ilsai_check_pointer(error_text *error, const char *name, const void *pointer);

#endif
