/* Each firmware that isoprint knows, as the virtual printer speaks for it: a job is printed once,
 * with the commands that this firmware has, and what goes wrong is told in its own words.
 *
 *     test-stream-firmwares [--print] [--verbose NAME] */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <isoprint/machine.h>

#include "check.h"
#include "protocol/source.h"
#include "stream/session.h"

enum { COMMANDS = 400, WORDS_MOST = 28, SENT_MOST = 1 << 17 };

typedef struct speaker {
    const char *name;
    fio_firmware_kind kind;
    bool counts; /* numbered lines that come again until they are right */
    bool heats;
    const char *words[WORDS_MOST]; /* what the host may say of itself */
} speaker;

#define MOVING "G1", "G21", "G90", "G91", "G92"
#define MARLINISH                                                                                  \
    "M82", "M83", "M104", "M105", "M106", "M107", "M109", "M110", "M114", "M115", "M140", "M190",  \
        "M220", "M221", "M400", MOVING

/* M118 is Marlin's since 1.1.2 and Prusa's since 3.9; RepRapFirmware has one with another syntax,
 * Klipper only where [respond] is configured. M155 goes only to those that announce it. */
static const speaker speakers[] = {
    /* in the order of the enum below */
    {"marlin", FIO_FIRMWARE_MARLIN, true, true, {MARLINISH, "M108", "M118", "M155"}},
    {"prusa", FIO_FIRMWARE_PRUSA, true, true, {MARLINISH, "M118", "M155"}},
    {"repetier", FIO_FIRMWARE_REPETIER, true, true, {MARLINISH}},
    {"smoothie", FIO_FIRMWARE_SMOOTHIE, true, true, {MARLINISH}},
    {"reprapfirmware", FIO_FIRMWARE_REPRAP, false, true, {MARLINISH}},
    {"klipper", FIO_FIRMWARE_KLIPPER, false, true, {MARLINISH, "TURN_OFF_HEATERS", "M109", "M190"}},
    {"grbl",
     FIO_FIRMWARE_GRBL,
     false,
     false,
     {MOVING, "G4", "M5", "M9", "$I", "?", "M110", "M115"}},
};
enum { MARLIN, PRUSA, REPETIER, SMOOTHIE, REPRAP, KLIPPER, GRBL, SPEAKERS };

typedef enum act { NOTHING, PAUSE, CANCEL, STOP } act;

typedef struct job_plan {
    fio_machine_options machine;
    fio_stream_options stream;
    act act;
    int at; /* command of the job */
} job_plan;

typedef struct printing {
    const speaker *who;
    job_plan plan;
    fio_machine *machine;
    fio_streamer *streamer;
    fio_firmware firmware; /* as it was found out */
    int next, made, wrong; /* commands, in their turn: executed, and also moved */
    char first_wrong[160], foreign[160];
    char sent[SENT_MOST]; /* the host's own commands, each followed by a blank line end */
    size_t sent_length;
    bool acted, was_paused, hung, loud;
    double acted_at, began, reached; /* the 20th and the 270th line of the job were sent */
    int job_lines;
    fio_status status;
    fio_stream_report report;
    char message[600];
    double seconds;
} printing;

static bool print_all;
static const char *verbose;

static char job[COMMANDS * 64];
static size_t job_length;
static int job_commands;
static int dwell_every; /* moves; 0: never */

/* A command ends with " K" and its index, a word that no firmware looks at. */
static void add(const char *command) {
    job_length += (size_t)snprintf(job + job_length, sizeof job - job_length, "%s K%d\n", command,
                                   job_commands++);
}

static void make_job(const speaker *who, int moves, double step) {
    char command[64];
    static const char *const heat[] = {"M140 S60", "M104 S200", "G28", "M109 S200", "M106 S0"};
    job_length = 0;
    job_commands = 0;
    for (size_t i = 0; who->heats && i < sizeof heat / sizeof *heat; i++)
        add(heat[i]);
    add("G21");
    add("G90");
    add("G1 X20 Y20 Z0.3 F6000");
    for (int i = 0; i < moves; i++) {
        snprintf(command, sizeof command, "G1 X%.3f Y%.3f F6000", 20 + step * (1 + i % 40),
                 20 + step * (i % 7));
        add(command);
        if (dwell_every > 0 && i % dwell_every == dwell_every - 1)
            add("G4 P300");
    }
    if (who->heats)
        add("M104 S0");
    if (who->heats)
        add("M140 S0");
    add("G1 X1 Y1 F6000");
}

