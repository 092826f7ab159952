/* Marlin's binary transfer, by packets put together here from its description. */
#include "bench.h"

#include "virtual/packet.h"

typedef unsigned char byte;

/* Fletcher's checksum as the textbook has it: two sums modulo 255. */
static void sum(byte result[2], const byte *bytes, size_t size) {
    unsigned a = 0, b = 0;
    for (size_t i = 0; i < size; i++) {
        a = (a + bytes[i]) % 255;
        b = (b + a) % 255;
    }
    result[0] = (byte)a;
    result[1] = (byte)b;
}

static size_t make(byte *packet, int number, int protocol, int type, const void *payload,
                   size_t size) {
    byte *p = packet;
    *p++ = 0xad;
    *p++ = 0xb5;
    *p++ = (byte)number;
    *p++ = (byte)(protocol << 4 | type);
    *p++ = (byte)size;
    *p++ = (byte)(size >> 8);
    sum(p, packet + 2, 4);
    p += 2;
    if (size == 0)
        return (size_t)(p - packet);
    memcpy(p, payload, size);
    sum(p + size, packet + 2, 6 + size);
    return (size_t)(p - packet) + size + 2;
}

static const char *send_bytes(bench *b, const byte *bytes, size_t size) {
    b->used = 0;
    b->heard[0] = 0;
    CHECK_EQUAL(size, fio_machine_write(b->machine, b->now, bytes, size));
    bench_pass(b, 0.1);
    return b->heard;
}

static void expect(bench *b, int number, int protocol, int type, const char *payload, size_t size,
                   const char *answer) {
    byte packet[300];
    const char *heard = send_bytes(b, packet, make(packet, number, protocol, type, payload, size));
    if (!CHECK(!strcmp(heard, answer)))
        fprintf(stderr, "    packet %d was answered by:\n%s\n", number, heard);
}

static void test_known_sum(void) {
    /* Fletcher-16 of "abcde" is C8F0. */
    uint16_t value = 0;
    for (const char *p = "abcde"; *p; p++)
        value = fio_packet_sum(value, (byte)*p);
    CHECK_EQUAL(0xc8f0, value);
}

static void test_transfer(void) {
    bench *b = bench_make(bench_options());
    bench_expect(b, "M28 B1\n", 0.1, "echo:Switching to Binary Protocol\nok\n");
    expect(b, 0, 0, 1, NULL, 0, "ss0,96,0.1.0\n");
    expect(b, 0, 1, 0, NULL, 0, "ok0\nPFT:version:0.1.0:compresion:none\n");
    expect(b, 1, 1, 3, "x", 1, "ok1\nPFT:invalid\n");
    expect(b, 2, 1, 1, "\0\0a.g", 6, "ok2\nPFT:success\n");
    expect(b, 3, 1, 1, "\0\0b.g", 6, "ok3\nPFT:busy\n");
    expect(b, 4, 1, 3, "M118 one\n", 9, "ok4\n");
    expect(b, 4, 1, 3, "M118 one\n", 9, "ok4\n"); /* again: not written again */
    expect(b, 5, 1, 3, "M118 two\n", 9, "ok5\n");
    expect(b, 6, 1, 2, NULL, 0, "ok6\nPFT:success\n");
    expect(b, 7, 0, 2, NULL, 0, "ok7\n");
    bench_expect(b, "M20\n", 0.1, "Begin file list\na.g 18\nEnd file list\nok\n");
    const char *heard = bench_ask(b, "M32 a.g\n", 1);
    CHECK(strstr(heard, "one\n") && strstr(heard, "two\n") && strstr(heard, "Done printing"));
    bench_free(b);
}

static void test_damage(void) {
    bench *b = bench_make(bench_options());
    byte packet[300], much[97] = {0};
    bench_ask(b, "M28 B1\n", 0.1);
    size_t size = make(packet, 0, 1, 1, "\0\0a.g", 6);
    packet[3] ^= 4;
    CHECK(!strcmp(send_bytes(b, packet, 8),
                  "echo:Packet header(0?) corrupt\necho:Resend request 1\nrs0\n"));
    packet[3] ^= 4;
    packet[10] ^= 4;
    CHECK(!strcmp(send_bytes(b, packet, size),
                  "echo:Packet(0) payload corrupt\necho:Resend request 2\nrs0\n"));
    packet[10] ^= 4;
    send_bytes(b, packet, size - 3);
    bench_expect(b, "", 0.5, "echo:Datastream timeout\necho:Resend request 3\nrs0\n");
    expect(b, 0, 1, 1, "\0\0a.g", 6, "ok0\nPFT:success\n");
    expect(b, 9, 1, 3, "x", 1, "echo:Datastream packet out of order\necho:Resend request 1\nrs1\n");
    size = make(packet, 1, 1, 3, much, sizeof much);
    CHECK(!strncmp(send_bytes(b, packet, 8), "echo:Datastream packet data buffer overrun\nfe1\n",
                   47));
    bench_pass(b, 1);
    expect(b, 0, 1, 4, NULL, 0, "ok0\nPFT:success\n"); /* abort: the file goes */
    expect(b, 1, 0, 2, NULL, 0, "ok1\n");
    bench_expect(b, "M20\n", 0.1, "Begin file list\nEnd file list\nok\n");
    bench_free(b);
}

int main(void) {
    RUN(test_known_sum);
    RUN(test_transfer);
    RUN(test_damage);
    return check_verdict();
}
