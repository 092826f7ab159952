/* A way for bytes to and from a printer: USB, a tty, a socket, or a printer that exists in memory.
 *
 * One thread owns a transport and calls all of its functions. Only fio_transport_wait(), _close()
 * and the two settings may block, for as long as is said below; none of the others ever waits.
 * Every function but close() may give FIO_LINK_LOST, with a message that says what happened to
 * which port; from then on it gives that at every call. Bytes received before the loss are still
 * read first. */
#ifndef ISOPRINT_TRANSPORT_H
#define ISOPRINT_TRANSPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/status.h>

#ifdef __cplusplus
extern "C" {
#endif

struct pollfd;

typedef struct fio_transport fio_transport;

/* What a transport is made of. A member may be NULL only where it says so. */
typedef struct fio_transport_type {
    const char *name; /* "usb", "tty", "socket", "memory" */

    /* Take what has arrived, at most `capacity` bytes; *count 0 if there is nothing. */
    fio_status (*read)(fio_transport *transport, void *bytes, size_t capacity, size_t *count);

    /* Take as many of `size` bytes as there is room for, in order; *taken 0 under back-pressure. A
     * transport holds back few bytes (one or two packets, at most 512), so that what is written
     * next, an emergency stop above all, has little in front of it. */
    fio_status (*write)(fio_transport *transport, const void *bytes, size_t size, size_t *taken);

    /* Bytes taken by write() that have not left this host yet, as far as it can know. */
    size_t (*pending)(const fio_transport *transport);

    /* Forget bytes taken and not yet left. *kept: how many of them left all the same. Up to 0.1 s.
     */
    fio_status (*discard)(fio_transport *transport, size_t *kept);

    /* Return once there is something to read, room to write (if `writing`), an event of one of the
     * `count` further descriptors (its revents are set), a loss, or after `seconds` of now(); early
     * returns for no reason are allowed. The only function that makes time pass. */
    fio_status (*wait)(fio_transport *transport, bool writing, struct pollfd *others, int count,
                       double seconds);

    /* Seconds since any fixed moment, never going back: the clock of whoever drives this transport.
     * Real ones give the monotonic clock, those in memory may give a virtual one. */
    double (*now)(const fio_transport *transport);

    /* Change the rate, or the two modem lines. Up to 1 s. NULL: there is no such thing here. */
    fio_status (*set_rate)(fio_transport *transport, int64_t bits_per_second);
    fio_status (*set_lines)(fio_transport *transport, bool dtr, bool rts);

    /* Let go of the port, as it was found, and free the transport. Up to 1 s. */
    void (*close)(fio_transport *transport);
} fio_transport_type;

/* Comes first in the struct of every transport. */
struct fio_transport {
    const fio_transport_type *type;
};

static inline FIO_MUST_CHECK fio_status fio_transport_read(fio_transport *transport, void *bytes,
                                                           size_t capacity, size_t *count) {
    return transport->type->read(transport, bytes, capacity, count);
}

static inline FIO_MUST_CHECK fio_status fio_transport_write(fio_transport *transport,
                                                            const void *bytes, size_t size,
                                                            size_t *taken) {
    return transport->type->write(transport, bytes, size, taken);
}

static inline size_t fio_transport_pending(const fio_transport *transport) {
    return transport->type->pending(transport);
}

static inline FIO_MUST_CHECK fio_status fio_transport_discard(fio_transport *transport,
                                                              size_t *kept) {
    return transport->type->discard(transport, kept);
}

static inline FIO_MUST_CHECK fio_status fio_transport_wait(fio_transport *transport, bool writing,
                                                           struct pollfd *others, int count,
                                                           double seconds) {
    return transport->type->wait(transport, writing, others, count, seconds);
}

static inline double fio_transport_now(const fio_transport *transport) {
    return transport->type->now(transport);
}

static inline void fio_transport_close(fio_transport *transport) { /* NULL is fine */
    if (transport)
        transport->type->close(transport);
}

#ifdef __cplusplus
}
#endif

#endif
