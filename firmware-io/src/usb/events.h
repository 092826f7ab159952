/* libusb's events, in a loop of ours: one thread, one poll(). */
#ifndef FIO_USB_EVENTS_H
#define FIO_USB_EVENTS_H

#include <libusb.h>
#include <poll.h>
#include <stdbool.h>

#include <isoprint/status.h>

enum { FIO_USB_POLLS = 16, FIO_USB_OTHERS = 32 };

typedef struct fio_usb_events {
    libusb_context *context;
    struct pollfd polls[FIO_USB_POLLS]; /* libusb's; it tells of changes */
    int count;
    bool clocked; /* libusb has no timer among them: it must be asked when to look again */
} fio_usb_events;

/* `events` must stay where it is until it is closed. FIO_NO_PRINTER where there is no USB. */
fio_status fio_usb_events_open(fio_usb_events *events) FIO_MUST_CHECK;
void fio_usb_events_close(fio_usb_events *events); /* a zeroed one is fine */

/* Wait for anything of libusb's or of the others, at most `seconds`, and let libusb call back. */
fio_status fio_usb_events_wait(fio_usb_events *events, struct pollfd *others, int count,
                               double seconds) FIO_MUST_CHECK;

#endif
