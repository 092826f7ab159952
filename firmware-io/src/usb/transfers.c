#include "usb/transfers.h"

#include "transport/descriptor.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double retry_seconds =
    0.004; /* of a failed IN transfer: a burst of noise is shorter */

void fio_usb_transfers_lose(fio_usb_transfers *transfers, const char *why) {
    if (!transfers->lost)
        snprintf(transfers->loss, sizeof transfers->loss, "%s", why);
    transfers->lost = true;
}

static void lose(fio_usb_transfers *self, int error) {
    fio_usb_transfers_lose(self, error == LIBUSB_ERROR_NO_DEVICE ? "the printer was unplugged"
                                                                 : libusb_strerror(error));
}

/* --- IN ----------------------------------------------------------------------------------------*/

static void keep(fio_usb_transfers *self, const uint8_t *bytes, size_t size) {
    size_t at = (self->first + self->used) % FIO_USB_RING;
    size_t here = size < FIO_USB_RING - at ? size : FIO_USB_RING - at;
    memcpy(self->ring + at, bytes, here);
    memcpy(self->ring, bytes + here, size - here);
    self->used += size;
}

static void LIBUSB_CALL received(struct libusb_transfer *usb) {
    fio_usb_in *in = usb->user_data;
    fio_usb_transfers *self = in->owner;
    in->flying = false;
    self->promised -= self->in_size;
    size_t size = usb->actual_length > 0 ? (size_t)usb->actual_length : 0;
    if (size > 0 && self->serial->driver->unwrap)
        size = self->serial->driver->unwrap(self->serial, in->bytes, size);
    keep(self, in->bytes, size);
    switch (usb->status) {
    case LIBUSB_TRANSFER_COMPLETED:
        self->in_errors = self->in_stalls = 0;
        break;
    case LIBUSB_TRANSFER_CANCELLED:
        break;
    case LIBUSB_TRANSFER_STALL:
        self->in_halted = true;
        break;
    case LIBUSB_TRANSFER_NO_DEVICE:
        lose(self, LIBUSB_ERROR_NO_DEVICE);
        break;
    default: /* noise on the wire, mostly: what it cost us the protocol asks for again */
        self->in_retry = fio_monotonic() + retry_seconds;
        if (++self->in_errors > FIO_USB_ERRORS_MOST)
            fio_usb_transfers_lose(self, "receiving fails again and again");
    }
}

static void submit_in(fio_usb_transfers *self) {
    for (int i = 0; i < FIO_USB_IN_COUNT && !self->lost; i++) {
        fio_usb_in *in = &self->in[i];
        if (in->flying || FIO_USB_RING - self->used - self->promised < self->in_size)
            continue;
        int error = libusb_submit_transfer(in->usb);
        in->flying = !error;
        if (error)
            lose(self, error);
        else
            self->promised += self->in_size;
    }
}

size_t fio_usb_transfers_read(fio_usb_transfers *transfers, void *bytes, size_t capacity) {
    size_t size = capacity < transfers->used ? capacity : transfers->used;
    size_t here = FIO_USB_RING - transfers->first;
    if (here > size)
        here = size;
    memcpy(bytes, transfers->ring + transfers->first, here);
    memcpy((uint8_t *)bytes + here, transfers->ring, size - here);
    transfers->first = (transfers->first + size) % FIO_USB_RING;
    transfers->used -= size;
    return size;
}

/* --- OUT ---------------------------------------------------------------------------------------*/

static void LIBUSB_CALL sent(struct libusb_transfer *usb) {
    fio_usb_out *out = usb->user_data;
    fio_usb_transfers *self = out->owner;
    out->flying = false;
    out->done += usb->actual_length;
    switch (usb->status) {
    case LIBUSB_TRANSFER_COMPLETED:
        self->out_stalls = 0;
        if (out->done < out->size)
            fio_usb_transfers_lose(self, "sending stopped half-way");
        break;
    case LIBUSB_TRANSFER_CANCELLED: /* by us, who look at `done` */
        break;
    case LIBUSB_TRANSFER_STALL:
        self->out_halted = true;
        break;
    case LIBUSB_TRANSFER_NO_DEVICE:
        lose(self, LIBUSB_ERROR_NO_DEVICE);
        break;
    default: /* nobody knows which bytes arrived, and the next ones must not overtake them */
        fio_usb_transfers_lose(self, "sending failed");
    }
}

