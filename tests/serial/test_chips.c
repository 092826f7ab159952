/* Each driver against each chip of the virtual printer, over a direct link: what the driver tells
 * the chip comes out as the rate and the lines that were asked for, and the printer answers. */
#include "virtual/usb_device.h"

#include <stdlib.h>

#include "check.h"
#include "serial/serial.h"

typedef struct link {
    fio_machine *machine;
    fio_virtual_usb *device;
    fio_serial serial;
    fio_usb_device found;
    double now;
    char text[4096]; /* what the printer said */
    size_t length;
    int packets, empty_packets, refused;
} link;

static fio_status request(void *context, uint8_t type, uint8_t code, uint16_t value, uint16_t index,
                          void *data, uint16_t length, uint16_t *moved, bool *stalled) {
    link *l = context;
    const uint8_t setup[8] = {type,
                              code,
                              (uint8_t)value,
                              (uint8_t)(value >> 8),
                              (uint8_t)index,
                              (uint8_t)(index >> 8),
                              (uint8_t)length,
                              (uint8_t)(length >> 8)};
    int result = fio_virtual_usb_control(l->device, l->now, setup, data, length);
    l->now += 0.0005;
    if (result == FIO_USB_GONE)
        return fio_fail(FIO_LINK_LOST, "gone");
    *stalled = result == FIO_USB_STALL;
    *moved = (uint16_t)(result > 0 ? result : 0);
    return FIO_OK;
}

static link *plug(const char *chip, int64_t rate, const fio_virtual_usb_options *more) {
    link *l = calloc(1, sizeof *l);
    if (!l)
        abort();
    fio_machine_options machine = fio_machine_options_defaults();
    machine.rate = rate;
    machine.boot_seconds = 0.01;
    fio_virtual_usb_options options = more ? *more : (fio_virtual_usb_options){0};
    options.chip = chip;
    CHECK_EQUAL(FIO_OK, fio_machine_create(&l->machine, &machine));
    CHECK_EQUAL(FIO_OK, fio_virtual_usb_create(&l->device, l->machine, &options));
    size_t size = 0;
    const uint8_t *bytes = fio_virtual_usb_descriptors(l->device, &size);
    CHECK(fio_usb_device_read(&l->found, bytes, size));
    l->serial.control = (fio_control){request, l};
    CHECK(fio_serial_match(&l->serial, &l->found));
    return l;
}

static void unplug(link *l) {
    fio_virtual_usb_free(l->device);
    fio_machine_free(l->machine);
    free(l);
}

/* One IN transfer as a host controller makes it: packets until a short one or the buffer is full.
 * Then the driver takes its wrapping off. */
static void receive(link *l) {
    uint8_t buffer[1024];
    size_t got = 0;
    while (got + l->serial.in_packet <= l->serial.in_transfer) {
        int size =
            fio_virtual_usb_in(l->device, l->now, l->serial.in, buffer + got, l->serial.in_packet);
        if (size < 0)
            break;
        l->packets++;
        l->empty_packets += size <= (l->serial.driver->unwrap ? 2 : 0);
        got += (size_t)size;
        if (size < l->serial.in_packet)
            break;
    }
    size_t left =
        l->serial.driver->unwrap ? l->serial.driver->unwrap(&l->serial, buffer, got) : got;
    CHECK(l->length + left < sizeof l->text);
    if (l->length + left >= sizeof l->text)
        abort();
    memcpy(l->text + l->length, buffer, left);
    l->length += left;
    l->text[l->length] = 0;
}

/* Let time pass, a tenth of a millisecond at a time, reading all the while. */
static void run(link *l, double seconds) {
    for (double end = l->now + seconds; l->now < end; l->now += 0.0001)
        receive(l);
}

