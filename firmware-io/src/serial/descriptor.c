#include "serial/serial.h"

#include <string.h>

enum {
    DEVICE = 1,
    CONFIGURATION = 2,
    INTERFACE = 4,
    ENDPOINT = 5,
    CLASS_INTERFACE = 0x24,
    CDC_UNION = 6,
    BULK = 2,
    FULL_SPEED_BULK = 64 /* most bytes of a bulk packet at full speed */
};

static uint16_t word(const uint8_t *bytes) {
    return (uint16_t)(bytes[0] | bytes[1] << 8);
}

static void read_interface(fio_usb_device *device, const uint8_t *bytes) {
    fio_usb_interface *interface = &device->interfaces[device->interface_count++];
    *interface = (fio_usb_interface){.number = bytes[2],
                                     .alternate = bytes[3],
                                     .class_code = bytes[5],
                                     .subclass = bytes[6],
                                     .protocol = bytes[7],
                                     .union_data = -1};
}

static void read_endpoint(fio_usb_device *device, fio_usb_interface *interface,
                          const uint8_t *bytes) {
    const int most = sizeof interface->endpoints / sizeof *interface->endpoints;
    if ((bytes[2] & 15) == 0 || interface->endpoint_count == most)
        return;
    fio_usb_endpoint endpoint = {
        .address = bytes[2] & 0x8f, .kind = bytes[3] & 3, .packet = word(bytes + 4) & 0x7ff};
    interface->endpoints[interface->endpoint_count++] = endpoint;
    if (endpoint.kind == BULK && endpoint.packet > FULL_SPEED_BULK)
        device->high_speed = true;
}

/* One descriptor inside the configuration. *current: the interface it belongs to, NULL before the
 * first and behind the last there is room for. */
static bool read_one(fio_usb_device *device, fio_usb_interface **current, const uint8_t *bytes,
                     bool *any) {
    size_t length = bytes[0];
    switch (bytes[1]) {
    case INTERFACE:
        if (length < 9)
            return false;
        *any = true;
        *current = NULL;
        if (device->interface_count < FIO_USB_INTERFACES) {
            read_interface(device, bytes);
            *current = &device->interfaces[device->interface_count - 1];
        }
        return true;
    case ENDPOINT:
        if (length < 7 || !*any)
            return false;
        if (*current)
            read_endpoint(device, *current, bytes);
        return true;
    case CLASS_INTERFACE:
        if (*current && length >= 5 && bytes[2] == CDC_UNION && (*current)->union_data < 0)
            (*current)->union_data = bytes[4];
        return true;
    default: /* associations, vendors' own: nothing a driver looks at */
        return true;
    }
}

static bool read_configuration(fio_usb_device *device, const uint8_t *bytes, size_t size) {
    if (size < 9 || bytes[0] < 9 || bytes[1] != CONFIGURATION)
        return false;
    size_t total = word(bytes + 2);
    if (total < bytes[0] || total > size)
        return false;
    fio_usb_interface *current = NULL;
    bool any = false;
    for (size_t at = bytes[0]; at < total; at += bytes[at]) {
        if (total - at < 2 || bytes[at] < 2 || bytes[at] > total - at)
            return false;
        if (bytes[at + 1] == CLASS_INTERFACE && bytes[at] < 3)
            return false;
        if (!read_one(device, &current, bytes + at, &any))
            return false;
    }
    return true;
}

bool fio_usb_device_read(fio_usb_device *device, const uint8_t *bytes, size_t size) {
    if (size < 18 || bytes[0] < 18 || bytes[0] > size || bytes[1] != DEVICE)
        return false;
    fio_usb_device found = {.version = word(bytes + 2),
                            .class_code = bytes[4],
                            .control_packet = bytes[7],
                            .vendor = word(bytes + 8),
                            .product = word(bytes + 10),
                            .release = word(bytes + 12)};
    if (!read_configuration(&found, bytes + bytes[0], size - bytes[0]))
        return false;
    *device = found;
    return true;
}
