/* A streamer in dialogue with a test that plays the firmware, line by line. */
#ifndef TESTS_STREAM_DIALOGUE_H
#define TESTS_STREAM_DIALOGUE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "protocol/encode.h"
#include "protocol/source.h"
#include "stream/streamer.h"

typedef struct dialogue {
    fio_streamer *streamer;
    fio_source *source;
    double now;
    char line[600]; /* written by the host, not yet looked at */
    size_t length;
    int64_t number; /* N of the last numbered line that take() gave */
    int marks, prompts, warnings;
    char prompt[100];
    fio_stream_resume mark;
    bool discard;
} dialogue;

static inline fio_source_result dialogue_next(void *context, fio_source_command *command) {
    return fio_source_next(context, command);
}

static inline fio_status dialogue_seek(void *context, int64_t index) {
    return fio_source_seek(context, index);
}

static inline void dialogue_hear(void *context, const fio_stream_event *event) {
    dialogue *d = context;
    if (event->kind == FIO_STREAM_MARK) {
        d->marks++;
        d->mark = *event->resume;
    }
    d->warnings += event->kind == FIO_STREAM_WARNING;
    if (event->kind == FIO_STREAM_PROMPT) {
        d->prompts++;
        snprintf(d->prompt, sizeof d->prompt, "%.*s", (int)event->length, event->text);
    }
}

static inline dialogue *dialogue_begin(const fio_stream_options *options, const char *job,
                                       const fio_stream_resume *resume) {
    dialogue *d = calloc(1, sizeof *d);
    d->now = 100;
    fio_stream_listener listener = {dialogue_hear, d};
    if (job && fio_source_memory(&d->source, job, strlen(job)) != FIO_OK)
        abort();
    fio_stream_source source = {dialogue_next, dialogue_seek, d->source};
    CHECK_EQUAL(FIO_OK, fio_streamer_create(&d->streamer, options, job ? &source : NULL, resume,
                                            &listener));
    fio_streamer_tick(d->streamer, d->now);
    return d;
}

static inline void dialogue_end(dialogue *d) {
    fio_streamer_free(d->streamer);
    fio_source_close(d->source);
    free(d);
}

static inline const fio_stream_report *dialogue_report(const dialogue *d) {
    return fio_streamer_report(d->streamer);
}

/* The firmware says this, a line end is added. */
static inline void say(dialogue *d, const char *text) {
    char line[600];
    int length = snprintf(line, sizeof line, "%s\n", text);
    fio_streamer_receive(d->streamer, d->now, line, (size_t)length);
}

/* The next line the host writes, without its end; NULL: nothing now. */
static inline const char *take(dialogue *d) {
    static char text[600];
    for (;;) {
        char *end = memchr(d->line, '\n', d->length);
        if (end == d->line) { /* an empty line */
            memmove(d->line, d->line + 1, --d->length);
            continue;
        }
        if (end) {
            size_t length = (size_t)(end - d->line);
            memcpy(text, d->line, length);
            text[length] = 0;
            d->length -= length + 1;
            memmove(d->line, end + 1, d->length);
            if (text[0] == 'N')
                d->number = strtoll(text + 1, NULL, 10);
            return text;
        }
        const char *bytes;
        bool discard;
        size_t size = fio_streamer_output(d->streamer, d->now, &bytes, &discard);
        d->discard = d->discard || discard;
        if (size == 0)
            return NULL;
        if (size > sizeof d->line - d->length)
            abort();
        memcpy(d->line + d->length, bytes, size);
        d->length += size;
        fio_streamer_wrote(d->streamer, d->now, size);
    }
}

/* The command of a line: without number and checksum, both of which must be right. */
static inline const char *take_command(dialogue *d) {
    static char command[600];
    const char *line = take(d);
    if (!line)
        return "";
    snprintf(command, sizeof command, "%s", line);
    if (line[0] != 'N')
        return command;
    char *star = strrchr(command, '*');
    if (!CHECK(star != NULL))
        return command;
    CHECK_EQUAL(fio_checksum(command, (size_t)(star - command)), strtol(star + 1, NULL, 10));
    *star = 0;
    while (star > command && star[-1] == ' ')
        *--star = 0;
    const char *start = command + 1 + strspn(command + 1, "0123456789");
    return start + strspn(start, " ");
}

