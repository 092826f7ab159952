/* Reading descriptors, and which driver they lead to. */
#include "serial/serial.h"

#include <stdlib.h>

#include "check.h"
#include "serial/devices.h"

static void test_reads_a_mega(void) {
    raw bytes = raw_mega();
    fio_usb_device device;
    CHECK(fio_usb_device_read(&device, bytes.bytes, bytes.size));
    CHECK_EQUAL(0x2341, device.vendor);
    CHECK_EQUAL(0x0042, device.product);
    CHECK_EQUAL(0x0001, device.release);
    CHECK_EQUAL(0x0110, device.version);
    CHECK_EQUAL(2, device.class_code);
    CHECK_EQUAL(8, device.control_packet);
    CHECK(!device.high_speed);
    CHECK_EQUAL(2, device.interface_count);
    CHECK_EQUAL(2, device.interfaces[0].class_code);
    CHECK_EQUAL(2, device.interfaces[0].subclass);
    CHECK_EQUAL(1, device.interfaces[0].protocol);
    CHECK_EQUAL(1, device.interfaces[0].union_data);
    CHECK_EQUAL(1, device.interfaces[0].endpoint_count);
    CHECK_EQUAL(-1, device.interfaces[1].union_data);
    CHECK_EQUAL(2, device.interfaces[1].endpoint_count);
    CHECK_EQUAL(0x83, device.interfaces[1].endpoints[1].address);
    CHECK_EQUAL(2, device.interfaces[1].endpoints[1].kind);
    CHECK_EQUAL(64, device.interfaces[1].endpoints[1].packet);
}

/* Bytes behind the first configuration are others', as sysfs has them, and don't count. */
static void test_only_the_first_configuration_counts(void) {
    raw bytes = raw_mega();
    raw_bytes(&bytes, (const uint8_t[]){9, 2, 18, 0, 1, 2, 0, 0x80, 50}, 9);
    raw_interface(&bytes, 0, 0, (const uint8_t[]){8, 6, 80});
    fio_usb_device device;
    CHECK(fio_usb_device_read(&device, bytes.bytes, bytes.size));
    CHECK_EQUAL(2, device.interface_count);
}

static void test_more_interfaces_and_endpoints_than_there_is_room_for(void) {
    raw bytes = raw_begin((raw_device){0x0200, 1, 2, 3, 0, 64});
    for (uint8_t i = 0; i < 20; i++) {
        raw_interface(&bytes, i, 0, (const uint8_t[]){0xff, 0, 0});
        raw_endpoint(&bytes, (uint8_t)(1 + i % 15), 2, 64);
    }
    raw_end(&bytes);
    fio_usb_device device;
    CHECK(fio_usb_device_read(&device, bytes.bytes, bytes.size));
    CHECK_EQUAL(FIO_USB_INTERFACES, device.interface_count);
    CHECK_EQUAL(1, device.interfaces[FIO_USB_INTERFACES - 1].endpoint_count);
    bytes = raw_begin((raw_device){0x0200, 1, 2, 3, 0, 64});
    raw_interface(&bytes, 0, 0, (const uint8_t[]){0xff, 0, 0});
    for (uint8_t i = 1; i < 12; i++)
        raw_endpoint(&bytes, i, 2, 64);
    raw_end(&bytes);
    CHECK(fio_usb_device_read(&device, bytes.bytes, bytes.size));
    CHECK_EQUAL(8, device.interfaces[0].endpoint_count);
}

static bool read_copy(fio_usb_device *device, const uint8_t *bytes, size_t size) {
    uint8_t *copy = malloc(size > 0 ? size : 1); /* so that a sanitizer sees each byte too far */
    if (!copy)
        abort();
    memcpy(copy, bytes, size);
    bool good = fio_usb_device_read(device, copy, size);
    free(copy);
    return good;
}

static void test_no_truncation_is_taken_for_whole(void) {
    raw bytes = raw_mega();
    fio_usb_device before, device;
    memset(&before, 0x5a, sizeof before);
    for (size_t size = 0; size < bytes.size; size++) {
        device = before;
        CHECK(!read_copy(&device, bytes.bytes, size));
        CHECK(memcmp(&before, &device, sizeof device) == 0);
    }
    CHECK(read_copy(&device, bytes.bytes, bytes.size));
}

