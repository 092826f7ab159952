/* What hosts are known to do wrong, from the threads of their users, and which test would tell:
 *
 * | failure                                             | test |
 * |-----------------------------------------------------|------------------------------------------|
 * | a Resend is served by the line next to it           | the_line_asked_for_is_the_one_that_comes
 * | | the firmware forgot the ok behind its Resend: stuck | a_resend_without_an_ok | | an error
 * without a Resend: both wait                | an_error_without_a_resend                | | the
 * same line asked for endlessly, sent endlessly   | a_line_that_is_never_good_ends_the_job,  | | |
 * a_firmware_that_always_complains         | | "Resend: -5" | a_number_below_zero | | the wanted
 * line is gone from the history            | a_line_is_kept_until_it_is_accepted      | | storms of
 * resends on slow links                     | streamer: a_doubled_resend_makes_no_storm| | a lost
 * ok is waited for for ever                    | streamer: a_lost_ok_costs_less_…;        | | |
 * a_lost_ok_where_the_firmware_says_wait   | | M105 pile up while it levels the bed |
 * no_flood_while_it_levels                 | | reports come, so the dead print looks alive |
 * reports_alone_are_no_life                | | long commands, a user who sleeps: given up |
 * streamer: long_commands_are_waited_for_… | | the emergency stop waits behind the queue |
 * streamer: an_emergency_stop_is_next_…    | | noise unplugs the port: all is lost | streamer:
 * after_a_disconnect_it_goes_on…,| |                                                     | campaign
 * | | heaters stay on after that                          | heaters_after_a_disconnect, | | |
 * streamer: a_reset_stops_the_job_with_…   | | opening the port resets the board | isoprint:
 * --no-reset, quiet resumption   | | a reset goes unnoticed, it goes on sending          |
 * streamer: a_reset_that_nobody_announces… | | nothing tells where to go on | journal, campaign |
 * | lines executed before are asked for again (a sensor | lines_asked_for_after_their_execution |
 * | threw the planner's away)                           | | | M117 with a colon ends the line, in
 * Repetier        | colons_for_repetier                      | | comments and brackets counted in
 * the checksum       | protocol: encode                         | | rubbish from the port kills the
 * thread that prints  | streamer: any_bytes_leave_it_sane        |
 */
#include "dialogue.h"

static fio_stream_options window_of(int lines, int bytes) {
    fio_stream_options options = fio_stream_options_defaults();
    options.window_lines = lines;
    options.window_bytes = bytes;
    return options;
}

static const char moves[] = "G90\nM83\nG1 X1\nG1 X2\nG1 X3\nG1 X4\nG1 X5\nG1 X6\nG1 X7\nG1 X8\n";

static void refuse(dialogue *d, const char *what, int64_t last) {
    char text[120];
    snprintf(text, sizeof text, "Error:%s, Last Line: %lld", what, (long long)last);
    say(d, text);
    snprintf(text, sizeof text, "Resend: %lld", (long long)last + 1);
    say(d, text);
}

static void test_the_line_asked_for_is_the_one_that_comes(void) {
    for (int wanted = 0; wanted < 4; wanted++) {
        fio_stream_options options = window_of(4, 127);
        dialogue *d = dialogue_begin(&options, moves, NULL);
        char lines[4][600];
        greet(d);
        for (int i = 0; i < 4; i++)
            snprintf(lines[i], sizeof lines[i], "%s", take(d));
        int64_t first = d->number - 3;
        for (int i = 0; i < wanted; i++)
            say(d, "ok");
        while (take(d)) /* others, as room appears */
            continue;
        refuse(d, "checksum mismatch", first + wanted - 1);
        say(d, "ok");
        for (int i = wanted; i < 4; i++) {
            pass_until_output(d, 1);
            const char *line = take(d);
            if (!CHECK(line && !strcmp(line, lines[i]))) /* the same bytes, in their order */
                fprintf(stderr, "    line %d of %d: %s\n", i, wanted, line ? line : "");
            say(d, "ok"); /* they go one by one, now that a line was damaged */
        }
        dialogue_end(d);
    }
}

