/* What goes over the wire next. */
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "stream/state.h"

static void put_line(fio_streamer *streamer, fio_sent_line *line) {
    memcpy(streamer->out, line->wire, line->length);
    streamer->out_length = line->length;
    streamer->out_done = 0;
    streamer->out_number = line->number;
    line->time = INFINITY;
    if (streamer->recovery.allow_one)
        streamer->recovery.extra = line->number;
    streamer->recovery.allow_one = false;
}

static void put_raw(fio_streamer *streamer) {
    size_t size = streamer->raw_length;
    if (size > sizeof streamer->out)
        size = sizeof streamer->out;
    memcpy(streamer->out, streamer->raw, size);
    memmove(streamer->raw, streamer->raw + size, streamer->raw_length - size);
    streamer->raw_length -= size;
    streamer->out_length = size;
    streamer->out_done = 0;
    streamer->out_number = -1;
}

static bool may_send(const fio_streamer *streamer) {
    if (streamer->state == FIO_STREAM_DONE || streamer->emergency || streamer->handshaking ||
        fio_recovery_holds(streamer))
        return false;
    return streamer->state != FIO_STREAM_GREETING || streamer->greeting == FIO_GREETING_NAME ||
           streamer->greeting == FIO_GREETING_SET_UP || streamer->greeting == FIO_GREETING_RESTORE;
}

/* Bytes of a command on the wire, at most. */
static size_t wire_length(const fio_streamer *streamer, size_t length) {
    size_t digits = 1;
    for (int64_t n = streamer->next; n >= 10; n /= 10)
        digits++;
    return length + (streamer->plain ? 1 : digits + 9);
}

static bool send_again(fio_streamer *streamer) {
    fio_sent_line *line = fio_history_line(streamer, streamer->cursor);
    if (!line) {
        fio_end(streamer, FIO_BUG, true, "line %lld is wanted again, but was not kept",
                (long long)streamer->cursor);
        return false;
    }
    if (!fio_window_open(streamer, line->length))
        return false;
    streamer->cursor++;
    streamer->report.repeats++;
    put_line(streamer, line);
    return true;
}

/* Where a whole history passes before a lost echo is asked for again, the job leaves room for that.
 */
static bool has_room(const fio_streamer *streamer, bool job) {
    return fio_history_has_room(streamer) &&
           (!job || streamer->opened_file ||
            streamer->next - streamer->accepted < FIO_HISTORY - FIO_HISTORY_RESERVE);
}

static bool send_new(fio_streamer *streamer, const char *text, size_t length,
                     const fio_source_command *job, bool marker) {
    if (!has_room(streamer, job) || !fio_window_open(streamer, wire_length(streamer, length)))
        return false;
    if (!fio_history_add(streamer, text, length, job, marker)) {
        if (job)
            fio_end(streamer, FIO_UNREADABLE, false,
                    "line %lld of the job is too long for the printer (it keeps %d bytes)",
                    (long long)job->line, streamer->firmware.line_most);
        else
            fio_streamer_warn(streamer, "too long for the printer: %.60s", text);
        return false;
    }
    put_line(streamer, fio_history_line(streamer, streamer->next - 1));
    return true;
}

/* Another run of host commands can be kept in mind. */
static bool run_fits(const fio_streamer *streamer) {
    if (streamer->plain || streamer->run_count < FIO_STREAM_RUNS)
        return true;
    const fio_stream_run *last = &streamer->runs[streamer->run_count - 1];
    return last->number + last->count == streamer->next;
}

static bool send_marker(fio_streamer *streamer) {
    char text[FIO_WIRE_LINE_MOST];
    size_t length = fio_marker_text(streamer, text, sizeof text);
    if (!run_fits(streamer) || !send_new(streamer, text, length, NULL, true))
        return false;
    fio_marker_sent(streamer);
    return true;
}

