/* The other firmwares' ways of speaking, from their sources and logs. */
#include "bench.h"

static bench *speak(const char *firmware) {
    fio_machine_options options = bench_options();
    options.firmware = firmware;
    options.boot_seconds = 0.5;
    options.script = "at time 100 reset";
    return bench_make(options);
}

static const char *boot(bench *b) {
    bench_pass(b, 99 - b->now);
    return bench_ask(b, "", 1.6);
}

static void test_prusa(void) {
    bench *b = speak("prusa");
    CHECK(strstr(bench_ask(b, "M115\n", 0.5), "FIRMWARE_NAME:Prusa-Firmware 3."));
    bench_ask(b, bench_line(1, "G90"), 0.1);
    /* As Marlin 1.0: a line it has just had is not passed over. */
    bench_expect(b, bench_line(1, "G90"), 0.1,
                 "Error:Line Number is not Last Line Number+1, Last Line: 1\nResend: 2\nok\n");
    CHECK_EQUAL(2, bench_count(bench_ask(b, "G4 S5\n", 4.5), "echo:busy: processing\n"));
    bench_pass(b, 1);
    bench_ask(b, "G4 S5\nG4 S5\nG4 S5\nG4 S5\n", 1); /* M112 has to wait for a place */
    CHECK(!strstr(bench_ask(b, "M112\n", 3), "halted"));
    CHECK(strstr(bench_ask(b, "", 20), "halted"));
    CHECK(!strncmp(boot(b), "start\necho: 3.", 14));
    bench_free(b);
}

static void test_repetier(void) {
    bench *b = speak("repetier");
    CHECK_EQUAL(4, bench_count(bench_ask(b, "", 4.5), "wait\n"));
    bench_expect(b, bench_line(1, "G90"), 0.1, "ok 1\n");
    bench_expect(b, "G90\n", 0.1, "ok\n");
    bench_expect(b, bench_line(2, "M105"), 0.1, "ok 2\nT:20.00 /0.00 B:20.00 /0.00 @:0 B@:0\n");
    bench_expect(b, bench_line(2, "G90"), 0.1, "skip 2\nok 2\n");
    bench_expect(b, bench_line(1, "G90"), 0.1, "skip 1\nok 1\n");
    bench_expect(b, bench_line(9, "G90"), 0.1, "Error:expected line 3 got 9\nResend:3\nok\n");
    bench_expect(b, "N3 G90*1\n", 0.1, "Error:Wrong checksum\nResend:3\nok\n");
    /* Its ok comes when the line was read: as many as there are places. */
    const char *heard = bench_ask(b, "G4 S3\nG4 S3\nG4 S3\n", 0.5);
    CHECK_EQUAL(3, bench_count(heard, "ok\n"));
    CHECK(strstr(bench_ask(b, "M115\n", 20), "FIRMWARE_NAME:Repetier_"));
    CHECK(strstr(boot(b), "start\n"));
    bench_free(b);
}

static void test_klipper(void) {
    bench *b = speak("klipper");
    bench_expect(b, "N17 G90*1\n", 0.1, "ok\n"); /* numbers and checksums mean nothing */
    bench_expect(b, bench_line(3, "G90"), 0.1, "ok\n");
    bench_expect(b, "M105\n", 0.1, "ok B:20.0 /0.0 T0:20.0 /0.0\n");
    CHECK(!strncmp(bench_ask(b, "M115\n", 0.1), "ok FIRMWARE_NAME:Klipper FIRMWARE_VERSION:", 41));
    bench_expect(b, "M999999\n", 0.1, "// Unknown command:\"M999999\"\nok\n");
    bench_expect(b, "G4 S9\n", 8, ""); /* and it says nothing while it works */
    bench_ask(b, "M104 S200\nM140 S60\n", 20);
    bench_expect(b, "TURN_OFF_HEATERS\n", 0.1, "ok\n");
    CHECK(strstr(bench_ask(b, "M105\n", 0.1), "/0.0 T0:") && strstr(b->heard, "/0.0\n"));
    bench_expect(b, "M112\n", 0.1, "// Klipper state: Shutdown\n");
    const char *heard = bench_ask(b, "G28\n", 0.1);
    CHECK(strstr(heard, "// Printer is shutdown\n!! Shutdown due to M112 command\nok\n"));
    bench_free(b);
}

static void test_grbl(void) {
    bench *b = speak("grbl");
    bench_expect(b, "G21\n", 0.1, "ok\n");
    bench_expect(b, "\n", 0.1, "ok\n");
    bench_expect(b, "M105\n", 0.1, "error:20\n");
    bench_expect(b, "?", 0.1, "<Idle|MPos:0.000,0.000,0.000|Bf:15,127|FS:0,0>\n");
    CHECK(strstr(bench_ask(b, "$I\n", 0.1), "[VER:1.1h"));
    bench_expect(b, "$Q\n", 0.1, "error:3\n");
    bench_ask(b, "G91\nG1 X50 F60\n", 0.5);
    CHECK(!strncmp(bench_ask(b, "?", 0.1), "<Run|", 5));
    bench_expect(b, "\x18", 0.1, "\nGrbl 1.1h ['$' for help]\n");
    CHECK(!strncmp(bench_ask(b, "?", 0.1), "<Idle|", 6));
    CHECK(!strncmp(boot(b), "\nGrbl 1.1h ['$' for help]\n", 26));
    bench_free(b);
}

static void test_smoothie(void) {
    bench *b = speak("smoothie");
    CHECK(strstr(bench_ask(b, "M115\n", 0.1), "FIRMWARE_NAME:Smoothieware"));
    bench_expect(b, bench_line(1, "G90"), 0.1, "ok\n");
    bench_expect(b, "N2 G90*1\n", 0.1, "rs N2\n");
    bench_expect(b, bench_line(7, "G90"), 0.1, "rs N2\n");
    bench_expect(b, bench_line(2, "G90"), 0.1, "ok\n");
    CHECK(strstr(bench_ask(b, "M112\n", 0.1), "Emergency Stop Requested"));
    bench_expect(b, "G28\n", 0.1, "!!\n");
    CHECK(!strncmp(boot(b), "Smoothie\nok\n", 12));
    bench_free(b);
}

static void test_reprapfirmware(void) {
    bench *b = speak("reprapfirmware");
    CHECK(strstr(bench_ask(b, "M115\n", 0.1), "FIRMWARE_NAME: RepRapFirmware for Duet"));
    bench_expect(b, bench_line(5, "G90"), 0.1, "ok\n"); /* the order means nothing */
    bench_expect(b, "N3 G90*1\n", 0.1, "");             /* passed over without a word */
    bench_expect(b, bench_line(3, "G90"), 0.1, "ok\n");
    bench_free(b);
}

static void test_no_such_firmware(void) {
    fio_machine *machine;
    fio_machine_options options = bench_options();
    options.firmware = "marlyn";
    CHECK_EQUAL(FIO_USAGE, fio_machine_create(&machine, &options));
    CHECK(!machine && strstr(fio_error_message(), "no firmware \"marlyn\": marlin, prusa"));
    options.firmware = NULL;
    CHECK_EQUAL(FIO_USAGE, fio_machine_create(&machine, &options));
}

int main(void) {
    RUN(test_prusa);
    RUN(test_repetier);
    RUN(test_klipper);
    RUN(test_grbl);
    RUN(test_smoothie);
    RUN(test_reprapfirmware);
    RUN(test_no_such_firmware);
    return check_verdict();
}
