/* The SD card, the settings that stay, and the questions to the user. */
#include "bench.h"

static void upload(bench *b, const char *name, const char *const *lines, int count) {
    char command[64];
    snprintf(command, sizeof command, "M28 %s", name);
    bench_ask(b, "M110 N0\n", 0.1);
    bench_send(b, bench_line(1, command));
    for (int i = 0; i < count; i++)
        CHECK(strstr(bench_ask(b, bench_line(2 + i, lines[i]), 0.1), "ok\n"));
    bench_expect(b, bench_line(2 + count, "M29"), 0.1, "Done saving file.\nok\n");
}

static void test_upload_and_print(void) {
    static const char *const lines[] = {"G28", "M83", "G1 X10 F600", "G4 S1", "M117 done"};
    bench *b = bench_make(bench_options());
    bench_expect(b, "M21\n", 0.1, "echo:SD card ok\nok\n");
    bench_expect(b, "M20\n", 0.1, "Begin file list\nEnd file list\nok\n");
    upload(b, "part.gco", lines, 5);
    CHECK(!strcmp(b->log, "M21\nM20\nM110 N0\nM28 part.gco\n")); /* written, not executed */
    bench_expect(b, "M20\n", 0.1, "Begin file list\npart.gco 36\nEnd file list\nok\n");
    bench_expect(b, "M27\n", 0.1, "Not SD printing\nok\n");
    bench_expect(b, "M23 none.gco\n", 0.1, "open failed, File: none.gco.\nok\n");
    bench_expect(b, "M23 part.gco\n", 0.1, "File opened: part.gco Size: 36\nFile selected\nok\n");
    b->logged = 0;
    const char *heard = bench_ask(b, "M27 S5\nM24\n", 17);
    CHECK_EQUAL(2, bench_count(heard, "ok\n"));
    CHECK_EQUAL(3, bench_count(heard, "SD printing byte "));
    CHECK(strstr(heard, "/36\n"));
    CHECK(strstr(bench_ask(b, "", 10), "Done printing file\n"));
    CHECK(!strcmp(b->log, "M27 S5\nM24\nG28\nM83\nG1 X10 F600\nG4 S1\nM117 done\n"));
    CHECK_EQUAL(0, bench_count(b->heard, "ok\n")); /* its lines get none */
    bench_ask(b, "M27 S0\n", 0.1);
    b->logged = 0;
    bench_ask(b, "M26 S16\nM24\n", 10); /* from the third line on, since the file is still open */
    CHECK(!strcmp(b->log, "M26 S16\nM24\nG4 S1\nM117 done\n") ||
          strstr(b->log, "G4 S1\nM117 done\n"));
    bench_expect(b, "M30 part.gco\n", 0.1, "File deleted:part.gco\nok\n");
    bench_expect(b, "M30 part.gco\n", 0.1, "Deletion failed, File: part.gco.\nok\n");
    bench_free(b);
}

static void test_unnumbered_lines_are_not_written(void) {
    bench *b = bench_make(bench_options());
    bench_expect(b, "M28 a.g\n", 0.1, "Writing to file: a.g\nok\n");
    bench_expect(b, "G28\n", 0.1,
                 "Error:No Checksum with line number, Last Line: 0\nResend: 1\nok\n");
    bench_expect(b, bench_line(1, "G91"), 0.1, "ok\n");
    bench_expect(b, "M29\n", 0.1, "Done saving file.\nok\n");
    bench_expect(b, "M20\n", 0.1, "Begin file list\na.g 4\nEnd file list\nok\n");
    bench_free(b);
}

static void test_pause_and_files_side_by_side(void) {
    static const char *const first[] = {"G4 S2", "G4 S2", "G4 S2", "G4 S2",
                                        "G4 S2", "G4 S2", "G4 S2", "M117 first"};
    static const char *const second[] = {"M117 second"};
    bench *b = bench_make(bench_options());
    upload(b, "a.g", first, 8);
    upload(b, "b.g", second, 1);
    upload(b, "a.g", first, 8); /* once more: the old one goes */
    CHECK(!strcmp(bench_ask(b, "M20\n", 0.1),
                  "Begin file list\nb.g 12\na.g 53\nEnd file list\nok\n"));
    bench_ask(b, "M32 a.g\n", 1);
    bench_ask(b, "M25\n", 20); /* what is in the queue is still done */
    CHECK(!strstr(b->log, "M117 first"));
    bench_expect(b, "M27\n", 0.1, "Not SD printing\nok\n");
    bench_ask(b, "M24\n", 20);
    CHECK(strstr(b->log, "M117 first"));
    bench_ask(b, "M32 b.g\n", 1);
    CHECK(strstr(b->log, "M117 second"));
    bench_free(b);
}

static void test_full_card(void) {
    bench *b = bench_make(bench_options());
    bench_ask(b, "M28 big.g\n", 0.1);
    bool told = false;
    for (int i = 1; i < 6000 && !told; i++)
        told = strstr(bench_ask(b,
                                bench_line(i, "M117 0123456789012345678901234567890123456789"
                                              "01234567890123456789012345678901"),
                                0.005),
                      "error writing to file") != NULL;
    CHECK(told);
    CHECK(strstr(bench_ask(b, "M29\n", 0.1), "SD card full\nok\n"));
    bench_free(b);
}

static void test_settings_outlive_a_reset(void) {
    bench *b = bench_script("at time 10 reset; at time 20 reset");
    CHECK(strstr(bench_ask(b, "M503\n", 0.5), "echo:  M203 X500.00 Y500.00 Z12.00 E120.00\n"));
    bench_ask(b, "M203 X321 Z7\nM500\nM203 X99\n", 1);
    CHECK(strstr(bench_ask(b, "M503\n", 0.5), "M203 X99.00 Y500.00 Z7.00"));
    bench_pass(b, 12 - b->now);
    CHECK(strstr(bench_ask(b, "M503\n", 0.5), "M203 X321.00 Y500.00 Z7.00"));
    bench_ask(b, "M502\n", 0.5);
    CHECK(strstr(bench_ask(b, "M503\n", 0.5), "M203 X500.00 Y500.00 Z12.00"));
    bench_ask(b, "M501\n", 0.5);
    CHECK(strstr(bench_ask(b, "M503\n", 0.5), "M203 X321.00 Y500.00 Z7.00"));
    bench_ask(b, "M502\nM500\n", 0.5);
    bench_pass(b, 22 - b->now);
    CHECK(strstr(bench_ask(b, "M503\n", 0.5), "M203 X500.00 Y500.00 Z12.00"));
    bench_free(b);
}

static void test_prompts(void) {
    bench *b = bench_make(bench_options());
    bench_expect(b, "M600\n", 1,
                 "//action:prompt_begin Nozzle Parked\n//action:prompt_button Continue\n"
                 "//action:prompt_show\n");
    bench_expect(b, "M876 S0\n", 1, "//action:prompt_end\nok\nok\n");
    bench_free(b);
}

int main(void) {
    RUN(test_upload_and_print);
    RUN(test_unnumbered_lines_are_not_written);
    RUN(test_pause_and_files_side_by_side);
    RUN(test_full_card);
    RUN(test_settings_outlive_a_reset);
    RUN(test_prompts);
    return check_verdict();
}
