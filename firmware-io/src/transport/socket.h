/* A printer behind a socket: an emulator, a network bridge, a printer with WiFi. */
#ifndef FIO_TRANSPORT_SOCKET_H
#define FIO_TRANSPORT_SOCKET_H

#include <isoprint/transport.h>

/* A stream socket in the file system. FIO_NO_PRINTER if nobody answers within `seconds`. */
fio_status fio_socket_open_path(fio_transport **transport, const char *path,
                                double seconds) FIO_MUST_CHECK;

/* "HOST:PORT", "[IPv6]:PORT". The same; looking up a host's name takes what the system's resolver
 * takes, on top of `seconds`. FIO_USAGE for text that is no such address. */
fio_status fio_socket_open_host(fio_transport **transport, const char *address,
                                double seconds) FIO_MUST_CHECK;

#endif
