#include "virtual/wire.h"

void fio_wire_put(fio_wire *wire, double now, uint8_t byte) {
    double start = now > wire->free ? now : wire->free;
    wire->free = start + wire->byte_seconds;
    if (wire->arrived == wire->last)
        wire->next = wire->free;
    wire->bytes[wire->last++ & (FIO_WIRE_BYTES - 1)] = byte;
}

void fio_wire_arrive(fio_wire *wire) {
    wire->arrived++;
    wire->next += wire->byte_seconds;
}

double fio_wire_line(const fio_wire *wire) {
    if (wire->arrived == wire->last)
        return INFINITY;
    double time =
        wire->next; /* summed as the bytes arrive, so that it is the same to the last bit */
    for (unsigned i = wire->arrived; i + 1 != wire->last && fio_wire_at(wire, i) != '\n'; i++)
        time += wire->byte_seconds;
    return time;
}

unsigned fio_wire_discard(fio_wire *wire, double now) {
    unsigned lost = fio_wire_waiting(wire);
    wire->last = wire->arrived;
    if (wire->free > now)
        wire->free = now;
    return lost;
}
