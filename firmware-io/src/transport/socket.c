#include "transport/socket.h"

#include "base/memory.h"
#include "transport/descriptor.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/sockios.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

/* Half of a full queue takes about this long at the least. */
static const double drain_seconds = 0.002;

static fio_status socket_discard(fio_transport *transport, size_t *kept) {
    /* What the kernel has it will deliver. */
    *kept = fio_descriptor_pending(transport);
    fio_descriptor *self = (fio_descriptor *)transport;
    return self->lost ? fio_descriptor_lose(self, "lost") : FIO_OK;
}

static void socket_close(fio_transport *transport) {
    fio_descriptor *self = (fio_descriptor *)transport;
    fio_descriptor_drain(self, 0.5);
    close(self->file);
    fio_release(self);
}

static const fio_transport_type socket_type = {
    .name = "socket",
    .read = fio_descriptor_read,
    .write = fio_descriptor_write,
    .pending = fio_descriptor_pending,
    .discard = socket_discard,
    .wait = fio_descriptor_wait,
    .now = fio_descriptor_now,
    .close = socket_close,
};

/* 0, or an errno. */
static int connect_within(int file, const struct sockaddr *address, socklen_t size,
                          double seconds) {
    double end = fio_monotonic() + seconds;
    int error = connect(file, address, size) == 0 ? 0 : errno;
    while (error == EAGAIN && fio_monotonic() < end) { /* a unix socket's queue is full */
        poll(NULL, 0, 10);
        error = connect(file, address, size) == 0 ? 0 : errno;
    }
    if (error != EINPROGRESS && error != EINTR)
        return error;
    struct pollfd ready = {.fd = file, .events = POLLOUT};
    double left;
    do {
        left = end - fio_monotonic();
    } while (poll(&ready, 1, fio_poll_milliseconds(left)) <= 0 && left > 0);
    if (!ready.revents)
        return ETIMEDOUT;
    socklen_t length = sizeof error;
    return getsockopt(file, SOL_SOCKET, SO_ERROR, &error, &length) == 0 ? error : errno;
}

/* The connected socket, or -1 and *error. */
static int connected(int family, const struct sockaddr *address, socklen_t size, double seconds,
                     int *error) {
    int file = socket(family, SOCK_STREAM, 0);
    if (file < 0) {
        *error = errno;
        return -1;
    }
    fcntl(file, F_SETFD, FD_CLOEXEC);
    fcntl(file, F_SETFL, O_NONBLOCK);
    *error = connect_within(file, address, size, seconds);
    if (*error) {
        close(file);
        return -1;
    }
    return file;
}

static fio_status wrap(fio_transport **transport, int file, bool counted, const char *kind,
                       const char *address) {
    fio_descriptor *self = fio_allocate(sizeof *self);
    if (!self) {
        close(file);
        return fio_fail(FIO_NO_MEMORY, "no memory for a port");
    }
    *self = (fio_descriptor){.transport.type = &socket_type,
                             .file = file,
                             .socket = true,
                             /* Of TCP what was not sent yet: what was, but is not acknowledged,
                              * may wait 40 ms for that although it has arrived. */
                             .question = counted ? SIOCOUTQNSD : SIOCOUTQ,
                             .counted = counted,
                             .drain = drain_seconds};
    snprintf(self->name, sizeof self->name, "%s:%s", kind, address);
    *transport = &self->transport;
    return FIO_OK;
}

fio_status fio_socket_open_path(fio_transport **transport, const char *path, double seconds) {
    *transport = NULL;
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    if (strlen(path) >= sizeof address.sun_path)
        return fio_fail(FIO_USAGE, "socket:%s: a socket's path has at most %zu bytes", path,
                        sizeof address.sun_path - 1);
    memcpy(address.sun_path, path, strlen(path) + 1);
    int error;
    int file = connected(AF_UNIX, (struct sockaddr *)&address, sizeof address, seconds, &error);
    if (file < 0)
        return fio_fail(FIO_NO_PRINTER, "socket:%s: %s", path,
                        error == ENOENT || error == ECONNREFUSED ? "nobody listens there"
                                                                 : strerror(error));
    return wrap(transport, file, false, "socket", path);
}

/* Cut "HOST:PORT" in two; false if it is not of that kind. */
static bool split(const char *address, char *host, size_t capacity, const char **port) {
    const char *colon = strrchr(address, ':');
    if (!colon || colon == address || !colon[1] || strlen(colon + 1) > 5 ||
        strspn(colon + 1, "0123456789") != strlen(colon + 1))
        return false;
    size_t length = (size_t)(colon - address);
    if (address[0] == '[' && colon[-1] == ']') {
        address++;
        length -= 2;
    } else if (memchr(address, ':', length)) {
        return false;
    }
    if (length == 0 || length >= capacity)
        return false;
    memcpy(host, address, length);
    host[length] = 0;
    *port = colon + 1;
    return true;
}

static bool is_port(const char *digits) {
    long number = strlen(digits) < 6 ? strtol(digits, NULL, 10) : 0;
    return number > 0 && number <= 65535;
}

fio_status fio_socket_open_host(fio_transport **transport, const char *address, double seconds) {
    *transport = NULL;
    char host[256];
    const char *port;
    if (!split(address, host, sizeof host, &port))
        return fio_fail(FIO_USAGE, "tcp:%s: not of the form tcp:HOST:PORT", address);
    if (!is_port(port))
        return fio_fail(FIO_USAGE, "tcp:%s: a port is a number from 1 to 65535", address);
    struct addrinfo hints = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_NUMERICSERV}, *found = NULL;
    int failed = getaddrinfo(host, port, &hints, &found);
    if (failed)
        return fio_fail(FIO_NO_PRINTER, "tcp:%s: no such host: %s", address, gai_strerror(failed));
    int file = -1, error = 0;
    double end = fio_monotonic() + seconds;
    for (const struct addrinfo *one = found; one && file < 0; one = one->ai_next)
        file =
            connected(one->ai_family, one->ai_addr, one->ai_addrlen, end - fio_monotonic(), &error);
    freeaddrinfo(found);
    if (file < 0)
        return fio_fail(FIO_NO_PRINTER, "tcp:%s: %s", address,
                        error == ECONNREFUSED ? "nobody listens there" : strerror(error));
    int on = 1;
    setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return wrap(transport, file, true, "tcp", address);
}
