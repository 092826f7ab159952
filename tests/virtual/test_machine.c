/* A machine speaks as Marlin's bugfix-2.1 does, takes its time, and loses what it has no room for.
 */
#include "bench.h"

static void test_numbers_and_checksums(void) {
    bench *b = bench_make(bench_options());
    bench_expect(b, "G90\n", 0.1, "ok\n");
    bench_expect(b, "N0 M110 N0*125\n", 0.1, "ok\n"); /* as OctoPrint greets */
    bench_expect(b, bench_line(1, "G91"), 0.1, "ok\n");
    bench_expect(b, "N2 G1 X10*1\n", 0.1, "Error:checksum mismatch, Last Line: 1\nResend: 2\nok\n");
    bench_expect(b, "N2 G1 X10\n", 0.1,
                 "Error:No Checksum with line number, Last Line: 1\nResend: 2\nok\n");
    /* The number is looked at first: this has a wrong checksum as well. */
    bench_expect(b, "N5 G1 X10*1\n", 0.1,
                 "Error:Line Number is not Last Line Number+1, Last Line: 1\nResend: 2\nok\n");
    bench_expect(b, bench_line(2, "G90"), 0.1, "ok\n");
    bench_expect(b, bench_line(2, "G90"), 0.1, ""); /* just had: dropped without an ok */
    bench_expect(b, bench_line(1, "G90"), 0.1, "");
    bench_expect(b, bench_line(0, "G90"), 0.1,
                 "Error:Line Number is not Last Line Number+1, Last Line: 2\nResend: 3\nok\n");
    bench_expect(b, bench_line(700, "M110 N41"), 0.1, "ok\n"); /* its second N wins */
    bench_expect(b, bench_line(42, "M117 a*b"), 0.1, "ok\n");
    bench_expect(b, "M110 N7\n", 0.1, "ok\n");
    bench_expect(b, bench_line(8, "G90"), 0.1, "ok\n");
    bench_expect(b, "n9 G90*5\n", 0.1, "echo:Unknown command: \"n9 G90\"\nok\n"); /* no number */
    CHECK(!strcmp(b->log, "G90\nM110 N0\nG91\nG90\nM110 N41\nM117 a*b\nM110 N7\nG90\n"));
    bench_free(b);

    fio_machine_options options = bench_options();
    options.case_insensitive = true;
    b = bench_make(options);
    bench_expect(b, "n9 G90*5\n", 0.1,
                 "Error:Line Number is not Last Line Number+1, Last Line: 0\nResend: 1\nok\n");
    bench_free(b);
}

static void test_reading(void) {
    bench *b = bench_make(bench_options());
    bench_expect(b, "; nothing\n\r\n\n", 0.1, "");
    bench_expect(b, "G90 ; a comment\r\n", 0.1, "ok\n");
    bench_expect(b, "M118 a\\;b\n", 0.1, "a;b\nok\n"); /* escaped */
    bench_expect(b, "M118 (a)\n", 0.1, "(a)\nok\n");   /* no comment, as Marlin is delivered */
    bench_expect(b, "M118 ab\bc\n", 0.1, "ac\nok\n");  /* rubbed out */
    char line[200], expected[200];
    memset(line, 'x', sizeof line);
    memcpy(line, "M118 ", 5);
    snprintf(line + 120, 2, "\n");
    snprintf(expected, sizeof expected, "%.90s\nok\n", line + 5); /* 95 bytes are kept */
    bench_expect(b, line, 0.1, expected);
    bench_expect(b, "M105 X\nG90\n", 0.1, "ok T:20.00 /0.00 B:20.00 /0.00 @:0 B@:0\nok\n");
    bench_free(b);
}

/* A small buffer is enough for long lines, as long as nothing else has to be done. */
static void test_small_buffer(void) {
    fio_machine_options options = bench_options();
    options.receive_bytes = 16;
    bench *b = bench_make(options);
    bench_expect(b,
                 "M118 0123456789012345678901234567890123456789 ; and a comment of some length\n",
                 0.1, "0123456789012345678901234567890123456789\nok\n");
    CHECK_EQUAL(0, fio_machine_count(b->machine)->overruns);
    bench_free(b);
}

