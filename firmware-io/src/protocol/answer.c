#include "protocol/answer.h"

#include <string.h>

#include "protocol/report.h"
#include "protocol/words.h"

enum { LARGEST_COUNT = 1 << 20 }; /* of free places in any buffer */

static bool starts(const fio_words *words, const char *text) {
    fio_words copy = *words;
    return fio_words_take(&copy, text);
}

static bool any_start(const fio_words *words, const char *const *texts) {
    for (; *texts; texts++)
        if (starts(words, *texts))
            return true;
    return false;
}

static bool any_within(const fio_words *words, const char *const *texts) {
    for (; *texts; texts++)
        if (fio_words_contain(words, *texts))
            return true;
    return false;
}

static bool is(const fio_words *words, const char *text) {
    fio_words copy = *words;
    return fio_words_take(&copy, text) && fio_words_done(&copy);
}

static fio_answer_kind after(fio_answer *answer, fio_words words, fio_answer_kind kind) {
    answer->rest = words.at;
    answer->rest_length = (size_t)(words.end - words.at);
    return kind;
}

/* "N3 P15 B3" or any part of it, or Repetier's plain number. */
static void read_counts(fio_answer *answer, fio_words words) {
    int64_t value[3] = {-1, -1, -1};
    static const char *const letters[3] = {"N", "P", "B"};
    fio_words_blanks(&words);
    if (!fio_words_integer(&words, &value[0]))
        for (int i = 0; i < 3; i++) {
            if (fio_words_take(&words, letters[i]) && !fio_words_integer(&words, &value[i]))
                return;
            if (!fio_words_done(&words) && value[i] >= 0 && *words.at != ' ')
                return;
            fio_words_blanks(&words);
        }
    fio_words_blanks(&words);
    if (!fio_words_done(&words) || value[1] > LARGEST_COUNT || value[2] > LARGEST_COUNT)
        return;
    answer->line = value[0];
    answer->planner_free = (int)value[1];
    answer->commands_free = (int)value[2];
}

static bool read_ok(fio_answer *answer, fio_words words) {
    if (!fio_words_take(&words, "ok") || !(fio_words_done(&words) || *words.at == ' '))
        return false;
    fio_words_blanks(&words);
    if (starts(&words, "Emergency Stop")) /* Smoothie's answer to M112 */
        return false;
    after(answer, words, FIO_ANSWER_OK);
    if (!fio_report_temperatures(answer, words))
        read_counts(answer, words);
    return true;
}

static bool read_resend(fio_answer *answer, fio_words words) {
    bool colon = fio_words_take(&words, "Resend:") || fio_words_take(&words, "resend:");
    if (!colon && !fio_words_take(&words, "Resend ") && !fio_words_take(&words, "rs "))
        return false;
    fio_words_blanks(&words);
    after(answer, words, FIO_ANSWER_RESEND);
    bool number = fio_words_take(&words, "N:") || fio_words_take(&words, "N") || true;
    int64_t line = -1;
    number = number && fio_words_integer(&words, &line);
    fio_words_blanks(&words);
    if (!number || !fio_words_done(&words))
        return false;
    answer->line = line;
    return true;
}

/* Reasons are lower-case words; others than the three of Marlin are as good as its first. */
static bool read_busy(fio_answer *answer, fio_words words) {
    if (fio_words_take(&words, "echo:"))
        fio_words_blanks(&words);
    if (!fio_words_take(&words, "busy:"))
        return false;
    fio_words_blanks(&words);
    while (words.end > words.at && words.end[-1] == ' ')
        words.end--;
    if (fio_words_done(&words))
        return false;
    for (const char *p = words.at; p < words.end; p++)
        if (*p != ' ' && !(*p >= 'a' && *p <= 'z'))
            return false;
    answer->busy = is(&words, "paused for user")    ? FIO_BUSY_PAUSED_FOR_USER
                   : is(&words, "paused for input") ? FIO_BUSY_PAUSED_FOR_INPUT
                                                    : FIO_BUSY_PROCESSING;
    after(answer, words, FIO_ANSWER_BUSY);
    return true;
}