static void send(link *l, const char *text) {
    size_t size = strlen(text), at = 0;
    for (int tries = 0; at < size && tries < 100000; tries++) {
        size_t piece = size - at < l->serial.out_packet ? size - at : l->serial.out_packet;
        int taken = fio_virtual_usb_out(l->device, l->now, l->serial.out,
                                        (const uint8_t *)text + at, (int)piece);
        if (taken == FIO_USB_NAK) {
            l->refused++;
            run(l, 0.0001);
            continue;
        }
        CHECK_EQUAL((int)piece, taken);
        at += piece;
    }
    CHECK_EQUAL((long long)size, (long long)at);
}

static const struct {
    const char *chip, *driver;
    int packet;
} chips[] = {{"cdc-acm", "cdc-acm", 64}, {"ch340", "ch341", 32},     {"ch340-limited", "ch341", 32},
             {"ftdi", "ftdi", 64},       {"ftdi-h", "ftdi", 512},    {"cp2102", "cp210x", 64},
             {"pl2303hx", "pl2303", 64}, {"pl2303hxn", "pl2303", 64}};

enum { CHIPS = sizeof chips / sizeof *chips };

static bool talk(link *l) {
    l->length = 0;
    send(l, "M115\n");
    run(l, 0.3);
    bool good = strstr(l->text, "FIRMWARE_NAME:") && strstr(l->text, "ok\n");
    l->length = 0;
    send(l, "N-1 M110*15\nM105\n");
    run(l, 0.3);
    return good && strstr(l->text, "ok T:");
}

static void test_a_dialogue_with_every_chip_at_every_rate(void) {
    static const int64_t rates[] = {115200, 250000, 1000000, 57600, 500000};
    for (int i = 0; i < CHIPS; i++) {
        for (size_t k = 0; k < sizeof rates / sizeof *rates; k++) {
            link *l = plug(chips[i].chip, rates[k], NULL);
            CHECK(strcmp(l->serial.driver->name, chips[i].driver) == 0);
            CHECK_EQUAL(chips[i].packet, l->serial.in_packet);
            CHECK_EQUAL(l->found.high_speed, fio_virtual_usb_high_speed(l->device));
            CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, rates[k], true));
            run(l, 0.1);
            if (!CHECK(strstr(l->text, "start") != NULL) || !CHECK(talk(l)))
                fprintf(stderr, "  %s at %lld: \"%s\"\n", chips[i].chip, (long long)rates[k],
                        l->text);
            CHECK_EQUAL(1, fio_machine_count(l->machine)->resets);
            CHECK_EQUAL(0, fio_machine_count(l->machine)->faults);
            CHECK_EQUAL(0, l->serial.line_errors);
            CHECK_EQUAL(FIO_OK, l->serial.driver->close(&l->serial));
            unplug(l);
        }
    }
}

/* The machine at another rate than it was asked for: nothing comes through. */
static void test_a_wrong_rate_gives_rubbish(void) {
    for (int i = 0; i < CHIPS; i++) {
        link *l = plug(chips[i].chip, 250000, NULL);
        CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, true));
        run(l, 0.1);
        CHECK(!talk(l));
        CHECK_EQUAL(FIO_OK, l->serial.driver->set_rate(&l->serial, 250000));
        send(l, "\n"); /* ends the rubbish */
        run(l, 0.3);
        CHECK(talk(l));
        unplug(l);
    }
}

static void test_lines_rise_only_if_they_are_told_to(void) {
    for (int i = 0; i < CHIPS; i++) {
        link *l = plug(chips[i].chip, 115200, NULL);
        int64_t before = fio_machine_count(l->machine)->resets;
        CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, false));
        CHECK_EQUAL(before, fio_machine_count(l->machine)->resets);
        CHECK_EQUAL(FIO_OK, l->serial.driver->close(&l->serial));
        CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, true));
        CHECK_EQUAL(before + 1, fio_machine_count(l->machine)->resets);
        CHECK_EQUAL(FIO_OK, l->serial.driver->set_lines(&l->serial, true, false));
        CHECK_EQUAL(FIO_OK, l->serial.driver->set_rate(&l->serial, 250000));
        CHECK_EQUAL(FIO_OK, l->serial.driver->set_lines(&l->serial, true, true));
        CHECK_EQUAL(before + 1, fio_machine_count(l->machine)->resets);
        CHECK_EQUAL(FIO_OK, l->serial.driver->close(&l->serial));
        CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, false));
        CHECK_EQUAL(before + 1, fio_machine_count(l->machine)->resets);
        CHECK_EQUAL(FIO_OK, l->serial.driver->set_lines(&l->serial, true, true));
        CHECK_EQUAL(before + 2, fio_machine_count(l->machine)->resets);
        unplug(l);
    }
}

