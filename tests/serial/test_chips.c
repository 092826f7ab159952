/* Each driver against each chip of the virtual printer, over a direct link: what the driver tells
 * the chip comes out as the rate and the lines that were asked for, and the printer answers. */
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "serial/link.h"

static const struct {
    const char *chip, *driver;
    int packet;
} chips[] = {{"cdc-acm", "cdc-acm", 64}, {"ch340", "ch341", 32},     {"ch340-limited", "ch341", 32},
             {"ftdi", "ftdi", 64},       {"ftdi-h", "ftdi", 512},    {"cp2102", "cp210x", 64},
             {"pl2303hx", "pl2303", 64}, {"pl2303hxn", "pl2303", 64}};

enum { CHIPS = sizeof chips / sizeof *chips };

static void test_a_dialogue_with_every_chip_at_every_rate(void) {
    static const int64_t rates[] = {115200, 250000, 1000000, 57600, 500000};
    for (int i = 0; i < CHIPS; i++) {
        for (size_t k = 0; k < sizeof rates / sizeof *rates; k++) {
            usb_link *l = link_plug(chips[i].chip, rates[k], NULL);
            CHECK(strcmp(l->serial.driver->name, chips[i].driver) == 0);
            CHECK_EQUAL(chips[i].packet, l->serial.in_packet);
            CHECK_EQUAL(l->found.high_speed, fio_virtual_usb_high_speed(l->device));
            CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, rates[k], true));
            link_run(l, 0.1);
            if (!CHECK(strstr(l->text, "start") != NULL) || !CHECK(link_talk(l)))
                fprintf(stderr, "  %s at %lld: \"%s\"\n", chips[i].chip, (long long)rates[k],
                        l->text);
            CHECK_EQUAL(1, fio_machine_count(l->machine)->resets);
            CHECK_EQUAL(0, fio_machine_count(l->machine)->faults);
            CHECK_EQUAL(0, l->serial.line_errors);
            CHECK_EQUAL(FIO_OK, l->serial.driver->close(&l->serial));
            link_unplug(l);
        }
    }
}

/* The machine at another rate than it was asked for: nothing comes through. */
static void test_a_wrong_rate_gives_rubbish(void) {
    for (int i = 0; i < CHIPS; i++) {
        usb_link *l = link_plug(chips[i].chip, 250000, NULL);
        CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, true));
        link_run(l, 0.1);
        CHECK(!link_talk(l));
        CHECK_EQUAL(FIO_OK, l->serial.driver->set_rate(&l->serial, 250000));
        link_send(l, "\n"); /* ends the rubbish */
        link_run(l, 0.3);
        CHECK(link_talk(l));
        link_unplug(l);
    }
}

static void test_lines_rise_only_if_they_are_told_to(void) {
    for (int i = 0; i < CHIPS; i++) {
        usb_link *l = link_plug(chips[i].chip, 115200, NULL);
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
        link_unplug(l);
    }
}

/* A bridge that has not been set up passes nothing on. */
static void test_bridges_need_their_setup(void) {
    for (int i = 1; i < CHIPS; i++) {
        usb_link *l = link_plug(chips[i].chip, 9600, NULL);
        fio_virtual_usb_out(l->device, 0, l->serial.out, (const uint8_t *)"M115\n", 5);
        link_run(l, 0.2);
        CHECK_EQUAL(0, fio_machine_count(l->machine)->bytes_in);
        CHECK_EQUAL(0, (long long)l->length);
        link_unplug(l);
    }
}

/* At 115200 bits/s 20 kB take 1.7 s: the chip holds the host back instead of losing any. */
static void test_back_pressure(void) {
    static char text[20001];
    memset(text, ';', sizeof text - 1);
    for (size_t i = 19; i < sizeof text - 1; i += 20)
        text[i] = '\n';
    for (int i = 0; i < CHIPS; i++) {
        usb_link *l = link_plug(chips[i].chip, 115200, NULL);
        CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, true));
        link_run(l, 0.1);
        double start = l->now;
        link_send(l, text);
        link_run(l, 0.1);
        CHECK(l->refused > 100);
        CHECK_NEAR((20000 - 576) * 10 / 115200., l->now - start - 0.1, 0.06);
        CHECK_EQUAL(20000, fio_machine_count(l->machine)->bytes_in);
        link_unplug(l);
    }
}

/* Native USB: what has no room stays in the host. */
static void test_back_pressure_without_a_wire(void) {
    usb_link *l = link_plug("cdc-acm", 0, NULL);
    CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, true));
    link_run(l, 0.1);
    l->length = 0;
    for (int i = 0; i < 100; i++)
        link_send(l, "G4 P5\n");
    link_run(l, 1);
    CHECK(l->refused > 0);
    CHECK_EQUAL(0, fio_machine_count(l->machine)->overruns);
    CHECK_EQUAL(100, fio_machine_count(l->machine)->oks);
    link_unplug(l);
}