static void test_a_resend_without_an_ok(void) {
    dialogue *d = dialogue_begin(NULL, moves, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    int64_t number = d->number;
    refuse(d, "checksum mismatch", number - 1);
    CHECK(pass_until_output(d, 10) < 0.5);
    EXPECT_COMMAND("G90", d);
    CHECK_EQUAL(number, d->number);
    say(d, "ok"); /* this one is the line's, not the Resend's */
    EXPECT_COMMAND("M83", d);
    dialogue_end(d);
}

/* Marlin 1.1 said no more of a line whose N had become something else. */
static void test_an_error_without_a_resend(void) {
    char text[120];
    dialogue *d = dialogue_begin(NULL, moves, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    int64_t number = d->number;
    snprintf(text, sizeof text, "Error:No Line Number with checksum, Last Line: %lld",
             (long long)number - 1);
    say(d, text);
    CHECK(pass_until_output(d, 10) < 1);
    CHECK(take(d) != NULL);
    if (d->number > number) { /* not that line, so its number tells */
        refuse(d, "Line Number is not Last Line Number+1", number - 1);
        say(d, "ok");
        CHECK(pass_until_output(d, 10) < 0.5);
        EXPECT_COMMAND("G90", d);
    }
    CHECK_EQUAL(number, d->number);
    say(d, "ok");
    EXPECT_COMMAND("M83", d);
    dialogue_end(d);
}

/* Answers each line of the host for so long; returns how many lines it wrote. */
static int64_t complain(dialogue *d, double seconds, const char *(*say_what)(dialogue *d)) {
    double end = d->now + seconds;
    int64_t lines = 0;
    while (d->now < end && dialogue_report(d)->state != FIO_STREAM_DONE) {
        if (take(d)) {
            lines++;
            d->now += 0.003;
            const char *text = say_what(d);
            if (text)
                say(d, text);
        } else {
            pass(d, 0.05);
        }
    }
    return lines;
}

static int64_t stuck_at;

static const char *refuse_one(dialogue *d) {
    refuse(d, d->number == stuck_at ? "checksum mismatch" : "Line Number is not Last Line Number+1",
           stuck_at - 1);
    return "ok";
}

static void test_a_line_that_is_never_good_ends_the_job(void) {
    dialogue *d = dialogue_begin(NULL, moves, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    stuck_at = d->number;
    refuse_one(d);
    say(d, "ok");
    int64_t lines = complain(d, 600, refuse_one);
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    CHECK_EQUAL(FIO_LINK_LOST, dialogue_report(d)->status);
    CHECK(strstr(dialogue_report(d)->message, "again and again"));
    CHECK(!dialogue_report(d)->heaters_off); /* it can't be told */
    CHECK(lines < 1000);
    dialogue_end(d);
}

static const char *always(dialogue *d) {
    (void)d;
    return "Error:No Checksum with line number";
}

static void test_a_firmware_that_always_complains(void) {
    dialogue *d = dialogue_begin(NULL, moves, NULL);
    greet(d);
    int64_t lines = complain(d, 3000, always);
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    CHECK_EQUAL(FIO_LINK_LOST, dialogue_report(d)->status);
    CHECK(lines < 3000);
    dialogue_end(d);
}

static const char *below_zero(dialogue *d) {
    say(d, "Error:Line Number is not Last Line Number+1, Last Line: -6");
    say(d, "Resend: -5");
    return "ok";
}

static void test_a_number_below_zero(void) {
    dialogue *d = dialogue_begin(NULL, moves, NULL);
    greet(d);
    int64_t lines = complain(d, 3000, below_zero);
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    CHECK(dialogue_report(d)->status != FIO_OK);
    CHECK(lines < 3000);
    dialogue_end(d);
}

/* No echo, no temperatures: nothing tells what has arrived, but everything has its ok. */
static void test_a_line_is_kept_until_it_is_accepted(void) {
    static char job[5000 * 8];
    for (int i = 0; i < 5000; i++)
        memcpy(job + (size_t)i * 6, "G1 X1\n", 7);
    fio_stream_options options = window_of(16, 1000);
    dialogue *d = dialogue_begin(&options, job, NULL);
    greet(d);
    const char *line = take(d);
    char first[100];
    snprintf(first, sizeof first, "%s", line ? line : "");
    int64_t number = d->number, highest = number;
    for (int i = 0; i < 20000; i++) {
        say(d, "ok");
        if (take(d))
            highest = d->number > highest && d->number < 1000000 ? d->number : highest;
        else
            pass(d, 0.05);
        if (dialogue_report(d)->state == FIO_STREAM_DONE)
            break;
    }
    CHECK(highest - number > 500 && highest - number <= 1024);
    refuse(d, "Line Number is not Last Line Number+1", number - 1);
    say(d, "ok");
    if (dialogue_report(d)->state != FIO_STREAM_DONE) {
        bool found = false;
        for (int i = 0; i < 40 && !found; i++) {
            const char *again = take(d);
            found = again && !strcmp(again, first);
            if (!again)
                pass(d, 0.1);
        }
        CHECK(found);
    }
    dialogue_end(d);
}

static void test_a_lost_ok_where_the_firmware_says_wait(void) {
    dialogue *d = dialogue_begin(NULL, moves, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    say(d, "wait");
    CHECK(pass_until_output(d, 10) < 0.2);
    dialogue_end(d);
}

/* G29 takes minutes. A small board has room for 64 bytes besides. */
static void test_no_flood_while_it_levels(void) {
    for (int busy = 0; busy <= 1; busy++) {
        dialogue *d = dialogue_begin(NULL, "G29\nG1 X1\n", NULL);
        greet(d);
        EXPECT_COMMAND("G29", d);
        size_t bytes = 0;
        for (int second = 0; second < 600; second += 2) {
            pass(d, 2);
            if (busy)
                say(d, "echo:busy: processing");
            for (const char *line; (line = take(d)) != NULL;)
                bytes += strlen(line) + 1;
            if (second <= 90)
                CHECK(bytes <= 63);
        }
        CHECK(bytes <= 500); /* one in half a minute */
        CHECK_EQUAL(FIO_STREAM_RUNNING, dialogue_report(d)->state);
        dialogue_end(d);
    }
}

static void test_reports_alone_are_no_life(void) {
    dialogue *d = dialogue_begin(NULL, moves, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    double start = d->now;
    while (d->now < start + 600 && dialogue_report(d)->state == FIO_STREAM_RUNNING) {
        say(d, " T:200.00 /200.00 B:60.00 /60.00 @:0 B@:0");
        pass(d, 1);
        while (take(d))
            continue;
    }
    CHECK(d->now < start + 130);
    CHECK(strstr(dialogue_report(d)->message, "does not arrive"));
    dialogue_end(d);
}

/* Out of reach they can't be switched off, and nobody may say that they are; at the next chance
 * they are, and without going on with the job if that is not wanted. */
static void test_heaters_after_a_disconnect(void) {
    dialogue *d = dialogue_begin(NULL, moves, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    fio_streamer_lost(d->streamer, d->now, FIO_LINK_LOST, "unplugged");
    CHECK(!dialogue_report(d)->heaters_off);
    fio_stream_resume resume = dialogue_report(d)->resume;
    dialogue_end(d);

    d = dialogue_begin(NULL, moves, &resume);
    bool nozzle = false, bed = false;
    for (int i = 0; i < 60 && dialogue_report(d)->state != FIO_STREAM_DONE; i++) {
        char command[600];
        snprintf(command, sizeof command, "%s", take_command(d));
        nozzle = nozzle || !strcmp(command, "M104 S0");
        bed = bed || !strcmp(command, "M140 S0");
        if (d->number == 2000000000 && !strcmp(command, "M105")) {
            refuse(d, "Line Number is not Last Line Number+1", resume.number - 1);
            say(d, "ok");
        } else if (command[0]) {
            answer(d, command);
        } else {
            pass(d, 0.3);
        }
        d->number = -1;
        if (i == 9)
            fio_streamer_cancel(d->streamer, d->now);
    }
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    CHECK_EQUAL(FIO_CANCELLED, dialogue_report(d)->status);
    CHECK(nozzle && bed && dialogue_report(d)->heaters_off);
    dialogue_end(d);
}

/* Prusa's MK3 drops what is queued and planned when its filament sensor asks for M600, and wants
 * those lines again. They are not to be had once a marker told of their execution: it stops safely,
 * and says why. */
static void test_lines_asked_for_after_their_execution(void) {
    dialogue *d = dialogue_begin(NULL, moves, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    int64_t number = d->number;
    say(d, "ok");
    pass(d, 1.1);
    for (int i = 0; i < 3; i++) {
        char command[600];
        snprintf(command, sizeof command, "%s", take_command(d));
        answer(d, command);
        pass(d, 1.1);
    }
    while (take(d))
        continue;
    for (int i = 0; i < 8 && dialogue_report(d)->state == FIO_STREAM_RUNNING; i++) {
        refuse(d, "Line Number is not Last Line Number+1", number - 1);
        say(d, "ok");
        while (take(d))
            continue;
    }
    CHECK_EQUAL(FIO_STREAM_CANCELLING, dialogue_report(d)->state);
    CHECK(strstr(dialogue_report(d)->message, "asks for line"));
    dialogue_end(d);
}

/* In Repetier before 1.0 a colon ends a line as LF does. */
static void test_colons_for_repetier(void) {
    fio_stream_options options = fio_stream_options_defaults();
    options.firmware = fio_firmware_of(FIO_FIRMWARE_REPETIER);
    options.no_greeting = true;
    dialogue *d = dialogue_begin(&options, "M117 ETA 10:20:30\n", NULL);
    char command[600];
    bool seen = false;
    for (int i = 0; i < 20 && !seen; i++) {
        const char *line = take(d);
        if (!line) {
            pass(d, 0.3);
            continue;
        }
        CHECK(!strchr(line, ':'));
        seen = strstr(line, "M117") != NULL;
        snprintf(command, sizeof command, "ok %lld", (long long)d->number);
        say(d, command);
        if (strstr(line, "M105"))
            say(d, "T:20.00 /0 B:20.00 /0 B@:0 @:0");
    }
    CHECK(seen);
    dialogue_end(d);
}

/* An ok as soon as a line is read, the temperatures later on a line of their own, as those are
 * which M109 tells while it heats: Repetier built without ACK_WITH_LINENUMBER, and others like it.
 */
static void print_without_markers(const char *name) {
    dialogue *d = dialogue_begin(NULL, "G90\nG1 X1\nM109 S200\nG1 X2\nG1 X3\n", NULL);
    int moves_seen = 0;
    for (int i = 0; i < 600 && dialogue_report(d)->state != FIO_STREAM_DONE; i++) {
        char command[600];
        snprintf(command, sizeof command, "%s", take_command(d));
        if (!command[0]) {
            pass(d, 0.1);
            continue;
        }
        say(d, "ok");
        moves_seen += !strncmp(command, "G1", 2);
        if (!strcmp(command, "M115"))
            say(d, name);
        for (int s = 0; s < 20 && !strncmp(command, "M109", 4); s++) {
            pass(d, 1);
            say(d, "T:100.00 /200 B:20.00 /0 B@:0 @:0");
        }
        if (!strcmp(command, "M105"))
            say(d, "T:200.00 /200 B:20.00 /0 B@:0 @:0");
    }
    CHECK_EQUAL(3, moves_seen);
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    CHECK_EQUAL(FIO_OK, dialogue_report(d)->status);
    CHECK(d->now < 140);
    dialogue_end(d);
}

static void test_firmwares_that_answer_no_marker(void) {
    print_without_markers("FIRMWARE_NAME:Repetier_1.0.4 PROTOCOL_VERSION:1.0 MACHINE_TYPE:Mendel");
    print_without_markers("FIRMWARE_NAME:Teacup FIRMWARE_URL:http://github.com/x PROTOCOL_VERSION");
    print_without_markers("echo:Unknown command: \"M115\"");
}

/* Repetier compares 16 bits of a number, and passes over the forty before the one that is due. */
static void test_a_far_number_is_far_for_repetier(void) {
    static char job[40000 * 8];
    for (int i = 0; i < 40000; i++)
        memcpy(job + (size_t)i * 6, "G1 X1\n", 7);
    fio_stream_options options = fio_stream_options_defaults();
    options.firmware = fio_firmware_of(FIO_FIRMWARE_REPETIER);
    dialogue *d = dialogue_begin(&options, job, NULL);
    int provoked = 0;
    say(d, "start");
    for (int i = 0; i < 120000 && d->number < 37950; i++) {
        char text[80];
        if (!take(d)) {
            pass(d, 0.05);
            continue;
        }
        snprintf(text, sizeof text, "ok %lld", (long long)d->number);
        say(d, text);
        if (d->number < 37870)
            continue;
        int64_t before = d->number;
        say(d, "Resend:7"); /* which can't be */
        say(d, "ok");
        for (int k = 0; k < 50 && d->number < 1000000; k++)
            if (!take(d))
                pass(d, 0.05);
        int64_t behind = (before - d->number) & 0xffff;
        CHECK(d->number > 1000000 && behind > 40 && behind < 0xff00);
        snprintf(text, sizeof text, "Resend:%lld", (long long)before + 1);
        say(d, text);
        say(d, "ok");
        d->number = before;
        provoked++;
    }
    CHECK(provoked > 40);
    CHECK_EQUAL(FIO_STREAM_RUNNING, dialogue_report(d)->state);
    dialogue_end(d);
}

int main(void) {
    RUN(test_the_line_asked_for_is_the_one_that_comes);
    RUN(test_a_resend_without_an_ok);
    RUN(test_an_error_without_a_resend);
    RUN(test_a_line_that_is_never_good_ends_the_job);
    RUN(test_a_firmware_that_always_complains);
    RUN(test_a_number_below_zero);
    RUN(test_a_line_is_kept_until_it_is_accepted);
    RUN(test_a_lost_ok_where_the_firmware_says_wait);
    RUN(test_no_flood_while_it_levels);
    RUN(test_reports_alone_are_no_life);
    RUN(test_heaters_after_a_disconnect);
    RUN(test_lines_asked_for_after_their_execution);
    RUN(test_colons_for_repetier);
    RUN(test_a_far_number_is_far_for_repetier);
    RUN(test_firmwares_that_answer_no_marker);
    return check_verdict();
}