/* Whatever one byte becomes, what is read stays within its bounds, and so does what is matched. */
static void test_every_mutation_of_a_byte(void) {
    raw bytes = raw_mega();
    long good = 0, matched = 0;
    for (size_t at = 0; at < bytes.size; at++) {
        uint8_t kept = bytes.bytes[at];
        for (int value = 0; value < 256; value++) {
            bytes.bytes[at] = (uint8_t)value;
            fio_usb_device device;
            if (!read_copy(&device, bytes.bytes, bytes.size))
                continue;
            good++;
            CHECK(device.interface_count >= 0 && device.interface_count <= FIO_USB_INTERFACES);
            fio_serial serial = {0};
            if (!fio_serial_match(&serial, &device))
                continue;
            matched++;
            CHECK(serial.interface_count >= 1 && serial.interface_count <= 2);
            CHECK((serial.in & 0x80) && !(serial.out & 0x80) && (serial.out & 15));
            CHECK(serial.in_packet >= 8 && serial.in_transfer >= serial.in_packet &&
                  serial.in_transfer % serial.in_packet == 0);
        }
        bytes.bytes[at] = kept;
    }
    CHECK(good > 0 && matched > 0 && matched < good);
}

static void test_damaged_descriptors_are_refused(void) {
    static const struct {
        size_t at;
        uint8_t value;
    } damages[] = {{0, 17}, {1, 2},  {18, 8}, {19, 1}, {20, 8}, {20, 200},
                   {27, 0}, {27, 1}, {27, 8}, {36, 2}, {50, 6}};
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
        raw bytes = raw_mega();
        bytes.bytes[damages[i].at] = damages[i].value;
        fio_usb_device device;
        CHECK(!fio_usb_device_read(&device, bytes.bytes, bytes.size));
    }
    raw bytes = raw_begin((raw_device){0x0200, 1, 2, 3, 0, 64});
    raw_endpoint(&bytes, 0x81, 2, 64); /* of no interface */
    raw_end(&bytes);
    fio_usb_device device;
    CHECK(!fio_usb_device_read(&device, bytes.bytes, bytes.size));
}

static bool match_raw(fio_serial *serial, raw *bytes) {
    fio_usb_device device;
    *serial = (fio_serial){0};
    return fio_usb_device_read(&device, bytes->bytes, bytes->size) &&
           fio_serial_match(serial, &device);
}

static void test_cdc_by_its_union_descriptor(void) {
    raw bytes = raw_begin((raw_device){0x0200, 0x1234, 0x5678, 1, 0xef, 64});
    raw_interface(&bytes, 0, 0, (const uint8_t[]){8, 6, 80}); /* a disk comes first */
    raw_endpoint(&bytes, 0x05, 2, 64);
    raw_endpoint(&bytes, 0x85, 2, 64);
    raw_bytes(&bytes, (const uint8_t[]){8, 11, 1, 2, 2, 2, 1, 0}, 8);
    raw_interface(&bytes, 1, 0, (const uint8_t[]){2, 2, 1});
    raw_bytes(&bytes, (const uint8_t[]){5, 0x24, 6, 1, 4}, 5);
    raw_endpoint(&bytes, 0x81, 3, 8);
    raw_interface(&bytes, 2, 0, (const uint8_t[]){10, 0, 0}); /* another's */
    raw_endpoint(&bytes, 0x06, 2, 64);
    raw_endpoint(&bytes, 0x86, 2, 64);
    raw_interface(&bytes, 4, 0, (const uint8_t[]){10, 0, 0});
    raw_endpoint(&bytes, 0x02, 2, 512);
    raw_endpoint(&bytes, 0x83, 2, 512);
    raw_end(&bytes);
    fio_serial serial;
    CHECK(match_raw(&serial, &bytes));
    CHECK(strcmp(serial.driver->name, "cdc-acm") == 0);
    CHECK_EQUAL(2, serial.interface_count);
    CHECK_EQUAL(1, serial.interfaces[0]);
    CHECK_EQUAL(4, serial.interfaces[1]);
    CHECK_EQUAL(0x83, serial.in);
    CHECK_EQUAL(0x02, serial.out);
    CHECK_EQUAL(512, serial.in_packet);
    CHECK_EQUAL(512, serial.in_transfer);
    CHECK(serial.driver->wants_empty_packet);
}