/* A bridge that has not been set up passes nothing on. */
static void test_bridges_need_their_setup(void) {
    for (int i = 1; i < CHIPS; i++) {
        link *l = plug(chips[i].chip, 9600, NULL);
        fio_virtual_usb_out(l->device, 0, l->serial.out, (const uint8_t *)"M115\n", 5);
        run(l, 0.2);
        CHECK_EQUAL(0, fio_machine_count(l->machine)->bytes_in);
        CHECK_EQUAL(0, (long long)l->length);
        unplug(l);
    }
}

/* At 115200 bits/s 20 kB take 1.7 s: the chip holds the host back instead of losing any. */
static void test_back_pressure(void) {
    static char text[20001];
    memset(text, ';', sizeof text - 1);
    for (size_t i = 19; i < sizeof text - 1; i += 20)
        text[i] = '\n';
    for (int i = 0; i < CHIPS; i++) {
        link *l = plug(chips[i].chip, 115200, NULL);
        CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, true));
        run(l, 0.1);
        double start = l->now;
        send(l, text);
        run(l, 0.1);
        CHECK(l->refused > 100);
        CHECK_NEAR((20000 - 576) * 10 / 115200., l->now - start - 0.1, 0.06);
        CHECK_EQUAL(20000, fio_machine_count(l->machine)->bytes_in);
        unplug(l);
    }
}

/* Native USB: what has no room stays in the host. */
static void test_back_pressure_without_a_wire(void) {
    link *l = plug("cdc-acm", 0, NULL);
    CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, true));
    run(l, 0.1);
    l->length = 0;
    for (int i = 0; i < 100; i++)
        send(l, "G4 P5\n");
    run(l, 1);
    CHECK(l->refused > 0);
    CHECK_EQUAL(0, fio_machine_count(l->machine)->overruns);
    CHECK_EQUAL(100, fio_machine_count(l->machine)->oks);
    unplug(l);
}

/* Empty status packets come once in a latency period, 16 ms until the driver makes it 1. */
static void test_ftdi_status_packets(void) {
    for (int i = 3; i <= 4; i++) {
        link *l = plug(chips[i].chip, 115200, NULL);
        run(l, 0.16);
        CHECK(l->empty_packets >= 10 && l->empty_packets <= 11);
        CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, false));
        run(l, 0.2);
        l->empty_packets = 0;
        run(l, 0.1);
        CHECK(l->empty_packets >= 90 && l->empty_packets <= 101);
        uint8_t packet[512];
        l->now += 0.002;
        while (fio_virtual_usb_in(l->device, l->now, l->serial.in, packet, 512) >= 0)
            continue;
        CHECK_NEAR(l->now + 0.001, fio_virtual_usb_next(l->device), 1e-9);
        l->now = fio_virtual_usb_next(l->device);
        CHECK_EQUAL(2, fio_virtual_usb_in(l->device, l->now, l->serial.in, packet, 512));
        CHECK_EQUAL(0x01, packet[0]);
        CHECK_EQUAL(0x60, packet[1]);
        unplug(l);
    }
}

