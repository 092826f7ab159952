/* A CP2102: it takes a rate for one of a list (AN205), and no byte until its UART is switched on.
 */
#include "virtual/chip.h"

#include <math.h>
#include <string.h>

enum {
    INTERFACE_ENABLE = 0x00,
    SET_LINE = 0x03,
    GET_LINE = 0x04,
    SET_BREAK = 0x05,
    SET_MODEM = 0x07,
    GET_MODEM = 0x08,
    GET_STATUS = 0x10,
    PURGE = 0x12,
    SET_FLOW = 0x13,
    GET_FLOW = 0x14,
    SET_CHARACTERS = 0x19,
    GET_RATE = 0x1d,
    SET_RATE = 0x1e,
    VENDOR_SPECIFIC = 0xff,
    PART_NUMBER = 0x370b,
    PART = 2,
    LINE = 0, /* in registers[]: 2 bytes */
    RATE = 4,
    FLOW = 16,
    ENABLED = 32,
    TO_INTERFACE = 0x41,
    FROM_INTERFACE = 0xc1,
    FROM_DEVICE = 0xc0
};

/* What each rate is taken for, up to which: the chip's own table. */
static double taken_for(double rate) {
    static const struct {
        int rate, upto;
    } list[] = {
        {300, 300},       {600, 600},       {1200, 1200},     {1800, 1800},     {2400, 2400},
        {4000, 4000},     {4800, 4803},     {7200, 7207},     {9600, 9612},     {14400, 14428},
        {16000, 16062},   {19200, 19250},   {28800, 28912},   {38400, 38601},   {51200, 51558},
        {56000, 56280},   {57600, 58053},   {64000, 64111},   {76800, 77608},   {115200, 117028},
        {128000, 129347}, {153600, 156868}, {230400, 237832}, {250000, 254234}, {256000, 273066},
        {460800, 491520}, {500000, 567138}, {576000, 670254}, {921600, 999999}};
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        if (rate <= list[i].upto)
            return list[i].rate;
    return 1e6;
}

static void settle(fio_virtual_usb *device, double now) {
    const uint8_t *bytes = device->registers + RATE;
    double rate = taken_for(bytes[0] + bytes[1] * 256. + bytes[2] * 65536. + bytes[3] * 16777216.);
    double clock = rate < 366 ? 6e6 : 24e6;
    fio_chip_set_rate(device, now, clock / round(clock / rate),
                      device->registers[LINE] == 0 && device->registers[LINE + 1] == 8);
}

static int write_data(fio_virtual_usb *device, double now, const fio_setup *setup,
                      const uint8_t *data) {
    switch (setup->request) {
    case SET_RATE:
        if (setup->length != 4)
            return FIO_USB_STALL;
        memcpy(device->registers + RATE, data, 4);
        settle(device, now);
        return 4;
    case SET_CHARACTERS:
        return setup->length == 6 ? 6 : FIO_USB_STALL;
    case SET_FLOW: /* the lines are driven by it, and a handshake waits for a line that is low */
        if (setup->length != 16)
            return FIO_USB_STALL;
        memcpy(device->registers + FLOW, data, 16);
        device->ready = device->registers[ENABLED] && (data[0] & 0x38) == 0;
        fio_chip_set_lines(device, now, (data[0] & 3) == 1, (data[4] & 0xc0) == 0x40);
        return 16;
    default:
        return FIO_USB_STALL;
    }
}

static int write_request(fio_virtual_usb *device, double now, const fio_setup *setup) {
    switch (setup->request) {
    case INTERFACE_ENABLE:
        device->registers[ENABLED] = setup->value & 1;
        device->ready = (setup->value & 1) && (device->registers[FLOW] & 0x38) == 0;
        if (!(setup->value & 1))
            fio_chip_set_lines(device, now, false, false);
        return 0;
    case SET_LINE:
        device->registers[LINE] = (uint8_t)setup->value;
        device->registers[LINE + 1] = (uint8_t)(setup->value >> 8);
        settle(device, now);
        return 0;
    case SET_MODEM:
        fio_chip_set_lines(device, now, setup->value & 0x100 ? setup->value & 1 : device->dtr,
                           setup->value & 0x200 ? setup->value & 2 : device->rts);
        return 0;
    case PURGE:
        if (setup->value & 0x05)
            device->outgoing_size = 0;
        if (setup->value & 0x0a)
            device->incoming_size = 0;
        return 0;
    case SET_BREAK:
        return 0;
    default:
        return FIO_USB_STALL;
    }
}

static int read_request(const fio_virtual_usb *device, const fio_setup *setup, uint8_t *data) {
    uint8_t status[19] = {0}, modem = (uint8_t)(device->dtr | device->rts << 1), part = PART;
    switch (setup->request) {
    case GET_LINE:
        return fio_chip_answer(setup, data, device->registers + LINE, 2);
    case GET_RATE:
        return fio_chip_answer(setup, data, device->registers + RATE, 4);
    case GET_FLOW:
        return fio_chip_answer(setup, data, device->registers + FLOW, 16);
    case GET_MODEM:
        return fio_chip_answer(setup, data, &modem, 1);
    case GET_STATUS:
        return fio_chip_answer(setup, data, status, sizeof status);
    case VENDOR_SPECIFIC:
        return setup->value == PART_NUMBER ? fio_chip_answer(setup, data, &part, 1) : FIO_USB_STALL;
    default:
        return FIO_USB_STALL;
    }
}

static int control(fio_virtual_usb *device, double now, const fio_setup *setup, uint8_t *data) {
    if (setup->index != 0)
        return FIO_USB_STALL;
    if (setup->type == FROM_INTERFACE || setup->type == FROM_DEVICE)
        return read_request(device, setup, data);
    if (setup->type != TO_INTERFACE)
        return FIO_USB_STALL;
    return setup->length > 0 ? write_data(device, now, setup, data)
                             : write_request(device, now, setup);
}

const fio_chip fio_chip_cp2102 = {.name = "cp2102",
                                  .maker = "Silicon Labs",
                                  .model = "CP2102 USB to UART Bridge Controller",
                                  .vendor = 0x10c4,
                                  .product = 0xea60,
                                  .release = 0x0100,
                                  .version = 0x0110,
                                  .control_packet = 64,
                                  .interface = {255, 0, 0},
                                  .in = 0x81,
                                  .out = 0x01,
                                  .packet = 64,
                                  .ends_transfers = true,
                                  .control = control};
