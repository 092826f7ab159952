#include "stream/session.h"

#include <math.h>
#include <poll.h>

/* A deadline that rounding leaves a hair away from now must be passed, not approached. */
#define LEAST_SECONDS 1e-6

enum { READS_MOST = 64 }; /* of a chatterbox, before anything is written */

static fio_status take_in(fio_transport *transport, fio_streamer *streamer) {
    char bytes[1024];
    for (int i = 0; i < READS_MOST; i++) {
        size_t count = 0;
        fio_status status = fio_transport_read(transport, bytes, sizeof bytes, &count);
        if (status != FIO_OK)
            return status;
        if (count > 0)
            fio_streamer_receive(streamer, fio_transport_now(transport), bytes, count);
        if (count < sizeof bytes)
            return FIO_OK; /* if there is more all the same, wait() returns at once */
    }
    return FIO_OK;
}

/* *waiting: there is more than the transport takes now. */
static fio_status put_out(fio_transport *transport, fio_streamer *streamer, bool *waiting) {
    *waiting = false;
    for (;;) {
        const char *bytes;
        bool discard;
        size_t kept, taken = 0;
        size_t size = fio_streamer_output(streamer, fio_transport_now(transport), &bytes, &discard);
        if (discard) {
            fio_status status = fio_transport_discard(transport, &kept);
            if (status != FIO_OK)
                return status;
        }
        if (size == 0)
            return FIO_OK;
        fio_status status = fio_transport_write(transport, bytes, size, &taken);
        if (status != FIO_OK)
            return status;
        fio_streamer_wrote(streamer, fio_transport_now(transport), taken);
        if (taken < size) {
            *waiting = true;
            return FIO_OK;
        }
    }
}

static fio_status wait(fio_transport *transport, fio_streamer *streamer,
                       const fio_session_hooks *hooks, bool writing) {
    struct pollfd polls[FIO_SESSION_POLLS] = {{0}};
    int count = 0;
    if (hooks && hooks->descriptors)
        count = hooks->descriptors(hooks->context, polls, FIO_SESSION_POLLS);
    double seconds = fio_streamer_deadline(streamer) - fio_transport_now(transport);
    if (hooks && hooks->period > 0)
        seconds = fmin(seconds, hooks->period);
    seconds = fmax(fmin(seconds, 3600), LEAST_SECONDS);
    fio_status status = fio_transport_wait(transport, writing, polls, count, seconds);
    if (hooks && hooks->woken)
        hooks->woken(hooks->context, fio_transport_now(transport), polls, count);
    return status;
}

static fio_status step(fio_transport *transport, fio_streamer *streamer,
                       const fio_session_hooks *hooks) {
    bool writing;
    fio_status status = take_in(transport, streamer);
    if (status != FIO_OK)
        return status;
    fio_streamer_tick(streamer, fio_transport_now(transport));
    status = put_out(transport, streamer, &writing);
    if (status != FIO_OK)
        return status;
    if (fio_streamer_report(streamer)->state == FIO_STREAM_DONE)
        return FIO_OK;
    return wait(transport, streamer, hooks, writing);
}

fio_status fio_session_run(fio_transport *transport, fio_streamer *streamer,
                           const fio_session_hooks *hooks) {
    const fio_stream_report *report = fio_streamer_report(streamer);
    while (report->state != FIO_STREAM_DONE) {
        fio_status status = step(transport, streamer, hooks);
        if (status != FIO_OK && report->state != FIO_STREAM_DONE)
            fio_streamer_lost(streamer, fio_transport_now(transport), status, fio_error_message());
    }
    if (report->status != FIO_OK)
        return fio_fail(report->status, "%s", report->message);
    return FIO_OK;
}
