/* Numbers in and out, against strtod and printf of the C locale. */
#include <stdlib.h>

#include "base/number.h"
#include "base/text.h"
#include "check.h"

static const char *read_all(double *value, const char *text) {
    return fio_number_read(value, text, text + strlen(text));
}

static void test_reads_what_strtod_reads(void) {
    static const char *const texts[] = {
        "0",
        "-0",
        "1",
        "+1.5",
        "-.25",
        "5.",
        "100.000",
        "0.1",
        "0.3",
        "2.71828",
        "123456.789",
        "999999999",
        "-87.65432",
        "0.000000001",
        "00012.50",
        "1.234567890123456789012345",
        "0.10000000000000000000000000000001",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        double value = 77;
        CHECK(*read_all(&value, texts[i]) == 0);
        CHECK_NEAR(strtod(texts[i], NULL), value, fabs(value) * 1e-16);
    }
    unsigned seed = 1;
    for (int i = 0; i < 20000; i++) {
        char text[40];
        seed = seed * 1664525u + 1013904223u;
        snprintf(text, sizeof text, "%.*f", (int)(seed >> 8 & 7), (int)seed / 1000.0);
        double value = 0;
        CHECK(*read_all(&value, text) == 0);
        CHECK(value == strtod(text, NULL)); /* 15 digits: correctly rounded */
    }
}

static void test_leaves_what_is_no_number(void) {
    static const char *const texts[] = {"", "-", "+", ".", "-.", "x", "nan", "inf", "--1", "e5"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        double value = 77;
        CHECK(read_all(&value, texts[i]) == texts[i]);
        CHECK(value == 77);
    }
    double value = 0;
    CHECK(*read_all(&value, "1e5") == 'e'); /* E is a word of its own */
    CHECK(value == 1);
}

static void test_absurd_numbers_are_infinite(void) {
    double value = 0;
    CHECK(*read_all(&value, "99999999999999999999999999999999999") == 0 && isinf(value));
    CHECK(*read_all(&value, "-1000000001") == 0 && isinf(value) && value < 0);
    CHECK(*read_all(&value, "1000000000") == 0 && value == 1e9);
}

static void test_writes_what_printf_writes(void) {
    unsigned seed = 7;
    for (int i = 0; i < 20000; i++) {
        seed = seed * 1664525u + 1013904223u;
        double number = (int)seed / 4096.0; /* ties are exact, and go away from zero */
        char ours[32], theirs[32];
        fio_text text = fio_text_in(ours, sizeof ours);
        fio_text_number(&text, number, 5);
        snprintf(theirs, sizeof theirs, "%.5f", number);
        CHECK_NEAR(strtod(theirs, NULL), strtod(ours, NULL), 1.0001e-5);
        CHECK(strlen(ours) == strlen(theirs));
    }
    char bytes[8];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_number(&text, -0.001, 2);
    CHECK(!strcmp(bytes, "0.00"));
    fio_text_string(&text, "too long to fit");
    CHECK(!strcmp(bytes, "0.00too"));
    text = fio_text_in(bytes, sizeof bytes);
    fio_text_number(&text, NAN, 0);
    fio_text_integer(&text, -42);
    CHECK(!strcmp(bytes, "0-42"));
}

int main(void) {
    RUN(test_reads_what_strtod_reads);
    RUN(test_leaves_what_is_no_number);
    RUN(test_absurd_numbers_are_infinite);
    RUN(test_writes_what_printf_writes);
    return check_verdict();
}
