/* What a host controller does with transfers, against a CDC-ACM printer. */
#include "rig.h"

#include <errno.h>

#include "standin/usb_host.h"

typedef struct cable {
    fio_machine *machine;
    fio_virtual_usb *device;
    fio_usb_host host;
    uint8_t in, out; /* endpoints of the chip */
    double now;
} cable;

static void plug_in(cable *bus, const char *chip) {
    fio_virtual_usb_options options = {.chip = chip};
    *bus = (cable){.machine = rig_machine(false)};
    CHECK_EQUAL(FIO_OK, fio_virtual_usb_create(&bus->device, bus->machine, &options));
    fio_usb_host_begin(&bus->host, bus->device, bus->machine);
    size_t size;
    const uint8_t *bytes = fio_virtual_usb_descriptors(bus->device, &size);
    for (size_t at = 0; at < size; at += bytes[at])
        if (bytes[at + 1] == 5 && bytes[at + 3] == 2)
            *(bytes[at + 2] & 0x80 ? &bus->in : &bus->out) = bytes[at + 2];
}

static void unplug(cable *bus) {
    fio_virtual_usb_free(bus->device);
    fio_machine_free(bus->machine);
}

static int control(cable *bus, const uint8_t setup[8], uint8_t *data, int length) {
    fio_urb urb = {.data = data, .length = length};
    memcpy(urb.setup, setup, 8);
    fio_usb_host_submit(&bus->host, bus->now, &urb);
    CHECK(fio_usb_host_reap(&bus->host, NULL) == &urb);
    return urb.status ? urb.status : urb.moved;
}

static void raise_lines(cable *bus) {
    static const uint8_t line_state[8] = {0x21, 0x22, 3, 0, 0, 0, 0, 0};
    CHECK_EQUAL(0, control(bus, line_state, NULL, 0));
}

static void pass(cable *bus, double seconds) {
    for (int i = 0; i < 200; i++) {
        bus->now += seconds / 200;
        fio_usb_host_pump(&bus->host, bus->now);
    }
}

static fio_urb to(const cable *bus, const char *text) {
    return (fio_urb){.endpoint = bus->out, .data = (uint8_t *)text, .length = (int)strlen(text)};
}

static fio_urb from(const cable *bus, uint8_t *bytes, int size) {
    return (fio_urb){.endpoint = bus->in, .data = bytes, .length = size};
}

/* USB 2.0, chapter 9.4.3: the device descriptor, as much as the host asks for. */
static void test_control_transfers_are_cut_to_what_is_asked_for(void) {
    static const uint8_t get_device[8] = {0x80, 6, 0, 1, 0, 0, 18, 0};
    static const uint8_t get_beginning[8] = {0x80, 6, 0, 1, 0, 0, 8, 0};
    static const uint8_t nonsense[8] = {0x21, 0x77, 0, 0, 0, 0, 0, 0};
    cable bus;
    uint8_t bytes[64];
    plug_in(&bus, "cdc-acm");
    CHECK_EQUAL(18, control(&bus, get_device, bytes, sizeof bytes));
    CHECK(bytes[0] == 18 && bytes[1] == 1 && bytes[7] >= 8);
    CHECK_EQUAL(8, control(&bus, get_beginning, bytes, sizeof bytes));
    CHECK_EQUAL(4, control(&bus, get_device, bytes, 4));
    CHECK_EQUAL(-EPIPE, control(&bus, nonsense, NULL, 0));
    unplug(&bus);
}

static void test_a_transfer_ends_with_a_short_packet(void) {
    cable bus;
    uint8_t bytes[512];
    plug_in(&bus, "cdc-acm");
    raise_lines(&bus);
    fio_urb in = from(&bus, bytes, sizeof bytes), out = to(&bus, "M105\n");
    fio_usb_host_submit(&bus.host, bus.now, &in);
    CHECK(!fio_usb_host_reap(&bus.host, NULL));
    fio_usb_host_submit(&bus.host, bus.now, &out);
    CHECK(fio_usb_host_reap(&bus.host, NULL) == &out);
    CHECK_EQUAL(5, out.moved);
    pass(&bus, 0.1);
    CHECK(fio_usb_host_reap(&bus.host, NULL) == &in);
    CHECK(in.moved > 5 && in.moved < 64 && !memcmp(bytes, "ok T:", 5));
    unplug(&bus);
}

