/* What each driver tells its bridge, against what Linux' own drivers (6.1) were seen to send to
 * devices of the same kind, at 115200 and at 250000 bits/s.
 *
 * Ours send fewer requests: Linux sets 9600 first when a device is found, and the lines once more
 * with every rate; it reads modem lines and line settings that are of no use to us. Where else we
 * differ, the table says why. All but what is marked stands in Linux' trace, in this order. */
#include "serial/serial.h"

#include "check.h"
#include "serial/devices.h"

#define COUNT(table) ((int)(sizeof(table) / sizeof *(table)))

static fio_serial plug(recorder *device, raw_device id, uint16_t packet) {
    raw bytes = raw_bridge(id, packet);
    fio_usb_device found;
    fio_serial serial = {.control = recorder_control(device)};
    CHECK(fio_usb_device_read(&found, bytes.bytes, bytes.size));
    CHECK(fio_serial_match(&serial, &found));
    return serial;
}

static const raw_device ch340 = {0x0110, 0x1a86, 0x7523, 0x0264, 0xff, 8},
                        ft232r = {0x0200, 0x0403, 0x6001, 0x0600, 0, 8},
                        cp2102 = {0x0110, 0x10c4, 0xea60, 0x0100, 0, 64},
                        pl2303hxn = {0x0200, 0x067b, 0x2303, 0x0400, 0, 64};

static void test_ch340(void) {
    static const answer answers[] = {{0xc0, 0x5f, 0, false, 2, {0x31, 0}},
                                     {0xc0, 0x95, 0x0005, false, 2, {0, 0}}};
    recorder device = {.answers = answers, .answer_count = 2, .fail_at = -1};
    fio_serial serial = plug(&device, ch340, 32);
    CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, true));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0xc0, 0x5f, 0, 0, 2, {0}},
                            {0x40, 0xa1, 0, 0, 0, {0}},
                            {0xc0, 0x95, 0x0005, 0, 2, {0}},
                            {0x40, 0x9a, 0x1312, 0xcc83, 0, {0}},
                            {0x40, 0x9a, 0x2518, 0x00c3, 0, {0}},
                            {0x40, 0xa4, 0xff9f, 0, 0, {0}},
                        }));
    CHECK_EQUAL(FIO_OK, serial.driver->set_rate(&serial, 250000));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0x40, 0x9a, 0x1312, 0xe883, 0, {0}},
                            {0x40, 0x9a, 0x2518, 0x00c3, 0, {0}},
                        }));
    CHECK_EQUAL(FIO_OK, serial.driver->set_rate(&serial, 9600));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0x40, 0x9a, 0x1312, 0xb282, 0, {0}},
                            {0x40, 0x9a, 0x2518, 0x00c3, 0, {0}},
                        }));
    CHECK_EQUAL(9600, serial.rate);
    CHECK_EQUAL(FIO_OK, serial.driver->set_lines(&serial, true, false));
    CHECK_EQUAL(FIO_OK, serial.driver->set_lines(&serial, false, true));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0x40, 0xa4, 0xffdf, 0, 0, {0}},
                            {0x40, 0xa4, 0xffbf, 0, 0, {0}},
                        }));
    CHECK_EQUAL(FIO_OK, serial.driver->close(&serial));
    CHECK_SEEN(&device, ((const seen_request[]){{0x40, 0xa4, 0xffff, 0, 0, {0}}}));
}

/* Linux drops the half step (fact, bit 2) of the slower prescalers where the break register stalls.
 * Chips before 0x30 have no line control register, and those up to 0x27 the bit against buffering
 * (0x80) the other way round. */
static void test_ch340_clones(void) {
    static const answer limited[] = {{0xc0, 0x5f, 0, false, 2, {0x31, 0}},
                                     {0xc0, 0x95, 0x0005, true, 0, {0}}};
    recorder device = {.answers = limited, .answer_count = 2, .fail_at = -1};
    fio_serial serial = plug(&device, ch340, 32);
    CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, false));
    CHECK_EQUAL(5, device.count);
    CHECK_EQUAL(0xcc83, device.seen[3].index);
    device.count = 0;
    static const int rates[] = {300, 600, 1200, 2400, 4800, 9600, 19200};
    for (int i = 0; i < COUNT(rates); i++) {
        CHECK_EQUAL(FIO_OK, serial.driver->set_rate(&serial, rates[i]));
        CHECK((device.seen[0].index & 4) == 0);
        device.count = 0;
    }
    static const answer old[] = {{0xc0, 0x5f, 0, false, 2, {0x27, 0}}};
    device = (recorder){.answers = old, .answer_count = 1, .fail_at = -1};
    serial = plug(&device, ch340, 32);
    CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, false));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0xc0, 0x5f, 0, 0, 2, {0}},
                            {0x40, 0xa1, 0, 0, 0, {0}},
                            {0xc0, 0x95, 0x0005, 0, 2, {0}},
                            {0x40, 0x9a, 0x1312, 0xcc03, 0, {0}},
                        }));
}