static bool read_capability(fio_answer *answer, fio_words words) {
    int64_t value;
    if (!fio_words_take(&words, "Cap:"))
        return false;
    fio_words name = words;
    while (!fio_words_done(&words) && ((*words.at >= 'A' && *words.at <= 'Z') ||
                                       (*words.at >= '0' && *words.at <= '9') || *words.at == '_'))
        words.at++;
    name.end = words.at;
    if (fio_words_done(&name) || !fio_words_take(&words, ":") || !fio_words_integer(&words, &value))
        return false;
    fio_words_blanks(&words);
    if (!fio_words_done(&words))
        return false;
    after(answer, name, FIO_ANSWER_CAPABILITY);
    answer->line = value;
    return true;
}

static bool is_start(fio_words words) {
    static const char *const banners[] = {"Grbl ", "Smoothie", "RepRapFirmware ",
                                          "RepRapFirmware for", NULL};
    if (is(&words, "// Klipper state: Ready") || any_start(&words, banners))
        return true;
    fio_words marlin = words;
    if (fio_words_take(&marlin, "echo:"))
        fio_words_blanks(&marlin);
    if (fio_words_take(&marlin, "Marlin ") && !fio_words_done(&marlin) &&
        ((*marlin.at >= '0' && *marlin.at <= '9') || starts(&marlin, "bugfix")))
        return true;
    /* A bootloader, or a rate that was wrong a moment ago, leaves bytes that are no text. */
    while (!fio_words_done(&words) && ((unsigned char)*words.at < ' ' || *words.at & 0x80))
        words.at++;
    return is(&words, "start");
}

static const char *const dead[] = {"Printer halted",
                                   "kill() called",
                                   "system stopped",
                                   "Printer stopped",
                                   "Printer is shutdown",
                                   "FIRMWARE_RESTART",
                                   "Emergency Stop",
                                   "Kill button pressed",
                                   "to exit HALT state",
                                   "Alarm lock",
                                   NULL};

static bool read_error(fio_answer *answer, fio_words words) {
    static const char *const alarms[] = {"ALARM:",
                                         "Alarm:",
                                         "fatal:",
                                         "Emergency Stop!",
                                         "ok Emergency Stop",
                                         "HALTED",
                                         "// Klipper state: Shutdown",
                                         "// Printer is shutdown",
                                         "// Printer is halted",
                                         NULL};
    if (any_start(&words, alarms)) {
        after(answer, words, answer->kind = FIO_ANSWER_HALTED);
        return true;
    }
    bool refused = fio_words_take(&words, "!!");
    if (!refused && !fio_words_take(&words, "Error:") && !fio_words_take(&words, "error:"))
        return false;
    fio_words_blanks(&words);
    after(answer, words, FIO_ANSWER_ERROR);
    bool halted = any_within(&words, dead) || (refused && fio_words_done(&words)); /* Smoothie */
    answer->kind = halted ? FIO_ANSWER_HALTED : FIO_ANSWER_ERROR;
    /* "…, Last Line: 12" */
    static const char last[] = "Last Line: ";
    while (!fio_words_done(&words) && !starts(&words, last))
        words.at++;
    int64_t line;
    if (!fio_words_take(&words, last) || !fio_words_integer(&words, &line))
        return true;
    fio_words_blanks(&words);
    if (fio_words_done(&words))
        answer->line = line;
    return true;
}

static bool read_sd(fio_answer *answer, fio_words words) {
    static const char *const starts_of[] = {
        "Not SD printing",    "File opened:",     "File selected",
        "Done printing file", "Done saving file", "Writing to file:",
        "SD card ",           "SD init",          "Begin file list",
        "End file list",      "open failed",      "Now fresh file:",
        "File deleted",       "Deletion failed",  "volume.init failed",
        "openRoot failed",    "SD print ",        NULL};
    if (fio_words_take(&words, "echo:"))
        fio_words_blanks(&words);
    int64_t byte, size;
    fio_words printing = words;
    after(answer, words, FIO_ANSWER_SD);
    if (fio_words_take(&printing, "SD printing byte ") && fio_words_integer(&printing, &byte) &&
        fio_words_take(&printing, "/") && fio_words_integer(&printing, &size) &&
        fio_words_done(&printing)) {
        answer->line = byte;
        return true;
    }
    return any_start(&words, starts_of);
}

