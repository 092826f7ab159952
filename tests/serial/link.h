/* A driver and a virtual printer's chip, linked without a bus in between: requests go straight
 * over, packets by hand. */
#ifndef TESTS_SERIAL_LINK_H
#define TESTS_SERIAL_LINK_H

#include "serial/serial.h"
#include "virtual/usb_device.h"

typedef struct usb_link {
    fio_machine *machine;
    fio_virtual_usb *device;
    fio_serial serial;
    fio_usb_device found;
    double now;
    char text[4096]; /* what the printer said */
    size_t length;
    int packets, empty_packets, refused;
} usb_link;

/* A printer whose wire runs at `rate`, matched with its driver. `more` may be NULL. */
usb_link *link_plug(const char *chip, int64_t rate, const fio_virtual_usb_options *more);
void link_unplug(usb_link *l);

/* Let time pass, a tenth of a millisecond at a time, reading all the while. */
void link_run(usb_link *l, double seconds);

/* Packet by packet, waiting for room. */
void link_send(usb_link *l, const char *text);

/* True if M115 and a numbered M105 are answered as they should. */
bool link_talk(usb_link *l);

/* A control request by itself. */
int link_ask(usb_link *l, uint8_t type, uint8_t code, uint16_t value, uint16_t index, uint8_t *data,
             uint16_t length);

#endif
