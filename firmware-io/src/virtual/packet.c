#include "virtual/packet.h"

enum { TOKEN_LOW = 0xad, TOKEN_HIGH = 0xb5, SUMMED = FIO_PACKET_HEADER - 2 };

uint16_t fio_packet_sum(uint16_t sum, uint8_t byte) {
    unsigned low = ((sum & 0xffu) + byte) % 255, high = ((unsigned)(sum >> 8) + low) % 255;
    return (uint16_t)(high << 8 | low);
}

static uint16_t pair(const uint8_t *bytes) {
    return (uint16_t)(bytes[0] | bytes[1] << 8);
}

static fio_packet_event end(fio_packet *packet, fio_packet_event event) {
    packet->headed = packet->filled = packet->footed = 0;
    packet->sum = 0;
    return event;
}

static fio_packet_event take_header(fio_packet *packet, uint8_t byte) {
    if (packet->headed == 1 && byte != TOKEN_HIGH)
        packet->headed = 0; /* it may begin here */
    if (packet->headed == 0 && byte != TOKEN_LOW)
        return FIO_PACKET_NOTHING;
    bool right = packet->headed < FIO_PACKET_HEADER - 1 ||
                 (packet->header[SUMMED] | byte << 8) == packet->sum;
    packet->header[packet->headed++] = byte;
    if (packet->headed > 2 && packet->headed <= SUMMED)
        packet->sum = fio_packet_sum(packet->sum, byte);
    if (packet->headed < FIO_PACKET_HEADER)
        return FIO_PACKET_NOTHING;
    if (!right)
        return end(packet, FIO_PACKET_BAD_HEADER);
    for (int i = SUMMED; i < FIO_PACKET_HEADER; i++) /* the payload's checksum goes over it, too */
        packet->sum = fio_packet_sum(packet->sum, packet->header[i]);
    if (fio_packet_size(packet) > FIO_PACKET_PAYLOAD)
        return end(packet, FIO_PACKET_TOO_LONG);
    return fio_packet_size(packet) == 0 ? end(packet, FIO_PACKET_WHOLE) : FIO_PACKET_NOTHING;
}

fio_packet_event fio_packet_feed(fio_packet *packet, uint8_t byte) {
    if (packet->headed < FIO_PACKET_HEADER)
        return take_header(packet, byte);
    if (packet->filled < fio_packet_size(packet)) {
        packet->payload[packet->filled++] = byte;
        packet->sum = fio_packet_sum(packet->sum, byte);
        return FIO_PACKET_NOTHING;
    }
    packet->footer[packet->footed++] = byte;
    if (packet->footed < 2)
        return FIO_PACKET_NOTHING;
    bool right = pair(packet->footer) == packet->sum;
    return end(packet, right ? FIO_PACKET_WHOLE : FIO_PACKET_BAD_PAYLOAD);
}
