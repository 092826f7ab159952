/* The USB devices there are, as the kernel describes them. */
#ifndef FIO_USB_DEVICE_H
#define FIO_USB_DEVICE_H

#include <stdbool.h>
#include <stdint.h>

#include <isoprint/status.h>

#include "serial/serial.h"

enum { FIO_USB_DEVICES = 256 };

typedef struct fio_usb_found {
    char place[32]; /* "1-2.3": bus and ports */
    int bus, address;
    char node[40]; /* "/dev/bus/usb/001/004" */
    uint16_t vendor, product;
    char serial[64], label[64]; /* what it says of itself: "" if nothing; any bytes but controls */
    char tty[32];               /* "/dev/ttyACM0": the kernel's driver has made one of it; "" */
    char kernel[32];            /* the kernel driver of its first interface for us: "cdc_acm"; "" */
    int configuration; /* 0: the system is not done with it yet, or the hub has no power for it */
    bool known;        /* `link` is a serial port of ours */
    fio_serial link;   /* matched, not opened */
} fio_usb_found;

/* All devices but hubs, in the order of their places. `found` has room for FIO_USB_DEVICES.
 * Returns how many; 0 where there is no USB. Opens none of them. */
int fio_usb_list(fio_usb_found *found);

/* Whether it is ready and we may open it. */
bool fio_usb_allowed(const fio_usb_found *found);

#endif
