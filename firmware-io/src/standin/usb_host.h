/* The far end of the cable: what a host controller does with the URBs it is given, for a device
 * that exists only in software. It cuts transfers into packets, tries refused ones again and keeps
 * the order on each endpoint. Nothing waits; one thread at a time. */
#ifndef FIO_STANDIN_USB_HOST_H
#define FIO_STANDIN_USB_HOST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "virtual/usb_device.h"

/* A transfer under way: the caller's memory, from submit until it was reaped. */
typedef struct fio_urb fio_urb;
struct fio_urb {
    uint8_t endpoint;   /* its address; 0: control */
    uint8_t setup[8];   /* of a control transfer */
    uint8_t *data;      /* what goes out or comes in */
    int length;         /* bytes of data */
    bool empty_packet;  /* end a transfer of whole packets by an empty one */
    void *owner;        /* the caller's */
    const void *client; /* whoever may reap it */

    int status; /* 0, or -errno as Linux gives it, once reaped */
    int moved;  /* bytes */
    bool ended; /* only the empty packet is missing */
    fio_urb *next;
};

typedef struct fio_urb_queue {
    fio_urb *first, **end;
} fio_urb_queue;

enum { FIO_USB_ENDPOINTS = 32, FIO_USB_PACKET_MOST = 1024 };

typedef struct fio_usb_host {
    fio_virtual_usb *device;
    const fio_machine *machine;
    fio_urb_queue waiting[FIO_USB_ENDPOINTS]; /* by number, those of IN endpoints above */
    fio_urb_queue done;
    int packet[FIO_USB_ENDPOINTS]; /* bytes; 0: no such endpoint */
    int bulk_in;                   /* index of the endpoint that answers come over */
    uint32_t halted;               /* endpoints that stalled, until the host clears that */
    int64_t packets_out;           /* bulk */
    int64_t stall_at;              /* this one of them is stalled instead; -1: none */
    bool gone;
} fio_usb_host;

void fio_usb_host_begin(fio_usb_host *host, fio_virtual_usb *device, const fio_machine *machine);

/* Take a transfer. It may be done at once: look with reap(). */
void fio_usb_host_submit(fio_usb_host *host, double now, fio_urb *urb);

/* Give up a transfer that is not done: it is done then, with `status`. False: there is none such.
 */
bool fio_usb_host_cancel(fio_usb_host *host, const fio_urb *urb, int status);

/* The next one of `client` (NULL: of anyone) that is done, in the order in which they were; NULL.
 */
fio_urb *fio_usb_host_reap(fio_usb_host *host, const void *client);

/* Try again what was refused. True if any transfer was done. */
bool fio_usb_host_pump(fio_usb_host *host, double now);

/* When pump() is worth calling next, on the machine's clock; INFINITY: not before the host submits
 * something, since it does not ask for what there is. */
double fio_usb_host_next(const fio_usb_host *host);

/* An endpoint that stalled works again, as after CLEAR_FEATURE(ENDPOINT_HALT). */
void fio_usb_host_clear_halt(fio_usb_host *host, double now, uint8_t endpoint);

/* All that is under way ends with -ESHUTDOWN, and so does what is submitted from now on. */
void fio_usb_host_unplug(fio_usb_host *host);

#endif
