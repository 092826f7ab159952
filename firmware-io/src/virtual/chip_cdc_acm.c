/* A CDC-ACM device: a board's own USB, or the bridge of an Arduino Mega. */
#include "virtual/chip.h"

enum { SET_LINE_CODING = 0x20, GET_LINE_CODING, SET_CONTROL_LINE_STATE, SEND_BREAK };

static int control(fio_virtual_usb *device, double now, const fio_setup *setup, uint8_t *data) {
    const uint8_t *coding = device->registers;
    if (setup->index != 0 || (setup->type & 0x7f) != 0x21)
        return FIO_USB_STALL;
    int moved = fio_chip_line_coding(device, setup, data);
    if (setup->request == SET_LINE_CODING && moved >= 0) {
        double rate = coding[0] + coding[1] * 256. + coding[2] * 65536. + coding[3] * 16777216.;
        fio_chip_set_rate(device, now, rate, coding[4] == 0 && coding[5] == 0 && coding[6] == 8);
    } else if (setup->request == SET_CONTROL_LINE_STATE && setup->type == 0x21) {
        fio_chip_set_lines(device, now, setup->value & 1, setup->value & 2);
        return 0;
    }
    return moved;
}

const fio_chip fio_chip_cdc_acm = {.name = "cdc-acm",
                                   .maker = "Arduino (www.arduino.cc)",
                                   .model = "Virtual printer",
                                   .vendor = 0x2341,
                                   .product = 0x0042,
                                   .release = 0x0001,
                                   .version = 0x0110,
                                   .control_packet = 64,
                                   .interface = {10, 0, 0},
                                   .in = 0x83,
                                   .out = 0x02,
                                   .interrupt = 0x81,
                                   .packet = 64,
                                   .communication = true,
                                   .ends_transfers = true,
                                   .ready = true,
                                   .control = control};
