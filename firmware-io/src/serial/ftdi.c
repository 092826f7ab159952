/* FTDI's bridges: FT232A/B/R, 2232, the H parts and the X series. Every packet from them begins
 * with two bytes of status. */
#include "serial/driver.h"

#include <math.h>
#include <string.h>

enum {
    TO_DEVICE = 0x40,
    RESET = 0,
    SET_MODEM = 1,
    SET_FLOW = 2,
    SET_RATE = 3,
    SET_DATA = 4,
    SET_EVENT = 6,
    SET_LATENCY = 9,
    EIGHT_BITS = 0x0008,
    LATENCY = 16,            /* ms that a bridge waits for more before it sends what it has */
    LINE_END = 0x100 | '\n', /* but not behind this byte: FTDI's AN232B-04 */
    DTR_OFF = 0x0100,
    RTS_OFF = 0x0200,
    DTR_ON = 0x0101,
    RTS_ON = 0x0202,
    STATUS_BYTES = 2,
    TRANSFER = 512,     /* bytes */
    LINE_ERRORS = 0x0e, /* of the second: overrun, parity, framing */
    CHANNEL = 0         /* of state[]: 0 where there is but one */
};

/* B and R alike; C and X take the rate's high bits one byte further up, as the H parts do. */
typedef enum variant { CHIP_A, CHIP_B, CHIP_C, CHIP_H } variant;

/* By the release: 0200 A, 0400 B, 0500 2232C/D, 0600 R, 0700 to 0900 H, 1000 X, later ones H. */
static variant chip_of(uint16_t release) {
    if (release < 0x0300)
        return CHIP_A;
    if (release == 0x0500 || release == 0x1000)
        return CHIP_C;
    return release < 0x0700 ? CHIP_B : CHIP_H;
}

static bool match(fio_serial *serial, const fio_usb_device *device) {
    static const fio_usb_id ids[] = {
        {0x0403, 0x6001}, {0x0403, 0x6010}, {0x0403, 0x6011}, {0x0403, 0x6014}, {0x0403, 0x6015}};
    if (!fio_usb_id_among(device, ids, sizeof ids / sizeof *ids) ||
        !fio_serial_take_interface(serial, device))
        return false;
    if (serial->in_packet < TRANSFER) /* the status packets end every transfer in time */
        serial->in_transfer = (uint16_t)(TRANSFER - TRANSFER % serial->in_packet);
    serial->chip = chip_of(device->release);
    int others = 0;
    for (int i = 0; i < device->interface_count; i++)
        others += device->interfaces[i].number != serial->interfaces[0];
    serial->state[CHANNEL] = others > 0 ? (uint8_t)(serial->interfaces[0] + 1) : 0;
    return true;
}

/* The clock is divided by eighths: 3 MHz, or 12 MHz in an H part. Only 0, the divisor 1, and 1,
 * which stands for 1.5, are below 2; the fraction's bits are in an order of their own, as FTDI's
 * AN120 lists them. The oldest part has but four of the fractions. */
static uint32_t find_divisor(double *nearest, double rate, variant chip) {
    static const uint32_t fractions[8] = {0, 3, 2, 4, 1, 5, 6, 7};
    static const bool of_a[8] = {true, true, true, false, true};
    bool fast = chip == CHIP_H && rate >= 1200;
    double clock = fast ? 12e6 : 3e6, best_error = INFINITY;
    int wanted = (int)fmin(round(clock * 8 / rate), 16383 * 8 + 7), best = 8;
    for (int eighths = wanted - 8; eighths <= wanted + 8; eighths++) {
        bool possible = eighths >= 16 || eighths == 8 || (eighths == 12 && chip != CHIP_A);
        if (!possible || eighths > 16383 * 8 + 7 || (chip == CHIP_A && !of_a[eighths & 7]))
            continue;
        double error = fabs(clock * 8 / eighths - rate);
        if (error < best_error) {
            best_error = error;
            best = eighths;
        }
    }
    *nearest = clock * 8 / best;
    uint32_t divisor = (uint32_t)best >> 3 | fractions[best & 7] << 14;
    divisor = best == 8 ? 0 : best == 12 ? 1 : divisor;
    return divisor | (fast ? 0x20000u : 0);
}

static fio_status set(const fio_serial *serial, uint8_t request, uint16_t value, uint16_t index) {
    return fio_serial_send(serial, (fio_request){TO_DEVICE, request, value, index, 0}, NULL);
}

static fio_status set_rate(fio_serial *serial, int64_t rate) {
    double nearest = 0;
    uint32_t divisor = find_divisor(&nearest, rate > 0 ? (double)rate : 1, (variant)serial->chip);
    fio_status status = fio_serial_check_rate(serial, rate, nearest);
    if (status != FIO_OK)
        return status;
    uint16_t high = (uint16_t)(divisor >> 16), channel = serial->state[CHANNEL];
    bool shifted = serial->chip == CHIP_C || serial->chip == CHIP_H;
    status =
        set(serial, SET_RATE, (uint16_t)divisor, shifted ? (uint16_t)(high << 8 | channel) : high);
    if (status == FIO_OK)
        serial->rate = rate;
    return status;
}

static fio_status set_lines(fio_serial *serial, bool dtr, bool rts) {
    uint16_t lines = (uint16_t)((dtr ? DTR_ON : DTR_OFF) | (rts ? RTS_ON : RTS_OFF));
    fio_status status = set(serial, SET_MODEM, lines, serial->state[CHANNEL]);
    return fio_serial_note_lines(serial, dtr, rts, status);
}

static fio_status open(fio_serial *serial, int64_t rate, bool raise_lines) {
    uint16_t channel = serial->state[CHANNEL];
    fio_status status = set(serial, RESET, 0, channel);
    if (status == FIO_OK && serial->chip != CHIP_A) /* which has no such timer */
        status = set(serial, SET_LATENCY, LATENCY, channel);
    if (status == FIO_OK)
        status = set(serial, SET_EVENT, LINE_END, channel);
    if (status == FIO_OK)
        status = set(serial, SET_DATA, EIGHT_BITS, channel);
    if (status == FIO_OK)
        status = set_rate(serial, rate);
    if (status == FIO_OK)
        status = set(serial, SET_FLOW, 0, channel);
    return status == FIO_OK && raise_lines ? set_lines(serial, true, true) : status;
}

static size_t unwrap(fio_serial *serial, uint8_t *bytes, size_t size) {
    size_t kept = 0;
    for (size_t at = 0; at < size; at += serial->in_packet) {
        size_t length = size - at < serial->in_packet ? size - at : serial->in_packet;
        if (length < STATUS_BYTES)
            break;
        serial->line_errors += (bytes[at + 1] & LINE_ERRORS) != 0;
        memmove(bytes + kept, bytes + at + STATUS_BYTES, length - STATUS_BYTES);
        kept += length - STATUS_BYTES;
    }
    return kept;
}

const fio_serial_driver fio_serial_ftdi = {.name = "ftdi",
                                           .match = match,
                                           .open = open,
                                           .set_rate = set_rate,
                                           .set_lines = set_lines,
                                           .close = fio_serial_lower_lines,
                                           .unwrap = unwrap};
