/* The table of firmwares, what they tell of themselves, and how commands behave. */
#include <stdio.h>

#include "check.h"
#include "protocol/firmware.h"

static fio_answer read_text(const char *text) {
    fio_answer answer;
    fio_answer_read(&answer, text, strlen(text));
    return answer;
}

/* M115 and banners as they are found in logs. */
static void test_identify(void) {
    static const struct {
        const char *text;
        fio_firmware_kind kind;
    } known[] = {
        {"FIRMWARE_NAME:Marlin 2.1.2 (Jan  1 2024 12:00:00) SOURCE_CODE_URL:github.com/MarlinFirmware"
         " PROTOCOL_VERSION:1.0 MACHINE_TYPE:Ender-3 EXTRUDER_COUNT:1 UUID:cede2a2f",
         FIO_FIRMWARE_MARLIN},
        {"FIRMWARE_NAME:Marlin V1; Sprinter/grbl mashup for gen6 FIRMWARE_URL:x",
         FIO_FIRMWARE_MARLIN},
        {"FIRMWARE_NAME:Prusa-Firmware 3.14.0 based on Marlin FIRMWARE_URL:https://github.com/prusa3d"
         " PROTOCOL_VERSION:1.0 MACHINE_TYPE:Prusa i3 MK3S EXTRUDER_COUNT:1",
         FIO_FIRMWARE_PRUSA},
        {"FIRMWARE_NAME:Prusa-Firmware-Buddy 5.1.2 (Github) SOURCE_CODE_URL:x", FIO_FIRMWARE_PRUSA},
        {"FIRMWARE_VERSION:v0.12.0 FIRMWARE_NAME:Klipper", FIO_FIRMWARE_KLIPPER},
        {"FIRMWARE_NAME: RepRapFirmware for Duet 2 WiFi/Ethernet FIRMWARE_VERSION: 3.4.1",
         FIO_FIRMWARE_REPRAP},
        {"FIRMWARE_NAME:Smoothieware, FIRMWARE_URL:http%3A//smoothieware.org, X-SOURCE_CODE_URL:x",
         FIO_FIRMWARE_SMOOTHIE},
        {"FIRMWARE_NAME:Repetier_1.0.4 COMPILED:x FIRMWARE_URL:https://github.com/repetier/",
         FIO_FIRMWARE_REPETIER},
        {"[VER:1.1h.20190825:]", FIO_FIRMWARE_GRBL},
        {"Grbl 1.1h ['$' for help]", FIO_FIRMWARE_GRBL},
        {"echo:Marlin bugfix-2.1.x", FIO_FIRMWARE_MARLIN},
        {"// Klipper state: Ready", FIO_FIRMWARE_KLIPPER},
        {"Smoothie", FIO_FIRMWARE_SMOOTHIE},
        {"start", FIO_FIRMWARE_UNKNOWN},
        {"FIRMWARE_NAME:Teacup", FIO_FIRMWARE_UNKNOWN},
        {"ok", FIO_FIRMWARE_UNKNOWN},
        {"echo:Marlinade", FIO_FIRMWARE_UNKNOWN},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        fio_answer answer = read_text(known[i].text);
        if (!CHECK_EQUAL(known[i].kind, fio_firmware_identify(&answer)->kind))
            fprintf(stderr, "    %s\n", known[i].text);
    }
}

static void test_rows_are_careful(void) {
    for (int kind = 0; kind < FIO_FIRMWARE_KINDS; kind++) {
        const fio_firmware *row = fio_firmware_of((fio_firmware_kind)kind);
        CHECK_EQUAL(kind, row->kind);
        CHECK(strlen(row->name) > 3 && row->command_slots >= 1 && row->usual_command_slots >= 1);
        CHECK(row->planner_blocks >= 16 && row->line_most >= 79 && row->line_most <= 255);
        CHECK(row->boot_seconds >= 1 && row->tools == 1);
        CHECK(!row->advanced_ok && !row->meatpack && !row->auto_temperatures);
        CHECK(row->heaters_off && row->stop && strlen(row->heaters_off) > 0);
        CHECK(row->receive_bytes <= row->usual_receive_bytes || row->usual_receive_bytes == 0);
        /* Whatever is under way half, the stop is a line of its own. */
        const char *stop = strstr(row->stop, "M112");
        CHECK(stop ? stop[-1] == '\n' && stop[4] == '\n' : row->stop[0] == 0x18);
    }
    /* Nobody said how large Marlin's buffer is, so one line at a time. */
    CHECK_EQUAL(0, fio_firmware_of(FIO_FIRMWARE_MARLIN)->receive_bytes);
    CHECK_EQUAL(FIO_FIRMWARE_UNKNOWN, fio_firmware_of(FIO_FIRMWARE_KINDS)->kind);
}

static fio_firmware marlin_after(const char *const *texts) {
    fio_firmware firmware = *fio_firmware_of(FIO_FIRMWARE_MARLIN);
    for (; *texts; texts++) {
        fio_answer answer = read_text(*texts);
        fio_firmware_learn(&firmware, &answer);
    }
    return firmware;
}

