#include "protocol/track.h"

#include <math.h>
#include <string.h>

#include "base/number.h"
#include "base/text.h"

#define INCH 25.4
#define SOFT 170. /* °C: colder than this usual limit no firmware lets filament move */

/* mm/min of the moves back to the part. */
enum { LIFT_FEEDRATE = 600, TRAVEL_FEEDRATE = 6000, PRIME_FEEDRATE = 1800 };

typedef struct fio_word_set {
    char letter;
    int code, subcode;
    uint32_t seen, valued; /* bit l - 'A'; the last word of a letter counts */
    double value[26];
} fio_word_set;

static const char *skip_blanks(const char *p, const char *end) {
    while (p < end && (*p == ' ' || *p == '\t'))
        p++;
    return p;
}

static int letter_index(char c) {
    unsigned index = ((unsigned)(unsigned char)c | 32u) - 'a';
    return index < 26 ? (int)index : -1;
}

static const char *read_digits(int *value, const char *p, const char *end) {
    *value = 0;
    for (; p < end && *p >= '0' && *p <= '9'; p++)
        if (*value < 100000)
            *value = *value * 10 + (*p - '0');
    return p;
}

static bool read_words(fio_word_set *words, const char *p, const char *end) {
    p = skip_blanks(p, end);
    int index = p < end ? letter_index(*p) : -1;
    if (index != 'G' - 'A' && index != 'M' - 'A' && index != 'T' - 'A')
        return false;
    const char *digits = skip_blanks(p + 1, end);
    words->letter = (char)('A' + index);
    words->subcode = 0;
    p = read_digits(&words->code, digits, end);
    if (p == digits)
        return false;
    if (p < end && *p == '.')
        p = read_digits(&words->subcode, p + 1, end);
    words->seen = words->valued = 0;
    while (p < end) {
        index = letter_index(*p++);
        if (index < 0)
            continue;
        const char *number = skip_blanks(p, end);
        words->seen |= 1u << index;
        words->valued &= ~(1u << index);
        p = fio_number_read(&words->value[index], number, end);
        if (p > number && isfinite(words->value[index]))
            words->valued |= 1u << index;
    }
    return true;
}

static bool has(const fio_word_set *words, char letter) {
    return words->valued >> (letter - 'A') & 1;
}

static bool seen(const fio_word_set *words, char letter) {
    return words->seen >> (letter - 'A') & 1;
}

static double value(const fio_word_set *words, char letter) {
    return words->value[letter - 'A'];
}

void fio_track_reset(fio_track *track) {
    *track = (fio_track){.bed = -1, .feedrate_percent = 100, .flow_percent = 100};
    for (int i = 0; i < FIO_TRACK_TOOLS; i++)
        track->nozzle[i] = -1;
}

static double unit(const fio_track *track) {
    return track->inches ? INCH : 1;
}

static void follow_move(fio_track *track, const fio_word_set *words) {
    for (int i = 0; i < 4; i++) {
        char letter = "XYZE"[i];
        if (!has(words, letter))
            continue;
        double given = value(words, letter) * unit(track);
        bool relative = i < 3 ? track->relative : track->relative_extrusion;
        track->position[i] = relative ? track->position[i] + given : given;
        track->known[i] = track->known[i] || !relative;
        if (i < 3)
            track->raised = 0;
    }
    if (has(words, 'F') && value(words, 'F') > 0)
        track->feedrate = value(words, 'F') * unit(track);
}

static void note_homed(fio_track *track) {
    track->homed = track->homed_axes[0] && track->homed_axes[1] && track->homed_axes[2];
}

static void follow_homing(fio_track *track, const fio_word_set *words) {
    bool some = seen(words, 'X') || seen(words, 'Y') || seen(words, 'Z');
    for (int i = 0; i < 3; i++) {
        bool asked = !some || seen(words, (char)('X' + i));
        if (!asked || (seen(words, 'O') && track->homed_axes[i])) /* O: what is not homed yet */
            continue;
        track->position[i] = track->offset[i] = 0;
        track->known[i] = track->homed_axes[i] = true;
    }
    note_homed(track);
    track->raised = 0;
}

