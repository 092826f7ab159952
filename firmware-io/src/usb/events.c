#include "usb/events.h"

#include "transport/descriptor.h"

#include <errno.h>
#include <string.h>

static void LIBUSB_CALL added(int file, short wanted, void *context) {
    fio_usb_events *self = context;
    if (self->count < FIO_USB_POLLS)
        self->polls[self->count++] = (struct pollfd){.fd = file, .events = wanted};
}

static void LIBUSB_CALL removed(int file, void *context) {
    fio_usb_events *self = context;
    for (int i = 0; i < self->count; i++)
        if (self->polls[i].fd == file)
            self->polls[i--] = self->polls[--self->count];
}

fio_status fio_usb_events_open(fio_usb_events *events) {
    *events = (fio_usb_events){0};
    int error = libusb_init(&events->context);
    if (error) {
        events->context = NULL;
        return fio_fail(FIO_NO_PRINTER, "no USB on this machine: %s (is /dev/bus/usb there?)",
                        libusb_strerror(error));
    }
    const struct libusb_pollfd **list = libusb_get_pollfds(events->context);
    for (int i = 0; list && list[i]; i++)
        added(list[i]->fd, list[i]->events, events);
    libusb_free_pollfds(list);
    libusb_set_pollfd_notifiers(events->context, added, removed, events);
    events->clocked = !libusb_pollfds_handle_timeouts(events->context);
    return FIO_OK;
}

void fio_usb_events_close(fio_usb_events *events) {
    if (!events->context)
        return;
    libusb_set_pollfd_notifiers(events->context, NULL, NULL, NULL);
    libusb_exit(events->context);
    events->context = NULL;
}

static double limit(const fio_usb_events *events, double seconds) {
    struct timeval next;
    if (!events->clocked || libusb_get_next_timeout(events->context, &next) != 1)
        return seconds;
    double until = (double)next.tv_sec + 1e-6 * (double)next.tv_usec;
    return until < seconds ? until : seconds;
}

fio_status fio_usb_events_wait(fio_usb_events *events, struct pollfd *others, int count,
                               double seconds) {
    if (count < 0 || count > FIO_USB_OTHERS)
        return fio_fail(FIO_BUG, "%d descriptors to wait for at once", count);
    struct pollfd polls[FIO_USB_POLLS + FIO_USB_OTHERS];
    int own = events->count;
    memcpy(polls, events->polls, (size_t)own * sizeof *polls);
    if (count)
        memcpy(polls + own, others, (size_t)count * sizeof *polls);
    int ready = poll(polls, (nfds_t)(own + count), fio_poll_milliseconds(limit(events, seconds)));
    if (ready < 0 && errno != EINTR)
        return fio_fail(FIO_BUG, "poll: %s", strerror(errno));
    for (int i = 0; i < count; i++)
        others[i].revents = ready < 0 ? 0 : polls[own + i].revents;
    bool due = events->clocked;
    for (int i = 0; ready > 0 && i < own; i++)
        due |= polls[i].revents != 0;
    struct timeval at_once = {0, 0};
    if (due)
        libusb_handle_events_timeout_completed(events->context, &at_once, NULL);
    return FIO_OK;
}
