/* Every kind of fault and warning, the line it names, and what the printer does about it. */
#include "rig.h"

#define READY "G28\nM109 S200\nM83\nG1 X50 Y50 Z1 F3000\n" /* 4 lines */

typedef struct scene {
    fio_event_code code;
    int64_t line; /* of the first such event */
    int count;
    const char *text;
} scene;

static const fio_event *first_of(const fio_virtual_printer *printer, fio_event_code code) {
    const fio_event *event;
    for (int64_t i = 0; (event = fio_virtual_printer_fault(printer, i)); i++)
        if (event->code == code)
            return event;
    for (int64_t i = 0; (event = fio_virtual_printer_warning(printer, i)); i++)
        if (event->code == code)
            return event;
    return NULL;
}

static const char long_move[] =
    READY "G1 X51                                                                              "
          "                    Y52\n";
static const char long_message[] =
    READY "M117 12345678901234567890123456789012345678901234567890123456789012345678901234567890"
          "123456789012345678901234567890\n";

static const scene scenes[] = {
    {FIO_FAULT_OUTSIDE, 5, 2, READY "G1 X250.1\nG1 X100\nG1 Y-1\nG1 Y210\nG1 X250"},
    {FIO_FAULT_OUTSIDE, 5, 1, READY "G1 Z300"},
    {FIO_FAULT_OUTSIDE, 5, 1, READY "G2 I-60 ; half of it is outside, but it is one fault"},
    {FIO_FAULT_OUTSIDE, 6, 1, READY "M211 S0\nG1 X-5"},
    {FIO_FAULT_NOT_HOMED, 1, 2, "G1 X5 F3000\nG28 X\nG1 X6\nG1 Z4"},
    {FIO_FAULT_NOT_HOMED, 6, 1, READY "M84\nG1 X6"},
    {FIO_FAULT_NOT_HOMED, 1, 1, "G29"},
    {FIO_FAULT_COLD_EXTRUSION, 2, 2, "G28\nG1 X5 E1 F600\nG1 E-1"},
    {FIO_FAULT_COLD_EXTRUSION, 3, 1, "G28\nM109 S169\nG1 X5 E1 F600"},
    {FIO_FAULT_LONG_EXTRUSION, 5, 1, READY "G1 X60 E201"},
    {FIO_FAULT_LONG_EXTRUSION, 6, 1, READY "M82\nG1 E-201"},
    {FIO_FAULT_NO_FEEDRATE, 4, 1, "G28\nM109 S200\nM83\nG1 X5 E0.1\nG1 X9 E0.1 F600"},
    {FIO_FAULT_BAD_FEEDRATE, 5, 3, READY "G1 X5 F0\nG1 F-3\nG0 F0"},
    {FIO_FAULT_BAD_ARC, 5, 1, READY "G2 X60 Y60"},
    {FIO_FAULT_BAD_ARC, 5, 1, READY "G2 X60 Y60 I3 J1"},
    {FIO_FAULT_BAD_ARC, 5, 1, READY "G2 X60 Y60 R2"},
    {FIO_FAULT_BAD_ARC, 5, 1, READY "G3 R10"},
    {FIO_FAULT_BAD_ARC, 5, 1, READY "G3 X60 I0 J0"},
    {FIO_FAULT_BAD_ARC, 5, 1, READY "G3 X60 I5 J999999999"},
    {FIO_FAULT_BAD_WORD, 5, 1, READY "G1 X"},
    {FIO_FAULT_BAD_WORD, 5, 1, READY "G1 Xnan Y20"},
    {FIO_FAULT_BAD_WORD, 5, 1, READY "G1 Yinf"},
    {FIO_FAULT_BAD_WORD, 5, 1, READY "G1 X1000000000000000000000000"},
    {FIO_FAULT_BAD_WORD, 5, 1, READY "G1 X5 #3"},
    {FIO_FAULT_BAD_WORD, 5, 1, READY "G1 X--5"},
    {FIO_FAULT_BAD_WORD, 5, 1, READY "G92 E"},
    {FIO_FAULT_BAD_WORD, 5, 1, READY "M104 S"},
    {FIO_FAULT_BAD_SETTING, 1, 6, "M204 S0\nM201 X-1\nM203 E0\nM220 S0\nM221 S-5\nM205 J0"},
    {FIO_FAULT_BAD_SETTING, 1, 2, "M205 S-1\nM204 P"},
    {FIO_FAULT_TEMPERATURE, 1, 3, "M104 S300\nM140 S121\nM104 S-1\nM104 S0\nM140 S0"},
    {FIO_FAULT_TEMPERATURE, 1, 1, "M109 R10\nM104 S0"},
    {FIO_FAULT_BAD_TOOL, 2, 2, "T0\nT1\nM104 T3 S200"},
    {FIO_FAULT_LINE_TOO_LONG, 5, 1, long_move},
    {FIO_FAULT_LINE_LOST, 2, 1, "G28\nN1 G28*0\nN1 G28*1"},
    {FIO_FAULT_HALTED, 1, 3, "M112\nG28\nG1 X5"},
    {FIO_FAULT_HEATER_LEFT_ON, 0, 2, "M104 S200\nM140 S60"},
    {FIO_FAULT_HEATER_LEFT_ON, 0, 1, "M140 S60"},
    {FIO_WARNING_UNKNOWN_COMMAND, 1, 3, "M9999\nG77\nhello\nM117 hello"},
    {FIO_WARNING_RETRACTED, 6, 1, READY "G1 E-1\nG1 X100 E2\nG1 X50 E1"},
    {FIO_WARNING_OVERPRIMED, 7, 1, READY "G1 E3\nG1 X100 E2\nG1 E1\nG1 E-1\nG1 E1.005"},
    {FIO_WARNING_FLOW, 5, 1, READY "G1 X100 E10 F6000\nG1 X50 E1.5"},
    {FIO_WARNING_TEXT_CUT, 5, 1, long_message},
    {FIO_WARNING_FAN_LEFT_ON, 0, 1, "M106 S255"},
};

