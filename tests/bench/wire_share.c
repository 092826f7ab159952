/* Streaming to the machine in memory on its virtual clock: what share of the wire a job takes, and
 * whether the planner ever runs empty. Prints one JSON object; `wire-share` takes no arguments. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <isoprint/machine.h>

#include "base/memory.h"
#include "protocol/source.h"
#include "stream/session.h"

enum { MOVES = 10000, LINE_MOST = 48 };

/* A job and how it fared. */
typedef struct wire_trial {
    const char *name;
    int64_t rate;     /* bits/s; 0: native USB */
    double speed;     /* mm/s of moves of 0.1 mm */
    bool tells;       /* the firmware tells its free room, by ADVANCED_OK */
    int window_lines; /* 0: as the firmware tells */
    double begun, ended;
    int64_t bytes_begun, bytes_ended;
} wire_trial;

static void must(fio_status status, const char *what) {
    if (status == FIO_OK)
        return;
    fprintf(stderr, "wire-share: %s: %s\n", what, fio_error_message());
    exit(1);
}

/* To and fro along x in steps of 0.1 mm, as a gyroid or a fine model has them. */
static size_t write_job(char *text, double speed) {
    size_t length = (size_t)sprintf(
        text, "M109 S210\nG28\nG90\nM83\nG1 X10 Y10 Z0.2 F3000\nG1 F%g\n", speed * 60);
    for (int i = 0; i < MOVES; i++) {
        int along = i % 4000;
        double x = 10 + 0.1 * (along < 2000 ? along + 1 : 3999 - along);
        length += (size_t)sprintf(text + length, "G1 X%.3f E0.00333\n", x);
    }
    return length + (size_t)sprintf(text + length, "M104 S0\nM84\n");
}

static fio_source_result next(void *context, fio_source_command *command) {
    return fio_source_next(context, command);
}

typedef struct observed {
    wire_trial *trial;
    const fio_streamer *streamer;
} observed;

/* Between the 100th command and the last one sent. */
static void watch(void *context, double now, const struct pollfd *polls, int count) {
    const observed *seen = context;
    const fio_stream_report *report = fio_streamer_report(seen->streamer);
    if (report->sent < 100)
        seen->trial->begun = NAN;
    else if (isnan(seen->trial->begun)) {
        seen->trial->begun = now;
        seen->trial->bytes_begun = report->bytes_sent;
    }
    if (report->sent < MOVES) {
        seen->trial->ended = now;
        seen->trial->bytes_ended = report->bytes_sent;
    }
}

static void run(wire_trial *trial, const char *text, size_t length, fio_machine_counts *counts,
                fio_stream_report *report) {
    fio_machine_options machine_options = fio_machine_options_defaults();
    fio_stream_options options = fio_stream_options_defaults();
    fio_machine *machine;
    fio_transport *transport;
    fio_source *source;
    fio_streamer *streamer;
    machine_options.rate = options.rate = trial->rate;
    machine_options.advanced_ok = trial->tells;
    options.window_lines = trial->window_lines;
    options.window_bytes = trial->window_lines ? 127 : 0;
    machine_options.printer.maximum_flow = 1000;
    machine_options.printer.print_acceleration = 5000;
    must(fio_machine_create(&machine, &machine_options), "the machine");
    must(fio_machine_transport(&transport, machine, 0, 0), "its transport");
    must(fio_source_memory(&source, text, length), "the job");
    fio_stream_source commands = {next, NULL, source};
    must(fio_streamer_create(&streamer, &options, &commands, NULL, NULL), "the streamer");
    observed seen = {trial, streamer};
    fio_session_hooks hooks = {.woken = watch, .context = &seen};
    must(fio_session_run(transport, streamer, &hooks), trial->name);
    must(fio_machine_finish(machine), "the print");
    *counts = *fio_machine_count(machine);
    *report = *fio_streamer_report(streamer);
    fio_streamer_free(streamer);
    fio_source_close(source);
    fio_transport_close(transport);
    fio_machine_free(machine);
}

int main(void) {
    static char text[LINE_MOST * (MOVES + 16)];
    wire_trial trials[] = {
        {.name = "native", .speed = 100},
        {.name = "wire, firmware tells its room", .rate = 250000, .speed = 400, .tells = true},
        {.name = "wire, window of 4 lines given", .rate = 250000, .speed = 400, .window_lines = 4},
        {.name = "wire, nothing known", .rate = 250000, .speed = 400},
    };
    printf("{");
    for (size_t i = 0; i < sizeof trials / sizeof *trials; i++) {
        fio_machine_counts counts;
        fio_stream_report report;
        wire_trial *of = &trials[i];
        run(of, text, write_job(text, of->speed), &counts, &report);
        double seconds = of->ended - of->begun;
        double bytes = (double)(of->bytes_ended - of->bytes_begun);
        printf("%s\"%s\": {\"rate\": %lld, \"speed\": %g, \"seconds\": %.6f, \"bytes\": %.0f, "
               "\"lines_a_second\": %.1f, \"starved\": %lld, \"resends\": %lld, \"overruns\": %lld",
               i ? ", " : "", of->name, (long long)of->rate, of->speed, seconds, bytes,
               (MOVES - 100) / seconds, (long long)counts.starved, (long long)report.resends,
               (long long)counts.overruns);
        if (of->rate)
            printf(", \"share\": %.4f", bytes / (seconds * (double)of->rate / 10));
        printf("}");
    }
    printf("}\n");
    return 0;
}
