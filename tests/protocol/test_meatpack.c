/* MeatPack against an unpacker written from the format's description, not from our packer. */
#include <stdint.h>
#include <stdlib.h>

#include "check.h"
#include "protocol/meatpack.h"

typedef struct unpacker {
    bool on, no_spaces;
    int signals; /* bytes ff in a row */
    bool command;
    int whole;  /* characters that follow as they are */
    char later; /* comes behind the next whole one; 0 */
    char text[4096];
    size_t length;
} unpacker;

static char character(const unpacker *u, unsigned half) {
    if (half == 11 && u->no_spaces)
        return 'E';
    return "0123456789. \nGX"[half];
}

static void unpack_data(unpacker *u, unsigned char byte) {
    if (!u->on) {
        u->text[u->length++] = (char)byte;
    } else if (u->whole > 0) {
        u->text[u->length++] = (char)byte;
        u->whole--;
        if (u->later)
            u->text[u->length++] = u->later;
        u->later = 0;
    } else {
        unsigned low = byte & 15, high = byte >> 4;
        if (low != 15)
            u->text[u->length++] = character(u, low);
        if (high != 15 && low != 15)
            u->text[u->length++] = character(u, high);
        if (high != 15 && low == 15)
            u->later = character(u, high);
        u->whole = (low == 15) + (high == 15);
    }
}

static void unpack(unpacker *u, const unsigned char *bytes, size_t size) {
    for (size_t i = 0; i < size; i++) {
        unsigned char byte = bytes[i];
        if (u->command) {
            u->command = false;
            u->on = byte == 0xfb || (u->on && byte != 0xfa);
            u->no_spaces = byte == 0xf7 || (u->no_spaces && byte != 0xf6);
        } else if (byte == 0xff) {
            u->signals++;
            u->command = u->signals == 2;
            u->signals %= 2;
        } else {
            if (u->signals > 0)
                unpack_data(u, 0xff);
            u->signals = 0;
            unpack_data(u, byte);
        }
    }
}

static void test_known_bytes(void) {
    static const unsigned char begin[] = {0xff, 0xff, 0xfb, 0xff, 0xff, 0xf6};
    static const unsigned char known[] = {0x1f, 0x4d, 0x50, 0xcc};
    unsigned char packed[64];
    fio_meatpack packer;
    CHECK_EQUAL(6, fio_meatpack_begin(&packer, false, packed));
    CHECK(memcmp(packed, begin, 6) == 0);
    CHECK_EQUAL(4, fio_meatpack_line(&packer, "M105\n", 5, packed));
    CHECK(memcmp(packed, known, 4) == 0);
    CHECK_EQUAL(3, fio_meatpack_end(&packer, packed));
    CHECK_EQUAL(0xfa, packed[2]);
    CHECK_EQUAL(5, fio_meatpack_line(&packer, "M105\n", 5, packed));
    CHECK(memcmp(packed, "M105\n", 5) == 0);
    CHECK_EQUAL(6, fio_meatpack_begin(&packer, true, packed));
    CHECK_EQUAL(0xf7, packed[5]);
}

static void test_any_line_comes_back(void) {
    static const char usual[] = "0123456789. \nGXYEZFN*M-";
    unsigned char packed[700];
    uint32_t state = 7;
    for (int round = 0; round < 4000; round++) {
        fio_meatpack packer;
        static unpacker u;
        u = (unpacker){0};
        unpack(&u, packed, fio_meatpack_begin(&packer, round % 2, packed));
        char line[300], expected[1300] = "";
        for (int piece = 0; piece < 3; piece++) {
            size_t size = 1 + (state >> 8) % 200;
            for (size_t i = 0; i < size; i++) {
                state = state * 1664525u + 1013904223u;
                unsigned value = state >> 16;
                line[i] =
                    (char)(round % 3 ? usual[value % (sizeof usual - 1)] : (char)(1 + value % 254));
            }
            line[size - 1] = '\n';
            size_t made = fio_meatpack_line(&packer, line, size, packed);
            CHECK(made <= 2 * size + 8);
            unpack(&u, packed, made);
            line[size] = 0;
            strcat(expected, line);
            if (size % 2) /* filled up with an empty line */
                strcat(expected, "\n");
        }
        u.text[u.length] = 0;
        if (!CHECK(strcmp(u.text, expected) == 0))
            break;
        unpack(&u, packed, fio_meatpack_end(&packer, packed));
        CHECK(!u.on);
    }
}

/* ff can't be told from a signal. */
static void test_byte_of_signals(void) {
    unsigned char packed[64];
    static unpacker u;
    fio_meatpack packer;
    unpack(&u, packed, fio_meatpack_begin(&packer, false, packed));
    unpack(&u, packed, fio_meatpack_line(&packer, "M117 \xff\xff\xff!\n", 10, packed));
    CHECK(memcmp(u.text,
                 "M117 ?"
                 "?"
                 "?!\n",
                 10) == 0 &&
          u.on);
}

int main(void) {
    RUN(test_known_bytes);
    RUN(test_any_line_comes_back);
    RUN(test_byte_of_signals);
    return check_verdict();
}
