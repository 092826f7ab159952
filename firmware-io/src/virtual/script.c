#include "virtual/script.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"

#define LEAST_REPETITION 0.01 /* s: the machine shall come to something else, too */

/* What follows the words of an action. */
typedef enum argument {
    NOTHING,
    SECONDS,       /* a number, 0 or more */
    MAYBE_FOR,     /* "for" seconds, or nothing */
    COUNT,         /* a whole number above 0, or nothing: 1 */
    COUNT_OR_EVER, /* the same, or "for ever" */
    INTEGER,
    CHANCE, /* 0 to 1 */
    TEXT    /* in quotation marks, or one word */
} argument;

static const struct {
    const char *words;
    fio_deed deed;
    argument argument;
} deeds[] = {
    {"reset", FIO_DO_RESET, NOTHING},
    {"unplug", FIO_DO_UNPLUG, MAYBE_FOR},
    {"plug", FIO_DO_PLUG, NOTHING},
    {"halt", FIO_DO_HALT, TEXT},
    {"silent", FIO_DO_SILENT, SECONDS},
    {"mute", FIO_DO_MUTE, SECONDS},
    {"busy", FIO_DO_BUSY, SECONDS},
    {"throttle", FIO_DO_THROTTLE, SECONDS},
    {"answer", FIO_DO_ANSWER, TEXT},
    {"action", FIO_DO_ACTION, TEXT},
    {"lose ok", FIO_DO_LOSE_OK, COUNT},
    {"double ok", FIO_DO_DOUBLE_OK, COUNT},
    {"late ok", FIO_DO_LATE_OK, SECONDS},
    {"lose answer", FIO_DO_LOSE_ANSWER, COUNT},
    {"flip line", FIO_DO_FLIP_LINE, COUNT},
    {"cut line", FIO_DO_CUT_LINE, COUNT},
    {"reject", FIO_DO_REJECT, COUNT_OR_EVER},
    {"resend", FIO_DO_RESEND, INTEGER},
    {"miscount", FIO_DO_MISCOUNT, INTEGER},
    {"forget", FIO_DO_FORGET, NOTHING},
    {"demand checksums", FIO_DO_DEMAND, NOTHING},
    {"relax", FIO_DO_RELAX, NOTHING},
    {"ok first", FIO_DO_OK_FIRST, NOTHING},
    {"ok last", FIO_DO_OK_LAST, NOTHING},
    {"press", FIO_DO_PRESS, NOTHING},
    {"heater nozzle dead", FIO_DO_NOZZLE_DEAD, NOTHING},
    {"heater nozzle stuck", FIO_DO_NOZZLE_STUCK, NOTHING},
    {"heater nozzle well", FIO_DO_NOZZLE_WELL, NOTHING},
    {"thermistor nozzle open", FIO_DO_NOZZLE_OPEN, NOTHING},
    {"thermistor nozzle short", FIO_DO_NOZZLE_SHORT, NOTHING},
    {"heater bed dead", FIO_DO_BED_DEAD, NOTHING},
    {"heater bed stuck", FIO_DO_BED_STUCK, NOTHING},
    {"heater bed well", FIO_DO_BED_WELL, NOTHING},
    {"thermistor bed open", FIO_DO_BED_OPEN, NOTHING},
    {"thermistor bed short", FIO_DO_BED_SHORT, NOTHING},
    {"flip in", FIO_DO_FLIP_IN, CHANCE},
    {"flip out", FIO_DO_FLIP_OUT, CHANCE},
    {"flip bytes", FIO_DO_FLIP_BYTES, CHANCE},
    {"lose bytes", FIO_DO_LOSE_BYTES, CHANCE},
    {"lose oks", FIO_DO_LOSE_OKS, CHANCE},
    {"double oks", FIO_DO_DOUBLE_OKS, CHANCE},
    {"late oks", FIO_DO_LATE_OKS, CHANCE},
    {"split", FIO_DO_SPLIT, CHANCE},
    {"merge", FIO_DO_MERGE, CHANCE},
};

typedef struct cursor {
    const char *start, *at, *end; /* of the line */
    int line;
} cursor;

static fio_status complain(const cursor *here, const char *what) {
    return fio_fail(FIO_USAGE, "script, line %d, column %d: %s", here->line,
                    (int)(here->at - here->start) + 1, what);
}

static void skip_blanks(cursor *here) {
    while (here->at < here->end && (*here->at == ' ' || *here->at == '\t' || *here->at == '\r'))
        here->at++;
}

static bool at_end(cursor *here) {
    skip_blanks(here);
    return here->at == here->end || *here->at == '#';
}

static bool ends_word(const char *p, const char *end) {
    return p == end || *p == ' ' || *p == '\t' || *p == '\r' || *p == '#';
}