static bool idle(const fio_usb_out *out) {
    return !out->flying && out->done == out->size;
}

static void submit_out(fio_usb_transfers *self, fio_usb_out *out) {
    out->usb->buffer = out->bytes + out->done;
    out->usb->length = out->size - out->done;
    int error = libusb_submit_transfer(out->usb);
    out->flying = !error;
    if (error)
        lose(self, error);
}

bool fio_usb_transfers_writable(const fio_usb_transfers *transfers) {
    if (transfers->out_halted)
        return false;
    for (int i = 0; i < FIO_USB_OUT_COUNT; i++)
        if (idle(&transfers->out[i]))
            return true;
    return false;
}

size_t fio_usb_transfers_write(fio_usb_transfers *transfers, const void *bytes, size_t size) {
    size_t taken = 0;
    for (int i = 0; i < FIO_USB_OUT_COUNT && taken < size; i++) {
        fio_usb_out *out = &transfers->out[i];
        if (transfers->lost || transfers->out_halted || !idle(out))
            continue;
        size_t rest = size - taken;
        out->size = (int)(rest < FIO_USB_OUT_MOST ? rest : FIO_USB_OUT_MOST);
        out->done = 0;
        out->order = transfers->orders++;
        memcpy(out->bytes, (const uint8_t *)bytes + taken, (size_t)out->size);
        submit_out(transfers, out);
        if (out->flying)
            taken += (size_t)out->size;
        else
            out->done = out->size;
    }
    return taken;
}

size_t fio_usb_transfers_pending(const fio_usb_transfers *transfers) {
    size_t pending = 0;
    for (int i = 0; i < FIO_USB_OUT_COUNT; i++)
        pending += (size_t)(transfers->out[i].size - transfers->out[i].done);
    return pending;
}

/* --- both --------------------------------------------------------------------------------------*/

static int flying(const fio_usb_transfers *self, bool out, bool in) {
    int count = 0;
    for (int i = 0; out && i < FIO_USB_OUT_COUNT; i++)
        count += self->out[i].flying;
    for (int i = 0; in && i < FIO_USB_IN_COUNT; i++)
        count += self->in[i].flying;
    return count;
}

static void cancel(fio_usb_transfers *self, bool out, bool in) {
    for (int i = 0; out && i < FIO_USB_OUT_COUNT; i++)
        if (self->out[i].flying)
            libusb_cancel_transfer(self->out[i].usb);
    for (int i = 0; in && i < FIO_USB_IN_COUNT; i++)
        if (self->in[i].flying)
            libusb_cancel_transfer(self->in[i].usb);
}

size_t fio_usb_transfers_cancel(fio_usb_transfers *transfers, fio_usb_events *events, bool all,
                                double seconds) {
    double end = fio_monotonic() + seconds, left;
    size_t before = fio_usb_transfers_pending(transfers);
    cancel(transfers, true, all);
    while (flying(transfers, true, all) && (left = end - fio_monotonic()) > 0)
        if (fio_usb_events_wait(events, NULL, 0, left) != FIO_OK)
            break;
    size_t forgotten = 0;
    for (int i = 0; i < FIO_USB_OUT_COUNT; i++) {
        fio_usb_out *out = &transfers->out[i];
        if (out->flying)
            continue;
        forgotten += (size_t)(out->size - out->done);
        out->done = out->size;
    }
    return before - forgotten;
}

/* A halted endpoint takes nothing until the halt is cleared, and it may not be cleared while
 * transfers are under way. One that stalls again at once is broken. */
