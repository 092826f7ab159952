#include "standin/vhci.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static const char attach[] = "/sys/devices/platform/vhci_hcd.0/attach";
static const char status_of_ports[] = "/sys/devices/platform/vhci_hcd.0/status";

/* A line a port: "hs  0000 004 000 00000000 000000 0-0"; state 004 is free. -1: none is. */
static int free_port(FILE *table) {
    char line[160];
    while (fgets(line, sizeof line, table)) {
        int port, state;
        if (sscanf(line, "hs %d %d", &port, &state) == 2 && state == 4)
            return port;
    }
    return -1;
}

static fio_status write_attach(int port, int socket_end, int device, int speed) {
    char text[64];
    int length = snprintf(text, sizeof text, "%d %d %d %d", port, socket_end, device, speed);
    int file = open(attach, O_WRONLY | O_CLOEXEC);
    bool done = file >= 0 && write(file, text, (size_t)length) == length;
    int error = errno;
    if (file >= 0)
        close(file);
    return done ? FIO_OK
                : fio_fail(FIO_NOT_WRITTEN, "%s: can't be written: %s", attach, strerror(error));
}

fio_status fio_vhci_attach(int *file, int speed, int device) {
    FILE *table = fopen(status_of_ports, "re");
    int ends[2];
    *file = -1;
    if (!table)
        return fio_fail(FIO_NOT_WRITTEN,
                        "%s: can't be read: %s. It comes with the kernel's module vhci_hcd: "
                        "modprobe vhci_hcd",
                        status_of_ports, strerror(errno));
    int port = free_port(table);
    fclose(table);
    if (port < 0)
        return fio_fail(FIO_NOT_WRITTEN, "vhci_hcd has no free port");
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
        return fio_fail(FIO_NOT_WRITTEN, "no pair of sockets to be had: %s", strerror(errno));
    fio_status status = write_attach(port, ends[1], device, speed);
    close(ends[1]);
    if (status == FIO_OK) {
        fcntl(ends[0], F_SETFD, FD_CLOEXEC);
        fcntl(ends[0], F_SETFL, O_NONBLOCK);
        *file = ends[0];
    } else {
        close(ends[0]);
    }
    return status;
}
