#include "base/error.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* The message of the thread, and whether it is that of a call that only reads a solver. */
static _Thread_local struct {
    error_text error;
    bool of_reading;
} of_thread;

const char *ilsa_status_text(ilsa_status status) {
    switch (status) {
    case ILSA_OK:
        return "done";
    case ILSA_STEP_REJECTED:
        return "no solution was found for this step: try a smaller one";
    case ILSA_MESH_EDGE:
        return "the footprint would leave the mesh";
    case ILSA_STEP_TOO_LARGE:
        return "the front would pass more cells than one step may: try a smaller one";
    case ILSA_STALLED:
        return "no progress: steps were refused down to the smallest, or again and again";
    case ILSA_CLOSED:
        return "every cell is closed and nothing is injected";
    case ILSA_NO_SPACE:
        return "the buffer is too small";
    case ILSA_ERR_NULL:
        return "a required pointer is NULL";
    case ILSA_ERR_VALUE:
        return "an argument is not finite or out of its range";
    case ILSA_ERR_MEMORY:
        return "out of memory";
    case ILSA_ERR_STATE:
        return "there is no fracture, or it is in no state for this call";
    case ILSA_ERR_MISMATCH:
        return "handles or definitions do not belong together";
    case ILSA_ERR_SNAPSHOT:
        return "the snapshot is foreign, truncated, altered or of another version";
    case ILSA_ERR_NUMERIC:
        return "reserved: no call gives this status";
    }
    return "unknown status";
}

ilsa_status ilsai_fail(error_text *error, ilsa_status status, const char *format, ...) {
    if (error) {
        /* Written aside first: an argument may point into the text that is replaced. */
        char text[sizeof error->text];
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(text, sizeof text, format, arguments);
        va_end(arguments);
        memcpy(error->text, text, strlen(text) + 1);
        of_thread.of_reading = false;
    }
    return status;
}

error_text *ilsai_thread_error(void) {
    return &of_thread.error;
}

ilsa_status ilsai_fail_reading(ilsa_status status) {
    of_thread.of_reading = status != ILSA_OK || of_thread.of_reading;
    return status;
}

bool ilsai_reading_failed(void) {
    return of_thread.of_reading;
}

static ilsa_status refuse(error_text *error, const char *name, double value, const char *range) {
    return ilsai_fail(error, ILSA_ERR_VALUE, "%s = %g: must be %s", name, value, range);
}

ilsa_status ilsai_check_finite(error_text *error, const char *name, double value) {
    return isfinite(value) ? ILSA_OK : refuse(error, name, value, "finite");
}

ilsa_status ilsai_check_positive(error_text *error, const char *name, double value) {
    return isfinite(value) && value > 0 ? ILSA_OK : refuse(error, name, value, "finite and > 0");
}

ilsa_status ilsai_check_not_negative(error_text *error, const char *name, double value) {
    return isfinite(value) && value >= 0 ? ILSA_OK : refuse(error, name, value, "finite and >= 0");
}

ilsa_status ilsai_check_range(error_text *error, const char *name, double value, double low,
                              double high) {
    return value >= low && value <= high
               ? ILSA_OK
               : ilsai_fail(error, ILSA_ERR_VALUE, "%s = %g: must be %g .. %g", name, value, low,
                            high);
}

ilsa_status ilsai_check_pointer(error_text *error, const char *name, const void *pointer) {
    return pointer ? ILSA_OK : ilsai_fail(error, ILSA_ERR_NULL, "%s is NULL", name);
}
