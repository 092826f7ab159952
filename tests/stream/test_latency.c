/* A slow link, as over a network: what is asked for again must not be sent again and again. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <isoprint/machine.h>

#include "check.h"
#include "protocol/source.h"
#include "stream/session.h"

enum { PIPE_BYTES = 1 << 16 };

/* Bytes on their way, each with the time it arrives. */
typedef struct delay {
    char bytes[PIPE_BYTES];
    double times[PIPE_BYTES];
    unsigned first, last;
} delay;

typedef struct slow {
    fio_transport transport;
    fio_transport *inner;
    double seconds;
    delay out, in;
} slow;

static void put(delay *pipe, double time, const char *bytes, size_t size) {
    for (size_t i = 0; i < size; i++) {
        pipe->bytes[pipe->last % PIPE_BYTES] = bytes[i];
        pipe->times[pipe->last++ % PIPE_BYTES] = time;
    }
}

static double next_time(const delay *pipe) {
    return pipe->first == pipe->last ? INFINITY : pipe->times[pipe->first % PIPE_BYTES];
}

static fio_status slow_read(fio_transport *transport, void *bytes, size_t capacity, size_t *count) {
    slow *self = (slow *)transport;
    double now = fio_transport_now(self->inner);
    *count = 0;
    while (*count < capacity && next_time(&self->in) <= now)
        ((char *)bytes)[(*count)++] = self->in.bytes[self->in.first++ % PIPE_BYTES];
    return FIO_OK;
}

static fio_status slow_write(fio_transport *transport, const void *bytes, size_t size,
                             size_t *taken) {
    slow *self = (slow *)transport;
    put(&self->out, fio_transport_now(self->inner) + self->seconds, bytes, size);
    *taken = size;
    return FIO_OK;
}

static size_t slow_pending(const fio_transport *transport) {
    const slow *self = (const slow *)transport;
    return self->out.last - self->out.first;
}

static fio_status slow_discard(fio_transport *transport, size_t *kept) {
    *kept = slow_pending(transport);
    return FIO_OK;
}

/* Moves what is due to the printer, and what it says onto its way. */
static fio_status slow_wait(fio_transport *transport, bool writing, struct pollfd *others,
                            int count, double seconds) {
    slow *self = (slow *)transport;
    double now = fio_transport_now(self->inner), end = now + seconds;
    (void)writing;
    do {
        double due = fmin(fmin(next_time(&self->out), next_time(&self->in)), end);
        fio_status status =
            fio_transport_wait(self->inner, false, others, count, fmax(due - now, 1e-6));
        if (status != FIO_OK)
            return status;
        now = fio_transport_now(self->inner);
        char bytes[256];
        size_t got = 0, taken = 0;
        status = fio_transport_read(self->inner, bytes, sizeof bytes, &got);
        if (status != FIO_OK)
            return status;
        put(&self->in, now + self->seconds, bytes, got);
        while (next_time(&self->out) <= now) {
            char byte = self->out.bytes[self->out.first % PIPE_BYTES];
            status = fio_transport_write(self->inner, &byte, 1, &taken);
            if (status != FIO_OK || taken == 0)
                return status;
            self->out.first++;
        }
    } while (now < end && next_time(&self->in) > now);
    return FIO_OK;
}

static double slow_now(const fio_transport *transport) {
    return fio_transport_now(((const slow *)transport)->inner);
}

static const fio_transport_type slow_type = {.name = "slow",
                                             .read = slow_read,
                                             .write = slow_write,
                                             .pending = slow_pending,
                                             .discard = slow_discard,
                                             .wait = slow_wait,
                                             .now = slow_now};

static int64_t executed_moves;

static void executed(void *context, const fio_executed *entry) {
    (void)context;
    executed_moves += entry->number >= 0 && entry->text[0] == 'G' && entry->text[1] == '1';
}

static fio_source_result next(void *context, fio_source_command *command) {
    return fio_source_next(context, command);
}

static fio_stream_report run(double seconds, double flips, int window) {
    static slow link;
    fio_machine_options options = fio_machine_options_defaults();
    fio_stream_options stream_options = fio_stream_options_defaults();
    fio_machine *machine;
    fio_source *source;
    fio_streamer *streamer;
    char *job = malloc(30000), *p = job;
    p += sprintf(p, "M302 P1\nG28\nG90\nM83\n");
    for (int i = 0; i < 400; i++)
        p += sprintf(p, "G1 X%d Y%d E0.01 F6000\n", 20 + i % 7, 20 + i % 3);
    options.faults.flip_in = flips;
    options.seed = 7;
    options.log.entry = executed;
    stream_options.window_lines = window;
    stream_options.window_bytes = 127;
    executed_moves = 0;
    memset(&link, 0, sizeof link);
    link.transport.type = &slow_type;
    link.seconds = seconds;
    CHECK_EQUAL(FIO_OK, fio_machine_create(&machine, &options));
    CHECK_EQUAL(FIO_OK, fio_machine_transport(&link.inner, machine, 0, 0));
    CHECK_EQUAL(FIO_OK, fio_source_memory(&source, job, (size_t)(p - job)));
    fio_stream_source from = {.next = next, .context = source};
    CHECK_EQUAL(FIO_OK, fio_streamer_create(&streamer, &stream_options, &from, NULL, NULL));
    CHECK_EQUAL(FIO_OK, fio_session_run(&link.transport, streamer, NULL));
    fio_stream_report report = *fio_streamer_report(streamer);
    CHECK_EQUAL(404, report.accepted);
    fio_streamer_free(streamer);
    fio_source_close(source);
    fio_transport_close(link.inner);
    fio_machine_free(machine);
    free(job);
    return report;
}

static void test_a_slow_link_repeats_nothing_of_itself(void) {
    for (int window = 1; window <= 4; window += 3) {
        fio_stream_report report = run(0.2, 0, window);
        CHECK_EQUAL(0, report.resends);
        CHECK_EQUAL(0, report.repeats);
        CHECK_EQUAL(400, executed_moves);
    }
}

/* Each damaged line costs itself and what was behind it in the window, and no more than twice. */
static void test_damaged_lines_make_no_storm_over_a_slow_link(void) {
    for (int window = 1; window <= 4; window += 3) {
        fio_stream_report report = run(0.15, 0.05, window);
        CHECK(report.resends >= 10);
        CHECK(report.resends <= 60 * window);
        CHECK(report.repeats <= 2 * report.resends);
        CHECK_EQUAL(400, executed_moves);
    }
}

int main(void) {
    RUN(test_a_slow_link_repeats_nothing_of_itself);
    RUN(test_damaged_lines_make_no_storm_over_a_slow_link);
    return check_verdict();
}
