/* MeatPack, against the bytes of its own documentation and the host's packer. */
#include "bench.h"

#include "protocol/meatpack.h"

static void send_bytes(bench *b, const unsigned char *bytes, size_t size) {
    b->used = 0;
    b->heard[0] = 0;
    CHECK_EQUAL(size, fio_machine_write(b->machine, b->now, bytes, size));
    bench_pass(b, 0.2);
}

static void test_known_bytes(void) {
    static const unsigned char on[] = {0xff, 0xff, 0xfb}, off[] = {0xff, 0xff, 0xfa};
    static const unsigned char ask[] = {0xff, 0xff, 0xf8}, tight[] = {0xff, 0xff, 0xf7};
    static const unsigned char m105[] = {0x1f, 0x4d, 0x50, 0xcc};
    static const unsigned char ff[] = {0xff, 0x1f, 0x4d, 0x50, 0xcc};
    bench *b = bench_make(bench_options());
    send_bytes(b, ask, 3);
    CHECK(!strcmp(b->heard, "[MP] PV01 OFF ESP\n"));
    send_bytes(b, on, 3);
    CHECK(!strcmp(b->heard, "[MP] PV01 ON ESP\n"));
    send_bytes(b, m105, 4);
    CHECK(!strncmp(b->heard, "ok T:20.00", 10));
    send_bytes(b, ff, 5); /* a lone 0xff is two literals: 0x1f and 'M' */
    CHECK(strstr(b->heard, "echo:Unknown command"));
    send_bytes(b, tight, 3);
    CHECK(!strcmp(b->heard, "[MP] PV01 ON NSP\n"));
    send_bytes(b, off, 3);
    CHECK(!strcmp(b->heard, "[MP] PV01 OFF NSP\n"));
    bench_expect(b, "G90\n", 0.1, "ok\n");
    bench_free(b);
}

static void test_what_the_host_packs(void) {
    static const char *const lines[] = {"G1 X10.25 Y-3.5 E0.01\n", "M104 S200\n", "M117 a?b*c\n",
                                        "G28\n", "G92 E0\n"};
    for (int no_spaces = 0; no_spaces < 2; no_spaces++) {
        bench *b = bench_make(bench_options());
        bench_ask(b, "M302 P1\nG28\n", 20);
        fio_meatpack packer = {0};
        unsigned char packed[600];
        send_bytes(b, packed, fio_meatpack_begin(&packer, no_spaces, packed));
        for (int i = 0; i < 5; i++) {
            size_t size = fio_meatpack_line(&packer, lines[i], strlen(lines[i]), packed);
            if (i != 2)
                CHECK(size < strlen(lines[i]) + 2);
            send_bytes(b, packed, size);
        }
        send_bytes(b, packed, fio_meatpack_end(&packer, packed));
        bench_ask(b, "M400\n", 30);
        const char *spaced = "G1 X10.25 Y-3.5 E0.01\nM104 S200\nM117 a?b*c\nG28\nG92 E0\nM400\n";
        const char *tight = strstr(b->log, "G28\n") + 4;
        if (!no_spaces)
            CHECK(!strcmp(tight, spaced));
        else
            CHECK(strstr(tight, "E0.01\n") && strstr(tight, "a?b*c\n") && strstr(tight, "M400\n"));
        fio_state state;
        fio_virtual_printer_state(fio_machine_printer(b->machine), &state);
        CHECK_NEAR(200, state.nozzle_target[0], 0);
        bench_free(b);
    }
}

int main(void) {
    RUN(test_known_bytes);
    RUN(test_what_the_host_packs);
    return check_verdict();
}
