/* The transport to a machine in memory: virtual, real and accelerated time. */
#include "bench.h"

#include "base/memory.h"

#include <poll.h>
#include <time.h>
#include <unistd.h>

static fio_machine *make(fio_machine_options options) {
    fio_machine *machine = NULL;
    CHECK_EQUAL(FIO_OK, fio_machine_create(&machine, &options));
    return machine;
}

static fio_transport *open_at(fio_machine *machine, double start, double speed) {
    fio_transport *transport = NULL;
    CHECK_EQUAL(FIO_OK, fio_machine_transport(&transport, machine, start, speed));
    return transport;
}

static void put(fio_transport *transport, const char *text) {
    size_t taken = 0;
    CHECK_EQUAL(FIO_OK, fio_transport_write(transport, text, strlen(text), &taken));
    CHECK_EQUAL(strlen(text), taken);
}

/* Wait for the first bytes, at most `seconds`. */
static size_t hear(fio_transport *transport, double seconds, char *text, size_t capacity) {
    size_t count = 0;
    double end = fio_transport_now(transport) + seconds;
    while (count == 0 && fio_transport_now(transport) < end) {
        double left = end - fio_transport_now(transport);
        if (fio_transport_wait(transport, false, NULL, 0, left) != FIO_OK)
            break;
        if (fio_transport_read(transport, text, capacity - 1, &count) != FIO_OK)
            break;
    }
    text[count] = 0;
    return count;
}

static void test_virtual_time_jumps(void) {
    fio_machine_options options = bench_options();
    options.rate = 9600;
    fio_machine *machine = make(options);
    fio_transport *t = open_at(machine, 5, 0);
    char text[64];
    CHECK_NEAR(5, fio_transport_now(t), 0);
    put(t, "G4 S1000\n");
    CHECK_EQUAL(9, fio_transport_pending(t));
    CHECK_NEAR(5, fio_transport_now(t), 0);                       /* only wait() lets time pass */
    CHECK_EQUAL(FIO_OK, fio_transport_wait(t, true, NULL, 0, 1)); /* there is room */
    CHECK_NEAR(5, fio_transport_now(t), 0);
    clock_t before = clock();
    CHECK(hear(t, 2.5, text, sizeof text) > 0 && !strcmp(text, "echo:busy: processing\n"));
    /* 9 bytes there, 0.3 ms of work, 2 s, 22 bytes back */
    CHECK_NEAR(5 + 90 / 9600. + 0.0003 + 2 + 220 / 9600., fio_transport_now(t), 1e-9);
    while (hear(t, 2000, text, sizeof text) > 0 && strcmp(text, "ok\n"))
        ;
    CHECK_NEAR(5 + 90 / 9600. + 0.0003 + 1000 + 30 / 9600., fio_transport_now(t), 1e-6);
    CHECK_EQUAL(0, hear(t, 50, text, sizeof text));
    CHECK((double)(clock() - before) / CLOCKS_PER_SEC < 1);
    fio_transport_close(t);
    fio_machine_free(machine);
}

static void test_back_pressure(void) {
    fio_machine *machine = make(bench_options());
    fio_transport *t = open_at(machine, 0, 0);
    char text[3000];
    memset(text, ';', sizeof text);
    size_t taken = 0, kept = 7;
    CHECK_EQUAL(FIO_OK, fio_transport_write(t, text, sizeof text, &taken));
    CHECK_EQUAL(FIO_MACHINE_LINE_BYTES, taken); /* an emergency stop has little in front of it */
    CHECK_EQUAL(taken, fio_transport_pending(t));
    size_t more = 1;
    CHECK_EQUAL(FIO_OK, fio_transport_write(t, text, sizeof text, &more));
    CHECK_EQUAL(0, more);
    CHECK_EQUAL(FIO_OK, fio_transport_wait(t, true, NULL, 0, 5));
    CHECK(fio_transport_now(t) < FIO_MACHINE_LINE_BYTES * 10 / 250000.);
    CHECK_EQUAL(FIO_OK, fio_transport_discard(t, &kept));
    CHECK_EQUAL(0, fio_transport_pending(t));
    put(t, "\nM105\n");
    CHECK(hear(t, 1, text, 100) > 0);
    fio_transport_close(t);
    fio_machine_free(machine);
}