static void test_every_kind(void) {
    int seen[FIO_EVENT_CODES] = {0};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        const scene *s = &scenes[i];
        fio_virtual_printer *printer = rig_after(s->text);
        fio_status verdict = fio_virtual_printer_finish(printer);
        const fio_statistics *statistics = rig_statistics(printer);
        CHECK_EQUAL(statistics->fault_count ? FIO_FAULTY : FIO_OK, verdict);
        bool good = CHECK_EQUAL(s->count, statistics->count[s->code]);
        const fio_event *event = first_of(printer, s->code);
        good = CHECK(event) && CHECK_EQUAL(s->line, event->line) && good;
        if (!good)
            fprintf(stderr, "    %s in: %s\n", fio_event_name(s->code), s->text);
        /* Nothing else is wrong with it, but for what is on at the end. */
        for (int code = 0; code < FIO_EVENT_CODES; code++)
            if (code != (int)s->code && code != FIO_FAULT_HEATER_LEFT_ON)
                if (!CHECK_EQUAL(0, statistics->count[code]))
                    fprintf(stderr, "    %s in: %s\n", fio_event_name(code), s->text);
        seen[s->code] = 1;
        fio_virtual_printer_free(printer);
    }
    for (int code = 0; code < FIO_EVENT_CODES; code++)
        CHECK(seen[code] && strlen(fio_event_name(code)) > 3);
}