static raw cdc_pair(uint8_t control, uint8_t data, const uint8_t *extra, size_t size) {
    raw bytes = raw_begin((raw_device){0x0200, 0x0483, 0x5740, 0x0200, 2, 64});
    for (int i = 0; i < 2; i++) {
        if ((control < data) == (i == 0)) {
            raw_interface(&bytes, control, 0, (const uint8_t[]){2, 2, 0});
            raw_bytes(&bytes, extra, size);
            raw_endpoint(&bytes, 0x82, 3, 8);
        } else {
            raw_interface(&bytes, data, 0, (const uint8_t[]){10, 0, 0});
            raw_endpoint(&bytes, 0x01, 2, 64);
            raw_endpoint(&bytes, 0x81, 2, 64);
        }
    }
    raw_end(&bytes);
    return bytes;
}

static void test_cdc_without_a_union_descriptor_or_with_a_wrong_one(void) {
    static const uint8_t none[1], absent[] = {5, 0x24, 6, 0, 9}, itself[] = {5, 0x24, 6, 0, 0},
                                  cut[] = {4, 0x24, 6, 0};
    static const struct {
        const uint8_t *bytes;
        size_t size;
    } unions[] = {{none, 0}, {absent, 5}, {itself, 5}, {cut, 4}};
    for (size_t i = 0; i < sizeof unions / sizeof *unions; i++) {
        fio_serial serial;
        raw bytes = cdc_pair(0, 1, unions[i].bytes, unions[i].size);
        CHECK(match_raw(&serial, &bytes));
        CHECK_EQUAL(0, serial.interfaces[0]);
        CHECK_EQUAL(1, serial.interfaces[1]);
        bytes = cdc_pair(3, 2, unions[i].bytes, unions[i].size); /* the data before the control */
        CHECK(match_raw(&serial, &bytes));
        CHECK_EQUAL(3, serial.interfaces[0]);
        CHECK_EQUAL(2, serial.interfaces[1]);
        bytes = cdc_pair(0, 5, unions[i].bytes, unions[i].size); /* no neighbour */
        CHECK(!match_raw(&serial, &bytes));
    }
}

static void test_cdc_all_in_one_interface(void) {
    raw bytes = raw_begin((raw_device){0x0200, 0x1234, 0x5678, 1, 0, 64});
    raw_interface(&bytes, 0, 0, (const uint8_t[]){2, 2, 1});
    raw_endpoint(&bytes, 0x81, 3, 8);
    raw_endpoint(&bytes, 0x02, 2, 64);
    raw_endpoint(&bytes, 0x83, 2, 64);
    raw_end(&bytes);
    fio_serial serial;
    CHECK(match_raw(&serial, &bytes));
    CHECK_EQUAL(1, serial.interface_count);
    CHECK_EQUAL(0x83, serial.in);
}

/* What only looks like a serial port. */
static void test_what_is_no_serial_port(void) {
    static const uint8_t classes[][3] = {
        {0xff, 2, 1}, /* a vendor's class with ACM's subclass */
        {2, 2, 0xff}, /* RNDIS, a network adapter */
        {2, 6, 0},    /* Ethernet */
        {2, 0x0d, 0}, /* NCM */
        {10, 0, 0},   /* data alone */
        {3, 0, 0},    /* HID */
        {0xe0, 1, 3}, /* RNDIS again */
    };
    for (size_t i = 0; i < sizeof classes / sizeof *classes; i++) {
        raw bytes = raw_begin((raw_device){0x0200, 0x1234, 0x5678, 1, 0, 64});
        raw_interface(&bytes, 0, 0, classes[i]);
        raw_bytes(&bytes, (const uint8_t[]){5, 0x24, 6, 0, 1}, 5);
        raw_endpoint(&bytes, 0x82, 3, 8);
        raw_interface(&bytes, 1, 0, (const uint8_t[]){10, 0, 0});
        raw_endpoint(&bytes, 0x04, 2, 64);
        raw_endpoint(&bytes, 0x83, 2, 64);
        raw_end(&bytes);
        fio_serial serial;
        CHECK(!match_raw(&serial, &bytes));
    }
    raw bytes = raw_mega(); /* no data class */
    bytes.bytes[18 + 9 + 9 + 5 + 4 + 5 + 7 + 5] = 0xff;
    fio_serial serial;
    CHECK(!match_raw(&serial, &bytes));
    bytes = raw_begin((raw_device){0x0200, 0x1a86, 0x7523, 1, 0, 64}); /* no bulk endpoints */
    raw_interface(&bytes, 0, 0, (const uint8_t[]){0xff, 0, 0});
    raw_endpoint(&bytes, 0x81, 3, 8);
    raw_end(&bytes);
    CHECK(!match_raw(&serial, &bytes));
}

