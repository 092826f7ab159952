#include "job.h"

#include <inttypes.h>
#include <poll.h>
#include <string.h>

#include "protocol/encode.h"
#include "protocol/words.h"
#include "signals.h"
#include "utf8.h"

enum { SIGNALS_EVERY = 4096 }; /* commands */

static bool is_of(const fio_source_command *command, int64_t wanted) {
    fio_words words = {command->text + 1, command->text + command->length};
    int64_t code;
    fio_words_blanks(&words);
    return fio_words_integer(&words, &code) && code == wanted;
}

/* What would spoil the numbers of the lines, or the job itself, wherever it stands in it; NULL if
 * there is nothing wrong. */
static const char *what_is_wrong(const fio_source_command *command) {
    unsigned traits = fio_command_traits(command->text, command->length);
    if (traits & FIO_COMMAND_NUMBERS)
        return "the numbers of the lines are the host's";
    if (traits & FIO_COMMAND_SD_WRITE)
        return "it belongs to writing on the printer's card, which --upload does";
    if (traits & FIO_COMMAND_RESETS)
        return "it restarts the printer";
    if ((traits & FIO_COMMAND_STOPS) && is_of(command, 112))
        return "it is the emergency stop";
    if ((traits & FIO_COMMAND_STOPS) && is_of(command, 410))
        return "it throws away the moves before it";
    return NULL;
}

/* Or a line that Marlin would cut at its 95 bytes. */
static fio_status check_command(const fio_job *job, const fio_source_command *command) {
    char wire[FIO_WIRE_LINE_MOST + 1], text[128];
    const char *wrong = what_is_wrong(command);
    if (wrong) {
        fio_text visible = fio_text_in(text, sizeof text);
        fio_utf8_visible(&visible, command->text, command->length < 40 ? command->length : 40);
        return fio_fail(FIO_FAULTY, "%s:%" PRId64 ": a job must not hold %s: %s", job->name,
                        command->line, text, wrong);
    }
    if (command->length > 64 &&
        fio_encode_line(wire, command->index + 1, command->text, command->length, 95) == 0)
        return fio_fail(FIO_FAULTY,
                        "%s:%" PRId64
                        ": %zu bytes are too long for a command: firmwares keep 95 of "
                        "a line, its number and checksum included",
                        job->name, command->line, command->length);
    return FIO_OK;
}

/* ---- text that is something else ---- */

static bool is_letter(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}

/* A letter and its number, as all firmwares have them; what grbl asks by a sign; the name of a
 * macro, as Klipper's START_PRINT. */
static bool is_gcode(const fio_source_command *command) {
    const char *text = command->text;
    size_t length = command->length, letters = 0;
    bool small = false;
    if (memchr("$?!~", *text, 4))
        return true;
    for (; letters < length && is_letter(text[letters]); letters++)
        small = small || text[letters] >= 'a';
    if (letters > 1) /* the words of other languages are written small */
        return !small && (letters == length || memchr(" \t0123456789", text[letters], 12));
    fio_words number = {text + letters, text + length};
    double value;
    if (!small) /* "v 0 0 0" is a corner in a model */
        fio_words_blanks(&number);
    return letters == 1 && fio_words_number(&number, &value);
}

static bool is_model(const fio_source_command *command) {
    fio_words words = {command->text, command->text + command->length};
    return fio_words_take(&words, "solid"); /* an STL of text */
}

static fio_status fail_model(const fio_job *job) {
    return fio_fail(FIO_UNREADABLE,
                    "%s: this is a model, not G-code; slice it first: isoslice %s -o part.gcode",
                    job->name, job->is_pipe ? "part.stl" : job->name);
}

static fio_status fail_empty(const fio_job *job) {
    return fio_fail(FIO_UNREADABLE, "%s: there is no command in it", job->name);
}

static fio_status check_file(fio_job *job) {
    fio_source_command command;
    fio_source_result result;
    int64_t count = 0;
    bool any = false;
    while ((result = fio_source_next(job->source, &command)) == FIO_SOURCE_COMMAND) {
        if (count == 0 && is_model(&command))
            return fail_model(job);
        any = any || is_gcode(&command);
        fio_status status = check_command(job, &command);
        if (status == FIO_OK && ++count % SIGNALS_EVERY == 0)
            status = fio_signals_check();
        if (status != FIO_OK)
            return status;
    }
    if (result == FIO_SOURCE_FAILED)
        return FIO_UNREADABLE;
    if (count > 0 && !any)
        return fio_fail(FIO_UNREADABLE, "%s: there is no command in it: this is text, not G-code",
                        job->name);
    return count == 0 ? fail_empty(job) : fio_source_seek(job->source, 0);
}