/* A full packet is followed by an empty one, but not on a CH340. */
static void test_empty_packets_end_transfers(void) {
    for (int i = 0; i < CHIPS; i++) {
        if (chips[i].packet == 512 || strcmp(chips[i].driver, "ftdi") == 0)
            continue;
        link *l = plug(chips[i].chip, 1000000, NULL);
        CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 1000000, true));
        l->now += 1;
        uint8_t packet[64];
        int size = 0, full = 0, empty = 0;
        for (int round = 0; round < 40; round++) { /* sooner or later an answer fills packets */
            char line[64];
            snprintf(line, sizeof line, "Q%.*s\n", round,
                     "........................................");
            send(l, line);
            l->now += 0.05;
            bool was_full = false;
            while ((size = fio_virtual_usb_in(l->device, l->now, l->serial.in, packet, 64)) >= 0) {
                CHECK(size <= chips[i].packet);
                CHECK(size > 0 || was_full);
                full += was_full = size == chips[i].packet;
                empty += size == 0;
            }
            CHECK(!was_full || chips[i].packet == 32);
        }
        CHECK(full > 0);
        CHECK(chips[i].packet == 32 ? empty == 0 : empty > 0);
        unplug(l);
    }
}

static int ask(link *l, uint8_t type, uint8_t code, uint16_t value, uint16_t index, uint8_t *data,
               uint16_t length) {
    const uint8_t setup[8] = {type,
                              code,
                              (uint8_t)value,
                              (uint8_t)(value >> 8),
                              (uint8_t)index,
                              (uint8_t)(index >> 8),
                              (uint8_t)length,
                              (uint8_t)(length >> 8)};
    return fio_virtual_usb_control(l->device, l->now, setup, data, length);
}

static void test_standard_requests(void) {
    const fio_virtual_usb_options options = {.vendor = 0x1d50, .product = 0x6029, .serial = "AB12"};
    link *l = plug("cdc-acm", 115200, &options);
    uint8_t data[256];
    size_t size = 0;
    const uint8_t *bytes = fio_virtual_usb_descriptors(l->device, &size);
    CHECK_EQUAL(18, ask(l, 0x80, 6, 0x0100, 0, data, 64));
    CHECK(memcmp(data, bytes, 18) == 0);
    CHECK_EQUAL(8, ask(l, 0x80, 6, 0x0100, 0, data, 8)); /* the first of all requests */
    CHECK_EQUAL(9, ask(l, 0x80, 6, 0x0200, 0, data, 9));
    CHECK_EQUAL((int)size - 18, ask(l, 0x80, 6, 0x0200, 0, data, 255));
    CHECK(memcmp(data, bytes + 18, size - 18) == 0);
    CHECK_EQUAL(FIO_USB_STALL, ask(l, 0x80, 6, 0x0201, 0, data, 255));
    CHECK_EQUAL(4, ask(l, 0x80, 6, 0x0300, 0, data, 255));
    CHECK(memcmp(data, "\x04\x03\x09\x04", 4) == 0);
    CHECK_EQUAL(10, ask(l, 0x80, 6, 0x0303, 0x0409, data, 255));
    CHECK(memcmp(data,
                 "\x0a\x03"
                 "A\0B\0"
                 "1\0"
                 "2\0",
                 10) == 0);
    CHECK_EQUAL(FIO_USB_STALL, ask(l, 0x80, 6, 0x0304, 0x0409, data, 255));
    CHECK_EQUAL(FIO_USB_STALL, ask(l, 0x80, 6, 0x0600, 0, data, 10)); /* full speed only */
    CHECK_EQUAL(0, ask(l, 0x00, 9, 1, 0, NULL, 0));
    CHECK_EQUAL(1, ask(l, 0x80, 8, 0, 0, data, 1));
    CHECK_EQUAL(1, data[0]);
    CHECK_EQUAL(FIO_USB_STALL, ask(l, 0x00, 9, 2, 0, NULL, 0));
    CHECK_EQUAL(2, ask(l, 0x80, 0, 0, 0, data, 2));
    CHECK_EQUAL(0, ask(l, 0x01, 11, 0, 1, NULL, 0));
    CHECK_EQUAL(FIO_USB_STALL, ask(l, 0x01, 11, 1, 1, NULL, 0));
    CHECK_EQUAL(0, ask(l, 0x02, 3, 0, 0x83, NULL, 0)); /* halt, look, and clear */
    CHECK_EQUAL(FIO_USB_STALL, fio_virtual_usb_in(l->device, l->now, 0x83, data, 64));
    CHECK_EQUAL(2, ask(l, 0x82, 0, 0, 0x83, data, 2));
    CHECK_EQUAL(1, data[0]);
    CHECK_EQUAL(0, ask(l, 0x02, 1, 0, 0x83, NULL, 0));
    CHECK(fio_virtual_usb_in(l->device, l->now, 0x83, data, 64) != FIO_USB_STALL);
    CHECK_EQUAL(FIO_USB_NAK, fio_virtual_usb_in(l->device, l->now, 0x81, data, 8));
    CHECK_EQUAL(FIO_USB_STALL, fio_virtual_usb_in(l->device, l->now, 0x84, data, 64));
    CHECK_EQUAL(FIO_USB_STALL, fio_virtual_usb_out(l->device, l->now, 0x03, data, 1));
    CHECK_EQUAL(FIO_USB_STALL, fio_virtual_usb_out(l->device, l->now, 0x02, data, 65));
    CHECK_EQUAL(FIO_USB_STALL, ask(l, 0xc0, 0x5f, 0, 0, data, 2)); /* another chip's */
    CHECK_EQUAL(FIO_USB_STALL, ask(l, 0x21, 0x20, 0, 0, data, 6));
    CHECK_EQUAL(0x1d50, l->found.vendor);
    unplug(l);
}

