#include "protocol/meatpack.h"

#include <string.h>

/* Two of these and a third byte are a command. */
enum { SIGNAL = 0xff, ON = 0xfb, OFF = 0xfa, NO_SPACES = 0xf7, SPACES = 0xf6 };

enum { WHOLE = 15, LINE_END = 12 };

static size_t put_command(unsigned char *packed, unsigned char command) {
    packed[0] = packed[1] = SIGNAL;
    packed[2] = command;
    return 3;
}

size_t fio_meatpack_begin(fio_meatpack *packer, bool no_spaces, unsigned char *packed) {
    *packer = (fio_meatpack){.on = true, .no_spaces = no_spaces};
    size_t size = put_command(packed, ON);
    return size + put_command(packed + size, no_spaces ? NO_SPACES : SPACES);
}

size_t fio_meatpack_end(fio_meatpack *packer, unsigned char *packed) {
    packer->on = false;
    return put_command(packed, OFF);
}

static unsigned half(const fio_meatpack *packer, char c) {
    static const char alphabet[] = "0123456789. \nGX";
    if (packer->no_spaces && (c == 'E' || c == ' '))
        return c == 'E' ? 11 : WHOLE;
    const char *found = memchr(alphabet, c, sizeof alphabet - 1);
    return found ? (unsigned)(found - alphabet) : WHOLE;
}

static unsigned char whole(char c) {
    return (unsigned char)c == SIGNAL ? '?' : (unsigned char)c;
}

size_t fio_meatpack_line(fio_meatpack *packer, const char *line, size_t size,
                         unsigned char *packed) {
    if (!packer->on) {
        memcpy(packed, line, size);
        return size;
    }
    size_t made = 0;
    for (size_t i = 0; i < size; i += 2) {
        bool pair = i + 1 < size;
        unsigned first = half(packer, line[i]);
        unsigned second = pair ? half(packer, line[i + 1]) : LINE_END;
        packed[made++] = (unsigned char)(second << 4 | first);
        if (first == WHOLE)
            packed[made++] = whole(line[i]);
        if (second == WHOLE)
            packed[made++] = whole(line[i + 1]);
    }
    return made;
}
