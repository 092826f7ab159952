/* A PL2303HX, which is silent until it got the writes its vendor's software begins with, and a
 * PL2303GC of the last generation (HXN), which stalls at them. */
#include "virtual/chip.h"

#include <math.h>

enum {
    VENDOR = 0x01,
    HXN_WRITE = 0x80,
    HXN_READ = 0x81,
    SET_LINE_CODING = 0x20,
    SET_CONTROL_LINE_STATE = 0x22,
    SEND_BREAK = 0x23,
    TO_DEVICE = 0x40,
    FROM_DEVICE = 0xc0,
    TO_INTERFACE = 0x21,
    CODING = 0,    /* in registers[]: 7 bytes */
    STEPS = 15,    /* one bit for each of the writes above */
    VENDORS = 128, /* the vendor's registers: 16 */
    HXN_RESET = 7,
    HXN_FLOW = 10,
    HXN_NO_FLOW = 0x1c,
    HXN_XON_XOFF = 0x0c
};

static bool newest(const fio_virtual_usb *device) {
    return device->chip == &fio_chip_pl2303hxn;
}

static bool listed(double rate) {
    static const int rates[] = {75,      150,     300,     600,    1200,   1800,   2400,
                                3600,    4800,    7200,    9600,   14400,  19200,  28800,
                                38400,   57600,   115200,  230400, 460800, 614400, 921600,
                                1228800, 2457600, 3000000, 6000000};
    for (size_t i = 0; i < sizeof rates / sizeof *rates; i++)
        if (rates[i] == rate)
            return true;
    return false;
}

static void settle(fio_virtual_usb *device, double now) {
    const uint8_t *coding = device->registers + CODING;
    bool eight_bits = coding[4] == 0 && coding[5] == 0 && coding[6] == 8;
    double rate = coding[0] + coding[1] * 256. + coding[2] * 65536. + coding[3] * 16777216.;
    if (newest(device))
        rate = rate > 12e6 ? 12e6 : rate;
    else if (coding[3] == 0x80) { /* a divisor instead of a rate */
        int mantissa = coding[0] | (coding[1] & 1) << 8, exponent = coding[1] >> 1 & 7;
        rate = 12e6 * 32 / ((mantissa > 0 ? mantissa : 512) * pow(4, exponent));
    } else if (!listed(rate))
        rate = 9600;
    fio_chip_set_rate(device, now, rate, eight_bits);
}

/* In their order: a step out of turn begins anew. */
static void step(fio_virtual_usb *device, const fio_setup *setup) {
    static const uint16_t steps[][2] = {{0x0404, 0}, {0x0404, 1}, {0, 1}, {1, 0}, {2, 0x44}};
    const int count = sizeof steps / sizeof *steps;
    uint8_t *done = &device->registers[STEPS];
    if (*done == count)
        return;
    if (setup->value != steps[*done][0] || setup->index != steps[*done][1])
        *done = 0;
    if (setup->value == steps[*done][0] && setup->index == steps[*done][1])
        (*done)++;
    device->ready = *done == count;
}

static int write_register(fio_virtual_usb *device, const fio_setup *setup) {
    if (setup->request != (newest(device) ? HXN_WRITE : VENDOR))
        return FIO_USB_STALL;
    if (setup->value < 16)
        device->registers[VENDORS + setup->value] = (uint8_t)setup->index;
    if (!newest(device)) {
        step(device, setup);
        if (setup->value == 8)
            device->incoming_size = 0;
        if (setup->value == 9)
            device->outgoing_size = 0;
        return 0;
    }
    if (setup->value == HXN_RESET)
        device->incoming_size = device->outgoing_size = 0;
    uint8_t flow = device->registers[VENDORS + HXN_FLOW] & HXN_NO_FLOW;
    device->ready = flow == HXN_NO_FLOW || flow == HXN_XON_XOFF; /* there is no CTS here */
    return 0;
}

static int read_register(const fio_virtual_usb *device, const fio_setup *setup, uint8_t *data) {
    if (setup->request != (newest(device) ? HXN_READ : VENDOR))
        return FIO_USB_STALL;
    uint8_t value = setup->value == 0x8484 ? 2
                    : newest(device) && setup->value < 16
                        ? device->registers[VENDORS + setup->value]
                        : 0;
    return fio_chip_answer(setup, data, &value, 1);
}

static int control(fio_virtual_usb *device, double now, const fio_setup *setup, uint8_t *data) {
    if (setup->type == TO_DEVICE)
        return setup->length == 0 ? write_register(device, setup) : FIO_USB_STALL;
    if (setup->type == FROM_DEVICE)
        return read_register(device, setup, data);
    if (setup->index != 0 || (setup->type & 0x7f) != TO_INTERFACE)
        return FIO_USB_STALL;
    int moved = fio_chip_line_coding(device, setup, data);
    if (setup->request == SET_LINE_CODING && moved >= 0)
        settle(device, now);
    if (setup->type != TO_INTERFACE || setup->length > 0)
        return moved;
    if (setup->request == SET_CONTROL_LINE_STATE) {
        fio_chip_set_lines(device, now, setup->value & 1, setup->value & 2);
        return 0;
    }
    return setup->request == SEND_BREAK ? 0 : moved;
}

#define PL2303                                                                                     \
    .maker = "Prolific Technology Inc.", .model = "USB-Serial Controller", .vendor = 0x067b,       \
    .control_packet = 64, .interface = {255, 0, 0}, .in = 0x83, .out = 0x02, .interrupt = 0x81,    \
    .packet = 64, .ends_transfers = true, .control = control

const fio_chip fio_chip_pl2303hx = {
    .name = "pl2303hx", .product = 0x2303, .release = 0x0300, .version = 0x0110, PL2303};
const fio_chip fio_chip_pl2303hxn = {
    .name = "pl2303hxn", .product = 0x23a3, .release = 0x0100, .version = 0x0200, PL2303};
