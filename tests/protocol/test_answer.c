/* What firmwares say: lines as their sources and their users' logs have them. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "check.h"
#include "protocol/answer.h"

#define OTHER FIO_ANSWER_OTHER
#define OK FIO_ANSWER_OK
#define RESEND FIO_ANSWER_RESEND
#define BUSY FIO_ANSWER_BUSY
#define WAIT FIO_ANSWER_WAIT
#define START FIO_ANSWER_START
#define ERROR FIO_ANSWER_ERROR
#define HALTED FIO_ANSWER_HALTED
#define ACTION FIO_ANSWER_ACTION
#define TEMPERATURES FIO_ANSWER_TEMPERATURES
#define POSITION FIO_ANSWER_POSITION
#define FIRMWARE FIO_ANSWER_FIRMWARE
#define CAPABILITY FIO_ANSWER_CAPABILITY
#define SD FIO_ANSWER_SD
#define ECHO FIO_ANSWER_ECHO
#define PREVENTED FIO_ANSWER_PREVENTED

static const struct {
    const char *text;
    fio_answer_kind kind;
    int line;
    const char *rest; /* NULL: not looked at */
} lines[] = {
    /* ok, of all sorts */
    {"ok", OK, -1, ""},
    {"ok ", OK, -1, ""},
    {"ok N3 P15 B3", OK, 3, "N3 P15 B3"},
    {"ok P15 B3", OK, -1, NULL},
    {"ok N123", OK, 123, NULL},
    {"ok N0 P15 B3", OK, 0, NULL},
    {"ok 12", OK, 12, NULL},
    {"ok N12", OK, 12, NULL},
    {"ok T:19.37 /0.00 B:19.37 /0.00 @:0 B@:0", OK, -1, NULL},
    {"ok C: X:1.0000 Y:2.0000 Z:3.0000 E:0.0000", OK, -1, NULL},
    {"ok SD card ok", OK, -1, NULL},
    /* damaged: no ok, or one without numbers */
    {"oj", OTHER, -1, NULL},
    {"okk", OTHER, -1, NULL},
    {"k", OTHER, -1, NULL},
    {"o", OTHER, -1, NULL},
    {"ok12", OTHER, -1, NULL},
    {"ok\x80", OTHER, -1, NULL},
    {"ok:", OTHER, -1, NULL},
    {"OK", OTHER, -1, NULL},
    {"ok N3 P1u B3", OK, -1, NULL},
    {"ok N3x", OK, -1, NULL},
    {"ok N3 P15B3", OK, -1, NULL},
    {"ok n3 P15 B3", OK, -1, NULL},
    {"ok N3 P15 B", OK, -1, NULL},
    {"ok N3 B3 P15", OK, -1, NULL},
    {"ok N-3", OK, -1, NULL},
    {"ok 1 2", OK, -1, NULL},
    {"ok N99999999999999999999", OK, -1, NULL},
    {"ok N3 P9999999 B1", OK, -1, NULL},
    /* sent again */
    {"Resend: 5", RESEND, 5, "5"},
    {"Resend:5", RESEND, 5, "5"},
    {"Resend: N5", RESEND, 5, NULL},
    {"Resend: N:5", RESEND, 5, NULL},
    {"Resend 5 ", RESEND, 5, NULL},
    {"resend:5", RESEND, 5, NULL},
    {"rs 5", RESEND, 5, NULL},
    {"rs N5", RESEND, 5, NULL},
    {"Resend: 5x", OTHER, -1, NULL},
    {"Resend: x5", OTHER, -1, NULL},
    {"Resend: ", OTHER, -1, NULL},
    {"Resend", OTHER, -1, NULL},
    {"Resend: -5", OTHER, -1, NULL},
    {"Resend: 5 6", OTHER, -1, NULL},
    {"Resend: 123456789012345678901", OTHER, -1, NULL},
    {"Re3end: 5", OTHER, -1, NULL},
    {"rs5", OTHER, -1, NULL},
    {"rsx 5", OTHER, -1, NULL},
    /* at work, idle */
    {"echo:busy: processing", BUSY, -1, "processing"},
    {"busy: processing", BUSY, -1, NULL},
    {"busy:processing", BUSY, -1, NULL},
    {"echo:busy: paused for user", BUSY, -1, NULL},
    {"echo:busy: paused for input", BUSY, -1, NULL},
    {"echo: busy: processing", BUSY, -1, NULL},
    {"echo:busy: pro<essing", ECHO, -1, NULL},
    {"echo:busy:", ECHO, -1, NULL},
    {"echo:busx: processing", ECHO, -1, NULL},
    {"busy", OTHER, -1, NULL},
    {"wait", WAIT, -1, NULL},
    {"waiting", OTHER, -1, NULL},
    {"waht", OTHER, -1, NULL},
    /* booted */
    {"start", START, -1, NULL},
    {"\xff\xfe\x80\x01start", START, -1, NULL},
    {"echo:Marlin bugfix-2.1.x", START, -1, NULL},
    {"echo: Marlin 1.1.9", START, -1, NULL},
    {"Marlin 2.1.2.1", START, -1, NULL},
    {"Grbl 1.1h ['$' for help]", START, -1, NULL},
    {"Smoothie", START, -1, NULL},
    {"Smoothie command shell", START, -1, NULL},
    {"RepRapFirmware for Duet 2 WiFi/Ethernet version 3.4.1 is up and running.", START, -1, NULL},
    {"// Klipper state: Ready", START, -1, NULL},
    {"starting", OTHER, -1, NULL},
    {"restart", OTHER, -1, NULL},
    {"Marlin", OTHER, -1, NULL},
    {"echo:Marlinade 3", ECHO, -1, NULL},
    /* wrong */
    {"Error:checksum mismatch, Last Line: 12", ERROR, 12, NULL},
    {"Error:Line Number is not Last Line Number+1, Last Line: 0", ERROR, 0, NULL},
    {"Error:No Checksum with line number, Last Line: 12", ERROR, 12, NULL},
    {"Error:checksum mismatch, Last Line: 1r", ERROR, -1, NULL},
    {"Error:Last Line: ", ERROR, -1, NULL},
    {"Error: G0/G1: insufficient axes homed", ERROR, -1, "G0/G1: insufficient axes homed"},
    {"error:9", ERROR, -1, "9"},
    {"!! Must home axis first: 10.0 0.0 0.0 [0.0]", ERROR, -1, NULL},
    {"!!", HALTED, -1, NULL},
    {"Error:Printer halted. kill() called!", HALTED, -1, NULL},
    {"Error:Heating failed, system stopped! Heater_ID: E0", HALTED, -1, NULL},
    {"Error:Thermal Runaway, system stopped! Heater_ID: bed", HALTED, -1, NULL},
    {"Error:MINTEMP triggered, system stopped! Heater_ID: 0", HALTED, -1, NULL},
    {"Error:Printer stopped due to errors. Fix the error and use M999 to restart.", HALTED, -1,
     NULL},
    {"// Klipper state: Shutdown", HALTED, -1, NULL},
    {"!! Printer is shutdown", HALTED, -1, NULL},
    {"// Printer is shutdown", HALTED, -1, NULL},
    {"ok Emergency Stop Requested - reset or M999 required to exit HALT state", HALTED, -1, NULL},
    {"Emergency Stop! Reset the controller to continue.", HALTED, -1, NULL},
    {"ALARM:1", HALTED, -1, NULL},
    {"ALARM: Kill button pressed - reset or M999 to continue", HALTED, -1, NULL},
    {"error:Alarm lock", HALTED, -1, NULL},
    {"fatal:Temperature sensor defect", HALTED, -1, NULL},
    /* actions */
    {"//action:pause", ACTION, -1, "pause"},
    {"// action:paused", ACTION, -1, "paused"},
    {"//action:prompt_begin Filament runout", ACTION, -1, "prompt_begin Filament runout"},
    {"//action:prompt_button Continue", ACTION, -1, "prompt_button Continue"},
    {"//action:notification Ender-3 Ready.", ACTION, -1, "notification Ender-3 Ready."},
    {"//actaon:pause", ECHO, -1, NULL},
    {"/action:pause", OTHER, -1, NULL},
    /* reports */
    {" T:20.1 /0.0 B:19.9 /60.0 @:0 B@:127", TEMPERATURES, -1, NULL},
    {"T:150.25 E:0 W:?", TEMPERATURES, -1, NULL},
    {"T:150.25 E:0 W:3", TEMPERATURES, -1, NULL},
    {"B:59.1 /60 T0:200.0 /205.0", TEMPERATURES, -1, NULL},
    {"T:23.5 /0.0 @0 B:22.3 /0.0 @0", TEMPERATURES, -1, NULL},
    {"T:27.8 /0.0 B:27.6 /0.0 T0:27.8 /0.0 @:0 B@:0 P:0.0 A:33.4", TEMPERATURES, -1, NULL},
    {" T:20.00 /0.00 (2011.0000) B:20.00 /0.00 (2011.0000) @:0 B@:0", TEMPERATURES, -1, NULL},
    {"T:-15.00 /0.00", TEMPERATURES, -1, NULL},
    {"T:2x.1 /0.0 B:19.9 /60.0", OTHER, -1, NULL},
    {"T:20.1 /0.0 B:19.9 /6u.0", OTHER, -1, NULL},
    {"T:99999 /0.0", OTHER, -1, NULL},
    {"T:", OTHER, -1, NULL},
    {"T", OTHER, -1, NULL},
    {"@:0 B@:0", OTHER, -1, NULL},
    {"X:1.00 Y:2.50 Z:0.30 E:7.00 Count X:80 Y:200 Z:120", POSITION, -1, NULL},
    {"X:1.00 Y:2.50 Z:0.30 E:7.00 Count A:80B:200 Z:120", POSITION, -1, NULL},
    {"X:1.000 Y:2.500 Z:0.300 E:7.000 E0:0.0 Count 0 0 0 Machine 1.0 2.5 0.3", POSITION, -1, NULL},
    {"X:1.000 Y:2.500 Z:0.300 E:7.000", POSITION, -1, NULL},
    {"X:1.000 Y:2.500 E:7.000", OTHER, -1, NULL},
    {"X:1.000 Y:2.5p0 Z:0.300 E:7.000", OTHER, -1, NULL},
    {"FIRMWARE_NAME:Marlin 2.1.2 (Jan  1 2024) SOURCE_CODE_URL:… EXTRUDER_COUNT:1", FIRMWARE, -1,
     NULL},
    {"FIRMWARE_VERSION:v0.12 FIRMWARE_NAME:Klipper", FIRMWARE, -1, NULL},
    {"[VER:1.1h.20190825:]", FIRMWARE, -1, NULL},
    {"Cap:AUTOREPORT_TEMP:1", CAPABILITY, 1, "AUTOREPORT_TEMP"},
    {"Cap:EEPROM:0", CAPABILITY, 0, "EEPROM"},
    {"Cap:EEPROM:", OTHER, -1, NULL},
    {"Cap::1", OTHER, -1, NULL},
    {"Cap:EEpROM:1", OTHER, -1, NULL},
    {"Cap:EEPROM:1x", OTHER, -1, NULL},
    {"SD printing byte 12/345", SD, 12, NULL},
    {"SD printing byte 1w/345", OTHER, -1, NULL},
    {"Not SD printing", SD, -1, NULL},
    {"echo:Now fresh file: PART.GCO", SD, -1, NULL},
    {"File opened: PART.GCO Size: 1234", SD, -1, NULL},
    {"Writing to file: PART.GCO", SD, -1, NULL},
    {"Done saving file.", SD, -1, NULL},
    {"Done printing file", SD, -1, NULL},
    {"open failed, File: X.GCO.", SD, -1, NULL},
    /* talk */
    {"echo:Unknown command: \"G999\"", PREVENTED, -1, NULL},
    {"// Unknown command:\"FOO\"", PREVENTED, -1, NULL},
    {"echo: cold extrusion prevented", PREVENTED, -1, NULL},
    {"echo:Home XYZ first", PREVENTED, -1, NULL},
    {"Unknown command: FOO", PREVENTED, -1, NULL},
    {"echo:  G21    ; Units in mm (mm)", ECHO, -1, NULL},
    {"// probe accuracy results: maximum 1.0", ECHO, -1, NULL},
    {"echo:M112 Shutdown", ECHO, -1, NULL},
    {"", OTHER, -1, NULL},
    {" ", OTHER, -1, NULL},
    {"\xff\xff", OTHER, -1, NULL},
};