static void test_advanced_ok(void) {
    fio_machine_options options = bench_options();
    options.advanced_ok = true;
    bench *b = bench_make(options);
    bench_expect(b, bench_line(1, "G92 E0"), 0.1, "ok N1 P15 B3\n");
    bench_expect(b, "G92 E0\n", 0.1, "ok P15 B3\n");
    bench_expect(b, bench_line(2, "M105"), 0.1, "ok T:20.00 /0.00 B:20.00 /0.00 @:0 B@:0\n");
    bench_free(b);
}

/* Seconds until the whole answer is there. */
static double time_of(bench *b, const char *text, const char *answer) {
    double start = b->now;
    b->used = 0;
    b->heard[0] = 0;
    bench_send(b, text);
    while (!strstr(b->heard, answer) && b->now < start + 100) {
        b->now = fio_machine_next(b->machine);
        bench_hear(b);
    }
    return b->now - start;
}

static void test_time_on_the_wire(void) {
    fio_machine_options options = bench_options();
    options.line_seconds = 0.002;
    bench *b = bench_make(options);
    bench_pass(b, 1);
    /* "G90\n" is 4 bytes, "ok\n" 3, of 10 bits each. */
    CHECK_NEAR(7 * 10 / 250000. + 0.002, time_of(b, "G90\n", "ok\n"), 1e-9);
    bench_pass(b, 1);
    options.rate = 9600;
    bench *slow = bench_make(options);
    CHECK_NEAR(7 * 10 / 9600. + 0.002, time_of(slow, "G90\n", "ok\n"), 1e-9);
    CHECK_NEAR(1.5 + 11 * 10 / 9600. + 0.002, time_of(slow, "G4 S1.5\n", "ok\n"), 1e-9);
    options.rate = 0;
    bench *native = bench_make(options);
    CHECK_NEAR(0.002, time_of(native, "G90\n", "ok\n"), 1e-9);
    bench_free(b);
    bench_free(slow);
    bench_free(native);
}

/* 40 lines at once into 128 bytes: what fits is answered, then the gap is noticed and everything
 * after it asks for the same line. A simulated ATmega2560 gave 15 oks and two Resends. */
static void test_burst_overruns(void) {
    fio_machine_options options = bench_options();
    options.line_seconds = 0.003; /* of an ATmega: 370 lines a second */
    bench *b = bench_make(options);
    char burst[2000] = "";
    for (int i = 1; i <= 40; i++)
        strcat(burst, bench_line(i, "G92 E0"));
    const char *heard = bench_ask(b, burst, 5);
    const char *resend = strstr(heard, "Resend: ");
    int wanted = resend ? atoi(resend + 8) : 0, asked = bench_count(heard, "Resend: ");
    char word[32];
    snprintf(word, sizeof word, "Resend: %d\n", wanted);
    CHECK(wanted > 5 && wanted < 30);
    CHECK(asked >= 1 && asked == bench_count(heard, word));
    CHECK_EQUAL(wanted - 1 + asked, bench_count(heard, "ok\n"));
    CHECK(fio_machine_count(b->machine)->overruns > 0);
    CHECK_EQUAL(wanted - 1, b->entries);
    CHECK_EQUAL(0, fio_machine_count(b->machine)->undetectable);
    bench_expect(b, bench_line(wanted, "G92 E0"), 0.1, "ok\n");
    bench_free(b);

    /* Longer lines: while the first Resend is said, more of the burst comes in. */
    b = bench_make(options);
    burst[0] = 0;
    for (int i = 1; i <= 40; i++)
        strcat(burst, bench_line(i, "G92 E0.1234"));
    heard = bench_ask(b, burst, 5);
    CHECK_EQUAL(2, bench_count(heard, "Resend: "));
    CHECK_EQUAL(2, bench_count(heard, "Resend: 13\n"));
    bench_free(b);
}