static void test_ft232r(void) {
    recorder device = {.fail_at = -1};
    fio_serial serial = plug(&device, ft232r, 64);
    CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, true));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0x40, 0, 0, 0, 0, {0}},
                            {0x40, 9, 0x0010, 0, 0, {0}},
                            {0x40, 6, 0x010a, 0, 0, {0}}, /* Linux does not; each answer of the
                                                           * printer would come up to 16 ms later */
                            {0x40, 4, 0x0008, 0, 0, {0}},
                            {0x40, 3, 0x001a, 0, 0, {0}},
                            {0x40, 2, 0x0000, 0, 0, {0}},
                            {0x40, 1, 0x0303, 0, 0, {0}},
                        }));
    CHECK_EQUAL(FIO_OK, serial.driver->set_rate(&serial, 250000));
    CHECK_EQUAL(FIO_OK, serial.driver->set_rate(&serial, 9600));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0x40, 3, 0x000c, 0, 0, {0}},
                            {0x40, 3, 0x4138, 0, 0, {0}},
                        }));
    CHECK_EQUAL(FIO_OK, serial.driver->set_lines(&serial, true, false));
    CHECK_EQUAL(FIO_OK, serial.driver->close(&serial));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0x40, 1, 0x0301, 0, 0, {0}}, /* the high byte: which ones change */
                            {0x40, 1, 0x0300, 0, 0, {0}},
                        }));
}

static void test_cp2102(void) {
    static const answer answers[] = {{0xc0, 0xff, 0x370b, false, 1, {2}}};
    recorder device = {.answers = answers, .answer_count = 1, .fail_at = -1};
    fio_serial serial = plug(&device, cp2102, 64);
    CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, true));
    /* as Linux opens it for the second time; the characters are from the first */
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0xc0, 0xff, 0x370b, 0, 1, {0}},
                            {0x41, 0x00, 1, 0, 0, {0}},
                            {0x41, 0x1e, 0, 0, 4, {0x00, 0xc2, 0x01, 0x00}},
                            {0x41, 0x03, 0x0800, 0, 0, {0}},
                            {0x41, 0x19, 0, 0, 6, {0, 0, 0, 0, 0x11, 0x13}},
                            {0x41, 0x13, 0, 0, 16, {1, 0, 0, 0, 0x40}},
                            {0x41, 0x07, 0x0303, 0, 0, {0}},
                        }));
    CHECK_EQUAL(FIO_OK, serial.driver->set_rate(&serial, 250000));
    CHECK_SEEN(&device, ((const seen_request[]){{0x41, 0x1e, 0, 0, 4, {0x90, 0xd0, 0x03, 0x00}}}));
    CHECK_EQUAL(FIO_OK, serial.driver->close(&serial));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0x41, 0x07, 0x0300, 0, 0, {0}}, /* Linux' does it with HUPCL only */
                            {0x41, 0x12, 0x000f, 0, 0, {0}},
                            {0x41, 0x00, 0x0000, 0, 0, {0}},
                        }));
}

/* Flow control drives the lines too: it is told what they are. */
static void test_cp2102_with_its_lines_kept(void) {
    for (int lines = 0; lines < 4; lines++) {
        const answer answers[] = {{0xc0, 0xff, 0x370b, false, 1, {2}},
                                  {0xc1, 0x08, 0, false, 1, {(uint8_t)(0xb0 | lines)}}};
        recorder device = {.answers = answers, .answer_count = 2, .fail_at = -1};
        fio_serial serial = plug(&device, cp2102, 64);
        CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, false));
        CHECK_EQUAL(7, device.count);
        CHECK_EQUAL(0x08, device.seen[5].request);
        CHECK_EQUAL(0x13, device.seen[6].request);
        CHECK_EQUAL(lines & 1, device.seen[6].data[0]);
        CHECK_EQUAL((lines & 2) << 5, device.seen[6].data[4]);
        device.count = 0;
        CHECK_EQUAL(FIO_OK, serial.driver->close(&serial));
        CHECK_EQUAL(2, device.count);
        CHECK_EQUAL(0x12, device.seen[0].request);
    }
}