static void test_every_line(void) {
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        fio_answer answer;
        const char *text = lines[i].text;
        fio_answer_read(&answer, text, strlen(text));
        bool right = answer.kind == lines[i].kind && answer.line == lines[i].line;
        right = right && (!lines[i].rest || fio_answer_says(&answer, lines[i].rest));
        if (!CHECK(right && answer.text == text && answer.length == strlen(text)))
            fprintf(stderr, "    kind %d, line %lld, rest \"%.*s\": %s\n", (int)answer.kind,
                    (long long)answer.line, (int)answer.rest_length, answer.rest, text);
    }
}

static fio_answer read_text(const char *text) {
    fio_answer answer;
    fio_answer_read(&answer, text, strlen(text));
    return answer;
}

static void test_numbers_within(void) {
    fio_answer a = read_text("ok N3 P15 B3");
    CHECK(a.planner_free == 15 && a.commands_free == 3 && !a.has_temperatures);
    a = read_text("ok P7 B1");
    CHECK(a.planner_free == 7 && a.commands_free == 1);
    a = read_text("ok N3 P15 B3x");
    CHECK(a.planner_free == -1 && a.commands_free == -1);
    a = read_text("ok T:19.37 /200.50 B:59.13 /60.00 @:0 B@:0\r\n");
    CHECK(a.has_temperatures && a.has_bed && a.nozzles == 1 && a.length == 42);
    CHECK_NEAR(19.37, a.nozzle[0], 1e-12);
    CHECK_NEAR(200.5, a.nozzle_target[0], 1e-12);
    CHECK_NEAR(59.13, a.bed, 1e-12);
    CHECK_NEAR(60, a.bed_target, 1e-12);
    /* T is the active tool's; T0 and T1 tell them apart. */
    a = read_text(" T:33 /0 B:20 /0 T0:22 /0 T1:33 /215 @:0 B@:0 @0:0 @1:0");
    CHECK(a.kind == TEMPERATURES && a.nozzles == 3);
    CHECK_NEAR(22, a.nozzle[0], 0);
    CHECK_NEAR(33, a.nozzle[1], 0);
    CHECK_NEAR(215, a.nozzle_target[1], 0);
    a = read_text("T:150.25 E:0 W:?");
    CHECK(a.nozzles == 1 && !a.has_bed && a.nozzle_target[0] == -1 && a.bed_target == -1);
    a = read_text("T0:20 /0 T7:25 /30 T8:9 /9 B:1");
    CHECK(a.nozzles == 0x81 && a.nozzle[7] == 25 && a.bed_target == -1);
    a = read_text("X:1.00 Y:-2.50 Z:0.30 E:7.00 Count X:80 Y:200 Z:120");
    CHECK(a.position[0] == 1 && a.position[1] == -2.5 && a.position[2] == 0.3 &&
          a.position[3] == 7);
    CHECK_EQUAL(FIO_BUSY_PAUSED_FOR_USER, read_text("echo:busy: paused for user").busy);
    CHECK_EQUAL(FIO_BUSY_PAUSED_FOR_INPUT, read_text("echo:busy: paused for input").busy);
    CHECK_EQUAL(FIO_BUSY_PROCESSING, read_text("busy: heating").busy);
}

