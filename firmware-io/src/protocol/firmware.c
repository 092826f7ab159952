/* Facts from the firmwares' sources as they come: Marlin 2.1 (Configuration_adv.h, queue.cpp),
 * Prusa firmware 3.x, Klipper (gcode.py), RepRapFirmware 3, Smoothieware, Repetier 1.0, Grbl 1.1.
 */
#include "protocol/firmware.h"

#include <string.h>

#include "protocol/words.h"

#define COLD "M104 S0\nM140 S0\nM107"
#define STOP "\nM112\n"

/* Buffers of Marlin and Prusa are their builders' choice: 64 bytes at least, usually 128. One line
 * is all that surely fits anywhere. Repetier's documentation asks hosts not to exceed 63 bytes;
 * grbl counts on 127; Klipper and RepRapFirmware hold the host back themselves. */
static const fio_firmware firmwares[FIO_FIRMWARE_KINDS] = {
    [FIO_FIRMWARE_UNKNOWN] = {.kind = FIO_FIRMWARE_UNKNOWN,
                              .name = "unknown",
                              .identity = "",
                              .numbered = true,
                              .resends = true,
                              .command_slots = 1,
                              .usual_command_slots = 1,
                              .planner_blocks = 64,
                              .line_most = 95,
                              .boot_seconds = 5,
                              .tools = 1,
                              .heaters_off = COLD,
                              .stop = STOP},
    [FIO_FIRMWARE_MARLIN] = {.kind = FIO_FIRMWARE_MARLIN,
                             .name = "Marlin",
                             .identity = "Marlin",
                             .numbered = true,
                             .resends = true,
                             .repeats_dropped = true,
                             .usual_receive_bytes = 127,
                             .usual_command_slots = 4,
                             .command_slots = 1,
                             .planner_blocks = 16,
                             .line_most = 95,
                             .busy_seconds = 2,
                             .boot_seconds = 5,
                             .sd_upload = true,
                             .tools = 1,
                             .heaters_off = COLD,
                             .stop = STOP},
    [FIO_FIRMWARE_PRUSA] = {.kind = FIO_FIRMWARE_PRUSA,
                            .name = "Prusa",
                            .identity = "Prusa-Firmware",
                            .numbered = true,
                            .resends = true,
                            .usual_receive_bytes = 127,
                            .usual_command_slots = 4,
                            .command_slots = 1,
                            .planner_blocks = 16,
                            .line_most = 95,
                            .busy_seconds = 2,
                            .boot_seconds = 8,
                            .sd_upload = true,
                            .tools = 1,
                            .heaters_off = COLD,
                            .stop = STOP},
    [FIO_FIRMWARE_KLIPPER] = {.kind = FIO_FIRMWARE_KLIPPER,
                              .name = "Klipper",
                              .identity = "Klipper",
                              .receive_bytes = 255,
                              .command_slots = 4,
                              .usual_receive_bytes = 255,
                              .usual_command_slots = 4,
                              .planner_blocks = 64,
                              .line_most = 255,
                              .boot_seconds = 5,
                              .emergency_parser = true,
                              .tools = 1,
                              .heaters_off = "TURN_OFF_HEATERS\nM107",
                              .stop = STOP},
    [FIO_FIRMWARE_REPRAP] = {.kind = FIO_FIRMWARE_REPRAP,
                             .name = "RepRapFirmware",
                             .identity = "RepRapFirmware",
                             .numbered = true, /* what is damaged is passed over in silence */
                             .command_slots = 1,
                             .usual_command_slots = 1,
                             .planner_blocks = 60,
                             .line_most = 100,
                             .boot_seconds = 5,
                             .emergency_parser = true,
                             .sd_upload = true,
                             .tools = 1,
                             .heaters_off = COLD,
                             .stop = STOP},
    [FIO_FIRMWARE_SMOOTHIE] = {.kind = FIO_FIRMWARE_SMOOTHIE,
                               .name = "Smoothieware",
                               .identity = "Smoothie",
                               .numbered = true,
                               .resends = true,
                               .command_slots = 1,
                               .usual_command_slots = 1,
                               .planner_blocks = 32,
                               .line_most = 100,
                               .boot_seconds = 5,
                               .sd_upload = true,
                               .tools = 1,
                               .heaters_off = COLD,
                               .stop = "\x18" STOP},
    [FIO_FIRMWARE_REPETIER] = {.kind = FIO_FIRMWARE_REPETIER,
                               .name = "Repetier",
                               .identity = "Repetier",
                               .numbered = true,
                               .resends = true,
                               .receive_bytes = 63,
                               .command_slots = 2,
                               .usual_receive_bytes = 63,
                               .usual_command_slots = 2,
                               .planner_blocks = 16,
                               .line_most = 95,
                               .boot_seconds = 5,
                               .sd_upload = true,
                               .tools = 1,
                               .heaters_off = COLD,
                               .stop = STOP},
    [FIO_FIRMWARE_GRBL] = {.kind = FIO_FIRMWARE_GRBL,
                           .name = "Grbl",
                           .identity = "Grbl",
                           .receive_bytes = 127,
                           .command_slots = 1,
                           .usual_receive_bytes = 127,
                           .usual_command_slots = 1,
                           .planner_blocks = 16,
                           .line_most = 79,
                           .boot_seconds = 3,
                           .tools = 1,
                           .heaters_off = "M5\nM9",
                           .stop = "\x18"},
};

