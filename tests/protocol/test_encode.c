/* Numbered lines: what they look like, and that no flipped bit makes a firmware execute another. */
#include <stdint.h>
#include <stdio.h>

#include "check.h"
#include "marlin.h"
#include "protocol/encode.h"

enum { LINES = 8, MOST = 300 };

static char wire[MOST];

static uint64_t random_state = 1;

static unsigned random_below(unsigned bound) {
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (unsigned)(random_state % bound);
}

static size_t encode(char *to, int64_t number, const char *command) {
    return fio_encode_line(to, number, command, strlen(command), 95);
}

/* From the RepRap wiki's article on G-code: "N3 T0*57", "N4 G92 E0*67", "N6 G1 F1500.0*82" … */
static void test_known_lines(void) {
    static const struct {
        int number;
        const char *command, *line;
    } known[] = {
        {3, "T0", "N3 T0*57\n"},
        {4, "G92 E0", "N4 G92 E0*67\n"},
        {5, "G28", "N5 G28*22\n"},
        {6, "G1 F1500.0", "N6 G1 F1500.0*82\n"},
        {7, "G1 X2.0 Y2.0 F3000.0", "N7 G1 X2.0 Y2.0 F3000.0*85\n"},
        {8, "G1 X3.0 Y3.0", "N8 G1 X3.0 Y3.0*33\n"},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        size_t size = encode(wire, known[i].number, known[i].command);
        CHECK_EQUAL(strlen(wire), size);
        /* The last one's sum is one of the 15 that merge. */
        bool merges = known[i].number == 8;
        if (!CHECK((strcmp(wire, known[i].line) != 0) == merges))
            fprintf(stderr, "    %s", wire);
    }
    CHECK(strcmp(wire, "N8 G1 X3.0 Y3.0 *1\n") != 0);
}

typedef struct run {
    const char *command[LINES]; /* of number first + i, as it must be executed */
    long first;
    int count, wrong;
    bool moved; /* something unnumbered that a firmware knows was executed */
    long next;
} run;

static void note(void *context, long number, const char *text) {
    run *r = context;
    if (number < 0) {
        size_t digit = 1 + strspn(text + 1, " ");
        r->moved = r->moved || (*text && strchr("GMTgmt", *text) && text[digit] >= '0' &&
                                text[digit] <= '9' && strcmp(text, "M112") != 0);
        return;
    }
    bool right = number >= r->first && number < r->first + r->count && number == r->next &&
                 strcmp(text, r->command[number - r->first]) == 0;
    r->next++;
    r->wrong += !right;
}

/* `way`: one of four firmwares. */
static void start(marlin *m, run *r, long first, int way) {
    *r = (run){.first = first, .next = first};
    *m = (marlin){.parentheses = way & 1,
                  .last_star = way & 2,
                  .last = first - 1,
                  .execute = note,
                  .context = r};
}

/* Every sum of a first line, every damage to its end, and all that may come next. */
static void test_no_damaged_end_merges_lines(void) {
    static char covered[256], command[MOST], second[MOST], again[MOST], bytes[2 * MOST];
    const char *const following[] = {"", second, "M112\n", again};
    int sums = 0;
    for (long round = 0; sums < 256 && round < 100000; round++) {
        snprintf(command, sizeof command, "M117 %c%c%c", (int)('!' + random_below(94)),
                 (int)('a' + random_below(26)),
                 (int)(round % 2 ? 128 + random_below(128) : '0' + random_below(75)));
        char plain[MOST];
        int length = snprintf(plain, sizeof plain, "N7 %s", command);
        unsigned char sum = (unsigned char)fio_checksum(plain, (size_t)length);
        if (covered[sum])
            continue;
        size_t size = encode(wire, 7, command);
        if (size == 0 || strncmp(strchr(wire, ' ') + 1, command, strlen(command)) != 0)
            continue; /* a ';', or something written in another way */
        covered[sum] = 1;
        sums++;
        encode(second, 8, "G1 X5 Y5");
        strcpy(again, wire);
        for (int flip = 0; flip < 8; flip++)
            for (size_t next = 0; next < 8; next++) {
                marlin m;
                run r;
                start(&m, &r, 7, next < 4 ? 0 : 2);
                r.command[0] = command;
                r.command[1] = "G1 X5 Y5";
                r.count = 2;
                memcpy(bytes, wire, size);
                bytes[size - 1] ^= (char)(1 << flip);
                const char *follows = following[next % 4];
                strcpy(bytes + size, follows);
                marlin_bytes(&m, bytes, size + strlen(follows));
                bool merged = next % 4 == 1 && m.last != 6; /* two numbered lines passed as one */
                if (!CHECK(!merged && r.wrong == 0 && !r.moved))
                    fprintf(stderr, "    sum %d, bit %d, next %zu: %s", sum, flip, next, wire);
            }
    }
    CHECK_EQUAL(256, sums);
}

