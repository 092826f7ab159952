/* A CH340: registers written in pairs, packets of 32 bytes. */
#include "virtual/chip.h"

enum {
    READ_VERSION = 0x5f,
    READ_REGISTER = 0x95,
    WRITE_REGISTER = 0x9a,
    INITIALISE = 0xa1,
    MODEM_CONTROL = 0xa4,
    FROM_DEVICE = 0xc0,
    TO_DEVICE = 0x40,
    VERSION = 0x31,
    BREAK = 0x05, /* registers */
    STATUS = 0x06,
    PRESCALER = 0x12,
    DIVISOR = 0x13,
    LINE = 0x18,
    RECEIVER_AND_TRANSMITTER = 0xc0,
    EIGHT_BITS = 0x03,
    FORMAT = 0x3f
};

/* Bit 7 of the prescaler's register is about buffering. */
static void settle(fio_virtual_usb *device, double now) {
    const uint8_t *registers = device->registers;
    int prescaler = registers[PRESCALER] & 3, fact = registers[PRESCALER] >> 2 & 1;
    if (device->chip->limited && prescaler < 3)
        fact = 0;
    double base = 48e6 / (1 << (12 - 3 * prescaler - fact));
    device->ready = (registers[LINE] & RECEIVER_AND_TRANSMITTER) == RECEIVER_AND_TRANSMITTER;
    fio_chip_set_rate(device, now, base / (256 - registers[DIVISOR]),
                      (registers[LINE] & FORMAT) == EIGHT_BITS);
}

static int read_request(fio_virtual_usb *device, const fio_setup *setup, uint8_t *data) {
    uint8_t low = (uint8_t)setup->value, high = (uint8_t)(setup->value >> 8);
    uint8_t answer[2] = {VERSION, 0};
    if (setup->request == READ_REGISTER) {
        if (device->chip->limited && low == BREAK)
            return FIO_USB_STALL;
        answer[0] = low == STATUS ? 0xff : device->registers[low]; /* inputs are inverted: none */
        answer[1] = high == STATUS + 1 ? 0xee : device->registers[high];
    } else if (setup->request != READ_VERSION)
        return FIO_USB_STALL;
    return fio_chip_answer(setup, data, answer, sizeof answer);
}

static int control(fio_virtual_usb *device, double now, const fio_setup *setup, uint8_t *data) {
    if (setup->type == FROM_DEVICE)
        return read_request(device, setup, data);
    if (setup->type != TO_DEVICE)
        return FIO_USB_STALL;
    switch (setup->request) {
    case WRITE_REGISTER:
        device->registers[setup->value & 255] = (uint8_t)setup->index;
        device->registers[setup->value >> 8] = (uint8_t)(setup->index >> 8);
        settle(device, now);
        return 0;
    case INITIALISE:
        return 0;
    case MODEM_CONTROL:
        fio_chip_set_lines(device, now, !(setup->value & 0x20), !(setup->value & 0x40));
        return 0;
    default:
        return FIO_USB_STALL;
    }
}

#define CH340                                                                                      \
    .maker = "1a86", .model = "USB Serial", .vendor = 0x1a86, .product = 0x7523,                   \
    .release = 0x0264, .version = 0x0110, .control_packet = 8, .interface = {255, 1, 2},           \
    .in = 0x82, .out = 0x02, .interrupt = 0x81, .packet = 32, .control = control

const fio_chip fio_chip_ch340 = {.name = "ch340", CH340};
const fio_chip fio_chip_ch340_limited = {.name = "ch340-limited", CH340, .limited = true};
