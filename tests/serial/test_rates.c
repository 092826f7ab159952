/* Rates: what each bridge is told is decoded here again by the arithmetic of its datasheet, and
 * compared with the best of everything it could have been told. And FTDI's status bytes. */
#include "serial/serial.h"

#include <stdlib.h>

#include "check.h"
#include "serial/devices.h"

#define COUNT(table) ((int)(sizeof(table) / sizeof *(table)))

static const int64_t rates[] = {300,    1200,   2400,   4800,    9600,    19200,   38400,  57600,
                                74880,  76800,  115200, 128000,  230400,  250000,  256000, 333333,
                                460800, 500000, 921600, 1000000, 1500000, 2000000, 3000000};

static fio_serial plug(recorder *device, raw_device id, uint16_t packet) {
    raw bytes = raw_bridge(id, packet);
    fio_usb_device found;
    fio_serial serial = {.control = recorder_control(device)};
    CHECK(fio_usb_device_read(&found, bytes.bytes, bytes.size));
    CHECK(fio_serial_match(&serial, &found));
    CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 9600, false));
    device->count = 0;
    return serial;
}

/* Off by how much, relative to the rate. */
static double error_of(double actual, double rate) {
    return fabs(actual - rate) / rate;
}

/* Set the rate if it is within 3 % of `best`, else see it refused, with the nearest in the message.
 * True if it was set. */
static bool set_or_refuse(fio_serial *serial, recorder *device, int64_t rate, double best) {
    bool possible = error_of(best, (double)rate) <= 0.03;
    device->count = 0;
    if (!CHECK_EQUAL(possible ? FIO_OK : FIO_USAGE, serial->driver->set_rate(serial, rate)))
        fprintf(stderr, "  %s at %lld, best %g\n", serial->driver->name, (long long)rate, best);
    if (possible) {
        CHECK_EQUAL(rate, serial->rate);
        return device->count > 0;
    }
    char text[32];
    snprintf(text, sizeof text, "%.0f", best);
    CHECK_EQUAL(0, device->count);
    if (!CHECK(strstr(fio_error_message(), text) != NULL))
        fprintf(stderr, "  %s: %s\n", text, fio_error_message());
    return false;
}

/* 48 MHz by a prescaler of 1 to 4096 and a divisor of 8 bits, as the notes on the chip have it. */
static double ch340_rate(int prescaler, int fact, int divisor) {
    return 48e6 / ((1 << (12 - 3 * prescaler - fact)) * (double)divisor);
}

static double ch340_best(double rate, bool limited) {
    double best = INFINITY;
    for (int prescaler = 0; prescaler < 4; prescaler++)
        for (int fact = 0; fact < (limited && prescaler < 3 ? 1 : 2); fact++)
            for (int divisor = fact ? 9 : 2; divisor < 256; divisor++) {
                double actual = ch340_rate(prescaler, fact, divisor);
                if (fabs(actual - rate) < fabs(best - rate))
                    best = actual;
            }
    return best;
}

static void test_ch340(void) {
    static const answer limited[] = {{0xc0, 0x5f, 0, false, 2, {0x31, 0}},
                                     {0xc0, 0x95, 0x0005, true, 0, {0}}};
    for (int clone = 0; clone < 2; clone++) {
        recorder device = {.answers = limited, .answer_count = 1 + clone, .fail_at = -1};
        fio_serial serial =
            plug(&device, (raw_device){0x0110, 0x1a86, 0x7523, 0x0264, 0xff, 8}, 32);
        for (int i = 0; i < COUNT(rates); i++) {
            double best = ch340_best((double)rates[i], clone);
            if (!set_or_refuse(&serial, &device, rates[i], best))
                continue;
            uint16_t word = device.seen[0].index;
            CHECK_EQUAL(0x1312, device.seen[0].value);
            CHECK_NEAR(best, ch340_rate(word & 3, word >> 2 & 1, 256 - (word >> 8)), best * 1e-12);
            CHECK_EQUAL(0x80, word & 0xf8);
        }
        CHECK(ch340_best(250000, clone) == 250000 && ch340_best(1e6, clone) == 1e6);
    }
}

/* AN120: 3 MHz (12 MHz in an H part) by n + 0, 1/8, … 7/8; but 1 and 1.5 below 2, and the oldest
 * knows no other fractions than 1/8, 1/4, 1/2. */
static bool ftdi_has(int eighths, bool oldest) {
    int fraction = eighths % 8;
    if (eighths < 16)
        return eighths == 8 || (eighths == 12 && !oldest);
    return !oldest || fraction < 3 || fraction == 4;
}

