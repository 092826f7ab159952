/* Each step of a script shows, at its moment; a wrong script is told where it is wrong. */
#include "bench.h"

#include "virtual/script.h"

static void expect_error(const char *text, const char *where) {
    static fio_script script;
    CHECK_EQUAL(FIO_USAGE, fio_script_read(&script, text));
    if (!CHECK(strstr(fio_error_message(), where)))
        fprintf(stderr, "    %s\n    gave: %s\n", text, fio_error_message());
}

static void test_errors_say_where(void) {
    expect_error("at line 5 explode", "line 1, column 11: no such action");
    expect_error("# one\n\n  sometimes reset", "line 3, column 3: a step begins with");
    expect_error("at lien 5 reset", "column 4: time, line, number, byte, ok or command");
    expect_error("at line x reset", "column 9: a number is expected");
    expect_error("at line 5x reset", "column 9: this is no number");
    expect_error("at line 2.5 reset", "column 9: a whole number");
    expect_error("at line 0 reset", "column 9: this number is too small");
    expect_error("at time -1 reset", "column 9: a time is not negative");
    expect_error("at time 99999999999 reset", "column 9: this is no number");
    expect_error("at line 5 reset now", "column 17: the end of the step");
    expect_error("at line 5 halt \"never closed", "column 16: this quotation mark");
    expect_error("at line 5 halt", "column 15: a text is expected");
    expect_error("from line 10 flip in 1.5", "column 22: a probability is 0 to 1");
    expect_error("from line 10 reset", "column 14: after \"from\"");
    expect_error("after 3 cows reset", "column 9: seconds, lines, bytes or oks");
    expect_error("after 0 oks reset", "column 7: this number is too small");
    expect_error("every 0.001 seconds reset", "column 1: nothing happens more often");
    expect_error("at line 1 reset; at line 2 lose ok 0", "column 36: this number is too small");
    char many[6000] = "";
    for (int i = 0; i <= FIO_SCRIPT_STEPS; i++)
        strcat(many, "at line 1 reset\n");
    expect_error(many, "line 129, column 1: too many steps");
    static fio_script script;
    CHECK_EQUAL(FIO_OK, fio_script_read(&script, ""));
    CHECK_EQUAL(FIO_OK,
                fio_script_read(&script, " # at line 5 ; \"\n;;\r\nat  time .5\tlose   ok # x"));
    CHECK_EQUAL(1, script.count);
    CHECK_NEAR(0.5, script.steps[0].at, 0);
    CHECK_EQUAL(FIO_OK, fio_script_read(&script, "at line 1 answer \"a;b # c\"; at ok 2 reset"));
    CHECK_EQUAL(2, script.count);
    CHECK(!strcmp("a;b # c", script.texts + script.steps[0].text));
}

static void test_lost_doubled_and_late_oks(void) {
    bench *b = bench_script("at ok 2 lose ok; at ok 4 double ok; at ok 6 late ok 3");
    bench_expect(b, "G90\n", 0.1, "ok\n");
    bench_expect(b, "G90\n", 0.1, "");
    bench_expect(b, "G90\n", 0.1, "ok\n");
    bench_expect(b, "G90\n", 0.1, "ok\nok\n");
    bench_expect(b, "G90\n", 0.1, "ok\n");
    bench_expect(b, "G90\n", 2.9, "");
    bench_expect(b, "", 0.2, "ok\n");
    CHECK_EQUAL(6, fio_machine_count(b->machine)->oks); /* as the firmware said them */
    CHECK_EQUAL(6, b->entries);
    bench_free(b);
    b = bench_script("after 1 ok lose ok 2\nat line 5 lose answer 2");
    CHECK_EQUAL(2, bench_count(bench_ask(b, "G90\nG90\nG90\nG90\n", 0.1), "ok"));
    bench_expect(b, "M118 hello\nG90\n", 0.1, "ok\n");
    bench_free(b);
}

static void test_rejections(void) {
    bench *b = bench_script("at line 2 reject 3");
    const char *again = "Error:checksum mismatch, Last Line: 1\nResend: 2\nok\n";
    bench_expect(b, bench_line(1, "G90"), 0.1, "ok\n");
    for (int i = 0; i < 3; i++)
        bench_expect(b, bench_line(2, "G90"), 0.1, again);
    bench_expect(b, bench_line(2, "G90"), 0.1, "ok\n");
    bench_free(b);
    b = bench_script("at line 1 reject for ever");
    for (int i = 0; i < 50; i++)
        CHECK(strstr(bench_ask(b, bench_line(1, "G90"), 0.1), "Resend: 1\n"));
    bench_free(b);
    b = bench_script("at line 1 miscount -3; after 5 seconds resend 77; at number 3 forget");
    CHECK(strstr(bench_ask(b, "N5 G90*1\n", 0.1), "Last Line: 0\nResend: -2\nok\n"));
    bench_expect(b, "", 5, "Resend: 77\nok\n");
    bench_ask(b, "M110 N2\n", 0.1);
    bench_expect(b, bench_line(3, "G90"), 0.1, "ok\n");
    CHECK(strstr(bench_ask(b, bench_line(4, "G90"), 0.1), "Last Line: 0\n"));
    bench_free(b);
}

