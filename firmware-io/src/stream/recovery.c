/* Lines asked for again, answers that don't come, numbers that can't be.
 *
 * Behind a damaged line there are others under way: the firmware throws them away or asks for the
 * same line again for each of them. To send at once what it asks for is what makes storms; so the
 * answers to what is under way are waited for, by their count if they all come, else for as long as
 * the link takes, twice as long each time that was too short.
 *
 * An overdue ok is never a reason to send the same line again: if it had arrived it might be
 * executed twice by a firmware that does not know doubles. The next line is sent instead, whatever
 * its place in the window: if all arrived it is answered, else a Resend says what is missing. */
#include <math.h>

#include "stream/state.h"

#define QUIET_SLACK 0.005 /* s: of a firmware to read and refuse what has arrived */
#define QUIET_MOST 2.0
#define QUIET_UNKNOWN 0.05 /* before any trip was measured */
#define TOLD_SECONDS 0.1
#define AGREE_SECONDS 0.5 /* an error and the Resend that goes with it */
#define DOUBT_SECONDS 0.7
#define BEAT_LATE 1.1
enum { DOUBTS_MOST = 8, DOUBTS_SURE = 3, REPEATS_MOST = 100 };

static double wire_seconds(const fio_streamer *streamer, int64_t bytes) {
    return streamer->options.rate > 0 ? (double)bytes * 10 / (double)streamer->options.rate : 0;
}

/* While long moves go through a full planner oks come as slowly as those are made. */
void fio_recovery_progress(fio_streamer *streamer) {
    fio_recovery *recovery = &streamer->recovery;
    double pace = 2 * streamer->pulse.pace;
    recovery->progress = streamer->now;
    recovery->stall = fmin(fmax(pace, FIO_STALL_SECONDS), FIO_STALL_PACED);
    recovery->stalls = 0;
}

bool fio_recovery_holds(const fio_streamer *streamer) {
    return streamer->recovery.waiting || streamer->recovery.doubts > 0;
}

/* A line that nobody can have: whatever the firmware counts, it says which one it had last, and
 * executes nothing. */
void fio_recovery_provoke(fio_streamer *streamer) {
    char wire[FIO_WIRE_LINE_MOST + 1];
    int64_t number = FIO_FAR_NUMBER;
    if (streamer->firmware.kind == FIO_FIRMWARE_REPETIER) /* it looks at 16 bits alone */
        number += (streamer->next + 32768 - FIO_FAR_NUMBER) & 0xffff;
    size_t length = fio_encode_line(wire, number, "M105", 4, FIO_WIRE_LINE_MOST);
    fio_queue_raw(streamer, wire, length);
}

static void doubt(fio_streamer *streamer, int64_t number, bool agreed) {
    fio_recovery *recovery = &streamer->recovery;
    recovery->doubts = recovery->doubts > 0 && number == recovery->doubtful
                           ? recovery->doubts + 1 + agreed
                           : 1 + agreed;
    recovery->doubtful = number;
    recovery->doubt_time = streamer->now;
    if (recovery->doubts > DOUBTS_SURE) {
        recovery->doubts = 0;
        fio_end(streamer, FIO_LINK_LOST, true,
                "the printer asks for line %lld, where it had line %lld already: it was reset, or "
                "another program talks to it",
                (long long)number, (long long)streamer->accepted);
        return;
    }
    fio_recovery_provoke(streamer);
}

static void wait_for_answers(fio_streamer *streamer, int64_t bytes) {
    fio_recovery *recovery = &streamer->recovery;
    double trip = streamer->pulse.trip > 0 ? 1.25 * streamer->pulse.trip : QUIET_UNKNOWN;
    double quiet =
        (trip + QUIET_SLACK) * (double)(1 << (recovery->repeats < 6 ? recovery->repeats : 6));
    recovery->quiet = fmin(quiet, QUIET_MOST) + wire_seconds(streamer, bytes);
    recovery->until = streamer->now + recovery->quiet;
    recovery->waiting = true;
}

static void rewind_to(fio_streamer *streamer, int64_t number) {
    fio_recovery *recovery = &streamer->recovery;
    int64_t behind = streamer->cursor - number;
    if (behind <= 0) { /* not sent yet: nothing is missing, or what it has is ahead of us */
        if (number > streamer->cursor && number <= streamer->accepted + 1)
            streamer->cursor = number;
        return;
    }
    if (number <= streamer->answered)
        fio_window_set(streamer, number - 1);
    int64_t bytes = fio_window_bytes(streamer);
    recovery->repeats = number == recovery->line ? recovery->repeats + 1 : 0;
    if (recovery->repeats >= REPEATS_MOST && !streamer->ending) {
        fio_end(streamer, FIO_LINK_LOST, true,
                "the printer asks for line %lld again and again, however often it is sent: is the "
                "cable good?",
                (long long)number);
        return;
    }
    recovery->line = number;
    recovery->left = (int)behind - 1;
    recovery->extra = -1;
    recovery->careful = streamer->next + FIO_CAREFUL_LINES;
    streamer->cursor = number;
    wait_for_answers(streamer, bytes);
}