const fio_firmware *fio_firmware_of(fio_firmware_kind kind) {
    if (kind >= FIO_FIRMWARE_KINDS)
        kind = FIO_FIRMWARE_UNKNOWN;
    return &firmwares[kind];
}

/* The name itself decides first: "Prusa-Firmware 3.14 based on Marlin" is Prusa's. */
const fio_firmware *fio_firmware_identify(const fio_answer *answer) {
    static const char label[] = "FIRMWARE_NAME:";
    fio_words words = {answer->text, answer->text + answer->length};
    bool tells = answer->kind == FIO_ANSWER_OK && fio_words_contain(&words, label); /* Klipper's */
    if (answer->kind != FIO_ANSWER_FIRMWARE && answer->kind != FIO_ANSWER_START && !tells)
        return fio_firmware_of(FIO_FIRMWARE_UNKNOWN);
    if (fio_words_contain(&words, "[VER:"))
        return fio_firmware_of(FIO_FIRMWARE_GRBL);
    for (fio_words name = words; !fio_words_done(&name); name.at++)
        if (fio_words_take(&name, label)) {
            words = name;
            break;
        }
    fio_words_blanks(&words);
    for (int kind = 1; kind < FIO_FIRMWARE_KINDS; kind++) {
        fio_words copy = words;
        if (fio_words_take(&copy, firmwares[kind].identity))
            return &firmwares[kind];
    }
    for (int kind = 1; kind < FIO_FIRMWARE_KINDS; kind++)
        if (fio_words_contain(&words, firmwares[kind].identity))
            return &firmwares[kind];
    return fio_firmware_of(FIO_FIRMWARE_UNKNOWN);
}

static void learn_capability(fio_firmware *firmware, const fio_answer *answer) {
    const struct {
        const char *name;
        bool *known;
    } capabilities[] = {
        {"EMERGENCY_PARSER", &firmware->emergency_parser},
        {"AUTOREPORT_TEMP", &firmware->auto_temperatures},
        {"AUTOREPORT_POS", &firmware->auto_position},
        {"AUTOREPORT_SD_STATUS", &firmware->auto_sd},
        {"PROMPT_SUPPORT", &firmware->action_prompts},
        {"MEATPACK", &firmware->meatpack},
        {"SDCARD", &firmware->sd_upload},
    };
    for (size_t i = 0; i < sizeof capabilities / sizeof *capabilities; i++)
        if (fio_answer_says(answer, capabilities[i].name))
            *capabilities[i].known = answer->line == 1;
}

static void learn_tools(fio_firmware *firmware, const fio_answer *answer) {
    int64_t tools;
    for (fio_words words = {answer->text, answer->text + answer->length}; !fio_words_done(&words);
         words.at++)
        if (fio_words_take(&words, "EXTRUDER_COUNT:")) {
            fio_words_blanks(&words);
            if (fio_words_integer(&words, &tools) && tools >= 1 && tools <= FIO_ANSWER_TOOLS)
                firmware->tools = (int)tools;
            return;
        }
}

/* More free than any sane build has is damage. */
enum { PLANNER_MOST = 512, SLOTS_MOST = 64 };

static void learn_buffers(fio_firmware *firmware, const fio_answer *answer) {
    if (answer->planner_free < 0 || answer->commands_free < 0 ||
        answer->planner_free > PLANNER_MOST || answer->commands_free > SLOTS_MOST)
        return;
    firmware->advanced_ok = true;
    int told = answer->commands_free, both = told;
    if (firmware->told_slots < both)
        both = firmware->told_slots;
    firmware->told_slots = told;
    if (both > firmware->command_slots)
        firmware->command_slots = both;
    if (answer->planner_free >= firmware->planner_blocks)
        firmware->planner_blocks = answer->planner_free + 1; /* one is always kept free */
    if (firmware->receive_bytes == 0)
        firmware->receive_bytes = firmware->usual_receive_bytes;
}

