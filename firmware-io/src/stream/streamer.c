/* Making a streamer, passing time and bytes through it, asking it for what it knows. */
#include "stream/streamer.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "stream/state.h"

#define DAMAGED_SECONDS 0.2 /* an answer was unreadable: it may be asked for so soon */
enum { DAMAGED_MOST = 6, DWELLS_MOST = 8 };

fio_stream_options fio_stream_options_defaults(void) {
    return (fio_stream_options){.rate = 115200, .report_seconds = 2, .lift = 2, .retract = 2};
}

static fio_status check_options(const fio_stream_options *options, bool has_source,
                                bool has_resume) {
    if (options->upload && (!has_source || has_resume))
        return fio_fail(FIO_USAGE, "an upload needs a job, and begins at its beginning");
    if (options->window_lines < 0 || options->window_lines > FIO_HISTORY / 4 ||
        options->window_bytes < 0)
        return fio_fail(FIO_USAGE, "a window is 1 to %d lines", FIO_HISTORY / 4);
    if (!(options->lift >= 0 && options->lift <= 100) ||
        !(options->retract >= 0 && options->retract <= 100))
        return fio_fail(FIO_USAGE, "lift and retraction are 0 to 100 mm");
    return FIO_OK;
}

fio_status fio_streamer_create(fio_streamer **streamer, const fio_stream_options *options,
                               const fio_stream_source *source, const fio_stream_resume *resume,
                               const fio_stream_listener *listener) {
    fio_stream_options defaults = fio_stream_options_defaults();
    *streamer = NULL;
    if (!options)
        options = &defaults;
    fio_status status = check_options(options, source, resume);
    if (status != FIO_OK)
        return status;
    fio_streamer *made = fio_allocate(sizeof *made);
    if (!made)
        return fio_fail(FIO_NO_MEMORY, "no memory for a streamer (%zu bytes)", sizeof *made);
    made->options = *options;
    if (source)
        made->source = *source;
    made->has_source = source;
    if (resume)
        made->from = *resume;
    made->has_resume = resume && source;
    if (listener)
        made->listener = *listener;
    made->firmware =
        options->firmware ? *options->firmware : *fio_firmware_of(FIO_FIRMWARE_UNKNOWN);
    fio_answer_parser_reset(&made->parser);
    fio_track_reset(&made->track);
    made->track_made = made->track;
    made->report.percent = made->report.minutes_left = -1;
    made->report.message = made->message;
    made->out_number = made->told_last = made->await = -1;
    made->recovery.last_line = made->recovery.line = -1;
    made->recovery.stall = FIO_STALL_SECONDS;
    made->echoes = options->firmware && (options->firmware->kind == FIO_FIRMWARE_MARLIN ||
                                         options->firmware->kind == FIO_FIRMWARE_PRUSA);
    fio_history_restart(made, 0);
    *streamer = made;
    return FIO_OK;
}

void fio_streamer_free(fio_streamer *streamer) {
    fio_release(streamer);
}

void fio_streamer_say(fio_streamer *streamer, fio_stream_event_kind kind, const char *text,
                      int64_t number) {
    if (!streamer->listener.event)
        return;
    fio_stream_event event = {.kind = kind,
                              .time = streamer->now,
                              .state = streamer->state,
                              .firmware = &streamer->firmware,
                              .text = text,
                              .length = text ? strlen(text) : 0,
                              .number = number};
    streamer->listener.event(streamer->listener.context, &event);
}

void fio_streamer_warn(fio_streamer *streamer, const char *format, ...) {
    char text[FIO_PROBLEM_MOST];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    fio_streamer_say(streamer, FIO_STREAM_WARNING, text, -1);
}

void fio_streamer_enter(fio_streamer *streamer, fio_stream_state state) {
    bool same = streamer->state == state && streamer->begun;
    streamer->state = streamer->report.state = state;
    if (!same)
        fio_streamer_say(streamer, FIO_STREAM_STATE, NULL, -1);
}

static void pass_time(fio_streamer *streamer, double now) {
    if (streamer->begun || streamer->state == FIO_STREAM_DONE) {
        if (now > streamer->now)
            streamer->now = now;
        return;
    }
    streamer->now = streamer->started = now;
    streamer->pulse = (fio_pulse){.heard = now, .answered = now, .busy = now, .reported = now};
    streamer->recovery.progress = now;
    fio_handshake_begin(streamer);
    streamer->begun = true;
}