static void executed(void *context, const fio_executed *entry) {
    printing *p = context;
    const char *key = strrchr(entry->text, 'K');
    if (p->loud)
        printf("%10.4f ** %s (N%lld)\n", entry->start, entry->text, (long long)entry->number);
    if (!key || key == entry->text || key[-1] != ' ' || !strchr("GM", entry->text[0]))
        return;
    int index = atoi(key + 1);
    if (index != p->next || index >= job_commands) {
        if (p->wrong++ == 0)
            snprintf(p->first_wrong, sizeof p->first_wrong, "%.80s where %d was next", entry->text,
                     p->next);
        return;
    }
    bool move = entry->text[0] == 'G' && entry->text[1] == '1';
    if (p->made == index && (!move || entry->duration > 0)) /* else a reset threw it away */
        p->made = index + 1;
    p->next = index + 1;
}

/* The host's own words, without number and checksum. */
static void note_sent(printing *p, double time, const char *text, size_t length) {
    char line[200];
    snprintf(line, sizeof line, "%.*s", (int)length, text);
    if (strrchr(line, 'K') && strrchr(line, 'K')[-1] == ' ') { /* the job's */
        if (++p->job_lines == 20)
            p->began = time;
        else if (p->job_lines == 270)
            p->reached = time;
        return;
    }
    char *start = line, *star = strrchr(line, '*');
    if (line[0] == 'N') {
        start += 1 + strspn(line + 1, "0123456789");
        start += strspn(start, " ");
        if (star)
            *star = 0;
    }
    for (char *part = strtok(start, "\n"); part; part = strtok(NULL, "\n")) {
        bool known = part[0] == 0x18 || strncmp(part, "M112", 4) == 0;
        size_t word = strcspn(part, " ");
        for (int i = 0; i < WORDS_MOST && p->who->words[i] && !known; i++) {
            const char *may = p->who->words[i];
            size_t zeros = strspn(part + 1, "0"); /* "M0118" */
            if (strlen(may) == word - zeros)
                known = part[0] == may[0] && !strncmp(part + 1 + zeros, may + 1, word - zeros - 1);
        }
        if (!known && !p->foreign[0])
            snprintf(p->foreign, sizeof p->foreign, "%s", part);
        int written = snprintf(p->sent + p->sent_length, SENT_MOST - p->sent_length, "%s\n", part);
        if (written > 0 && (size_t)written < SENT_MOST - p->sent_length)
            p->sent_length += (size_t)written;
    }
}

static bool has_sent(const printing *p, const char *command) {
    size_t length = strlen(command);
    char disguised[64]; /* as emergency parsers could take "M400" for M410 after one flipped bit */
    snprintf(disguised, sizeof disguised, "%c0%s", command[0], command + 1);
    if (command[1] != '0' && command[1] && strstr(p->sent, disguised))
        return true;
    for (const char *at = p->sent; (at = strstr(at, command)) != NULL; at += length)
        if ((at == p->sent || at[-1] == '\n') && at[length] == '\n')
            return true;
    return false;
}

static void listen(void *context, const fio_stream_event *event) {
    printing *p = context;
    if (p->loud && event->text)
        printf("%10.4f %s %.*s\n", event->time, event->kind == FIO_STREAM_SENT ? ">" : "  <",
               (int)event->length, event->text);
    if (event->kind == FIO_STREAM_SENT)
        note_sent(p, event->time, event->text, event->length);
    if (event->kind == FIO_STREAM_FIRMWARE)
        p->firmware = *event->firmware;
    p->was_paused =
        p->was_paused || (event->kind == FIO_STREAM_STATE && event->state == FIO_STREAM_PAUSED);
}

static fio_source_result next(void *context, fio_source_command *command) {
    return fio_source_next(context, command);
}

static fio_status seek(void *context, int64_t index) {
    return fio_source_seek(context, index);
}

