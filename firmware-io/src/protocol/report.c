#include "protocol/report.h"

#include <math.h>
#include <string.h>

#define HOTTEST 2000. /* °C: more, or less than the negative, is no temperature */

/* "T", "T0", "B", "@", "B@", "B@0"; *length 0 if there is none. */
static size_t name_length(const fio_words *words) {
    const char *p = words->at;
    while (p < words->end && p - words->at < 4 &&
           ((*p >= 'A' && *p <= 'Z') || (*p >= '0' && *p <= '9' && p > words->at) || *p == '@'))
        p++;
    return (size_t)(p - words->at);
}

static bool in_range(double value) {
    return fabs(value) <= HOTTEST;
}

/* " /205.00", or nothing. */
static bool read_target(fio_words *words, double *target) {
    fio_words after = *words;
    *target = -1;
    fio_words_blanks(&after);
    if (!fio_words_take(&after, "/"))
        return true;
    fio_words_blanks(&after);
    if (!fio_words_number(&after, target) || !in_range(*target))
        return false;
    *words = after;
    return true;
}

static void store(fio_answer *answer, const char *name, size_t length, double value,
                  double target) {
    if (name[0] == 'B' && length == 1) {
        answer->has_bed = true;
        answer->bed = value;
        answer->bed_target = target;
    }
    int tool = length == 2 ? name[1] - '0' : 0;
    if (name[0] != 'T' || length > 2 || tool < 0 || tool >= FIO_ANSWER_TOOLS)
        return;
    answer->nozzles |= 1u << tool;
    answer->nozzle[tool] = value;
    answer->nozzle_target[tool] = target;
}

/* What stands in a report besides temperatures: powers "@:12", "@12", "B@:0", the seconds M109
 * still waits "W:3" or "W:?", raw values "(2011.0)". */
static bool read_item(fio_words *words, fio_answer *answer) {
    double value, target;
    if (fio_words_take(words, "("))
        return fio_words_number(words, &value) && fio_words_take(words, ")");
    if (fio_words_take(words, "W:?"))
        return true;
    const char *name = words->at;
    size_t length = name_length(words);
    if (length == 0)
        return false;
    words->at += length;
    bool power = memchr(name, '@', length) != NULL;
    if (!fio_words_take(words, ":"))
        return power;
    fio_words_blanks(words); /* RepRapFirmware's "T0: 20.0" */
    if (!fio_words_number(words, &value) || !in_range(value))
        return false;
    if (!read_target(words, &target))
        return false;
    if (!power)
        store(answer, name, length, value, target);
    return true;
}

bool fio_report_temperatures(fio_answer *answer, fio_words words) {
    fio_answer read = *answer;
    fio_words_blanks(&words);
    while (!fio_words_done(&words)) {
        const char *before = words.at;
        if (!read_item(&words, &read))
            return false;
        fio_words_blanks(&words);
        if (!fio_words_done(&words) && words.at[-1] != ' ' && words.at[-1] != '\t' &&
            *before != '(' && *words.at != '(')
            return false;
    }
    if (read.nozzles == 0 && !read.has_bed)
        return false;
    read.has_temperatures = true;
    *answer = read;
    return true;
}

bool fio_report_position(fio_answer *answer, fio_words words) {
    static const char letters[] = "XYZE";
    double position[4] = {0};
    int seen = 0;
    fio_words_blanks(&words);
    while (!fio_words_done(&words) && !fio_words_take(&words, "Count")) {
        size_t length = name_length(&words);
        const char *letter = length > 0 ? memchr(letters, *words.at, 4) : NULL;
        bool asked = letter && length == 1;
        double value;
        if (length == 0)
            return false;
        words.at += length;
        if (!fio_words_take(&words, ":") || !fio_words_number(&words, &value))
            return false;
        if (!fio_words_done(&words) && *words.at != ' ')
            return false;
        if (asked && !(seen >> (letter - letters) & 1)) {
            position[letter - letters] = value;
            seen |= 1 << (letter - letters);
        }
        fio_words_blanks(&words);
    }
    if ((seen & 7) != 7)
        return false;
    memcpy(answer->position, position, sizeof position);
    return true;
}
