/* A transport with a machine at its far end, on a clock that jumps, or that follows real time. */
#include <math.h>
#include <poll.h>
#include <time.h>

#include <isoprint/machine.h>

#include "base/memory.h"

typedef struct memory {
    fio_transport transport;
    fio_machine *machine;
    double now;   /* of the machine's clock, when it is virtual */
    double speed; /* 0: virtual */
    double start, real_start;
    bool lost;
} memory;

static double real_now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + (double)time.tv_nsec * 1e-9;
}

static double now_of(const memory *self) {
    return self->speed == 0 ? self->now
                            : self->start + (real_now() - self->real_start) * self->speed;
}

static double now(const fio_transport *transport) {
    return now_of((const memory *)transport);
}

/* The loss is told once all bytes that had arrived before it are read. */
static fio_status look(memory *self) {
    if (!self->lost && fio_machine_plugged(self->machine))
        return FIO_OK;
    self->lost = true;
    return fio_fail(FIO_LINK_LOST, "the virtual printer was unplugged");
}

static fio_status take(fio_transport *transport, void *bytes, size_t capacity, size_t *count) {
    memory *self = (memory *)transport;
    *count = self->lost ? 0 : fio_machine_read(self->machine, now_of(self), bytes, capacity);
    return *count ? FIO_OK : look(self);
}

static fio_status put(fio_transport *transport, const void *bytes, size_t size, size_t *taken) {
    memory *self = (memory *)transport;
    *taken = 0;
    if (!self->lost)
        *taken = fio_machine_write(self->machine, now_of(self), bytes, size);
    return *taken ? FIO_OK : look(self);
}

static size_t pending(const fio_transport *transport) {
    return fio_machine_pending(((const memory *)transport)->machine);
}

static fio_status discard(fio_transport *transport, size_t *kept) {
    memory *self = (memory *)transport;
    fio_machine_discard(self->machine, now_of(self));
    *kept = 0;
    return look(self);
}

static bool is_ready(const memory *self, bool writing) {
    return !fio_machine_plugged(self->machine) || fio_machine_readable(self->machine) ||
           (writing && fio_machine_room(self->machine) > 0);
}

/* True if one of them has something, or a signal came, which is a reason to return, too. */
static bool poll_others(struct pollfd *others, int count, double seconds) {
    int timeout = seconds > 3600 ? 3600000 : (int)ceil(fmax(seconds, 0) * 1e3);
    return (count > 0 || timeout > 0) && poll(others, (nfds_t)count, timeout) != 0;
}

/* No further descriptor can delay virtual time: they are looked at, not waited for. */
static fio_status wait_virtual(memory *self, bool writing, struct pollfd *others, int count,
                               double seconds) {
    double deadline = self->now + fmax(seconds, 0);
    bool some = poll_others(others, count, 0);
    while (!some && !is_ready(self, writing)) {
        double next = fio_machine_next(self->machine);
        self->now = next < deadline ? next : deadline;
        fio_machine_advance(self->machine, self->now);
        if (!(next < deadline))
            break;
    }
    return self->lost ? look(self) : FIO_OK;
}

static fio_status wait_real(memory *self, bool writing, struct pollfd *others, int count,
                            double seconds) {
    double deadline = now_of(self) + fmax(seconds, 0); /* of the clock that now() gives */
    for (bool some = false; !some;) {
        double time = now_of(self);
        fio_machine_advance(self->machine, time);
        bool ready = is_ready(self, writing) || time >= deadline;
        double next = fmin(fio_machine_next(self->machine), deadline);
        double left = ready ? 0 : fmax((next - time) / self->speed, 0);
        some = poll_others(others, count, left) || ready;
    }
    return FIO_OK;
}

static fio_status wait(fio_transport *transport, bool writing, struct pollfd *others, int count,
                       double seconds) {
    memory *self = (memory *)transport;
    for (int i = 0; i < count; i++)
        others[i].revents = 0;
    return self->speed == 0 ? wait_virtual(self, writing, others, count, seconds)
                            : wait_real(self, writing, others, count, seconds);
}

static fio_status set_rate(fio_transport *transport, int64_t rate) {
    memory *self = (memory *)transport;
    fio_machine_set_rate(self->machine, now_of(self), rate);
    return look(self);
}

static fio_status set_lines(fio_transport *transport, bool dtr, bool rts) {
    memory *self = (memory *)transport;
    fio_machine_set_lines(self->machine, now_of(self), dtr, rts);
    return look(self);
}

static void close_memory(fio_transport *transport) {
    memory *self = (memory *)transport;
    fio_machine_set_lines(self->machine, now_of(self), false, false);
    fio_release(self);
}

fio_status fio_machine_transport(fio_transport **transport, fio_machine *machine, double start,
                                 double speed) {
    static const fio_transport_type type = {
        .name = "memory",
        .read = take,
        .write = put,
        .pending = pending,
        .discard = discard,
        .wait = wait,
        .now = now,
        .set_rate = set_rate,
        .set_lines = set_lines,
        .close = close_memory,
    };
    *transport = NULL;
    if (!(speed >= 0 && speed <= 1e6) || !isfinite(start))
        return fio_fail(FIO_USAGE, "the speed of a machine's clock is 0 to 1e6");
    if (!fio_machine_plugged(machine))
        return fio_fail(FIO_NO_PRINTER, "the virtual printer is not plugged in");
    memory *made = fio_allocate(sizeof *made);
    if (!made)
        return fio_fail(FIO_NO_MEMORY, "no memory for a transport");
    made->transport.type = &type;
    made->machine = machine;
    made->now = made->start = start;
    made->speed = speed;
    made->real_start = real_now();
    fio_machine_set_lines(machine, start, true, true);
    *transport = &made->transport;
    return FIO_OK;
}
