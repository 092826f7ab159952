/* CDC Abstract Control Model: native USB boards, and Arduinos whose bridge is a programmed one. */
#include "serial/driver.h"

#include <string.h>

enum {
    CLASS_COMMUNICATION = 2,
    SUBCLASS_ACM = 2,
    CLASS_DATA = 10,
    PROTOCOL_AT_LAST = 6, /* V.250 and its kin; 255, a vendor's own, is a network adapter */
    TO_INTERFACE = 0x21,
    SET_LINE_CODING = 0x20,
    SET_CONTROL_LINE_STATE = 0x22,
    DTR = 1,
    RTS = 2,
    HIGHEST_RATE = 12000000 /* bits/s that full speed carries */
};

static const fio_usb_interface *interface_of(const fio_usb_device *device, int number) {
    for (int i = 0; i < device->interface_count; i++)
        if (device->interfaces[i].number == number && device->interfaces[i].alternate == 0)
            return &device->interfaces[i];
    return NULL;
}

static bool take_data(fio_serial *serial, const fio_usb_interface *control,
                      const fio_usb_interface *data) {
    if (!data || data->class_code != CLASS_DATA || !fio_serial_take_endpoints(serial, data))
        return false;
    serial->interfaces[0] = control->number;
    serial->interfaces[1] = data->number;
    serial->interface_count = 2;
    return true;
}

/* The data interface is the one the Union descriptor names; where that is missing or wrong, a
 * neighbour; or there is but one for both. */
static bool take_pair(fio_serial *serial, const fio_usb_device *device,
                      const fio_usb_interface *control) {
    const int candidates[] = {control->union_data, control->number + 1, control->number - 1};
    for (size_t i = 0; i < sizeof candidates / sizeof *candidates; i++)
        if (take_data(serial, control, interface_of(device, candidates[i])))
            return true;
    if (!fio_serial_take_endpoints(serial, control))
        return false;
    serial->interfaces[0] = control->number;
    serial->interface_count = 1;
    return true;
}

static bool match(fio_serial *serial, const fio_usb_device *device) {
    for (int i = 0; i < device->interface_count; i++) {
        const fio_usb_interface *control = &device->interfaces[i];
        if (control->alternate == 0 && control->class_code == CLASS_COMMUNICATION &&
            control->subclass == SUBCLASS_ACM && control->protocol <= PROTOCOL_AT_LAST &&
            take_pair(serial, device, control))
            return true;
    }
    return false;
}

/* A board without a wire may refuse what a wire needs: that harms nothing. */
static fio_status tell(fio_serial *serial, uint8_t request, uint16_t value, void *data,
                       uint16_t length) {
    uint16_t moved = 0;
    bool stalled = false;
    return serial->control.request(serial->control.context, TO_INTERFACE, request, value,
                                   (uint16_t)serial->interfaces[0], data, length, &moved, &stalled);
}

static fio_status set_rate(fio_serial *serial, int64_t rate) {
    int64_t told = rate < 1 ? 1 : rate > HIGHEST_RATE ? HIGHEST_RATE : rate;
    fio_status status = fio_serial_check_rate(serial, rate, (double)told);
    if (status != FIO_OK)
        return status;
    uint8_t coding[7] = {
        (uint8_t)told, (uint8_t)(told >> 8), (uint8_t)(told >> 16), (uint8_t)(told >> 24), 0, 0, 8};
    status = tell(serial, SET_LINE_CODING, 0, coding, sizeof coding);
    if (status == FIO_OK)
        serial->rate = rate;
    return status;
}

static fio_status set_lines(fio_serial *serial, bool dtr, bool rts) {
    fio_status status = tell(serial, SET_CONTROL_LINE_STATE,
                             (uint16_t)((dtr ? DTR : 0) | (rts ? RTS : 0)), NULL, 0);
    return fio_serial_note_lines(serial, dtr, rts, status);
}

static fio_status open(fio_serial *serial, int64_t rate, bool raise_lines) {
    fio_status status = set_rate(serial, rate);
    return status == FIO_OK && raise_lines ? set_lines(serial, true, true) : status;
}

const fio_serial_driver fio_serial_cdc_acm = {.name = "cdc-acm",
                                              .match = match,
                                              .open = open,
                                              .set_rate = set_rate,
                                              .set_lines = set_lines,
                                              .close = fio_serial_lower_lines,
                                              .wants_empty_packet = true};
