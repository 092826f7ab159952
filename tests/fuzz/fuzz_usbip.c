/* Bytes as what a USB/IP host sends: requests, or after the first byte's lowest bit, URBs. */
#include "fuzz.h"

#include <fcntl.h>
#include <poll.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "standin/usbip.h"
#include "standin/usbip_wire.h"

static void read_requests(const fio_virtual_usb *device, const uint8_t *bytes, size_t size) {
    uint8_t request[FIO_USBIP_REQUEST + FIO_USBIP_BUSID] = {0}, reply[FIO_USBIP_REPLY_MOST];
    memcpy(request, bytes, size < sizeof request ? size : sizeof request);
    bool imported;
    size_t wanted = fio_usbip_request_size(request);
    if (wanted && fio_usbip_answer(reply, device, request, size & 1, &imported) > sizeof reply)
        abort();
}

static void send_urbs(fio_machine *machine, fio_virtual_usb *device, const uint8_t *bytes,
                      size_t size) {
    fio_pace pace = fio_pace_start(0);
    fio_standin *standin;
    uint8_t answers[4096];
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
        return;
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
    fcntl(ends[1], F_SETFL, O_NONBLOCK);
    if (fio_standin_usbip_socket(&standin, machine, &pace, device, ends[0]) != FIO_OK)
        abort();
    for (size_t at = 0; at < size;) {
        size_t piece = size - at < 700 ? size - at : 700;
        if (send(ends[1], bytes + at, piece, MSG_NOSIGNAL) != (ssize_t)piece)
            break;
        at += piece;
        struct pollfd polls[FIO_STANDIN_POLLS];
        int count = standin->type->polls(standin, polls, FIO_STANDIN_POLLS);
        poll(polls, (nfds_t)count, 0);
        if (fio_standin_turn(standin, polls, count) != FIO_OK)
            abort();
        while (recv(ends[1], answers, sizeof answers, 0) > 0)
            continue;
    }
    close(ends[1]);
    fio_standin_close(standin);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    static const char *const chips[] = {"cdc-acm", "ftdi", "ch340", "pl2303hx"};
    fio_machine_options machine_options = fio_machine_options_defaults();
    fio_machine *machine;
    fio_virtual_usb *device;
    if (size < 1)
        return 0;
    fio_virtual_usb_options options = {.chip = chips[bytes[0] >> 1 & 3]};
    machine_options.rate = bytes[0] & 8 ? 0 : 115200;
    machine_options.boot_seconds = 0;
    if (fio_machine_create(&machine, &machine_options) != FIO_OK ||
        fio_virtual_usb_create(&device, machine, &options) != FIO_OK)
        abort();
    if (bytes[0] & 1)
        send_urbs(machine, device, bytes + 1, size - 1);
    else
        read_requests(device, bytes + 1, size - 1);
    fio_virtual_usb_free(device);
    fio_machine_free(machine);
    return 0;
}