#define EXPECT_COMMAND(expected, d) expect_command((expected), take_command(d), __FILE__, __LINE__)
static inline void expect_command(const char *expected, const char *actual, const char *file,
                                  int line) {
    check_count++;
    if (!strcmp(expected, actual))
        return;
    check_failures++;
    fprintf(stderr, "%s:%d: the host wrote \"%s\", not \"%s\"\n", file, line, actual, expected);
}

#define EXPECT_SILENCE(d) EXPECT_COMMAND("", d)

/* Let this much time pass, in steps as the streamer wants them. */
static inline void pass(dialogue *d, double seconds) {
    double end = d->now + seconds;
    while (d->now < end) {
        double deadline = fio_streamer_deadline(d->streamer);
        d->now = deadline > d->now && deadline < end ? deadline : end;
        fio_streamer_tick(d->streamer, d->now);
    }
}

/* Until the host writes something, at most this long; returns how long it took. */
static inline double pass_until_output(dialogue *d, double seconds) {
    double start = d->now, end = start + seconds;
    while (d->now < end && d->length == 0 && dialogue_report(d)->state != FIO_STREAM_DONE) {
        const char *bytes;
        bool discard;
        if (fio_streamer_output(d->streamer, d->now, &bytes, &discard) > 0)
            break;
        double deadline = fio_streamer_deadline(d->streamer);
        d->now = deadline > d->now && deadline < end ? deadline : end;
        fio_streamer_tick(d->streamer, d->now);
    }
    return d->now - start;
}

/* Answer what the host says of itself as Marlin would: echo, temperatures, ok. */
static inline void answer(dialogue *d, const char *command) {
    const char *text = !strncmp(command, "M118 ", 5)    ? command + 5
                       : !strncmp(command, "M0118 ", 6) ? command + 6
                                                        : NULL;
    if (text)
        say(d, text);
    say(d, !strcmp(command, "M105") ? "ok T:20.00 /0.00 B:20.00 /0.00 @:0 B@:0" : "ok");
}

/* Through the greeting of a Marlin, up to the first command behind it. */
static inline void greet(dialogue *d) {
    say(d, "start");
    pass(d, 0.5);
    EXPECT_COMMAND("M110 N1000", d);
    say(d, "ok");
    EXPECT_COMMAND("M115", d);
    say(d, "FIRMWARE_NAME:Marlin 2.1.2 (Test) PROTOCOL_VERSION:1.0 MACHINE_TYPE:Test");
    say(d, "Cap:EMERGENCY_PARSER:0");
    say(d, "ok");
    char command[600];
    snprintf(command, sizeof command, "%s", take_command(d));
    CHECK(!strncmp(command, "M118 ", 5));
    answer(d, command);
}

static inline void expect_marker(dialogue *d) {
    char command[600];
    snprintf(command, sizeof command, "%s", take_command(d));
    if (!CHECK(!strncmp(command, "M118 ", 5) || !strncmp(command, "M0118 ", 6)))
        fprintf(stderr, "    but: %s\n", command);
    answer(d, command);
}

/* A job of ten commands. */
__attribute__((unused)) static const char five[] =
    "G90\nM83\nG1 X1\nG1 X2\nG1 X3\nG1 X4\nG1 X5\nG1 X6\nG1 X7\nG1 X8\n";

static inline void end_with_heaters_off(dialogue *d) {
    char command[600];
    bool nozzle = false, bed = false, fan = false;
    for (int i = 0; i < 30 && dialogue_report(d)->state != FIO_STREAM_DONE; i++) {
        snprintf(command, sizeof command, "%s", take_command(d));
        nozzle = nozzle || !strcmp(command, "M104 S0");
        bed = bed || !strcmp(command, "M140 S0");
        fan = fan || !strcmp(command, "M107");
        if (command[0])
            answer(d, command);
        else
            pass(d, 0.3);
    }
    CHECK(nozzle && bed && fan);
    CHECK(dialogue_report(d)->heaters_off);
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
}

#endif
