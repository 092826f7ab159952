/* A serial line in one direction: bytes leave one after the other, each after its time. */
#ifndef FIO_VIRTUAL_WIRE_H
#define FIO_VIRTUAL_WIRE_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes that wait to leave, and bytes that have arrived and wait to be read. A power of two. */
enum { FIO_WIRE_BYTES = 8192 };

typedef struct fio_wire {
    uint8_t bytes[FIO_WIRE_BYTES];
    unsigned first, arrived, last; /* counts: read, arrived, written; first ≤ arrived ≤ last */
    double byte_seconds;           /* 0: no wire */
    double next;                   /* when byte `arrived` arrives, if there is one */
    double free;                   /* when the last byte has */
} fio_wire;

static inline unsigned fio_wire_waiting(const fio_wire *wire) {
    return wire->last - wire->arrived;
}

static inline unsigned fio_wire_readable(const fio_wire *wire) {
    return wire->arrived - wire->first;
}

static inline unsigned fio_wire_room(const fio_wire *wire) {
    return FIO_WIRE_BYTES - (wire->last - wire->first);
}

/* When the next byte arrives; INFINITY: none is under way. */
static inline double fio_wire_next(const fio_wire *wire) {
    return wire->arrived == wire->last ? INFINITY : wire->next;
}

static inline uint8_t fio_wire_at(const fio_wire *wire, unsigned index) {
    return wire->bytes[index & (FIO_WIRE_BYTES - 1)];
}

/* One byte more at `now`; there is room. */
void fio_wire_put(fio_wire *wire, double now, uint8_t byte);

/* The next byte arrives: moves it to the readable ones. */
void fio_wire_arrive(fio_wire *wire);

/* When the last of the next line's bytes arrives, or of all bytes if there is no whole line. */
double fio_wire_line(const fio_wire *wire);

/* Bytes under way never arrive; returns how many. */
unsigned fio_wire_discard(fio_wire *wire, double now);

#endif
