#include "utf8.h"

#include <stdbool.h>

static const char hexadecimal[] = "0123456789abcdef";

/* Shortest forms only, no surrogates, up to U+10FFFF: RFC 3629, section 4. */
size_t fio_utf8_character(const char *bytes, size_t size) {
    const unsigned char *b = (const unsigned char *)bytes;
    if (size == 0)
        return 0;
    if (b[0] < 0x80)
        return 1;
    size_t length = b[0] >= 0xc2 && b[0] < 0xe0   ? 2
                    : b[0] >= 0xe0 && b[0] < 0xf0 ? 3
                    : b[0] >= 0xf0 && b[0] < 0xf5 ? 4
                                                  : 0;
    if (length == 0 || size < length)
        return 0;
    for (size_t i = 1; i < length; i++)
        if ((b[i] & 0xc0) != 0x80)
            return 0;
    bool allowed = !(b[0] == 0xe0 && b[1] < 0xa0) && !(b[0] == 0xed && b[1] > 0x9f) &&
                   !(b[0] == 0xf0 && b[1] < 0x90) && !(b[0] == 0xf4 && b[1] > 0x8f);
    return allowed ? length : 0;
}

/* C0, DEL, and C1, whose codes begin sequences in some terminals. */
static bool is_control(const char *bytes, size_t length) {
    unsigned char first = (unsigned char)bytes[0];
    return length == 1 ? first < ' ' || first == 0x7f
                       : length == 2 && first == 0xc2 && (unsigned char)bytes[1] < 0xa0;
}

void fio_utf8_visible(fio_text *text, const char *bytes, size_t size) {
    for (size_t i = 0; i < size;) {
        size_t length = fio_utf8_character(bytes + i, size - i);
        if (length > 0 && !is_control(bytes + i, length))
            fio_text_bytes(text, bytes + i, length);
        else
            fio_text_bytes(text, length > 0 && bytes[i] == '\t' ? " " : "?", 1);
        i += length > 0 ? length : 1;
    }
}

void fio_utf8_escaped(fio_text *text, const char *bytes, size_t size) {
    for (size_t i = 0; i < size; i++) {
        unsigned char byte = (unsigned char)bytes[i];
        const char escape[4] = {'\\', 'x', hexadecimal[byte >> 4], hexadecimal[byte & 15]};
        if (byte == '\\')
            fio_text_string(text, "\\\\");
        else if (byte < ' ' || byte > '~')
            fio_text_bytes(text, escape, sizeof escape);
        else
            fio_text_bytes(text, bytes + i, 1);
    }
}

void fio_utf8_json(fio_text *text, const char *bytes, size_t size) {
    fio_text_string(text, "\"");
    for (size_t i = 0; i < size && i < FIO_UTF8_JSON_MOST - 4;) {
        size_t length = fio_utf8_character(bytes + i, size - i);
        unsigned char byte = (unsigned char)bytes[i];
        const char code[6] = {'\\', 'u', '0', '0', hexadecimal[byte >> 4], hexadecimal[byte & 15]};
        if (byte == '"' || byte == '\\') {
            fio_text_string(text, "\\");
            fio_text_bytes(text, bytes + i, 1);
        } else if (length == 0 || byte < ' ' || byte == 0x7f) {
            fio_text_bytes(text, code, sizeof code);
        } else {
            fio_text_bytes(text, bytes + i, length);
        }
        i += length > 0 ? length : 1;
    }
    fio_text_string(text, "\"");
}