static fio_answer_kind read_talk(fio_answer *answer, fio_words words) {
    static const char *const refusals[] = {"Unknown command",
                                           "extrusion prevented",
                                           "Invalid extruder",
                                           "Home XYZ first",
                                           "Home X",
                                           "extruder change prevented",
                                           NULL};
    fio_words action = words;
    if (fio_words_take(&action, "//")) {
        fio_words_blanks(&action);
        if (fio_words_take(&action, "action:"))
            return after(answer, action, FIO_ANSWER_ACTION);
    }
    bool echo = fio_words_take(&words, "echo:") || fio_words_take(&words, "//");
    fio_words_blanks(&words);
    if (any_within(&words, refusals) && (echo || any_start(&words, refusals)))
        return after(answer, words, FIO_ANSWER_PREVENTED);
    return echo ? after(answer, words, FIO_ANSWER_ECHO) : FIO_ANSWER_OTHER;
}

static fio_answer_kind read_kind(fio_answer *answer, fio_words words) {
    if (is_start(words))
        return after(answer, words, FIO_ANSWER_START);
    fio_words_blanks(&words);
    if (read_ok(answer, words))
        return FIO_ANSWER_OK;
    if (read_resend(answer, words))
        return FIO_ANSWER_RESEND;
    if (read_busy(answer, words))
        return FIO_ANSWER_BUSY;
    if (is(&words, "wait"))
        return FIO_ANSWER_WAIT;
    if (read_error(answer, words))
        return answer->kind;
    if (fio_report_temperatures(answer, words))
        return FIO_ANSWER_TEMPERATURES;
    if (fio_report_position(answer, words))
        return FIO_ANSWER_POSITION;
    if (starts(&words, "[VER:") ||
        (fio_words_contain(&words, "FIRMWARE_NAME:") && starts(&words, "FIRMWARE_")))
        return after(answer, words, FIO_ANSWER_FIRMWARE);
    if (read_capability(answer, words))
        return FIO_ANSWER_CAPABILITY;
    if (read_sd(answer, words))
        return FIO_ANSWER_SD;
    after(answer, words, FIO_ANSWER_OTHER);
    return read_talk(answer, words);
}

void fio_answer_read(fio_answer *answer, const char *line, size_t length) {
    while (length > 0 && (line[length - 1] == '\n' || line[length - 1] == '\r'))
        length--;
    *answer = (fio_answer){.text = line,
                           .length = length,
                           .rest = line,
                           .rest_length = length,
                           .line = -1,
                           .planner_free = -1,
                           .commands_free = -1,
                           .bed_target = -1};
    for (int i = 0; i < FIO_ANSWER_TOOLS; i++)
        answer->nozzle_target[i] = -1;
    answer->kind = read_kind(answer, (fio_words){line, line + length});
}

bool fio_answer_says(const fio_answer *answer, const char *text) {
    return answer->rest_length == strlen(text) &&
           memcmp(answer->rest, text, answer->rest_length) == 0;
}

void fio_answer_parser_reset(fio_answer_parser *parser) {
    parser->length = 0;
    parser->cut = false;
}

static void end_line(fio_answer_parser *parser, fio_answer_taker *taker, void *context) {
    if (parser->length > 0) {
        fio_answer answer;
        parser->line[parser->length] = 0;
        fio_answer_read(&answer, parser->line, (size_t)parser->length);
        answer.cut = parser->cut;
        taker(context, &answer);
    }
    fio_answer_parser_reset(parser);
}

void fio_answer_parser_feed(fio_answer_parser *parser, const void *bytes, size_t size,
                            fio_answer_taker *taker, void *context) {
    const char *p = bytes, *end = p + size;
    for (; p < end; p++) {
        if (*p == '\n' || *p == '\r')
            end_line(parser, taker, context);
        else if (parser->length < FIO_ANSWER_MOST)
            parser->line[parser->length++] = *p;
        else
            parser->cut = true;
    }
}
