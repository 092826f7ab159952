#include "standin/usbip_wire.h"

#include <stdio.h>
#include <string.h>

enum { LIST = 5, IMPORT = 3, REQUEST = 0x80, VERSION = 0x0111, ZERO_PACKET = 0x40 };

static const char busid[] = "1-1";

static uint32_t get32(const uint8_t *bytes) {
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static uint8_t *put32(uint8_t *bytes, uint32_t value) {
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(value >> (24 - 8 * i));
    return bytes + 4;
}

static uint8_t *put16(uint8_t *bytes, unsigned value) {
    bytes[0] = (uint8_t)(value >> 8);
    bytes[1] = (uint8_t)value;
    return bytes + 2;
}

bool fio_usbip_read(fio_usbip_header *header, const uint8_t bytes[FIO_USBIP_HEADER]) {
    uint32_t command = get32(bytes), endpoint = get32(bytes + 16), length = get32(bytes + 24);
    if ((command != FIO_USBIP_SUBMIT && command != FIO_USBIP_UNLINK) || endpoint > 15)
        return false;
    *header = (fio_usbip_header){
        .command = (fio_usbip_command)command,
        .sequence = get32(bytes + 4),
        .in = get32(bytes + 12) != 0,
        .empty_packet = get32(bytes + 20) & ZERO_PACKET,
        .length = length <= FIO_USBIP_TRANSFER ? (int)length : -1,
        .unlink = get32(bytes + 20),
    };
    header->endpoint = (uint8_t)(endpoint | (header->in && endpoint ? 0x80 : 0));
    memcpy(header->setup, bytes + 40, 8);
    return true;
}

void fio_usbip_write(uint8_t bytes[FIO_USBIP_HEADER], fio_usbip_command command, uint32_t sequence,
                     int status, int moved) {
    memset(bytes, 0, FIO_USBIP_HEADER);
    put32(bytes, (uint32_t)command);
    put32(bytes + 4, sequence);
    put32(bytes + 20, (uint32_t)status);
    if (command == FIO_USBIP_SUBMITTED) {
        put32(bytes + 24, (uint32_t)moved);
        put32(bytes + 32, UINT32_MAX); /* no packets: it is not isochronous */
    }
}

size_t fio_usbip_request_size(const uint8_t beginning[FIO_USBIP_REQUEST]) {
    if (beginning[2] != REQUEST)
        return 0;
    return beginning[3] == LIST     ? FIO_USBIP_REQUEST
           : beginning[3] == IMPORT ? FIO_USBIP_REQUEST + FIO_USBIP_BUSID
                                    : 0;
}

int fio_usbip_speed(const fio_virtual_usb *device) {
    size_t size;
    const uint8_t *bytes = fio_virtual_usb_descriptors(device, &size);
    for (size_t at = 0; at + 7 <= size && bytes[at] >= 2; at += bytes[at])
        if (bytes[at + 1] == 5 && (bytes[at + 5] & 6) == 2)
            return 3; /* a bulk endpoint of 512 bytes */
    return 2;
}

static uint8_t *put_device(uint8_t *to, const fio_virtual_usb *device) {
    size_t size;
    const uint8_t *bytes = fio_virtual_usb_descriptors(device, &size);
    memset(to, 0, FIO_USBIP_DEVICE);
    snprintf((char *)to, 256, "/sys/devices/virtual/isoprint/%s", busid);
    memcpy(to + 256, busid, sizeof busid);
    uint8_t *at = put32(to + 288, FIO_USBIP_BUS);
    at = put32(put32(at, FIO_USBIP_NUMBER), (uint32_t)fio_usbip_speed(device));
    for (int i = 8; i < 14; i += 2) /* vendor, product, release */
        at = put16(at, bytes[i] | (unsigned)bytes[i + 1] << 8);
    memcpy(at, bytes + 4, 3); /* class, subclass, protocol */
    at[3] = bytes[18 + 5];    /* configuration value */
    at[4] = bytes[17];
    at[5] = bytes[18 + 4]; /* interfaces */
    return at + 6;
}

static uint8_t *put_interfaces(uint8_t *to, const fio_virtual_usb *device) {
    size_t size;
    const uint8_t *bytes = fio_virtual_usb_descriptors(device, &size);
    int left = 32;
    for (size_t at = 0; at + 9 <= size && bytes[at] >= 2 && left > 0; at += bytes[at])
        if (bytes[at + 1] == 4 && bytes[at + 3] == 0) {
            memcpy(to, bytes + at + 5, 3);
            to[3] = 0;
            to += 4;
            left--;
        }
    return to;
}

size_t fio_usbip_answer(uint8_t reply[FIO_USBIP_REPLY_MOST], const fio_virtual_usb *device,
                        const uint8_t *request, bool free, bool *imported) {
    bool list = request[3] == LIST;
    const char *wanted = (const char *)request + FIO_USBIP_REQUEST;
    bool there = free && (list || (memchr(wanted, 0, FIO_USBIP_BUSID) && !strcmp(wanted, busid)));
    *imported = there && !list;
    uint8_t *at = put16(put16(reply, VERSION), request[3]);
    at = put32(at, !list && !there);
    if (list)
        at = put32(at, there);
    if (there)
        at = put_device(at, device);
    if (there && list)
        at = put_interfaces(at, device);
    return (size_t)(at - reply);
}
