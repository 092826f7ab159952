/* The lines that may still be asked for, and what is known of those before them. */
#include <math.h>
#include <string.h>

#include "stream/state.h"

/* mm, far enough to be a block of the planner: what is less waits for the next move to be added. */
#define BLOCK_LEAST 0.08

fio_sent_line *fio_history_line(fio_streamer *streamer, int64_t number) {
    fio_sent_line *line = &streamer->lines[number & (FIO_HISTORY - 1)];
    return number >= 0 && number < streamer->next && line->number == number ? line : NULL;
}

void fio_history_restart(fio_streamer *streamer, int64_t last) {
    for (int i = 0; i < FIO_HISTORY; i++)
        streamer->lines[i].number = -1;
    streamer->next = streamer->cursor = last + 1;
    streamer->answered = streamer->accepted = streamer->executed = streamer->claimed = last;
    streamer->unmade = -1;
    streamer->answered_end = streamer->end = 0;
    streamer->run_count = 0;
    streamer->recovery.careful = 0;
    streamer->recovery.extra = -1;
    streamer->move_first = streamer->move_last = 0;
    streamer->marker = last;
    streamer->marker_lines = 0;
    streamer->marker_told = true;
}

/* The oldest line that may be asked for stays. While a file is written no marker tells what has
 * arrived; but then nothing takes long, and a Resend comes soon or never. */
bool fio_history_has_room(const fio_streamer *streamer) {
    int64_t kept = streamer->accepted;
    if (streamer->opened_file && streamer->answered - FIO_HISTORY / 2 > kept)
        kept = streamer->answered - FIO_HISTORY / 2;
    return streamer->next - kept < FIO_HISTORY - 2;
}

static bool note_run(fio_streamer *streamer, int64_t number) {
    fio_stream_run *last = streamer->run_count ? &streamer->runs[streamer->run_count - 1] : NULL;
    if (last && last->number + last->count == number) {
        last->count++;
        return true;
    }
    if (streamer->run_count == FIO_STREAM_RUNS)
        return false;
    streamer->runs[streamer->run_count++] = (fio_stream_run){number, 1};
    return true;
}

/* Whether the planner has surely got a block more since the last time this was so. */
static bool surely_moves(fio_streamer *streamer, bool moves) {
    const double *position = streamer->track.position;
    double most = 0;
    for (int i = 0; i < 4; i++)
        most = fmax(most, fabs(position[i] - streamer->planned[i]));
    if (!moves || most >= BLOCK_LEAST) /* G92 moves nothing */
        memcpy(streamer->planned, position, sizeof streamer->planned);
    return moves && most >= BLOCK_LEAST;
}

static bool encode(fio_streamer *streamer, fio_sent_line *line, const char *text, size_t length) {
    size_t most = streamer->firmware.line_most > 0 ? (size_t)streamer->firmware.line_most
                                                   : (size_t)FIO_WIRE_LINE_MOST - 1;
    char disguised[FIO_COMMAND_MOST + 3], plain[FIO_COMMAND_MOST + 1];
    if (streamer->firmware.kind == FIO_FIRMWARE_REPETIER && memchr(text, ':', length) &&
        length < sizeof plain) { /* it ends a line; older ones end it there */
        for (size_t i = 0; i < length; i++)
            plain[i] = text[i] == ':' ? '.' : text[i];
        text = plain;
    }
    if (!streamer->plain && !streamer->options.upload && streamer->firmware.emergency_parser &&
        length <= FIO_COMMAND_MOST) {
        length = fio_encode_disguised(disguised, text, length);
        text = disguised;
    }
    if (!streamer->plain) {
        line->length = (uint16_t)fio_encode_line(line->wire, line->number, text, length, most);
        return line->length > 0;
    }
    if (length > most || length + 1 > FIO_WIRE_LINE_MOST)
        return false;
    memcpy(line->wire, text, length);
    line->wire[length] = '\n';
    line->wire[length + 1] = 0;
    line->length = (uint16_t)(length + 1);
    return true;
}

/* A journal must know of the host's commands before the firmware does. */
static void mark(fio_streamer *streamer) {
    fio_stream_resume resume;
    if (!streamer->listener.event || !streamer->has_source || streamer->opened_file)
        return;
    fio_history_resume(streamer, &resume);
    streamer->listener.event(streamer->listener.context,
                             &(fio_stream_event){.kind = FIO_STREAM_MARK,
                                                 .time = streamer->now,
                                                 .state = streamer->state,
                                                 .resume = &resume});
}

bool fio_history_add(fio_streamer *streamer, const char *text, size_t length,
                     const fio_source_command *job, bool marker) {
    fio_sent_line *line = &streamer->lines[streamer->next & (FIO_HISTORY - 1)];
    line->number = streamer->next;
    if (!encode(streamer, line, text, length)) {
        line->number = -1;
        return false;
    }
    line->index = job ? job->index : -1;
    line->line = job ? job->line : 0;
    line->offset = job ? job->offset : 0;
    line->layer = job ? job->layer : 0;
    line->end = streamer->end += line->length;
    line->time = INFINITY;
    line->traits = fio_command_traits(text, length);
    line->marker = marker;
    line->moved = false;
    streamer->next++;
    streamer->cursor = streamer->next;
    streamer->marker_lines += !marker;
    if (job) {
        line->track = streamer->track;
        fio_track_follow(&streamer->track, text, length);
        line->moved = surely_moves(streamer, line->traits & FIO_COMMAND_MOVES);
        streamer->job_sent = job->index + 1;
        return true;
    }
    /* A run that can't be kept in mind makes a later resume impossible: see fio_queue. */
    if (!note_run(streamer, line->number))
        streamer->runs[FIO_STREAM_RUNS - 1].count++;
    mark(streamer);
    return true;
}