static void test_options(void) {
    fio_machine_options machine_options = fio_machine_options_defaults();
    fio_machine *machine = NULL;
    CHECK_EQUAL(FIO_OK, fio_machine_create(&machine, &machine_options));
    fio_virtual_usb *device = NULL;
    fio_virtual_usb_options options = {.chip = "ch9999"};
    CHECK_EQUAL(FIO_USAGE, fio_virtual_usb_create(&device, machine, &options));
    CHECK(!device && strstr(fio_error_message(), "ch9999"));
    options = (fio_virtual_usb_options){
        .chip = "ftdi",
        .serial = "0123456789012345678901234567890123456789012345678901234567890123"};
    CHECK_EQUAL(FIO_USAGE, fio_virtual_usb_create(&device, machine, &options));
    fio_machine_free(machine);
    options = (fio_virtual_usb_options){.no_union = true};
    link *l = plug("cdc-acm", 115200, &options);
    CHECK_EQUAL(-1, l->found.interfaces[0].union_data);
    CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, true));
    run(l, 0.1);
    CHECK(talk(l));
    unplug(l);
}

/* Whatever is asked, the answer fits what was asked for, and the device stays in one piece. */
static void test_requests_of_any_kind(void) {
    for (int i = 0; i < CHIPS; i++) {
        link *l = plug(chips[i].chip, 115200, NULL);
        uint64_t state = 88172645463325252u;
        for (int n = 0; n < 20000; n++) {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            static const uint8_t types[] = {0x80, 0x00, 0x02, 0x82, 0x21,
                                            0xa1, 0x40, 0xc0, 0x41, 0xc1};
            uint8_t type = types[state % 10],
                    code = (uint8_t)(state >> 8 & (state & 1 ? 0xff : 0x1f));
            uint16_t length = (uint16_t)(state >> 16 & 31);
            uint8_t *data = calloc(1, length + 1u);
            if (!data)
                abort();
            int moved = ask(l, type, code, (uint16_t)(state >> 24),
                            (uint16_t)(state >> 40 & 0x0101), data, length);
            CHECK(moved >= FIO_USB_STALL && moved <= length);
            free(data);
            l->now += 0.0001;
        }
        unplug(l);
    }
}

int main(void) {
    RUN(test_a_dialogue_with_every_chip_at_every_rate);
    RUN(test_a_wrong_rate_gives_rubbish);
    RUN(test_lines_rise_only_if_they_are_told_to);
    RUN(test_bridges_need_their_setup);
    RUN(test_back_pressure);
    RUN(test_back_pressure_without_a_wire);
    RUN(test_ftdi_status_packets);
    RUN(test_empty_packets_end_transfers);
    RUN(test_standard_requests);
    RUN(test_options);
    RUN(test_requests_of_any_kind);
    return check_verdict();
}
