/* How much may be under way at once, and the oks that say how much is. */
#include <math.h>

#include "stream/state.h"

/* After so many stalls in sequence what seems to be in the firmware's way was surely lost: at once
 * if it is nothing that takes time, late if it may take long. */
enum { STALLS_MANY = 1, STALLS_MOVING = 2, STALLS_LONG = 9 };

#define EXTRA_SECONDS 0.02

enum { BYTES_LEAST = 63 };     /* that the smallest receive buffers hold */
enum { UNNUMBERED_LEAST = 4 }; /* oks in sequence without numbers, where others have them */
enum { UNSURE_OKS = 2 };       /* the last ones, which may be of lines that wait or were lost */

static int64_t end_of(const fio_streamer *streamer, int64_t number) {
    const fio_sent_line *line = &streamer->lines[number & (FIO_HISTORY - 1)];
    return line->number == number ? line->end : streamer->answered_end;
}

int64_t fio_window_lines(const fio_streamer *streamer) {
    return streamer->cursor - 1 - streamer->answered;
}

/* Of what is surely in the firmware's queue nothing is in its receive buffer, answered or not. */
static int64_t first_in_buffer(const fio_streamer *streamer) {
    return 1 + (streamer->accepted > streamer->answered ? streamer->accepted : streamer->answered);
}

int64_t fio_window_bytes(const fio_streamer *streamer) {
    int64_t first = first_in_buffer(streamer);
    if (streamer->cursor <= first)
        return 0;
    return end_of(streamer, streamer->cursor - 1) - end_of(streamer, first - 1);
}

/* When nothing comes any more the firmware is at the first line that takes time: that one has left
 * the receive buffer, as have those before it, whose oks were lost. A probe may take their place.
 */
static int64_t bytes_behind_work(const fio_streamer *streamer) {
    const unsigned takes_time = FIO_COMMAND_LONG | FIO_COMMAND_USER | FIO_COMMAND_MOVES;
    int64_t first = first_in_buffer(streamer);
    if (streamer->cursor <= first || first > streamer->answered + 1)
        return fio_window_bytes(streamer);
    while (first < streamer->cursor - 1 &&
           !(streamer->lines[first & (FIO_HISTORY - 1)].traits & takes_time))
        first++;
    return end_of(streamer, streamer->cursor - 1) - end_of(streamer, first);
}

static int stalls_enough(const fio_streamer *streamer) {
    unsigned traits = 0;
    for (int64_t n = streamer->answered + 1; n < streamer->cursor; n++)
        traits |= streamer->lines[n & (FIO_HISTORY - 1)].traits;
    return traits & (FIO_COMMAND_LONG | FIO_COMMAND_USER) ? STALLS_LONG
           : traits & FIO_COMMAND_MOVES                   ? STALLS_MOVING
                                                          : STALLS_MANY;
}

bool fio_window_open(const fio_streamer *streamer, size_t length) {
    const fio_stream_options *options = &streamer->options;
    int64_t lines = fio_window_lines(streamer);
    if (lines <= 0)
        return true;
    bool told = options->window_lines > 0 || options->window_bytes > 0;
    int64_t most_bytes = options->window_bytes > 0 ? options->window_bytes
                         : told                    ? INT64_MAX / 2
                                                   : streamer->firmware.receive_bytes;
    int64_t most_lines = options->window_lines > 0 ? options->window_lines
                         : told                    ? INT64_MAX / 2
                                                   : streamer->firmware.command_slots;
    if (!told && most_bytes <= 0)
        most_lines = 1;
    else if (!told && streamer->firmware.kind == FIO_FIRMWARE_GRBL)
        most_lines = INT64_MAX / 2; /* it counts characters alone */
    if (streamer->cursor < streamer->recovery.careful && most_lines > 1)
        most_lines = 1;
    if (streamer->recovery.allow_one) {
        int64_t behind = bytes_behind_work(streamer);
        bool fits = behind + (int64_t)length <= (most_bytes > 0 ? most_bytes : BYTES_LEAST);
        return fits || (behind == 0 && most_bytes <= 0) ||
               streamer->recovery.stalls > stalls_enough(streamer);
    }
    return lines < most_lines && fio_window_bytes(streamer) + (int64_t)length <= most_bytes;
}

