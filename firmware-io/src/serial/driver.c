#include "serial/driver.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { BULK = 2, IN = 0x80, SMALLEST_PACKET = 8, USUAL_PACKET = 64 };

const fio_serial_driver *const fio_serial_drivers[] = {&fio_serial_ch34x,   &fio_serial_ftdi,
                                                       &fio_serial_cp210x,  &fio_serial_pl2303,
                                                       &fio_serial_cdc_acm, NULL};

bool fio_serial_match(fio_serial *serial, const fio_usb_device *device) {
    for (const fio_serial_driver *const *driver = fio_serial_drivers; *driver; driver++) {
        fio_serial found = {.driver = *driver, .control = serial->control};
        if (!(*driver)->match(&found, device))
            continue;
        *serial = found;
        return true;
    }
    return false;
}

bool fio_usb_id_among(const fio_usb_device *device, const fio_usb_id *ids, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (ids[i].vendor == device->vendor && ids[i].product == device->product)
            return true;
    return false;
}

/* Some clones tell a packet size of 0, or one no bulk endpoint may have. */
static uint16_t packet_of(const fio_usb_endpoint *endpoint) {
    return endpoint->packet < SMALLEST_PACKET ? USUAL_PACKET : endpoint->packet;
}

bool fio_serial_take_endpoints(fio_serial *serial, const fio_usb_interface *interface) {
    const fio_usb_endpoint *in = NULL, *out = NULL;
    for (int i = 0; i < interface->endpoint_count; i++) {
        const fio_usb_endpoint *endpoint = &interface->endpoints[i];
        if (endpoint->kind != BULK)
            continue;
        if (endpoint->address & IN)
            in = in ? in : endpoint;
        else
            out = out ? out : endpoint;
    }
    if (!in || !out)
        return false;
    serial->in = in->address;
    serial->out = out->address;
    serial->in_packet = packet_of(in);
    serial->out_packet = packet_of(out);
    serial->in_transfer = serial->in_packet;
    return true;
}

bool fio_serial_take_interface(fio_serial *serial, const fio_usb_device *device) {
    for (int i = 0; i < device->interface_count; i++) {
        const fio_usb_interface *interface = &device->interfaces[i];
        if (interface->alternate != 0 || !fio_serial_take_endpoints(serial, interface))
            continue;
        serial->interfaces[0] = interface->number;
        serial->interface_count = 1;
        return true;
    }
    return false;
}

fio_status fio_serial_send(const fio_serial *serial, fio_request request, const void *data) {
    uint8_t copy[32]; /* the function's pointer serves both directions, so it is not const */
    if (request.length > sizeof copy)
        return fio_fail(FIO_BUG, "a request of %d bytes", request.length);
    if (request.length > 0)
        memcpy(copy, data, request.length);
    uint16_t moved = 0;
    bool stalled = false;
    fio_status status = serial->control.request(serial->control.context, request.type,
                                                request.request, request.value, request.index, copy,
                                                request.length, &moved, &stalled);
    if (status != FIO_OK || (!stalled && moved >= request.length))
        return status;
    return fio_fail(FIO_NO_PRINTER,
                    "the %s bridge refuses request %02x %02x (value %04x, index %04x); unplug it "
                    "and plug it in again",
                    serial->driver->name, request.type, request.request, request.value,
                    request.index);
}

fio_status fio_serial_ask(const fio_serial *serial, fio_request request, void *data,
                          bool *answered) {
    uint16_t moved = 0;
    bool stalled = false;
    fio_status status = serial->control.request(serial->control.context, request.type,
                                                request.request, request.value, request.index, data,
                                                request.length, &moved, &stalled);
    *answered = status == FIO_OK && !stalled && moved >= request.length;
    return status;
}

fio_status fio_serial_note_lines(fio_serial *serial, bool dtr, bool rts, fio_status status) {
    if (status != FIO_OK)
        return status;
    serial->dtr = dtr;
    serial->rts = rts;
    return FIO_OK;
}

fio_status fio_serial_lower_lines(fio_serial *serial) {
    return serial->dtr || serial->rts ? serial->driver->set_lines(serial, false, false) : FIO_OK;
}

fio_status fio_serial_check_rate(const fio_serial *serial, int64_t rate, double nearest) {
    if (rate > 0 && fabs(nearest - (double)rate) * 100 <= FIO_SERIAL_RATE_ERROR * (double)rate)
        return FIO_OK;
    return fio_fail(FIO_USAGE, "the %s bridge can't do %lld bits/s; the nearest it can is %lld",
                    serial->driver->name, (long long)rate, (long long)llround(nearest));
}