static double ftdi_best(double rate, double clock, bool oldest) {
    double best = INFINITY;
    for (int eighths = 8; eighths < 16384 * 8; eighths++)
        if (ftdi_has(eighths, oldest) && fabs(clock * 8 / eighths - rate) < fabs(best - rate))
            best = clock * 8 / eighths;
    return best;
}

static double ftdi_decode(unsigned whole, unsigned code, double clock) {
    static const double fractions[8] = {0, 0.5, 0.25, 0.125, 0.375, 0.625, 0.75, 0.875};
    if (code == 0 && whole < 2)
        return whole == 0 ? clock : clock / 1.5;
    return clock / (whole + fractions[code]);
}

static void test_ftdi(void) {
    static const struct {
        uint16_t release;
        bool oldest, fast, shifted;
    } kinds[] = {{0x0200, true, false, false}, {0x0400, false, false, false},
                 {0x0500, false, false, true}, {0x0600, false, false, false},
                 {0x0700, false, true, true},  {0x0800, false, true, true},
                 {0x0900, false, true, true},  {0x1000, false, false, true}};
    for (int k = 0; k < COUNT(kinds); k++) {
        recorder device = {.fail_at = -1};
        fio_serial serial =
            plug(&device, (raw_device){0x0200, 0x0403, 0x6001, kinds[k].release, 0, 8}, 64);
        for (int i = 0; i < COUNT(rates); i++) {
            bool fast = kinds[k].fast && rates[i] >= 1200;
            double clock = fast ? 12e6 : 3e6,
                   best = ftdi_best((double)rates[i], clock, kinds[k].oldest);
            if (!set_or_refuse(&serial, &device, rates[i], best))
                continue;
            unsigned value = device.seen[0].value, index = device.seen[0].index;
            if (kinds[k].shifted)
                index >>= 8;
            CHECK_EQUAL(3, device.seen[0].request);
            CHECK_EQUAL(fast ? 2 : 0, index & 0xfe);
            CHECK_NEAR(best, ftdi_decode(value & 0x3fff, value >> 14 | (index & 1) << 2, clock),
                       best * 1e-12);
        }
    }
}

/* Of two ports the first is port A, and the rate's high bits move up for it. */
static void test_ftdi_with_two_ports(void) {
    raw bytes = raw_begin((raw_device){0x0200, 0x0403, 0x6010, 0x0700, 0, 64});
    for (uint8_t i = 0; i < 2; i++) {
        raw_interface(&bytes, i, 0, (const uint8_t[]){0xff, 0xff, 0xff});
        raw_endpoint(&bytes, (uint8_t)(0x81 + 2 * i), 2, 512);
        raw_endpoint(&bytes, (uint8_t)(0x02 + 2 * i), 2, 512);
    }
    raw_end(&bytes);
    recorder device = {.fail_at = -1};
    fio_usb_device found;
    fio_serial serial = {.control = recorder_control(&device)};
    CHECK(fio_usb_device_read(&found, bytes.bytes, bytes.size));
    CHECK(found.high_speed && fio_serial_match(&serial, &found));
    CHECK_EQUAL(0x81, serial.in);
    CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, true));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0x40, 0, 0, 1, 0, {0}},
                            {0x40, 9, 16, 1, 0, {0}},
                            {0x40, 6, 0x010a, 1, 0, {0}},
                            {0x40, 4, 8, 1, 0, {0}},
                            {0x40, 3, 0xc068, 0x0201, 0, {0}}, /* 104 + 1/8, by 12 MHz */
                            {0x40, 2, 0, 1, 0, {0}},
                            {0x40, 1, 0x0303, 1, 0, {0}},
                        }));
}

/* AN205's list for the first parts, AN571's division for the later ones. */
static void test_cp210x(void) {
    static const double list[] = {300,    1200,   2400,   4800,   9600,   19200,  38400,
                                  57600,  76800,  115200, 128000, 153600, 230400, 250000,
                                  256000, 460800, 500000, 576000, 921600, 1000000};
    static const struct {
        uint8_t part;
        double most;
        bool divides;
    } parts[] = {{1, 921600, false}, {2, 1e6, false}, {4, 2e6, true}, {0x20, 3e6, true}};
    for (int k = 0; k < COUNT(parts); k++) {
        const answer part = {0xc0, 0xff, 0x370b, false, 1, {parts[k].part}};
        recorder device = {.answers = &part, .answer_count = 1, .fail_at = -1};
        fio_serial serial = plug(&device, (raw_device){0x0110, 0x10c4, 0xea60, 0x0100, 0, 64}, 64);
        for (int i = 0; i < COUNT(rates); i++) {
            double rate = (double)rates[i], best = parts[k].most;
            for (int n = 0; n < COUNT(list) && !parts[k].divides; n++)
                if (list[n] <= parts[k].most && fabs(list[n] - rate) < fabs(best - rate))
                    best = list[n];
            if (parts[k].divides && rate <= parts[k].most) {
                double clock = rate <= 365 ? 6e6 : 24e6;
                best = clock / floor(clock / rate + 0.5);
            }
            if (!set_or_refuse(&serial, &device, rates[i], best))
                continue;
            const uint8_t *data = device.seen[0].data;
            CHECK_EQUAL(0x1e, device.seen[0].request);
            CHECK_EQUAL((int64_t)best,
                        data[0] | data[1] << 8 | data[2] << 16 | (int64_t)data[3] << 24);
        }
    }
}

