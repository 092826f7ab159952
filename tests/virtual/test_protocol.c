/* What the printer answers, word by word as Marlin's bugfix-2.1 does. */
#include "rig.h"

static char answers[4096];

static void collect(void *context, const char *text, size_t length) {
    (void)context;
    size_t used = strlen(answers);
    snprintf(answers + used, sizeof answers - used, "%.*s\n", (int)length, text);
}

static void expect(fio_virtual_printer *printer, const char *line, fio_status status,
                   const char *expected) {
    answers[0] = 0;
    CHECK_EQUAL(status, fio_virtual_printer_execute(printer, line, strlen(line), collect, NULL));
    if (!CHECK(!strcmp(expected, answers)))
        fprintf(stderr, "    %s was answered by:\n%s", line, answers);
}

static void test_ok_and_silence(void) {
    fio_virtual_printer *printer = rig_make(NULL, NULL);
    expect(printer, "G90\n", FIO_OK, "ok\n");
    expect(printer, "; a comment\n", FIO_OK, "");
    expect(printer, "\r\n", FIO_OK, "");
    expect(printer, "", FIO_OK, "");
    expect(printer, "M999 X1 ; odd", FIO_OK, "echo:Unknown command: \"M999 X1\"\nok\n");
    expect(printer, "X10 Y10", FIO_OK, "echo:Unknown command: \"X10 Y10\"\nok\n");
    expect(printer, "G", FIO_OK, "echo:Unknown command: \"G\"\nok\n");
    expect(printer, "G28.5", FIO_OK, "echo:Unknown command: \"G28.5\"\nok\n");
    expect(printer, "M118 hello there", FIO_OK, "hello there\nok\n");
    expect(printer, "T3", FIO_OK, "echo:Invalid extruder\nok\n");
    CHECK_EQUAL(4, rig_statistics(printer)->unknown_commands);
    fio_virtual_printer_free(printer);
}

static void test_reports(void) {
    fio_virtual_printer *printer = rig_make(NULL, NULL);
    expect(printer, "M105", FIO_OK, "ok T:20.00 /0.00 B:20.00 /0.00 @:0 B@:0\n");
    rig_run(printer, "M190 S60\nM109 S200\nG28\nG1 X10.5 Y2 Z.3 E1 F600\nG92 X0");
    expect(printer, "M105", FIO_OK, "ok T:200.00 /200.00 B:60.00 /60.00 @:0 B@:0\n");
    expect(printer, "M114", FIO_OK, "X:0.00 Y:2.00 Z:0.30 E:1.00 Count X:840 Y:160 Z:120\nok\n");
    answers[0] = 0;
    CHECK_EQUAL(FIO_OK, fio_virtual_printer_execute(printer, "M115", 4, collect, NULL));
    CHECK(!strncmp(answers, "FIRMWARE_NAME:Marlin", 20) && strstr(answers, "\nok\n"));
    fio_virtual_printer_free(printer);
}

static void test_checksums(void) {
    fio_virtual_printer *printer = rig_make(NULL, NULL);
    expect(printer, "N0 M110 N0*125", FIO_OK, "ok\n"); /* as OctoPrint greets */
    expect(printer, rig_numbered(1, "G28"), FIO_OK, "ok\n");
    expect(printer, "N2 G1 X10*1", FIO_REJECTED,
           "Error:checksum mismatch, Last Line: 1\nResend: 2\nok\n");
    expect(printer, "N2 G1 X10", FIO_REJECTED,
           "Error:No Checksum with line number, Last Line: 1\nResend: 2\nok\n");
    expect(printer, rig_numbered(5, "G1 X10"), FIO_REJECTED,
           "Error:Line Number is not Last Line Number+1, Last Line: 1\nResend: 2\nok\n");
    CHECK_NEAR(0, rig_state(printer).position[0], 0);
    expect(printer, rig_numbered(2, "G1 X10 F3000"), FIO_OK, "ok\n");
    CHECK_NEAR(10, rig_state(printer).position[0], 0);
    expect(printer, rig_numbered(2, "G91"), FIO_OK, ""); /* sent twice: dropped without an ok */
    expect(printer, rig_numbered(1, "G91"), FIO_OK, "");
    CHECK(rig_state(printer).absolute);
    expect(printer, rig_numbered(0, "G91"), FIO_REJECTED,
           "Error:Line Number is not Last Line Number+1, Last Line: 2\nResend: 3\nok\n");
    expect(printer, rig_numbered(700, "M110 N41"), FIO_OK, "ok\n"); /* its second N wins */
    expect(printer, rig_numbered(42, "M117 a*b"), FIO_OK, "ok\n");  /* the last * counts */
    expect(printer, "G1 X12*7", FIO_OK, "ok\n");                    /* no N: cut off, not checked */
    expect(printer, rig_numbered(43, "G1 X14 "), FIO_OK, "ok\n");
    expect(printer, "N44 G1 X15*", FIO_REJECTED,
           "Error:checksum mismatch, Last Line: 43\nResend: 44\nok\n");
    expect(printer, rig_numbered(44, ""), FIO_OK, "ok\n");
    CHECK_NEAR(14, rig_state(printer).position[0], 0);
    CHECK_EQUAL(5, rig_statistics(printer)->rejected_lines);
    CHECK_EQUAL(2, rig_statistics(printer)->duplicate_lines);
    CHECK_EQUAL(44, rig_state(printer).line_number);
    CHECK_EQUAL(FIO_OK, fio_virtual_printer_finish(printer)); /* all was sent again */
    fio_virtual_printer_free(printer);
}

static void test_emergency_stop(void) {
    fio_virtual_printer *printer = rig_after("M104 S200\nM140 S60\nM106\n");
    expect(printer, "M112", FIO_OK,
           "echo:M112 Shutdown\nError:Printer halted. kill() called!\n//action:poweroff\n");
    expect(printer, "G28", FIO_REJECTED, "");
    expect(printer, "M105", FIO_REJECTED, "");
    fio_state state = rig_state(printer);
    CHECK(state.halted && state.nozzle_target[0] == 0 && state.bed_target == 0 && state.fan == 0);
    CHECK_EQUAL(FIO_FAULTY, fio_virtual_printer_finish(printer));
    CHECK_EQUAL(3, rig_statistics(printer)->count[FIO_FAULT_HALTED]);
    CHECK_EQUAL(FIO_USAGE, fio_virtual_printer_finish(printer));
    CHECK_EQUAL(FIO_USAGE, fio_virtual_printer_execute(printer, "G28", 3, NULL, NULL));
    fio_virtual_printer_free(printer);
}

int main(void) {
    RUN(test_ok_and_silence);
    RUN(test_reports);
    RUN(test_checksums);
    RUN(test_emergency_stop);
    return check_verdict();
}
