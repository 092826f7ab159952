/* Damage on the wire: what it does, that it is counted, and that everything can be replayed. */
#include "bench.h"

#include "virtual/random.h"

enum { LINES = 400 };

static void command_of(char command[48], int64_t number) {
    snprintf(command, 48, "G1 X%d.%d E0.%03d", (int)(number % 97), (int)(number % 10), (int)number);
}

/* A host of the simplest kind: one line at a time, again on Resend, a new try after silence. Its
 * numbers and checksums are its own. Returns the lines it gave up on. */
static int print_lines(bench *b, int count) {
    int next = 1, tries = 0;

    while (next <= count && tries++ < count * 40) {
        char command[48];
        command_of(command, next);
        const char *heard = bench_ask(b, bench_line(next, command), 0.05);
        int wanted = 0;
        for (const char *p = heard; (p = strstr(p, "Resend: ")); p += 8)
            wanted = atoi(p + 8);
        if (wanted >= 1 && wanted <= next)
            next = wanted;
        else if (strstr(heard, "ok\n"))
            next++;
        else
            bench_ask(b, "\n", 0.05);
    }
    return count - next + 1;
}

static fio_machine_options faulty(uint64_t seed) {
    fio_machine_options options = bench_options();
    options.printer.planner_blocks = 64;
    options.seed = seed;
    return options;
}

/* Whether it is the line of the file that was due. What the firmware does not know does nothing. */
static bool is_due(bench *b, const fio_executed *executed) {
    char command[48];
    if (!executed->known)
        return true;
    command_of(command, executed->number);
    bool right = executed->number == b->number + 1 && !strcmp(executed->text, command);
    if (executed->number > 0)
        b->number = executed->number;
    return right;
}

static void test_single_flips_are_all_noticed(void) {
    for (uint64_t seed = 1; seed <= 8; seed++) {
        fio_machine_options options = faulty(seed);
        options.script = "from line 5 flip in 0.1"; /* not the first lines, which bear no number */
        bench *b = bench_make(options);
        bench_ask(b, "M302 P1\nG28\nM83\nG1 F30000\n", 20);
        b->judge = is_due;
        CHECK_EQUAL(0, print_lines(b, LINES));
        bench_pass(b, 100);
        const fio_machine_counts *counts = fio_machine_count(b->machine);
        CHECK(counts->faults > 20 && counts->resends > 10);
        CHECK_EQUAL(LINES, b->number);
        CHECK_EQUAL(0, b->wrong);
        CHECK(counts->undetectable <= 1); /* a line feed may be damaged to what is passed over */
        bench_free(b);
    }
}

/* XOR misses what flips the same bit twice. Every line executed that should not have been is one
 * that the machine knows of: it may count more than there are, never fewer. */
static void test_undetectable_is_counted(void) {
    int64_t wrong = 0, told = 0;
    for (uint64_t seed = 1; seed <= 40; seed++) {
        fio_machine_options options = faulty(seed);
        options.faults.flip_bytes = 0.02;
        options.faults.lose_bytes_in = 0.02;
        bench *b = bench_make(options);
        bench_ask(b, "M302 P1\nG28\nM83\nG1 F30000\n", 20);
        b->judge = is_due;
        print_lines(b, LINES / 2);
        bench_pass(b, 200);
        int64_t undetectable = fio_machine_count(b->machine)->undetectable;
        CHECK(b->wrong <= undetectable);
        wrong += b->wrong;
        told += undetectable;
        bench_free(b);
    }
    CHECK(wrong > 10 && told < 4 * wrong);
}