static void test_transfers_of_an_endpoint_keep_their_order(void) {
    cable bus;
    uint8_t bytes[3][64];
    fio_urb in[3];
    plug_in(&bus, "cdc-acm");
    raise_lines(&bus);
    for (int i = 0; i < 3; i++) {
        in[i] = from(&bus, bytes[i], 64);
        in[i].client = i == 1 ? &in[1] : &in[0];
        fio_usb_host_submit(&bus.host, bus.now, &in[i]);
    }
    for (int i = 0; i < 3; i++) {
        fio_urb out = to(&bus, "M105\n");
        out.client = &out;
        fio_usb_host_submit(&bus.host, bus.now, &out);
        pass(&bus, 0.1);
        CHECK(fio_usb_host_reap(&bus.host, &out) == &out);
        CHECK(!fio_usb_host_reap(&bus.host, i == 1 ? &in[0] : &in[1])); /* another program's */
        CHECK(fio_usb_host_reap(&bus.host, in[i].client) == &in[i]);
    }
    unplug(&bus);
}

/* A firmware whose buffers are full refuses packets; they are tried again, none is lost. */
static void test_refused_packets_are_held(void) {
    cable bus;
    static char text[40 * 64 + 1];
    static uint8_t answers[8192];
    plug_in(&bus, "cdc-acm");
    raise_lines(&bus);
    for (int i = 0; i < 40 * 16; i++)
        memcpy(text + i * 4, i == 0 ? "G4S1" : i % 2 ? "\nM10" : "5 ;x", 4);
    fio_urb out = to(&bus, text);
    fio_usb_host_submit(&bus.host, bus.now, &out);
    pass(&bus, 0.5);
    CHECK(!fio_usb_host_reap(&bus.host, NULL)); /* it dwells */
    CHECK(out.moved > 0 && out.moved < out.length && out.moved % 64 == 0);
    fio_urb in = from(&bus, answers, sizeof answers);
    bool whole = false;
    fio_usb_host_submit(&bus.host, bus.now, &in);
    for (int i = 0; i < 400 && !whole; i++) {
        pass(&bus, 0.05);
        for (fio_urb *done; (done = fio_usb_host_reap(&bus.host, NULL));) {
            whole |= done == &out;
            if (done == &in)
                fio_usb_host_submit(&bus.host, bus.now, &in);
        }
    }
    CHECK(whole);
    CHECK_EQUAL(out.length, out.moved);
    pass(&bus, 1);
    CHECK_EQUAL(320, rig_lines(bus.machine));
    CHECK_EQUAL(0, fio_machine_count(bus.machine)->overruns);
    unplug(&bus);
}

static void test_cancelled_transfers_are_done_once(void) {
    cable bus;
    uint8_t bytes[64];
    plug_in(&bus, "cdc-acm");
    raise_lines(&bus);
    fio_urb in = from(&bus, bytes, 64);
    fio_usb_host_submit(&bus.host, bus.now, &in);
    CHECK(fio_usb_host_cancel(&bus.host, &in, -ENOENT));
    CHECK(!fio_usb_host_cancel(&bus.host, &in, -ENOENT));
    CHECK(fio_usb_host_reap(&bus.host, NULL) == &in);
    CHECK_EQUAL(-ENOENT, in.status);
    CHECK(!fio_usb_host_reap(&bus.host, NULL));
    fio_usb_host_submit(&bus.host, bus.now, &in); /* the queue is whole */
    CHECK(fio_usb_host_cancel(&bus.host, &in, -ECONNRESET));
    unplug(&bus);
}