static void follow_motors(fio_track *track, const fio_word_set *words) {
    if (seen(words, 'S'))
        return; /* a time-out */
    bool some = seen(words, 'X') || seen(words, 'Y') || seen(words, 'Z') || seen(words, 'E');
    for (int i = 0; i < 3; i++)
        if (!some || seen(words, (char)('X' + i)))
            track->homed_axes[i] = false;
    note_homed(track);
}

static void follow_position(fio_track *track, const fio_word_set *words) {
    for (int i = 0; i < 4; i++) {
        char letter = "XYZE"[i];
        double before = track->position[i];
        if (words->subcode == 1 && i < 3)
            track->position[i] -= track->offset[i];
        else if (words->subcode == 0 && has(words, letter))
            track->position[i] = value(words, letter) * unit(track);
        else
            continue;
        track->known[i] = track->known[i] || i == 3;
        if (i < 3)
            track->offset[i] += track->position[i] - before;
    }
}

static void follow_g(fio_track *track, const fio_word_set *words) {
    if (words->subcode != 0 && words->code != 92)
        return;
    switch (words->code) {
    case 0:
    case 1:
    case 2:
    case 3:
        follow_move(track, words);
        break;
    case 10:
    case 11:
        if (!seen(words, 'P') && !seen(words, 'L')) /* those set a tool's offset */
            track->retracted = words->code == 10;
        break;
    case 20:
    case 21:
        track->inches = words->code == 20;
        break;
    case 28:
        follow_homing(track, words);
        break;
    case 90: /* for E too, until M82 or M83 */
    case 91:
        track->relative = track->relative_extrusion = words->code == 91;
        break;
    case 92:
        follow_position(track, words);
        break;
    default:
        break;
    }
}

static void follow_heat(fio_track *track, const fio_word_set *words, bool bed) {
    double tool = has(words, 'T') ? value(words, 'T') : track->tool;
    char letter = has(words, 'S') ? 'S' : 'R';
    if (!has(words, letter) || (!bed && !(tool >= 0 && tool < FIO_TRACK_TOOLS)))
        return;
    double target = fmax(value(words, letter), 0);
    if (bed)
        track->bed = target;
    else
        track->nozzle[(int)tool] = target;
}

static void follow_fan(fio_track *track, const fio_word_set *words) {
    if (has(words, 'P') && value(words, 'P') != 0)
        return; /* fan 0 cools the part; others the machine */
    double speed = has(words, 'S') ? value(words, 'S') : 255;
    track->fan = words->code == 107 ? 0 : fmin(fmax(speed, 0), 255);
}

static void follow_accelerations(fio_track *track, const fio_word_set *words) {
    static const char letters[3] = {'P', 'R', 'T'};
    if (has(words, 'S') && value(words, 'S') > 0)
        track->acceleration[0] = track->acceleration[2] = value(words, 'S') * unit(track);
    for (int i = 0; i < 3; i++)
        if (has(words, letters[i]) && value(words, letters[i]) > 0)
            track->acceleration[i] = value(words, letters[i]) * unit(track);
}

static void follow_percent(double *percent, const fio_word_set *words) {
    if (has(words, 'S') && value(words, 'S') > 0)
        *percent = value(words, 'S');
}

static void follow_m(fio_track *track, const fio_word_set *words) {
    switch (words->code) {
    case 18:
    case 84:
        follow_motors(track, words);
        break;
    case 82:
    case 83:
        track->relative_extrusion = words->code == 83;
        break;
    case 104:
    case 109:
        follow_heat(track, words, false);
        break;
    case 106:
    case 107:
        follow_fan(track, words);
        break;
    case 140:
    case 190:
        follow_heat(track, words, true);
        break;
    case 204:
        follow_accelerations(track, words);
        break;
    case 220:
        follow_percent(&track->feedrate_percent, words);
        break;
    case 221:
        follow_percent(&track->flow_percent, words);
        break;
    default:
        break;
    }
}

void fio_track_follow(fio_track *track, const char *command, size_t length) {
    fio_word_set words;
    if (!read_words(&words, command, command + length))
        return;
    if (words.letter == 'G')
        follow_g(track, &words);
    else if (words.letter == 'M')
        follow_m(track, &words);
    else if (words.code < FIO_TRACK_TOOLS)
        track->tool = words.code;
}

static void put(fio_text *text, const char *words, double number, int decimals) {
    fio_text_string(text, words);
    fio_text_number(text, number, decimals);
}

