/* The transport over libusb. */
#ifndef FIO_USB_TRANSPORT_H
#define FIO_USB_TRANSPORT_H

#include <isoprint/transport.h>

#include "usb/device.h"

/* Open a device of fio_usb_list() that is `known`. The kernel's driver is sent away and comes back
 * at the end. `name` is what messages call it. FIO_NO_PRINTER with a message that says why and what
 * to do, FIO_USAGE for a rate it can't run at. Up to 1 s, or 1 s for each control request that the
 * device leaves unanswered. */
fio_status fio_usb_open(fio_transport **transport, const fio_usb_found *found, const char *name,
                        int64_t rate, bool raise_lines) FIO_MUST_CHECK;

/* Wait for any USB device to come or go, up to `seconds`: by hotplug events, or where there are
 * none for 0.2 s at the most. Early returns are allowed. */
typedef struct fio_usb_watch fio_usb_watch;
fio_status fio_usb_watch_open(fio_usb_watch **watch) FIO_MUST_CHECK;
fio_status fio_usb_watch_wait(fio_usb_watch *watch, double seconds) FIO_MUST_CHECK;
void fio_usb_watch_close(fio_usb_watch *watch); /* NULL is fine */

#endif