static double pl2303_best(double rate, int step, int limit, int last) {
    double best = INFINITY, scale = 1;
    for (int exponent = 0; exponent <= last; exponent++, scale *= step)
        for (int mantissa = 1; mantissa < limit; mantissa++) {
            double actual = 12e6 * 32 / (mantissa * scale);
            if (fabs(actual - rate) < fabs(best - rate))
                best = actual;
        }
    return best;
}

/* Listed rates as they are, others as a divisor; the two ways of writing one as in Linux' driver,
 * whose author found them. */
static void test_pl2303(void) {
    static const struct {
        uint16_t version, release;
        int step, limit, last;
        double most;
    } kinds[] = {{0x0110, 0x0300, 4, 512, 7, 6e6},
                 {0x0110, 0x0400, 4, 512, 7, 12e6},
                 {0x0200, 0x0300, 2, 2048, 15, 6e6},
                 {0x0200, 0x0600, 0, 0, 0, 12e6}};
    for (int k = 0; k < COUNT(kinds); k++) {
        recorder device = {.fail_at = -1};
        fio_serial serial = plug(
            &device, (raw_device){kinds[k].version, 0x067b, 0x2303, kinds[k].release, 0, 64}, 64);
        int divided = 0;
        for (int i = 0; i < COUNT(rates); i++) {
            CHECK_EQUAL(FIO_OK, serial.driver->set_rate(&serial, rates[i]));
            const uint8_t *d = device.seen[0].data;
            CHECK_EQUAL(8, d[6]);
            device.count = 0;
            if (d[3] != 0x80) {
                CHECK_EQUAL(rates[i], d[0] | d[1] << 8 | d[2] << 16);
                continue;
            }
            divided++;
            int mantissa = kinds[k].step == 4 ? d[0] | (d[1] & 1) << 8 : d[0] | (d[1] & 7) << 8;
            int exponent = kinds[k].step == 4 ? d[1] >> 1 : d[1] >> 4 | (d[2] & 1);
            double actual = 12e6 * 32 / (mantissa * pow(kinds[k].step, exponent));
            CHECK_NEAR(pl2303_best((double)rates[i], kinds[k].step, kinds[k].limit, kinds[k].last),
                       actual, actual * 1e-12);
        }
        CHECK_EQUAL(kinds[k].step ? 10 : 0, divided);
        CHECK_EQUAL(FIO_USAGE, serial.driver->set_rate(&serial, 20000000));
        CHECK(strstr(fio_error_message(), "nearest") != NULL);
    }
}

static void test_absurd_rates(void) {
    static const raw_device ids[] = {
        {0x0110, 0x1a86, 0x7523, 0x0264, 0xff, 8}, {0x0200, 0x0403, 0x6001, 0x0600, 0, 8},
        {0x0200, 0x0403, 0x6014, 0x0900, 0, 8},    {0x0110, 0x10c4, 0xea60, 0x0100, 0, 64},
        {0x0110, 0x067b, 0x2303, 0x0300, 0, 64},   {0x0200, 0x067b, 0x23a3, 0x0100, 0, 64}};
    static const int64_t absurd[] = {0, -1, -115200, INT64_MIN, INT64_MAX, 4294967296 + 115200, 1};
    for (int k = 0; k < COUNT(ids); k++) {
        recorder device = {.fail_at = -1};
        fio_serial serial = plug(&device, ids[k], 64);
        for (int i = 0; i < COUNT(absurd) - (k == 5); i++) { /* 1 is a rate like any to an HXN */
            CHECK_EQUAL(FIO_USAGE, serial.driver->set_rate(&serial, absurd[i]));
            CHECK_EQUAL(0, device.count);
        }
        CHECK_EQUAL(9600, serial.rate);
    }
    recorder device = {.fail_at = -1};
    raw bytes = raw_mega();
    fio_usb_device found;
    fio_serial serial = {.control = recorder_control(&device)};
    CHECK(fio_usb_device_read(&found, bytes.bytes, bytes.size) &&
          fio_serial_match(&serial, &found));
    CHECK_EQUAL(FIO_USAGE, serial.driver->open(&serial, 0, true));
    CHECK_EQUAL(FIO_USAGE, serial.driver->open(&serial, INT64_MAX, true));
    CHECK_EQUAL(0, device.count);
}

