/* Numbers of ASCII files, against the C library's strtof in the C locale. */
#include "check.h"

#include "mesh/decimal.h"
#include "models/shapes.h"

static void compare(const char *text) {
    float mine = 0, theirs = strtof(text, NULL);
    const char *end = text + strlen(text);
    check_count++;
    if (iso_decimal_parse(&mine, text, end) == end && memcmp(&mine, &theirs, sizeof mine) == 0)
        return;
    check_failures++;
    fprintf(stderr, "\"%s\" gives %.9g, not %.9g\n", text, mine, theirs);
}

static void test_forms(void) {
    static const char *const forms[] = {
        "0",
        "-0",
        "+0.0",
        "1",
        "-1",
        "1.",
        ".5",
        "-.5e1",
        "1e5",
        "1E+5",
        "1e-5",
        "00012.500",
        "3.14159265358979323846264338327950288",
        "123456789012345678901234567890",
        "0.1",
        "1e22",
        "1e23",
        "1e-22",
        "1e-23",
        "9007199254740993",
        "9007199254740992",
        "16777217",
        "16777219",
        "16777217.0000000000000000000000000000000000001",
        "33554434.00000000001",
        "33554435",
        "1e38",
        "3.4028235e38",
        "3.4028236e38",
        "3.40282357e38",
        "1e39",
        "1e400",
        "1e-400",
        "1e999999999999",
        "1e-999999999999",
        "0e999999999999",
        "0.000000000000e5",
        "1.401298464e-45",
        "7.006492321624085e-46",
        "7.006492321624086e-46",
        "1e-45",
        "1e-46",
        "1.17549435e-38",
        "1.1754942e-38",
        "1.17549428e-38",
        "1.1754943508222875e-38",
        "0.00000000000000000000000000000000000000000000000000000000000000000000000000000001e81",
        "100000000000000000000000000000000000000000000000000000000000000000000000000000000000e-80"};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
        compare(forms[i]);
}

/* Every digit of the tie between two neighbouring floats, and a hair to either side. */
static void test_ties(void) {
    uint64_t seed = 7;
    for (int i = 0; i < 1200; i++) {
        uint32_t bits = shape_random(&seed) % 0x7f000000u;
        float low, high;
        memcpy(&low, &bits, sizeof low);
        bits++;
        memcpy(&high, &bits, sizeof high);
        char text[400];
        snprintf(text, sizeof text, "%.180f", ((double)low + (double)high) / 2);
        compare(text);
        size_t length = strlen(text);
        text[length] = '1';
        text[length + 1] = 0;
        compare(text);
        text[length] = '0';
        for (size_t k = length; k-- > 0;) { /* one unit of the last digit less */
            if (text[k] == '.')
                continue;
            if (text[k] != '0') {
                text[k]--;
                break;
            }
            text[k] = '9';
        }
        compare(text);
    }
}

static void test_random_numbers(void) {
    uint64_t seed = 1;
    for (int i = 0; i < 100000; i++) {
        char text[64];
        uint32_t bits = shape_random(&seed) ^ shape_random(&seed) << 16;
        float value;
        memcpy(&value, &bits, sizeof value);
        if (value - value != 0)
            continue;
        static const char *const format[] = {"%.9g", "%.6f", "%e", "%.17g", "%.12e", "%g"};
        snprintf(text, sizeof text, format[i % 6], i % 6 == 1 ? fmod(value, 1e6) : value);
        compare(text);
        snprintf(text, sizeof text, "%u.%ue%d", shape_random(&seed), shape_random(&seed),
                 (int)(shape_random(&seed) % 80) - 50);
        compare(text);
    }
}

static void refuse(const char *text) {
    float value;
    const char *end = text + strlen(text);
    CHECK(iso_decimal_parse(&value, text, end) != end);
}

static void test_what_is_no_number(void) {
    static const char *const words[] = {"",      "-",   "+",    ".",   "-.", "e5",   "1e",
                                        "1e+",   "1,5", "0x1",  "--1", "1-", "nanx", "in",
                                        "1.2.3", "1 2", "1e5.", "abc", "1f"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        refuse(words[i]);
}

static void test_not_finite(void) {
    static const char *const words[] = {"nan", "NaN", "-nan", "inf", "-INF", "Infinity", "1e39"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        float value = 0;
        const char *end = words[i] + strlen(words[i]);
        CHECK(iso_decimal_parse(&value, words[i], end) == end);
        CHECK(value - value != 0);
    }
}

static void test_end_of_text_is_respected(void) {
    float value = 0;
    const char text[] = "12345";
    CHECK(iso_decimal_parse(&value, text, text + 3) == text + 3);
    CHECK(value == 123);
}

int main(void) {
    RUN(test_forms);
    RUN(test_ties);
    RUN(test_random_numbers);
    RUN(test_what_is_no_number);
    RUN(test_not_finite);
    RUN(test_end_of_text_is_respected);
    return check_verdict();
}