static void test_silence(void) {
    bench *b = bench_script("at line 2 silent 20; at time 60 mute 5");
    bench_expect(b, "G90\n", 0.1, "ok\n");
    bench_expect(b, "G91\nG90\n", 19.9, ""); /* it does nothing, and forgets nothing */
    CHECK_EQUAL(1, b->entries);
    bench_expect(b, "", 0.2, "ok\nok\n");
    bench_pass(b, 60 - b->now);
    bench_expect(b, "G90\n", 4, ""); /* it works, but is not heard */
    CHECK_EQUAL(4, b->entries);
    bench_expect(b, "", 4, "");
    bench_expect(b, "G90\n", 0.1, "ok\n");
    bench_free(b);
}

static void test_busy_and_throttle(void) {
    bench *b = bench_script("at line 1 busy 9; at line 2 throttle 0.5; at line 4 throttle 0");
    CHECK_EQUAL(4, bench_count(bench_ask(b, "G90\n", 8.9), "echo:busy: processing\n"));
    bench_expect(b, "", 0.2, "ok\n");
    bench_expect(b, "G90\n", 0.49, "");
    bench_expect(b, "", 0.1, "ok\n");
    bench_expect(b, "G90\nG90\nG90\n", 0.4, "");
    bench_free(b);
}

static void test_resets_and_halts(void) {
    bench *b =
        bench_script("at line 3 reset; at number 4 halt \"Thermal Runaway\"; at time 30 reset");
    bench_send(b, bench_line(1, "G91"));
    bench_expect(b, bench_line(2, "G91"), 0.1, "ok\nok\n");
    bench_expect(b, bench_line(3, "G91"), 0.9, "");
    CHECK(!strncmp(bench_ask(b, "", 0.2), "start\n", 6));
    CHECK(strstr(bench_ask(b, bench_line(3, "G91"), 0.1), "Last Line: 0\nResend: 1\n"));
    bench_ask(b, "M110 N3\n", 0.1);
    bench_expect(
        b, bench_line(4, "G91"), 0.1,
        "Error:Thermal Runaway\nError:Printer halted. kill() called!\n//action:poweroff\n");
    bench_expect(b, "G90\n", 10, "");
    bench_pass(b, 31.5 - b->now);
    CHECK(strstr(b->heard, "start\n"));
    bench_expect(b, "G90\n", 0.1, "ok\n");
    CHECK_EQUAL(2, fio_machine_count(b->machine)->resets);
    bench_free(b);
}

/* The plug goes in the middle of a line; the printer lives on, its heater, too. */
static void test_unplug(void) {
    bench *b = bench_script("at byte 20 unplug for 30; at time 100 unplug");
    bench_ask(b, "M104 S200\n", 0.1);
    CHECK(fio_machine_plugged(b->machine));
    bench_ask(b, bench_line(1, "G1 X10"), 0.1);
    CHECK(!fio_machine_plugged(b->machine));
    CHECK_EQUAL(0, fio_machine_write(b->machine, b->now, "G90\n", 4));
    bench_expect(b, "", 29, "");
    bench_pass(b, 2);
    CHECK(fio_machine_plugged(b->machine));
    fio_state state;
    fio_virtual_printer_state(fio_machine_printer(b->machine), &state);
    CHECK_NEAR(500 - 480 * exp(-b->now / 120), state.nozzle[0], 0.1);
    bench_ask(b, "\n", 0.1); /* the rest of the line that was cut */
    bench_expect(b, bench_line(1, "G90"), 0.1, "ok\n");
    CHECK(!strstr(b->log, "G1"));
    bench_pass(b, 200 - b->now);
    CHECK(!fio_machine_plugged(b->machine));
    fio_machine_plug(b->machine, b->now);
    bench_expect(b, bench_line(2, "G90"), 0.1, "ok\n");
    bench_free(b);
}

static void test_answers_of_its_own(void) {
    bench *b = bench_script("every 5 seconds answer \"wait\"; at line 1 action pause\n"
                            "at line 2 action \"prompt_begin Filament?\"; at line 3 ok first");
    bench_expect(b, "", 16, "wait\nwait\nwait\n");
    bench_expect(b, "G90\n", 0.1, "//action:pause\nok\n");
    bench_expect(b, "G90\n", 0.1, "//action:prompt_begin Filament?\nok\n");
    bench_expect(b, "M118 later\n", 0.1, "ok\nlater\n");
    bench_free(b);
}