/* What was waited for has been executed: on with the next step of whatever is going on. */
void fio_streamer_check(fio_streamer *streamer) {
    if (streamer->await < 0 || streamer->await_queued || streamer->executed < streamer->await ||
        streamer->handshaking || !fio_queue_is_empty(streamer))
        return;
    streamer->await = -1;
    switch (streamer->state) {
    case FIO_STREAM_GREETING:
        fio_handshake_step(streamer);
        break;
    case FIO_STREAM_PAUSING:
    case FIO_STREAM_RESUMING:
        fio_pause_step(streamer);
        break;
    case FIO_STREAM_FINISHING:
    case FIO_STREAM_CANCELLING:
        fio_end_step(streamer);
        break;
    default:
        break;
    }
}

static void hear_start(fio_streamer *streamer, const fio_answer *answer) {
    if (streamer->emergency) { /* grbl's answer to Ctrl-X, and of boards that reset themselves */
        fio_end_halted(streamer, answer);
        return;
    }
    if (streamer->state == FIO_STREAM_GREETING && streamer->greeting != FIO_GREETING_RESTORE)
        return;
    if (!streamer->has_source && !streamer->ending && !streamer->emergency) {
        fio_streamer_warn(streamer, "the printer was reset");
        fio_handshake_begin(streamer);
        streamer->greeting_until = INFINITY;
        return;
    }
    fio_end(streamer, FIO_LINK_LOST, true, "the printer was reset in the middle of the job");
}

/* Damaged: if lines wait for their answers, one of those may have been it. */
static void hear_damaged(fio_streamer *streamer) {
    bool is_long = fio_pulse_patience(streamer) > FIO_PLAIN_SECONDS;
    if (fio_window_lines(streamer) > 0 && streamer->recovery.stalls < DAMAGED_MOST && !is_long)
        streamer->recovery.stall = fmin(streamer->recovery.stall, DAMAGED_SECONDS);
}

static void hear_error(fio_streamer *streamer, const fio_answer *answer) {
    if (!streamer->plain && answer->line >= 0) {
        streamer->recovery.last_line = answer->line;
        streamer->recovery.last_time = streamer->now;
        return;
    }
    fio_streamer_say(streamer, FIO_STREAM_WARNING, answer->text, -1);
    hear_damaged(streamer);
    if (streamer->plain && streamer->firmware.kind == FIO_FIRMWARE_GRBL)
        fio_window_answer(streamer, answer); /* instead of an ok */
    /* Klipper and grbl did not do what they answer so; Klipper's own prints end there, too. */
    if (streamer->plain && streamer->has_source && streamer->job_sent > 0 && !streamer->ending &&
        (streamer->firmware.kind == FIO_FIRMWARE_KLIPPER ||
         streamer->firmware.kind == FIO_FIRMWARE_GRBL))
        fio_end(streamer, FIO_FAULTY, false, "the printer refused a command: %s", answer->text);
}

/* How long usual lines take to be answered; our own waiting is not to be measured. */
static void measure_pace(fio_streamer *streamer) {
    const fio_sent_line *line = fio_history_line(streamer, streamer->answered + 1);
    fio_pulse *pulse = &streamer->pulse;
    bool counts = line && line->time <= streamer->now && streamer->recovery.stalls == 0 &&
                  !(line->traits & FIO_COMMAND_LONG);
    pulse->pace *= 0.75;
    if (counts)
        pulse->pace = fmax(pulse->pace, streamer->now - fmax(pulse->answered, line->time));
}

static void hear_ok(fio_streamer *streamer, const fio_answer *answer) {
    measure_pace(streamer);
    streamer->pulse.answered = streamer->now;
    streamer->rubbish = false;
    if (answer->planner_free >= 0)
        fio_firmware_learn(&streamer->firmware, answer);
    if (fio_recovery_take_ok(streamer) || fio_handshake_ok(streamer, answer))
        return;
    fio_window_answer(streamer, answer);
}

/* grbl's status tells that nothing is left to do: what has no answer was lost, or its answer was.
 * While it dwells it calls itself idle, too. */
