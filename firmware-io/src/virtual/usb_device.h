/* The virtual printer as a USB device: descriptors, control requests and bulk packets of one of the
 * chips that printers have, around a fio_machine. It knows nothing of how it is plugged in: the
 * stand-ins for a host controller (umockdev, USB/IP) call it. */
#ifndef FIO_VIRTUAL_USB_DEVICE_H
#define FIO_VIRTUAL_USB_DEVICE_H

#include <isoprint/machine.h>

typedef struct fio_virtual_usb fio_virtual_usb;

typedef struct fio_virtual_usb_options {
    const char *chip;         /* "cdc-acm", "ch340", "ch340-limited", "ftdi", "ftdi-h", "cp2102",
                                 "pl2303hx", "pl2303hxn" */
    uint16_t vendor, product; /* 0: the chip's own */
    const char *serial;       /* NULL: "VP0001" */
    bool no_union;            /* cdc-acm: leave the Union descriptor out */
    /* Tells of each control request, for traces; NULL. */
    void (*trace)(void *context, const uint8_t setup[8], const uint8_t *data, int moved);
    void *trace_context;
} fio_virtual_usb_options;

fio_status fio_virtual_usb_create(fio_virtual_usb **device, fio_machine *machine,
                                  const fio_virtual_usb_options *options) FIO_MUST_CHECK;
void fio_virtual_usb_free(fio_virtual_usb *device); /* the machine stays the caller's */

/* Device and configuration descriptors, as the kernel keeps them in sysfs. */
const uint8_t *fio_virtual_usb_descriptors(const fio_virtual_usb *device, size_t *size);
const char *fio_virtual_usb_string(const fio_virtual_usb *device, int index); /* 1, 2, 3; NULL */
bool fio_virtual_usb_high_speed(const fio_virtual_usb *device); /* 480 Mbit/s instead of 12 */

enum { FIO_USB_STALL = -1, FIO_USB_NAK = -2, FIO_USB_GONE = -3 };

/* A control transfer: `data` holds what the host sends, or receives the answer. Returns the bytes
 * moved or one of the above. */
int fio_virtual_usb_control(fio_virtual_usb *device, double now, const uint8_t setup[8],
                            uint8_t *data, int capacity);

/* One packet from the host: taken whole, or FIO_USB_NAK while there is no room. */
int fio_virtual_usb_out(fio_virtual_usb *device, double now, uint8_t endpoint, const uint8_t *bytes,
                        int size);

/* One packet for the host, at most the endpoint's size; FIO_USB_NAK if there is none yet. A short
 * packet ends a transfer. */
int fio_virtual_usb_in(fio_virtual_usb *device, double now, uint8_t endpoint, uint8_t *bytes,
                       int capacity);

/* When to try a refused packet again, as fio_machine_next(). */
double fio_virtual_usb_next(const fio_virtual_usb *device);

#endif