/* USB 2.0, chapter 9.4.1: a halted endpoint stalls until CLEAR_FEATURE(ENDPOINT_HALT). */
static void test_a_stalled_endpoint_waits_for_clear_feature(void) {
    cable bus;
    plug_in(&bus, "cdc-acm");
    raise_lines(&bus);
    bus.host.stall_at = 1;
    fio_urb out = to(&bus, "M105\n");
    static const int expected[] = {0, -EPIPE, -EPIPE, 0};
    for (int i = 0; i < 4; i++) {
        if (i == 3) {
            uint8_t clear[8] = {2, 1, 0, 0, bus.out, 0, 0, 0};
            CHECK_EQUAL(0, control(&bus, clear, NULL, 0));
        }
        fio_usb_host_submit(&bus.host, bus.now, &out);
        pass(&bus, 0.1);
        CHECK(fio_usb_host_reap(&bus.host, NULL) == &out);
        CHECK_EQUAL(expected[i], out.status);
    }
    CHECK_EQUAL(2, rig_lines(bus.machine));
    bus.host.stall_at = bus.host.packets_out;
    fio_usb_host_submit(&bus.host, bus.now, &out);
    CHECK(fio_usb_host_reap(&bus.host, NULL) == &out && out.status == -EPIPE);
    fio_usb_host_clear_halt(&bus.host, bus.now, bus.out);
    CHECK(!fio_usb_host_reap(&bus.host, NULL)); /* it was no transfer of anyone's */
    fio_usb_host_submit(&bus.host, bus.now, &out);
    CHECK(fio_usb_host_reap(&bus.host, NULL) == &out && out.status == 0);
    unplug(&bus);
}

static void test_unplugging_ends_everything(void) {
    cable bus;
    uint8_t bytes[2][64];
    plug_in(&bus, "cdc-acm");
    raise_lines(&bus);
    fio_urb in[2] = {from(&bus, bytes[0], 64), from(&bus, bytes[1], 64)}, out = to(&bus, "M105\n");
    fio_usb_host_submit(&bus.host, bus.now, &in[0]);
    fio_usb_host_submit(&bus.host, bus.now, &in[1]);
    fio_usb_host_unplug(&bus.host);
    for (int i = 0; i < 2; i++) {
        CHECK(fio_usb_host_reap(&bus.host, NULL) == &in[i]);
        CHECK_EQUAL(-ESHUTDOWN, in[i].status);
    }
    fio_usb_host_submit(&bus.host, bus.now, &out);
    CHECK(fio_usb_host_reap(&bus.host, NULL) == &out);
    CHECK_EQUAL(-ESHUTDOWN, out.status);
    unplug(&bus);
}

static void test_unknown_endpoints_and_small_buffers(void) {
    cable bus;
    uint8_t bytes[4];
    plug_in(&bus, "cdc-acm");
    raise_lines(&bus);
    fio_urb nowhere = {.endpoint = 0x0f, .data = bytes, .length = 4};
    fio_usb_host_submit(&bus.host, bus.now, &nowhere);
    CHECK(fio_usb_host_reap(&bus.host, NULL) == &nowhere);
    CHECK_EQUAL(-ENOENT, nowhere.status);
    fio_urb out = to(&bus, "M105\n"), in = from(&bus, bytes, 4);
    fio_usb_host_submit(&bus.host, bus.now, &out);
    fio_usb_host_reap(&bus.host, NULL);
    pass(&bus, 0.1);
    fio_usb_host_submit(&bus.host, bus.now, &in);
    CHECK(fio_usb_host_reap(&bus.host, NULL) == &in);
    CHECK_EQUAL(-EOVERFLOW, in.status); /* the kernel's word for babble */
    CHECK_EQUAL(4, in.moved);
    unplug(&bus);
}

static void test_every_chip_lets_bytes_through(void) {
    static const char *const chips[] = {"cdc-acm", "ch340",  "ch340-limited", "ftdi",
                                        "ftdi-h",  "cp2102", "pl2303hx",      "pl2303hxn"};
    for (size_t i = 0; i < sizeof chips / sizeof *chips; i++) {
        cable bus;
        plug_in(&bus, chips[i]);
        CHECK(bus.in && bus.out);
        CHECK(bus.host.packet[(bus.in & 15) + 16] >= 32 && bus.host.packet[bus.out] >= 32);
        unplug(&bus);
    }
}

int main(void) {
    RUN(test_control_transfers_are_cut_to_what_is_asked_for);
    RUN(test_a_transfer_ends_with_a_short_packet);
    RUN(test_transfers_of_an_endpoint_keep_their_order);
    RUN(test_refused_packets_are_held);
    RUN(test_cancelled_transfers_are_done_once);
    RUN(test_a_stalled_endpoint_waits_for_clear_feature);
    RUN(test_unplugging_ends_everything);
    RUN(test_unknown_endpoints_and_small_buffers);
    RUN(test_every_chip_lets_bytes_through);
    return check_verdict();
}