/* Over native USB nothing is lost: the host is held back. */
static void test_native_holds_back(void) {
    fio_machine_options options = bench_options();
    options.rate = 0;
    options.line_seconds = 0.003;
    bench *b = bench_make(options);
    char burst[20000] = "";
    for (int i = 1; i <= 400; i++)
        strcat(burst, bench_line(i, "G92 E0"));
    const char *heard = bench_ask(b, burst, 5);
    CHECK_EQUAL(400, bench_count(heard, "ok\n"));
    CHECK_EQUAL(0, bench_count(heard, "Resend"));
    CHECK_EQUAL(400, b->entries);
    bench_ask(b, "G4 S2\n", 0);
    size_t taken = fio_machine_write(b->machine, b->now, burst, 1000);
    CHECK(taken > 100 && taken < 600);
    CHECK_EQUAL(0, fio_machine_room(b->machine));
    bench_free(b);
}

static void test_long_commands(void) {
    bench *b = bench_make(bench_options());
    /* An axis not homed travels half of its length: 125/50 + 105/50 + 105/8 s. */
    const char *heard = bench_ask(b, "G28\n", 17.7);
    CHECK_EQUAL(8, bench_count(heard, "echo:busy: processing\n"));
    CHECK(!strstr(heard, "ok"));
    bench_expect(b, "", 0.1, "ok\n");
    bench_expect(b, "M113\n", 0.1, "echo:M113 S2\nok\n");
    bench_ask(b, "M113 S1\n", 0.1);
    CHECK_EQUAL(4, bench_count(bench_ask(b, "G4 S4.5\n", 5), "busy"));
    bench_ask(b, "M113 S0\n", 0.1);
    CHECK_EQUAL(0, bench_count(bench_ask(b, "G4 S4.5\n", 5), "busy"));
    /* Waits for a heater tell the temperature every second: (500 - T) falls as exp(-t/120). */
    double seconds = 120 * log((500 - 20.) / (500 - 60));
    heard = bench_ask(b, "M109 S60\n", seconds - 0.01);
    CHECK(!strstr(heard, "ok"));
    CHECK_EQUAL(floor(seconds), bench_count(heard, " T:"));
    CHECK(strstr(heard, " /60.00 B:20.00 /0.00 @:0 B@:0 W:?\n"));
    bench_expect(b, "", 0.1, "ok\n");
    bench_free(b);
}

static void test_full_planner_holds_the_ok(void) {
    bench *b = bench_make(bench_options());
    bench_ask(b, "G28\n", 20);
    bench_expect(b, "", 1, "");
    char moves[800] = "";
    for (int i = 1; i <= 16; i++)
        sprintf(moves + strlen(moves), "G1 X%d F60\n", i); /* 1 mm/s */
    double before = b->now;
    /* 15 places, then each waits for the end of one. The wire is given time between them. */
    for (char *line = strtok(moves, "\n"); line; line = strtok(NULL, "\n")) {
        char text[40];
        snprintf(text, sizeof text, "%s\n", line);
        CHECK_EQUAL(
            1,
            bench_count(bench_ask(b, text, line[4] == '1' && line[5] == '6' ? 1.5 : 0.002), "ok"));
    }
    CHECK(b->now > before + 0.5);
    CHECK_EQUAL(1, b->entries - 1); /* G28 and the first move are done */
    CHECK_EQUAL(1, bench_count(bench_ask(b, "M400\n", 20), "ok"));
    CHECK_EQUAL(18, b->entries);
    CHECK_EQUAL(0, fio_machine_count(b->machine)->starved);
    bench_free(b);
}

static void test_starving(void) {
    bench *b = bench_make(bench_options());
    bench_ask(b, "M302 P1\nG28\nM83\n", 20);
    bench_ask(b, "G1 X10 E1 F6000\n", 1);
    bench_ask(b, "G1 X20 E1\n", 1); /* the first was done long before */
    CHECK_EQUAL(1, fio_machine_count(b->machine)->starved);
    bench_ask(b, "G1 X30 E1\nG1 X40 E1\nM400\n", 2); /* once more; then it was told to wait */
    CHECK_EQUAL(2, fio_machine_count(b->machine)->starved);
    bench_ask(b, "G1 X10 E1\nG1 X20 E1\n", 1);
    CHECK_EQUAL(2, fio_machine_count(b->machine)->starved);
    bench_free(b);
}

