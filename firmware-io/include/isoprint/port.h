/* The ports of this machine: finding and opening them. */
#ifndef ISOPRINT_PORT_H
#define ISOPRINT_PORT_H

#include <isoprint/transport.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fio_port {
    char name[128];  /* what fio_port_open() takes: "usb:2341:0042:SERIAL", "tty:/dev/ttyACM0" */
    char tty[64];    /* of a USB device: what the kernel calls the same port; "" */
    char driver[16]; /* "cdc-acm", "ch341", "ftdi", "cp210x", "pl2303", "tty" */
    char board[64];  /* "Arduino Mega 2560", or the device's own product name */
    char serial[64]; /* "" if it has none */
    uint16_t vendor, product;
    bool certain; /* its ID is a printer's; false: a general bridge that may be anything */
    bool allowed; /* we may open it; otherwise `reason` says why not and what to do */
    char reason[256];
} fio_port;

typedef struct fio_port_options {
    int64_t rate;    /* bits/s: 115200. Ignored where there is no wire (native USB, sockets) */
    bool keep_lines; /* open without raising DTR and RTS, so that a board does not reset */
    /* Of the printer behind "virtual", NULL: none. "NAME=NUMBER …", parted by blanks or commas:
     * members of fio_machine_options and of its faults ("flip_in=0.01, seed=3"), "firmware=NAME",
     * and "speed", as fio_machine_transport() takes it: 1. Its wire runs at `rate` unless
     * "rate=…" says otherwise. */
    const char *virtual_options;
} fio_port_options;

FIO_API fio_port_options fio_port_options_defaults(void);

/* All serial ports that a printer may be behind, certain ones first, then in order of their names.
 * A tty that belongs to a USB device of the list is not listed again, unless it may be opened where
 * the USB device may not. Devices alike in everything are told apart by where they are plugged in:
 * "usb:1a86:7523@1-2.3". *ports is the caller's, to be freed with fio_ports_free(), NULL if there
 * are none. Opens none of them. Up to 1 s. */
FIO_API fio_status fio_ports_list(fio_port **ports, int *count) FIO_MUST_CHECK;
FIO_API void fio_ports_free(fio_port *ports); /* NULL is fine */

/* Open by name:
 *   auto                    the only certain port, or else the only port there is
 *   usb:VID:PID[:SERIAL]    through libusb, four hexadecimal digits each
 *   usb:VID:PID@PLACE       by bus and port numbers, as the kernel writes them: 1-2.3
 *   tty:PATH                a serial device or a pseudo terminal
 *   socket:PATH, tcp:HOST:PORT
 *   virtual[:SCRIPT]        a printer in memory, that follows a script of faults
 * FIO_USAGE for a name that is none of these, FIO_NO_PRINTER with a message that says what is there
 * instead, or why it can't be opened and what to do. Up to 2 s. */
FIO_API fio_status fio_port_open(fio_transport **transport, const char *name,
                                 const fio_port_options *options) FIO_MUST_CHECK;

/* Wait for a port of this name to come (back), up to `seconds`: by hotplug events where there are,
 * else by looking. FIO_NO_PRINTER if it does not. */
FIO_API fio_status fio_port_wait(const char *name, double seconds) FIO_MUST_CHECK;

#ifdef __cplusplus
}
#endif

#endif