static void test_same_seed_same_bytes(void) {
    static char first[BENCH_HEARD];
    for (int round = 0; round < 3; round++) {
        fio_machine_options options = faulty(round < 2 ? 42 : 43);
        options.faults = (fio_machine_faults){.flip_in = 0.05,
                                              .flip_out = 0.05,
                                              .lose_ok = 0.05,
                                              .double_ok = 0.05,
                                              .late_ok = 0.05,
                                              .late_seconds = 0.2,
                                              .lose_bytes_in = 0.05,
                                              .split = 0.2,
                                              .merge = 0.2};
        bench *b = bench_make(options);
        for (int i = 1; i < 200; i++) {
            bench_send(b, bench_line(i, "M105"));
            bench_pass(b, 0.01);
        }
        if (round == 0)
            memcpy(first, b->heard, sizeof first);
        else
            CHECK_EQUAL(round == 1, !strcmp(first, b->heard));
        bench_free(b);
    }
}

/* In whatever pieces the same bytes come at the same times, and however often it is read. */
static void test_pieces_change_nothing(void) {
    static char heard[3][BENCH_HEARD];
    char text[3000] = "M155 S1\n";
    for (int i = 1; i <= 60; i++)
        strcat(text, bench_line(i, i % 9 ? "G1 X10 F6000" : "G1 X0 F3000"));
    for (int way = 0; way < 3; way++) {
        fio_machine_options options = faulty(7);
        options.faults = (fio_machine_faults){.flip_in = 0.1, .flip_out = 0.1, .lose_ok = 0.1};
        bench *b = bench_make(options);
        size_t size = strlen(text);
        for (size_t sent = 0; sent < size;) {
            size_t part = size - sent < 80 ? size - sent : 80;
            for (size_t i = 0; i < part; i += way == 1 ? 1 : part)
                fio_machine_write(b->machine, b->now, text + sent + i, way == 1 ? 1 : part);
            sent += part;
            double until = b->now + 0.05;
            for (int i = 0; way == 2 && i < 500; i++) {
                b->now += 0.0001;
                fio_machine_advance(b->machine, b->now);
                bench_hear(b);
            }
            b->now = until;
            if (way != 1)
                bench_hear(b);
        }
        b->now += 100;
        bench_hear(b);
        memcpy(heard[way], b->heard, sizeof b->heard);
        bench_free(b);
    }
    CHECK(strlen(heard[0]) > 1000);
    CHECK(!strcmp(heard[0], heard[1]));
    CHECK(!strcmp(heard[0], heard[2]));
}

/* How much of each fault there is, against its probability: 2,000 draws, four sigma. */
static void test_frequencies(void) {
    fio_machine_options options = bench_options();
    options.faults = (fio_machine_faults){.lose_ok = 0.2};
    bench *b = bench_make(options);
    int oks = 0;
    for (int i = 0; i < 2000; i++)
        oks += bench_count(bench_ask(b, "G90\n", 0.002), "ok");
    CHECK_NEAR(1600, oks, 4 * sqrt(2000 * 0.2 * 0.8));
    CHECK_EQUAL(2000 - oks, fio_machine_count(b->machine)->faults);
    bench_free(b);
    options.faults = (fio_machine_faults){.double_ok = 0.3};
    b = bench_make(options);
    oks = 0;
    for (int i = 0; i < 2000; i++)
        oks += bench_count(bench_ask(b, "G90\n", 0.002), "ok");
    CHECK_NEAR(2600, oks, 4 * sqrt(2000 * 0.3 * 0.7));
    bench_free(b);
    options.faults = (fio_machine_faults){.flip_out = 0.25};
    b = bench_make(options);
    int whole = 0;
    for (int i = 0; i < 2000; i++)
        whole += !strcmp(bench_ask(b, "M118 abcdefgh\n", 0.002), "abcdefgh\nok\n");
    CHECK_NEAR(2000 * 0.75 * 0.75, whole, 4 * sqrt(2000 * 0.5625 * 0.4375));
    bench_free(b);
}

