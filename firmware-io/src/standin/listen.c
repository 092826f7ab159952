#include "standin/listen.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

static int prepared(int file) {
    if (file >= 0) {
        fcntl(file, F_SETFD, FD_CLOEXEC);
        fcntl(file, F_SETFL, O_NONBLOCK);
    }
    return file;
}

static int failed(int file) {
    int error = errno;
    close(file);
    errno = error;
    return -1;
}

/* Whether somebody serves it. */
static bool is_served(const struct sockaddr_un *address) {
    int file = socket(AF_UNIX, SOCK_STREAM, 0);
    bool served =
        file >= 0 && connect(file, (const struct sockaddr *)address, sizeof *address) == 0;
    if (file >= 0)
        close(file);
    return served;
}

fio_status fio_listen_path(int *listener, const char *path) {
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    struct stat found;
    *listener = -1;
    if (strlen(path) >= sizeof address.sun_path)
        return fio_fail(FIO_USAGE, "%s: the path of a socket has at most %zu bytes", path,
                        sizeof address.sun_path - 1);
    memcpy(address.sun_path, path, strlen(path));
    if (lstat(path, &found) == 0 && S_ISSOCK(found.st_mode) && !is_served(&address))
        unlink(path);
    int file = prepared(socket(AF_UNIX, SOCK_STREAM, 0));
    if (file >= 0 &&
        (bind(file, (struct sockaddr *)&address, sizeof address) != 0 || listen(file, 8) != 0))
        file = failed(file);
    if (file < 0)
        return fio_fail(FIO_NOT_WRITTEN, "%s: no socket can be made there: %s", path,
                        strerror(errno));
    *listener = file;
    return FIO_OK;
}

static int listen_at(const struct addrinfo *where, int *port) {
    int file = prepared(socket(where->ai_family, where->ai_socktype, where->ai_protocol)), yes = 1;
    if (file < 0)
        return -1;
    struct sockaddr_storage bound;
    socklen_t size = sizeof bound;
    setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (bind(file, where->ai_addr, where->ai_addrlen) != 0 || listen(file, 8) != 0 ||
        getsockname(file, (struct sockaddr *)&bound, &size) != 0)
        return failed(file);
    *port = ntohs(bound.ss_family == AF_INET6 ? ((struct sockaddr_in6 *)&bound)->sin6_port
                                              : ((struct sockaddr_in *)&bound)->sin_port);
    return file;
}

fio_status fio_listen_tcp(int *listener, const char *host, int *port) {
    struct addrinfo hints = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE}, *found;
    char service[16];
    *listener = -1;
    snprintf(service, sizeof service, "%d", *port);
    int error = getaddrinfo(host, service, &hints, &found);
    if (error)
        return fio_fail(FIO_USAGE, "%s: no address: %s", host, gai_strerror(error));
    for (const struct addrinfo *where = found; where && *listener < 0; where = where->ai_next)
        *listener = listen_at(where, port);
    error = errno;
    freeaddrinfo(found);
    if (*listener < 0)
        return fio_fail(FIO_NOT_WRITTEN, "%s:%s: nothing can listen there: %s", host, service,
                        strerror(error));
    return FIO_OK;
}

int fio_listen_accept(int listener) {
    int file = prepared(accept(listener, NULL, NULL)), yes = 1;
    if (file >= 0)
        setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes); /* no matter if it is none */
    return file;
}