void fio_recovery_resend(fio_streamer *streamer, int64_t number) {
    fio_recovery *recovery = &streamer->recovery;
    bool agreed = recovery->last_line >= 0 && recovery->last_line + 1 == number &&
                  streamer->now - recovery->last_time < AGREE_SECONDS;
    /* Who tells no last line is believed when asking twice brings the same number. */
    bool terse = streamer->firmware.kind == FIO_FIRMWARE_SMOOTHIE ||
                 streamer->firmware.kind == FIO_FIRMWARE_REPETIER;
    agreed = agreed || (terse && recovery->last_line < 0 && number == recovery->told);
    recovery->told = number;
    recovery->last_line = -1;
    streamer->report.resends++;
    fio_streamer_say(streamer, FIO_STREAM_RESEND, NULL, number);
    if (fio_handshake_resend(streamer, number))
        return;
    recovery->oks = 1;
    recovery->progress = streamer->now;
    if (number <= streamer->accepted || number > streamer->next) {
        doubt(streamer, number, agreed);
        return;
    }
    recovery->doubts = 0;
    recovery->stalls = 0;
    recovery->stall = FIO_STALL_SECONDS;
    if (agreed)
        fio_history_accept(streamer, number - 1);
    if (recovery->waiting && number == recovery->line) {
        recovery->until = fmax(recovery->until, streamer->now + recovery->quiet);
        recovery->left--;
        return;
    }
    rewind_to(streamer, number);
}

bool fio_recovery_take_ok(fio_streamer *streamer) {
    fio_recovery *recovery = &streamer->recovery;
    if (recovery->oks == 0)
        return false;
    recovery->oks = 0;
    if (recovery->waiting && recovery->left <= 0)
        recovery->waiting = false;
    return true;
}

/* Since when the firmware owes an answer to a line; INFINITY: it owes none. */
static double owed_since(const fio_streamer *streamer) {
    const fio_recovery *recovery = &streamer->recovery;
    if (streamer->plain && streamer->handshaking)
        return INFINITY;
    if (fio_window_lines(streamer) <= 0 || fio_recovery_holds(streamer) ||
        streamer->out_done < streamer->out_length || streamer->raw_length > 0)
        return INFINITY;
    const fio_sent_line *line = &streamer->lines[(streamer->answered + 1) & (FIO_HISTORY - 1)];
    double since = fmax(line->time, recovery->progress);
    if (streamer->pulse.busy <= fmax(line->time, streamer->pulse.answered) || !isfinite(line->time))
        return since;
    double beat = streamer->firmware.busy_seconds > 0 ? streamer->firmware.busy_seconds : 2;
    return fmax(since,
                streamer->pulse.busy + BEAT_LATE * beat); /* it will say so again, or answer */
}

/* When an error that named the last line has waited long enough for its Resend, which was damaged;
 * INFINITY: there is none. */
static double told_at(const fio_streamer *streamer) {
    const fio_recovery *recovery = &streamer->recovery;
    bool waits = recovery->last_line >= 0 && !streamer->handshaking && !streamer->plain &&
                 streamer->state != FIO_STREAM_GREETING && streamer->state != FIO_STREAM_DONE;
    return waits ? recovery->last_time + TOLD_SECONDS : INFINITY;
}

double fio_recovery_deadline(const fio_streamer *streamer) {
    const fio_recovery *recovery = &streamer->recovery;
    if (isfinite(told_at(streamer)))
        return told_at(streamer);
    if (recovery->waiting)
        return recovery->until;
    if (recovery->doubts > 0)
        return recovery->doubt_time + DOUBT_SECONDS;
    return owed_since(streamer) + recovery->stall;
}

static void stalled(fio_streamer *streamer) {
    fio_recovery *recovery = &streamer->recovery;
    recovery->stalls++;
    recovery->progress = streamer->now;
    bool is_long = fio_pulse_patience(streamer) > FIO_PLAIN_SECONDS && !streamer->pulse.busy_seen;
    recovery->stall = fmin(2 * recovery->stall, is_long ? FIO_STALL_RARE : FIO_STALL_MOST);
    if (is_long)
        recovery->stall = fmax(recovery->stall, FIO_STALL_LONG);
    streamer->report.lost_answers++;
    if (streamer->plain) {
        fio_queue_raw(streamer, streamer->firmware.kind == FIO_FIRMWARE_GRBL ? "?" : "M105\n",
                      streamer->firmware.kind == FIO_FIRMWARE_GRBL ? 1 : 5);
        return;
    }
    /* What an echo proved to be executed owes nothing: its ok was lost, or came before the echo. */
    if (!streamer->handshaking && streamer->executed + 1 >= streamer->cursor) {
        fio_window_set(streamer, streamer->cursor - 1);
        return;
    }
    recovery->allow_one = true;
    if (streamer->cursor < streamer->next)
        return;
    if (streamer->opened_file || streamer->run_count == FIO_STREAM_RUNS) {
        recovery->allow_one = false;
        fio_recovery_provoke(streamer);
    } else {
        streamer->probe = true;
    }
}

void fio_recovery_tick(fio_streamer *streamer) {
    fio_recovery *recovery = &streamer->recovery;
    if (told_at(streamer) <= streamer->now) {
        int64_t wanted = recovery->last_line + 1;
        recovery->last_line = -1;
        fio_recovery_resend(streamer, wanted);
        recovery->oks = 0; /* that one has come */
    }
    if (recovery->waiting && streamer->now >= recovery->until) {
        recovery->waiting = false;
        recovery->oks = 0;
        recovery->progress = streamer->now;
    }
    if (recovery->doubts > 0 && streamer->now >= recovery->doubt_time + DOUBT_SECONDS) {
        recovery->doubt_time = streamer->now;
        if (++recovery->stalls > DOUBTS_MOST) {
            recovery->doubts = 0;
            fio_end(streamer, FIO_LINK_LOST, true,
                    "the printer asked for line %lld, which can't be, and does not say which line "
                    "it had last",
                    (long long)recovery->doubtful);
            return;
        }
        fio_recovery_provoke(streamer);
    }
    if (streamer->state != FIO_STREAM_DONE &&
        owed_since(streamer) + recovery->stall <= streamer->now)
        stalled(streamer);
}
