/* Between the program and its module isoprint-umockdev.so, which alone knows glib and umockdev: it
 * makes a device node whose ioctls are answered by a usb_host.h. */
#ifndef FIO_STANDIN_UMOCKDEV_H
#define FIO_STANDIN_UMOCKDEV_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "standin/usb_host.h"

#define FIO_UMOCKDEV_VERSION 1
#define FIO_UMOCKDEV_ENTRY "fio_umockdev_module_table"

/* What the module calls, on umockdev's own thread: all with the lock that is taken by lock(). */
typedef struct fio_umockdev_host {
    void *context;
    void (*lock)(void *context);
    void (*unlock)(void *context);
    void (*submit)(void *context, fio_urb *urb);
    bool (*cancel)(void *context, const fio_urb *urb, int status);
    fio_urb *(*reap)(void *context, const void *client);
    void (*clear_halt)(void *context, uint8_t endpoint);
} fio_umockdev_host;

typedef struct fio_umockdev_device {
    const uint8_t *descriptors; /* device, then configuration */
    size_t size;
    const char *manufacturer, *product, *serial; /* NULL: none */
    bool high_speed;
    bool denied; /* nobody may open the node */
    bool bound;  /* Linux' own driver has it at first */
} fio_umockdev_device;

typedef struct fio_umockdev fio_umockdev;

/* All but open() and close() are called with the lock held; plug() lets go of it for a while, since
 * umockdev waits for its thread at times. */
typedef struct fio_umockdev_module {
    int version;
    /* NULL on failure, with what failed in `reason`. The device is plugged in at once. Texts and
     * descriptors must outlive it. */
    fio_umockdev *(*open)(const fio_umockdev_host *host, const fio_umockdev_device *device,
                          char reason[256]);
    /* Whether poll() says at the node that there is something to reap. */
    void (*gate)(fio_umockdev *mock, bool open);
    /* Send the events of a device that went or came. False: it could not be put back. */
    bool (*plug)(fio_umockdev *mock, bool in);
    /* Interfaces that Linux' driver has now, of those it had at first. */
    void (*bound)(const fio_umockdev *mock, int *now, int *first);
    void (*close)(fio_umockdev *mock);
} fio_umockdev_module;

#endif