/* Empty status packets come once in a latency period of 16 ms; a line does not wait for its end. */
static void test_ftdi_status_packets(void) {
    for (int i = 3; i <= 4; i++) {
        usb_link *l = link_plug(chips[i].chip, 115200, NULL);
        link_run(l, 0.16);
        CHECK(l->empty_packets >= 10 && l->empty_packets <= 11);
        CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, false));
        link_run(l, 0.2);
        l->empty_packets = 0;
        link_run(l, 0.16);
        CHECK(l->empty_packets >= 9 && l->empty_packets <= 11);
        uint8_t packet[512];
        l->now += 0.002;
        while (fio_virtual_usb_in(l->device, l->now, l->serial.in, packet, 512) >= 0)
            continue;
        double due = fio_virtual_usb_next(l->device);
        CHECK(due > l->now && due <= l->now + 0.016);
        l->now = due;
        CHECK_EQUAL(2, fio_virtual_usb_in(l->device, l->now, l->serial.in, packet, 512));
        CHECK_EQUAL(0x01, packet[0]);
        CHECK_EQUAL(0x60, packet[1]);
        link_run(l, 1.5);
        for (int round = 0; round < 8; round++) { /* 40 bytes of a wire take 3.5 ms */
            double start = l->now;
            l->length = 0;
            link_send(l, "M105\n");
            while (l->length == 0 && l->now < start + 1)
                link_run(l, 0.0001);
            CHECK(l->now - start < 0.008);
            link_run(l, 0.0173);
        }
        link_unplug(l);
    }
}

/* A full packet is followed by an empty one, but not on a CH340. */
static void test_empty_packets_end_transfers(void) {
    for (int i = 0; i < CHIPS; i++) {
        if (chips[i].packet == 512 || strcmp(chips[i].driver, "ftdi") == 0)
            continue;
        usb_link *l = link_plug(chips[i].chip, 1000000, NULL);
        CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 1000000, true));
        l->now += 1;
        uint8_t packet[64];
        int size = 0, full = 0, empty = 0;
        for (int round = 0; round < 40; round++) { /* sooner or later an answer fills packets */
            char line[64];
            snprintf(line, sizeof line, "Q%.*s\n", round,
                     "........................................");
            link_send(l, line);
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
        link_unplug(l);
    }
}

static void test_standard_requests(void) {
    const fio_virtual_usb_options options = {.vendor = 0x1d50, .product = 0x6029, .serial = "AB12"};
    usb_link *l = link_plug("cdc-acm", 115200, &options);
    uint8_t data[256];
    size_t size = 0;
    const uint8_t *bytes = fio_virtual_usb_descriptors(l->device, &size);
    CHECK_EQUAL(18, link_ask(l, 0x80, 6, 0x0100, 0, data, 64));
    CHECK(memcmp(data, bytes, 18) == 0);
    CHECK_EQUAL(8, link_ask(l, 0x80, 6, 0x0100, 0, data, 8)); /* the first of all requests */
    CHECK_EQUAL(9, link_ask(l, 0x80, 6, 0x0200, 0, data, 9));
    CHECK_EQUAL((int)size - 18, link_ask(l, 0x80, 6, 0x0200, 0, data, 255));
    CHECK(memcmp(data, bytes + 18, size - 18) == 0);
    CHECK_EQUAL(FIO_USB_STALL, link_ask(l, 0x80, 6, 0x0201, 0, data, 255));
    CHECK_EQUAL(4, link_ask(l, 0x80, 6, 0x0300, 0, data, 255));
    CHECK(memcmp(data, "\x04\x03\x09\x04", 4) == 0);
    CHECK_EQUAL(10, link_ask(l, 0x80, 6, 0x0303, 0x0409, data, 255));
    CHECK(memcmp(data,
                 "\x0a\x03"
                 "A\0B\0"
                 "1\0"
                 "2\0",
                 10) == 0);
    CHECK_EQUAL(FIO_USB_STALL, link_ask(l, 0x80, 6, 0x0304, 0x0409, data, 255));
    CHECK_EQUAL(FIO_USB_STALL, link_ask(l, 0x80, 6, 0x0600, 0, data, 10)); /* full speed only */
    CHECK_EQUAL(0, link_ask(l, 0x00, 9, 1, 0, NULL, 0));
    CHECK_EQUAL(1, link_ask(l, 0x80, 8, 0, 0, data, 1));
    CHECK_EQUAL(1, data[0]);
    CHECK_EQUAL(FIO_USB_STALL, link_ask(l, 0x00, 9, 2, 0, NULL, 0));
    CHECK_EQUAL(2, link_ask(l, 0x80, 0, 0, 0, data, 2));
    CHECK_EQUAL(0, link_ask(l, 0x01, 11, 0, 1, NULL, 0));
    CHECK_EQUAL(FIO_USB_STALL, link_ask(l, 0x01, 11, 1, 1, NULL, 0));
    CHECK_EQUAL(0, link_ask(l, 0x02, 3, 0, 0x83, NULL, 0)); /* halt, look, and clear */
    CHECK_EQUAL(FIO_USB_STALL, fio_virtual_usb_in(l->device, l->now, 0x83, data, 64));
    CHECK_EQUAL(2, link_ask(l, 0x82, 0, 0, 0x83, data, 2));
    CHECK_EQUAL(1, data[0]);
    CHECK_EQUAL(0, link_ask(l, 0x02, 1, 0, 0x83, NULL, 0));
    CHECK(fio_virtual_usb_in(l->device, l->now, 0x83, data, 64) != FIO_USB_STALL);
    CHECK_EQUAL(FIO_USB_NAK, fio_virtual_usb_in(l->device, l->now, 0x81, data, 8));
    CHECK_EQUAL(FIO_USB_STALL, fio_virtual_usb_in(l->device, l->now, 0x84, data, 64));
    CHECK_EQUAL(FIO_USB_STALL, fio_virtual_usb_out(l->device, l->now, 0x03, data, 1));
    CHECK_EQUAL(FIO_USB_STALL, fio_virtual_usb_out(l->device, l->now, 0x02, data, 65));
    CHECK_EQUAL(FIO_USB_STALL, link_ask(l, 0xc0, 0x5f, 0, 0, data, 2)); /* another chip's */
    CHECK_EQUAL(FIO_USB_STALL, link_ask(l, 0x21, 0x20, 0, 0, data, 6));
    CHECK_EQUAL(0x1d50, l->found.vendor);
    link_unplug(l);
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
    usb_link *l = link_plug("cdc-acm", 115200, &options);
    CHECK_EQUAL(-1, l->found.interfaces[0].union_data);
    CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, 115200, true));
    link_run(l, 0.1);
    CHECK(link_talk(l));
    link_unplug(l);
}