static void test_learn(void) {
    static const char *const tells[] = {"FIRMWARE_NAME:Marlin 2.1 EXTRUDER_COUNT:2 UUID:x",
                                        "Cap:EMERGENCY_PARSER:1",
                                        "Cap:AUTOREPORT_TEMP:1",
                                        "Cap:AUTOREPORT_POS:1",
                                        "Cap:AUTOREPORT_SD_STATUS:1",
                                        "Cap:PROMPT_SUPPORT:1",
                                        "Cap:MEATPACK:1",
                                        "Cap:SDCARD:0",
                                        "Cap:NEVER_HEARD_OF:1",
                                        "ok N3 P15 B7", /* a 3 with one wrong bit */
                                        "ok N4 P15 B3",
                                        "ok N5 P12 B0",
                                        NULL};
    fio_firmware f = marlin_after(tells);
    CHECK(f.tools == 2 && f.emergency_parser && f.auto_temperatures && f.auto_position);
    CHECK(f.auto_sd && f.action_prompts && f.meatpack && !f.sd_upload && f.advanced_ok);
    CHECK(f.command_slots == 3 && f.receive_bytes == 127 && f.planner_blocks == 16);
    static const char *const nothing[] = {"ok",
                                          "ok N5",
                                          "ok N6 P9999 B3",
                                          "ok N3 P1 B99",
                                          "ok P3",
                                          "ok T:20 /0",
                                          "Cap:EMERGENCY_PARSER:0",
                                          "start",
                                          "FIRMWARE_NAME:Marlin EXTRUDER_COUNT:0",
                                          "FIRMWARE_NAME:Marlin EXTRUDER_COUNT:99",
                                          "echo:Cap:MEATPACK:1",
                                          NULL};
    f = marlin_after(nothing);
    const fio_firmware *row = fio_firmware_of(FIO_FIRMWARE_MARLIN);
    CHECK(!f.advanced_ok && f.receive_bytes == 0 && f.command_slots == 1 && f.tools == 1);
    CHECK(!f.emergency_parser && !f.meatpack && f.planner_blocks == row->planner_blocks);
}

static unsigned traits(const char *command) {
    return fio_command_traits(command, strlen(command));
}

static void test_traits(void) {
    static const struct {
        const char *command;
        unsigned traits;
    } known[] = {
        {"G1 X5", FIO_COMMAND_MOVES},
        {"g0x5", FIO_COMMAND_MOVES},
        {"G01 X5", FIO_COMMAND_MOVES},
        {"G28", FIO_COMMAND_LONG | FIO_COMMAND_MOVES | FIO_COMMAND_DRAINS},
        {"G28.1", FIO_COMMAND_LONG | FIO_COMMAND_MOVES | FIO_COMMAND_DRAINS},
        {"G29 P1", FIO_COMMAND_LONG | FIO_COMMAND_MOVES | FIO_COMMAND_DRAINS},
        {"G4 S600", FIO_COMMAND_LONG | FIO_COMMAND_DRAINS},
        {"M109 S200", FIO_COMMAND_LONG | FIO_COMMAND_DRAINS | FIO_COMMAND_HEATS},
        {"M190 S60", FIO_COMMAND_LONG | FIO_COMMAND_DRAINS | FIO_COMMAND_HEATS},
        {"M104 S200", FIO_COMMAND_HEATS},
        {"M140 S60", FIO_COMMAND_HEATS},
        {"M303 E0 S200", FIO_COMMAND_LONG | FIO_COMMAND_DRAINS | FIO_COMMAND_HEATS},
        {"M400", FIO_COMMAND_LONG | FIO_COMMAND_DRAINS},
        {"M0 Click", FIO_COMMAND_LONG | FIO_COMMAND_DRAINS | FIO_COMMAND_USER},
        {"M600", FIO_COMMAND_LONG | FIO_COMMAND_MOVES | FIO_COMMAND_DRAINS | FIO_COMMAND_USER},
        {"T1", FIO_COMMAND_LONG | FIO_COMMAND_MOVES | FIO_COMMAND_DRAINS},
        {"T?", FIO_COMMAND_LONG},
        {"M112", FIO_COMMAND_STOPS},
        {"M108", FIO_COMMAND_STOPS},
        {"M410", FIO_COMMAND_STOPS},
        {"M876 S0", FIO_COMMAND_STOPS},
        {"M110 N0", FIO_COMMAND_NUMBERS},
        {"M28 X.GCO", FIO_COMMAND_SD_WRITE},
        {"M29", FIO_COMMAND_SD_WRITE},
        {"M999", FIO_COMMAND_RESETS},
        {"FIRMWARE_RESTART", FIO_COMMAND_RESETS | FIO_COMMAND_LONG},
        {"PRINT_START BED=60", FIO_COMMAND_LONG},
        {"bed_mesh_calibrate", FIO_COMMAND_LONG},
        {"M105", 0},
        {"M1050", 0},
        {"M117 G28", 0},
        {"M999999999999999999999", 0},
        {"", 0},
        {"G", 0},
        {"X5", 0},
        {"$H", 0},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (!CHECK_EQUAL(known[i].traits, traits(known[i].command)))
            fprintf(stderr, "    %s\n", known[i].command);
}

int main(void) {
    RUN(test_identify);
    RUN(test_rows_are_careful);
    RUN(test_learn);
    RUN(test_traits);
    return check_verdict();
}
