#include "standin/usb_host.h"

#include <errno.h>
#include <math.h>
#include <string.h>

static int slot(uint8_t endpoint) {
    return (endpoint & 15) + (endpoint & 0x80 ? 16 : 0);
}

static void append(fio_urb_queue *queue, fio_urb *urb) {
    urb->next = NULL;
    *queue->end = urb;
    queue->end = &urb->next;
}

static void take(fio_urb_queue *queue, fio_urb **at) {
    fio_urb *urb = *at;
    *at = urb->next;
    if (!*at)
        queue->end = at;
}

static void begin(fio_urb_queue *queue) {
    queue->first = NULL;
    queue->end = &queue->first;
}

/* The descriptors are our own: endpoints in a row of length-prefixed records. */
static void read_packets(fio_usb_host *host) {
    size_t size;
    const uint8_t *bytes = fio_virtual_usb_descriptors(host->device, &size);
    for (size_t at = 0; at + 2 <= size && bytes[at] >= 2 && at + bytes[at] <= size; at += bytes[at])
        if (bytes[at + 1] == 5 && bytes[at] >= 7) {
            int index = slot(bytes[at + 2]);
            host->packet[index] = (bytes[at + 4] | bytes[at + 5] << 8) & 0x7ff;
            if (index >= 16 && (bytes[at + 3] & 3) == 2)
                host->bulk_in = index;
        }
}

void fio_usb_host_begin(fio_usb_host *host, fio_virtual_usb *device, const fio_machine *machine) {
    *host = (fio_usb_host){.device = device, .machine = machine, .stall_at = -1};
    for (int i = 0; i < FIO_USB_ENDPOINTS; i++)
        begin(&host->waiting[i]);
    begin(&host->done);
    read_packets(host);
    host->packet[0] = 64;
}

static bool finish(fio_usb_host *host, fio_urb *urb, int status) {
    urb->status = status;
    append(&host->done, urb);
    return true;
}

static int error_of(int refusal) {
    return refusal == FIO_USB_GONE ? -ESHUTDOWN : -EPIPE;
}

/* True once it is done. */
static bool control(fio_usb_host *host, double now, fio_urb *urb) {
    const uint8_t *setup = urb->setup;
    int wanted = setup[6] | setup[7] << 8;
    int capacity = wanted < urb->length ? wanted : urb->length;
    int moved = fio_virtual_usb_control(host->device, now, setup, urb->data, capacity);
    if (setup[0] == 2 && setup[1] == 1 && !setup[2] && !setup[3] && moved != FIO_USB_GONE) {
        host->halted &= ~(UINT32_C(1) << slot(setup[4])); /* CLEAR_FEATURE(ENDPOINT_HALT) */
        moved = 0;
    }
    if (moved == FIO_USB_NAK)
        return false;
    urb->moved = moved < 0 ? 0 : moved < capacity ? moved : capacity;
    return finish(host, urb, moved < 0 ? error_of(moved) : 0);
}

static bool out(fio_usb_host *host, double now, fio_urb *urb, int packet) {
    do {
        if (host->packets_out == host->stall_at) {
            host->stall_at = -1;
            host->halted |= UINT32_C(1) << slot(urb->endpoint);
            return finish(host, urb, -EPIPE);
        }
        int left = urb->length - urb->moved;
        int size = left < packet ? left : packet;
        int taken = fio_virtual_usb_out(host->device, now, urb->endpoint,
                                        size ? urb->data + urb->moved : urb->setup, size);
        if (taken == FIO_USB_NAK)
            return false;
        if (taken < 0)
            return finish(host, urb, error_of(taken));
        host->packets_out++;
        urb->moved += size;
        if (size == packet && urb->moved == urb->length && urb->empty_packet && !urb->ended)
            urb->ended = true;
        else if (urb->moved == urb->length)
            return finish(host, urb, 0);
    } while (true);
}

static bool in(fio_usb_host *host, double now, fio_urb *urb, int packet) {
    while (urb->moved < urb->length) {
        uint8_t bytes[FIO_USB_PACKET_MOST];
        int moved = fio_virtual_usb_in(host->device, now, urb->endpoint, bytes, packet);
        if (moved == FIO_USB_NAK)
            return false;
        if (moved < 0)
            return finish(host, urb, error_of(moved));
        int left = urb->length - urb->moved;
        memcpy(urb->data + urb->moved, bytes, (size_t)(moved < left ? moved : left));
        urb->moved += moved < left ? moved : left;
        if (moved > left)
            return finish(host, urb, -EOVERFLOW); /* more than the buffer has room for */
        if (moved < packet)
            break;
    }
    return finish(host, urb, 0);
}

static bool attempt(fio_usb_host *host, double now, fio_urb *urb) {
    int at = slot(urb->endpoint), packet = host->packet[at];
    if (host->gone)
        return finish(host, urb, -ESHUTDOWN);
    if (at == 0)
        return control(host, now, urb);
    if (packet == 0)
        return finish(host, urb, -ENOENT);
    if (host->halted >> at & 1)
        return finish(host, urb, -EPIPE);
    return urb->endpoint & 0x80 ? in(host, now, urb, packet) : out(host, now, urb, packet);
}

void fio_usb_host_submit(fio_usb_host *host, double now, fio_urb *urb) {
    fio_urb_queue *queue = &host->waiting[slot(urb->endpoint)];
    urb->status = urb->moved = 0;
    urb->ended = false;
    if (queue->first || !attempt(host, now, urb))
        append(queue, urb);
}

bool fio_usb_host_cancel(fio_usb_host *host, const fio_urb *urb, int status) {
    fio_urb_queue *queue = &host->waiting[slot(urb->endpoint)];
    for (fio_urb **at = &queue->first; *at; at = &(*at)->next)
        if (*at == urb) {
            fio_urb *found = *at;
            take(queue, at);
            return finish(host, found, status);
        }
    return false;
}

fio_urb *fio_usb_host_reap(fio_usb_host *host, const void *client) {
    fio_urb **at = &host->done.first;
    while (*at && client && (*at)->client != client)
        at = &(*at)->next;
    fio_urb *urb = *at;
    if (urb)
        take(&host->done, at);
    return urb;
}

bool fio_usb_host_pump(fio_usb_host *host, double now) {
    bool any = false;
    for (int i = 0; i < FIO_USB_ENDPOINTS; i++) {
        fio_urb_queue *queue = &host->waiting[i];
        while (queue->first) {
            /* Taken off first: it goes to the other queue if it is done, and back if it is not. */
            fio_urb *urb = queue->first;
            take(queue, &queue->first);
            if (!attempt(host, now, urb)) {
                urb->next = queue->first;
                if (!queue->first)
                    queue->end = &urb->next;
                queue->first = urb;
                break;
            }
            any = true;
        }
    }
    return any;
}

double fio_usb_host_next(const fio_usb_host *host) {
    bool asked = host->waiting[host->bulk_in].first != NULL;
    if (host->gone || (!asked && fio_machine_readable(host->machine)))
        return INFINITY;
    return fio_virtual_usb_next(host->device);
}

void fio_usb_host_clear_halt(fio_usb_host *host, double now, uint8_t endpoint) {
    fio_urb urb = {.setup = {2, 1, 0, 0, endpoint, 0, 0, 0}};
    if (!control(host, now, &urb))
        return;
    fio_urb **at = &host->done.first; /* it was no transfer of anyone's */
    while (*at != &urb)
        at = &(*at)->next;
    take(&host->done, at);
}

void fio_usb_host_unplug(fio_usb_host *host) {
    host->gone = true;
    fio_usb_host_pump(host, 0);
}
