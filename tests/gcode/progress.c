#include "gcode/progress.h"

#include <unistd.h>

#include "check.h"

static const char *const file_name = "test-gcode-progress.txt";

static void check_line(const char *expected, int percent, int64_t minutes) {
    char text[64];
    *iso_progress_put_line(text, percent, minutes) = '\0';
    CHECK(strcmp(expected, text) == 0);
}

static void test_lines_have_one_size(void) {
    check_line("M73 P0 R0      \n", 0, 0);
    check_line("M73 P100 R0    \n", 100, 0);
    check_line("M73 P100 R99999\n", 100, 99999);
    check_line("M73 P7 R99999  \n", 7, INT64_MAX);
}

/* Far more than the output's buffer holds, so that some lines are on disk already. */
static void test_lines_are_filled_in_wherever_they_are(void) {
    enum { MARKS = 300, FILLER = 1000 };
    iso_progress progress = {0};
    iso_output *output;
    char line[64], filler[FILLER];
    memset(filler, '.', FILLER);
    CHECK_OK(iso_output_open(&output, file_name));
    for (int i = 0; i < MARKS; i++) {
        CHECK_OK(iso_progress_mark(&progress, iso_output_size(output), 60.0 * i));
        iso_output_write(output, line, (size_t)(iso_progress_put_line(line, 0, 0) - line));
        iso_output_write(output, filler, FILLER);
    }
    int64_t size = iso_output_size(output);
    CHECK_OK(iso_progress_fill_in(output, &progress, 60.0 * MARKS));
    CHECK_EQUAL(size, iso_output_size(output));
    CHECK_OK(iso_output_commit(output));
    FILE *file = fopen(file_name, "r");
    for (int i = 0; file && i < MARKS; i++) {
        char expected[64], found[64] = "";
        *iso_progress_put_line(expected, 100 * i / MARKS, MARKS - i) = '\0';
        CHECK(fgets(found, sizeof found, file) && strcmp(expected, found) == 0);
        CHECK(fread(filler, 1, FILLER, file) == FILLER && filler[0] == '.' &&
              filler[FILLER - 1] == '.');
    }
    if (CHECK(file))
        fclose(file);
    unlink(file_name);
    iso_progress_free(&progress);
}

static void test_a_line_beyond_the_end_is_refused(void) {
    iso_progress progress = {0};
    iso_output *output;
    CHECK_OK(iso_output_open(&output, file_name));
    iso_output_write(output, "M73", 3);
    CHECK_OK(iso_progress_mark(&progress, 0, 0));
    CHECK_STATUS(ISO_BUG, iso_progress_fill_in(output, &progress, 1));
    CHECK_STATUS(ISO_BUG, iso_output_commit(output));
    CHECK(access(file_name, F_OK) != 0);
    iso_progress_free(&progress);
}

int main(void) {
    RUN(test_lines_have_one_size);
    RUN(test_lines_are_filled_in_wherever_they_are);
    RUN(test_a_line_beyond_the_end_is_refused);
    return check_verdict();
}
