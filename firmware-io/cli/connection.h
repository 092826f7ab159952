/* The way from a name of a port to a printer that answers there. */
#ifndef FIO_CLI_CONNECTION_H
#define FIO_CLI_CONNECTION_H

#include <isoprint/port.h>

#include "arguments.h"
#include "control.h"

/* Wait for the port as long as asked for, open it and find its rate. `control` for signals. */
fio_status fio_connection_open(fio_transport **transport, const char *port,
                               const fio_arguments *arguments, fio_control *control) FIO_MUST_CHECK;

/* Ask what is there for its firmware: FIO_NO_PRINTER if nothing answers within `seconds`. `name`
 * has room for `size` bytes. */
fio_status fio_connection_probe(fio_transport *transport, int64_t rate, double seconds, char *name,
                                size_t size) FIO_MUST_CHECK;

/* The row of a firmware's name, as --firmware has it; FIO_USAGE lists them. NULL name: NULL. */
fio_status fio_connection_firmware(const fio_firmware **firmware, const char *name) FIO_MUST_CHECK;

#endif
