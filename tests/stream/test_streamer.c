#include "dialogue.h"

#include <math.h>

#include "base/memory.h"
#include "stream/state.h"

static fio_stream_options options_of(int lines, int bytes) {
    fio_stream_options options = fio_stream_options_defaults();
    options.window_lines = lines;
    options.window_bytes = bytes;
    return options;
}

static void test_the_greeting_numbers_and_asks_who_is_there(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    EXPECT_SILENCE(d); /* a board may be booting */
    pass(d, 0.5);
    say(d, "start");
    pass(d, 0.1);
    say(d, "echo:Marlin 2.1.2");
    EXPECT_SILENCE(d);
    pass(d, 0.3);
    EXPECT_COMMAND("M110 N1000", d);
    CHECK_EQUAL(1000, d->number);
    EXPECT_SILENCE(d);
    say(d, "ok");
    EXPECT_COMMAND("M115", d);
    CHECK_EQUAL(1001, d->number);
    EXPECT_SILENCE(d);
    say(d, "FIRMWARE_NAME:Marlin bugfix-2.1.x (Jan  1 2024)");
    say(d, "Cap:AUTOREPORT_TEMP:1");
    say(d, "ok");
    expect_marker(d);
    EXPECT_COMMAND("M155 S2", d);
    say(d, "ok");
    expect_marker(d);
    EXPECT_COMMAND("G90", d);
    CHECK_EQUAL(1005, d->number);
    CHECK_EQUAL(FIO_STREAM_RUNNING, dialogue_report(d)->state);
    dialogue_end(d);
}

static void test_nobody_there_is_no_printer(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    for (int i = 0; i < 40 && dialogue_report(d)->state != FIO_STREAM_DONE; i++) {
        pass(d, 1);
        while (take(d))
            continue;
    }
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    CHECK_EQUAL(FIO_NO_PRINTER, dialogue_report(d)->status);
    CHECK(strstr(dialogue_report(d)->message, "baud"));
    CHECK(d->now < 130);
    dialogue_end(d);
}

static void test_one_line_at_a_time_where_nothing_is_known(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    EXPECT_SILENCE(d);
    say(d, "ok");
    EXPECT_COMMAND("M83", d);
    EXPECT_SILENCE(d);
    dialogue_end(d);
}

