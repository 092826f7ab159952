/* Bulk transfers against a libusb that the test plays: every end that a transfer can come to. */
#include "check.h"

#include "fake_libusb.h"

#include "transport/descriptor.h"
#include "usb/transfers.h"

#include <stdlib.h>

enum { IN = 0x83, OUT = 0x02 };

typedef struct rig {
    fio_usb_transfers *transfers;
    fio_serial serial;
    fio_serial_driver driver;
    fio_usb_events events;
} rig;

/* Of each packet the first byte is none of ours. */
static size_t strip_one(fio_serial *serial, uint8_t *bytes, size_t size) {
    size_t kept = 0;
    for (size_t at = 0; at < size; at += serial->in_packet)
        for (size_t i = at + 1; i < size && i < at + serial->in_packet; i++)
            bytes[kept++] = bytes[i];
    return kept;
}

static void begin(rig *r, bool wrapped) {
    fake_begin();
    *r = (rig){.transfers = calloc(1, sizeof *r->transfers),
               .driver = {.name = "test", .wants_empty_packet = !wrapped},
               .events.clocked = true};
    r->driver.unwrap = wrapped ? strip_one : NULL;
    r->serial = (fio_serial){.driver = &r->driver,
                             .in = IN,
                             .out = OUT,
                             .in_packet = 64,
                             .out_packet = 64,
                             .in_transfer = 512};
    CHECK_EQUAL(FIO_OK, fio_usb_transfers_begin(r->transfers, NULL, &r->serial));
    fio_usb_transfers_service(r->transfers);
}

static void end(rig *r) {
    fio_usb_transfers_end(r->transfers);
    free(r->transfers);
}

static void several_wait_for_data(void) {
    rig r;
    begin(&r, false);
    CHECK_EQUAL(FIO_USB_IN_COUNT, fake_count(IN));
    for (int i = 0; i < FIO_USB_IN_COUNT; i++)
        CHECK_EQUAL(0, fake_flying(IN, i)->length % 64);
    CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_COMPLETED, 3, "ok "));
    CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_COMPLETED, 0, NULL));
    CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_COMPLETED, 5, "T:20\n"));
    CHECK_EQUAL(FIO_USB_IN_COUNT - 3, fake_count(IN));
    fio_usb_transfers_service(r.transfers);
    CHECK_EQUAL(FIO_USB_IN_COUNT, fake_count(IN));
    char text[16] = "";
    CHECK_EQUAL(8, fio_usb_transfers_read(r.transfers, text, sizeof text));
    CHECK(strcmp(text, "ok T:20\n") == 0);
    CHECK_EQUAL(0, fio_usb_transfers_read(r.transfers, text, sizeof text));
    end(&r);
}

static void wrapping_is_taken_off(void) {
    rig r;
    begin(&r, true);
    uint8_t packets[70], got[80];
    for (int i = 0; i < 70; i++)
        packets[i] = (uint8_t)i;
    CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_COMPLETED, 70, packets));
    CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_COMPLETED, 1, packets));
    CHECK_EQUAL(68, fio_usb_transfers_read(r.transfers, got, sizeof got));
    CHECK_EQUAL(1, got[0]);
    CHECK_EQUAL(63, got[62]);
    CHECK_EQUAL(65, got[63]);
    end(&r);
}

/* While nobody reads, no more is asked for than there is room for; later every byte is there. */
static void ring_holds_the_printer_back(void) {
    rig r;
    begin(&r, false);
    unsigned char packet[512], next = 0, expected = 0;
    size_t given = 0, got = 0, wrong = 0;
    srand(7);
    for (int round = 0; round < 200; round++) {
        for (int quiet = 0; fake_count(IN) > 0 && quiet < 100; quiet++) {
            int size = rand() % 513;
            for (int i = 0; i < size; i++)
                packet[i] = next++;
            CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_COMPLETED, size, packet));
            given += (size_t)size;
            fio_usb_transfers_service(r.transfers);
        }
        CHECK(given - got <= FIO_USB_RING);
        unsigned char bytes[3000];
        size_t size = fio_usb_transfers_read(r.transfers, bytes, 1 + (size_t)rand() % 3000);
        for (size_t i = 0; i < size; i++)
            wrong += bytes[i] != expected++;
        got += size;
        fio_usb_transfers_service(r.transfers);
    }
    CHECK(given > 10 * FIO_USB_RING);
    CHECK_EQUAL(0, wrong);
    end(&r);
}

