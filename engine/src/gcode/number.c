#include "gcode/number.h"

/* The tables are written by the preprocessor, so that they need no start-up and no lock. */
#define TENS(ROW, a)                                                                               \
    ROW(a, 0), ROW(a, 1), ROW(a, 2), ROW(a, 3), ROW(a, 4), ROW(a, 5), ROW(a, 6), ROW(a, 7),        \
        ROW(a, 8), ROW(a, 9)
#define HUNDREDS(ROW)                                                                              \
    TENS(ROW, 0), TENS(ROW, 1), TENS(ROW, 2), TENS(ROW, 3), TENS(ROW, 4), TENS(ROW, 5),            \
        TENS(ROW, 6), TENS(ROW, 7), TENS(ROW, 8), TENS(ROW, 9)

#define FRACTION(a, b, c)                                                                          \
    { {'0' + a, '0' + b, '0' + c}, c ? 4 : b ? 3 : a ? 2 : 0 }
#define WHOLE(a, b, c)                                                                             \
    {                                                                                              \
        {a   ? '0' + a                                                                             \
         : b ? '0' + b                                                                             \
             : '0' + c,                                                                            \
         a ? '0' + b : '0' + c, '0' + c},                                                          \
            a   ? 3                                                                                \
            : b ? 2                                                                                \
            : c ? 1                                                                                \
                : 0                                                                                \
    }
#define TEN(ONE, a, b)                                                                             \
    ONE(a, b, 0), ONE(a, b, 1), ONE(a, b, 2), ONE(a, b, 3), ONE(a, b, 4), ONE(a, b, 5),            \
        ONE(a, b, 6), ONE(a, b, 7), ONE(a, b, 8), ONE(a, b, 9)
#define FRACTIONS(a, b) TEN(FRACTION, a, b)
#define WHOLES(a, b) TEN(WHOLE, a, b)

const iso_three_digits iso_number_fraction[1000] = {HUNDREDS(FRACTIONS)};
const iso_three_digits iso_number_whole[1000] = {HUNDREDS(WHOLES)};

char *iso_put_integer(char *to, int64_t value) {
    char digit[20];
    int n = 0;
    uint64_t magnitude = value < 0 ? 0u - (uint64_t)value : (uint64_t)value;
    do
        digit[n++] = (char)('0' + magnitude % 10);
    while (magnitude /= 10);
    if (value < 0)
        *to++ = '-';
    while (n > 0)
        *to++ = digit[--n];
    return to;
}

char *iso_put_decimal(char *to, int64_t value, int decimals) {
    uint64_t magnitude = value < 0 ? 0u - (uint64_t)value : (uint64_t)value, scale = 1;
    for (int i = 0; i < decimals; i++)
        scale *= 10;
    uint64_t fraction = magnitude % scale;
    if (value < 0)
        *to++ = '-';
    to = iso_put_integer(to, (int64_t)(magnitude / scale));
    if (fraction == 0)
        return to;
    *to++ = '.';
    while (fraction > 0) {
        scale /= 10;
        *to++ = (char)('0' + fraction / scale);
        fraction %= scale;
    }
    return to;
}