static void hear_idle(fio_streamer *streamer) {
    bool is_long = fio_pulse_patience(streamer) > FIO_PLAIN_SECONDS;
    if (streamer->recovery.stalls <= (is_long ? DWELLS_MOST : 0) || fio_window_lines(streamer) <= 0)
        return;
    fio_window_set(streamer, streamer->cursor - 1);
    if (streamer->has_source && streamer->job_sent > 0 && !streamer->ending)
        fio_end(streamer, FIO_LINK_LOST, false,
                "a line got no answer, and this firmware does not tell whether it had it");
    else
        fio_history_execute(streamer, streamer->answered);
}

static void hear_other(fio_streamer *streamer, const fio_answer *answer) {
    if (streamer->plain && answer->length > 5 && !memcmp(answer->text, "<Idle", 5))
        hear_idle(streamer);
    if (answer->kind == FIO_ANSWER_OTHER)
        hear_damaged(streamer);
    for (size_t i = 0; i < answer->length; i++)
        streamer->rubbish = streamer->rubbish || (unsigned char)answer->text[i] >= 127;
}

static void hear(void *context, const fio_answer *answer) {
    fio_streamer *streamer = context;
    if (streamer->state == FIO_STREAM_DONE)
        return;
    fio_pulse_hear(streamer, answer);
    if (streamer->listener.event)
        streamer->listener.event(streamer->listener.context,
                                 &(fio_stream_event){.kind = FIO_STREAM_ANSWER,
                                                     .time = streamer->now,
                                                     .state = streamer->state,
                                                     .answer = answer,
                                                     .text = answer->text,
                                                     .length = answer->length});
    fio_handshake_hear(streamer, answer);
    fio_pause_hear(streamer, answer);
    switch (answer->kind) {
    case FIO_ANSWER_OK:
        hear_ok(streamer, answer);
        break;
    case FIO_ANSWER_RESEND:
        if (!streamer->plain && answer->line >= 0)
            fio_recovery_resend(streamer, answer->line);
        break;
    case FIO_ANSWER_ERROR:
        hear_error(streamer, answer);
        break;
    case FIO_ANSWER_START:
        hear_start(streamer, answer);
        break;
    case FIO_ANSWER_HALTED:
        if (!fio_handshake_halted(streamer))
            fio_end_halted(streamer, answer);
        break;
    case FIO_ANSWER_BUSY:
        fio_recovery_progress(streamer);
        break;
    case FIO_ANSWER_WAIT: /* idle: whatever is unanswered will remain so */
        if (fio_window_lines(streamer) > 0)
            streamer->recovery.stall = 0.1;
        break;
    case FIO_ANSWER_ACTION:
        fio_pause_action(streamer, answer);
        break;
    case FIO_ANSWER_CAPABILITY:
        fio_firmware_learn(&streamer->firmware, answer);
        break;
    case FIO_ANSWER_PREVENTED:
        if (!streamer->echo_proved &&
            (strstr(answer->text, "\"M118") || strstr(answer->text, "\"M0118")))
            streamer->echoes = false;
        break;
    default:
        if (!fio_marker_hear(streamer, answer))
            hear_other(streamer, answer);
        break;
    }
    fio_streamer_check(streamer);
}

void fio_streamer_receive(fio_streamer *streamer, double now, const void *bytes, size_t size) {
    pass_time(streamer, now);
    if (size > 0)
        streamer->pulse.heard = streamer->now;
    fio_answer_parser_feed(&streamer->parser, bytes, size, hear, streamer);
}

void fio_streamer_tick(fio_streamer *streamer, double now) {
    pass_time(streamer, now);
    if (streamer->state == FIO_STREAM_DONE)
        return;
    fio_handshake_tick(streamer);
    fio_recovery_tick(streamer);
    fio_pulse_tick(streamer);
    fio_end_tick(streamer);
    fio_streamer_check(streamer);
}

double fio_streamer_deadline(const fio_streamer *streamer) {
    if (!streamer->begun)
        return 0;
    if (streamer->state == FIO_STREAM_DONE)
        return INFINITY;
    double marker = fio_marker_deadline(streamer);
    if (marker <= streamer->now)
        marker = INFINITY; /* it is due, but there is no room for it */
    double deadline = fmin(fio_handshake_deadline(streamer), fio_recovery_deadline(streamer));
    deadline = fmin(deadline, fmin(fio_pulse_deadline(streamer), fio_end_deadline(streamer)));
    return fmin(deadline, marker);
}

