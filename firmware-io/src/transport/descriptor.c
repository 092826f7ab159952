#include "transport/descriptor.h"

#include <errno.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

double fio_monotonic(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int fio_poll_milliseconds(double seconds) {
    double limit = 3600;
    if (!(seconds > 0))
        return 0;
    int milliseconds = (int)((seconds < limit ? seconds : limit) * 1000);
    return milliseconds < seconds * 1000 ? milliseconds + 1 : milliseconds;
}

fio_status fio_descriptor_lose(fio_descriptor *descriptor, const char *format, ...) {
    if (!descriptor->lost) {
        char why[200];
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(why, sizeof why, format, arguments);
        va_end(arguments);
        snprintf(descriptor->loss, sizeof descriptor->loss, "%s: %s", descriptor->name, why);
        descriptor->lost = true;
    }
    return fio_fail(FIO_LINK_LOST, "%s", descriptor->loss);
}

static fio_status closed(fio_descriptor *self) {
    return fio_descriptor_lose(self, self->socket ? "the other end closed the connection"
                                                  : "the port was unplugged or hung up");
}

static fio_status broken(fio_descriptor *self, const char *doing) {
    if (errno == EIO || errno == ENODEV || errno == ENXIO || errno == EPIPE || errno == ECONNRESET)
        return closed(self);
    return fio_descriptor_lose(self, "%s failed: %s", doing, strerror(errno));
}

static bool later(void) {
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

fio_status fio_descriptor_read(fio_transport *transport, void *bytes, size_t capacity,
                               size_t *count) {
    fio_descriptor *self = (fio_descriptor *)transport;
    *count = 0;
    if (capacity == 0)
        return self->lost ? closed(self) : FIO_OK;
    ssize_t got = read(self->file, bytes, capacity);
    if (got > 0) {
        *count = (size_t)got;
        return FIO_OK;
    }
    if (got == 0)
        return closed(self);
    if (later())
        return self->lost ? closed(self) : FIO_OK;
    return broken(self, "reading");
}

size_t fio_descriptor_pending(const fio_transport *transport) {
    const fio_descriptor *self = (const fio_descriptor *)transport;
    int held = 0;
    if (self->lost || ioctl(self->file, self->question, &held) < 0 || held <= 0)
        return 0;
    return self->counted ? (size_t)held : self->since_empty;
}

fio_status fio_descriptor_write(fio_transport *transport, const void *bytes, size_t size,
                                size_t *taken) {
    fio_descriptor *self = (fio_descriptor *)transport;
    *taken = 0;
    if (self->lost)
        return closed(self);
    if (self->held_most + size > FIO_DESCRIPTOR_HELD) {
        self->held_most = fio_descriptor_pending(transport);
        if (self->held_most == 0)
            self->since_empty = 0;
    }
    size_t room = self->held_most < FIO_DESCRIPTOR_HELD ? FIO_DESCRIPTOR_HELD - self->held_most : 0;
    if (size > room)
        size = room;
    if (size == 0)
        return FIO_OK;
    ssize_t put =
        self->socket ? send(self->file, bytes, size, MSG_NOSIGNAL) : write(self->file, bytes, size);
    if (put < 0)
        return later() ? FIO_OK : broken(self, "writing");
    *taken = (size_t)put;
    self->since_empty += (size_t)put;
    self->held_most += (size_t)put;
    return FIO_OK;
}

fio_status fio_descriptor_wait(fio_transport *transport, bool writing, struct pollfd *others,
                               int count, double seconds) {
    fio_descriptor *self = (fio_descriptor *)transport;
    if (count < 0 || count >= FIO_DESCRIPTOR_POLLS)
        return fio_fail(FIO_BUG, "%s: %d descriptors to wait for at once", self->name, count);
    if (self->lost)
        return closed(self);
    struct pollfd polls[FIO_DESCRIPTOR_POLLS] = {{.fd = self->file, .events = POLLIN}};
    /* A device's queue is longer than what we allow ourselves to put there, so while it is full by
     * our measure poll() would return at once. */
    if (writing && fio_descriptor_pending(transport) < FIO_DESCRIPTOR_HELD)
        polls[0].events |= POLLOUT;
    else if (writing && !(seconds < self->drain))
        seconds = self->drain;
    if (count)
        memcpy(polls + 1, others, (size_t)count * sizeof *others);
    int ready = poll(polls, (nfds_t)count + 1, fio_poll_milliseconds(seconds));
    if (ready < 0 && errno != EINTR)
        return fio_fail(FIO_BUG, "%s: poll: %s", self->name, strerror(errno));
    for (int i = 0; i < count; i++)
        others[i].revents = ready < 0 ? 0 : polls[i + 1].revents;
    if (ready > 0 && !(polls[0].revents & POLLIN) &&
        polls[0].revents & (POLLHUP | POLLERR | POLLNVAL))
        return closed(self);
    return FIO_OK;
}

double fio_descriptor_now(const fio_transport *transport) {
    return fio_monotonic();
}

void fio_descriptor_drain(fio_descriptor *descriptor, double seconds) {
    double end = fio_monotonic() + seconds;
    while (!descriptor->lost && fio_descriptor_pending(&descriptor->transport) > 0 &&
           fio_monotonic() < end) {
        struct pollfd hangup = {.fd = descriptor->file};
        if (poll(&hangup, 1, 5) > 0)
            return;
    }
}
