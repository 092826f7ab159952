/* Ways out: the job is printed, cancelled, stopped at once, or lost. On each of them heaters and
 * fan go off as long as the firmware listens, and that it did is known only by its answer. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "stream/state.h"

#define STOP_REPEAT 0.5 /* s after the first emergency stop, then twice as long each time */
#define STOP_REPEAT_MOST 8.0
enum {
    REPEATS_MOST = 4, /* of heaters off, while it tells of a target */
    RESETS_MOST = 60  /* of a board that starts again and again, once a second as a rule */
};
#define END_MOST 1800.0 /* s: heating to the end without an emergency parser */

static void done(fio_streamer *streamer, bool heaters_off) {
    streamer->report.status = streamer->end_status;
    streamer->report.heaters_off = heaters_off;
    fio_queue_clear(streamer);
    streamer->raw_length = 0;
    streamer->out_length = streamer->out_done = 0;
    if (!streamer->resume_saved)
        fio_history_resume(streamer, &streamer->report.resume);
    if (streamer->has_resume && !streamer->skipped)
        streamer->report.resume = streamer->from; /* nothing has become of it yet */
    fio_streamer_enter(streamer, FIO_STREAM_DONE);
}

static void say_why(fio_streamer *streamer, fio_status status, const char *format, va_list values) {
    char why[FIO_PROBLEM_MOST / 2];
    vsnprintf(why, sizeof why, format, values);
    const fio_stream_report *report = &streamer->report;
    if (streamer->has_source && streamer->job_sent > 0 && status != FIO_OK)
        snprintf(streamer->message, sizeof streamer->message,
                 "%s (after line %lld, byte %lld, layer %d of the job)", why,
                 (long long)report->line, (long long)report->offset, (int)report->layer);
    else
        snprintf(streamer->message, sizeof streamer->message, "%s", why);
    streamer->end_status = status;
    streamer->report.message = streamer->message;
}

void fio_end_now(fio_streamer *streamer, fio_status status, const char *format, ...) {
    va_list values;
    if (streamer->state == FIO_STREAM_DONE)
        return;
    if (!streamer->ending && !streamer->emergency) {
        va_start(values, format);
        say_why(streamer, status, format, values);
        va_end(values);
    }
    done(streamer, false);
}

static void queue_heaters_off(fio_streamer *streamer) {
    char command[48];
    fio_queue_text(streamer, streamer->firmware.heaters_off);
    for (int tool = 0; tool < streamer->firmware.tools && streamer->firmware.tools > 1; tool++) {
        fio_text text = fio_text_in(command, sizeof command);
        fio_text_string(&text, "M104 T");
        fio_text_integer(&text, tool);
        fio_text_string(&text, " S0");
        fio_queue_text(streamer, command);
    }
}

static void queue_lift(fio_streamer *streamer) {
    char command[48];
    fio_text text = fio_text_in(command, sizeof command);
    bool known = streamer->track.homed && streamer->options.lift > 0;
    if (streamer->end_status != FIO_CANCELLED || !known || streamer->state == FIO_STREAM_PAUSED)
        return;
    streamer->track.raised = streamer->options.lift;
    fio_text_string(&text, "G1 Z");
    fio_text_number(&text, streamer->options.lift, 3);
    fio_text_string(&text, " F600");
    fio_queue_text(streamer, "G21\nG91");
    fio_queue_text(streamer, command);
    fio_queue_text(streamer, "G90");
}

/* What it is at may take minutes; where the firmware can be told so, it stops waiting. */
static void break_waiting(fio_streamer *streamer) {
    if (!streamer->firmware.emergency_parser || streamer->plain)
        return;
    for (int64_t n = streamer->answered + 1; n < streamer->cursor; n++) {
        const fio_sent_line *line = fio_history_line(streamer, n);
        if (line && (line->traits & FIO_COMMAND_LONG) &&
            (line->traits & (FIO_COMMAND_HEATS | FIO_COMMAND_USER))) {
            fio_queue_raw(streamer, "M108\n", 5);
            return;
        }
    }
}

