/* The virtual printer as a USB device that one command sees, by umockdev. */
#ifndef FIO_STANDIN_MOCK_H
#define FIO_STANDIN_MOCK_H

#include "standin/standin.h"
#include "virtual/usb_device.h"

typedef struct fio_mock_options {
    bool denied;      /* the node may not be opened */
    bool bound;       /* Linux' own driver has it at first */
    int64_t stall_at; /* this bulk packet from the host is stalled instead, 0 = the first; -1 */
} fio_mock_options;

/* See that umockdev's library is preloaded, here and in the commands that are run: if it is not,
 * the program is executed again, as `argv`, with it. Call it first of all. */
fio_status fio_mock_preload(char **argv) FIO_MUST_CHECK;

/* Plug it in. FIO_NOT_WRITTEN if the module or umockdev is not there; the message says what to
 * install. */
fio_status fio_standin_mock(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                            fio_virtual_usb *device,
                            const fio_mock_options *options) FIO_MUST_CHECK;

/* Interfaces that Linux' driver has (again), of those that it had at first. */
void fio_mock_bound(fio_standin *standin, int *now, int *first);

#endif
