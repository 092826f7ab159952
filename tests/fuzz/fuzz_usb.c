/* Bytes as a device: its descriptors first, then what it answers to the requests of the driver they
 * lead to, then what it sends. */
#include "fuzz.h"

#include <string.h>

#include "serial/serial.h"

typedef struct tape {
    const uint8_t *bytes;
    size_t size, at;
} tape;

static uint8_t next(tape *t) {
    return t->at < t->size ? t->bytes[t->at++] : 0;
}

/* Lies about how much it moved as a device can: never more than was asked for. */
static fio_status request(void *context, uint8_t type, uint8_t code, uint16_t value, uint16_t index,
                          void *data, uint16_t length, uint16_t *moved, bool *stalled) {
    tape *t = context;
    uint8_t mood = next(t);
    if (mood == 255)
        return fio_fail(FIO_LINK_LOST, "gone");
    *stalled = mood % 16 == 15;
    *moved = mood % 16 == 14 ? (uint16_t)(length / 2) : length;
    if (*stalled)
        *moved = 0;
    for (uint16_t i = 0; (type & 0x80) && i < *moved; i++)
        ((uint8_t *)data)[i] = next(t);
    return FIO_OK;
}

static void expect(bool right) {
    if (!right)
        abort();
}

static void drive(fio_serial *serial, tape *t) {
    static const int64_t rates[] = {115200, 250000, 1000000, 9600, 300};
    int64_t rate = rates[next(t) % 5];
    const fio_serial_driver *driver = serial->driver;
    if (driver->open(serial, rate, next(t) & 1) == FIO_OK) {
        expect(serial->rate == rate);
        rate = (int64_t)next(t) << (next(t) % 32);
        expect(driver->set_rate(serial, rate) != FIO_OK || serial->rate == rate);
        expect(driver->set_lines(serial, true, false) != FIO_OK || (serial->dtr && !serial->rts));
        expect(driver->close(serial) != FIO_OK || (!serial->dtr && !serial->rts));
    }
    size_t size = t->size - t->at;
    size = size < serial->in_transfer ? size : serial->in_transfer;
    if (!driver->unwrap || size == 0)
        return;
    uint8_t *copy = malloc(size); /* of this size, so that a sanitizer sees each byte too far */
    expect(copy != NULL);
    memcpy(copy, t->bytes + t->at, size);
    expect(driver->unwrap(serial, copy, size) <= size);
    free(copy);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fio_usb_device device;
    if (!fio_usb_device_read(&device, bytes, size))
        return 0;
    expect(device.interface_count >= 0 && device.interface_count <= FIO_USB_INTERFACES);
    for (int i = 0; i < device.interface_count; i++)
        expect(device.interfaces[i].endpoint_count >= 0 &&
               device.interfaces[i].endpoint_count <= 8);
    size_t used = bytes[0] + (size_t)(bytes[bytes[0] + 2] | bytes[bytes[0] + 3] << 8);
    expect(used <= size);
    tape t = {bytes, size, used};
    fio_serial serial = {.control = {request, &t}};
    if (!fio_serial_match(&serial, &device))
        return 0;
    expect(serial.interface_count == 1 || serial.interface_count == 2);
    expect((serial.in & 0x80) && !(serial.out & 0x80) && serial.in_packet >= 8);
    expect(serial.in_transfer >= serial.in_packet && serial.in_transfer % serial.in_packet == 0);
    drive(&serial, &t);
    return 0;
}