static void woken(void *context, double now, const struct pollfd *polls, int count) {
    printing *p = context;
    (void)polls, (void)count;
    if (now > 4000) {
        p->hung = true;
        fio_streamer_lost(p->streamer, now, FIO_BUG, "hung");
    }
    if (fio_streamer_report(p->streamer)->state == FIO_STREAM_PAUSED)
        fio_streamer_resume(p->streamer, now);
    if (p->plan.act == NOTHING || p->acted || p->next < p->plan.at)
        return;
    p->acted = true;
    p->acted_at = now;
    if (p->plan.act == PAUSE)
        fio_streamer_pause(p->streamer, now);
    else if (p->plan.act == CANCEL)
        fio_streamer_cancel(p->streamer, now);
    else
        fio_streamer_emergency(p->streamer, now);
}

static job_plan usual(const speaker *who) {
    job_plan plan = {.machine = fio_machine_options_defaults(),
                     .stream = fio_stream_options_defaults()};
    plan.machine.firmware = who->name;
    plan.machine.reset_on_dtr = false;
    bool native = who->kind == FIO_FIRMWARE_KLIPPER || who->kind == FIO_FIRMWARE_REPRAP;
    plan.machine.rate = plan.stream.rate = native ? 0 : 115200; /* pty, USB */
    return plan;
}

static printing *print_from(const speaker *who, const job_plan *plan,
                            const fio_stream_resume *resume, fio_machine *machine, double start) {
    printing *p = calloc(1, sizeof *p);
    fio_transport *transport;
    fio_source *source;
    p->who = who;
    p->plan = *plan;
    p->plan.machine.log = (fio_execution_log){executed, p};
    p->machine = machine;
    if ((!machine && fio_machine_create(&p->machine, &p->plan.machine) != FIO_OK) ||
        fio_machine_transport(&transport, p->machine, start, 0) != FIO_OK ||
        fio_source_memory(&source, job, job_length) != FIO_OK) {
        fprintf(stderr, "no printing: %s\n", fio_error_message());
        exit(1);
    }
    fio_stream_source from = {next, seek, source};
    fio_stream_listener listener = {listen, p};
    fio_session_hooks hooks = {.woken = woken, .period = 0.05, .context = p};
    if (fio_streamer_create(&p->streamer, &plan->stream, &from, resume, &listener) != FIO_OK)
        exit(1);
    p->loud = verbose && !strcmp(verbose, who->name);
    p->status = fio_session_run(transport, p->streamer, &hooks);
    p->seconds = fio_transport_now(transport);
    p->report = *fio_streamer_report(p->streamer);
    snprintf(p->message, sizeof p->message, "%s", p->report.message);
    fio_machine_advance(p->machine, p->seconds + 300);
    fio_streamer_free(p->streamer);
    fio_source_close(source);
    fio_transport_close(transport);
    return p;
}

static printing *print(const speaker *who, const job_plan *plan) {
    return print_from(who, plan, NULL, NULL, 0);
}

static void done(printing *p) {
    fio_machine_free(p->machine);
    free(p);
}

static void fail(const printing *p, const char *what, const char *detail) {
    check_failures++;
    fprintf(stderr, "%s: %s: %s\n", p->who->name, what, detail);
}

/* The whole job, each command once and in its turn, with no word that this firmware does not know.
 */
static void check_whole(const printing *p) {
    char detail[700];
    check_count += 4;
    snprintf(detail, sizeof detail, "%d of %d, status %d, %s", p->next, job_commands, p->status,
             p->message);
    if (p->status != FIO_OK || p->next != job_commands)
        fail(p, "not done", detail);
    if (p->wrong)
        fail(p, "executed otherwise", p->first_wrong);
    if (p->foreign[0])
        fail(p, "the host said what this firmware does not know", p->foreign);
    if (p->firmware.kind != p->who->kind)
        fail(p, "taken for", p->firmware.name ? p->firmware.name : "nothing");
}

static bool is_cold(const printing *p) {
    fio_state state;
    fio_virtual_printer_state(fio_machine_printer(p->machine), &state);
    return state.nozzle_target[0] == 0 && state.bed_target == 0;
}

static void test_a_job_is_printed_once_on_each(void) {
    for (int i = 0; i < SPEAKERS; i++) {
        make_job(&speakers[i], 200, 1);
        job_plan plan = usual(&speakers[i]);
        printing *p = print(&speakers[i], &plan);
        check_whole(p);
        CHECK_EQUAL(0, p->report.resends);
        CHECK_EQUAL(0, fio_machine_count(p->machine)->overruns);
        done(p);
    }
}