/* The shortest trips of 32 tell the link's own delay, whatever the firmware was busy with. */
static void measure_trip(fio_streamer *streamer, const fio_sent_line *line) {
    fio_pulse *pulse = &streamer->pulse;
    if (!line || !(line->time <= streamer->now))
        return;
    double trip = streamer->now - line->time;
    if (pulse->samples == 0 || trip < pulse->shortest)
        pulse->shortest = trip;
    if (pulse->trip == 0 || trip < pulse->trip)
        pulse->trip = trip;
    if (++pulse->samples >= 32) {
        pulse->trip = pulse->shortest;
        pulse->samples = 0;
    }
}

void fio_window_set(fio_streamer *streamer, int64_t answered) {
    if (answered >= streamer->cursor)
        answered = streamer->cursor - 1;
    if (answered == streamer->answered)
        return;
    streamer->answered_end = end_of(streamer, answered);
    streamer->answered = answered;
}

/* Repetier says ok when a line has a place in its queue: so many before it may still be there. */
static int64_t early_oks(const fio_streamer *streamer) {
    const fio_firmware *firmware = &streamer->firmware;
    return firmware->kind == FIO_FIRMWARE_REPETIER ? firmware->usual_command_slots : 0;
}

/* Repetier built so that its oks have no numbers, and firmwares that tell temperatures on lines of
 * their own, say nothing else that could be believed; a line whose number was lost is asked for at
 * the next one. */
static void believe_oks(fio_streamer *streamer) {
    bool repetier = streamer->firmware.kind == FIO_FIRMWARE_REPETIER;
    bool mute = streamer->firmware.kind == FIO_FIRMWARE_UNKNOWN && !streamer->echoes &&
                streamer->temperatures_told == 0;
    if (!streamer->plain && (repetier || mute) &&
        streamer->answered > streamer->claimed + UNNUMBERED_LEAST)
        fio_history_execute(streamer, streamer->answered - UNSURE_OKS);
}

/* An ok that names its line: believed if it agrees with the count, or with the one before it, since
 * a bit of the number may be wrong. */
static void take_numbered(fio_streamer *streamer, int64_t number) {
    if (number <= streamer->answered || number >= streamer->cursor)
        return;
    bool agrees = number == streamer->answered + 1 || number == streamer->claimed + 1;
    streamer->claimed = number;
    if (agrees)
        fio_history_accept(streamer, number);
    if (agrees)
        fio_history_execute(streamer, number - early_oks(streamer));
    if (number > streamer->answered)
        fio_window_set(streamer, number);
}

/* After a stall, an ok right behind the line that was sent all the same is that line's: those
 * before it were lost, else there would have been a Resend. Believed only while lines are sent
 * again, when no marker can tell. */
static bool answers_extra(fio_streamer *streamer) {
    const fio_sent_line *line = fio_history_line(streamer, streamer->recovery.extra);
    double most = 4 * streamer->pulse.trip + EXTRA_SECONDS;
    streamer->recovery.extra = -1;
    return line && line->number > streamer->answered && streamer->now - line->time <= most &&
           streamer->cursor < streamer->next;
}

void fio_window_answer(fio_streamer *streamer, const fio_answer *answer) {
    fio_recovery_progress(streamer);
    if (!streamer->plain && answer->line >= 0) {
        measure_trip(streamer, fio_history_line(streamer, answer->line));
        take_numbered(streamer, answer->line);
        fio_marker_answered(streamer, answer);
        return;
    }
    if (streamer->answered + 1 < streamer->cursor) {
        int64_t extra = streamer->recovery.extra;
        int64_t number = answers_extra(streamer) ? extra : streamer->answered + 1;
        measure_trip(streamer, fio_history_line(streamer, number));
        fio_window_set(streamer, number);
    }
    fio_marker_answered(streamer, answer);
    if (streamer->plain)
        fio_history_execute(streamer, streamer->answered);
    believe_oks(streamer);
}
