/* Prolific PL2303 in all its generations. They differ in how a rate that is not on their list is
 * written, and the last of them, HXN, in its registers. */
#include "serial/driver.h"

#include <math.h>
#include <string.h>

enum {
    FROM_DEVICE = 0xc0,
    TO_DEVICE = 0x40,
    TO_INTERFACE = 0x21,
    VENDOR = 0x01,
    HXN_WRITE = 0x80,
    HXN_READ = 0x81,
    SET_LINE_CODING = 0x20,
    SET_CONTROL_LINE_STATE = 0x22,
    HXN_RESET = 0x07,
    HXN_FLOW = 0x0a,
    HXN_FLOW_MASK = 0x1c, /* all of its bits set: none */
    HX_STATUS = 0x8080,
    DTR = 1,
    RTS = 2,
    STATE_KNOWN = 0 /* of state[]: HXN's flow register was set */
};

typedef enum variant { CHIP_H, CHIP_HX, CHIP_HXD, CHIP_TA, CHIP_TB, CHIP_HXN } variant;

static bool match(fio_serial *serial, const fio_usb_device *device) {
    static const fio_usb_id ids[] = {{0x067b, 0x2303}, {0x067b, 0x2304}, {0x067b, 0x23a3},
                                     {0x067b, 0x23b3}, {0x067b, 0x23c3}, {0x067b, 0x23d3},
                                     {0x067b, 0x23e3}, {0x067b, 0x23f3}};
    if (!fio_usb_id_among(device, ids, sizeof ids / sizeof *ids) ||
        !fio_serial_take_interface(serial, device))
        return false;
    if (device->class_code == 2 || device->control_packet != 64)
        serial->chip = CHIP_H;
    else if (device->version < 0x0200)
        serial->chip = device->release == 0x0400 ? CHIP_HXD : CHIP_HX;
    else if (device->release == 0x0300) /* or an HXN: open() asks */
        serial->chip = CHIP_TA;
    else
        serial->chip = device->release == 0x0500 ? CHIP_TB : CHIP_HXN;
    return true;
}

static fio_status write_register(const fio_serial *serial, uint16_t which, uint16_t value) {
    uint8_t code = serial->chip == CHIP_HXN ? HXN_WRITE : VENDOR;
    return fio_serial_send(serial, (fio_request){TO_DEVICE, code, which, value, 0}, NULL);
}

static bool listed(int64_t rate) {
    static const int rates[] = {75,      150,     300,     600,    1200,   1800,   2400,
                                3600,    4800,    7200,    9600,   14400,  19200,  28800,
                                38400,   57600,   115200,  230400, 460800, 614400, 921600,
                                1228800, 2457600, 3000000, 6000000};
    for (size_t i = 0; i < sizeof rates / sizeof *rates; i++)
        if (rates[i] == rate)
            return true;
    return false;
}

/* 12 MHz · 32 / (mantissa · step^exponent): the rate that comes nearest, and its four bytes. */
static double divided(uint8_t bytes[4], double rate, bool alternative) {
    const double base = 12e6 * 32;
    const int step = alternative ? 2 : 4, limit = alternative ? 2048 : 512,
              last = alternative ? 15 : 7;
    int exponent = 0;
    double mantissa = fmax(round(base / rate), 1);
    for (double scale = step; mantissa >= limit && exponent < last; scale *= step) {
        exponent++;
        mantissa = round(base / (rate * scale));
    }
    mantissa = fmin(mantissa, limit - 1);
    unsigned digits = (unsigned)mantissa;
    bytes[0] = (uint8_t)digits;
    bytes[1] = (uint8_t)(digits >> 8 |
                         (alternative ? (unsigned)(exponent & ~1) << 4 : (unsigned)exponent << 1));
    bytes[2] = alternative ? exponent & 1 : 0;
    bytes[3] = 0x80;
    return base / (mantissa * pow(step, exponent));
}

static int most_of(variant chip) {
    static const int most[] = {1228800, 6000000, 12000000, 6000000, 12000000, 12000000};
    return most[chip];
}

/* The rate it will be, and its bytes. */
static double encode(uint8_t bytes[4], int64_t rate, variant chip) {
    int64_t most = most_of(chip), told = rate < 1 ? 1 : rate > most ? most : rate;
    if (chip != CHIP_HXN && !listed(told))
        return divided(bytes, (double)told, chip == CHIP_TA || chip == CHIP_TB);
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(told >> (8 * i));
    return (double)told;
}