static void test_loss_is_told_after_the_last_bytes(void) {
    fio_machine_options options = bench_options();
    options.script = "at time 3 unplug";
    fio_machine *machine = make(options);
    fio_transport *t = open_at(machine, 0, 0), *again = NULL;
    char text[64];
    size_t count;
    put(t, "G90\n");
    CHECK_EQUAL(FIO_OK, fio_transport_wait(t, false, NULL, 0, 1));
    fio_machine_advance(machine, 3.5);
    CHECK_EQUAL(FIO_OK, fio_transport_read(t, text, sizeof text, &count));
    CHECK(count == 3 && !memcmp(text, "ok\n", 3));
    for (int i = 0; i < 3; i++) {
        CHECK_EQUAL(FIO_LINK_LOST, fio_transport_read(t, text, sizeof text, &count));
        CHECK_EQUAL(FIO_LINK_LOST, fio_transport_write(t, "G90\n", 4, &count));
        CHECK_EQUAL(FIO_LINK_LOST, fio_transport_wait(t, true, NULL, 0, 1));
        CHECK(strstr(fio_error_message(), "unplugged"));
    }
    CHECK_EQUAL(FIO_NO_PRINTER, fio_machine_transport(&again, machine, 4, 0));
    fio_machine_plug(machine, 5);
    CHECK_EQUAL(FIO_LINK_LOST, fio_transport_read(t, text, sizeof text, &count)); /* for good */
    fio_transport_close(t);
    t = open_at(machine, 6, 0);
    put(t, "G90\n");
    CHECK_EQUAL(3, hear(t, 1, text, sizeof text));
    fio_transport_close(t);
    fio_machine_free(machine);
}

static void test_opening_resets(void) {
    fio_machine_options options = bench_options();
    options.reset_on_dtr = true;
    options.boot_seconds = 1.5;
    fio_machine *machine = make(options);
    fio_transport *t = open_at(machine, 10, 0);
    char text[64];
    CHECK(hear(t, 5, text, sizeof text) > 0 && !strncmp(text, "start\n", 6));
    CHECK_NEAR(11.5 + 60 / 250000., fio_transport_now(t), 1e-9);
    CHECK_EQUAL(FIO_OK, t->type->set_lines(t, false, false));
    CHECK_EQUAL(FIO_OK, t->type->set_lines(t, true, true));
    CHECK_EQUAL(2, fio_machine_count(machine)->resets);
    fio_transport_close(t);
    fio_machine_free(machine);

    options.reset_on_dtr = false;
    options.mute_without_dtr = true;
    machine = make(options);
    t = open_at(machine, 0, 0);
    CHECK_EQUAL(FIO_OK, t->type->set_lines(t, false, false));
    put(t, "G90\n");
    CHECK_EQUAL(0, hear(t, 1, text, sizeof text));
    CHECK_EQUAL(FIO_OK, t->type->set_lines(t, true, false));
    put(t, "G90\n");
    CHECK_EQUAL(3, hear(t, 1, text, sizeof text));
    fio_transport_close(t);
    fio_machine_free(machine);
}

static void test_further_descriptors(void) {
    int ends[2];
    CHECK_EQUAL(0, pipe(ends));
    for (int speed = 0; speed < 2; speed++) {
        fio_machine *machine = make(bench_options());
        fio_transport *t = open_at(machine, 0, speed);
        struct pollfd other = {ends[0], POLLIN, 0};
        CHECK_EQUAL(FIO_OK, fio_transport_wait(t, false, &other, 1, 0.01));
        CHECK_EQUAL(0, other.revents);
        CHECK_EQUAL(1, write(ends[1], "x", 1));
        CHECK_EQUAL(FIO_OK, fio_transport_wait(t, false, &other, 1, 100)); /* at once */
        CHECK_EQUAL(POLLIN, other.revents);
        char byte;
        CHECK_EQUAL(1, read(ends[0], &byte, 1));
        fio_transport_close(t);
        fio_machine_free(machine);
    }
    close(ends[0]);
    close(ends[1]);
}

/* A dwell of 50 s at 1,000 times the speed takes 50 ms of ours, at least. */
static void test_accelerated_time(void) {
    fio_machine *machine = make(bench_options());
    fio_transport *t = open_at(machine, 0, 1000);
    struct timespec start, end;
    char text[64];
    clock_gettime(CLOCK_MONOTONIC, &start);
    put(t, "M113 S0\n");
    CHECK(hear(t, 1000, text, sizeof text) > 0);
    put(t, "G4 S50\n");
    CHECK(hear(t, 1e6, text, sizeof text) > 0 && !strcmp(text, "ok\n"));
    clock_gettime(CLOCK_MONOTONIC, &end);
    double seconds =
        (double)(end.tv_sec - start.tv_sec) + (double)(end.tv_nsec - start.tv_nsec) * 1e-9;
    CHECK(seconds >= 0.049 && seconds < 10);
    CHECK(fio_transport_now(t) >= 50);
    fio_transport_close(t);
    fio_machine_free(machine);
}

