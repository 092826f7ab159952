/* How much of a wire is used, whether the planner runs empty, what a line costs: in virtual time,
 * so that only the last figure depends on the machine this runs on.
 *
 *     test-stream-figures [--print] */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <isoprint/machine.h>

#include "check.h"
#include "protocol/source.h"
#include "stream/session.h"

typedef struct figures {
    double running, finishing; /* when */
    int64_t bytes_before, bytes, lines;
    fio_machine_counts counts;
    double cpu; /* s */
    fio_status status;
} figures;

typedef struct watch {
    figures *figures;
    fio_streamer *streamer;
} watch;

static bool print_all;

static void listen(void *context, const fio_stream_event *event) {
    watch *self = context;
    if (event->kind != FIO_STREAM_STATE)
        return;
    const fio_stream_report *report = fio_streamer_report(self->streamer);
    if (event->state == FIO_STREAM_RUNNING) {
        self->figures->running = event->time;
        self->figures->bytes_before = report->bytes_sent;
    } else if (event->state == FIO_STREAM_FINISHING) {
        self->figures->finishing = event->time;
        self->figures->bytes = report->bytes_sent - self->figures->bytes_before;
        self->figures->lines = report->lines_sent;
    }
}

static fio_source_result next(void *context, fio_source_command *command) {
    return fio_source_next(context, command);
}

static double cpu_now(void) {
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + (double)time.tv_nsec * 1e-9;
}

static figures stream(const fio_machine_options *options, const fio_stream_options *stream_options,
                      const char *text, size_t length) {
    figures result = {0};
    watch self = {.figures = &result};
    fio_machine *machine;
    fio_transport *transport;
    fio_source *source;
    CHECK_EQUAL(FIO_OK, fio_machine_create(&machine, options));
    CHECK_EQUAL(FIO_OK, fio_machine_transport(&transport, machine, 0, 0));
    CHECK_EQUAL(FIO_OK, fio_source_memory(&source, text, length));
    fio_stream_source job = {.next = next, .context = source};
    fio_stream_listener listener = {listen, &self};
    CHECK_EQUAL(FIO_OK, fio_streamer_create(&self.streamer, stream_options, &job, NULL, &listener));
    double start = cpu_now();
    result.status = fio_session_run(transport, self.streamer, NULL);
    result.cpu = cpu_now() - start;
    result.counts = *fio_machine_count(machine);
    CHECK_EQUAL(FIO_OK, result.status);
    fio_streamer_free(self.streamer);
    fio_source_close(source);
    fio_transport_close(transport);
    fio_machine_free(machine);
    return result;
}

static char *small_moves(int count, double length, int feedrate, size_t *size) {
    char *text = malloc((size_t)count * 48 + 200), *p = text;
    p += sprintf(p, "M302 P1\nG28\nG90\nM83\nG1 X20 Y20 Z0.2 F%d\n", feedrate);
    for (int i = 0; i < count; i++) {
        double x = 20 + length * (double)(i % 1000 < 500 ? i % 1000 : 1000 - i % 1000);
        p += sprintf(p, "G1 X%.3f Y%.3f E0.00412\n", x, 20 + 0.001 * i);
    }
    p += sprintf(p, "M84\n");
    *size = (size_t)(p - text);
    return text;
}

static double share_of(const figures *result, int64_t rate) {
    return (double)result->bytes * 10 / (double)rate / (result->finishing - result->running);
}

/* The job's lines from the first after homing on: G28 takes 18 s. */
static double homing_seconds(const fio_machine_options *options,
                             const fio_stream_options *stream_options) {
    static const char text[] = "M302 P1\nG28\nG90\nM83\nG1 X20 Y20 Z0.2 F12000\nM84\n";
    figures result = stream(options, stream_options, text, sizeof text - 1);
    return result.finishing - result.running;
}

static void test_a_known_window_fills_a_wire_of_250000_baud(void) {
    fio_machine_options options = fio_machine_options_defaults();
    fio_stream_options stream_options = fio_stream_options_defaults();
    size_t size;
    char *text = small_moves(10000, 0.01, 18000, &size);
    options.rate = stream_options.rate = 250000;
    for (int lines = 1; lines <= 4; lines++) {
        stream_options.window_lines = lines;
        stream_options.window_bytes = options.receive_bytes - 1;
        double homing = homing_seconds(&options, &stream_options);
        figures result = stream(&options, &stream_options, text, size);
        result.running += homing;
        double share = share_of(&result, options.rate);
        if (print_all)
            printf("250000 baud, %d lines, %d bytes: %.1f %% of the wire, %.0f lines/s\n", lines,
                   stream_options.window_bytes, 100 * share,
                   10000 / (result.finishing - result.running));
        CHECK(result.counts.overruns == 0);
        if (lines >= 2)
            CHECK(share >= 0.95);
    }
    free(text);
}

static void test_the_planner_never_runs_empty_over_native_usb(void) {
    fio_machine_options options = fio_machine_options_defaults();
    fio_stream_options stream_options = fio_stream_options_defaults();
    size_t size;
    char *text = small_moves(10000, 0.1, 6000, &size);
    options.rate = stream_options.rate = 0;
    for (int lines = 0; lines <= 4; lines += 4) {
        stream_options.window_lines = lines;
        figures result = stream(&options, &stream_options, text, size);
        if (print_all)
            printf("native USB, 10000 moves of 0.1 mm at 100 mm/s, %d lines: starved %lld times\n",
                   lines > 0 ? lines : 1, (long long)result.counts.starved);
        CHECK_EQUAL(0, result.counts.starved);
    }
    free(text);
}

static void test_what_a_line_costs(void) {
    fio_machine_options options = fio_machine_options_defaults();
    fio_stream_options stream_options = fio_stream_options_defaults();
    size_t size;
    char *text = small_moves(50000, 0.01, 18000, &size);
    options.rate = stream_options.rate = 0;
    options.line_seconds = 0;
    stream_options.window_lines = 4;
    figures result = stream(&options, &stream_options, text, size);
    if (print_all)
        printf("CPU of streamer, source, session and virtual printer: %.2f us a line\n",
               1e6 * result.cpu / (double)result.lines);
    CHECK(result.lines > 50000);
    free(text);
}

int main(int count, char **arguments) {
    print_all = count > 1 && !strcmp(arguments[1], "--print");
    RUN(test_a_known_window_fills_a_wire_of_250000_baud);
    RUN(test_the_planner_never_runs_empty_over_native_usb);
    RUN(test_what_a_line_costs);
    return check_verdict();
}