static void test_emergencies(void) {
    bench *b = bench_make(bench_options());
    CHECK(strstr(bench_ask(b, "M115\n", 0.5), "Cap:EMERGENCY_PARSER:1\n"));
    /* M108 ends a wait, out of band, and is queued as well. */
    bench_ask(b, "M109 S200\n", 5);
    CHECK_EQUAL(2, bench_count(bench_ask(b, "M108\n", 0.1), "ok\n"));
    fio_state state;
    fio_virtual_printer_state(fio_machine_printer(b->machine), &state);
    CHECK(state.nozzle[0] > 35 && state.nozzle[0] < 45 && state.nozzle_target[0] == 200);
    /* A stop behind a full queue acts at the end of its line; then it is mute. */
    bench_ask(b, "G4 S100\nG4 S1\nG4 S1\nG4 S1\nG4 S1\n", 1);
    bench_expect(b, "M112\n", 0.1,
                 "echo:M112 Shutdown\nError:Printer halted. kill() called!\n//action:poweroff\n");
    bench_expect(b, "M105\nM999\n", 10, "");
    fio_virtual_printer_state(fio_machine_printer(b->machine), &state);
    CHECK(state.halted && state.nozzle_target[0] == 0);
    CHECK(isinf(fio_machine_next(b->machine)));
    bench_free(b);

    fio_machine_options options = bench_options();
    options.emergency_parser = false;
    b = bench_make(options);
    bench_ask(b, "G4 S10\nG4 S1\nG4 S1\nG4 S1\n", 0.5); /* no slot is free to read it */
    CHECK(!strstr(bench_ask(b, "M112\n", 5), "halted"));
    CHECK(strstr(bench_ask(b, "", 10), "halted"));
    bench_free(b);
}

/* M410 stops where it is, and it knows where that is. */
static void test_quick_stop(void) {
    bench *b = bench_make(bench_options());
    bench_ask(b, "G28\n", 20);
    bench_ask(b, "G1 X100 F600\nG1 X0\nM117 after\n", 5.1); /* 10 mm/s, 0.1 s after it came */
    bench_ask(b, "M410\n", 0.1);
    fio_state state;
    fio_virtual_printer_state(fio_machine_printer(b->machine), &state);
    CHECK_NEAR(50, state.machine[0], 0.1);
    CHECK(!strstr(b->log, "G1") && strstr(b->log, "M117 after\n"));
    bench_ask(b, "G1 X60\nM400\n", 2);
    CHECK(strstr(b->log, "G1 X60\n"));
    bench_free(b);
}

/* A processor that hangs answers no emergency until it is back. */
static void test_emergency_while_it_hangs(void) {
    fio_machine_options options = bench_options();
    options.script = "at line 1 silent 10";
    bench *b = bench_make(options);
    bench_expect(b, "G90\nM112\n", 9, "");
    CHECK_NEAR(10, fio_machine_next(b->machine), 0.01);
    CHECK(strstr(bench_ask(b, "", 2), "kill() called!"));
    bench_free(b);
}

/* It once took an endless time for one in which an endless number of bytes arrive. */
static void test_endless_times(void) {
    bench *b = bench_make(bench_options());
    bench_ask(b, "G1 X10 F600\n", 0.2);
    fio_machine_advance(b->machine, INFINITY);
    fio_machine_advance(b->machine, NAN);
    fio_machine_advance(b->machine, -1);
    CHECK(isinf(fio_machine_next(b->machine)));
    CHECK(strstr(bench_ask(b, "M114\n", 0.1), "ok\n"));
    CHECK(fio_machine_finish(b->machine) == FIO_FAULTY); /* it was never homed */
    CHECK(!strcmp(b->log, "G1 X10 F600\nM114\n"));
    CHECK_NEAR(1.1, b->last_start, 0.05);
    bench_free(b);
}

