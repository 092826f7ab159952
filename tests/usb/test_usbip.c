/* The USB/IP server, spoken to as Linux' tools and vhci_hcd do: the layouts below are those of the
 * kernel's Documentation/usb/usbip_protocol.rst, written out again. */
#include "rig.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "standin/usbip.h"

enum { SUBMIT = 1, UNLINK = 2, RET_SUBMIT = 3, RET_UNLINK = 4, OUT = 0, IN = 1 };

typedef struct far_end {
    fio_machine *machine;
    fio_virtual_usb *device;
    fio_pace pace;
    fio_standin *server;
    int in, out; /* endpoints */
    uint32_t sequence;
    uint8_t bytes[4096]; /* received */
    size_t length;
} far_end;

static uint32_t get32(const uint8_t *at) {
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static void put32(uint8_t *at, uint32_t value) {
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(value >> (24 - 8 * i));
}

static void serve(far_end *end) {
    const fio_virtual_usb_options options = {.chip = "cdc-acm"};
    size_t size;
    *end = (far_end){.machine = rig_machine(false), .pace = fio_pace_start(0)};
    CHECK_EQUAL(FIO_OK, fio_virtual_usb_create(&end->device, end->machine, &options));
    CHECK_EQUAL(FIO_OK, fio_standin_usbip(&end->server, end->machine, &end->pace, end->device,
                                          "127.0.0.1", 0));
    const uint8_t *bytes = fio_virtual_usb_descriptors(end->device, &size);
    for (size_t at = 0; at < size; at += bytes[at])
        if (bytes[at + 1] == 5 && bytes[at + 3] == 2)
            *(bytes[at + 2] & 0x80 ? &end->in : &end->out) = bytes[at + 2] & 15;
}

static void leave(far_end *end) {
    fio_standin_close(end->server);
    fio_virtual_usb_free(end->device);
    fio_machine_free(end->machine);
}

static int call(const far_end *end) {
    int port = atoi(strrchr(end->server->where, ':') + 1);
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    int file = socket(AF_INET, SOCK_STREAM, 0);
    CHECK_EQUAL(0, connect(file, (struct sockaddr *)&address, sizeof address));
    fcntl(file, F_SETFL, O_NONBLOCK);
    return file;
}

/* Send, let the server work, and receive until there are `wanted` bytes; false if the far end hung
 * up or never said so much. */
static bool ask(far_end *end, int file, const void *bytes, size_t size, size_t wanted) {
    end->length = 0;
    CHECK(size == 0 || send(file, bytes, size, MSG_NOSIGNAL) == (ssize_t)size);
    for (int i = 0; i < 50 && end->length < wanted; i++) {
        rig_turn(end->server);
        ssize_t got = recv(file, end->bytes + end->length, sizeof end->bytes - end->length, 0);
        if (got == 0 || (got < 0 && errno != EAGAIN))
            return false;
        end->length += got > 0 ? (size_t)got : 0;
    }
    return end->length >= wanted;
}

static const uint8_t list_request[8] = {0x01, 0x11, 0x80, 0x05, 0, 0, 0, 0};

static size_t import_request(uint8_t request[40], const char *busid) {
    memset(request, 0, 40);
    memcpy(request, list_request, 8);
    request[3] = 3;
    memcpy(request + 8, busid, strlen(busid));
    return 40;
}

static int import(far_end *end) {
    uint8_t request[40];
    int file = call(end);
    CHECK(ask(end, file, request, import_request(request, "1-1"), 8 + 312));
    CHECK_EQUAL(0, get32(end->bytes + 4));
    return file;
}

/* The header of a URB, and for OUT its data. */
static size_t submit(far_end *end, uint8_t *to, int endpoint, int direction, uint32_t length,
                     const void *data) {
    memset(to, 0, 48);
    put32(to, SUBMIT);
    put32(to + 4, ++end->sequence);
    put32(to + 8, 1 << 16 | 2);
    put32(to + 12, (uint32_t)direction);
    put32(to + 16, (uint32_t)endpoint);
    put32(to + 24, length);
    put32(to + 32, 0xffffffff);
    if (direction == OUT && length)
        memcpy(to + 48, data, length);
    return 48 + (direction == OUT ? length : 0);
}

static size_t unlink_urb(far_end *end, uint8_t *to, uint32_t sequence) {
    memset(to, 0, 48);
    put32(to, UNLINK);
    put32(to + 4, ++end->sequence);
    put32(to + 8, 1 << 16 | 2);
    put32(to + 20, sequence);
    return 48;
}

static void test_the_list_describes_the_device(void) {
    far_end end;
    serve(&end);
    int file = call(&end);
    CHECK(ask(&end, file, list_request, 8, 8 + 4 + 312 + 2 * 4));
    const uint8_t *bytes = end.bytes, *device = bytes + 12;
    CHECK_EQUAL(0x01110005, get32(bytes));
    CHECK_EQUAL(0, get32(bytes + 4));
    CHECK_EQUAL(1, get32(bytes + 8));
    CHECK(!strcmp((const char *)device + 256, "1-1"));
    CHECK_EQUAL(2, get32(device + 296));          /* full speed */
    CHECK_EQUAL(0x23410042, get32(device + 300)); /* the Arduino Mega's ID */
    CHECK_EQUAL(2, device[306]);                  /* class: communications */
    CHECK_EQUAL(2, device[311]);                  /* interfaces */
    CHECK(device[312] == 2 && device[313] == 2);  /* communications, ACM */
    CHECK_EQUAL(10, device[316]);                 /* data */
    CHECK(!ask(&end, file, NULL, 0, 1));          /* and it hangs up */
    close(file);
    leave(&end);
}

static void test_only_what_is_there_can_be_imported_and_once(void) {
    far_end end;
    uint8_t request[40];
    serve(&end);
    int wrong = call(&end);
    CHECK(ask(&end, wrong, request, import_request(request, "3-7"), 8));
    CHECK_EQUAL(1, get32(end.bytes + 4));
    close(wrong);
    int file = import(&end), second = call(&end), third = call(&end);
    CHECK(end.server->connected);
    CHECK(ask(&end, second, request, import_request(request, "1-1"), 8));
    CHECK_EQUAL(1, get32(end.bytes + 4));
    CHECK(ask(&end, third, list_request, 8, 12)); /* it can be asked while one is connected */
    CHECK_EQUAL(0, get32(end.bytes + 8));
    close(second);
    close(third);
    close(file);
    rig_turn(end.server);
    CHECK(!end.server->connected);
    close(import(&end)); /* and it is free again */
    leave(&end);
}

static void test_a_conversation(void) {
    static const uint8_t get_device[8] = {0x80, 6, 0, 1, 0, 0, 18, 0};
    static const uint8_t line_state[8] = {0x21, 0x22, 3, 0, 0, 0, 0, 0};
    static const uint8_t nonsense[8] = {0x21, 0x77, 0, 0, 0, 0, 0, 0};
    far_end end;
    uint8_t urb[256];
    serve(&end);
    int file = import(&end);
    size_t size = submit(&end, urb, 0, IN, 18, NULL);
    memcpy(urb + 40, get_device, 8);
    CHECK(ask(&end, file, urb, size, 48 + 18));
    CHECK_EQUAL(RET_SUBMIT, get32(end.bytes));
    CHECK_EQUAL(end.sequence, get32(end.bytes + 4));
    CHECK_EQUAL(0, get32(end.bytes + 20));
    CHECK_EQUAL(18, get32(end.bytes + 24));
    CHECK(end.bytes[48] == 18 && end.bytes[56] == 0x41 && end.bytes[57] == 0x23);
    size = submit(&end, urb, 0, OUT, 0, NULL);
    memcpy(urb + 40, nonsense, 8);
    CHECK(ask(&end, file, urb, size, 48));
    CHECK_EQUAL((uint32_t)-EPIPE, get32(end.bytes + 20));
    size = submit(&end, urb, 0, OUT, 0, NULL);
    memcpy(urb + 40, line_state, 8);
    CHECK(ask(&end, file, urb, size, 48));
    CHECK_EQUAL(0, get32(end.bytes + 20));
    size = submit(&end, urb, end.in, IN, 128, NULL); /* waits for an answer */
    uint32_t waiting = end.sequence;
    CHECK(!ask(&end, file, urb, size, 1));
    size = submit(&end, urb, end.out, OUT, 5, "M105\n");
    CHECK(ask(&end, file, urb, size, 48 + 48 + 6));
    CHECK_EQUAL(end.sequence, get32(end.bytes + 4));
    CHECK_EQUAL(5, get32(end.bytes + 24));
    CHECK_EQUAL(waiting, get32(end.bytes + 48 + 4));
    CHECK(!memcmp(end.bytes + 96, "ok T:", 5));
    close(file);
    leave(&end);
}

static void test_unlinking(void) {
    far_end end;
    uint8_t urb[256];
    serve(&end);
    int file = import(&end);
    size_t size = submit(&end, urb, end.in, IN, 64, NULL);
    uint32_t waiting = end.sequence;
    CHECK(!ask(&end, file, urb, size, 1));
    CHECK(ask(&end, file, urb, unlink_urb(&end, urb, waiting), 48));
    CHECK_EQUAL(48, end.length); /* nothing for the URB itself */
    CHECK_EQUAL(RET_UNLINK, get32(end.bytes));
    CHECK_EQUAL(end.sequence, get32(end.bytes + 4));
    CHECK_EQUAL((uint32_t)-ECONNRESET, get32(end.bytes + 20));
    CHECK(ask(&end, file, urb, unlink_urb(&end, urb, waiting), 48)); /* too late by now */
    CHECK_EQUAL(0, get32(end.bytes + 20));
    close(file);
    leave(&end);
}

/* Header and data of an answer leave in one piece: vhci_hcd must not be caught between the two. On
 * a socket that keeps packets apart, each call sends one. */
static void test_an_answer_leaves_in_one_piece(void) {
    static const uint8_t get_device[8] = {0x80, 6, 0, 1, 0, 0, 18, 0};
    far_end end;
    uint8_t urb[256];
    int ends[2];
    serve(&end);
    fio_standin_close(end.server);
    CHECK_EQUAL(0, socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends));
    CHECK_EQUAL(FIO_OK,
                fio_standin_usbip_socket(&end.server, end.machine, &end.pace, end.device, ends[1]));
    size_t size = submit(&end, urb, 0, IN, 18, NULL);
    memcpy(urb + 40, get_device, 8);
    CHECK(ask(&end, ends[0], urb, size, 1));
    CHECK_EQUAL(48 + 18, end.length);
    CHECK(end.bytes[48] == 18 && end.bytes[56] == 0x41 && end.bytes[57] == 0x23);
    close(ends[0]);
    leave(&end);
}

