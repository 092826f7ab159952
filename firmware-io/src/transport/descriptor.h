/* What ttys and sockets share: bytes over a descriptor that never blocks. */
#ifndef FIO_TRANSPORT_DESCRIPTOR_H
#define FIO_TRANSPORT_DESCRIPTOR_H

#include <isoprint/transport.h>

enum { FIO_DESCRIPTOR_HELD = 512, FIO_DESCRIPTOR_POLLS = 32 };

typedef struct fio_descriptor {
    fio_transport transport; /* comes first */
    int file;
    bool socket; /* send() instead of write(): no signal when the other end is gone */
    /* What asks the kernel how much it holds: in bytes if `counted`. Of unix sockets it tells
     * memory instead, of which only "none" means anything: then what was written since the last
     * time there was none is an upper bound. */
    unsigned long question;
    bool counted;
    size_t since_empty;
    size_t held_most; /* what it said last, and all since: it is asked only when that is too much */
    double drain;     /* s until some of a full queue has left */
    bool lost;
    char name[160]; /* "tty:/dev/ttyACM0" */
    char loss[368];
} fio_descriptor;

/* The link is lost, for the first reason that was given. */
fio_status fio_descriptor_lose(fio_descriptor *descriptor, const char *format, ...)
    FIO_PRINTF(2, 3);

/* Members of fio_transport_type. */
fio_status fio_descriptor_read(fio_transport *transport, void *bytes, size_t capacity,
                               size_t *count);
fio_status fio_descriptor_write(fio_transport *transport, const void *bytes, size_t size,
                                size_t *taken);
size_t fio_descriptor_pending(const fio_transport *transport);
fio_status fio_descriptor_wait(fio_transport *transport, bool writing, struct pollfd *others,
                               int count, double seconds);
double fio_descriptor_now(const fio_transport *transport);

/* The monotonic clock, s. */
double fio_monotonic(void);

/* A time limit as poll() wants it, rounded up; at most an hour. */
int fio_poll_milliseconds(double seconds);

/* Let what is pending leave, for at most `seconds`. */
void fio_descriptor_drain(fio_descriptor *descriptor, double seconds);

#endif