static void test_a_window_is_filled_by_lines_and_by_bytes(void) {
    fio_stream_options lines = options_of(4, 1000), bytes = options_of(20, 40);
    dialogue *d = dialogue_begin(&lines, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    EXPECT_COMMAND("M83", d);
    EXPECT_COMMAND("G1 X1", d);
    EXPECT_COMMAND("G1 X2", d);
    EXPECT_SILENCE(d);
    say(d, "ok");
    EXPECT_COMMAND("G1 X3", d);
    EXPECT_SILENCE(d);
    dialogue_end(d);
    d = dialogue_begin(&bytes, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d); /* "N1003 G90*16": 13 bytes with its end; two and a half fit */
    EXPECT_COMMAND("M83", d);
    EXPECT_SILENCE(d);
    dialogue_end(d);
}

/* Marlin behind a slow link: it throws away what it has, and asks twice for the same line. */
static void test_a_doubled_resend_makes_no_storm(void) {
    fio_stream_options options = options_of(4, 127);
    dialogue *d = dialogue_begin(&options, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    int64_t first = d->number;
    char resend[40], error[80];
    for (int i = 0; i < 3; i++)
        take(d);
    d->now += 0.2; /* of latency */
    say(d, "ok");
    EXPECT_COMMAND("G1 X3", d);
    snprintf(error, sizeof error, "Error:checksum mismatch, Last Line: %d", (int)first);
    snprintf(resend, sizeof resend, "Resend: %d", (int)first + 1);
    for (int i = 0; i < 4; i++) {
        d->now += 0.001;
        say(d, error);
        say(d, resend);
        EXPECT_SILENCE(d); /* the others may still be asked for */
        say(d, "ok");
        if (i < 3)
            EXPECT_SILENCE(d);
    }
    const char *const again[] = {"M83", "G1 X1", "G1 X2", "G1 X3"};
    for (int i = 0; i < 4; i++) { /* one by one, now that lines are damaged */
        EXPECT_COMMAND(again[i], d);
        CHECK_EQUAL(first + 1 + i, d->number);
        EXPECT_SILENCE(d);
        say(d, "ok");
    }
    EXPECT_COMMAND("G1 X4", d);
    CHECK_EQUAL(4, dialogue_report(d)->repeats);
    dialogue_end(d);
}

/* The same, but what was under way is lost without a word. */
static void test_a_single_resend_is_served_when_nothing_more_comes(void) {
    fio_stream_options options = options_of(4, 127);
    dialogue *d = dialogue_begin(&options, five, NULL);
    greet(d);
    char resend[40];
    for (int i = 0; i < 4; i++)
        take(d);
    snprintf(resend, sizeof resend, "Resend: %d", (int)d->number - 3);
    d->now += 0.01;
    say(d, resend);
    say(d, "ok");
    EXPECT_SILENCE(d);
    CHECK(pass_until_output(d, 10) < 0.2);
    EXPECT_COMMAND("G90", d);
    dialogue_end(d);
}

static void test_a_lost_ok_costs_less_than_a_second(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    int64_t lost = d->number;
    CHECK(pass_until_output(d, 10) < 1);
    char command[600];
    snprintf(command, sizeof command, "%s", take_command(d));
    CHECK(!strncmp(command, "M118 ", 5)); /* not the same line again */
    CHECK_EQUAL(lost + 1, d->number);
    EXPECT_SILENCE(d);
    answer(d, command);
    EXPECT_COMMAND("M83", d);
    EXPECT_SILENCE(d);
    CHECK_EQUAL(1, dialogue_report(d)->lost_answers);
    dialogue_end(d);
}

static void test_a_lost_line_is_asked_for_by_the_probe(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    char text[80];
    int last = (int)d->number - 1;
    pass_until_output(d, 10);
    take(d);
    snprintf(text, sizeof text, "Error:Line Number is not Last Line Number+1, Last Line: %d", last);
    say(d, text);
    snprintf(text, sizeof text, "Resend: %d", last + 1);
    say(d, text);
    say(d, "ok");
    CHECK(pass_until_output(d, 10) < 0.5);
    EXPECT_COMMAND("G90", d);
    CHECK_EQUAL(last + 1, d->number);
    dialogue_end(d);
}

/* "Resend: 1" of a damaged "Resend: 1005" is not believed at once. */
static void test_a_number_that_can_not_be_is_asked_for_again(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    char text[80];
    int wanted = (int)d->number;
    say(d, "Resend: 5");
    say(d, "ok");
    const char *line = take(d);
    if (CHECK(line != NULL))
        CHECK(!strncmp(line, "N2000000000 M105*", 17)); /* nobody can have that line */
    snprintf(text, sizeof text, "Error:Line Number is not Last Line Number+1, Last Line: %d",
             wanted - 1);
    say(d, text);
    snprintf(text, sizeof text, "Resend: %d", wanted);
    say(d, text);
    say(d, "ok");
    pass(d, 0.5);
    EXPECT_COMMAND("G90", d);
    CHECK_EQUAL(FIO_STREAM_RUNNING, dialogue_report(d)->state);
    dialogue_end(d);
}

/* The error alone tells as much as the Resend that goes with it. */
static void test_a_damaged_resend_costs_a_tenth_of_a_second(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    int64_t wanted = d->number;
    char text[80];
    snprintf(text, sizeof text, "Error:checksum mismatch, Last Line: %d", (int)wanted - 1);
    say(d, text);
    say(d, "Resend: 10?3");
    say(d, "ok");
    EXPECT_COMMAND("M83", d); /* the ok is taken for one */
    CHECK(pass_until_output(d, 5) < 0.3);
    EXPECT_COMMAND("G90", d);
    CHECK_EQUAL(wanted, d->number);
    dialogue_end(d);
}

static void test_a_reset_that_nobody_announces_is_noticed(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    for (int i = 0; i < 4 && dialogue_report(d)->state == FIO_STREAM_RUNNING; i++) {
        say(d, "Error:Line Number is not Last Line Number+1, Last Line: 0");
        say(d, "Resend: 1");
        say(d, "ok");
        if (dialogue_report(d)->state == FIO_STREAM_RUNNING)
            CHECK(take(d) != NULL);
    }
    CHECK_EQUAL(FIO_STREAM_CANCELLING, dialogue_report(d)->state);
    EXPECT_COMMAND("M110 N1000", d); /* its own count is not ours */
    say(d, "ok");
    end_with_heaters_off(d);
    CHECK_EQUAL(FIO_LINK_LOST, dialogue_report(d)->status);
    CHECK_EQUAL(-1, dialogue_report(d)->resume.number);
    CHECK_EQUAL(0, dialogue_report(d)->resume.made);
    dialogue_end(d);
}

static void test_a_reset_stops_the_job_with_heaters_off(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    say(d, "start");
    CHECK_EQUAL(FIO_STREAM_CANCELLING, dialogue_report(d)->state);
    EXPECT_COMMAND("M110 N1000", d);
    EXPECT_SILENCE(d);
    say(d, "ok");
    end_with_heaters_off(d);
    CHECK_EQUAL(FIO_LINK_LOST, dialogue_report(d)->status);
    CHECK(strstr(dialogue_report(d)->message, "reset"));
    dialogue_end(d);
}

static void test_a_halted_firmware_ends_the_job_at_once(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    say(d, "Error:Heating failed, system stopped! Heater_ID: E0");
    say(d, "Error:Printer halted. kill() called!");
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    CHECK_EQUAL(FIO_FAULTY, dialogue_report(d)->status);
    CHECK(dialogue_report(d)->heaters_off);
    EXPECT_SILENCE(d);
    dialogue_end(d);
}

static void until_done(dialogue *d, double seconds) {
    double end = d->now + seconds;
    while (d->now < end && dialogue_report(d)->state != FIO_STREAM_DONE) {
        pass_until_output(d, end - d->now);
        while (take(d))
            continue;
    }
}

static void test_silence_is_noticed_in_seconds_where_hearts_beat(void) {
    dialogue *d = dialogue_begin(NULL, "G28\nG1 X1\n", NULL);
    greet(d);
    EXPECT_COMMAND("G28", d);
    for (int i = 0; i < 60; i++) { /* two minutes of homing are fine */
        pass(d, 2);
        while (take(d))
            continue;
        say(d, "echo:busy: processing");
    }
    CHECK_EQUAL(FIO_STREAM_RUNNING, dialogue_report(d)->state);
    double start = d->now;
    until_done(d, 100);
    CHECK_EQUAL(FIO_LINK_LOST, dialogue_report(d)->status);
    CHECK(d->now - start < 20);
    CHECK(!dialogue_report(d)->heaters_off);
    CHECK(strstr(dialogue_report(d)->message, "silent"));
    dialogue_end(d);
}

static void test_long_commands_are_waited_for_without_heartbeats(void) {
    dialogue *d = dialogue_begin(NULL, "G1 X1\nM190 S100\nG1 X2\n", NULL);
    greet(d);
    EXPECT_COMMAND("G1 X1", d);
    say(d, "ok");
    EXPECT_COMMAND("M190 S100", d);
    double end = d->now + 600;
    while (d->now < end) {
        pass(d, 10);
        while (take(d))
            continue;
    }
    CHECK_EQUAL(FIO_STREAM_RUNNING, dialogue_report(d)->state);
    dialogue_end(d);
    d = dialogue_begin(NULL, "G1 X1\nM190 S100\nG1 X2\n", NULL);
    greet(d);
    EXPECT_COMMAND("G1 X1", d);
    until_done(d, 300);
    CHECK_EQUAL(FIO_LINK_LOST, dialogue_report(d)->status);
    dialogue_end(d);
}

/* What is written after an emergency stop is wanted, whatever was going on, half a line included.
 */
static void stop_in(dialogue *d) {
    const char *bytes;
    bool discard;
    if (fio_streamer_output(d->streamer, d->now, &bytes, &discard) > 3)
        fio_streamer_wrote(d->streamer, d->now, 3);
    fio_streamer_emergency(d->streamer, d->now);
    size_t size = fio_streamer_output(d->streamer, d->now, &bytes, &discard);
    CHECK(discard);
    CHECK(size == 6 && !memcmp(bytes, "\nM112\n", 6));
    fio_streamer_wrote(d->streamer, d->now, size);
    CHECK_EQUAL(0, fio_streamer_output(d->streamer, d->now, &bytes, &discard));
    say(d, "Error:Printer halted. kill() called!");
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    CHECK_EQUAL(FIO_CANCELLED, dialogue_report(d)->status);
    CHECK(dialogue_report(d)->heaters_off);
    dialogue_end(d);
}

static void test_an_emergency_stop_is_next_in_any_state(void) {
    fio_stream_options options = options_of(4, 127);
    dialogue *d = dialogue_begin(&options, five, NULL);
    stop_in(d); /* before the greeting */
    d = dialogue_begin(&options, five, NULL);
    pass(d, 2);
    stop_in(d); /* M110 half written */
    d = dialogue_begin(&options, five, NULL);
    greet(d);
    take(d);
    stop_in(d); /* in the job, window open */
    d = dialogue_begin(&options, five, NULL);
    greet(d);
    while (take(d))
        continue;
    stop_in(d); /* window full */
    d = dialogue_begin(&options, five, NULL);
    greet(d);
    take(d);
    say(d, "Resend: 1003");
    stop_in(d); /* waiting in a recovery */
    d = dialogue_begin(&options, five, NULL);
    greet(d);
    fio_streamer_pause(d->streamer, d->now);
    stop_in(d);
    d = dialogue_begin(&options, five, NULL);
    greet(d);
    fio_streamer_cancel(d->streamer, d->now);
    stop_in(d);
    d = dialogue_begin(&options, "G90\n", NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    EXPECT_COMMAND("M400", d);
    CHECK_EQUAL(FIO_STREAM_FINISHING, dialogue_report(d)->state);
    stop_in(d);
}

static void test_an_emergency_stop_is_repeated_until_it_is_confirmed(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    take(d);
    fio_streamer_emergency(d->streamer, d->now);
    EXPECT_COMMAND("M112", d);
    CHECK(pass_until_output(d, 5) <= 1);
    EXPECT_COMMAND("M112", d);
    until_done(d, 1000);
    CHECK_EQUAL(FIO_CANCELLED, dialogue_report(d)->status);
    CHECK(!dialogue_report(d)->heaters_off);
    CHECK(strstr(dialogue_report(d)->message, "switch it off"));
    dialogue_end(d);
}

static void test_the_end_is_believed_only_when_a_marker_is_answered(void) {
    dialogue *d = dialogue_begin(NULL, "G90\nG1 X1\n", NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    say(d, "ok");
    EXPECT_COMMAND("G1 X1", d);
    say(d, "ok");
    EXPECT_COMMAND("M400", d);
    say(d, "ok");
    say(d, "ok"); /* doubled: proves nothing */
    char marker[600];
    snprintf(marker, sizeof marker, "%s", take_command(d));
    say(d, "ok");
    CHECK_EQUAL(FIO_STREAM_FINISHING, dialogue_report(d)->state);
    CHECK(pass_until_output(d, 5) < 1);
    expect_marker(d);
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    CHECK_EQUAL(FIO_OK, dialogue_report(d)->status);
    CHECK_EQUAL(2, dialogue_report(d)->accepted);
    dialogue_end(d);
}

static void test_a_pause_restores_position_temperatures_and_modes(void) {
    static const char job[] = "G28\nM104 S210\nM140 S60\nM106 S100\nG1 X10 Y20 Z0.3 F1500\n"
                              "M83\nG1 X11 E1\nG1 X12\nG1 X13\n";
    dialogue *d = dialogue_begin(NULL, job, NULL);
    greet(d);
    for (int i = 0; i < 7; i++) {
        CHECK(take(d) != NULL);
        if (i < 6)
            say(d, "ok");
    }
    fio_streamer_pause(d->streamer, d->now);
    CHECK_EQUAL(FIO_STREAM_PAUSING, dialogue_report(d)->state);
    say(d, "ok");
    const char *const steps[] = {"M400",           "M114", "G21", "G91", "M83", "G1 E-2.000 F1800",
                                 "G1 Z2.000 F600", "G90"};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        EXPECT_COMMAND(steps[i], d);
        if (i == 1)
            say(d, "X:11.00 Y:20.00 Z:0.30 E:1.00 Count X:880 Y:1600 Z:120");
        say(d, "ok");
    }
    expect_marker(d);
    CHECK_EQUAL(FIO_STREAM_PAUSED, dialogue_report(d)->state);
    EXPECT_SILENCE(d);
    fio_streamer_resume(d->streamer, d->now);
    char all[2000] = "";
    for (int i = 0; i < 40 && dialogue_report(d)->state == FIO_STREAM_RESUMING; i++) {
        char command[600];
        snprintf(command, sizeof command, "%s", take_command(d));
        strcat(strcat(all, command), "|");
        answer(d, command);
    }
    CHECK_EQUAL(FIO_STREAM_RUNNING, dialogue_report(d)->state);
    CHECK(strstr(all, "S210"));
    CHECK(strstr(all, "X11") && strstr(all, "Y20") && strstr(all, "Z0.3"));
    CHECK(strstr(all, "M106 S100"));
    CHECK(strstr(all, "M83"));
    CHECK(strstr(all, "F1500"));
    EXPECT_COMMAND("G1 X12", d);
    dialogue_end(d);
}

/* All that the host says until it is in this state. */
static void answer_until(dialogue *d, fio_stream_state state, char *all, size_t capacity) {
    all[0] = 0;
    for (int i = 0; i < 60 && dialogue_report(d)->state != state; i++) {
        char command[600];
        snprintf(command, sizeof command, "%s", take_command(d));
        size_t length = strlen(all);
        snprintf(all + length, capacity - length, "%s|", command);
        answer(d, command);
    }
    CHECK_EQUAL(state, dialogue_report(d)->state);
}

static void test_what_is_set_by_hand_in_a_pause_outlasts_the_next_one(void) {
    static const char job[] = "G28\nM104 S210\nG1 X10 Y20 Z0.3 F1500\nG1 X12\nG1 X13\nG1 X14\n";
    static char all[4000];
    dialogue *d = dialogue_begin(NULL, job, NULL);
    greet(d);
    for (int i = 0; i < 3; i++) {
        CHECK(take(d) != NULL);
        say(d, "ok");
    }
    for (int pause = 0; pause < 2; pause++) {
        fio_streamer_pause(d->streamer, d->now);
        answer_until(d, FIO_STREAM_PAUSED, all, sizeof all);
        if (pause == 0) {
            CHECK_EQUAL(FIO_OK, fio_streamer_command(d->streamer, d->now, "M104 S225"));
            EXPECT_COMMAND("M104 S225", d);
            say(d, "ok");
        }
        fio_streamer_resume(d->streamer, d->now);
        answer_until(d, FIO_STREAM_RUNNING, all, sizeof all);
        CHECK(strstr(all, "S225") && !strstr(all, "S210"));
    }
    dialogue_end(d);
}

static void test_one_that_was_cancelled_before_it_began_stays_so(void) {
    fio_streamer *streamer;
    const char *bytes;
    bool discard;
    CHECK_EQUAL(FIO_OK, fio_streamer_create(&streamer, NULL, NULL, NULL, NULL));
    fio_streamer_cancel(streamer, 100);
    fio_streamer_tick(streamer, 100);
    CHECK_EQUAL(FIO_STREAM_DONE, fio_streamer_report(streamer)->state);
    CHECK_EQUAL(0, fio_streamer_output(streamer, 110, &bytes, &discard));
    CHECK_EQUAL(FIO_CANCELLED, fio_streamer_report(streamer)->status);
    fio_streamer_free(streamer);
}

static void test_cancel_switches_off_and_waits_for_the_answer(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    fio_streamer_cancel(d->streamer, d->now);
    EXPECT_SILENCE(d); /* the window holds one line */
    say(d, "ok");
    end_with_heaters_off(d);
    CHECK_EQUAL(FIO_CANCELLED, dialogue_report(d)->status);
    CHECK_EQUAL(1, dialogue_report(d)->resume.accepted);
    dialogue_end(d);
}

static void test_the_printers_own_actions_are_obeyed(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    say(d, "ok");
    say(d, "//action:paused");
    CHECK_EQUAL(FIO_STREAM_PAUSED, dialogue_report(d)->state);
    say(d, "// action:resumed");
    CHECK_EQUAL(FIO_STREAM_RUNNING, dialogue_report(d)->state);
    say(d, "//action:prompt_begin Load filament");
    CHECK_EQUAL(1, d->prompts);
    CHECK(strstr(d->prompt, "Load filament"));
    say(d, "//action:prompt_end");
    CHECK(!strcmp("", d->prompt));
    say(d, "//action:pause");
    CHECK_EQUAL(FIO_STREAM_PAUSING, dialogue_report(d)->state);
    say(d, "//action:cancel");
    CHECK_EQUAL(FIO_STREAM_CANCELLING, dialogue_report(d)->state);
    dialogue_end(d);
}

static void test_after_a_disconnect_it_goes_on_with_the_next_command(void) {
    fio_stream_options options = options_of(4, 127);
    dialogue *d = dialogue_begin(&options, five, NULL);
    greet(d);
    for (int i = 0; i < 4; i++)
        take(d);
    int64_t last = d->number - 2; /* of four lines, two arrived */
    fio_streamer_lost(d->streamer, d->now, FIO_LINK_LOST, "unplugged");
    CHECK_EQUAL(FIO_LINK_LOST, dialogue_report(d)->status);
    CHECK(strstr(dialogue_report(d)->message, "unplugged"));
    fio_stream_resume resume = dialogue_report(d)->resume;
    CHECK_EQUAL(4, resume.sent);
    dialogue_end(d);

    d = dialogue_begin(&options, five, &resume);
    pass(d, 2);
    for (int i = 0; i < 2; i++) {
        const char *line = take(d);
        if (CHECK(line != NULL))
            CHECK(!strncmp(line, "N2000000000 M105*", 17));
        char text[80];
        snprintf(text, sizeof text, "Error:Line Number is not Last Line Number+1, Last Line: %d",
                 (int)last);
        say(d, text);
        snprintf(text, sizeof text, "Resend: %d", (int)last + 1);
        say(d, text);
        say(d, "ok");
    }
    EXPECT_COMMAND("M400", d); /* the same count goes on */
    CHECK_EQUAL(last + 1, d->number);
    say(d, "ok");
    EXPECT_COMMAND("M115", d);
    say(d, "FIRMWARE_NAME:Marlin 2.1");
    say(d, "ok");
    expect_marker(d);
    EXPECT_COMMAND("G1 X1", d);
    dialogue_end(d);
}

static void test_the_host_commands_among_the_lines_are_counted_out(void) {
    fio_stream_resume resume = {
        .accepted = 10, .sent = 14, .number = 1020, .run_count = 2, .runs = {{1022, 2}, {1025, 1}}};
    /* 1020: 10, 1021: 11, then two of the host, 1024: 12, one, 1026: 13 */
    static const int after[] = {10, 11, 12, 12, 12, 13, 13, 14, 15};
    for (int i = 0; i < 9; i++)
        CHECK_EQUAL(after[i], fio_history_index(&resume, 1019 + i));
    CHECK_EQUAL(-1, fio_history_index(&resume, 1018)); /* it has less than it surely had */
    CHECK_EQUAL(-1, fio_history_index(&resume, 900000));
}

static void test_a_journal_is_told_before_each_host_command(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    int before = d->marks;
    CHECK_EQUAL(FIO_OK, fio_streamer_command(d->streamer, d->now, "M106 S50"));
    say(d, "ok");
    EXPECT_COMMAND("M106 S50", d);
    CHECK_EQUAL(before + 1, d->marks);
    CHECK_EQUAL(1, d->mark.sent);
    dialogue_end(d);
}

static void test_a_job_may_not_meddle_with_numbers_or_files(void) {
    dialogue *d = dialogue_begin(NULL, "G90\nM110 N0\nM28 x.gco\nG91\n", NULL);
    greet(d);
    const char *const sent[] = {"G90", "G4 P0", "G4 P0", "G91"};
    for (int i = 0; i < 4; i++) {
        EXPECT_COMMAND(sent[i], d);
        say(d, "ok");
    }
    CHECK_EQUAL(2, d->warnings);
    CHECK_EQUAL(FIO_USAGE, fio_streamer_command(d->streamer, d->now, "M110 N5"));
    dialogue_end(d);
}

static void test_a_line_too_long_for_the_firmware_ends_safely(void) {
    char job[400] = "G90\nG1 ";
    for (int i = 0; i < 30; i++)
        strcat(job, "X10.12345");
    strcat(job, "\nG91\n");
    dialogue *d = dialogue_begin(NULL, job, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    say(d, "ok");
    end_with_heaters_off(d);
    CHECK_EQUAL(FIO_UNREADABLE, dialogue_report(d)->status);
    CHECK(strstr(dialogue_report(d)->message, "line 2"));
    dialogue_end(d);
}

static void test_allocations_that_fail_leave_nothing(void) {
    fio_streamer *streamer;
    fio_fail_allocation_after(0);
    CHECK_EQUAL(FIO_NO_MEMORY, fio_streamer_create(&streamer, NULL, NULL, NULL, NULL));
    fio_fail_allocation_after(-1);
    CHECK(streamer == NULL);
}

static void test_any_bytes_leave_it_sane(void) {
    uint64_t state = 5;
    for (int round = 0; round < 200; round++) {
        dialogue *d = dialogue_begin(NULL, five, NULL);
        for (int i = 0; i < 100; i++) {
            static const char *const pieces[] = {"ok",          "Resend: ", "1001",
                                                 "\n",          "start\n",  "Error:",
                                                 "Last Line: ", "9",        "//action:pause\n",
                                                 "\xff",        "wait\n",   "ok N1003 P15 B3\n",
                                                 "busy: x\n",   " T:1 /2"};
            state = state * 6364136223846793005u + 1442695040888963407u;
            const char *piece = pieces[(state >> 33) % (sizeof pieces / sizeof *pieces)];
            fio_streamer_receive(d->streamer, d->now, piece, strlen(piece));
            pass(d, (double)(state >> 40 & 1023) / 500);
            while (take(d))
                continue;
        }
        CHECK(fio_streamer_deadline(d->streamer) >= 100);
        dialogue_end(d);
    }
}

int main(void) {
    RUN(test_the_greeting_numbers_and_asks_who_is_there);
    RUN(test_nobody_there_is_no_printer);
    RUN(test_one_line_at_a_time_where_nothing_is_known);
    RUN(test_a_window_is_filled_by_lines_and_by_bytes);
    RUN(test_a_doubled_resend_makes_no_storm);
    RUN(test_a_single_resend_is_served_when_nothing_more_comes);
    RUN(test_a_lost_ok_costs_less_than_a_second);
    RUN(test_a_lost_line_is_asked_for_by_the_probe);
    RUN(test_a_number_that_can_not_be_is_asked_for_again);
    RUN(test_a_damaged_resend_costs_a_tenth_of_a_second);
    RUN(test_a_reset_that_nobody_announces_is_noticed);
    RUN(test_a_reset_stops_the_job_with_heaters_off);
    RUN(test_a_halted_firmware_ends_the_job_at_once);
    RUN(test_silence_is_noticed_in_seconds_where_hearts_beat);
    RUN(test_long_commands_are_waited_for_without_heartbeats);
    RUN(test_an_emergency_stop_is_next_in_any_state);
    RUN(test_an_emergency_stop_is_repeated_until_it_is_confirmed);
    RUN(test_the_end_is_believed_only_when_a_marker_is_answered);
    RUN(test_a_pause_restores_position_temperatures_and_modes);
    RUN(test_what_is_set_by_hand_in_a_pause_outlasts_the_next_one);
    RUN(test_one_that_was_cancelled_before_it_began_stays_so);
    RUN(test_cancel_switches_off_and_waits_for_the_answer);
    RUN(test_the_printers_own_actions_are_obeyed);
    RUN(test_after_a_disconnect_it_goes_on_with_the_next_command);
    RUN(test_the_host_commands_among_the_lines_are_counted_out);
    RUN(test_a_journal_is_told_before_each_host_command);
    RUN(test_a_job_may_not_meddle_with_numbers_or_files);
    RUN(test_a_line_too_long_for_the_firmware_ends_safely);
    RUN(test_allocations_that_fail_leave_nothing);
    RUN(test_any_bytes_leave_it_sane);
    return check_verdict();
}
