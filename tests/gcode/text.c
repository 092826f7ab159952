#include "gcode/text.h"

#include <time.h>

#include "check.h"

/* Every 31 days and some seconds for 400 years, as the C library has it. */
static void test_dates(void) {
    for (int64_t t = 0; t < 12700000000; t += 31 * 86400 + 4321) {
        char date[ISO_DATE_SIZE], expected[64];
        time_t at = (time_t)t;
        struct tm parts;
        gmtime_r(&at, &parts);
        strftime(expected, sizeof expected, "%Y-%m-%d at %H:%M:%S", &parts);
        iso_text_date(date, t);
        CHECK(strcmp(expected, date) == 0);
    }
}

static void check_duration(const char *expected, int64_t seconds) {
    char text[80];
    *iso_text_put_duration(text, seconds) = '\0';
    if (!CHECK(strcmp(expected, text) == 0))
        fprintf(stderr, "  %s instead of %s\n", text, expected);
}

static void test_durations(void) {
    check_duration("0s", 0);
    check_duration("59s", 59);
    check_duration("1m 0s", 60);
    check_duration("1h 2m 3s", 3723);
    check_duration("1h 0m 0s", 3600);
    check_duration("1d 0h 0m 5s", 86405);
    check_duration("12d 3h 4m 5s", 12 * 86400 + 3 * 3600 + 4 * 60 + 5);
}

static void test_commands_are_found(void) {
    CHECK(iso_text_has_command("M104 S200", "M104"));
    CHECK(iso_text_has_command("G28\n  M104\tS200\n", "M104"));
    CHECK(iso_text_has_command("G28\r\nM104;heat", "M104"));
    CHECK(iso_text_has_command("M104", "M104"));
    CHECK(!iso_text_has_command("M1040 S1\n", "M104"));
    CHECK(!iso_text_has_command("; M104 S200\nG28 ; M104\n", "M104"));
    CHECK(!iso_text_has_command("", "M104"));
}

int main(void) {
    RUN(test_dates);
    RUN(test_durations);
    RUN(test_commands_are_found);
    return check_verdict();
}
