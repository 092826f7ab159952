/* An FT232R and, with packets of 512 bytes and a faster clock, an FT232H. */
#include "virtual/chip.h"

enum {
    RESET,
    SET_MODEM,
    SET_FLOW,
    SET_RATE,
    SET_DATA,
    GET_MODEM,
    SET_EVENT,
    SET_LATENCY = 9,
    GET_LATENCY = 10,
    READ_EEPROM = 0x90,
    TO_DEVICE = 0x40,
    FROM_DEVICE = 0xc0
};

/* A divisor in eighths, the fraction coded; 0 stands for 1, and 1 for 1.5. */
static double rate_of(const fio_virtual_usb *device, const fio_setup *setup) {
    static const int eighths[8] = {0, 4, 2, 1, 3, 5, 6, 7};
    bool fast = device->chip->packet > 64;
    unsigned high = fast ? setup->index >> 8 : setup->index;
    unsigned fraction = setup->value >> 14 | (high & 1) << 2, whole = setup->value & 0x3fff;
    double divisor = whole + eighths[fraction] / 8.;
    if (fraction == 0 && whole < 2)
        divisor = whole == 0 ? 1 : 1.5;
    else if (whole < 2)
        divisor = 16384; /* no such thing */
    return (fast && (high & 2) ? 12e6 : 3e6) / divisor;
}

static int write_request(fio_virtual_usb *device, double now, const fio_setup *setup) {
    switch (setup->request) {
    case RESET:
        if (setup->value == 1 || setup->value == 0)
            device->incoming_size = 0;
        if (setup->value == 2 || setup->value == 0)
            device->outgoing_size = 0;
        return setup->value > 2 ? FIO_USB_STALL : 0;
    case SET_MODEM: /* the high byte says which of the two change */
        fio_chip_set_lines(device, now, setup->value & 0x100 ? setup->value & 1 : device->dtr,
                           setup->value & 0x200 ? setup->value & 2 : device->rts);
        return 0;
    case SET_RATE:
        fio_chip_set_rate(device, now, rate_of(device, setup), true);
        return 0;
    case SET_FLOW:
        return 0;
    case SET_DATA:
        device->ready = (setup->value & 0x7fff) == 8;
        return 0;
    case SET_EVENT:
        device->event = setup->value & 0x100 ? setup->value & 0xff : -1;
        return 0;
    case SET_LATENCY:
        if (setup->value < 1 || setup->value > 255)
            return FIO_USB_STALL;
        device->latency = setup->value * 1e-3;
        device->status_due = now + device->latency;
        return 0;
    default:
        return FIO_USB_STALL;
    }
}

static int control(fio_virtual_usb *device, double now, const fio_setup *setup, uint8_t *data) {
    static const uint8_t modem[2] = {0x01, 0x60}, nothing[2];
    uint8_t latency = (uint8_t)(device->latency * 1e3 + 0.5);
    if (setup->type == TO_DEVICE)
        return write_request(device, now, setup);
    if (setup->type != FROM_DEVICE)
        return FIO_USB_STALL;
    switch (setup->request) {
    case GET_MODEM:
        return fio_chip_answer(setup, data, modem, 2);
    case GET_LATENCY:
        return fio_chip_answer(setup, data, &latency, 1);
    case READ_EEPROM:
        return fio_chip_answer(setup, data, nothing, 2);
    default:
        return FIO_USB_STALL;
    }
}

#define FTDI                                                                                       \
    .maker = "FTDI", .vendor = 0x0403, .version = 0x0200, .interface = {255, 255, 255},            \
    .in = 0x81, .out = 0x02, .ends_transfers = true, .status_bytes = true, .control = control

const fio_chip fio_chip_ftdi = {.name = "ftdi",
                                .model = "FT232R USB UART",
                                .product = 0x6001,
                                .release = 0x0600,
                                .control_packet = 8,
                                .packet = 64,
                                FTDI};
const fio_chip fio_chip_ftdi_h = {.name = "ftdi-h",
                                  .model = "FT232H USB UART",
                                  .product = 0x6014,
                                  .release = 0x0900,
                                  .control_packet = 64,
                                  .packet = 512,
                                  FTDI};