/* HXN keeps other things in the register of the flow control; the others have it for themselves. */
static fio_status no_flow_control(fio_serial *serial) {
    if (serial->state[STATE_KNOWN])
        return FIO_OK;
    fio_status status = FIO_OK;
    uint8_t old = 0;
    bool answered = false;
    if (serial->chip == CHIP_HXN)
        status = fio_serial_ask(serial, (fio_request){FROM_DEVICE, HXN_READ, HXN_FLOW, 0, 1}, &old,
                                &answered);
    if (status == FIO_OK)
        status = serial->chip == CHIP_HXN
                     ? write_register(serial, HXN_FLOW, (answered ? old : 0) | HXN_FLOW_MASK)
                     : write_register(serial, 0, 0);
    serial->state[STATE_KNOWN] = status == FIO_OK;
    return status;
}

static fio_status set_rate(fio_serial *serial, int64_t rate) {
    uint8_t coding[7] = {0};
    double nearest = encode(coding, rate, (variant)serial->chip);
    fio_status status = fio_serial_check_rate(serial, rate, nearest);
    if (status != FIO_OK)
        return status;
    coding[6] = 8;
    status = fio_serial_send(
        serial, (fio_request){TO_INTERFACE, SET_LINE_CODING, 0, 0, sizeof coding}, coding);
    if (status == FIO_OK)
        status = no_flow_control(serial);
    if (status == FIO_OK)
        serial->rate = rate;
    return status;
}

static fio_status set_lines(fio_serial *serial, bool dtr, bool rts) {
    uint16_t lines = (uint16_t)((dtr ? DTR : 0) | (rts ? RTS : 0));
    fio_status status = fio_serial_send(
        serial, (fio_request){TO_INTERFACE, SET_CONTROL_LINE_STATE, lines, 0, 0}, NULL);
    return fio_serial_note_lines(serial, dtr, rts, status);
}

/* What the vendor's software sends to all but the HXN; nobody outside knows what it means, and the
 * answers don't matter. */
static fio_status dance(const fio_serial *serial) {
    static const struct {
        bool ask;
        uint16_t value, index;
    } steps[] = {{true, 0x8484, 0}, {false, 0x0404, 0}, {true, 0x8484, 0}, {true, 0x8383, 0},
                 {true, 0x8484, 0}, {false, 0x0404, 1}, {true, 0x8484, 0}, {true, 0x8383, 0},
                 {false, 0, 1},     {false, 1, 0}};
    fio_status status = FIO_OK;
    for (size_t i = 0; i < sizeof steps / sizeof *steps && status == FIO_OK; i++) {
        uint8_t ignored = 0;
        bool answered = false;
        status =
            steps[i].ask
                ? fio_serial_ask(serial, (fio_request){FROM_DEVICE, VENDOR, steps[i].value, 0, 1},
                                 &ignored, &answered)
                : write_register(serial, steps[i].value, steps[i].index);
    }
    if (status == FIO_OK)
        status = write_register(serial, 2, serial->chip == CHIP_H ? 0x24 : 0x44);
    return status;
}

/* Two releases were used twice; only the older chips know this register. */
static fio_status find_generation(fio_serial *serial) {
    if (serial->chip != CHIP_TA && serial->chip != CHIP_TB)
        return FIO_OK;
    uint8_t ignored = 0;
    bool answered = false;
    fio_status status = fio_serial_ask(serial, (fio_request){FROM_DEVICE, VENDOR, HX_STATUS, 0, 1},
                                       &ignored, &answered);
    if (status == FIO_OK && !answered)
        serial->chip = CHIP_HXN;
    return status;
}

/* Empties the pipes of what was left from before; the oldest have no request for it. */
static fio_status reset_pipes(const fio_serial *serial) {
    if (serial->chip == CHIP_HXN)
        return write_register(serial, HXN_RESET, 3);
    if (serial->chip == CHIP_H)
        return FIO_OK;
    fio_status status = write_register(serial, 8, 0);
    return status == FIO_OK ? write_register(serial, 9, 0) : status;
}

static fio_status open(fio_serial *serial, int64_t rate, bool raise_lines) {
    fio_status status = find_generation(serial);
    if (status == FIO_OK && serial->chip != CHIP_HXN)
        status = dance(serial);
    if (status == FIO_OK)
        status = reset_pipes(serial);
    if (status == FIO_OK)
        status = set_rate(serial, rate);
    return status == FIO_OK && raise_lines ? set_lines(serial, true, true) : status;
}

const fio_serial_driver fio_serial_pl2303 = {.name = "pl2303",
                                             .match = match,
                                             .open = open,
                                             .set_rate = set_rate,
                                             .set_lines = set_lines,
                                             .close = fio_serial_lower_lines};