/* Without the care taken some pairs would pass: the test above can fail. */
static void test_plain_lines_would_merge(void) {
    /* 33 ^ '*' ^ '3' ^ '3' = 0x0b, which is LF with its lowest bit wrong. */
    char bytes[MOST] = "N8 G1 X3.0 Y3.0*33\x0bN9 G1 X5*";
    size_t body = strlen("N9 G1 X5"), length = strlen(bytes);
    snprintf(bytes + length, 8, "%u\n", fio_checksum(bytes + length - 1 - body, body));
    marlin m;
    run r;
    start(&m, &r, 8, 0);
    r.count = 1;
    r.command[0] = "G1 X3.0 Y3.0";
    marlin_bytes(&m, bytes, strlen(bytes));
    CHECK_EQUAL(8, m.last);
    CHECK_EQUAL(0, r.wrong); /* even so: the command ends at the first star */
}

static const char *const commands[] = {
    "G1 X10 Y20.5 E0.0331",
    "G1 X133.993 Y93.39 E39.93939",
    "G2 X12.5 Y-7 I-3 J4.2 E.033",
    "G3 X1 Y1 I1 J-1 F1800",
    "G0 F9000 X3 Z.3",
    "G28",
    "G28 X Y",
    "G29",
    "G92 E0",
    "G4 P300",
    "M82",
    "M83",
    "M104 S200",
    "M104 T1 S215",
    "M109 S200",
    "M140 S60",
    "M190 S60",
    "M106 S255",
    "M107",
    "M204 P1500 T2000 R1500",
    "M205 X8 Y8 J0.013",
    "M73 P3 R39",
    "M220 S100",
    "M221 S95",
    "M400",
    "M84",
    "T0",
    "T1",
    "M900 K0.05",
    "M105",
    "M155 S2",
    "M115",
    "M117 Layer 3 of 39",
    "M117 J G28 at home",
    "M117 done -T1 -M104 S250",
    "M117 MM112 MT1 M G28 JG1 X3",
    "M117 HHello HH",
    "M117 M110 N77",
    "M117 2*3+33=39*33",
    "M118 E1 J\tM109 S200",
    "M117 a\\b (c) d\\",
    "M117 \xc3\xa4\xc3\xb6\xc3\xbc \xe2\x82\xac",
    "M117 \xc3\x8aG28 \xc3\x8d M104 S250",
    "M486 S3",
    "M0 press -M3",
    "G1 X9 Y9 E9 F9",
    "G1 X8.8 Y8.8",
    "M201 X1000 Y1000 Z200 E5000",
    "M300 S440 P200",
    "M600",
    "G1 Z0.2 F600.000",
    "G10",
    "G11",
    "G21",
    "G90",
};
enum { COMMANDS = sizeof commands / sizeof *commands };