/* Bytes that come one by one mean the same. */
static void test_any_pieces(void) {
    static const uint8_t get_configuration[8] = {0x80, 6, 0, 2, 0, 0, 9, 0};
    far_end end;
    uint8_t urb[256];
    serve(&end);
    int file = import(&end);
    size_t size = submit(&end, urb, 0, IN, 9, NULL);
    memcpy(urb + 40, get_configuration, 8);
    for (size_t i = 0; i < size - 1; i++) {
        CHECK_EQUAL(1, send(file, urb + i, 1, MSG_NOSIGNAL));
        if (i % 16 == 0)
            rig_turn(end.server);
    }
    CHECK(ask(&end, file, urb + size - 1, 1, 48 + 9));
    CHECK(end.bytes[48] == 9 && end.bytes[49] == 2);
    close(file);
    leave(&end);
}

static void test_what_makes_no_sense_is_hung_up_on(void) {
    far_end end;
    uint8_t urb[256];
    serve(&end);
    static const uint8_t nothing[8] = {0x01, 0x11, 0x12, 0x34, 0, 0, 0, 0};
    int file = call(&end);
    CHECK(!ask(&end, file, nothing, 8, 1));
    close(file);
    for (int i = 0; i < 4; i++) {
        file = import(&end);
        size_t size = submit(&end, urb, i == 3 ? 77 : end.in, i == 1 ? OUT : IN, 0, NULL);
        put32(urb + 24, i < 2 ? 0x7fffffff : 64); /* 2 GB is more than is taken */
        if (i == 2)
            put32(urb, 99); /* no such command */
        CHECK(!ask(&end, file, urb, size, 1));
        CHECK(!end.server->connected);
        close(file);
    }
    /* Noise, seeded: whatever it does, it must neither stop nor fall over. */
    uint32_t state = 1;
    for (int round = 0; round < 30; round++) {
        file = round % 2 ? import(&end) : call(&end);
        for (int k = 0; k < 10; k++) {
            for (size_t i = 0; i < sizeof urb; i++) {
                state = state * 1664525 + 1013904223;
                urb[i] = (uint8_t)(state >> 24) & (i % 4 == 3 ? 3 : 0);
            }
            if (send(file, urb, sizeof urb, MSG_NOSIGNAL) < 0)
                break;
            rig_turn(end.server);
        }
        close(file);
        rig_turn(end.server);
    }
    close(import(&end));
    leave(&end);
}

