/* The loop that drives a streamer over a transport, with a machine at its far end. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <poll.h>
#include <unistd.h>

#include <isoprint/machine.h>

#include "check.h"
#include "protocol/source.h"
#include "stream/session.h"

typedef struct rig {
    fio_machine *machine;
    fio_transport *transport;
    fio_source *source;
    fio_streamer *streamer;
    double stop_at, stopped, halted; /* s */
    int64_t lines_at_stop, executed_after;
    int woken, revents, pipe_end;
    int64_t discards;
} rig;

static void executed(void *context, const fio_executed *entry) {
    rig *r = context;
    if (r->stopped > 0 && entry->duration > 0)
        r->executed_after++;
}

static fio_source_result next(void *context, fio_source_command *command) {
    return fio_source_next(context, command);
}

static void make(rig *r, const fio_machine_options *machine, const fio_stream_options *options,
                 const char *job) {
    fio_machine_options with_log = *machine;
    memset(r, 0, sizeof *r);
    r->stop_at = INFINITY;
    r->pipe_end = -1;
    with_log.log = (fio_execution_log){executed, r};
    CHECK_EQUAL(FIO_OK, fio_machine_create(&r->machine, &with_log));
    CHECK_EQUAL(FIO_OK, fio_machine_transport(&r->transport, r->machine, 0, 0));
    CHECK_EQUAL(FIO_OK, fio_source_memory(&r->source, job, strlen(job)));
    fio_stream_source source = {.next = next, .context = r->source};
    CHECK_EQUAL(FIO_OK, fio_streamer_create(&r->streamer, options, &source, NULL, NULL));
}

static void end(rig *r) {
    fio_streamer_free(r->streamer);
    fio_source_close(r->source);
    fio_transport_close(r->transport);
    fio_machine_free(r->machine);
}

static bool is_halted(const rig *r) {
    fio_state state;
    fio_virtual_printer_state(fio_machine_printer(r->machine), &state);
    return state.halted;
}

static void woken(void *context, double now, const struct pollfd *polls, int count) {
    rig *r = context;
    r->woken++;
    for (int i = 0; i < count; i++) {
        char byte;
        r->revents |= polls[i].revents;
        if ((polls[i].revents & POLLIN) && read(polls[i].fd, &byte, 1) != 1)
            abort();
    }
    if (now >= r->stop_at && r->stopped == 0) {
        r->stopped = now;
        r->lines_at_stop = fio_streamer_report(r->streamer)->bytes_sent;
        fio_streamer_emergency(r->streamer, now);
    }
    if (r->stopped > 0 && r->halted == 0 && is_halted(r))
        r->halted = now;
}

static int descriptors(void *context, struct pollfd *polls, int most) {
    rig *r = context;
    if (r->pipe_end < 0 || most < 1)
        return 0;
    polls[0] = (struct pollfd){.fd = r->pipe_end, .events = POLLIN};
    return 1;
}

static char *moves(int count) {
    char *text = malloc((size_t)count * 40 + 100), *p = text;
    p += sprintf(p, "M302 P1\nG28\nG90\nM83\n");
    for (int i = 0; i < count; i++)
        p += sprintf(p, "G1 X%d Y%d E0.1 F3000\n", 20 + i % 2 * 100, 20 + i % 3 * 50);
    sprintf(p, "M84\n");
    return text;
}

static void test_a_job_runs_to_its_end(void) {
    rig r;
    fio_machine_options machine = fio_machine_options_defaults();
    char *job = moves(20);
    make(&r, &machine, NULL, job);
    CHECK_EQUAL(FIO_OK, fio_session_run(r.transport, r.streamer, NULL));
    CHECK_EQUAL(25, fio_streamer_report(r.streamer)->accepted);
    CHECK_EQUAL(FIO_OK, fio_machine_finish(r.machine));
    end(&r);
    free(job);
}

/* With bytes under way and a planner full of long moves. */
static void test_an_emergency_stop_is_felt_at_once(void) {
    for (int rate = 0; rate <= 250000; rate += 250000) {
        rig r;
        fio_machine_options machine = fio_machine_options_defaults();
        fio_stream_options options = fio_stream_options_defaults();
        fio_session_hooks hooks = {.woken = woken, .period = 0.01, .context = &r};
        char *job = moves(200);
        machine.rate = options.rate = rate;
        options.window_lines = 4;
        options.window_bytes = 127;
        make(&r, &machine, &options, job);
        r.stop_at = 40;
        CHECK_EQUAL(FIO_CANCELLED, fio_session_run(r.transport, r.streamer, &hooks));
        CHECK(is_halted(&r));
        CHECK(fio_streamer_report(r.streamer)->heaters_off);
        CHECK(fio_transport_now(r.transport) - r.stopped < 0.05);
        /* nothing but the stop was written */
        CHECK_EQUAL(r.lines_at_stop + 6, fio_streamer_report(r.streamer)->bytes_sent);
        end(&r);
        free(job);
    }
}

static void test_an_unplugged_printer_ends_it_with_where_and_why(void) {
    rig r;
    fio_machine_options machine = fio_machine_options_defaults();
    char *job = moves(200);
    machine.script = "at line 40 unplug";
    make(&r, &machine, NULL, job);
    CHECK_EQUAL(FIO_LINK_LOST, fio_session_run(r.transport, r.streamer, NULL));
    const fio_stream_report *report = fio_streamer_report(r.streamer);
    CHECK(strstr(fio_error_message(), "unplugged"));
    CHECK(strstr(fio_error_message(), "line"));
    CHECK(report->resume.accepted > 0 && report->resume.made <= report->resume.accepted);
    CHECK_EQUAL(report->accepted, report->resume.accepted);
    CHECK(!report->heaters_off);
    end(&r);
    free(job);
}

static void test_other_descriptors_wake_the_loop(void) {
    rig r;
    int ends[2];
    fio_machine_options machine = fio_machine_options_defaults();
    fio_session_hooks hooks = {descriptors, woken, 0, &r};
    char *job = moves(3);
    if (pipe(ends) != 0 || write(ends[1], "x", 1) != 1)
        abort();
    make(&r, &machine, NULL, job);
    r.pipe_end = ends[0];
    CHECK_EQUAL(FIO_OK, fio_session_run(r.transport, r.streamer, &hooks));
    CHECK(r.woken > 0);
    CHECK(r.revents & POLLIN);
    end(&r);
    free(job);
    close(ends[0]);
    close(ends[1]);
}

int main(void) {
    RUN(test_a_job_runs_to_its_end);
    RUN(test_an_emergency_stop_is_felt_at_once);
    RUN(test_an_unplugged_printer_ends_it_with_where_and_why);
    RUN(test_other_descriptors_wake_the_loop);
    return check_verdict();
}