size_t fio_streamer_output(fio_streamer *streamer, double now, const char **bytes, bool *discard) {
    pass_time(streamer, now);
    *discard = streamer->discard;
    streamer->discard = false;
    *bytes = streamer->out;
    if (!fio_feed(streamer))
        return 0;
    *bytes = streamer->out + streamer->out_done;
    return streamer->out_length - streamer->out_done;
}

static void say_sent(fio_streamer *streamer) {
    if (!streamer->listener.event)
        return;
    size_t length = streamer->out_length;
    while (length > 0 && streamer->out[length - 1] == '\n')
        length--;
    size_t start = 0;
    while (start < length && streamer->out[start] == '\n')
        start++;
    streamer->listener.event(streamer->listener.context,
                             &(fio_stream_event){.kind = FIO_STREAM_SENT,
                                                 .time = streamer->now,
                                                 .state = streamer->state,
                                                 .text = streamer->out + start,
                                                 .length = length - start,
                                                 .number = streamer->out_number});
}

void fio_streamer_wrote(fio_streamer *streamer, double now, size_t size) {
    pass_time(streamer, now);
    if (size > streamer->out_length - streamer->out_done)
        size = streamer->out_length - streamer->out_done;
    streamer->out_done += size;
    streamer->report.bytes_sent += (int64_t)size;
    if (size == 0 || streamer->out_done < streamer->out_length)
        return;
    streamer->report.lines_sent++;
    fio_sent_line *line =
        streamer->out_number >= 0 ? fio_history_line(streamer, streamer->out_number) : NULL;
    if (line)
        line->time = streamer->now;
    say_sent(streamer);
}

static fio_status out_of_band(fio_streamer *streamer, const char *text, size_t length) {
    int code = 0;
    for (size_t i = 1; i < length && text[i] >= '0' && text[i] <= '9' && code < 10000; i++)
        code = code * 10 + (text[i] - '0');
    if (code == 112) {
        fio_streamer_emergency(streamer, streamer->now);
        return FIO_OK;
    }
    char line[FIO_WIRE_LINE_MOST + 1];
    if (length + 1 > sizeof line || streamer->raw_length + length + 1 > sizeof streamer->raw)
        return fio_fail(FIO_USAGE, "too many commands wait already");
    memcpy(line, text, length);
    line[length] = '\n';
    fio_queue_raw(streamer, line, length + 1);
    return FIO_OK;
}

fio_status fio_streamer_command(fio_streamer *streamer, double now, const char *text) {
    if (streamer->begun)
        pass_time(streamer, now);
    while (*text == ' ' || *text == '\t')
        text++;
    size_t length = strcspn(text, "\r\n;");
    while (length > 0 && (text[length - 1] == ' ' || text[length - 1] == '\t'))
        length--;
    if (length == 0)
        return FIO_OK;
    unsigned traits = fio_command_traits(text, length);
    if (streamer->state == FIO_STREAM_DONE || streamer->ending || streamer->emergency)
        return fio_fail(FIO_USAGE, "the connection is being closed");
    if (traits & FIO_COMMAND_STOPS)
        return out_of_band(streamer, text, length);
    if (traits & (FIO_COMMAND_NUMBERS | FIO_COMMAND_SD_WRITE) || streamer->opened_file)
        return fio_fail(FIO_USAGE, "\"%.*s\" may not be sent by hand now", (int)length, text);
    bool running = streamer->state == FIO_STREAM_RUNNING;
    if (!running && streamer->state != FIO_STREAM_PAUSED)
        return fio_fail(FIO_USAGE, "commands are taken while printing or paused, not now");
    if (fio_queue_room(streamer) < 4)
        return fio_fail(FIO_USAGE, "too many commands wait already");
    if (!fio_queue_command(streamer, text, length))
        return fio_fail(FIO_USAGE, "the command is too long");
    bool sets = *text == 'M' || *text == 'm'; /* moves in a pause are undone at its end */
    if (running || sets)
        fio_track_follow(&streamer->track, text, length);
    if (!running && sets)
        fio_track_follow(&streamer->paused, text, length);
    return FIO_OK;
}

const fio_stream_report *fio_streamer_report(const fio_streamer *streamer) {
    return &streamer->report;
}