void fio_firmware_learn(fio_firmware *firmware, const fio_answer *answer) {
    if (answer->kind == FIO_ANSWER_CAPABILITY)
        learn_capability(firmware, answer);
    else if (answer->kind == FIO_ANSWER_FIRMWARE)
        learn_tools(firmware, answer);
    else if (answer->kind == FIO_ANSWER_OK)
        learn_buffers(firmware, answer);
}

typedef struct command_row {
    char letter;
    short first, last;
    short traits;
} command_row;

enum {
    LONG = FIO_COMMAND_LONG,
    MOVES = FIO_COMMAND_MOVES,
    DRAINS = FIO_COMMAND_DRAINS,
    USER = FIO_COMMAND_USER,
    HEATS = FIO_COMMAND_HEATS
};

static const command_row command_rows[] = {
    {'G', 0, 3, MOVES},
    {'G', 4, 4, LONG | DRAINS},
    {'G', 5, 6, MOVES},
    {'G', 10, 11, MOVES},
    {'G', 12, 12, LONG | MOVES | DRAINS},   /* clean the nozzle */
    {'G', 26, 38, LONG | MOVES | DRAINS},   /* patterns, parking, homing, levelling, probing */
    {'G', 76, 81, LONG | MOVES | DRAINS},   /* Prusa's calibrations and mesh */
    {'G', 425, 425, LONG | MOVES | DRAINS}, /* calibration by a probe */
    {'M', 0, 1, LONG | DRAINS | USER},
    {'M', 17, 18, DRAINS},
    {'M', 28, 29, FIO_COMMAND_SD_WRITE},
    {'M', 32, 32, LONG | DRAINS},
    {'M', 48, 48, LONG | MOVES | DRAINS},
    {'M', 84, 84, DRAINS},
    {'M', 98, 98, LONG}, /* a macro */
    {'M', 104, 104, HEATS},
    {'M', 108, 108, FIO_COMMAND_STOPS},
    {'M', 109, 109, LONG | DRAINS | HEATS},
    {'M', 110, 110, FIO_COMMAND_NUMBERS},
    {'M', 112, 112, FIO_COMMAND_STOPS},
    {'M', 116, 116, LONG | DRAINS},
    {'M', 140, 141, HEATS},
    {'M', 190, 192, LONG | DRAINS | HEATS},
    {'M', 226, 226, LONG | DRAINS | USER},
    {'M', 303, 306, LONG | DRAINS | HEATS},
    {'M', 400, 400, LONG | DRAINS},
    {'M', 401, 402, LONG | MOVES | DRAINS}, /* the probe */
    {'M', 410, 410, FIO_COMMAND_STOPS},
    {'M', 500, 502, LONG},
    {'M', 600, 603, LONG | MOVES | DRAINS | USER},
    {'M', 701, 702, LONG | MOVES | DRAINS},
    {'M', 860, 869, LONG},
    {'M', 876, 876, FIO_COMMAND_STOPS},
    {'M', 997, 997, LONG | FIO_COMMAND_RESETS},
    {'M', 999, 999, FIO_COMMAND_RESETS},
    {'T', 0, 9999, LONG | MOVES | DRAINS},
};

static unsigned macro_traits(const char *command, size_t length) {
    fio_words words = {command, command + length};
    bool restart = fio_words_take(&words, "FIRMWARE_RESTART") || fio_words_take(&words, "RESTART");
    return (unsigned)LONG | (restart ? FIO_COMMAND_RESETS : 0u);
}

unsigned fio_command_traits(const char *command, size_t length) {
    if (length == 0)
        return 0;
    char letter = (char)(command[0] >= 'a' && command[0] <= 'z' ? command[0] - 32 : command[0]);
    fio_words words = {command + 1, command + length};
    int64_t code;
    fio_words_blanks(&words);
    if ((letter != 'G' && letter != 'M' && letter != 'T') || !fio_words_integer(&words, &code)) {
        bool name = length > 1 && letter >= 'A' && letter <= 'Z' &&
                    ((command[1] | 32) >= 'a' || command[1] == '_' || letter == 'T');
        return name ? macro_traits(command, length) : 0; /* Klipper's, or Prusa's "T?" */
    }
    for (size_t i = 0; i < sizeof command_rows / sizeof *command_rows; i++)
        if (command_rows[i].letter == letter && code >= command_rows[i].first &&
            code <= command_rows[i].last)
            return (unsigned)command_rows[i].traits;
    return 0;
}