static bool send_host(fio_streamer *streamer) {
    fio_host_command *command = &streamer->host[streamer->host_first % FIO_HOST_QUEUE];
    if (command->marker && streamer->plain) {
        streamer->await = streamer->next - 1;
    } else if (command->marker) {
        if (!send_marker(streamer))
            return false;
        streamer->await = streamer->next - 1;
    } else {
        bool fits = run_fits(streamer);
        int64_t next = streamer->next;
        bool asks = !streamer->echoes && !strcmp(command->text, "M105"); /* as a marker does */
        if (!fits || (!send_new(streamer, command->text, command->length, NULL, asks) &&
                      fio_window_open(streamer, wire_length(streamer, command->length)) == false))
            return false;
        if (streamer->next == next && !fio_history_has_room(streamer))
            return false;
        if (asks && streamer->next > next)
            fio_marker_sent(streamer);
    }
    if (!fio_queue_is_empty(streamer))
        streamer->host_first++;
    streamer->await_queued = streamer->await_queued && !command->marker;
    return true;
}

static void follow_progress(fio_streamer *streamer, const fio_source_command *command) {
    const char *text = command->text, *end = text + command->length;
    if (command->length < 5 || memcmp(text, "M73", 3) != 0 || (text[3] >= '0' && text[3] <= '9'))
        return;
    for (const char *p = text + 3; p < end; p++) {
        double value;
        if ((*p != 'P' && *p != 'R') || fio_number_read(&value, p + 1, end) == p + 1 ||
            !(value >= 0 && value < 1e6))
            continue;
        if (*p == 'P')
            streamer->report.percent = value < 100 ? (int)value : 100;
        else
            streamer->report.minutes_left = (int)value;
    }
}

static bool fetch(fio_streamer *streamer) {
    if (streamer->has_pending)
        return true;
    if (streamer->source_ended)
        return false;
    switch (streamer->source.next(streamer->source.context, &streamer->pending)) {
    case FIO_SOURCE_COMMAND:
        streamer->has_pending = true;
        if (streamer->source_dry)
            streamer->report.idle += streamer->now - streamer->dry_since;
        streamer->source_dry = false;
        return true;
    case FIO_SOURCE_LATER:
        if (!streamer->source_dry)
            streamer->dry_since = streamer->now;
        streamer->source_dry = true;
        return false;
    case FIO_SOURCE_END:
        streamer->source_ended = true;
        return false;
    default:
        fio_end(streamer, FIO_UNREADABLE, false, "%s", fio_error_message());
        return false;
    }
}

/* What a job must not say to a firmware that counts lines is replaced by nothing, so that lines and
 * commands still go together. */
static bool send_job(fio_streamer *streamer) {
    if (streamer->state != FIO_STREAM_RUNNING || !streamer->has_source || !fetch(streamer))
        return false;
    const fio_source_command *command = &streamer->pending;
    unsigned traits = fio_command_traits(command->text, command->length);
    bool foreign = traits & (FIO_COMMAND_NUMBERS | FIO_COMMAND_SD_WRITE);
    const char *text = foreign ? "G4 P0" : command->text;
    if (!send_new(streamer, text, foreign ? 5 : command->length, command, false))
        return false;
    if (foreign)
        fio_streamer_warn(streamer, "line %lld of the job is left out: %s",
                          (long long)command->line, command->text);
    follow_progress(streamer, command);
    streamer->report.sent = command->index + 1;
    streamer->has_pending = false;
    return true;
}

bool fio_feed(fio_streamer *streamer) {
    if (streamer->out_done < streamer->out_length)
        return true;
    streamer->out_length = streamer->out_done = 0;
    if (streamer->raw_length > 0 && streamer->state != FIO_STREAM_DONE) {
        put_raw(streamer);
        return true;
    }
    while (may_send(streamer) && streamer->out_length == 0) {
        if (streamer->cursor < streamer->next)
            return send_again(streamer);
        if (streamer->probe && fio_marker_due(streamer) && run_fits(streamer)) {
            if (!send_marker(streamer))
                return false;
            continue;
        }
        if (!fio_queue_is_empty(streamer) &&
            (run_fits(streamer) || streamer->state != FIO_STREAM_RUNNING)) {
            if (!send_host(streamer))
                return false;
            fio_streamer_check(streamer);
            continue;
        }
        if (fio_marker_due(streamer) && run_fits(streamer)) {
            if (!send_marker(streamer))
                return false;
            continue;
        }
        if (send_job(streamer))
            continue;
        if (streamer->state == FIO_STREAM_RUNNING && streamer->has_source &&
            streamer->source_ended && !streamer->has_pending) {
            fio_end_finish(streamer);
            continue;
        }
        return false;
    }
    return streamer->out_length > 0 && streamer->state != FIO_STREAM_DONE;
}
