/* Base64, as inline binary data of XML files are written. */
#ifndef ILSA_RUN_BASE64_H
#define ILSA_RUN_BASE64_H

#include <stddef.h>
#include <stdio.h>

/* One stream of bytes, given piece by piece. Start with {stream}. */
typedef struct base64 {
    FILE *stream;
    unsigned bits; /* up to 2 bytes not yet written */
    int held;
} base64;

void base64_put(base64 *b, const void *data, size_t size);
void base64_end(base64 *b);

#endif