static void test_a_pulled_plug(void) {
    fio_machine_options options = fio_machine_options_defaults();
    options.script = "at time 0.05 unplug for 0.1";
    fio_machine *machine = NULL;
    fio_virtual_usb *device = NULL;
    CHECK_EQUAL(FIO_OK, fio_machine_create(&machine, &options));
    CHECK_EQUAL(FIO_OK, fio_virtual_usb_create(&device, machine,
                                               &(fio_virtual_usb_options){.chip = "cp2102"}));
    static const uint8_t setup[8] = {0x80, 6, 0, 1, 0, 0, 18, 0},
                         configuration[8] = {0x80, 8, 0, 0, 0, 0, 1, 0},
                         configure[8] = {0x00, 9, 1, 0, 0, 0, 0, 0};
    uint8_t data[64];
    CHECK_EQUAL(0, fio_virtual_usb_control(device, 0.01, configure, data, 0));
    CHECK_EQUAL(1, fio_virtual_usb_control(device, 0.01, configuration, data, sizeof data));
    CHECK_EQUAL(1, data[0]);
    CHECK_EQUAL(18, fio_virtual_usb_control(device, 0.01, setup, data, sizeof data));
    CHECK_EQUAL(FIO_USB_GONE, fio_virtual_usb_control(device, 0.06, setup, data, sizeof data));
    CHECK_EQUAL(FIO_USB_GONE, fio_virtual_usb_in(device, 0.07, 0x81, data, sizeof data));
    CHECK_EQUAL(FIO_USB_GONE, fio_virtual_usb_out(device, 0.08, 0x01, data, 1));
    CHECK_EQUAL(18, fio_virtual_usb_control(device, 0.2, setup, data, sizeof data));
    CHECK_EQUAL(1, fio_virtual_usb_control(device, 0.2, configuration, data, sizeof data));
    CHECK_EQUAL(0, data[0]); /* it has forgotten all */
    fio_virtual_usb_free(device);
    fio_machine_free(machine);
}

static void test_no_memory(void) {
    fio_machine_options options = fio_machine_options_defaults();
    fio_machine *machine = NULL;
    fio_virtual_usb *device = NULL;
    CHECK_EQUAL(FIO_OK, fio_machine_create(&machine, &options));
    fio_fail_allocation_after(0);
    CHECK_EQUAL(FIO_NO_MEMORY, fio_virtual_usb_create(&device, machine,
                                                      &(fio_virtual_usb_options){.chip = "ftdi"}));
    fio_fail_allocation_after(-1);
    CHECK(!device);
    fio_machine_free(machine);
}

/* Whatever is asked, the answer fits what was asked for, and the device stays in one piece. */
static void test_requests_of_any_kind(void) {
    for (int i = 0; i < CHIPS; i++) {
        usb_link *l = link_plug(chips[i].chip, 115200, NULL);
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
            int moved = link_ask(l, type, code, (uint16_t)(state >> 24),
                                 (uint16_t)(state >> 40 & 0x0101), data, length);
            CHECK(moved >= FIO_USB_STALL && moved <= length);
            free(data);
            l->now += 0.0001;
        }
        link_unplug(l);
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
    RUN(test_a_pulled_plug);
    RUN(test_no_memory);
    RUN(test_requests_of_any_kind);
    return check_verdict();
}
