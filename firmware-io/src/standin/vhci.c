#include "standin/vhci.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { FREE = 4, TRIES = 16 };

static const char attach[] = "/sys/devices/platform/vhci_hcd.0/attach";
static const char status_of_ports[] = "/sys/devices/platform/vhci_hcd.0/status";

/* A line a port: "hs  0000 004 000 00000000 000000 0-0"; state 004 is free. */
static fio_status find_port(int *port) {
    FILE *table = fopen(status_of_ports, "re");
    if (!table)
        return fio_fail(FIO_NOT_WRITTEN,
                        "%s: can't be read: %s. It comes with the kernel's module vhci_hcd: "
                        "modprobe vhci_hcd",
                        status_of_ports, strerror(errno));
    char line[160];
    int state = 0;
    while (state != FREE && fgets(line, sizeof line, table))
        if (sscanf(line, "hs %d %d", port, &state) != 2)
            state = 0;
    fclose(table);
    return state == FREE ? FIO_OK : fio_fail(FIO_NOT_WRITTEN, "vhci_hcd has no free port");
}

/* 0, or an errno. */
static int write_attach(int port, int socket_end, int device, int speed) {
    char text[64];
    int length = snprintf(text, sizeof text, "%d %d %d %d", port, socket_end, device, speed);
    int file = open(attach, O_WRONLY | O_CLOEXEC);
    int error = file >= 0 && write(file, text, (size_t)length) == length ? 0 : errno;
    if (file >= 0)
        close(file);
    return error;
}

fio_status fio_vhci_attach(int *file, int speed, int device) {
    int ends[2], port, error = EBUSY;
    *file = -1;
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
        return fio_fail(FIO_NOT_WRITTEN, "no pair of sockets to be had: %s", strerror(errno));
    fio_status status = FIO_OK;
    /* Busy: another program has just taken that port. */
    for (int tries = 0; tries < TRIES && error == EBUSY && status == FIO_OK; tries++)
        if ((status = find_port(&port)) == FIO_OK)
            error = write_attach(port, ends[1], device, speed);
    if (status == FIO_OK && error)
        status = fio_fail(FIO_NOT_WRITTEN, "%s: can't be written: %s", attach, strerror(error));
    close(ends[1]);
    if (status != FIO_OK) {
        close(ends[0]);
        return status;
    }
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
    *file = ends[0];
    return FIO_OK;
}