static void test_a_thousand_waiting_transfers_are_too_many(void) {
    far_end end;
    uint8_t urb[64];
    serve(&end);
    int file = import(&end);
    bool hung_up = false;
    for (int i = 0; i < 2000 && !hung_up; i++) {
        size_t size = submit(&end, urb, end.in, IN, 64, NULL);
        hung_up = send(file, urb, size, MSG_NOSIGNAL) < 0;
        if (i % 100 == 99)
            rig_turn(end.server);
    }
    rig_turn(end.server);
    CHECK(!end.server->connected);
    close(file);
    leave(&end);
}

static void test_a_pulled_plug_ends_the_connection(void) {
    far_end end;
    serve(&end);
    int file = import(&end);
    CHECK_EQUAL(FIO_OK, end.server->type->plug(end.server, false));
    CHECK(!ask(&end, file, NULL, 0, 1));
    CHECK(!end.server->connected);
    close(file);
    leave(&end);
}

int main(void) {
    RUN(test_the_list_describes_the_device);
    RUN(test_only_what_is_there_can_be_imported_and_once);
    RUN(test_a_conversation);
    RUN(test_unlinking);
    RUN(test_an_answer_leaves_in_one_piece);
    RUN(test_any_pieces);
    RUN(test_what_makes_no_sense_is_hung_up_on);
    RUN(test_a_thousand_waiting_transfers_are_too_many);
    RUN(test_a_pulled_plug_ends_the_connection);
    return check_verdict();
}
