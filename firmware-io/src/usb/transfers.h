/* Bulk transfers under way: several IN at once into a ring, at most two OUT. */
#ifndef FIO_USB_TRANSFERS_H
#define FIO_USB_TRANSFERS_H

#include <libusb.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/status.h>

#include "serial/serial.h"
#include "usb/events.h"

enum {
    FIO_USB_IN_COUNT =
        16, /* of 32 bytes with a CH340: 20 ms of 250000 bits/s that we may be late */
    FIO_USB_IN_MOST = 1024,
    FIO_USB_OUT_COUNT = 2,
    FIO_USB_OUT_MOST = 256, /* bytes each: what is in front of an emergency stop */
    FIO_USB_RING = 16384,
    FIO_USB_ERRORS_MOST = 160, /* in a row: some ten tries of all IN transfers */
    FIO_USB_STALLS_MOST = 1    /* in a row */
};

typedef struct fio_usb_transfers fio_usb_transfers;

typedef struct fio_usb_in {
    struct libusb_transfer *usb;
    fio_usb_transfers *owner;
    bool flying;
    uint8_t bytes[FIO_USB_IN_MOST];
} fio_usb_in;

typedef struct fio_usb_out {
    struct libusb_transfer *usb;
    fio_usb_transfers *owner;
    bool flying;
    int size, done; /* bytes; done < size and not flying: stopped by a stall, to be sent on */
    int64_t order;
    uint8_t bytes[FIO_USB_OUT_MOST];
} fio_usb_out;

struct fio_usb_transfers {
    libusb_device_handle *handle;
    fio_serial *serial;
    fio_usb_in in[FIO_USB_IN_COUNT];
    fio_usb_out out[FIO_USB_OUT_COUNT];
    size_t in_size;     /* bytes asked for at once: whole packets */
    size_t first, used; /* of the ring */
    size_t promised;    /* room in the ring that IN transfers under way may need */
    int in_errors;      /* in a row */
    double in_retry;    /* the time before which a failed one is not tried again */
    bool in_halted, out_halted;
    int in_stalls, out_stalls; /* in a row */
    int64_t orders;
    bool lost;
    char loss[96];
    uint8_t ring[FIO_USB_RING];
};

/* FIO_NO_MEMORY. `transfers` stays where it is; end it also after a failure. */
fio_status fio_usb_transfers_begin(fio_usb_transfers *transfers, libusb_device_handle *handle,
                                   fio_serial *serial) FIO_MUST_CHECK;

/* Free what begin() made; none may be flying, or the handle must be closed. */
void fio_usb_transfers_end(fio_usb_transfers *transfers);

/* Set going what can go: IN transfers there is room for, endpoints that stalled. After each wait.
 */
void fio_usb_transfers_service(fio_usb_transfers *transfers);

/* The time of the next service() that is due although nothing happens; INFINITY. */
double fio_usb_transfers_next(const fio_usb_transfers *transfers);

size_t fio_usb_transfers_read(fio_usb_transfers *transfers, void *bytes, size_t capacity);
size_t fio_usb_transfers_write(fio_usb_transfers *transfers, const void *bytes, size_t size);
bool fio_usb_transfers_writable(const fio_usb_transfers *transfers);
size_t fio_usb_transfers_pending(const fio_usb_transfers *transfers);

/* Give up the OUT transfers, or all, and wait for their ends, up to `seconds`. Returns how many
 * bytes of those OUT have left, or may still leave. */
size_t fio_usb_transfers_cancel(fio_usb_transfers *transfers, fio_usb_events *events, bool all,
                                double seconds);

/* Remember the first reason of a loss. */
void fio_usb_transfers_lose(fio_usb_transfers *transfers, const char *why);

#endif
