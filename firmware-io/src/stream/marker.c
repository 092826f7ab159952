/* Markers: commands whose answer proves that all before them was executed.
 *
 * An ok says nothing of which line it is for, and one too many looks like any other. So a text that
 * no other line has is sent for an echo (M118); where that is not known, M105, whose answer only
 * M105 gives: it counts for the line whose turn it is by the oks, else for the first one without,
 * and one right behind another is taken for its double. Rejected: M110 with its own number, which
 * is answered by a plain ok. */
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "stream/state.h"

#define RETRY_SECONDS 0.3   /* its ok came, its echo did not */
#define ALONE_SECONDS 0.2   /* of silence before it */
#define DOUBLE_SECONDS 0.05 /* an answer so soon after another is its double */
enum { ECHOES_MISSED_MOST = 12, TOKEN = 7 };

/* Seven hexadecimal digits of the number, mixed so that no two damaged bits make one of another. */
static void token_of(int64_t number, char token[TOKEN + 1]) {
    uint64_t bits = (uint64_t)number * 0x9e3779b97f4a7c15u;
    bits ^= bits >> 31;
    bits *= 0xbf58476d1ce4e5b9u;
    bits ^= bits >> 29;
    for (int i = 0; i < TOKEN; i++)
        token[i] = "0123456789abcdef"[bits >> (4 * i) & 15];
    token[TOKEN] = 0;
}

size_t fio_marker_text(const fio_streamer *streamer, char *text, size_t capacity) {
    char token[TOKEN + 1];
    fio_text out = fio_text_in(text, capacity);
    token_of(streamer->next, token);
    fio_text_string(&out, streamer->echoes ? "M118 " : "M105");
    if (streamer->echoes)
        fio_text_string(&out, token);
    return out.length;
}

/* Of what has no ok; those take no time, so that after a silence none of their answers is to come.
 */
static bool only_markers(const fio_streamer *streamer) {
    for (int64_t n = streamer->answered + 1; n < streamer->cursor; n++)
        if (!streamer->lines[n & (FIO_HISTORY - 1)].marker)
            return false;
    return true;
}

void fio_marker_sent(fio_streamer *streamer) {
    streamer->marker = streamer->next - 1;
    streamer->marker_lines = 0;
    streamer->marker_time = streamer->now;
    streamer->marker_told = false;
    streamer->probe = false;
    streamer->marker_alone =
        only_markers(streamer) && streamer->now - streamer->pulse.answered >= ALONE_SECONDS;
}

static bool unsure(const fio_streamer *streamer) {
    return streamer->executed < streamer->next - 1;
}

/* When to send one although nothing asks for it; INFINITY: not before something else happens. */
double fio_marker_deadline(const fio_streamer *streamer) {
    bool wanted =
        streamer->state != FIO_STREAM_DONE && (streamer->probe || fio_queue_is_empty(streamer));
    if (streamer->plain || streamer->opened_file || streamer->handshaking || !wanted ||
        !(unsure(streamer) || streamer->probe) || streamer->cursor < streamer->next)
        return INFINITY;
    if (streamer->state == FIO_STREAM_GREETING && streamer->greeting < FIO_GREETING_NAME)
        return INFINITY;
    if (streamer->probe)
        return streamer->now;
    bool outstanding = streamer->marker > streamer->executed;
    if (outstanding && streamer->answered < streamer->marker)
        return INFINITY;
    if (outstanding)
        return streamer->marker_answered + RETRY_SECONDS;
    if (streamer->marker_lines == 0)
        return INFINITY;
    if (streamer->marker_lines >= FIO_MARKER_LINES_MOST)
        return streamer->now;
    return streamer->marker_time + (streamer->marker_lines >= FIO_MARKER_LINES
                                        ? FIO_MARKER_SECONDS_LEAST
                                        : FIO_MARKER_SECONDS);
}

bool fio_marker_due(const fio_streamer *streamer) {
    return fio_marker_deadline(streamer) <= streamer->now;
}