/* At most two transfers of 256 bytes are in front of an emergency stop. */
static void little_is_sent_at_once(void) {
    rig r;
    begin(&r, false);
    uint8_t bytes[2000];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (uint8_t)(i * 7);
    CHECK_EQUAL(512, fio_usb_transfers_write(r.transfers, bytes, sizeof bytes));
    CHECK_EQUAL(0, fio_usb_transfers_write(r.transfers, bytes, 1));
    CHECK(!fio_usb_transfers_writable(r.transfers));
    CHECK_EQUAL(512, fio_usb_transfers_pending(r.transfers));
    CHECK_EQUAL(2, fake_count(OUT));
    CHECK(memcmp(fake_flying(OUT, 0)->buffer, bytes, 256) == 0);
    CHECK(memcmp(fake_flying(OUT, 1)->buffer, bytes + 256, 256) == 0);
    CHECK(fake_flying(OUT, 0)->flags & LIBUSB_TRANSFER_ADD_ZERO_PACKET);
    CHECK_EQUAL(0, fake_flying(OUT, 0)->timeout); /* a busy printer may take its time */
    CHECK(fake_end(OUT, 0, LIBUSB_TRANSFER_COMPLETED, 256, NULL));
    CHECK(fio_usb_transfers_writable(r.transfers));
    CHECK_EQUAL(256, fio_usb_transfers_pending(r.transfers));
    CHECK_EQUAL(5, fio_usb_transfers_write(r.transfers, "M112\n", 5));
    CHECK(memcmp(fake_flying(OUT, 1)->buffer, "M112\n", 5) == 0);
    CHECK_EQUAL(5, fake_flying(OUT, 1)->length);
    end(&r);
}

static void no_empty_packet_where_none_is_wanted(void) {
    rig r;
    begin(&r, true);
    CHECK_EQUAL(64, fio_usb_transfers_write(r.transfers, (uint8_t[64]){0}, 64));
    CHECK_EQUAL(0, fake_flying(OUT, 0)->flags & LIBUSB_TRANSFER_ADD_ZERO_PACKET);
    end(&r);
}

/* A stall stops both transfers; after the halt is cleared the rest goes out in its order. */
static void stall_is_cleared_once(void) {
    rig r;
    begin(&r, false);
    uint8_t bytes[512];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (uint8_t)(i ^ i >> 8);
    CHECK_EQUAL(512, fio_usb_transfers_write(r.transfers, bytes, sizeof bytes));
    CHECK(fake_end(OUT, 0, LIBUSB_TRANSFER_STALL, 64, NULL));
    fio_usb_transfers_service(r.transfers); /* the second is cancelled first */
    CHECK_EQUAL(0, fake.halts_cleared);
    CHECK(!fio_usb_transfers_writable(r.transfers));
    CHECK_EQUAL(0, fio_usb_transfers_write(r.transfers, "x", 1));
    CHECK_EQUAL(FIO_OK, fio_usb_events_wait(&r.events, NULL, 0, 0));
    fio_usb_transfers_service(r.transfers);
    CHECK_EQUAL(1, fake.halts_cleared);
    CHECK_EQUAL(OUT, fake.halt_cleared);
    CHECK_EQUAL(2, fake_count(OUT));
    CHECK_EQUAL(192, fake_flying(OUT, 0)->length);
    CHECK(memcmp(fake_flying(OUT, 0)->buffer, bytes + 64, 192) == 0);
    CHECK_EQUAL(256, fake_flying(OUT, 1)->length);
    CHECK(memcmp(fake_flying(OUT, 1)->buffer, bytes + 256, 256) == 0);
    CHECK_EQUAL(448, fio_usb_transfers_pending(r.transfers));
    CHECK(fake_end(OUT, 0, LIBUSB_TRANSFER_COMPLETED, 192, NULL));
    CHECK(fake_end(OUT, 0, LIBUSB_TRANSFER_COMPLETED, 256, NULL));
    CHECK_EQUAL(0, fio_usb_transfers_pending(r.transfers));
    CHECK(!r.transfers->lost);
    /* Success makes the next stall a first one again; a second in a row is the end. */
    CHECK_EQUAL(9, fio_usb_transfers_write(r.transfers, "G1 X1 Y1\n", 9));
    for (int i = 0; i < 2; i++) {
        CHECK(!r.transfers->lost);
        CHECK(fake_end(OUT, 0, LIBUSB_TRANSFER_STALL, 0, NULL));
        fio_usb_transfers_service(r.transfers);
    }
    CHECK(r.transfers->lost);
    CHECK(strstr(r.transfers->loss, "stall") != NULL);
    end(&r);
}

