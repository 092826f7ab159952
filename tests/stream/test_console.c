/* Sources that are no file, consoles, and firmwares that are fed otherwise. */
#include "dialogue.h"

typedef struct dry_source {
    int given, dry; /* commands before it runs dry; then for how many questions */
    bool fails;
} dry_source;

static fio_source_result dry_next(void *context, fio_source_command *command) {
    dry_source *source = context;
    if (source->given == 2 && source->fails) {
        (void)fio_fail(FIO_UNREADABLE, "the disk is on fire");
        return FIO_SOURCE_FAILED;
    }
    if (source->given == 2 && source->dry-- > 0)
        return FIO_SOURCE_LATER;
    if (source->given == 4)
        return FIO_SOURCE_END;
    *command = (fio_source_command){
        .text = "G90", .length = 3, .index = source->given, .line = source->given + 1};
    source->given++;
    return FIO_SOURCE_COMMAND;
}

static dialogue *dialogue_with(dry_source *source) {
    dialogue *d = calloc(1, sizeof *d);
    fio_stream_source from = {.next = dry_next, .context = source};
    fio_stream_listener listener = {dialogue_hear, d};
    d->now = 100;
    CHECK_EQUAL(FIO_OK, fio_streamer_create(&d->streamer, NULL, &from, NULL, &listener));
    fio_streamer_tick(d->streamer, d->now);
    greet(d);
    EXPECT_COMMAND("G90", d);
    say(d, "ok");
    EXPECT_COMMAND("G90", d);
    say(d, "ok");
    return d;
}

static void test_a_source_that_has_nothing_yet_is_waited_for(void) {
    dry_source source = {.dry = 2};
    dialogue *d = dialogue_with(&source);
    EXPECT_SILENCE(d);
    d->now += 0.7;
    EXPECT_SILENCE(d);
    d->now += 0.2;
    EXPECT_COMMAND("G90", d);
    CHECK_NEAR(0.9, dialogue_report(d)->idle, 1e-9);
    CHECK_EQUAL(FIO_STREAM_RUNNING, dialogue_report(d)->state);
    dialogue_end(d);
}

static void test_a_source_that_fails_ends_with_heaters_off(void) {
    dry_source source = {.fails = true};
    dialogue *d = dialogue_with(&source);
    end_with_heaters_off(d);
    CHECK_EQUAL(FIO_UNREADABLE, dialogue_report(d)->status);
    CHECK(strstr(dialogue_report(d)->message, "on fire"));
    dialogue_end(d);
}

static void test_a_console_runs_until_it_is_left(void) {
    dialogue *d = dialogue_begin(NULL, NULL, NULL);
    CHECK_EQUAL(FIO_USAGE, fio_streamer_command(d->streamer, d->now, "M114"));
    greet(d);
    EXPECT_SILENCE(d);
    CHECK_EQUAL(FIO_OK, fio_streamer_command(d->streamer, d->now, "  M114 ; where"));
    EXPECT_COMMAND("M114", d);
    say(d, "X:0.00 Y:0.00 Z:0.00 E:0.00 Count X:0 Y:0 Z:0");
    say(d, "ok");
    CHECK_EQUAL(FIO_OK, fio_streamer_command(d->streamer, d->now, "M108"));
    EXPECT_COMMAND("M108", d); /* out of band, without a number */
    fio_streamer_finish(d->streamer, d->now);
    expect_marker(d);
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    CHECK_EQUAL(FIO_OK, dialogue_report(d)->status);
    CHECK_EQUAL(FIO_USAGE, fio_streamer_command(d->streamer, d->now, "M114"));
    dialogue_end(d);
}

static void test_temperatures_are_asked_for_where_they_do_not_come(void) {
    dialogue *d = dialogue_begin(NULL, NULL, NULL);
    greet(d);
    int asked = 0;
    double end = d->now + 20;
    while (d->now < end) {
        pass_until_output(d, end - d->now);
        char command[600];
        snprintf(command, sizeof command, "%s", take_command(d));
        if (strcmp(command, "M105") == 0) {
            asked++;
            say(d, "ok T:205.50 /210.00 B:60.10 /60.00 @:64 B@:0");
        } else if (command[0]) {
            answer(d, command);
        }
    }
    CHECK(asked >= 8 && asked <= 11);
    CHECK_NEAR(205.5, dialogue_report(d)->nozzle, 1e-9);
    CHECK_NEAR(210, dialogue_report(d)->nozzle_target, 1e-9);
    CHECK_NEAR(60, dialogue_report(d)->bed_target, 1e-9);
    dialogue_end(d);
}

static void test_heaters_that_are_told_to_be_on_are_switched_off_again(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    greet(d);
    EXPECT_COMMAND("G90", d);
    say(d, "ok");
    fio_streamer_cancel(d->streamer, d->now);
    const char *const off[] = {"M104 S0", "M140 S0", "M107"};
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < 3; i++) {
            EXPECT_COMMAND(off[i], d);
            say(d, "ok");
        }
        EXPECT_COMMAND("M105", d);
        d->now += 0.1;
        say(d,
            round == 0 ? "ok T:205.50 /210.00 B:60.10 /0.00" : "ok T:205.50 /0.00 B:60.10 /0.00");
        expect_marker(d);
    }
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    CHECK(dialogue_report(d)->heaters_off);
    dialogue_end(d);
}

static void test_grbl_is_fed_by_characters(void) {
    dialogue *d = dialogue_begin(NULL, five, NULL);
    say(d, "Grbl 1.1h ['$' for help]");
    pass(d, 0.5);
    int lines = 0, bytes = 0;
    for (const char *line; (line = take(d)); lines++) {
        CHECK(line[0] == 'G' || line[0] == 'M'); /* no numbers */
        bytes += (int)strlen(line) + 1;
    }
    CHECK_EQUAL(11, lines); /* all ten, and G4 P0 behind them */
    CHECK(bytes <= 127);
    dialogue_end(d);
}

static void test_upload_goes_into_a_file(void) {
    fio_stream_options options = fio_stream_options_defaults();
    options.upload = "part.gco";
    dialogue *d = dialogue_begin(&options, "G90\nG1 X1\n", NULL);
    greet(d);
    EXPECT_COMMAND("M28 part.gco", d);
    say(d, "Writing to file: part.gco");
    say(d, "ok");
    EXPECT_COMMAND("G90", d);
    say(d, "ok");
    EXPECT_COMMAND("G1 X1", d);
    say(d, "ok");
    EXPECT_COMMAND("M29", d); /* nothing of the host's own stands in the file */
    say(d, "Done saving file.");
    say(d, "ok");
    expect_marker(d);
    CHECK_EQUAL(FIO_OK, dialogue_report(d)->status);
    CHECK_EQUAL(FIO_STREAM_DONE, dialogue_report(d)->state);
    dialogue_end(d);
}

int main(void) {
    RUN(test_a_source_that_has_nothing_yet_is_waited_for);
    RUN(test_a_source_that_fails_ends_with_heaters_off);
    RUN(test_a_console_runs_until_it_is_left);
    RUN(test_temperatures_are_asked_for_where_they_do_not_come);
    RUN(test_heaters_that_are_told_to_be_on_are_switched_off_again);
    RUN(test_grbl_is_fed_by_characters);
    RUN(test_upload_goes_into_a_file);
    return check_verdict();
}
