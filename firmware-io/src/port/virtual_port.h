/* The port "virtual": a printer in memory, in real time. */
#ifndef FIO_PORT_VIRTUAL_PORT_H
#define FIO_PORT_VIRTUAL_PORT_H

#include <isoprint/port.h>

/* `script`: the path of a script of faults, NULL for none. FIO_USAGE for options or a script that
 * are wrong, FIO_UNREADABLE for a script that can't be read. */
fio_status fio_virtual_port_open(fio_transport **transport, const char *script,
                                 const fio_port_options *options) FIO_MUST_CHECK;

#endif
