#include "gcode/number.h"

#include <stdlib.h>

#include "check.h"

static uint64_t seed = 1;

static uint64_t random_bits(void) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return seed ^ seed >> 29;
}

/* Written with the C library, then shortened. */
static void expected_text(char *text, int64_t value, int decimals, int keep_zero) {
    unsigned long long m = value < 0 ? 0ull - (unsigned long long)value : (unsigned long long)value;
    unsigned long long scale = 1;
    for (int i = 0; i < decimals; i++)
        scale *= 10;
    char number[64];
    int n = decimals ? snprintf(number, 64, "%llu.%0*llu", m / scale, decimals, m % scale)
                     : snprintf(number, 64, "%llu", m);
    while (decimals && number[n - 1] == '0')
        number[--n] = '\0';
    if (number[n - 1] == '.')
        number[--n] = '\0';
    const char *shown = number;
    if (!keep_zero && number[0] == '0' && number[1] == '.')
        shown++;
    sprintf(text, "%s%s", value < 0 ? "-" : "", shown);
}

typedef enum writer { THOUSANDTHS, HUNDRED_THOUSANDTHS, DECIMAL, INTEGER } writer;

static int check_one(writer with, int64_t value, int decimals) {
    char text[64], expected[96];
    char *end = with == THOUSANDTHS           ? iso_put_thousandths(text, (int32_t)value)
                : with == HUNDRED_THOUSANDTHS ? iso_put_hundred_thousandths(text, value)
                : with == DECIMAL             ? iso_put_decimal(text, value, decimals)
                                              : iso_put_integer(text, value);
    CHECK(end - text <= ISO_NUMBER_MAX);
    *end = '\0';
    expected_text(expected, value, decimals, with == DECIMAL || with == INTEGER);
    if (CHECK(strcmp(text, expected) == 0))
        return 1;
    fprintf(stderr, "  %s instead of %s\n", text, expected);
    return 0;
}

static void test_thousandths(void) {
    CHECK(check_one(THOUSANDTHS, INT32_MIN, 3));
    CHECK(check_one(THOUSANDTHS, INT32_MAX, 3));
    for (int32_t v = -1100500; v <= 1100500; v += v > -2000 && v < 2000 ? 1 : 37)
        if (!check_one(THOUSANDTHS, v, 3))
            return;
}

static void test_hundred_thousandths(void) {
    static const int64_t edge[] = {
        0,      1,       10,       100,      1000,      10000,       99999,        100000,   100001,
        123450, 9999999, 10000000, 99999999, 100000000, 99999999999, 100000000000, INT64_MAX};
    for (size_t i = 0; i < sizeof edge / sizeof *edge; i++) {
        CHECK(check_one(HUNDRED_THOUSANDTHS, edge[i], 5));
        CHECK(check_one(HUNDRED_THOUSANDTHS, -edge[i], 5));
    }
    CHECK(check_one(HUNDRED_THOUSANDTHS, INT64_MIN, 5));
    for (int32_t v = -250000; v <= 250000; v += 3)
        if (!check_one(HUNDRED_THOUSANDTHS, v, 5))
            return;
    for (int i = 0; i < 100000; i++)
        if (!check_one(HUNDRED_THOUSANDTHS, (int64_t)(random_bits() >> random_bits() % 64), 5))
            return;
}

static void test_decimals_and_integers(void) {
    for (int i = 0; i < 60000; i++) {
        int64_t v = (int64_t)(random_bits() >> random_bits() % 64);
        if (!check_one(DECIMAL, i % 2 ? v : (int64_t)(0 - (uint64_t)v), i % 10) ||
            !check_one(INTEGER, v, 0))
            return;
    }
    CHECK(check_one(INTEGER, INT64_MIN, 0));
    CHECK(check_one(DECIMAL, INT64_MIN, 9));
}

int main(void) {
    RUN(test_thousandths);
    RUN(test_hundred_thousandths);
    RUN(test_decimals_and_integers);
    return check_verdict();
}
