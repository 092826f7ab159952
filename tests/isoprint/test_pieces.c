/* The parts of isoprint that need no printer: words, text from outside, time left, slow readers. */
#include "../check.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include "../../firmware-io/cli/job.h"
#include "../../firmware-io/cli/json.h"
#include "../../firmware-io/cli/nearest.h"
#include "../../firmware-io/cli/output.h"
#include "../../firmware-io/cli/progress.h"
#include "../../firmware-io/cli/utf8.h"

static void test_nearest(void) {
    CHECK_EQUAL(3,
                fio_nearest_distance("kitten", "sitting")); /* Levenshtein's own example's heir */
    CHECK_EQUAL(0, fio_nearest_distance("resume_from", "resume-from"));
    CHECK_EQUAL(4, fio_nearest_distance("port", ""));
    CHECK_EQUAL(4, fio_nearest_distance("", "port"));
    char longest[300];
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    CHECK(fio_nearest_distance("port", longest) > fio_nearest_tolerance(longest));
}

/* The table of RFC 3629, section 4: first and last of each length, and what is none. */
static void test_utf8(void) {
    const char *const good[] = {"\x7f",         "\xc2\x80",         "\xdf\xbf",
                                "\xe0\xa0\x80", "\xed\x9f\xbf",     "\xee\x80\x80",
                                "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"};
    const char *const bad[] = {"\x80",
                               "\xc1\xbf",
                               "\xe0\x9f\xbf",
                               "\xed\xa0\x80",
                               "\xf0\x8f\xbf\xbf",
                               "\xf4\x90\x80\x80",
                               "\xf5\x80\x80\x80",
                               "\xc3(",
                               "\xff"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        CHECK_EQUAL(strlen(good[i]), fio_utf8_character(good[i], strlen(good[i])));
        if (strlen(good[i]) > 1)
            CHECK_EQUAL(0, fio_utf8_character(good[i], strlen(good[i]) - 1));
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        CHECK_EQUAL(0, fio_utf8_character(bad[i], strlen(bad[i])));
    CHECK_EQUAL(0, fio_utf8_character("", 0));
}

static void test_what_is_visible(void) {
    char bytes[64];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_utf8_visible(&text,
                     "a\tb\x1b[2J\xc2\x9b"
                     "c\xff\xc3\xa9",
                     13);
    CHECK(!strcmp("a b?[2J?c?\xc3\xa9", bytes));
    text = fio_text_in(bytes, sizeof bytes);
    fio_utf8_escaped(&text, "\\\x1b\xc3 ~", 5);
    CHECK(!strcmp("\\\\\\x1b\\xc3 ~", bytes));
}

static void test_json_of_any_bytes(void) {
    static fio_json json;
    char all[256];
    for (int i = 0; i < 256; i++)
        all[i] = (char)i;
    fio_json_begin(&json, "x\"\\\n");
    fio_json_bytes(&json, "all", all, sizeof all);
    fio_json_number(&json, "n", -1.25, 2);
    fio_json_boolean(&json, "b", true);
    fio_json_end(&json);
    CHECK(!strncmp("{\"event\": \"x\\\"\\\\\\u000a\", \"all\": \"\\u0000", json.bytes, 36));
    CHECK(strstr(json.bytes, "~\\u007f\\u0080") != NULL);
    CHECK(strstr(json.bytes, "\\u00ff\", \"n\": -1.25, \"b\": true}\n") != NULL);
    char huge[5000];
    memset(huge, 1, sizeof huge); /* the longest escapes */
    fio_json_begin(&json, "x");
    for (int i = 0; i < 4; i++)
        fio_json_bytes(&json, "k", huge, sizeof huge);
    fio_json_end(&json);
    CHECK(!strcmp("\"}\n", json.bytes + json.text.length - 3));
}

static const char *duration(double seconds) {
    static char bytes[64];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_progress_duration(&text, seconds);
    return bytes;
}

static void test_durations(void) {
    CHECK(!strcmp("0 s", duration(-5)));
    CHECK(!strcmp("59 s", duration(59.4)));
    CHECK(!strcmp("1 min", duration(59.5)));
    CHECK(!strcmp("59 min", duration(3599)));
    CHECK(!strcmp("1 h 00 min", duration(3600)));
    CHECK(!strcmp("27 h 46 min", duration(1e5)));
    CHECK(strlen(duration(1e300)) < 30);
}

/* A job of 1,000 bytes that takes twice as long as its slicer thought: at first its word is taken,
 * in the end what was seen. */
static void test_time_left(void) {
    fio_source_summary whole = {1000, 10, 100};
    fio_stream_report report = {.state = FIO_STREAM_RUNNING, .percent = -1, .minutes_left = -1};
    fio_progress progress;
    fio_progress_begin(&progress, &whole);
    fio_progress_update(&progress, &report, 0);
    CHECK_NEAR(100, progress.seconds_left, 1e-9);
    fio_progress_update(&progress, &report, 300); /* heating up: no layer yet */
    CHECK_NEAR(100, progress.seconds_left, 1e-9);
    report.accepted = report.layer = 1;
    fio_progress_update(&progress, &report, 300);
    for (int i = 1; i <= 99; i++) {
        report.offset = 10 * i;
        fio_progress_update(&progress, &report, 300 + 2 * i);
        double share = i / 100., blend = 100 * (1 - share) + 200 * share;
        if (i > 1)
            CHECK_NEAR((1 - share) * blend, progress.seconds_left, 1e-6);
    }
    double left = progress.seconds_left;
    report.state = FIO_STREAM_PAUSED;
    fio_progress_update(&progress, &report, 9000);
    CHECK_NEAR(left, progress.seconds_left, 1e-9);
    report.state = FIO_STREAM_RUNNING;
    report.percent = 50;
    report.minutes_left = 7;
    fio_progress_update(&progress, &report, 9000);
    CHECK_NEAR(0.5, progress.share, 1e-9);
    CHECK_NEAR(420, progress.seconds_left, 1e-9);
    fio_progress_update(&progress, &report, 9030); /* M73 comes but once a minute */
    CHECK_NEAR(390, progress.seconds_left, 1e-9);
}

/* Nobody reads: whole lines are dropped, none is cut, nothing waits. */
static void test_a_full_pipe(void) {
    static fio_output output;
    static char line[1000], read_back[300000];
    int ends[2];
    CHECK(pipe(ends) == 0);
    fio_output_share(&output, ends[1]);
    memset(line, 'x', sizeof line - 1);
    line[sizeof line - 1] = '\n';
    for (int i = 0; i < 300; i++)
        fio_output_line(&output, line, sizeof line);
    struct pollfd poll_it;
    CHECK(fio_output_waits(&output, &poll_it));
    CHECK(output.dropped > 100 && output.dropped < 300);
    int64_t written = 300 - output.dropped;
    size_t length = 0;
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
    for (ssize_t got = 1; got > 0; fio_output_flush(&output)) {
        got = read(ends[0], read_back + length, sizeof read_back - length);
        length += got > 0 ? (size_t)got : 0;
    }
    CHECK_EQUAL(written * (int64_t)sizeof line, length);
    for (size_t i = 1; i <= length / sizeof line; i++)
        CHECK(read_back[i * sizeof line - 1] == '\n');
    CHECK(!fio_output_close(&output, 0.1)); /* some were lost */
    close(ends[0]);
    close(ends[1]);
}

/* Command i stands in line 3 i + 2. After a resume most commands were never given out, and what is
 * surely made may lie far behind what was. */
static void test_the_line_of_any_command(void) {
    enum { COMMANDS = 5000 };
    char path[] = "/tmp/isoprint-test-job-XXXXXX";
    FILE *file = fdopen(mkstemp(path), "w");
    for (int i = 0; file && i < COMMANDS; i++)
        fprintf(file, "; comment\nG1 X%d\n\n", i);
    if (!file || fclose(file) != 0)
        abort();
    static fio_job job;
    fio_source_command command;
    CHECK_EQUAL(FIO_OK, fio_job_open(&job, path));
    CHECK_EQUAL(FIO_OK, fio_job_seek(&job, 3000));
    CHECK_EQUAL(FIO_SOURCE_COMMAND, fio_job_next(&job, &command));
    const int64_t indices[] = {3000, 0, 10, 2999, 3001, 4999, 1, 100};
    for (size_t i = 0; i < sizeof indices / sizeof *indices; i++) {
        int64_t line = -1;
        CHECK_EQUAL(FIO_OK, fio_job_line_of(&job, &line, indices[i]));
        CHECK_EQUAL(3 * indices[i] + 2, line);
    }
    int64_t line = -1;
    CHECK_EQUAL(FIO_OK, fio_job_line_of(&job, &line, COMMANDS)); /* all is made */
    CHECK_EQUAL(3 * COMMANDS, line);
    CHECK_EQUAL(0, truncate(path, 40));
    CHECK(fio_job_line_of(&job, &line, 4000) != FIO_OK);
    fio_job_close(&job);
    unlink(path);
}

int main(void) {
    RUN(test_nearest);
    RUN(test_utf8);
    RUN(test_what_is_visible);
    RUN(test_json_of_any_bytes);
    RUN(test_durations);
    RUN(test_time_left);
    RUN(test_a_full_pipe);
    RUN(test_the_line_of_any_command);
    return check_verdict();
}