static void stall_of_the_printers_side(void) {
    rig r;
    begin(&r, false);
    CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_STALL, 0, NULL));
    fio_usb_transfers_service(r.transfers);
    CHECK_EQUAL(FIO_USB_IN_COUNT - 1, fake_count(IN));
    CHECK_EQUAL(FIO_OK, fio_usb_events_wait(&r.events, NULL, 0, 0));
    fio_usb_transfers_service(r.transfers);
    CHECK_EQUAL(1, fake.halts_cleared);
    CHECK_EQUAL(IN, fake.halt_cleared);
    CHECK_EQUAL(FIO_USB_IN_COUNT, fake_count(IN));
    CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_COMPLETED, 3, "ok\n"));
    CHECK_EQUAL(3, fio_usb_transfers_read(r.transfers, (char[8]){0}, 8));
    CHECK(!r.transfers->lost);
    end(&r);
}

/* Bytes that came with an error are kept; it is tried again, but not for ever. */
static void noise_is_passed_over(void) {
    rig r;
    begin(&r, false);
    CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_ERROR, 2, "ok"));
    fio_usb_transfers_service(r.transfers);
    CHECK_EQUAL(FIO_USB_IN_COUNT - 1, fake_count(IN)); /* not at once */
    CHECK(fio_usb_transfers_next(r.transfers) < INFINITY);
    CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_COMPLETED, 1, "\n"));
    fio_usb_transfers_service(r.transfers);
    CHECK_EQUAL(FIO_USB_IN_COUNT, fake_count(IN));
    CHECK(fio_usb_transfers_next(r.transfers) == INFINITY);
    char text[8] = "";
    CHECK_EQUAL(3, fio_usb_transfers_read(r.transfers, text, sizeof text));
    CHECK(strcmp(text, "ok\n") == 0);
    int errors = 0;
    for (double stop = fio_monotonic() + 20; !r.transfers->lost && fio_monotonic() < stop;) {
        errors += fake_end(IN, 0, LIBUSB_TRANSFER_ERROR, 0, NULL);
        fio_usb_transfers_service(r.transfers);
    }
    CHECK(r.transfers->lost);
    CHECK(errors > 2 * FIO_USB_IN_COUNT && errors < 20 * FIO_USB_IN_COUNT);
    end(&r);
}

/* What may have arrived in part must not be overtaken or sent twice: the link is given up. */
static void failed_sending_is_a_loss(void) {
    rig r;
    begin(&r, false);
    CHECK_EQUAL(9, fio_usb_transfers_write(r.transfers, "G1 X1 Y1\n", 9));
    CHECK(fake_end(OUT, 0, LIBUSB_TRANSFER_ERROR, 0, NULL));
    CHECK(r.transfers->lost);
    CHECK_EQUAL(0, fio_usb_transfers_write(r.transfers, "M112\n", 5));
    end(&r);
}

static void unplugged(void) {
    rig r;
    begin(&r, false);
    CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_COMPLETED, 3, "ok\n"));
    for (int i = 0; i < 3; i++)
        CHECK(fake_end(IN, 0, LIBUSB_TRANSFER_NO_DEVICE, 0, NULL));
    int before = fake.submitted;
    fio_usb_transfers_service(r.transfers);
    CHECK_EQUAL(before, fake.submitted);
    CHECK(r.transfers->lost && strstr(r.transfers->loss, "unplugged"));
    CHECK_EQUAL(3, fio_usb_transfers_read(r.transfers, (char[8]){0}, 8));
    end(&r);

    begin(&r, false);
    fake.refuse = LIBUSB_ERROR_NO_DEVICE;
    CHECK_EQUAL(0, fio_usb_transfers_write(r.transfers, "M105\n", 5));
    CHECK(r.transfers->lost && strstr(r.transfers->loss, "unplugged"));
    CHECK_EQUAL(0, fio_usb_transfers_pending(r.transfers));
    end(&r);
}

