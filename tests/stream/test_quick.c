/* A firmware that answers at once: a whole history of lines passes before any time does. */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "protocol/source.h"
#include "stream/streamer.h"

enum { MOVES = 5000 };

typedef enum echo { ECHO_WHOLE, ECHO_BLANK, ECHO_SECOND, ECHO_NEVER } echo;

typedef struct quick {
    fio_streamer *streamer;
    fio_source *source;
    double now;
    echo echoes;
    const char *nags; /* said before every answer since the first move */
    int lines, markers, moves, heaters_off;
} quick;

static fio_source_result next(void *context, fio_source_command *command) {
    return fio_source_next(context, command);
}

static quick *begin(echo kind) {
    static char job[MOVES * 24];
    static quick q;
    size_t length = 0;
    q = (quick){.echoes = kind};
    for (int i = 0; i < MOVES; i++)
        length += (size_t)sprintf(job + length, "G1 X%d.%d\n", i / 10 % 200, i % 10);
    if (fio_source_memory(&q.source, job, length) != FIO_OK)
        abort();
    const fio_stream_source source = {next, NULL, q.source};
    const fio_stream_options options = fio_stream_options_defaults();
    if (fio_streamer_create(&q.streamer, &options, &source, NULL, NULL) != FIO_OK)
        abort();
    return &q;
}

static void end(quick *q) {
    fio_streamer_free(q->streamer);
    fio_source_close(q->source);
}

static void say(quick *q, const char *text) {
    fio_streamer_receive(q->streamer, q->now, text, strlen(text));
}

/* "N1003 M0118 39c1304 *77\n" */
static void answer_marker(quick *q, const char *text) {
    char token[16] = "", said[24];
    sscanf(text, "%7s", token);
    bool heard = q->echoes == ECHO_WHOLE || q->echoes == ECHO_BLANK ||
                 (q->echoes == ECHO_SECOND && q->markers % 2 == 1);
    q->markers++;
    snprintf(said, sizeof said, "%s%s\n", token, q->echoes == ECHO_BLANK ? " " : "");
    if (heard)
        say(q, said);
    say(q, "ok\n");
}

static void answer(quick *q, const char *line) {
    const char *command = strchr(line, ' ');
    int number = command ? atoi(command + 2) : 0;
    if (q->nags && q->moves > 0)
        say(q, q->nags);
    q->lines++;
    q->heaters_off |= number == 104 ? 1 : number == 140 ? 2 : 0;
    if (command && command[1] == 'M' && number == 115)
        say(q, "FIRMWARE_NAME:Marlin quick\nok\n");
    else if (command && command[1] == 'M' && number == 105)
        say(q, "ok T:20.0 /0.0 B:20.0 /0.0 @:0 B@:0\n");
    else if (command && command[1] == 'M' && number == 118)
        answer_marker(q, strchr(command + 1, ' ') + 1);
    else
        say(q, "ok\n");
    q->moves += command && command[1] == 'G';
}

/* Until the end, or an hour. */
static const fio_stream_report *run(quick *q) {
    say(q, "start\n");
    const fio_stream_report *report = fio_streamer_report(q->streamer);
    while (report->state != FIO_STREAM_DONE && q->now < 3600) {
        const char *bytes;
        char line[300];
        bool discard;
        size_t size = fio_streamer_output(q->streamer, q->now, &bytes, &discard);
        if (size == 0) {
            double due = fio_streamer_deadline(q->streamer);
            q->now = due > q->now ? (due < 3600 ? due : 3600) : q->now + 0.001;
            fio_streamer_tick(q->streamer, q->now);
            continue;
        }
        snprintf(line, sizeof line, "%.*s", (int)size, bytes);
        fio_streamer_wrote(q->streamer, q->now, size);
        answer(q, line);
    }
    return report;
}

static void check_whole(echo kind, double longest) {
    quick *q = begin(kind);
    const fio_stream_report *report = run(q);
    CHECK_EQUAL(FIO_STREAM_DONE, report->state);
    CHECK_EQUAL(FIO_OK, report->status);
    CHECK_EQUAL(MOVES, report->accepted);
    CHECK_EQUAL(MOVES, q->moves);
    CHECK(q->now < longest);
    if (q->now >= longest)
        fprintf(stderr, "took %g s: %s\n", q->now, report->message);
    end(q);
}

static void test_a_quick_firmware_is_fed_without_a_pause(void) {
    check_whole(ECHO_WHOLE, 5);
}

static void test_a_blank_behind_an_echo_is_the_encoders(void) {
    check_whole(ECHO_BLANK, 5);
}

static void test_lost_echoes_are_asked_for_again_before_the_history_is_full(void) {
    check_whole(ECHO_SECOND, 60);
}

static void test_a_firmware_that_echoes_nothing_is_asked_for_its_temperatures(void) {
    check_whole(ECHO_NEVER, 60);
}

static void test_a_printer_that_cancels_again_and_again_is_made_safe_once(void) {
    quick *q = begin(ECHO_WHOLE);
    q->nags = "//action:cancel\n";
    const fio_stream_report *report = run(q);
    CHECK_EQUAL(FIO_STREAM_DONE, report->state);
    CHECK_EQUAL(FIO_CANCELLED, report->status);
    CHECK_EQUAL(3, q->heaters_off);
    CHECK(report->heaters_off);
    CHECK(q->now < 5);
    end(q);
}

static void test_a_printer_that_starts_again_and_again_is_given_up(void) {
    quick *q = begin(ECHO_WHOLE);
    q->nags = "start\n";
    const fio_stream_report *report = run(q);
    CHECK_EQUAL(FIO_STREAM_DONE, report->state);
    CHECK_EQUAL(FIO_LINK_LOST, report->status);
    CHECK(strstr(report->message, "reset"));
    CHECK(q->lines < 1000);
    CHECK(q->now < 300);
    end(q);
}

int main(void) {
    RUN(test_a_quick_firmware_is_fed_without_a_pause);
    RUN(test_a_blank_behind_an_echo_is_the_encoders);
    RUN(test_lost_echoes_are_asked_for_again_before_the_history_is_full);
    RUN(test_a_firmware_that_echoes_nothing_is_asked_for_its_temperatures);
    RUN(test_a_printer_that_cancels_again_and_again_is_made_safe_once);
    RUN(test_a_printer_that_starts_again_and_again_is_given_up);
    return check_verdict();
}