/* Take the words, if they are there; a blank of theirs stands for any number. */
static bool take_words(cursor *here, const char *words) {
    cursor saved = *here;
    while (*words) {
        skip_blanks(here);
        while (*words && *words != ' ') {
            if (here->at == here->end || *here->at != *words) {
                *here = saved;
                return false;
            }
            here->at++;
            words++;
        }
        if (!ends_word(here->at, here->end)) {
            *here = saved;
            return false;
        }
        words += *words == ' ';
    }
    return true;
}

static fio_status take_number(cursor *here, double *value) {
    skip_blanks(here);
    const char *after = fio_number_read(value, here->at, here->end);
    if (after == here->at)
        return complain(here, "a number is expected");
    if (!ends_word(after, here->end) || !isfinite(*value))
        return complain(here, "this is no number that can be used");
    here->at = after;
    return FIO_OK;
}

static fio_status take_whole(cursor *here, double *value, double least) {
    cursor before = *here;
    skip_blanks(&before);
    fio_status status = take_number(here, value);
    if (status != FIO_OK)
        return status;
    if (*value != floor(*value))
        return complain(&before, "a whole number is expected");
    return *value < least ? complain(&before, "this number is too small") : FIO_OK;
}

static fio_status take_seconds(cursor *here, double *value) {
    cursor before = *here;
    skip_blanks(&before);
    fio_status status = take_number(here, value);
    if (status == FIO_OK && *value < 0)
        status = complain(&before, "a time is not negative");
    return status;
}

static fio_status take_text(fio_script *script, cursor *here, int *text) {
    if (at_end(here))
        return complain(here, "a text is expected, in quotation marks");
    cursor before = *here;
    bool quoted = *here->at == '"';
    here->at += quoted;
    const char *start = here->at;
    while (here->at < here->end && (quoted ? *here->at != '"' : !ends_word(here->at, here->end)))
        here->at++;
    if (quoted && here->at == here->end)
        return complain(&before, "this quotation mark is never closed");
    size_t length = (size_t)(here->at - start);
    here->at += quoted;
    if (length + 1 > (size_t)(FIO_SCRIPT_TEXT - script->used))
        return complain(&before, "the texts of the script are too long");
    *text = script->used;
    memcpy(script->texts + script->used, start, length);
    script->used += (int)length;
    script->texts[script->used++] = 0;
    return FIO_OK;
}

static fio_status take_argument(fio_script *script, cursor *here, argument wanted,
                                fio_script_step *step) {
    cursor before = *here;
    skip_blanks(&before);
    switch (wanted) {
    case SECONDS:
        return take_seconds(here, &step->value);
    case MAYBE_FOR:
        return take_words(here, "for") ? take_seconds(here, &step->value) : FIO_OK;
    case COUNT_OR_EVER:
        if (take_words(here, "for ever")) {
            step->value = INFINITY;
            return FIO_OK;
        } /* fall through */
    case COUNT:
        step->value = 1;
        return at_end(here) ? FIO_OK : take_whole(here, &step->value, 1);
    case INTEGER:
        return take_whole(here, &step->value, -1e9);
    case CHANCE: {
        fio_status status = take_number(here, &step->value);
        if (status == FIO_OK && (step->value < 0 || step->value > 1))
            status = complain(&before, "a probability is 0 to 1");
        return status;
    }
    case TEXT:
        return take_text(script, here, &step->text);
    default:
        return FIO_OK;
    }
}

static fio_status take_deed(fio_script *script, cursor *here, fio_script_step *step) {
    skip_blanks(here);
    for (size_t i = 0; i < sizeof deeds / sizeof *deeds; i++) {
        if (!take_words(here, deeds[i].words))
            continue;
        step->deed = deeds[i].deed;
        return take_argument(script, here, deeds[i].argument, step);
    }
    return complain(here, "no such action: reset, unplug, halt \"…\", silent 20, lose ok, flip in "
                          "0.05 … are some");
}

/* "line 100", "time 12.5", "command G28" … */
static fio_status take_moment(fio_script *script, cursor *here, fio_script_step *step) {
    static const char *const names[FIO_MOMENTS] = {
        [FIO_AT_TIME] = "time", [FIO_AT_LINE] = "line", [FIO_AT_NUMBER] = "number",
        [FIO_AT_BYTE] = "byte", [FIO_AT_OK] = "ok",     [FIO_AT_COMMAND] = "command",
    };
    skip_blanks(here);
    for (int i = 0; i < FIO_MOMENTS; i++) {
        if (!take_words(here, names[i]))
            continue;
        step->moment = (fio_moment)i;
        if (i == FIO_AT_COMMAND)
            return take_text(script, here, &step->command);
        return i == FIO_AT_TIME ? take_seconds(here, &step->at)
                                : take_whole(here, &step->at, i == FIO_AT_NUMBER ? 0 : 1);
    }
    return complain(here, "time, line, number, byte, ok or command is expected");
}

