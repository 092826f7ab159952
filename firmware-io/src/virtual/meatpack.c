#include "virtual/meatpack.h"

enum { SIGNAL = 0xff, ON = 0xfb, OFF = 0xfa, RESET = 0xf9, NO_SPACES = 0xf7, SPACES = 0xf6 };

static char character(const fio_unpacker *unpacker, unsigned nibble) {
    static const char packed[16] = "0123456789. \nGX";
    return nibble == 11 && unpacker->no_spaces ? 'E' : packed[nibble];
}

static void command(fio_unpacker *unpacker, uint8_t byte) {
    switch (byte) {
    case ON:
        unpacker->on = true;
        break;
    case OFF:
        unpacker->on = false;
        break;
    case RESET:
        *unpacker = (fio_unpacker){0};
        break;
    case NO_SPACES:
    case SPACES:
        unpacker->no_spaces = byte == NO_SPACES;
        break;
    default: /* a question, or nothing known: the state is told all the same */
        break;
    }
}

static int unpack(fio_unpacker *unpacker, uint8_t byte, char *text) {
    int count = 0;
    if (!unpacker->on) {
        text[count++] = (char)byte;
        return count;
    }
    if (unpacker->literals > 0) {
        text[count++] = (char)byte;
        if (unpacker->second)
            text[count++] = unpacker->second;
        unpacker->second = 0;
        unpacker->literals--;
        return count;
    }
    unsigned low = byte & 15, high = byte >> 4;
    if (low == 15) {
        unpacker->literals = high == 15 ? 2 : 1;
        unpacker->second = high == 15 ? 0 : character(unpacker, high);
        return 0;
    }
    text[count++] = character(unpacker, low);
    if (text[0] == '\n')
        return count; /* the other half only fills the byte */
    if (high == 15)
        unpacker->literals = 1;
    else
        text[count++] = character(unpacker, high);
    return count;
}

int fio_unpacker_feed(fio_unpacker *unpacker, uint8_t byte, char text[4], bool *told) {
    int count = 0;
    *told = false;
    if (byte == SIGNAL) {
        unpacker->commanded = unpacker->signals > 0;
        unpacker->signals = !unpacker->commanded;
        return 0;
    }
    if (unpacker->commanded) {
        unpacker->commanded = false;
        command(unpacker, byte);
        *told = true;
        return 0;
    }
    if (unpacker->signals)
        count = unpack(unpacker, SIGNAL, text);
    unpacker->signals = 0;
    return count + unpack(unpacker, byte, text + count);
}