static void forget_runs(fio_streamer *streamer) {
    int gone = 0;
    while (gone < streamer->run_count) {
        fio_stream_run *run = &streamer->runs[gone];
        if (run->number + run->count - 1 > streamer->accepted) {
            if (run->number <= streamer->accepted) {
                run->count -= streamer->accepted + 1 - run->number;
                run->number = streamer->accepted + 1;
            }
            break;
        }
        gone++;
    }
    streamer->run_count -= gone;
    memmove(streamer->runs, streamer->runs + gone,
            (size_t)streamer->run_count * sizeof *streamer->runs);
}

void fio_history_accept(fio_streamer *streamer, int64_t number) {
    if (number >= streamer->next)
        number = streamer->next - 1;
    if (number <= streamer->accepted)
        return;
    for (int64_t n = streamer->accepted + 1; n <= number; n++) {
        const fio_sent_line *line = fio_history_line(streamer, n);
        if (!line || line->index < 0)
            continue;
        streamer->job_accepted = line->index + 1;
        streamer->report.accepted = streamer->job_accepted;
        streamer->report.line = line->line;
        streamer->report.offset = line->offset;
        streamer->report.layer = line->layer;
    }
    streamer->accepted = number;
    forget_runs(streamer);
    fio_recovery_progress(streamer);
}

static void find_made(fio_streamer *streamer) {
    if (streamer->undrained)
        return;
    int64_t first = streamer->unmade >= 0 ? streamer->unmade : streamer->executed + 1;
    if (first < streamer->next && !fio_history_line(streamer, first))
        return; /* the moves lie too far apart: what was known to be made before stays */
    for (int64_t n = first; n < streamer->next; n++) {
        const fio_sent_line *line = fio_history_line(streamer, n);
        if (line && line->index >= 0) {
            streamer->job_made = line->index;
            streamer->track_made = line->track;
            return;
        }
    }
    streamer->job_made = streamer->job_sent;
    streamer->track_made = streamer->track;
}

void fio_history_execute(fio_streamer *streamer, int64_t number) {
    if (number >= streamer->next)
        number = streamer->next - 1;
    fio_history_accept(streamer, number);
    if (number <= streamer->executed)
        return;
    int blocks = streamer->firmware.planner_blocks > 0 ? streamer->firmware.planner_blocks : 64;
    if (blocks > FIO_MOVES_KEPT - 1)
        blocks = FIO_MOVES_KEPT - 1;
    for (int64_t n = streamer->executed + 1; n <= number; n++) {
        const fio_sent_line *line = fio_history_line(streamer, n);
        if (line && (line->traits & FIO_COMMAND_MOVES) && streamer->unmade < 0)
            streamer->unmade = n;
        if (line && line->moved) {
            streamer->moves[streamer->move_last++ & (FIO_MOVES_KEPT - 1)] = n;
            if (streamer->move_last - streamer->move_first > (unsigned)blocks)
                streamer->move_first++;
            if (streamer->move_last - streamer->move_first == (unsigned)blocks)
                streamer->unmade = streamer->moves[streamer->move_first & (FIO_MOVES_KEPT - 1)];
        }
        if (line && (line->traits & FIO_COMMAND_DRAINS)) {
            streamer->move_first = streamer->move_last;
            streamer->unmade = -1;
            streamer->undrained = false;
        }
    }
    streamer->executed = number;
    find_made(streamer);
}

void fio_history_resume(const fio_streamer *streamer, fio_stream_resume *resume) {
    *resume = (fio_stream_resume){.accepted = streamer->job_accepted,
                                  .sent = streamer->job_sent,
                                  .number = -1,
                                  .made = streamer->job_made,
                                  .track = streamer->track,
                                  .track_made = streamer->track_made};
    if (resume->sent < resume->accepted)
        resume->sent = resume->accepted;
    for (int64_t n = streamer->accepted + 1; n < streamer->next; n++) {
        const fio_sent_line *line = &streamer->lines[n & (FIO_HISTORY - 1)];
        if (line->number == n && line->index >= 0) {
            resume->track = line->track;
            break;
        }
    }
    if (streamer->plain || streamer->renumbered)
        return;
    resume->number = streamer->accepted + 1;
    resume->run_count = streamer->run_count;
    memcpy(resume->runs, streamer->runs, sizeof resume->runs);
}

int64_t fio_history_index(const fio_stream_resume *resume, int64_t last) {
    if (resume->number < 0 || last + 1 < resume->number ||
        last + 1 - resume->number > 2 * FIO_HISTORY)
        return -1;
    int64_t index = resume->accepted + last + 1 - resume->number;
    for (int i = 0; i < resume->run_count && i < FIO_STREAM_RUNS; i++) {
        const fio_stream_run *run = &resume->runs[i];
        if (run->number <= last)
            index -= run->number + run->count - 1 <= last ? run->count : last + 1 - run->number;
    }
    return index;
}
