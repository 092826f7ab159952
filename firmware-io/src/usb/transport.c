#include "usb/transport.h"

#include "base/memory.h"
#include "transport/descriptor.h"
#include "transport/holder.h"
#include "usb/transfers.h"
#include "usb/trouble.h"

#include <math.h>
#include <stdio.h>

enum { CONTROL_MILLISECONDS = 1000 };

static const double discard_seconds = 0.1, drain_seconds = 0.3, cancel_seconds = 0.3;

typedef struct usb_port {
    fio_transport transport; /* comes first */
    fio_usb_events events;
    libusb_device_handle *handle;
    fio_serial serial;
    int claimed; /* of its interfaces */
    bool opened; /* the bridge is set up */
    char name[160];
    fio_usb_transfers transfers;
} usb_port;

static fio_status lost(const usb_port *self) {
    return fio_fail(FIO_LINK_LOST, "%s: %s", self->name, self->transfers.loss);
}

/* --- the vtable --------------------------------------------------------------------------------*/

static fio_status usb_read(fio_transport *transport, void *bytes, size_t capacity, size_t *count) {
    usb_port *self = (usb_port *)transport;
    *count = fio_usb_transfers_read(&self->transfers, bytes, capacity);
    return *count == 0 && self->transfers.used == 0 && self->transfers.lost ? lost(self) : FIO_OK;
}

static fio_status usb_write(fio_transport *transport, const void *bytes, size_t size,
                            size_t *taken) {
    usb_port *self = (usb_port *)transport;
    *taken = fio_usb_transfers_write(&self->transfers, bytes, size);
    return *taken == 0 && self->transfers.lost ? lost(self) : FIO_OK;
}

static size_t usb_pending(const fio_transport *transport) {
    return fio_usb_transfers_pending(&((const usb_port *)transport)->transfers);
}

static fio_status usb_discard(fio_transport *transport, size_t *kept) {
    usb_port *self = (usb_port *)transport;
    *kept = fio_usb_transfers_cancel(&self->transfers, &self->events, false, discard_seconds);
    return self->transfers.lost ? lost(self) : FIO_OK;
}

static fio_status usb_wait(fio_transport *transport, bool writing, struct pollfd *others, int count,
                           double seconds) {
    usb_port *self = (usb_port *)transport;
    fio_usb_transfers *transfers = &self->transfers;
    fio_usb_transfers_service(transfers);
    if (transfers->used > 0 || (writing && fio_usb_transfers_writable(transfers)))
        seconds = 0;
    else if (transfers->lost)
        return lost(self);
    double next = fio_usb_transfers_next(transfers) - fio_monotonic();
    fio_status status =
        fio_usb_events_wait(&self->events, others, count, next < seconds ? next : seconds);
    if (status != FIO_OK)
        return status;
    fio_usb_transfers_service(transfers);
    return transfers->lost && transfers->used == 0 ? lost(self) : FIO_OK;
}

static double usb_now(const fio_transport *transport) {
    return fio_monotonic();
}

static fio_status usb_set_rate(fio_transport *transport, int64_t rate) {
    usb_port *self = (usb_port *)transport;
    return self->transfers.lost ? lost(self) : self->serial.driver->set_rate(&self->serial, rate);
}

static fio_status usb_set_lines(fio_transport *transport, bool dtr, bool rts) {
    usb_port *self = (usb_port *)transport;
    return self->transfers.lost ? lost(self)
                                : self->serial.driver->set_lines(&self->serial, dtr, rts);
}

/* --- opening and closing -----------------------------------------------------------------------*/

static fio_status request(void *context, uint8_t type, uint8_t code, uint16_t value, uint16_t index,
                          void *data, uint16_t length, uint16_t *moved, bool *stalled) {
    usb_port *self = context;
    *moved = 0;
    *stalled = false;
    if (self->transfers.lost)
        return lost(self);
    int result = libusb_control_transfer(self->handle, type, code, value, index, data, length,
                                         CONTROL_MILLISECONDS);
    if (result == LIBUSB_ERROR_PIPE) {
        *stalled = true;
        return FIO_OK;
    }
    if (result >= 0) {
        *moved = (uint16_t)result;
        return FIO_OK;
    }
    fio_usb_transfers_lose(&self->transfers, result == LIBUSB_ERROR_NO_DEVICE
                                                 ? "the printer was unplugged"
                                             : result == LIBUSB_ERROR_TIMEOUT
                                                 ? "its USB bridge answers no control request"
                                                 : libusb_strerror(result));
    return lost(self);
}

/* Data first, control last: the other way round the kernel's cdc-acm, that comes back with each
 * interface let go, would find the half of its pair and give up. */
static void release_interfaces(usb_port *self) {
    while (self->claimed > 0)
        libusb_release_interface(self->handle, self->serial.interfaces[--self->claimed]);
}

