#include "base64.h"

static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

static void put_triple(const base64 *b, int bytes) {
    char text[4] = {digits[b->bits >> 18 & 63], digits[b->bits >> 12 & 63],
                    bytes > 1 ? digits[b->bits >> 6 & 63] : '=',
                    bytes > 2 ? digits[b->bits & 63] : '='};
    fwrite(text, 1, 4, b->stream);
}

void base64_put(base64 *b, const void *data, size_t size) {
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++) {
        b->bits = b->bits << 8 | bytes[i];
        if (++b->held == 3) {
            put_triple(b, 3);
            b->bits = 0;
            b->held = 0;
        }
    }
}

void base64_end(base64 *b) {
    if (b->held) {
        b->bits <<= 8 * (3 - b->held);
        put_triple(b, b->held);
    }
    b->bits = 0;
    b->held = 0;
}