/* One flipped bit never makes an ok of anything, nor a number of a damaged one; what it can still
 * do is change a digit, which nobody can see. */
static void test_flipped_bits(void) {
    static const char *const texts[] = {
        "ok",   "ok N12 P15 B3",          "Resend: 12",           "rs 12", "start",
        "wait", "Error:x, Last Line: 12", "echo:busy: processing"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char text[64];
        size_t length = strlen(texts[i]);
        fio_answer good = read_text(texts[i]);
        for (size_t bit = 0; bit < 8 * length; bit++) {
            memcpy(text, texts[i], length + 1);
            text[bit / 8] ^= (char)(1 << bit % 8);
            if (text[bit / 8] == '\n' || text[bit / 8] == '\r')
                continue;
            fio_answer a;
            fio_answer_read(&a, text, length);
            bool digit = text[bit / 8] >= '0' && text[bit / 8] <= '9' && texts[i][bit / 8] >= '0' &&
                         texts[i][bit / 8] <= '9';
            bool right = a.kind == OTHER || a.kind == ECHO || a.kind == good.kind;
            if (a.kind == good.kind && !digit && good.line >= 0) /* e.g. "ok N12 P15 B" */
                right = right && (a.line == -1 || a.line == good.line);
            if (good.kind == OK && bit < 16)
                right = right && a.kind == OTHER;
            if (good.kind == START || good.kind == WAIT)
                right = right && (a.kind == OTHER ||
                                  (good.kind == START &&
                                   ((unsigned char)text[bit / 8] < ' ' || text[bit / 8] & 0x80)));
            if (good.kind == RESEND && !digit)
                right = right && (a.kind == OTHER || a.line == 12);
            if (!CHECK(right))
                fprintf(stderr, "    kind %d line %lld: %s\n", (int)a.kind, (long long)a.line,
                        text);
        }
    }
}

