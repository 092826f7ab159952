#include "serial/link.h"

#include <stdlib.h>

#include "check.h"

static fio_status request(void *context, uint8_t type, uint8_t code, uint16_t value, uint16_t index,
                          void *data, uint16_t length, uint16_t *moved, bool *stalled) {
    usb_link *l = context;
    const uint8_t setup[8] = {type,
                              code,
                              (uint8_t)value,
                              (uint8_t)(value >> 8),
                              (uint8_t)index,
                              (uint8_t)(index >> 8),
                              (uint8_t)length,
                              (uint8_t)(length >> 8)};
    int result = fio_virtual_usb_control(l->device, l->now, setup, data, length);
    l->now += 0.0005;
    if (result == FIO_USB_GONE)
        return fio_fail(FIO_LINK_LOST, "gone");
    *stalled = result == FIO_USB_STALL;
    *moved = (uint16_t)(result > 0 ? result : 0);
    return FIO_OK;
}

usb_link *link_plug(const char *chip, int64_t rate, const fio_virtual_usb_options *more) {
    usb_link *l = calloc(1, sizeof *l);
    if (!l)
        abort();
    fio_machine_options machine = fio_machine_options_defaults();
    machine.rate = rate;
    machine.boot_seconds = 0.01;
    fio_virtual_usb_options options = more ? *more : (fio_virtual_usb_options){0};
    options.chip = chip;
    CHECK_EQUAL(FIO_OK, fio_machine_create(&l->machine, &machine));
    CHECK_EQUAL(FIO_OK, fio_virtual_usb_create(&l->device, l->machine, &options));
    size_t size = 0;
    const uint8_t *bytes = fio_virtual_usb_descriptors(l->device, &size);
    CHECK(fio_usb_device_read(&l->found, bytes, size));
    l->serial.control = (fio_control){request, l};
    CHECK(fio_serial_match(&l->serial, &l->found));
    return l;
}

void link_unplug(usb_link *l) {
    fio_virtual_usb_free(l->device);
    fio_machine_free(l->machine);
    free(l);
}

/* One IN transfer as a host controller makes it: packets until a short one or the buffer is full.
 * Then the driver takes its wrapping off. */
static void receive(usb_link *l) {
    uint8_t buffer[1024];
    size_t got = 0;
    while (got + l->serial.in_packet <= l->serial.in_transfer) {
        int size =
            fio_virtual_usb_in(l->device, l->now, l->serial.in, buffer + got, l->serial.in_packet);
        if (size < 0)
            break;
        l->packets++;
        l->empty_packets += size <= (l->serial.driver->unwrap ? 2 : 0);
        got += (size_t)size;
        if (size < l->serial.in_packet)
            break;
    }
    size_t left =
        l->serial.driver->unwrap ? l->serial.driver->unwrap(&l->serial, buffer, got) : got;
    CHECK(l->length + left < sizeof l->text);
    if (l->length + left >= sizeof l->text)
        abort();
    memcpy(l->text + l->length, buffer, left);
    l->length += left;
    l->text[l->length] = 0;
}

/* Let time pass, a tenth of a millisecond at a time, reading all the while. */
void link_run(usb_link *l, double seconds) {
    for (double end = l->now + seconds; l->now < end; l->now += 0.0001)
        receive(l);
}

void link_send(usb_link *l, const char *text) {
    size_t size = strlen(text), at = 0;
    for (int tries = 0; at < size && tries < 100000; tries++) {
        size_t piece = size - at < l->serial.out_packet ? size - at : l->serial.out_packet;
        int taken = fio_virtual_usb_out(l->device, l->now, l->serial.out,
                                        (const uint8_t *)text + at, (int)piece);
        if (taken == FIO_USB_NAK) {
            l->refused++;
            link_run(l, 0.0001);
            continue;
        }
        CHECK_EQUAL((int)piece, taken);
        at += piece;
    }
    CHECK_EQUAL((long long)size, (long long)at);
}

bool link_talk(usb_link *l) {
    l->length = 0;
    link_send(l, "M115\n");
    link_run(l, 0.3);
    bool good = strstr(l->text, "FIRMWARE_NAME:") && strstr(l->text, "ok\n");
    l->length = 0;
    link_send(l, "N-1 M110*15\nM105\n");
    link_run(l, 0.3);
    return good && strstr(l->text, "ok T:");
}

int link_ask(usb_link *l, uint8_t type, uint8_t code, uint16_t value, uint16_t index, uint8_t *data,
             uint16_t length) {
    const uint8_t setup[8] = {type,
                              code,
                              (uint8_t)value,
                              (uint8_t)(value >> 8),
                              (uint8_t)index,
                              (uint8_t)(index >> 8),
                              (uint8_t)length,
                              (uint8_t)(length >> 8)};
    return fio_virtual_usb_control(l->device, l->now, setup, data, length);
}