static void test_answers_lost_doubled_and_late(void) {
    int stopped[SPEAKERS] = {0};
    for (int i = 0; i < SPEAKERS; i++)
        for (uint64_t seed = 1; seed <= 8; seed++) {
            make_job(&speakers[i], 150, 1);
            job_plan plan = usual(&speakers[i]);
            plan.machine.seed = seed;
            plan.machine.faults.lose_ok = 0.03;
            /* Who counts characters only has no way to know a doubled answer. */
            plan.machine.faults.double_ok = speakers[i].counts ? 0.03 : 0;
            plan.machine.faults.late_ok = 0.03;
            plan.machine.faults.late_seconds = 0.4;
            printing *p = print(&speakers[i], &plan);
            /* Without an echo of its own text a marker's answer may be another's double; and who
             * never asks again can't be trusted after a lost one. Both stop safely. */
            bool may = i != MARLIN && i != PRUSA && i != KLIPPER && p->status == FIO_LINK_LOST;
            stopped[i] += may;
            if (may)
                CHECK(is_cold(p) && !p->wrong && p->report.resume.made <= p->made);
            else
                check_whole(p);
            done(p);
        }
    for (int i = 0; i < SPEAKERS; i++)
        CHECK(stopped[i] <= (i == REPRAP || i == GRBL ? 8 : 1));
}

/* The first answers of all; Klipper's name comes with one of them. */
static void test_answers_lost_in_the_greeting(void) {
    for (int i = 0; i < SPEAKERS; i++)
        for (int ok = 1; ok <= 6; ok++) {
            char script[40];
            make_job(&speakers[i], 20, 1);
            snprintf(script, sizeof script, "at ok %d lose ok", ok);
            job_plan plan = usual(&speakers[i]);
            plan.machine.script = script;
            printing *p = print(&speakers[i], &plan);
            check_count++;
            if (p->status == FIO_OK ? p->next != job_commands || p->wrong > 0 : i < REPRAP)
                fail(p, script, p->message);
            if (p->status != FIO_OK && p->next == 0)
                fail(p, script, p->message);
            done(p);
        }
}

static void test_flipped_bits_where_lines_are_counted(void) {
    for (int i = 0; i < SPEAKERS; i++)
        for (uint64_t seed = 1; seed <= 8 && speakers[i].counts; seed++) {
            make_job(&speakers[i], 150, 1);
            job_plan plan = usual(&speakers[i]);
            plan.machine.seed = seed;
            plan.machine.faults.flip_in = 0.04;
            plan.machine.faults.flip_out = 0.02;
            plan.machine.faults.lose_ok = 0.02;
            printing *p = print(&speakers[i], &plan);
            check_whole(p);
            done(p);
        }
}

static void test_pause_and_resume(void) {
    for (int i = 0; i < SPEAKERS; i++) {
        make_job(&speakers[i], 200, 4);
        job_plan plan = usual(&speakers[i]);
        plan.act = PAUSE;
        plan.at = 100;
        printing *p = print(&speakers[i], &plan);
        check_whole(p);
        CHECK(p->was_paused);
        CHECK(has_sent(p, speakers[i].heats ? "M400" : "G4 P0"));
        done(p);
    }
}

static void test_cancel_switches_off(void) {
    for (int i = 0; i < SPEAKERS; i++) {
        make_job(&speakers[i], 300, 4);
        job_plan plan = usual(&speakers[i]);
        plan.act = CANCEL;
        plan.at = 100;
        printing *p = print(&speakers[i], &plan);
        CHECK_EQUAL(FIO_CANCELLED, p->status);
        CHECK(p->next > 10 && p->next < job_commands);
        CHECK(p->report.heaters_off && is_cold(p));
        CHECK(!p->wrong);
        CHECK(has_sent(p, p->who->kind == FIO_FIRMWARE_KLIPPER ? "TURN_OFF_HEATERS"
                          : p->who->heats                      ? "M104 S0"
                                                               : "M5"));
        if (p->foreign[0])
            fail(p, "the host said what this firmware does not know", p->foreign);
        done(p);
    }
}