static void what_is_given_up_counts_what_left(void) {
    rig r;
    begin(&r, false);
    uint8_t bytes[300] = {0};
    CHECK_EQUAL(300, fio_usb_transfers_write(r.transfers, bytes, sizeof bytes));
    CHECK_EQUAL(0, fio_usb_transfers_cancel(r.transfers, &r.events, false, 0.02));
    CHECK_EQUAL(0, fio_usb_transfers_pending(r.transfers));
    CHECK_EQUAL(FIO_USB_IN_COUNT, fake_count(IN)); /* reading goes on */

    CHECK_EQUAL(300, fio_usb_transfers_write(r.transfers, bytes, sizeof bytes));
    CHECK(fake_end(OUT, 0, LIBUSB_TRANSFER_CANCELLED, 128, NULL));
    CHECK_EQUAL(172, fio_usb_transfers_pending(r.transfers));
    CHECK_EQUAL(0, fio_usb_transfers_cancel(r.transfers, &r.events, false, 0.02));

    /* One that does not end may still leave. */
    CHECK_EQUAL(44, fio_usb_transfers_write(r.transfers, bytes, 44));
    fake.deaf = true;
    double start = fio_monotonic();
    CHECK_EQUAL(44, fio_usb_transfers_cancel(r.transfers, &r.events, false, 0.05));
    CHECK(fio_monotonic() - start >= 0.049);
    CHECK_EQUAL(44, fio_usb_transfers_pending(r.transfers));
    fake.deaf = false;
    CHECK_EQUAL(0, fio_usb_transfers_cancel(r.transfers, &r.events, true, 0.02));
    CHECK_EQUAL(0, fake.count);
    end(&r);
}

static void packets_that_make_no_sense(void) {
    static const uint16_t packets[][3] = {
        {0, 64, 512}, {1025, 64, 512}, {65535, 64, 512}, {64, 0, 512}};
    for (size_t i = 0; i < sizeof packets / sizeof *packets; i++) {
        rig r;
        begin(&r, false);
        end(&r);
        fake_begin();
        fio_usb_transfers *transfers = calloc(1, sizeof *transfers);
        r.serial.in_packet = packets[i][0];
        r.serial.out_packet = packets[i][1];
        r.serial.in_transfer = packets[i][2];
        CHECK_EQUAL(FIO_NO_PRINTER, fio_usb_transfers_begin(transfers, NULL, &r.serial));
        fio_usb_transfers_end(transfers);
        free(transfers);
    }
    static const uint16_t good[][3] = {
        {64, 0, 64}, {64, 65535, 1024}, {512, 512, 512}, {1024, 512, 1024}, {7, 512, 511}};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        rig r;
        begin(&r, false);
        end(&r);
        fake_begin();
        fio_usb_transfers *transfers = calloc(1, sizeof *transfers);
        r.serial.in_packet = good[i][0];
        r.serial.in_transfer = good[i][1];
        CHECK_EQUAL(FIO_OK, fio_usb_transfers_begin(transfers, NULL, &r.serial));
        CHECK_EQUAL(good[i][2], transfers->in_size);
        fio_usb_transfers_end(transfers);
        free(transfers);
    }
}

int main(void) {
    RUN(several_wait_for_data);
    RUN(wrapping_is_taken_off);
    RUN(ring_holds_the_printer_back);
    RUN(little_is_sent_at_once);
    RUN(no_empty_packet_where_none_is_wanted);
    RUN(stall_is_cleared_once);
    RUN(stall_of_the_printers_side);
    RUN(noise_is_passed_over);
    RUN(failed_sending_is_a_loss);
    RUN(unplugged);
    RUN(what_is_given_up_counts_what_left);
    RUN(packets_that_make_no_sense);
    return check_verdict();
}
