/* Drivers of USB serial bridges: which control requests set them up, and what wraps their bytes.
 *
 * A driver knows nothing of libusb: its requests go through a function, so that a test compares
 * them with what Linux' own drivers send. */
#ifndef FIO_SERIAL_SERIAL_H
#define FIO_SERIAL_SERIAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/status.h>

/* One control transfer on endpoint 0. `data` is read or filled by the direction in `type` (bit 7).
 * *moved: bytes of it that were transferred. *stalled: the device refused it (which a driver may
 * expect); then FIO_OK all the same. Up to 1 s. */
typedef struct fio_control {
    fio_status (*request)(void *context, uint8_t type, uint8_t request, uint16_t value,
                          uint16_t index, void *data, uint16_t length, uint16_t *moved,
                          bool *stalled);
    void *context;
} fio_control;

/* What of a device's descriptors a driver looks at. */
typedef struct fio_usb_endpoint {
    uint8_t address, kind; /* bmAttributes & 3 */
    uint16_t packet;       /* bytes */
} fio_usb_endpoint;

typedef struct fio_usb_interface {
    uint8_t number, alternate, class_code, subclass, protocol;
    int endpoint_count;
    fio_usb_endpoint endpoints[8];
    int union_data; /* CDC Union descriptor (24 06): the data interface; -1 */
} fio_usb_interface;

enum { FIO_USB_INTERFACES = 16 };

typedef struct fio_usb_device {
    uint16_t vendor, product, release; /* bcdDevice */
    uint16_t version;                  /* bcdUSB */
    uint8_t class_code;
    uint8_t control_packet; /* bytes a packet of endpoint 0 carries */
    bool high_speed;        /* as the size of its bulk packets tells */
    int interface_count;
    fio_usb_interface interfaces[FIO_USB_INTERFACES]; /* each alternate setting counts */
} fio_usb_device;

/* Read raw descriptors, as sysfs keeps them: device, then configuration, the first of which counts.
 * Interfaces and endpoints there is no room for are left out. False for damaged ones, and *device
 * is untouched; never reads beyond `size`. */
bool fio_usb_device_read(fio_usb_device *device, const uint8_t *bytes, size_t size);

typedef struct fio_serial_driver fio_serial_driver;

/* A rate may be off by so much; what is further off is refused, and never tried. */
enum { FIO_SERIAL_RATE_ERROR = 3 /* % */ };

/* An opened bridge. Plain data: nothing to free. match() fills all but `control`. */
typedef struct fio_serial {
    const fio_serial_driver *driver;
    fio_control control;
    int interfaces[2],
        interface_count; /* to claim, in this order; to be released the other way: data first */
    uint8_t in, out;     /* endpoints */
    uint16_t in_packet, out_packet; /* bytes */
    uint16_t in_transfer; /* bytes to ask for at once: one packet, as many chips and boards do not
                           * end a transfer of full packets by an empty one; several where that
                           * can't happen */
    int chip;             /* a driver's own: which variant it found */
    int64_t rate;         /* as asked for */
    int64_t line_errors;  /* bytes that the bridge itself saw arrive damaged, or lost */
    bool dtr, rts;
    uint8_t state[16]; /* a driver's own */
} fio_serial;

struct fio_serial_driver {
    const char *name; /* "cdc-acm" */
    bool (*match)(fio_serial *serial,
                  const fio_usb_device *device); /* fills endpoints and interfaces */
    /* 8 data bits, no parity, no flow control. Without raise_lines DTR and RTS stay as they are.
     * FIO_NO_PRINTER if the bridge refuses what it must be able to do. */
    fio_status (*open)(fio_serial *serial, int64_t rate, bool raise_lines);
    fio_status (*set_rate)(fio_serial *serial,
                           int64_t rate); /* FIO_USAGE: it can't, the message says the nearest */
    fio_status (*set_lines)(fio_serial *serial, bool dtr, bool rts);
    fio_status (*close)(fio_serial *serial); /* lowers the lines again that it raised */
    /* Take what is no data out of a transfer's bytes, in place: whole packets of in_packet bytes,
     * the last may be shorter. Returns the bytes left. NULL: nothing is wrapped. */
    size_t (*unwrap)(fio_serial *serial, uint8_t *bytes, size_t size);
    bool wants_empty_packet; /* after an OUT transfer of whole packets */
};

/* All drivers, in the order they are tried; ends with NULL. */
extern const fio_serial_driver *const fio_serial_drivers[];

/* The driver for a device; false if it is no serial port that we know. */
bool fio_serial_match(fio_serial *serial, const fio_usb_device *device);

/* Names of known boards and bridges: "Arduino Mega 2560"; NULL. *certain: it is a printer's. */
const char *fio_serial_board(uint16_t vendor, uint16_t product, bool *certain);

/* The IDs it knows, one after the other; false behind the last. */
bool fio_serial_board_at(int index, uint16_t *vendor, uint16_t *product);

#endif