static void queue_end(fio_streamer *streamer, bool lift) {
    fio_queue_clear(streamer);
    if (streamer->opened_file)
        fio_queue_text(streamer, "M29");
    queue_heaters_off(streamer);
    if (lift)
        queue_lift(streamer);
    if (streamer->end_status == FIO_CANCELLED)
        fio_queue_text(streamer, streamer->options.on_cancel);
    if (streamer->firmware.kind != FIO_FIRMWARE_GRBL)
        fio_queue_text(streamer, "M105"); /* its answer tells the targets */
    fio_queue_await(streamer);
}

void fio_end(fio_streamer *streamer, fio_status status, bool renumber, const char *format, ...) {
    va_list values;
    if (streamer->state == FIO_STREAM_DONE || streamer->emergency)
        return;
    bool again = streamer->ending;
    /* A printer that says so with every answer would have it begin anew for ever. */
    if (again && !renumber && status == FIO_CANCELLED)
        return;
    if (again && renumber && ++streamer->end_resets > RESETS_MOST) {
        done(streamer, false);
        return;
    }
    if (!again) {
        va_start(values, format);
        say_why(streamer, status, format, values);
        va_end(values);
    }
    if (streamer->state == FIO_STREAM_GREETING && streamer->greeting < FIO_GREETING_NAME) {
        if (!streamer->has_resume || streamer->pulse.heard <= streamer->started) {
            done(streamer, false); /* nothing was begun, or nobody is there */
            return;
        }
        renumber = true;
    }
    if (renumber) {
        streamer->renumbered = true;
        if (!streamer->resume_saved)
            fio_history_resume(streamer, &streamer->report.resume);
        streamer->resume_saved = true;
        streamer->opened_file = false;
        streamer->attempts = 0;
    }
    streamer->ending = true;
    streamer->finishing = false;
    streamer->has_pending = false;
    if (renumber)
        fio_queue_clear(streamer);
    else
        queue_end(streamer, !again);
    if (!again) {
        break_waiting(streamer);
        streamer->end_started = streamer->now;
        fio_streamer_enter(streamer, FIO_STREAM_CANCELLING);
    }
    streamer->opened_file = false;
    if (renumber)
        fio_handshake_number(streamer);
}

void fio_end_again(fio_streamer *streamer) {
    queue_end(streamer, false);
}

void fio_streamer_cancel(fio_streamer *streamer, double now) {
    streamer->now = now;
    if (streamer->state == FIO_STREAM_FINISHING && streamer->source_ended &&
        streamer->executed >= streamer->await && streamer->await >= 0)
        return;
    fio_end(streamer, FIO_CANCELLED, false, "cancelled");
}

/* The job has been sent, or the console is to be left. */
void fio_end_finish(fio_streamer *streamer) {
    streamer->finishing = true;
    fio_streamer_enter(streamer, FIO_STREAM_FINISHING);
    if (streamer->opened_file) {
        fio_queue_text(streamer, "M29");
    } else if (streamer->has_source) {
        fio_queue_text(streamer, streamer->firmware.kind == FIO_FIRMWARE_GRBL ? "G4 P0" : "M400");
        if (streamer->options.finish_heaters_off)
            queue_heaters_off(streamer);
    }
    fio_queue_await(streamer);
}

void fio_streamer_finish(fio_streamer *streamer, double now) {
    streamer->now = now;
    if (streamer->has_source || streamer->ending || streamer->finishing ||
        streamer->state == FIO_STREAM_DONE)
        return;
    if (streamer->state == FIO_STREAM_GREETING) {
        fio_end_now(streamer, FIO_CANCELLED, "left before the printer had answered");
        return;
    }
    fio_end_finish(streamer);
}

void fio_end_step(fio_streamer *streamer) {
    const fio_stream_report *report = &streamer->report;
    bool hot = streamer->pulse.reported > streamer->end_started &&
               (report->nozzle_target > 0 || report->bed_target > 0);
    if (streamer->ending && hot && streamer->end_repeats++ < REPEATS_MOST) {
        queue_end(streamer, false);
        return;
    }
    if (streamer->ending) {
        done(streamer, !hot);
        return;
    }
    streamer->end_status = FIO_OK;
    done(streamer, streamer->options.finish_heaters_off);
}