/* As it stands on the wire, so as it must be executed. */
static void sent_text(char *text, const char *line) {
    const char *blank = strchr(line, ' ') + 1;
    size_t length = (size_t)(strrchr(line, '*') - blank);
    memcpy(text, blank, length);
    while (length > 0 && text[length - 1] == ' ')
        length--;
    text[length] = 0;
}

/* All single bits of `count` lines in a row, of which number `damaged` is hit. */
static long flip_all(int damaged, const char *const *lines, const char *const *texts, int count,
                     long first) {
    static char bytes[LINES * MOST];
    size_t at = 0, from = 0, to = 0;
    for (int i = 0; i < count; i++) {
        from = i == damaged ? at : from;
        memcpy(bytes + at, lines[i], strlen(lines[i]));
        at += strlen(lines[i]);
        to = i == damaged ? at : to;
    }
    long flips = 0;
    for (size_t byte = from; byte < to; byte++)
        for (int bit = 0; bit < 8; bit++, flips++)
            for (int way = 0; way < 4; way++) {
                marlin m;
                run r;
                start(&m, &r, first, way);
                r.count = count;
                memcpy(r.command, texts, (size_t)count * sizeof *texts);
                bytes[byte] ^= (char)(1 << bit);
                marlin_bytes(&m, bytes, at);
                /* The damaged line and all after it come to nothing, but for damage that leaves
                 * everything in it as it was. */
                if (!CHECK(r.wrong == 0 && !r.moved && m.last - first + 1 <= count))
                    fprintf(stderr, "    byte %zu bit %d of %s", byte - from, bit, lines[damaged]);
                bytes[byte] ^= (char)(1 << bit);
            }
    return flips;
}

static void test_no_flipped_bit_changes_what_is_executed(void) {
    static char line[3][MOST], text[3][MOST];
    const char *lines[3] = {line[0], line[1], line[2]}, *texts[3] = {text[0], text[1], text[2]};
    long flips = 0;
    for (int round = 0; round < 400; round++) {
        long first = round % 4 == 0 ? 1 : (long)random_below(round % 4 == 1 ? 100 : 2000000);
        for (int i = 0; i < 3; i++) {
            const char *command =
                commands[i == 1 ? (unsigned)round % COMMANDS : random_below(COMMANDS)];
            size_t size = encode(line[i], first + i, command);
            CHECK(size > 0 && size <= 96);
            sent_text(text[i], line[i]);
        }
        if (round < 2 * COMMANDS)
            flips += flip_all(0, lines + 1, texts + 1, 1, first + 1); /* alone */
        flips += flip_all(1, lines, texts, 3, first);
    }
    CHECK(flips > 80000);
}

/* M109 hit in one bit must not be an M108, nor M400 an M410. */
static void test_no_flipped_bit_is_an_emergency(void) {
    static const char *const real[] = {"M108", "M112", "M410", "M876 S1"};
    static char text[MOST], command[MOST];
    int disguised = 0, known = 0;
    for (int code = 0; code < 1000; code++) {
        if (code == 110)
            continue; /* looked for as it is written */
        snprintf(command, sizeof command, code % 3 ? "M%d S108" : "M%d", code);
        size_t length = fio_encode_disguised(text, command, strlen(command));
        CHECK_EQUAL(strlen(text), length);
        CHECK_EQUAL(code, atoi(text + 1));
        disguised += length > strlen(command);
        size_t size = encode(wire, 7000 + code, text);
        bool emergency = code == 108 || code == 112 || code == 410 || code == 876;
        CHECK_EQUAL(emergency ? code : 0, marlin_emergency(wire, size));
        for (size_t byte = 0; byte < size && !emergency; byte++)
            for (int bit = 0; bit < 8; bit++) {
                wire[byte] ^= (char)(1 << bit);
                if (!CHECK_EQUAL(0, marlin_emergency(wire, size)))
                    fprintf(stderr, "    bit %d of byte %zu: %s", bit, byte, wire);
                wire[byte] ^= (char)(1 << bit);
            }
    }
    /* Four codes of three digits, each with 3 or so digits one bit away in each place. */
    CHECK(disguised > 30 && disguised < 50);
    for (size_t i = 0; i < 4; i++) { /* they themselves stay plain */
        fio_encode_disguised(text, real[i], strlen(real[i]));
        known += strcmp(text, real[i]) == 0;
    }
    CHECK_EQUAL(4, known);
    fio_encode_disguised(text, "M400", 4);
    CHECK(strcmp(text, "M0400") == 0);
    fio_encode_disguised(text, "M109 S200", 9);
    CHECK(strcmp(text, "M00109 S200") == 0);
    fio_encode_disguised(text, "G1 X5", 5);
    CHECK(strcmp(text, "G1 X5") == 0);
    CHECK_EQUAL(0, fio_encode_disguised(text, "", 0));
    CHECK_EQUAL(2, fio_encode_disguised(text, "M1", 2));
}