static void test_bridges_by_their_ids(void) {
    static const struct {
        uint16_t vendor, product;
        const char *driver, *board;
        bool certain;
    } devices[] = {
        {0x1a86, 0x7523, "ch341", "CH340", false},
        {0x1a86, 0x5523, "ch341", "CH341A", false},
        {0x0403, 0x6001, "ftdi", "FT232R", false},
        {0x0403, 0x6015, "ftdi", "FT231X", false},
        {0x10c4, 0xea60, "cp210x", "CP2102", false},
        {0x067b, 0x2303, "pl2303", "PL2303", false},
        {0x067b, 0x23a3, "pl2303", "PL2303GC", false},
        {0x2341, 0x0042, NULL, "Arduino Mega 2560 R3", true},
        {0x2c99, 0x0001, NULL, "Prusa i3 MK2", true},
        {0x0483, 0x5740, NULL, "STM32 virtual COM port", false},
        {0x1234, 0x5678, NULL, NULL, false},
    };
    for (size_t i = 0; i < sizeof devices / sizeof *devices; i++) {
        raw bytes = raw_bridge(
            (raw_device){0x0200, devices[i].vendor, devices[i].product, 0x0600, 0, 64}, 64);
        fio_serial serial;
        bool matched = match_raw(&serial, &bytes), certain = !devices[i].certain;
        CHECK_EQUAL(devices[i].driver != NULL, matched);
        if (matched && devices[i].driver) {
            CHECK(strcmp(devices[i].driver, serial.driver->name) == 0);
            CHECK_EQUAL(1, serial.interface_count);
            CHECK_EQUAL(0x83, serial.in);
            CHECK_EQUAL(0x02, serial.out);
        }
        const char *board = fio_serial_board(devices[i].vendor, devices[i].product, &certain);
        CHECK(devices[i].board ? board && strcmp(devices[i].board, board) == 0 : !board);
        CHECK_EQUAL(devices[i].certain, certain);
    }
}

static void test_a_packet_size_of_zero_is_a_clones_mistake(void) {
    raw bytes = raw_bridge((raw_device){0x0200, 0x0403, 0x6001, 0x0600, 0, 8}, 0);
    fio_serial serial;
    CHECK(match_raw(&serial, &bytes));
    CHECK_EQUAL(64, serial.in_packet);
    CHECK_EQUAL(64, serial.out_packet);
}

/* A full packet must not wait for the next one, which may never come. */
static void test_reading_packet_by_packet(void) {
    static const struct {
        raw_device id;
        uint16_t packet, transfer;
    } devices[] = {{{0x0110, 0x1a86, 0x7523, 0x0264, 0xff, 8}, 32, 32},
                   {{0x0110, 0x10c4, 0xea60, 0x0100, 0, 64}, 64, 64},
                   {{0x0200, 0x067b, 0x2303, 0x0400, 0, 64}, 64, 64},
                   {{0x0200, 0x0403, 0x6001, 0x0600, 0, 8}, 64, 512}, /* status ends it */
                   {{0x0200, 0x0403, 0x6014, 0x0900, 0, 64}, 512, 512}};
    for (size_t i = 0; i < sizeof devices / sizeof *devices; i++) {
        raw bytes = raw_bridge(devices[i].id, devices[i].packet);
        fio_serial serial;
        CHECK(match_raw(&serial, &bytes));
        CHECK_EQUAL(devices[i].packet, serial.in_packet);
        CHECK_EQUAL(devices[i].transfer, serial.in_transfer);
    }
    raw bytes = raw_mega();
    fio_serial serial;
    CHECK(match_raw(&serial, &bytes));
    CHECK_EQUAL(64, serial.in_transfer);
}

int main(void) {
    RUN(test_reads_a_mega);
    RUN(test_only_the_first_configuration_counts);
    RUN(test_more_interfaces_and_endpoints_than_there_is_room_for);
    RUN(test_no_truncation_is_taken_for_whole);
    RUN(test_every_mutation_of_a_byte);
    RUN(test_damaged_descriptors_are_refused);
    RUN(test_cdc_by_its_union_descriptor);
    RUN(test_cdc_without_a_union_descriptor_or_with_a_wrong_one);
    RUN(test_cdc_all_in_one_interface);
    RUN(test_what_is_no_serial_port);
    RUN(test_bridges_by_their_ids);
    RUN(test_a_packet_size_of_zero_is_a_clones_mistake);
    RUN(test_reading_packet_by_packet);
    return check_verdict();
}