static void clear_halt(fio_usb_transfers *self, bool *halted, int *stalls, bool out) {
    if (!*halted || self->lost)
        return;
    if (flying(self, out, !out)) {
        cancel(self, out, !out);
        return;
    }
    *halted = false;
    if (++*stalls > FIO_USB_STALLS_MOST) {
        fio_usb_transfers_lose(self, out ? "the printer refuses to take data (stall)"
                                         : "the printer refuses to send data (stall)");
        return;
    }
    int error = libusb_clear_halt(self->handle, out ? self->serial->out : self->serial->in);
    if (error)
        lose(self, error);
}

/* Send on what a stall stopped, in the order in which it was written. */
static void resume_out(fio_usb_transfers *self) {
    for (;;) {
        fio_usb_out *next = NULL;
        for (int i = 0; i < FIO_USB_OUT_COUNT; i++) {
            fio_usb_out *out = &self->out[i];
            if (!out->flying && !idle(out) && (!next || out->order < next->order))
                next = out;
        }
        if (!next || self->lost)
            return;
        submit_out(self, next);
    }
}

void fio_usb_transfers_service(fio_usb_transfers *transfers) {
    clear_halt(transfers, &transfers->in_halted, &transfers->in_stalls, false);
    clear_halt(transfers, &transfers->out_halted, &transfers->out_stalls, true);
    if (!transfers->in_halted &&
        (transfers->in_errors == 0 || fio_monotonic() >= transfers->in_retry))
        submit_in(transfers);
    if (!transfers->out_halted)
        resume_out(transfers);
}

double fio_usb_transfers_next(const fio_usb_transfers *transfers) {
    return transfers->in_errors > 0 && flying(transfers, false, true) < FIO_USB_IN_COUNT
               ? transfers->in_retry
               : INFINITY;
}

fio_status fio_usb_transfers_begin(fio_usb_transfers *transfers, libusb_device_handle *handle,
                                   fio_serial *serial) {
    transfers->handle = handle;
    transfers->serial = serial;
    size_t packet = serial->in_packet, most = serial->in_transfer;
    if (packet == 0 || packet > FIO_USB_IN_MOST || serial->out_packet == 0)
        return fio_fail(FIO_NO_PRINTER, "packets of %zu bytes in and %u out make no sense", packet,
                        serial->out_packet);
    if (most < packet || most > FIO_USB_IN_MOST)
        most = most < packet ? packet : FIO_USB_IN_MOST;
    transfers->in_size = most - most % packet;
    for (int i = 0; i < FIO_USB_IN_COUNT; i++) {
        fio_usb_in *in = &transfers->in[i];
        if (!(in->usb = libusb_alloc_transfer(0)))
            return fio_fail(FIO_NO_MEMORY, "no memory for USB transfers");
        in->owner = transfers;
        libusb_fill_bulk_transfer(in->usb, handle, serial->in, in->bytes, (int)transfers->in_size,
                                  received, in, 0);
    }
    for (int i = 0; i < FIO_USB_OUT_COUNT; i++) {
        fio_usb_out *out = &transfers->out[i];
        if (!(out->usb = libusb_alloc_transfer(0)))
            return fio_fail(FIO_NO_MEMORY, "no memory for USB transfers");
        out->owner = transfers;
        libusb_fill_bulk_transfer(out->usb, handle, serial->out, out->bytes, 0, sent, out, 0);
        if (serial->driver->wants_empty_packet)
            out->usb->flags |= LIBUSB_TRANSFER_ADD_ZERO_PACKET;
    }
    return FIO_OK;
}

void fio_usb_transfers_end(fio_usb_transfers *transfers) {
    for (int i = 0; i < FIO_USB_IN_COUNT; i++)
        libusb_free_transfer(transfers->in[i].usb);
    for (int i = 0; i < FIO_USB_OUT_COUNT; i++)
        libusb_free_transfer(transfers->out[i].usb);
}