static void test_damage_in_a_span(void) {
    bench *b = bench_script("from line 11 to line 21 flip in 1");
    int bad = 0;
    for (int i = 0; i < 30; i++) {
        bool damaged = i >= 11 && i < 21; /* from the line after the 11th that arrives */
        char text[40];
        snprintf(text, sizeof text, "M117 message %d\n\n", i);
        bench_ask(b, text, 0.1);
        char expected[40];
        snprintf(expected, sizeof expected, "M117 message %d\n", i);
        bool arrived = strstr(b->log, expected) != NULL;
        bad += !arrived;
        if (!damaged && i != 10 && i != 21)
            CHECK(arrived);
    }
    CHECK(bad >= 9 && bad <= 14);
    bench_free(b);
    b = bench_script("at line 1 flip line 2; at line 4 cut line");
    bench_send(b, bench_line(1, "G90"));
    CHECK(!strstr(bench_ask(b, bench_line(2, "G90"), 0.1), "ok\nok\n"));
    bench_free(b);
}

static void test_heaters_that_break(void) {
    bench *b = bench_script("at time 100 heater nozzle dead");
    bench_ask(b, "M104 S60\n", 99); /* hot by 10.4 s */
    const char *heard = bench_ask(b, "", 100);
    CHECK(strstr(heard, "Error:Thermal Runaway, system stopped! Heater_ID: 0\n"
                        "Error:Printer halted. kill() called!\n"));
    bench_free(b);

    b = bench_script("at time 1 heater bed dead");
    bench_pass(b, 2);
    CHECK(!strstr(bench_ask(b, "M190 S60\n", 59), "Heating failed"));
    CHECK(strstr(bench_ask(b, "", 5), "Error:Heating failed, system stopped! Heater_ID: bed\n"));
    bench_free(b);

    b = bench_script("at time 5 heater nozzle stuck");
    heard = bench_ask(b, "", 400);
    CHECK(strstr(heard, "Error:MAXTEMP triggered, system stopped! Heater_ID: 0\n"));
    fio_state state; /* no firmware can help it */
    fio_virtual_printer_state(fio_machine_printer(b->machine), &state);
    CHECK(state.nozzle[0] > 400);
    bench_free(b);

    b = bench_script("at time 5 thermistor nozzle open; at time 9 thermistor bed short");
    bench_pass(b, 8);
    CHECK_EQUAL(0, b->used); /* cold and off: nobody is worried */
    CHECK(strstr(bench_ask(b, "M105\n", 0.1), "T:-14.00"));
    CHECK(strstr(bench_ask(b, "", 3), "Error:MAXTEMP triggered, system stopped! Heater_ID: bed\n"));
    bench_free(b);
    b = bench_script("at time 5 thermistor nozzle open");
    bench_ask(b, "M104 S200\n", 4);
    CHECK(strstr(bench_ask(b, "", 3), "Error:MINTEMP triggered, system stopped! Heater_ID: 0\n"));
    bench_free(b);
}

static void test_commands_as_moments(void) {
    bench *b = bench_script("at command G28 silent 5; every command M117 answer \"// shown\"\n"
                            "at command M400 reset");
    bench_ask(b, "G90\n", 0.1);
    bench_expect(b, "G280\nG28 X\n", 4.9, "echo:Unknown command: \"G280\"\nok\n");
    CHECK(strstr(bench_ask(b, "", 5), "ok\n"));
    bench_expect(b, "M117 a\nM117\nM1170\n", 0.1,
                 "// shown\nok\n// shown\nok\necho:Unknown command: \"M1170\"\nok\n");
    bench_expect(b, "M400\n", 0.5, "");
    CHECK(strstr(bench_ask(b, "", 1), "start\n"));
    bench_free(b);
}

static void test_demanded_checksums(void) {
    bench *b = bench_script("at time 1 demand checksums; at time 5 relax");
    bench_expect(b, "G90\n", 2, "ok\n");
    bench_expect(b, "G90\n", 0.1,
                 "Error:No Checksum with line number, Last Line: 0\nResend: 1\nok\n");
    bench_expect(b, bench_line(1, "G90"), 0.1, "ok\n");
    bench_pass(b, 5);
    bench_expect(b, "G90\n", 0.1, "ok\n");
    bench_free(b);
}

static void test_a_person_presses(void) {
    bench *b = bench_script("at time 30 press");
    bench_expect(b, "M113 S0\nM0\n", 29,
                 "ok\n//action:prompt_begin M0/1 Break Called\n//action:prompt_button Continue\n"
                 "//action:prompt_show\n");
    bench_expect(b, "", 2, "//action:prompt_end\nok\n");
    bench_free(b);
}

int main(void) {
    RUN(test_errors_say_where);
    RUN(test_lost_doubled_and_late_oks);
    RUN(test_rejections);
    RUN(test_silence);
    RUN(test_busy_and_throttle);
    RUN(test_resets_and_halts);
    RUN(test_unplug);
    RUN(test_answers_of_its_own);
    RUN(test_damage_in_a_span);
    RUN(test_heaters_that_break);
    RUN(test_commands_as_moments);
    RUN(test_demanded_checksums);
    RUN(test_a_person_presses);
    return check_verdict();
}