static void test_emergency_stop(void) {
    for (int i = 0; i < SPEAKERS; i++) {
        make_job(&speakers[i], 300, 4);
        job_plan plan = usual(&speakers[i]);
        plan.act = STOP;
        plan.at = 100;
        printing *p = print(&speakers[i], &plan);
        if (p->status != FIO_CANCELLED || !is_cold(p) || p->seconds > p->acted_at + 3)
            fail(p, "no emergency stop", p->message);
        CHECK(!strstr(p->message, "did not confirm"));
        check_count++;
        done(p);
    }
}

/* What each says when something is wrong, from its source; it has to be in the message. */
static void test_errors_and_halts_are_told_in_their_own_words(void) {
    static const struct {
        const char *name, *words;
    } cases[] = {
        {"marlin", "Error:Thermal Runaway, system stopped! Heater_ID: 0"},
        {"marlin", "Error:MINTEMP triggered, system stopped! Heater_ID: 0"},
        {"marlin", "Error:Printer stopped due to errors. Fix the error and use M999 to restart."},
        {"prusa", "Error:Heating failed, system stopped! Heater_ID: 0"},
        {"repetier", "fatal:Heater/sensor error - Printer stopped and heaters disabled due to this "
                     "error. Fix error and restart with M999."},
        {"klipper", "// Klipper state: Shutdown"},
        {"klipper", "!! Must home axis first: 10.000 0.000 0.000 [0.000]"},
        {"klipper", "!! Move out of range: 999.000 0.000 0.000 [0.000]"},
        {"grbl", "ALARM:1"},
        {"grbl", "error:33"},
        {"smoothie", "!!"},
        {"smoothie", "HALTED, M999 or $X to exit HALT state"},
        {"reprapfirmware", "Emergency Stop! Reset the controller to continue."},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const speaker *who = speakers;
        while (strcmp(who->name, cases[i].name) != 0)
            who++;
        char script[200];
        make_job(who, 200, 1);
        job_plan plan = usual(who);
        snprintf(script, sizeof script, "at line 60 answer \"%s\"", cases[i].words);
        plan.machine.script = script;
        printing *p = print(who, &plan);
        check_count++;
        if (p->status != FIO_FAULTY || !strstr(p->message, cases[i].words) ||
            !strstr(p->message, "after line ") || p->next >= job_commands)
            fail(p, cases[i].words, p->message);
        done(p);
    }
}

/* A Klipper that was stopped before answers M110, M115 and M105, but does nothing. */
static void test_a_stopped_klipper_prints_nothing(void) {
    const speaker *who = &speakers[KLIPPER];
    make_job(who, 50, 1);
    job_plan plan = usual(who);
    plan.machine.script = "every command \"G28\" answer "
                          "\"!! Printer is not ready\"";
    printing *p = print(who, &plan);
    CHECK_EQUAL(FIO_FAULTY, p->status);
    CHECK(strstr(p->message, "!! Printer is not ready"));
    CHECK(is_cold(p));
    done(p);
}

/* No number tells a line that was passed over in silence from one whose ok was lost. */
static void test_what_reprapfirmware_passes_over_is_no_success(void) {
    const speaker *who = &speakers[REPRAP];
    int stopped = 0;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        make_job(who, 150, 1);
        job_plan plan = usual(who);
        plan.machine.seed = seed;
        plan.machine.faults.flip_in = 0.02;
        printing *p = print(who, &plan);
        CHECK(p->wrong == 0 || p->status != FIO_OK);
        if (p->status == FIO_OK)
            check_whole(p);
        else {
            stopped++;
            CHECK_EQUAL(FIO_LINK_LOST, p->status);
            CHECK(is_cold(p));
            CHECK(p->report.resume.made <= p->next);
        }
        done(p);
    }
    CHECK(stopped > 6);
}

/* Nothing protects grbl's lines; but one that is gone, or stuck to the next one, has no answer. */
static void test_lines_lost_on_the_way_to_grbl_are_no_success(void) {
    const speaker *who = &speakers[GRBL];
    int stopped = 0, lost = 0;
    make_job(who, 150, 1);
    for (uint64_t seed = 1; seed <= 20; seed++) {
        job_plan plan = usual(who);
        plan.machine.seed = seed;
        plan.machine.faults.lose_bytes_in = 0.02;
        printing *p = print(who, &plan);
        stopped += p->status != FIO_OK;
        lost += fio_machine_count(p->machine)->lines_in < job_commands && p->status == FIO_OK;
        done(p);
    }
    CHECK_EQUAL(0, lost);
    CHECK(stopped > 5);
}