static void test_lengths(void) {
    static const char words[] = "G1 X100.12345 Y100.12345 Z100.12345 E100.12345 F12000 I1 J1";
    CHECK_EQUAL(0, fio_encode_line(wire, 1, words, strlen(words), 20));
    CHECK_EQUAL(0, wire[0]);
    size_t size = fio_encode_line(wire, 1, words, strlen(words), 60);
    CHECK(size > 0 && size <= 61 && strstr(wire, "G1X100.12345Y100.12345Z100"));
    for (size_t most = 0; most < 110; most++) {
        size = fio_encode_line(wire, 1234567, words, strlen(words), most);
        CHECK(size <= most + 1 || size == 0);
        CHECK((size > 0) == (most >= 8 + strlen(words) - 7 + 5 || size > 0));
    }
    static char message[1200] = "M117 ";
    for (size_t i = 5; i < sizeof message - 1; i++)
        message[i] = "abcdefgh \xc3\xa4"[i % 11];
    size = fio_encode_line(wire, 99, message, strlen(message), 95);
    CHECK(size > 80 && size <= 96);
    size = fio_encode_line(wire, 99, message, strlen(message), 5000);
    CHECK(size > 200 && size <= FIO_WIRE_LINE_MOST);
    memcpy(message, "M23 ", 4); /* a file's name must not be cut, nor its blanks lost */
    CHECK_EQUAL(0, fio_encode_line(wire, 99, message, strlen(message), 95));
    CHECK_EQUAL(0, fio_encode_line(wire, 1, "", 0, 95));
    CHECK_EQUAL(0, fio_encode_line(wire, -1, "G28", 3, 95));
    CHECK_EQUAL(0, fio_encode_line(wire, 1, "G28 ; home", 10, 95));
    CHECK_EQUAL(0, fio_encode_line(wire, 1, "G28\nM112", 8, 95));
    CHECK_EQUAL(0, fio_encode_line(wire, 1, "G28\0 X", 6, 95));
    CHECK(fio_encode_line(wire, INT64_MAX, "G28", 3, 95) > 20);
}

/* Nothing cut in the middle of a character of UTF-8. */
static void test_text_cut_between_characters(void) {
    char message[] = "M117 \xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4";
    for (size_t most = 14; most < 40; most++) {
        if (fio_encode_line(wire, 1, message, strlen(message), most) == 0)
            continue;
        const char *end = strrchr(wire, '*'), *start = strstr(wire, "M117 ") + 5;
        while (end[-1] == ' ')
            end--;
        if (!CHECK((end - start) % 2 == 0))
            fprintf(stderr, "    at most %zu: %s", most, wire);
    }
}

int main(void) {
    RUN(test_known_lines);
    RUN(test_no_damaged_end_merges_lines);
    RUN(test_plain_lines_would_merge);
    RUN(test_no_flipped_bit_changes_what_is_executed);
    RUN(test_no_flipped_bit_is_an_emergency);
    RUN(test_lengths);
    RUN(test_text_cut_between_characters);
    return check_verdict();
}