static void test_split_and_merged_reads(void) {
    fio_machine_options options = bench_options();
    options.faults.split = 1;
    bench *b = bench_make(options);
    bench_send(b, "M118 abcdefgh\n");
    b->now = 1;
    char bytes[64];
    size_t first = fio_machine_read(b->machine, b->now, bytes, sizeof bytes);
    size_t rest = fio_machine_read(b->machine, b->now, bytes + first, sizeof bytes - first);
    CHECK(first >= 1 && first < 12 && first + rest == 12);
    CHECK(!memcmp(bytes, "abcdefgh\nok\n", 12));
    bench_free(b);
    options.faults.split = 0;
    options.faults.merge = 1;
    b = bench_make(options);
    bench_send(b, "G90\n");
    bench_pass(b, 0.005);
    CHECK(!fio_machine_readable(b->machine) && b->used == 0);
    bench_send(b, "G90\n");
    bench_pass(b, 0.02);
    CHECK(!strcmp(b->heard, "ok\nok\n"));
    bench_free(b);
}

/* Any bytes, in any pieces, at any times: it goes on, in bounded work, and still obeys a reset. */
static void test_any_bytes_at_any_time(void) {
    static const char *const names[] = {"marlin", "prusa",    "repetier",      "klipper",
                                        "grbl",   "smoothie", "reprapfirmware"};
    for (uint64_t seed = 1; seed <= 60; seed++) {
        fio_random random = {seed};
        fio_machine_options options = bench_options();
        options.rate = seed % 3 ? 250000 : 0;
        options.firmware = names[seed % 7];
        options.seed = seed;
        options.advanced_ok = seed % 2;
        options.emergency_parser = seed % 5 != 0;
        options.faults = (fio_machine_faults){.flip_in = 0.1,
                                              .flip_out = 0.1,
                                              .lose_ok = 0.1,
                                              .late_ok = 0.1,
                                              .late_seconds = 0.5,
                                              .double_ok = 0.1,
                                              .split = 0.1,
                                              .merge = 0.1,
                                              .lose_bytes_in = 0.1};
        options.script = "every 50 lines reset; every 900 bytes unplug for 0.1; every 7 seconds "
                         "silent 1; at line 33 reject 5; at time 20 heater nozzle dead";
        bench *b = bench_make(options);
        static const char *const seeds[] = {"N1 G1 X10 E1*5\n",
                                            "M28 a.g\n",
                                            "G2 I30 E5\n",
                                            "M104 S250\n",
                                            "M109 S300\n",
                                            "G28\n",
                                            "M112\n",
                                            "M108\n",
                                            "\xff\xff\xfb",
                                            "G4 P50\n",
                                            "M155 S1\n",
                                            "M24\n",
                                            "M0\n",
                                            "$$\n",
                                            "?",
                                            "\x18",
                                            "M29\n",
                                            "M23 a.g\n",
                                            "M20\n",
                                            "M500\n",
                                            "M503\n",
                                            "N-5 M110 N-9*1\n",
                                            "M410\n"};
        for (int i = 0; i < 300; i++) {
            char bytes[64];
            int length = fio_random_below(&random, 20);
            for (int k = 0; k < length; k++)
                bytes[k] = (char)fio_random_next(&random);
            fio_machine_write(b->machine, b->now, bytes, (size_t)length);
            const char *line = seeds[fio_random_below(&random, sizeof seeds / sizeof *seeds)];
            fio_machine_write(b->machine, b->now, line, strlen(line));
            if (fio_random_below(&random, 20) == 0)
                fio_machine_set_lines(b->machine, b->now, i & 1, true);
            b->used = 0;
            bench_pass(b, fio_random_below(&random, 3) ? 0.001 : 2);
        }
        CHECK_EQUAL(fio_machine_count(b->machine)->bytes_out > 0, 1);
        CHECK(fio_machine_finish(b->machine) != FIO_BUG);
        bench_free(b);
    }
}

int main(void) {
    RUN(test_single_flips_are_all_noticed);
    RUN(test_undetectable_is_counted);
    RUN(test_same_seed_same_bytes);
    RUN(test_pieces_change_nothing);
    RUN(test_frequencies);
    RUN(test_split_and_merged_reads);
    RUN(test_any_bytes_at_any_time);
    return check_verdict();
}