/* "3 oks", "10 lines", "2.5 seconds" */
static fio_status take_amount(cursor *here, fio_moment *moment, double *amount) {
    static const struct {
        const char *name;
        fio_moment moment;
    } units[] = {
        {"seconds", FIO_AT_TIME}, {"second", FIO_AT_TIME}, {"lines", FIO_AT_LINE},
        {"line", FIO_AT_LINE},    {"bytes", FIO_AT_BYTE},  {"byte", FIO_AT_BYTE},
        {"oks", FIO_AT_OK},       {"ok", FIO_AT_OK},
    };
    cursor before = *here;
    skip_blanks(&before);
    fio_status status = take_number(here, amount);
    if (status != FIO_OK)
        return status;
    if (!(*amount > 0))
        return complain(&before, "this number is too small");
    skip_blanks(here);
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (take_words(here, units[i].name)) {
            *moment = units[i].moment;
            if (*moment != FIO_AT_TIME && *amount != floor(*amount))
                return complain(&before, "a whole number is expected");
            return FIO_OK;
        }
    return complain(here, "seconds, lines, bytes or oks is expected");
}

static fio_status add_step(fio_script *script, const cursor *here, const fio_script_step *step) {
    if (script->count == FIO_SCRIPT_STEPS)
        return complain(here, "too many steps in the script");
    script->steps[script->count++] = *step;
    script->moments |= 1u << step->moment;
    return FIO_OK;
}

/* Beyond the "to", the probability is 0 again. */
static fio_status read_from(fio_script *script, cursor *here) {
    fio_script_step step = {.text = -1}, back = {.text = -1, .at = -1};
    cursor start = *here;
    fio_status status = take_moment(script, here, &step);
    if (status == FIO_OK && take_words(here, "to"))
        status = take_moment(script, here, &back);
    cursor deed = *here;
    skip_blanks(&deed);
    if (status == FIO_OK)
        status = take_deed(script, here, &step);
    if (status == FIO_OK && step.deed < FIO_DO_FLIP_IN)
        return complain(&deed, "after \"from\" a probability is set, as in: flip in 0.05");
    if (status == FIO_OK)
        status = add_step(script, &start, &step);
    if (status != FIO_OK || (back.at < 0 && back.moment != FIO_AT_COMMAND))
        return status;
    back.deed = step.deed;
    return add_step(script, &start, &back);
}

static fio_status read_step(fio_script *script, cursor *here) {
    if (take_words(here, "from"))
        return read_from(script, here);
    fio_script_step step = {.text = -1};
    cursor start = *here;
    fio_status status;
    if (take_words(here, "at"))
        status = take_moment(script, here, &step);
    else if (take_words(here, "after")) {
        status = take_amount(here, &step.moment, &step.at);
        step.at += step.moment != FIO_AT_TIME; /* after 3 oks is at ok 4 */
    } else if (take_words(here, "every command")) {
        step.moment = FIO_AT_COMMAND;
        step.every = 1;
        status = take_text(script, here, &step.command);
    } else if (take_words(here, "every")) {
        status = take_amount(here, &step.moment, &step.every);
        step.at = step.every;
        if (status == FIO_OK && step.every < LEAST_REPETITION)
            status = complain(&start, "nothing happens more often than every 0.01 s");
    } else
        return complain(here, "a step begins with at, after, every or from");
    if (status == FIO_OK)
        status = take_deed(script, here, &step);
    return status == FIO_OK ? add_step(script, &start, &step) : status;
}

/* Where the step that begins at `p` ends: at the line's end, or at a ';' outside a text or a
 * comment, so that a script fits on a command line. */
static const char *end_of_step(const char *p, const char *end) {
    bool quoted = false, comment = false;
    for (; p < end && *p != '\n'; p++) {
        if (*p == '"')
            quoted = !quoted;
        comment = comment || (*p == '#' && !quoted);
        if (*p == ';' && !quoted && !comment)
            break;
    }
    return p;
}

fio_status fio_script_read(fio_script *script, const char *text) {
    script->count = script->used = 0;
    script->moments = 0;
    cursor here = {.line = 1, .start = text};
    for (const char *end = text + strlen(text), *p = text; p < end;) {
        here.at = p;
        here.end = end_of_step(p, end);
        if (!at_end(&here)) {
            fio_status status = read_step(script, &here);
            if (status == FIO_OK && !at_end(&here))
                status = complain(&here, "the end of the step is expected");
            if (status != FIO_OK)
                return status;
        }
        p = here.end < end ? here.end + 1 : end;
        if (p > text && p[-1] == '\n') {
            here.line++;
            here.start = p;
        }
    }
    return FIO_OK;
}