typedef struct record {
    uint64_t hash;
    int count, cut;
    size_t longest;
} record;

static void take(void *context, const fio_answer *answer) {
    record *r = context;
    r->count++;
    r->cut += answer->cut;
    r->longest = answer->length > r->longest ? answer->length : r->longest;
    CHECK(answer->text[answer->length] == 0 && answer->length > 0);
    CHECK(answer->rest >= answer->text &&
          answer->rest + answer->rest_length <= answer->text + answer->length);
    for (size_t i = 0; i < answer->length; i++)
        r->hash = (r->hash ^ (unsigned char)answer->text[i]) * 1099511628211u;
    r->hash = (r->hash ^ (uint64_t)answer->kind) * 31 + (uint64_t)answer->line;
}

static void test_any_pieces(void) {
    static char all[20000];
    size_t size = 0;
    int expected = 0;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        static const char *const ends[] = {"\n", "\r\n", "\r", "\n\n\r\r"};
        size += (size_t)snprintf(all + size, sizeof all - size, "%s%s", lines[i].text, ends[i % 4]);
        expected += *lines[i].text != 0;
    }
    record whole = {0}, pieces;
    fio_answer_parser parser;
    fio_answer_parser_reset(&parser);
    fio_answer_parser_feed(&parser, all, size, take, &whole);
    CHECK_EQUAL(expected, whole.count);
    for (size_t piece = 1; piece < 40; piece++) {
        pieces = (record){0};
        for (size_t at = 0; at < size; at += piece)
            fio_answer_parser_feed(&parser, all + at, piece < size - at ? piece : size - at, take,
                                   &pieces);
        CHECK(pieces.hash == whole.hash && pieces.count == whole.count && pieces.cut == 0);
    }
}