static void test_clean_print_has_none(void) {
    fio_virtual_printer *printer = rig_after(
        "M140 S60\nM104 S200\nG28\nM190 S60\nM109 S200\nM107\nG92 E0\nG1 Z0.2 F600\n"
        "G1 X20 Y20 F6000\nG1 X60 E2 F1200\nG1 E1.2 F2400\nG1 X20 Y30 F6000\nG1 E2 F2400\n"
        "M106 S255\nG1 X60 E4 F1200\nG1 E3 F2400\nM104 S0\nM140 S0\nM107\nG1 Z10\nM84\n");
    CHECK_EQUAL(FIO_OK, fio_virtual_printer_finish(printer));
    CHECK_EQUAL(0, rig_statistics(printer)->warning_count);
    fio_virtual_printer_free(printer);
}

/* A micrometre with as much plastic as rounding makes of it says nothing of the flow. */
static void test_flow_of_paths_that_are_rounding(void) {
    fio_virtual_printer *printer =
        rig_after(READY "G1 X100 Y0 E2 F6000\nG1 X100.001 E.0001\nG1 X100.03 E.003");
    CHECK_EQUAL(1, rig_statistics(printer)->count[FIO_WARNING_FLOW]);
    CHECK_NEAR(100 * 2.405 * 0.003 / 0.029, rig_statistics(printer)->highest_flow, 0.05);
    fio_virtual_printer_free(printer);
}

static void test_what_is_done_about_them(void) {
    fio_virtual_printer *printer =
        rig_after(READY "G1 X999 Y-3\nG1 Z5 E300\nG2 X1 Y1\nM104 S999\nM204 P0\nG1 F0");
    fio_state state = rig_state(printer);
    CHECK_NEAR(250, state.machine[0], 0); /* clamped */
    CHECK_NEAR(0, state.machine[1], 0);
    CHECK_NEAR(5, state.machine[2], 0); /* moved, but E was prevented */
    CHECK_NEAR(0, rig_statistics(printer)->filament, 0);
    CHECK_NEAR(285, state.nozzle_target[0], 0);
    CHECK_NEAR(1500, state.acceleration[0], 0);
    CHECK_NEAR(50, state.feedrate, 1e-12);
    rig_run(printer, "M211 S0\nG1 X260");
    CHECK_NEAR(260, rig_state(printer).machine[0], 0);
    fio_virtual_printer_free(printer);
    printer = rig_after("M302 P1\nG28\nG1 X5 E1 F600");
    CHECK_EQUAL(0, rig_statistics(printer)->fault_count);
    CHECK_NEAR(1, rig_statistics(printer)->filament, 0);
    fio_virtual_printer_free(printer);
}

static void test_all_counted_a_hundred_kept(void) {
    fio_virtual_printer *printer = rig_after("G28");
    for (int i = 0; i < 150; i++)
        rig_run(printer, i % 2 ? "G1 X-1 Y-1 F600" : "M12345");
    rig_run(printer, "G1 X-1 X-2 Y-3 F6");
    for (int i = 0; i < 100; i++)
        rig_run(printer, "G1 X-1\nM12345");
    const fio_statistics *statistics = rig_statistics(printer);
    CHECK_EQUAL(176, statistics->fault_count);
    CHECK_EQUAL(175, statistics->warning_count);
    CHECK(fio_virtual_printer_fault(printer, 99) && fio_virtual_printer_warning(printer, 99));
    CHECK(!fio_virtual_printer_fault(printer, 100) && !fio_virtual_printer_warning(printer, -1));
    CHECK_EQUAL(3, fio_virtual_printer_fault(printer, 0)->line);
    CHECK_EQUAL(2, fio_virtual_printer_warning(printer, 0)->line);
    CHECK_EQUAL(FIO_FAULTY, fio_virtual_printer_finish(printer));
    CHECK(strstr(fio_error_message(), "176 faults, the first in line 3: outside"));
    fio_virtual_printer_free(printer);
}

int main(void) {
    RUN(test_every_kind);
    RUN(test_clean_print_has_none);
    RUN(test_flow_of_paths_that_are_rounding);
    RUN(test_what_is_done_about_them);
    RUN(test_all_counted_a_hundred_kept);
    return check_verdict();
}
