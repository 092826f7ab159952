/* Messages of USB/IP, version 1.1.1, all numbers big-endian. */
#ifndef FIO_STANDIN_USBIP_WIRE_H
#define FIO_STANDIN_USBIP_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "virtual/usb_device.h"

enum {
    FIO_USBIP_HEADER = 48,        /* bytes of each message about a URB */
    FIO_USBIP_REQUEST = 8,        /* bytes of a request's beginning */
    FIO_USBIP_BUSID = 32,         /* bytes of a bus ID */
    FIO_USBIP_DEVICE = 312,       /* bytes that describe a device */
    FIO_USBIP_TRANSFER = 1 << 20, /* bytes of the largest transfer taken */
    FIO_USBIP_BUS = 1,
    FIO_USBIP_NUMBER = 2, /* of the device on it */
    FIO_USBIP_REPLY_MOST = FIO_USBIP_REQUEST + 4 + FIO_USBIP_DEVICE + 4 * 32
};

typedef enum fio_usbip_command {
    FIO_USBIP_SUBMIT = 1,
    FIO_USBIP_UNLINK = 2,
    FIO_USBIP_SUBMITTED = 3,
    FIO_USBIP_UNLINKED = 4
} fio_usbip_command;

typedef struct fio_usbip_header {
    fio_usbip_command command;
    uint32_t sequence;
    uint8_t endpoint; /* address, with its direction; 0: control */
    bool in;
    bool empty_packet;
    int length; /* bytes of the transfer; -1: more than is taken, or negative */
    uint8_t setup[8];
    uint32_t unlink; /* the sequence number to give up */
} fio_usbip_header;

/* False for a message that is none. */
bool fio_usbip_read(fio_usbip_header *header, const uint8_t bytes[FIO_USBIP_HEADER]);
void fio_usbip_write(uint8_t bytes[FIO_USBIP_HEADER], fio_usbip_command command, uint32_t sequence,
                     int status, int moved);

/* The answer to a list (0x8005) or an import (0x8003) request; 0 bytes: it is neither. `free`: the
 * device may be imported. *imported: it is, from now on. */
size_t fio_usbip_answer(uint8_t reply[FIO_USBIP_REPLY_MOST], const fio_virtual_usb *device,
                        const uint8_t *request, bool free, bool *imported);

/* Bytes of a request that begins so; 0: it is none. */
size_t fio_usbip_request_size(const uint8_t beginning[FIO_USBIP_REQUEST]);

int fio_usbip_speed(const fio_virtual_usb *device); /* 2 full, 3 high: enum usb_device_speed */

#endif
