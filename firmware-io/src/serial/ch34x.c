/* WCH CH340 and CH341: what most boards and clones have. There is no datasheet of the requests;
 * they are what the vendor's own software sends. */
#include "serial/driver.h"

#include <math.h>

enum {
    FROM_DEVICE = 0xc0,
    TO_DEVICE = 0x40,
    READ_VERSION = 0x5f,
    WRITE_REGISTER = 0x9a,
    READ_REGISTER = 0x95,
    INITIALISE = 0xa1,
    MODEM_CONTROL = 0xa4,
    DIVISOR_AND_PRESCALER = 0x1312,
    LINE_CONTROL = 0x2518,
    BREAK_REGISTER = 0x0005,
    EIGHT_BITS = 0xc3,      /* no parity, receiver and transmitter on */
    NO_BUFFERING = 0x80,    /* don't wait for a whole packet */
    UNBUFFERED_FROM = 0x28, /* at least one older chip has that bit the other way round */
    LINE_CONTROL_FROM = 0x30,
    DTR = 0x20,
    RTS = 0x40,
    LIMITED = 1, /* chip: a clone without the half steps of the slower prescalers */
    VERSION = 0  /* of state[] */
};

#define CLOCK 48e6 /* Hz */

static bool match(fio_serial *serial, const fio_usb_device *device) {
    static const fio_usb_id ids[] = {
        {0x1a86, 0x7523}, {0x1a86, 0x5523}, {0x1a86, 0x7522}, {0x4348, 0x5523}};
    return fio_usb_id_among(device, ids, sizeof ids / sizeof *ids) &&
           fio_serial_take_interface(serial, device);
}

/* rate = clock / (2^(12 - 3 prescaler - fact) divisor). Of all settings the nearest; of equals the
 * one with fact 0, whose receiver samples more finely, and the fastest prescaler. Divisors below 9
 * don't work with fact 1. */
static uint16_t find_divisor(double *nearest, double rate, bool limited) {
    uint16_t best = 0;
    double best_error = INFINITY;
    for (int prescaler = 3; prescaler >= 0; prescaler--) {
        for (int fact = 0; fact < (limited && prescaler < 3 ? 1 : 2); fact++) {
            double base = CLOCK / (double)(1 << (12 - 3 * prescaler - fact));
            double divisor = round(base / rate), least = fact ? 9 : 2;
            divisor = divisor < least ? least : divisor > 255 ? 255 : divisor;
            double error = fabs(base / divisor - rate);
            if (error >= best_error)
                continue;
            best_error = error;
            *nearest = base / divisor;
            best = (uint16_t)((256 - (int)divisor) << 8 | fact << 2 | prescaler);
        }
    }
    return best;
}

static fio_status write_register(const fio_serial *serial, uint16_t pair, uint16_t value) {
    return fio_serial_send(serial, (fio_request){TO_DEVICE, WRITE_REGISTER, pair, value, 0}, NULL);
}

static fio_status set_rate(fio_serial *serial, int64_t rate) {
    double nearest = 0;
    uint16_t divisor = find_divisor(&nearest, rate > 0 ? (double)rate : 1, serial->chip == LIMITED);
    fio_status status = fio_serial_check_rate(serial, rate, nearest);
    if (status != FIO_OK)
        return status;
    if (serial->state[VERSION] >= UNBUFFERED_FROM)
        divisor |= NO_BUFFERING;
    status = write_register(serial, DIVISOR_AND_PRESCALER, divisor);
    if (status == FIO_OK && serial->state[VERSION] >= LINE_CONTROL_FROM)
        status = write_register(serial, LINE_CONTROL, EIGHT_BITS);
    if (status == FIO_OK)
        serial->rate = rate;
    return status;
}

static fio_status set_lines(fio_serial *serial, bool dtr, bool rts) {
    uint16_t lines = (uint16_t) ~((dtr ? DTR : 0) | (rts ? RTS : 0)); /* low is on */
    fio_status status =
        fio_serial_send(serial, (fio_request){TO_DEVICE, MODEM_CONTROL, lines, 0, 0}, NULL);
    return fio_serial_note_lines(serial, dtr, rts, status);
}

/* A clone that stalls when it is asked for the break register lacks other things too. */
static fio_status open(fio_serial *serial, int64_t rate, bool raise_lines) {
    uint8_t bytes[2] = {0};
    bool answered = false;
    fio_status status =
        fio_serial_ask(serial, (fio_request){FROM_DEVICE, READ_VERSION, 0, 0, 2}, bytes, &answered);
    serial->state[VERSION] = answered ? bytes[0] : LINE_CONTROL_FROM;
    if (status == FIO_OK)
        status = fio_serial_send(serial, (fio_request){TO_DEVICE, INITIALISE, 0, 0, 0}, NULL);
    if (status == FIO_OK)
        status =
            fio_serial_ask(serial, (fio_request){FROM_DEVICE, READ_REGISTER, BREAK_REGISTER, 0, 2},
                           bytes, &answered);
    serial->chip = answered ? 0 : LIMITED;
    if (status == FIO_OK)
        status = set_rate(serial, rate);
    return status == FIO_OK && raise_lines ? set_lines(serial, true, true) : status;
}

const fio_serial_driver fio_serial_ch34x = {.name = "ch341",
                                            .match = match,
                                            .open = open,
                                            .set_rate = set_rate,
                                            .set_lines = set_lines,
                                            .close = fio_serial_lower_lines};