static void test_pl2303hxn(void) {
    recorder device = {.fail_at = -1};
    fio_serial serial = plug(&device, pl2303hxn, 64);
    CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, true));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0x40, 0x80, 0x0007, 0x0003, 0, {0}},
                            {0x21, 0x20, 0, 0, 7, {0x00, 0xc2, 0x01, 0x00, 0, 0, 8}},
                            {0xc0, 0x81, 0x000a, 0, 1, {0}},
                            {0x40, 0x80, 0x000a, 0x001c, 0, {0}},
                            {0x21, 0x22, 0x0003, 0, 0, {0}},
                        }));
    CHECK_EQUAL(FIO_OK, serial.driver->set_rate(&serial, 250000));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0x21, 0x20, 0, 0, 7, {0x90, 0xd0, 0x03, 0x00, 0, 0, 8}},
                        }));
    CHECK_EQUAL(FIO_OK, serial.driver->close(&serial));
    CHECK_SEEN(&device, ((const seen_request[]){{0x21, 0x22, 0x0000, 0, 0, {0}}}));
}

/* Not in the traces, but in Linux' source: what the older generations are told at first. */
static void test_pl2303_of_older_generations(void) {
    static const struct {
        raw_device id;
        uint16_t last; /* of the dance */
        bool asked, pipes;
    } kinds[] = {
        {{0x0110, 0x067b, 0x2303, 0x0300, 0, 64}, 0x44, false, true},  /* HX */
        {{0x0110, 0x067b, 0x2303, 0x0400, 0, 64}, 0x44, false, true},  /* HXD */
        {{0x0110, 0x067b, 0x2303, 0x0202, 0, 8}, 0x24, false, false},  /* H */
        {{0x0110, 0x067b, 0x2303, 0x0300, 2, 64}, 0x24, false, false}, /* H */
        {{0x0200, 0x067b, 0x2303, 0x0300, 0, 64}, 0x44, true, true},   /* TA */
        {{0x0200, 0x067b, 0x2303, 0x0500, 0, 64}, 0x44, true, true},   /* TB */
    };
    static const seen_request dance[] = {{0xc0, 1, 0x8484, 0, 1, {0}}, {0x40, 1, 0x0404, 0, 0, {0}},
                                         {0xc0, 1, 0x8484, 0, 1, {0}}, {0xc0, 1, 0x8383, 0, 1, {0}},
                                         {0xc0, 1, 0x8484, 0, 1, {0}}, {0x40, 1, 0x0404, 1, 0, {0}},
                                         {0xc0, 1, 0x8484, 0, 1, {0}}, {0xc0, 1, 0x8383, 0, 1, {0}},
                                         {0x40, 1, 0, 1, 0, {0}},      {0x40, 1, 1, 0, 0, {0}}};
    for (int i = 0; i < COUNT(kinds); i++) {
        seen_request expected[20];
        int n = 0;
        if (kinds[i].asked)
            expected[n++] = (seen_request){0xc0, 1, 0x8080, 0, 1, {0}};
        memcpy(expected + n, dance, sizeof dance);
        n += COUNT(dance);
        expected[n++] = (seen_request){0x40, 1, 2, kinds[i].last, 0, {0}};
        if (kinds[i].pipes) {
            expected[n++] = (seen_request){0x40, 1, 8, 0, 0, {0}};
            expected[n++] = (seen_request){0x40, 1, 9, 0, 0, {0}};
        }
        expected[n++] = (seen_request){0x21, 0x20, 0, 0, 7, {0x00, 0xc2, 0x01, 0x00, 0, 0, 8}};
        expected[n++] = (seen_request){0x40, 1, 0, 0, 0, {0}};
        expected[n++] = (seen_request){0x21, 0x22, 3, 0, 0, {0}};
        recorder device = {.fail_at = -1};
        fio_serial serial = plug(&device, kinds[i].id, 64);
        CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, true));
        check_seen(&device, expected, n, __FILE__, __LINE__);
    }
}

/* The same release as a TA, but it does not know the register of the old ones. */
static void test_pl2303gt_is_told_from_a_ta(void) {
    static const answer stalls[] = {{0xc0, 1, 0x8080, true, 0, {0}}};
    recorder device = {.answers = stalls, .answer_count = 1, .fail_at = -1};
    fio_serial serial = plug(&device, (raw_device){0x0200, 0x067b, 0x23c3, 0x0300, 0, 64}, 64);
    CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, false));
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0xc0, 1, 0x8080, 0, 1, {0}},
                            {0x40, 0x80, 0x0007, 0x0003, 0, {0}},
                            {0x21, 0x20, 0, 0, 7, {0x00, 0xc2, 0x01, 0x00, 0, 0, 8}},
                            {0xc0, 0x81, 0x000a, 0, 1, {0}},
                            {0x40, 0x80, 0x000a, 0x001c, 0, {0}},
                        }));
}