static void test_no_memory(void) {
    fio_machine_options options = bench_options();
    fio_machine *machine = NULL;
    for (int n = 0; n < 2; n++) {
        fio_fail_allocation_after(n);
        CHECK_EQUAL(FIO_NO_MEMORY, fio_machine_create(&machine, &options));
        CHECK(!machine);
    }
    fio_fail_allocation_after(-1);
    machine = make(options);
    fio_transport *transport = NULL;
    fio_fail_allocation_after(0);
    /* Nothing else allocates, whatever happens. */
    CHECK_EQUAL(FIO_NO_MEMORY, fio_machine_transport(&transport, machine, 0, 0));
    CHECK(!transport);
    char text[100];
    CHECK_EQUAL(5, fio_machine_write(machine, 1, "M115\n", 5));
    CHECK(fio_machine_read(machine, 2, text, sizeof text) == sizeof text);
    fio_fail_allocation_after(-1);
    fio_machine_free(machine);
    fio_machine_free(NULL);
}

static void expect_usage(fio_machine_options options, const char *words) {
    fio_machine *machine = NULL;
    CHECK_EQUAL(FIO_USAGE, fio_machine_create(&machine, &options));
    CHECK(!machine);
    if (!CHECK(strstr(fio_error_message(), words)))
        fprintf(stderr, "    %s\n", fio_error_message());
}

static void test_options_out_of_range(void) {
    fio_machine_options options = bench_options();
    options.rate = 299;
    expect_usage(options, "a rate of 299 bits/s");
    options = bench_options();
    options.receive_bytes = 15;
    expect_usage(options, "a receive buffer of 15 bytes: 16 to 4096");
    options = bench_options();
    options.command_slots = 65;
    expect_usage(options, "65 commands in the queue: 1 to 64");
    options = bench_options();
    options.line_seconds = NAN;
    expect_usage(options, "times of a machine");
    options = bench_options();
    options.faults.merge = 1.01;
    expect_usage(options, "a fault's probability is 0 to 1, not 1.01");
    options = bench_options();
    options.script = "at";
    expect_usage(options, "script, line 1, column 3: time, line");
    options = bench_options();
    options.printer.tools = 99;
    expect_usage(options, "1 to 8 tools");
    fio_machine *machine = make(bench_options());
    fio_transport *transport;
    CHECK_EQUAL(FIO_USAGE, fio_machine_transport(&transport, machine, 0, -1));
    CHECK_EQUAL(FIO_USAGE, fio_machine_transport(&transport, machine, INFINITY, 0));
    fio_machine_free(machine);
}

static void test_what_is_under_way(void) {
    fio_machine *machine = make(bench_options());
    char text[64];
    CHECK(!fio_machine_working(machine));
    CHECK_EQUAL(FIO_MACHINE_LINE_BYTES, fio_machine_room(machine));
    CHECK_EQUAL(8, fio_machine_write(machine, 0, "G4 P100\n", 8));
    CHECK_EQUAL(8, fio_machine_pending(machine));
    CHECK_EQUAL(FIO_MACHINE_LINE_BYTES - 8, fio_machine_room(machine));
    fio_machine_advance(machine, 3.5 * 10 / 250000.);
    CHECK_EQUAL(5, fio_machine_pending(machine));
    CHECK_EQUAL(5, fio_machine_discard(machine, 3.5 * 10 / 250000.)); /* "G4 " had arrived */
    CHECK_EQUAL(4, fio_machine_write(machine, 0.01, "S1\n\n", 4));
    fio_machine_advance(machine, 0.5);
    CHECK(fio_machine_working(machine));
    CHECK_EQUAL(0, fio_machine_read(machine, 0.9, text, sizeof text));
    CHECK_EQUAL(3, fio_machine_read(machine, 1.1, text, sizeof text));
    CHECK(!fio_machine_working(machine));
    CHECK_EQUAL(1, fio_machine_count(machine)->undetectable); /* two halves of two lines */
    fio_machine_free(machine);
}

int main(void) {
    RUN(test_no_memory);
    RUN(test_options_out_of_range);
    RUN(test_what_is_under_way);
    RUN(test_virtual_time_jumps);
    RUN(test_back_pressure);
    RUN(test_loss_is_told_after_the_last_bytes);
    RUN(test_opening_resets);
    RUN(test_further_descriptors);
    RUN(test_accelerated_time);
    return check_verdict();
}