void fio_streamer_emergency(fio_streamer *streamer, double now) {
    streamer->now = now;
    if (streamer->state == FIO_STREAM_DONE)
        return;
    if (!streamer->emergency) {
        streamer->ending = false;
        snprintf(streamer->message, sizeof streamer->message,
                 "emergency stop: the printer has to be switched off and on, or reset");
        streamer->end_status = FIO_CANCELLED;
        streamer->report.message = streamer->message;
        streamer->finishing = false;
        streamer->emergency = true;
        fio_queue_clear(streamer);
        fio_streamer_enter(streamer, FIO_STREAM_CANCELLING);
    }
    streamer->discard = true;
    streamer->out_length = streamer->out_done = 0;
    streamer->out_number = -1;
    streamer->raw_length = 0;
    streamer->emergency_time =
        now + fmin(STOP_REPEAT * (double)(1 << streamer->emergencies), STOP_REPEAT_MOST);
    if (streamer->emergencies++ == 0)
        streamer->end_started = now;
    if (streamer->emergencies > 8)
        streamer->emergencies = 8;
    const char *stop = streamer->firmware.stop ? streamer->firmware.stop : "\nM112\n";
    fio_queue_raw(streamer, stop, strlen(stop));
}

void fio_end_halted(fio_streamer *streamer, const fio_answer *answer) {
    if (streamer->state == FIO_STREAM_DONE)
        return;
    if (!streamer->emergency && !streamer->ending) {
        char text[160];
        snprintf(text, sizeof text, "%.*s", (int)answer->length, answer->text);
        streamer->ending = true;
        snprintf(streamer->message, sizeof streamer->message,
                 "the printer halted: %s (after line %lld, byte %lld, layer %d of the job); it has "
                 "to be reset",
                 text, (long long)streamer->report.line, (long long)streamer->report.offset,
                 (int)streamer->report.layer);
        streamer->report.message = streamer->message;
        streamer->end_status = FIO_FAULTY;
    }
    streamer->renumbered = true;
    done(streamer, true); /* a halted firmware has switched them off */
}

static double end_at(const fio_streamer *streamer) {
    const fio_pulse *pulse = &streamer->pulse;
    double start = streamer->end_started;
    if (streamer->end_silent && pulse->heard <= start)
        return start + FIO_END_SECONDS;
    double until = fmin(fmax(start, pulse->heard) + fio_pulse_silence(streamer),
                        fmax(start, pulse->answered) + fio_pulse_patience(streamer));
    return fmin(until, start + END_MOST);
}

void fio_end_tick(fio_streamer *streamer) {
    if (streamer->state == FIO_STREAM_DONE)
        return;
    if (streamer->emergency && streamer->now >= end_at(streamer)) {
        snprintf(streamer->message, sizeof streamer->message,
                 "emergency stop: the printer did not confirm it; switch it off");
        done(streamer, false);
        return;
    }
    if (streamer->emergency && streamer->now >= streamer->emergency_time) {
        fio_streamer_emergency(streamer, streamer->now);
        return;
    }
    if (streamer->ending && streamer->now >= end_at(streamer)) {
        size_t length = strlen(streamer->message);
        snprintf(streamer->message + length, sizeof streamer->message - length,
                 "; it did not confirm that its heaters are off");
        done(streamer, false);
    }
}

double fio_end_deadline(const fio_streamer *streamer) {
    if (streamer->emergency)
        return fmin(streamer->emergency_time, end_at(streamer));
    return streamer->ending ? end_at(streamer) : INFINITY;
}

void fio_streamer_lost(fio_streamer *streamer, double now, fio_status status, const char *message) {
    streamer->now = now;
    char copy[FIO_PROBLEM_MOST / 2];
    snprintf(copy, sizeof copy, "%s", message ? message : "the link is gone");
    if (streamer->ending && streamer->state != FIO_STREAM_DONE) {
        size_t length = strlen(streamer->message);
        snprintf(streamer->message + length, sizeof streamer->message - length, "; then %s", copy);
    }
    fio_end_now(streamer, status, "%s", copy);
}