static fio_serial plug_cdc(recorder *device) {
    raw bytes = raw_mega();
    fio_usb_device found;
    fio_serial serial = {.control = recorder_control(device)};
    CHECK(fio_usb_device_read(&found, bytes.bytes, bytes.size));
    CHECK(fio_serial_match(&serial, &found));
    return serial;
}

/* By the class's own specification (PSTN120, 6.3.10 to 6.3.12). */
static void test_cdc(void) {
    recorder device = {.fail_at = -1};
    fio_serial serial = plug_cdc(&device);
    CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, true));
    CHECK_EQUAL(FIO_OK, serial.driver->set_rate(&serial, 250000));
    CHECK_EQUAL(FIO_OK, serial.driver->set_lines(&serial, true, false));
    CHECK_EQUAL(FIO_OK, serial.driver->close(&serial));
    CHECK_EQUAL(FIO_OK, serial.driver->close(&serial)); /* nothing is raised any more */
    CHECK_SEEN(&device, ((const seen_request[]){
                            {0x21, 0x20, 0, 0, 7, {0x00, 0xc2, 0x01, 0x00, 0, 0, 8}},
                            {0x21, 0x22, 3, 0, 0, {0}},
                            {0x21, 0x20, 0, 0, 7, {0x90, 0xd0, 0x03, 0x00, 0, 0, 8}},
                            {0x21, 0x22, 1, 0, 0, {0}},
                            {0x21, 0x22, 0, 0, 0, {0}},
                        }));
}

static void test_cdc_may_refuse_what_only_a_wire_needs(void) {
    static const answer stalls[] = {{0x21, 0x20, 0, true, 0, {0}}, {0x21, 0x22, 3, true, 0, {0}}};
    recorder device = {.answers = stalls, .answer_count = 2, .fail_at = -1};
    fio_serial serial = plug_cdc(&device);
    CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, true));
    CHECK_EQUAL(2, device.count);
}

/* Each request lost, or stalled, in turn: the driver says so at once and sends nothing more. */
static void test_failures_of_every_request(void) {
    static const raw_device ids[] = {
        {0x0110, 0x1a86, 0x7523, 0x0264, 0xff, 8}, {0x0200, 0x0403, 0x6001, 0x0600, 0, 8},
        {0x0110, 0x10c4, 0xea60, 0x0100, 0, 64},   {0x0200, 0x067b, 0x2303, 0x0400, 0, 64},
        {0x0110, 0x067b, 0x2303, 0x0300, 0, 64},   {0x0200, 0x067b, 0x2303, 0x0300, 0, 64}};
    for (int i = 0; i < COUNT(ids); i++) {
        recorder device = {.fail_at = -1};
        fio_serial serial = plug(&device, ids[i], 64);
        CHECK_EQUAL(FIO_OK, serial.driver->open(&serial, 115200, true));
        int all = device.count;
        seen_request seen[SEEN_MOST];
        memcpy(seen, device.seen, sizeof seen);
        CHECK(all >= 5);
        for (int k = 0; k < all; k++) {
            device = (recorder){.fail_at = k};
            serial = plug(&device, ids[i], 64);
            CHECK_EQUAL(FIO_LINK_LOST, serial.driver->open(&serial, 115200, true));
            CHECK_EQUAL(k, device.count);
            if (seen[k].type & 0x80)
                continue;
            const answer stall = {seen[k].type, seen[k].request, seen[k].value, true, 0, {0}};
            device = (recorder){.answers = &stall, .answer_count = 1, .fail_at = -1};
            serial = plug(&device, ids[i], 64);
            CHECK_EQUAL(FIO_NO_PRINTER, serial.driver->open(&serial, 115200, true));
            CHECK(device.count <= k + 1);
            CHECK(strstr(fio_error_message(), serial.driver->name) != NULL);
        }
    }
}

int main(void) {
    RUN(test_ch340);
    RUN(test_ch340_clones);
    RUN(test_ft232r);
    RUN(test_cp2102);
    RUN(test_cp2102_with_its_lines_kept);
    RUN(test_pl2303hxn);
    RUN(test_pl2303_of_older_generations);
    RUN(test_pl2303gt_is_told_from_a_ta);
    RUN(test_cdc);
    RUN(test_cdc_may_refuse_what_only_a_wire_needs);
    RUN(test_failures_of_every_request);
    return check_verdict();
}