static void test_a_dwell_of_grbl_is_not_its_end(void) {
    const speaker *who = &speakers[GRBL];
    job_length = 0;
    job_commands = 0;
    add("G1 X5 F600");
    add("G4 P30");
    add("G1 X9 F600");
    job_plan plan = usual(who);
    printing *p = print(who, &plan);
    check_whole(p);
    done(p);
}

static void check_resets(int i, int line) {
    char script[60];
    make_job(&speakers[i], 200, 4);
    snprintf(script, sizeof script, "at line %d reset%s", line,
             i == REPRAP ? "; at line 41 unplug" : "");
    job_plan plan = usual(&speakers[i]);
    plan.machine.script = script;
    plan.machine.command_slots = speakers[i].kind == FIO_FIRMWARE_REPETIER ? 2 : 4;
    printing *p = print(&speakers[i], &plan);
    CHECK_EQUAL(FIO_LINK_LOST, p->status);
    check_count++;
    if (p->report.resume.made > p->made)
        fail(p, "said to be made", p->message);
    done(p);
}

/* The job goes on where it was, or behind the last command that was surely made. Repetier's ok says
 * that a line was read, the others' that it was executed. */
static void test_going_on_after_a_reset_leaves_no_gap(void) {
    for (int i = 0; i < SPEAKERS; i++) {
        if (i == KLIPPER || i == GRBL)
            continue; /* nothing tells how far those were */
        for (dwell_every = 0; dwell_every <= 14; dwell_every += 7)
            for (int line = 40; line < 160; line += dwell_every ? 3 : 20)
                check_resets(i, line);
    }
    dwell_every = 0;
}

/* Lines of 40 bytes, number and checksum included, that cost the firmware half a millisecond. The
 * wire of 115200 baud carries 288 of them a second, and as many answers in the other direction. */
static void test_how_many_lines_a_second(void) {
    static const double least[SPEAKERS] = {
        [MARLIN] = 230,  [PRUSA] = 230,    [REPETIER] = 240, [SMOOTHIE] = 230,
        [REPRAP] = 1500, [KLIPPER] = 1500, [GRBL] = 270};
    for (int i = 0; i < SPEAKERS; i++) {
        bool counts = i != KLIPPER && i != GRBL;
        job_length = 0;
        job_commands = 0;
        for (int k = 0; k < 300; k++)
            add(i == GRBL ? "G21 G90 G94 G17 G40 G49 G54 G80 G21"
                : counts  ? "M117 abcdefghijklmn"
                          : "M117 abcdefghijklmnopqrstuvwxyz");
        job_plan plan = usual(&speakers[i]);
        plan.machine.line_seconds = 0.0005;
        printing *p = print(&speakers[i], &plan);
        check_whole(p);
        double rate = 250 / (p->reached - p->began);
        if (print_all)
            printf("%-15s %5.0f lines/s\n", speakers[i].name, rate);
        check_count++;
        if (rate < least[i])
            fail(p, "too slow", "");
        done(p);
    }
}

int main(int count, char **arguments) {
    print_all = count > 1 && !strcmp(arguments[1], "--print");
    verbose = count > 2 && !strcmp(arguments[1], "--verbose") ? arguments[2] : NULL;
    RUN(test_a_job_is_printed_once_on_each);
    RUN(test_answers_lost_doubled_and_late);
    RUN(test_answers_lost_in_the_greeting);
    RUN(test_flipped_bits_where_lines_are_counted);
    RUN(test_pause_and_resume);
    RUN(test_cancel_switches_off);
    RUN(test_emergency_stop);
    RUN(test_errors_and_halts_are_told_in_their_own_words);
    RUN(test_a_stopped_klipper_prints_nothing);
    RUN(test_what_reprapfirmware_passes_over_is_no_success);
    RUN(test_lines_lost_on_the_way_to_grbl_are_no_success);
    RUN(test_a_dwell_of_grbl_is_not_its_end);
    RUN(test_going_on_after_a_reset_leaves_no_gap);
    RUN(test_how_many_lines_a_second);
    return check_verdict();
}
