/* The ports there are, and what stands behind their names. */
#ifndef FIO_PORT_LIST_H
#define FIO_PORT_LIST_H

#include <isoprint/port.h>

#include "usb/device.h"

enum { FIO_PORTS_MOST = 2 * FIO_USB_DEVICES };

/* A port and, if it is one, the USB device. */
typedef struct fio_port_entry {
    fio_port port;
    const fio_usb_found *usb; /* NULL: a tty */
} fio_port_entry;

typedef struct fio_port_table {
    fio_usb_found found[FIO_USB_DEVICES];
    int found_count;
    fio_port_entry entries[FIO_PORTS_MOST];
    int count;
} fio_port_table;

/* Look at what there is now. Up to 1 s. */
void fio_port_table_read(fio_port_table *table);

/* Whether "usb:VID:PID[:SERIAL|@PLACE]" means this device; `name` is well-formed. */
bool fio_port_names(const char *name, const fio_usb_found *found);

/* Whether a name beginning with "usb:" is well-formed. */
bool fio_port_usb_name(const char *name);

#endif
