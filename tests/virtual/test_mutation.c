/* Any bytes at all: mutated lines and noise, from a fixed seed. And no memory. */
#include "rig.h"

#include "base/memory.h"

static uint32_t seed = 20240229;

static uint32_t draw(uint32_t below) {
    seed ^= seed << 13;
    seed ^= seed >> 17;
    seed ^= seed << 5;
    return seed % below;
}

static const char *const lines[] = {
    "G1 X100.5 Y20 Z0.3 E1.25 F1800",
    "G0 X1 Y2 F9000 ; travel",
    "G2 X60 Y60 I10 J0 E0.5",
    "G3 X50 Y50 R-10 P2",
    "G28 X Y",
    "G92 E0",
    "G91",
    "G90",
    "M83",
    "M104 S200 T0",
    "M109 R180",
    "M140 S60",
    "M106 S127",
    "M204 P800 T1500",
    "M205 X8 Y8 J0.013",
    "M201 X9000 Y9000",
    "M203 X500 Z12",
    "M220 S95",
    "M221 S100",
    "N12 G1 X5*88",
    "N0 M110 N11*76",
    "M117 any (text) here; and more",
    "M486 A\"part\"",
    "M73 P10 R5",
    "G20",
    "G21",
    "G4 P100",
    "M207 S1.5 F2400",
    "G10",
    "G11",
    "T0",
    "M84",
};

static void swallow(void *context, const char *text, size_t length) {
    *(size_t *)context += length;
    CHECK(strlen(text) == length && !memchr(text, '\n', length));
}

static size_t mutate(char *text, size_t length, size_t capacity) {
    for (uint32_t n = draw(4); n > 0; n--) {
        uint32_t at = length ? draw((uint32_t)length) : 0;
        switch (draw(5)) {
        case 0:
            if (length)
                text[at] = (char)draw(256);
            break;
        case 1:
            if (length)
                text[at] ^= (char)(1u << draw(8));
            break;
        case 2: /* a piece doubled */
            if (length && 2 * length - at < capacity) {
                memmove(text + length, text + at, length - at);
                length += length - at;
            }
            break;
        case 3: /* a piece lost */
            length = at;
            break;
        default:
            if (length + 1 < capacity) {
                memmove(text + at + 1, text + at, length - at);
                text[at] = "0123456789.-+ XYZEFIJRSPTNGM*;()"[draw(32)];
                length++;
            }
        }
    }
    return length;
}

static size_t noise(char *text, size_t capacity) {
    size_t length = draw((uint32_t)capacity);
    for (size_t i = 0; i < length; i++)
        text[i] = (char)draw(256);
    return length;
}

static void expect_sane(const fio_virtual_printer *printer) {
    fio_state state = rig_state(printer);
    const fio_statistics *statistics = rig_statistics(printer);
    CHECK(isfinite(state.time) && isfinite(state.nozzle[0]) && isfinite(state.bed));
    for (int i = 0; i < 4; i++)
        CHECK(isfinite(state.position[i]));
    for (int i = 0; i < 3;
         i++) /* no line above is one M211 away from switching the end stops off */
        CHECK(state.machine[i] >= -1e-6 && state.machine[i] <= 250 + 1e-6);
    CHECK(state.nozzle[0] <= 285 && state.bed <= 120);
    CHECK(isfinite(statistics->filament) && statistics->filament >= 0);
    int64_t sum = 0;
    for (int i = 0; i < FIO_EVENT_CODES; i++)
        sum += statistics->count[i];
    CHECK_EQUAL(sum, statistics->fault_count + statistics->warning_count);
    CHECK(statistics->commands + statistics->rejected_lines <= statistics->lines);
}

static double run_round(void) {
    fio_virtual_printer *printer = rig_make(NULL, NULL);
    rig_run(printer, "G28\nM109 S200");
    size_t answered = 0;
    for (int i = 0; i < 1500 && !rig_state(printer).halted; i++) {
        char text[300];
        const char *line = lines[draw(sizeof lines / sizeof *lines)];
        size_t length = mutate(memcpy(text, line, strlen(line) + 1), strlen(line), sizeof text);
        if (draw(20) == 0)
            length = noise(text, sizeof text);
        char *exact = malloc(length ? length : 1); /* so that reading past its end is seen */
        memcpy(exact, text, length);
        fio_status status = fio_virtual_printer_execute(printer, exact, length, swallow, &answered);
        CHECK(status == FIO_OK || status == FIO_REJECTED);
        free(exact);
    }
    fio_status verdict = fio_virtual_printer_finish(printer);
    CHECK(verdict == FIO_OK || verdict == FIO_FAULTY);
    expect_sane(printer);
    double time = rig_state(printer).time + (double)answered;
    fio_virtual_printer_free(printer);
    return time;
}

static void test_mutated_lines(void) {
    for (int i = 0; i < 60; i++)
        run_round();
}

static void test_same_seed_same_result(void) {
    seed = 99;
    double first = run_round();
    seed = 99;
    CHECK(first == run_round());
}

static void test_no_memory(void) {
    fio_virtual_printer *printer = (fio_virtual_printer *)&seed;
    fio_fail_allocation_after(0);
    CHECK_EQUAL(FIO_NO_MEMORY, fio_virtual_printer_create(&printer, NULL, NULL));
    CHECK(!printer);
    fio_fail_allocation_after(1); /* one block is all it takes, however long the print */
    CHECK_EQUAL(FIO_OK, fio_virtual_printer_create(&printer, NULL, NULL));
    rig_run(printer, "G28\nM109 S200\nG1 X50 E1 F600\nG2 I10 E2\n");
    CHECK_EQUAL(FIO_FAULTY, fio_virtual_printer_finish(printer));
    fio_virtual_printer_free(printer);
    fio_fail_allocation_after(-1);
    fio_virtual_printer_free(NULL);
}

int main(void) {
    RUN(test_mutated_lines);
    RUN(test_same_seed_same_result);
    RUN(test_no_memory);
    return check_verdict();
}
