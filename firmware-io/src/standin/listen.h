/* Sockets that wait for hosts; all are non-blocking and closed on exec. */
#ifndef FIO_STANDIN_LISTEN_H
#define FIO_STANDIN_LISTEN_H

#include <stdbool.h>

#include <isoprint/status.h>

/* A socket left at `path` that nobody serves any more is replaced; FIO_NOT_WRITTEN otherwise. */
fio_status fio_listen_path(int *listener, const char *path) FIO_MUST_CHECK;

/* *port 0: any free one, told in *port. FIO_USAGE for a host that has no address here. */
fio_status fio_listen_tcp(int *listener, const char *host, int *port) FIO_MUST_CHECK;

/* A host that has come; -1 if there is none. */
int fio_listen_accept(int listener);

#endif