static bool several_tools(const fio_track *track) {
    bool several = track->tool > 0;
    for (int i = 1; i < FIO_TRACK_TOOLS; i++)
        several = several || track->nozzle[i] >= 0;
    return several;
}

static void put_nozzles(fio_text *text, const fio_track *track, bool wait) {
    for (int i = 0; i < FIO_TRACK_TOOLS; i++) {
        double target = track->nozzle[i];
        if (wait ? target <= 0 : target < 0)
            continue;
        fio_text_string(text, wait ? "M109" : "M104");
        if (several_tools(track))
            put(text, " T", i, 0);
        put(text, " S", target, 1);
        fio_text_string(text, "\n");
    }
}

static void put_temperatures(fio_text *text, const fio_track *track) {
    if (track->bed >= 0) {
        put(text, "M140 S", track->bed, 1);
        fio_text_string(text, "\n");
    }
    put_nozzles(text, track, false);
    if (track->bed > 0) {
        put(text, "M190 S", track->bed, 1);
        fio_text_string(text, "\n");
    }
    put_nozzles(text, track, true);
}

/* Back to the part: up before anything moves sideways, down once above. */
static void put_moves(fio_text *text, const fio_track *track, bool homing, double lift) {
    const double *logical = track->position;
    double at[3]; /* in the coordinates the firmware has meanwhile */
    for (int i = 0; i < 3; i++)
        at[i] = homing ? logical[i] - track->offset[i] : logical[i];
    if (homing)
        put(text, "G92 Z", at[2] + track->raised, 4);
    put(text, homing ? "\nG1 Z" : "G1 Z", at[2] + (homing ? track->raised : 0) + lift, 4);
    put(text, " F", LIFT_FEEDRATE, 0);
    fio_text_string(text, homing ? "\nG28 X Y" : "");
    put(text, "\nG1 X", at[0], 4);
    put(text, " Y", at[1], 4);
    put(text, " F", TRAVEL_FEEDRATE, 0);
    put(text, "\nG1 Z", at[2], 4);
    put(text, " F", LIFT_FEEDRATE, 0);
    for (int i = 0; homing && i < 3; i++)
        if (track->offset[i] != 0) {
            const char *const words[3] = {"\nG92 X", "\nG92 Y", "\nG92 Z"};
            put(text, words[i], logical[i], 4);
        }
    fio_text_string(text, "\n");
}

static void put_settings(fio_text *text, const fio_track *track) {
    put(text, "M220 S", track->feedrate_percent, 2);
    put(text, "\nM221 S", track->flow_percent, 2);
    fio_text_string(text, "\n");
    for (int i = 0; i < 3; i++)
        if (track->acceleration[i] > 0) {
            const char *const words[3] = {"M204 P", "M204 R", "M204 T"};
            put(text, words[i], track->acceleration[i], 2);
            fio_text_string(text, "\n");
        }
    if (track->feedrate > 0) {
        put(text, "G1 F", track->feedrate, 3);
        fio_text_string(text, "\n");
    }
    if (track->fan > 0)
        put(text, "M106 S", track->fan, 2);
    else
        fio_text_string(text, "M107");
    fio_text_string(text, track->relative ? "\nG91" : "");
    fio_text_string(text, track->relative_extrusion ? "\nM83" : "\nM82");
    fio_text_string(text, track->inches ? "\nG20\n" : "\n");
}

size_t fio_track_restore(const fio_track *track, bool homing, double lift, double prime,
                         char *text) {
    fio_text out = fio_text_in(text, FIO_TRACK_TEXT);
    put_temperatures(&out, track);
    fio_text_string(&out, "G21\nG90\n");
    if (several_tools(track)) {
        put(&out, "T", track->tool, 0);
        fio_text_string(&out, "\n");
    }
    bool there = track->known[0] && track->known[1] && track->known[2] && track->homed;
    if (there)
        put_moves(&out, track, homing, lift);
    if (there && prime > 0 && track->nozzle[track->tool] >= SOFT) {
        put(&out, "M83\nG1 E", prime, 4);
        put(&out, " F", PRIME_FEEDRATE, 0);
        fio_text_string(&out, "\n");
    }
    put(&out, "G92 E", track->position[3], 5);
    fio_text_string(&out, "\n");
    put_settings(&out, track);
    return out.length;
}