/* 12058624 once passed as done without a request to the device; 78000 is nearest to 76800, which
 * only a CP2102 that is told 76800 makes of it; and a list ends with its highest rate. */
static void test_rates_between_and_beyond(void) {
    static const struct {
        raw_device id;
        int64_t rate;
        uint8_t data[4];
    } cases[] = {
        {{0x0110, 0x10c4, 0xea60, 0x0100, 0, 64}, 78000, {0x00, 0x2c, 0x01, 0x00}},
        {{0x0110, 0x10c4, 0xea60, 0x0100, 0, 64}, 2050000, {0x80, 0x84, 0x1e, 0x00}},
        {{0x0110, 0x067b, 0x2303, 0x0300, 0, 64}, 6100000, {0x80, 0x8d, 0x5b, 0x00}},
        {{0x0200, 0x067b, 0x2303, 0x0400, 0, 64}, 12058624, {0x00, 0x1b, 0xb7, 0x00}},
    };
    for (int i = 0; i < COUNT(cases); i++) {
        recorder device = {.fail_at = -1};
        fio_serial serial = plug(&device, cases[i].id, 64);
        CHECK_EQUAL(FIO_OK, serial.driver->set_rate(&serial, cases[i].rate));
        CHECK_EQUAL(cases[i].rate, serial.rate);
        CHECK(device.count > 0 && memcmp(device.seen[0].data, cases[i].data, 4) == 0);
    }
    recorder device = {.fail_at = -1};
    raw bytes = raw_mega();
    fio_usb_device found;
    fio_serial serial = {.control = recorder_control(&device)};
    CHECK(fio_usb_device_read(&found, bytes.bytes, bytes.size) &&
          fio_serial_match(&serial, &found));
    CHECK_EQUAL(FIO_OK, serial.driver->set_rate(&serial, 12058624));
    CHECK_SEEN(&device,
               ((const seen_request[]){{0x21, 0x20, 0, 0, 7, {0x00, 0x1b, 0xb7, 0, 0, 0, 8}}}));
}

/* Packets of every size in transfers of every size: what is left is the data, nothing more. */
static void test_unwrap_of_every_split(void) {
    static const uint16_t sizes[] = {64, 512};
    for (int k = 0; k < 2; k++) {
        recorder device = {.fail_at = -1};
        fio_serial serial =
            plug(&device, (raw_device){0x0200, 0x0403, 0x6001, 0x0900, 0, 8}, sizes[k]);
        for (size_t size = 0; size <= (size_t)serial.in_transfer; size++) {
            uint8_t *bytes = malloc(size > 0 ? size : 1);
            if (!bytes)
                abort();
            size_t data = 0;
            for (size_t i = 0; i < size; i++)
                bytes[i] = i % sizes[k] == 0   ? 0x01
                           : i % sizes[k] == 1 ? 0x60
                                               : (uint8_t)(data++ * 7 + 3);
            size_t left = serial.driver->unwrap(&serial, bytes, size);
            CHECK_EQUAL((long long)data, (long long)left);
            bool same = true;
            for (size_t i = 0; i < left; i++)
                same = same && bytes[i] == (uint8_t)(i * 7 + 3);
            CHECK(same);
            free(bytes);
        }
        CHECK_EQUAL(0, serial.line_errors);
    }
}

/* Overrun, parity and framing errors are counted by packet; a break or an empty transmitter, which
 * the second byte tells too, is none. */
static void test_unwrap_notices_line_errors(void) {
    recorder device = {.fail_at = -1};
    fio_serial serial = plug(&device, (raw_device){0x0200, 0x0403, 0x6001, 0x0600, 0, 8}, 64);
    static const struct {
        uint8_t status;
        int errors;
    } cases[] = {{0x60, 0}, {0x62, 1}, {0x64, 1}, {0x68, 1}, {0x6e, 1}, {0x70, 0}, {0x01, 0}};
    for (int i = 0; i < COUNT(cases); i++) {
        uint8_t bytes[128] = {1, cases[i].status};
        bytes[64] = 1;
        bytes[65] = 0x60;
        serial.line_errors = 0;
        CHECK_EQUAL(124, (long long)serial.driver->unwrap(&serial, bytes, sizeof bytes));
        CHECK_EQUAL(cases[i].errors, serial.line_errors);
    }
}

int main(void) {
    RUN(test_ch340);
    RUN(test_ftdi);
    RUN(test_ftdi_with_two_ports);
    RUN(test_cp210x);
    RUN(test_pl2303);
    RUN(test_absurd_rates);
    RUN(test_rates_between_and_beyond);
    RUN(test_unwrap_of_every_split);
    RUN(test_unwrap_notices_line_errors);
    return check_verdict();
}
