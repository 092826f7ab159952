/* A host and a hub at their worst: pauses, packets cut anywhere, transfers of any length, halted
 * endpoints, settings renewed in mid-line. No byte may be lost, doubled or out of order. */
#include <stdlib.h>

#include "check.h"
#include "serial/link.h"

enum { LINES = 150, IN = 0, OUT = 1 };

static uint64_t state;

static int below(int bound) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (int)(state % (unsigned)bound);
}

/* The device halts an endpoint; the host gets a stall, clears it and tries again. */
static void halt(usb_link *l, uint8_t endpoint) {
    CHECK_EQUAL(0, link_ask(l, 0x02, 3, 0, endpoint, NULL, 0));
}

static void clear(usb_link *l, uint8_t endpoint) {
    CHECK_EQUAL(0, link_ask(l, 0x02, 1, 0, endpoint, NULL, 0));
}

static void disturb(usb_link *l, int64_t rate) {
    switch (below(40)) {
    case 0:
        l->now += below(300) * 1e-4; /* nobody asks for that long */
        break;
    case 1:
        halt(l, l->serial.in);
        break;
    case 2:
        halt(l, l->serial.out);
        break;
    case 3:
        CHECK_EQUAL(FIO_OK, l->serial.driver->set_rate(&l->serial, rate));
        break;
    case 4:
        CHECK_EQUAL(FIO_OK, l->serial.driver->set_lines(&l->serial, true, true));
        break;
    default:
        l->now += 1e-5 * below(20);
    }
}

/* One IN transfer of one packet or more, as long as packets are full. */
static void receive(usb_link *l) {
    uint8_t buffer[512 * 4];
    size_t got = 0, most = (size_t)l->serial.in_packet * (size_t)(1 + below(4));
    while (got < most) {
        int size =
            fio_virtual_usb_in(l->device, l->now, l->serial.in, buffer + got, l->serial.in_packet);
        if (size == FIO_USB_STALL)
            clear(l, l->serial.in);
        if (size < 0)
            break;
        got += (size_t)size;
        if (size < l->serial.in_packet)
            break;
    }
    if (l->serial.driver->unwrap)
        got = l->serial.driver->unwrap(&l->serial, buffer, got);
    if (!CHECK(l->length + got < sizeof l->text))
        abort();
    memcpy(l->text + l->length, buffer, got);
    l->length += got;
    l->text[l->length] = 0;
}

/* A piece of any length, empty ones included; returns what was taken. */
static int transmit(usb_link *l, const char *text, int size) {
    int piece = below(l->serial.out_packet + 1);
    piece = piece < size ? piece : size;
    int taken = fio_virtual_usb_out(l->device, l->now, l->serial.out, (const uint8_t *)text, piece);
    if (taken == FIO_USB_STALL)
        clear(l, l->serial.out);
    l->refused += taken == FIO_USB_NAK;
    return taken > 0 ? taken : 0;
}

static int count_of(const char *text, const char *word) {
    int count = 0;
    for (const char *at = text; (at = strstr(at, word)); at++)
        count++;
    return count;
}

/* All lines in one go: the device itself must hold the host back. Over a wire a window of two short
 * lines keeps the firmware's buffer from running over. */
static void print_job(const char *chip, int64_t rate, bool wire) {
    static const char greeting[] = "N0 M110*35\n";
    usb_link *l = link_plug(chip, wire ? rate : 0, NULL);
    CHECK_EQUAL(FIO_OK, l->serial.driver->open(&l->serial, rate, true));
    link_run(l, 0.1);
    l->length = 0;
    l->text[0] = 0;
    int sent = 0, answered = 0, at = 0, length = 0, tries = 0;
    char line[64] = "";
    for (; answered <= LINES && tries < 2000000; tries++) {
        if (at == length && sent <= LINES && (!wire || sent < answered + 2)) {
            int size = snprintf(line, sizeof line, "N%d G92 E%d.%d", sent, sent % 100, sent);
            unsigned sum = 0;
            for (int i = 0; i < size; i++)
                sum ^= (unsigned char)line[i];
            snprintf(line + size, sizeof line - (size_t)size, "*%u\n", sum);
            if (sent == 0)
                snprintf(line, sizeof line, "%s", greeting);
            at = 0;
            length = (int)strlen(line);
            sent++;
        }
        if (at < length)
            at += transmit(l, line + at, length - at);
        receive(l);
        disturb(l, rate);
        answered = count_of(l->text, "ok\n");
    }
    CHECK_EQUAL(LINES + 1, answered);
    CHECK_EQUAL(0, count_of(l->text, "Resend"));
    CHECK_EQUAL(0, count_of(l->text, "Error"));
    CHECK_EQUAL((long long)l->length, 3 * (LINES + 1)); /* nothing but oks */
    fio_state printer;
    fio_virtual_printer_state(fio_machine_printer(l->machine), &printer);
    CHECK_EQUAL(LINES, printer.line_number);
    CHECK_EQUAL(LINES + 1, fio_machine_count(l->machine)->lines_in);
    CHECK_EQUAL(0, fio_machine_count(l->machine)->overruns);
    CHECK_EQUAL(1, fio_machine_count(l->machine)->resets);
    if (!wire)
        CHECK(l->refused > 0);
    link_unplug(l);
}

static void test_every_chip_on_a_bad_hub(void) {
    static const char *const chips[] = {"cdc-acm", "ch340",  "ch340-limited", "ftdi",
                                        "ftdi-h",  "cp2102", "pl2303hx",      "pl2303hxn"};
    for (size_t i = 0; i < sizeof chips / sizeof *chips; i++)
        for (int seed = 1; seed <= 4; seed++) {
            int failures = check_failures;
            state = 0x9e3779b97f4a7c15u * (uint64_t)seed;
            print_job(chips[i], seed & 1 ? 115200 : 250000, true);
            if (check_failures > failures)
                fprintf(stderr, "  %s, seed %d\n", chips[i], seed);
        }
}

static void test_native_usb_on_a_bad_hub(void) {
    for (int seed = 1; seed <= 8; seed++) {
        int failures = check_failures;
        state = 0x9e3779b97f4a7c15u * (uint64_t)seed;
        print_job("cdc-acm", 115200, false);
        if (check_failures > failures)
            fprintf(stderr, "  seed %d\n", seed);
    }
}

int main(void) {
    RUN(test_every_chip_on_a_bad_hub);
    RUN(test_native_usb_on_a_bad_hub);
    return check_verdict();
}