static void test_endless_line(void) {
    static char bytes[100000];
    record r = {0};
    fio_answer_parser parser;
    fio_answer_parser_reset(&parser);
    memset(bytes, 'o', sizeof bytes);
    for (int i = 0; i < 20; i++)
        fio_answer_parser_feed(&parser, bytes, sizeof bytes, take, &r);
    CHECK_EQUAL(0, r.count);
    fio_answer_parser_feed(&parser, "\nok\n", 4, take, &r);
    CHECK(r.count == 2 && r.cut == 1 && r.longest == FIO_ANSWER_MOST);
    /* As long as it may be is not cut. */
    r = (record){0};
    fio_answer_parser_feed(&parser, bytes, FIO_ANSWER_MOST, take, &r);
    fio_answer_parser_feed(&parser, "\n", 1, take, &r);
    CHECK(r.count == 1 && r.cut == 0 && r.longest == FIO_ANSWER_MOST);
    memset(bytes, 0, sizeof bytes);
    r = (record){0};
    fio_answer_parser_feed(&parser, bytes, sizeof bytes, take, &r);
    fio_answer_parser_feed(&parser, "\nok\0\nok\n", 8, take, &r);
    CHECK_EQUAL(3, r.count);
}

static int oks;
static void count_oks(void *context, const fio_answer *answer) {
    (void)context;
    oks += answer->kind == OK;
}

/* A line cut off by a reset is forgotten when the parser is reset. */
static void test_reset(void) {
    fio_answer_parser parser;
    fio_answer_parser_reset(&parser);
    fio_answer_parser_feed(&parser, "rubbish", 7, count_oks, NULL);
    fio_answer_parser_reset(&parser);
    fio_answer_parser_feed(&parser, "ok\n", 3, count_oks, NULL);
    CHECK_EQUAL(1, oks);
}

int main(void) {
    RUN(test_every_line);
    RUN(test_numbers_within);
    RUN(test_flipped_bits);
    RUN(test_any_pieces);
    RUN(test_endless_line);
    RUN(test_reset);
    return check_verdict();
}
