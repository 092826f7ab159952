/* Whether the firmware lives, and how warm it is. */
#include <math.h>

#include "stream/state.h"

#define BEATS_MISSED 3.0 /* heartbeats that may be lost or late */
#define BEAT_SLACK 1.5   /* s */
enum { POLL_BYTES = 24, STALLS_LEAST = 3 };
#define NO_BUSY_SECONDS 60.0 /* reports come, but nothing is executed and nothing is busy */

void fio_pulse_hear(fio_streamer *streamer, const fio_answer *answer) {
    fio_pulse *pulse = &streamer->pulse;
    fio_stream_report *report = &streamer->report;
    if (answer->kind == FIO_ANSWER_BUSY) {
        pulse->busy = streamer->now;
        pulse->busy_seen = true;
    }
    if (answer->kind == FIO_ANSWER_TEMPERATURES && streamer->firmware.auto_temperatures)
        pulse->reports_seen = true;
    if (!answer->has_temperatures)
        return;
    pulse->reported = streamer->now;
    int tool = streamer->track.tool;
    bool known = tool >= 0 && tool < FIO_ANSWER_TOOLS && (answer->nozzles >> tool & 1);
    if (!known)
        tool = 0;
    if (answer->nozzles >> tool & 1) {
        report->has_temperatures = true;
        report->nozzle = answer->nozzle[tool];
        if (answer->nozzle_target[tool] >= 0)
            report->nozzle_target = answer->nozzle_target[tool];
    }
    if (answer->has_bed) {
        report->has_bed = true;
        report->bed = answer->bed;
        if (answer->bed_target >= 0)
            report->bed_target = answer->bed_target;
    }
}

static double report_period(const fio_streamer *streamer) {
    return streamer->options.report_seconds > 0 ? streamer->options.report_seconds : 2;
}

/* The traits of all lines that the firmware may be at. */
static unsigned traits_under_way(const fio_streamer *streamer) {
    unsigned traits = 0;
    for (int64_t n = streamer->answered + 1; n < streamer->cursor; n++)
        traits |= streamer->lines[n & (FIO_HISTORY - 1)].traits;
    return traits;
}

static bool is_due(const fio_streamer *streamer) {
    return fio_window_lines(streamer) > 0 || fio_recovery_holds(streamer) ||
           streamer->handshaking || streamer->executed < streamer->next - 1;
}

double fio_pulse_patience(const fio_streamer *streamer) {
    unsigned traits = traits_under_way(streamer);
    return traits & FIO_COMMAND_USER   ? FIO_USER_SECONDS
           : traits & FIO_COMMAND_LONG ? FIO_LONG_SECONDS
                                       : FIO_PLAIN_SECONDS;
}

/* How long it may say nothing at all while an answer is due. */
double fio_pulse_silence(const fio_streamer *streamer) {
    const fio_pulse *pulse = &streamer->pulse;
    double beat = INFINITY, busy = streamer->firmware.busy_seconds;
    if (streamer->options.silence_seconds > 0)
        return streamer->options.silence_seconds;
    if (pulse->busy_seen)
        beat = busy > 0 ? busy : 2;
    if (pulse->reports_seen)
        beat = fmin(beat, report_period(streamer));
    return isfinite(beat) ? BEATS_MISSED * beat + BEAT_SLACK : fio_pulse_patience(streamer);
}

static bool is_watched(const fio_streamer *streamer) {
    bool greeting =
        streamer->state == FIO_STREAM_GREETING && streamer->greeting != FIO_GREETING_RESTORE;
    return !greeting && streamer->state != FIO_STREAM_DONE && !streamer->ending &&
           !streamer->emergency;
}

static double silent_at(const fio_streamer *streamer) {
    if (!is_watched(streamer) || !is_due(streamer))
        return INFINITY;
    double owed = fio_window_lines(streamer) > 0
                      ? streamer->lines[(streamer->answered + 1) & (FIO_HISTORY - 1)].time
                      : streamer->pulse.heard;
    if (!isfinite(owed))
        owed = streamer->pulse.heard; /* not even written: the link holds us back */
    if (fio_window_lines(streamer) > 0 && streamer->recovery.stalls < STALLS_LEAST &&
        isfinite(fio_recovery_deadline(streamer)))
        return INFINITY; /* what was asked may have been lost: it is asked again first */
    return fmax(streamer->pulse.heard, owed) + fio_pulse_silence(streamer);
}

/* It talks, but works at nothing: what we send does not arrive. */
static double idle_at(const fio_streamer *streamer) {
    if (!is_watched(streamer) || fio_window_lines(streamer) <= 0)
        return INFINITY;
    double last = fmax(streamer->pulse.busy, streamer->pulse.answered);
    double sent = streamer->lines[(streamer->answered + 1) & (FIO_HISTORY - 1)].time;
    if (isfinite(sent))
        last = fmax(last, sent); /* before that it had nothing to answer */
    return last + (streamer->pulse.busy_seen ? NO_BUSY_SECONDS : fio_pulse_patience(streamer));
}

/* Temperatures are asked for where they don't come by themselves, and when it has been quiet for so
 * long that one can't know whether anybody is there. */
static double poll_at(const fio_streamer *streamer) {
    const fio_pulse *pulse = &streamer->pulse;
    bool may = streamer->state == FIO_STREAM_RUNNING || streamer->state == FIO_STREAM_PAUSED;
    if (!may || streamer->opened_file || streamer->firmware.kind == FIO_FIRMWARE_GRBL ||
        !fio_queue_is_empty(streamer) || streamer->run_count >= FIO_STREAM_RUNS / 2)
        return INFINITY;
    if (!fio_window_open(streamer, POLL_BYTES))
        return INFINITY; /* while it is at something long: it would answer all of them at its end */
    if (!streamer->plain && !streamer->echoes && streamer->marker > streamer->executed)
        return INFINITY; /* the marker under way tells them, too */
    double period = report_period(streamer);
    double due = fmax(pulse->poll, pulse->reported) + (pulse->reports_seen ? 2 * period : period);
    return due;
}

double fio_pulse_deadline(const fio_streamer *streamer) {
    return fmin(poll_at(streamer), fmin(silent_at(streamer), idle_at(streamer)));
}

void fio_pulse_tick(fio_streamer *streamer) {
    if (poll_at(streamer) <= streamer->now) {
        streamer->pulse.poll = streamer->now;
        fio_queue_command(streamer, "M105", 4);
    }
    if (silent_at(streamer) <= streamer->now) {
        streamer->end_silent = true;
        fio_end(streamer, FIO_LINK_LOST, false,
                "the printer has been silent for %.0f s where an answer was due",
                streamer->now - streamer->pulse.heard);
    } else if (idle_at(streamer) <= streamer->now)
        fio_end(streamer, FIO_LINK_LOST, false,
                "the printer has not answered for %.0f s, though it still talks: what is sent does "
                "not arrive",
                streamer->now - streamer->pulse.answered);
}