static void test_user_waits(void) {
    bench *b = bench_make(bench_options());
    const char *heard = bench_ask(b, "M0\n", 10);
    CHECK_EQUAL(4, bench_count(heard, "echo:busy: paused for user\n"));
    CHECK_EQUAL(0, bench_count(heard, "ok"));
    CHECK_EQUAL(2, bench_count(bench_ask(b, "M108\n", 0.1), "ok\n"));
    bench_ask(b, "M600\n", 3);
    CHECK_EQUAL(2, bench_count(bench_ask(b, "M876 S1\n", 0.1), "ok\n"));
    CHECK_EQUAL(1, bench_count(bench_ask(b, "M0 S2\n", 2.1), "ok\n"));
    bench_free(b);
}

static void test_reports_of_itself(void) {
    bench *b = bench_make(bench_options());
    const char *heard = bench_ask(b, "M155 S2\n", 10.5);
    CHECK_EQUAL(5, bench_count(heard, " T:20.00 /0.00 B:20.00 /0.00 @:0 B@:0\n"));
    CHECK_EQUAL(1, bench_count(heard, "ok"));
    bench_ask(b, "M155 S0\nM154 S1\n", 0.1);
    CHECK_EQUAL(3, bench_count(bench_ask(b, "", 3), "X:0.00 Y:0.00 Z:0.00 E:0.00 Count X:0"));
    bench_free(b);
}

static void test_reset_by_dtr(void) {
    fio_machine_options options = bench_options();
    options.reset_on_dtr = true;
    bench *b = bench_make(options);
    bench_ask(b, "G91\nM104 S50\n", 1);
    bench_send(b, bench_line(1, "G91"));
    bench_pass(b, 0.1);
    b->used = 0;
    fio_machine_set_lines(b->machine, b->now, true, true);
    bench_expect(b, "G90\n", 0.9, ""); /* its loader hears nothing */
    CHECK(!strncmp(bench_ask(b, "", 0.2), "start\n", 6));
    fio_state state;
    fio_virtual_printer_state(fio_machine_printer(b->machine), &state);
    CHECK(state.absolute && state.line_number == 0 && state.nozzle_target[0] == 0);
    CHECK(state.nozzle[0] > 20.1); /* it does not cool at once */
    CHECK_EQUAL(1, fio_machine_count(b->machine)->resets);
    fio_machine_set_lines(b->machine, b->now, true, false);
    fio_machine_set_lines(b->machine, b->now, false, false);
    CHECK_EQUAL(1, fio_machine_count(b->machine)->resets);
    bench_free(b);
}

static void test_wrong_rate_is_rubbish(void) {
    bench *b = bench_make(bench_options());
    fio_machine_set_rate(b->machine, 0, 115200);
    CHECK(!strstr(bench_ask(b, "M105\nM105\nM105\nM105\n", 1), "ok"));
    fio_machine_set_rate(b->machine, b->now, 250000);
    bench_ask(b, "\n", 1);
    CHECK_EQUAL(1, bench_count(bench_ask(b, "M105\n", 1), "ok T:"));
    bench_free(b);
}

int main(void) {
    RUN(test_numbers_and_checksums);
    RUN(test_reading);
    RUN(test_small_buffer);
    RUN(test_advanced_ok);
    RUN(test_time_on_the_wire);
    RUN(test_burst_overruns);
    RUN(test_native_holds_back);
    RUN(test_long_commands);
    RUN(test_full_planner_holds_the_ok);
    RUN(test_starving);
    RUN(test_emergencies);
    RUN(test_quick_stop);
    RUN(test_emergency_while_it_hangs);
    RUN(test_endless_times);
    RUN(test_user_waits);
    RUN(test_reports_of_itself);
    RUN(test_reset_by_dtr);
    RUN(test_wrong_rate_is_rubbish);
    return check_verdict();
}