static void credit(fio_streamer *streamer, int64_t number) {
    fio_history_execute(streamer, number);
    fio_window_set(streamer, number - 1); /* its ok is still to come */
    streamer->echoes_missed = 0;
}

bool fio_marker_hear(fio_streamer *streamer, const fio_answer *answer) {
    char token[TOKEN + 1];
    size_t length = answer->length;
    while (length > 0 && answer->text[length - 1] == ' ') /* the encoder may put one there */
        length--;
    if (!streamer->echoes || length < TOKEN || length > TOKEN + 8)
        return false;
    const char *tail = answer->text + length - TOKEN;
    /* Not those that have to be sent again: a marker whose number was cut off when the firmware
     * threw away what it had received is executed out of its turn. */
    for (int64_t n = streamer->cursor - 1; n > streamer->executed; n--) {
        const fio_sent_line *line = fio_history_line(streamer, n);
        if (!line || !line->marker)
            continue;
        token_of(n, token);
        if (memcmp(token, tail, TOKEN) == 0) {
            streamer->echo_proved = true;
            credit(streamer, n);
            return true;
        }
    }
    return false;
}

/* RepRapFirmware passes over what is damaged without a word: a line without an ok may be one whose
 * answer was lost, or one that was never executed. */
static bool lost_unseen(fio_streamer *streamer, int64_t marker) {
    bool greeting =
        streamer->state == FIO_STREAM_GREETING && streamer->greeting != FIO_GREETING_RESTORE;
    if (greeting || !streamer->firmware.numbered)
        return false; /* what is asked there is asked again */
    for (int64_t n = streamer->executed + 1; n < marker && !streamer->ending; n++) {
        const fio_sent_line *line = fio_history_line(streamer, n);
        if (!line || line->marker)
            continue;
        fio_end(streamer, FIO_LINK_LOST, true,
                "a line got no answer, and this firmware does not tell whether it had it");
        return true;
    }
    return false;
}

/* The answer of an M105 may have been lost: this one counts for the first that has none, unless it
 * was asked for when nothing was left to come. */
static void credit_oldest(fio_streamer *streamer) {
    bool alone = streamer->marker_alone && streamer->marker > streamer->executed;
    for (int64_t n = alone ? streamer->marker : streamer->executed + 1; n < streamer->cursor; n++) {
        const fio_sent_line *line = fio_history_line(streamer, n);
        if (!line || !line->marker || !(line->time <= streamer->now))
            continue;
        if (!streamer->firmware.resends && n > streamer->answered && lost_unseen(streamer, n))
            return;
        fio_history_execute(streamer, n);
        if (n > streamer->answered)
            fio_window_set(streamer, n);
        return;
    }
}

/* An ok was counted: perhaps it is the marker's. */
void fio_marker_answered(fio_streamer *streamer, const fio_answer *answer) {
    if (streamer->plain || streamer->marker <= streamer->executed)
        return;
    if (!streamer->echoes && answer->has_temperatures) {
        const fio_sent_line *line = fio_history_line(streamer, streamer->answered);
        bool turn = line && line->marker && line->time <= streamer->now; /* by the count of oks */
        bool fresh = streamer->now - streamer->temperatures_told >= DOUBLE_SECONDS;
        if (fresh && (streamer->marker_alone || !turn))
            credit_oldest(streamer);
        else if (turn)
            fio_history_execute(streamer, line->number);
        else /* doubted: to be asked again, but not at once, which would be doubted too */
            streamer->marker_answered = streamer->now;
        streamer->temperatures_told = streamer->now;
        return;
    }
    if (streamer->answered < streamer->marker || streamer->marker_told)
        return;
    streamer->marker_told = true;
    streamer->marker_answered = streamer->now;
    if (streamer->echoes && ++streamer->echoes_missed >= ECHOES_MISSED_MOST &&
        !streamer->echo_proved)
        streamer->echoes = false; /* answered again and again, but never echoed: it can't */
}
