/* Silicon Labs CP2101 to CP2109 and CP2102N, by their AN571. */
#include "serial/driver.h"

#include <math.h>
#include <string.h>

enum {
    FROM_DEVICE = 0xc0,
    FROM_INTERFACE = 0xc1,
    TO_INTERFACE = 0x41,
    INTERFACE_ENABLE = 0x00,
    SET_LINE = 0x03,
    SET_MODEM = 0x07,
    GET_MODEM = 0x08,
    PURGE = 0x12,
    SET_FLOW = 0x13,
    SET_CHARACTERS = 0x19,
    SET_RATE = 0x1e,
    VENDOR_SPECIFIC = 0xff,
    PART_NUMBER = 0x370b,
    EIGHT_BITS = 0x0800,
    PURGE_ALL = 0x000f,
    DTR = 0x0001,
    RTS = 0x0002,
    BOTH_CHANGE = 0x0300,
    CP2101 = 1,
    CP2102 = 2,
    CP2103 = 3,
    CP2104 = 4,
    CP2105 = 5,
    CP2108 = 8,
    CP2102N = 0x20, /* and the two after it */
};

static bool match(fio_serial *serial, const fio_usb_device *device) {
    static const fio_usb_id ids[] = {
        {0x10c4, 0xea60}, {0x10c4, 0xea61}, {0x10c4, 0xea63}, {0x10c4, 0xea70}, {0x10c4, 0xea71}};
    return fio_usb_id_among(device, ids, sizeof ids / sizeof *ids) &&
           fio_serial_take_interface(serial, device);
}

static fio_request request(const fio_serial *serial, uint8_t code, uint16_t value,
                           uint16_t length) {
    return (fio_request){TO_INTERFACE, code, value, (uint16_t)serial->interfaces[0], length};
}

/* AN205: the first parts know these rates and, but for the very first, 1 M; what lies between they
 * take for one of them, which need not be the nearest. */
static double listed_rate(double rate, int part) {
    static const int rates[] = {300,    600,    1200,   1800,   2400,   4000,   4800,   7200,
                                9600,   14400,  16000,  19200,  28800,  38400,  51200,  56000,
                                57600,  64000,  76800,  115200, 128000, 153600, 230400, 250000,
                                256000, 460800, 500000, 576000, 921600, 1000000};
    double nearest = rates[0];
    int count = (int)(sizeof rates / sizeof *rates) - (part == CP2101);
    for (int i = 1; i < count; i++)
        if (fabs(rates[i] - rate) < fabs(nearest - rate))
            nearest = rates[i];
    return nearest;
}

static double divided_rate(double rate, double most) {
    double clock = rate <= 365 ? 6e6 : 24e6;
    rate = fmin(rate, most);
    return fmin(clock / fmax(round(clock / rate), 1), most);
}

static double nearest_rate(double rate, int part) {
    switch (part) {
    case CP2104:
    case CP2105:
    case CP2108:
        return divided_rate(rate, 2e6);
    case CP2102N:
    case CP2102N + 1:
    case CP2102N + 2:
        return divided_rate(rate, 3e6);
    case CP2101:
    case CP2102:
    case CP2103:
        return listed_rate(rate, part);
    default: /* a clone: the old list, and beyond it what the newer ones do */
        return rate > 1e6 ? divided_rate(rate, 2e6) : listed_rate(rate, part);
    }
}

static fio_status set_rate(fio_serial *serial, int64_t rate) {
    double nearest = nearest_rate(rate > 0 ? (double)rate : 1, serial->chip);
    fio_status status = fio_serial_check_rate(serial, rate, nearest);
    if (status != FIO_OK)
        return status;
    uint32_t told = (uint32_t)nearest;
    uint8_t bytes[4] = {(uint8_t)told, (uint8_t)(told >> 8), (uint8_t)(told >> 16),
                        (uint8_t)(told >> 24)};
    status = fio_serial_send(serial, request(serial, SET_RATE, 0, sizeof bytes), bytes);
    if (status == FIO_OK)
        serial->rate = rate;
    return status;
}

static fio_status set_lines(fio_serial *serial, bool dtr, bool rts) {
    uint16_t lines = (uint16_t)(BOTH_CHANGE | (dtr ? DTR : 0) | (rts ? RTS : 0));
    fio_status status = fio_serial_send(serial, request(serial, SET_MODEM, lines, 0), NULL);
    return fio_serial_note_lines(serial, dtr, rts, status);
}

/* No handshake of any kind, whatever was set before. This drives the two lines too; where they must
 * not rise, they are set to what they are. */
static fio_status set_flow(const fio_serial *serial, bool raise_lines) {
    uint8_t flow[16] = {0}, lines = DTR | RTS;
    bool answered = true;
    fio_status status = FIO_OK;
    if (!raise_lines) {
        fio_request ask = request(serial, GET_MODEM, 0, 1);
        ask.type = FROM_INTERFACE;
        status = fio_serial_ask(serial, ask, &lines, &answered);
    }
    if (status != FIO_OK)
        return status;
    flow[0] = answered && (lines & DTR) ? 0x01 : 0;
    flow[4] = answered && (lines & RTS) ? 0x40 : 0;
    return fio_serial_send(serial, request(serial, SET_FLOW, 0, sizeof flow), flow);
}

static fio_status open(fio_serial *serial, int64_t rate, bool raise_lines) {
    static const uint8_t characters[6] = {0, 0, 0, 0, 0x11, 0x13}; /* XON and XOFF last */
    uint8_t part = 0;
    bool answered = false;
    fio_status status = fio_serial_ask(
        serial, (fio_request){FROM_DEVICE, VENDOR_SPECIFIC, PART_NUMBER, 0, 1}, &part, &answered);
    if (status != FIO_OK)
        return status;
    serial->chip = answered ? part : 0;
    status = fio_serial_send(serial, request(serial, INTERFACE_ENABLE, 1, 0), NULL);
    if (status == FIO_OK)
        status = set_rate(serial, rate);
    if (status == FIO_OK)
        status = fio_serial_send(serial, request(serial, SET_LINE, EIGHT_BITS, 0), NULL);
    if (status == FIO_OK)
        status = fio_serial_send(serial, request(serial, SET_CHARACTERS, 0, 6), characters);
    if (status == FIO_OK)
        status = set_flow(serial, raise_lines);
    return status == FIO_OK && raise_lines ? set_lines(serial, true, true) : status;
}

/* Some parts hang, and do not open again, if they are switched off with bytes in them. */
static fio_status close(fio_serial *serial) {
    fio_status status = fio_serial_lower_lines(serial);
    if (status == FIO_OK)
        status = fio_serial_send(serial, request(serial, PURGE, PURGE_ALL, 0), NULL);
    if (status == FIO_OK)
        status = fio_serial_send(serial, request(serial, INTERFACE_ENABLE, 0, 0), NULL);
    return status;
}

const fio_serial_driver fio_serial_cp210x = {.name = "cp210x",
                                             .match = match,
                                             .open = open,
                                             .set_rate = set_rate,
                                             .set_lines = set_lines,
                                             .close = close};