static fio_source_result next(fio_job *job, fio_source_command *command) {
    if (job->peeked) {
        job->peeked = false;
        *command = job->first;
        return FIO_SOURCE_COMMAND;
    }
    fio_source_result result = fio_source_next(job->source, command);
    job->waits = result == FIO_SOURCE_LATER;
    if (result == FIO_SOURCE_FAILED)
        job->failure = FIO_UNREADABLE;
    if (result != FIO_SOURCE_COMMAND || !job->is_pipe)
        return result;
    job->failure = check_command(job, command);
    return job->failure == FIO_OK ? FIO_SOURCE_COMMAND : FIO_SOURCE_FAILED;
}

/* Nothing is sent, no port is opened, before the one at the other end has something to print. */
static fio_status wait_for_first(fio_job *job) {
    for (;;) {
        fio_source_result result = next(job, &job->first);
        if (result == FIO_SOURCE_COMMAND) {
            if (is_model(&job->first))
                return fail_model(job);
            job->peeked = true;
            return FIO_OK;
        }
        if (result != FIO_SOURCE_LATER)
            return result == FIO_SOURCE_END ? fail_empty(job) : job->failure;
        struct pollfd polls[2] = {{fio_source_descriptor(job->source), POLLIN, 0},
                                  {fio_signals_descriptor(), POLLIN, 0}};
        poll(polls, 2, -1);
        fio_status status = fio_signals_check();
        if (status != FIO_OK)
            return status;
    }
}

fio_status fio_job_open(fio_job *job, const char *path) {
    *job = (fio_job){.is_pipe = !strcmp(path, "-")};
    job->name = job->is_pipe ? "standard input" : path;
    fio_status status = fio_source_open(&job->source, path);
    if (status == FIO_OK)
        status = job->is_pipe ? wait_for_first(job) : check_file(job);
    if (status != FIO_OK)
        fio_job_close(job);
    return status;
}

void fio_job_close(fio_job *job) {
    fio_source_close(job->source);
    job->source = NULL;
}

fio_source_result fio_job_next(void *context, fio_source_command *command) {
    return next(context, command);
}

void fio_job_look(fio_job *job) {
    struct pollfd input = {fio_source_descriptor(job->source), POLLIN, 0};
    if (job->waits && poll(&input, 1, 0) == 1)
        job->waits = false;
}

fio_status fio_job_line_of(fio_job *job, int64_t *line, int64_t index) {
    fio_source_command command;
    *line = 1;
    fio_status status = fio_source_seek(job->source, index > 0 ? index - 1 : 0);
    if (status != FIO_OK)
        return status;
    fio_source_result result = fio_source_next(job->source, &command);
    if (index > 0 && result == FIO_SOURCE_COMMAND) {
        *line = command.line + 1;
        result = fio_source_next(job->source, &command);
    }
    if (result == FIO_SOURCE_COMMAND)
        *line = command.line;
    return result == FIO_SOURCE_FAILED ? FIO_UNREADABLE : FIO_OK;
}

fio_status fio_job_seek(void *context, int64_t index) {
    fio_job *job = context;
    return fio_source_seek(job->source, index);
}

fio_status fio_job_find_line(fio_job *job, int64_t line, fio_stream_resume *resume) {
    fio_source_command command;
    fio_source_result result;
    fio_track track;
    fio_track_reset(&track);
    while ((result = fio_source_next(job->source, &command)) == FIO_SOURCE_COMMAND &&
           command.line < line)
        fio_track_follow(&track, command.text, command.length);
    if (result == FIO_SOURCE_FAILED)
        return FIO_UNREADABLE;
    if (result == FIO_SOURCE_END)
        return fio_fail(FIO_USAGE, "%s: there is no command from line %" PRId64 " on", job->name,
                        line);
    *resume = (fio_stream_resume){.accepted = command.index,
                                  .sent = command.index,
                                  .number = -1,
                                  .made = command.index,
                                  .track = track,
                                  .track_made = track};
    return fio_source_seek(job->source, 0);
}