static void drain(usb_port *self) {
    double end = fio_monotonic() + drain_seconds, left;
    while (!self->transfers.lost && fio_usb_transfers_pending(&self->transfers) > 0 &&
           (left = end - fio_monotonic()) > 0)
        if (usb_wait(&self->transport, false, NULL, 0, left) != FIO_OK)
            return;
        else /* what comes in now nobody reads */
            self->transfers.used = 0;
}

static void usb_close(fio_transport *transport) {
    usb_port *self = (usb_port *)transport;
    if (self->opened) {
        drain(self);
        fio_usb_transfers_cancel(&self->transfers, &self->events, true, cancel_seconds);
        if (!self->transfers.lost && self->serial.driver->close(&self->serial) != FIO_OK)
            fio_usb_transfers_lose(&self->transfers, "closing failed");
    }
    if (self->handle) {
        release_interfaces(self);
        libusb_close(self->handle);
    }
    fio_usb_transfers_end(&self->transfers);
    fio_usb_events_close(&self->events);
    fio_release(self);
}

static const fio_transport_type usb_type = {
    .name = "usb",
    .read = usb_read,
    .write = usb_write,
    .pending = usb_pending,
    .discard = usb_discard,
    .wait = usb_wait,
    .now = usb_now,
    .set_rate = usb_set_rate,
    .set_lines = usb_set_lines,
    .close = usb_close,
};

static fio_status refuse(const usb_port *self, const fio_usb_found *found, int error) {
    char why[400], holder[160];
    switch (error) {
    case LIBUSB_ERROR_ACCESS:
        fio_usb_explain_access(why, sizeof why, found);
        return fio_fail(FIO_NO_PRINTER, "%s: %s", self->name, why);
    case LIBUSB_ERROR_BUSY: {
        bool named = fio_holder_find(holder, sizeof holder, found->node);
        fio_usb_explain_busy(why, sizeof why, found, named ? holder : NULL);
        return fio_fail(FIO_NO_PRINTER, "%s: %s", self->name, why);
    }
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
        return fio_fail(FIO_NO_PRINTER, "%s: unplugged just now", self->name);
    default:
        return fio_fail(FIO_NO_PRINTER, "%s: %s", self->name, libusb_strerror(error));
    }
}

static int open_device(usb_port *self, const fio_usb_found *found) {
    libusb_device **devices;
    ssize_t count = libusb_get_device_list(self->events.context, &devices);
    if (count < 0)
        return (int)count;
    int error = LIBUSB_ERROR_NO_DEVICE;
    for (ssize_t i = 0; i < count; i++)
        if (libusb_get_bus_number(devices[i]) == found->bus &&
            libusb_get_device_address(devices[i]) == found->address)
            error = libusb_open(devices[i], &self->handle);
    libusb_free_device_list(devices, 1);
    return error;
}

static fio_status claim(usb_port *self, const fio_usb_found *found) {
    char holder[160], why[400];
    int error = found->configuration == 0 ? LIBUSB_ERROR_ACCESS : open_device(self, found);
    if (error)
        return refuse(self, found, error);
    /* Taking the device away from a program that prints through the kernel's tty would end that
     * print; the system would let us. */
    if (found->tty[0] && fio_holder_find(holder, sizeof holder, found->tty)) {
        fio_usb_explain_busy(why, sizeof why, found, holder);
        return fio_fail(FIO_NO_PRINTER, "%s: %s", self->name, why);
    }
    libusb_set_auto_detach_kernel_driver(self->handle, 1);
    while (self->claimed < self->serial.interface_count) {
        error = libusb_claim_interface(self->handle, self->serial.interfaces[self->claimed]);
        if (error)
            return refuse(self, found, error);
        self->claimed++;
    }
    return FIO_OK;
}

static fio_status start(usb_port *self, const fio_usb_found *found, int64_t rate,
                        bool raise_lines) {
    fio_status status = fio_usb_events_open(&self->events);
    if (status == FIO_OK)
        status = claim(self, found);
    if (status == FIO_OK)
        status = fio_usb_transfers_begin(&self->transfers, self->handle, &self->serial);
    if (status == FIO_OK)
        status = self->serial.driver->open(&self->serial, rate, raise_lines);
    if (status != FIO_OK)
        return status == FIO_LINK_LOST ? FIO_NO_PRINTER : status;
    self->opened = true;
    fio_usb_transfers_service(&self->transfers);
    return self->transfers.lost
               ? fio_fail(FIO_NO_PRINTER, "%s: %s", self->name, self->transfers.loss)
               : FIO_OK;
}

fio_status fio_usb_open(fio_transport **transport, const fio_usb_found *found, const char *name,
                        int64_t rate, bool raise_lines) {
    *transport = NULL;
    usb_port *self = fio_allocate(sizeof *self);
    if (!self)
        return fio_fail(FIO_NO_MEMORY, "no memory for a port");
    self->transport.type = &usb_type;
    self->serial = found->link;
    self->serial.control = (fio_control){request, self};
    snprintf(self->name, sizeof self->name, "%s", name);
    fio_status status = start(self, found, rate, raise_lines);
    if (status != FIO_OK)
        usb_close(&self->transport);
    else
        *transport = &self->transport;
    return status;
}
