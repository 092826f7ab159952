/* Marlin's binary file transfer (M28 B1): packets with a Fletcher checksum instead of lines.
 *
 * A packet is AD B5, its number, protocol << 4 | type, the payload's size (two bytes, low first),
 * the checksum of these four; then, if there is a payload, it and the checksum of everything from
 * the number on. */
#ifndef FIO_VIRTUAL_PACKET_H
#define FIO_VIRTUAL_PACKET_H

#include <stdbool.h>
#include <stdint.h>

enum { FIO_PACKET_PAYLOAD = 96, FIO_PACKET_HEADER = 8, FIO_PACKET_RETRY_MILLISECONDS = 500 };

typedef enum fio_packet_event {
    FIO_PACKET_NOTHING, /* yet */
    FIO_PACKET_WHOLE,
    FIO_PACKET_BAD_HEADER,
    FIO_PACKET_BAD_PAYLOAD,
    FIO_PACKET_TOO_LONG
} fio_packet_event;

typedef struct fio_packet {
    uint8_t header[FIO_PACKET_HEADER], payload[FIO_PACKET_PAYLOAD], footer[2];
    int headed, filled, footed; /* bytes there of each */
    uint16_t sum;
} fio_packet;

static inline int fio_packet_number(const fio_packet *packet) {
    return packet->header[2];
}

static inline int fio_packet_kind(const fio_packet *packet) { /* protocol << 4 | type */
    return packet->header[3];
}

static inline int fio_packet_size(const fio_packet *packet) {
    return packet->header[4] | packet->header[5] << 8;
}

uint16_t fio_packet_sum(uint16_t sum, uint8_t byte);

/* One byte more; after anything but NOTHING the next one begins a new packet. */
fio_packet_event fio_packet_feed(fio_packet *packet, uint8_t byte);

/* In the middle of one. */
static inline bool fio_packet_begun(const fio_packet *packet) {
    return packet->headed >= 2;
}

#endif
