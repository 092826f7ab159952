#include "base/number.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

static const double power_of_ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8, 1e9,
                                      1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18};

enum { MOST_DIGITS = 18 }; /* 10^18 < 2^63 */

static inline unsigned digit(char c) {
    return (unsigned)(unsigned char)c - '0';
}

const char *fio_number_read(double *value, const char *text, const char *end) {
    const char *p = text;
    bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+'))
        p++;
    uint64_t mantissa = 0;
    int any = 0, places = 0;
    bool huge = false;
    for (; p < end && digit(*p) < 10; p++, any = 1) {
        if (mantissa < (uint64_t)FIO_NUMBER_LIMIT * 10)
            mantissa = mantissa * 10 + digit(*p);
        else
            huge = true;
    }
    if (p < end && *p == '.') {
        uint64_t room = UINT64_C(100000000000000000); /* 10^17: one more digit keeps 18 */
        for (p++; p < end && digit(*p) < 10; p++, any = 1)
            if (places < MOST_DIGITS && mantissa < room) {
                mantissa = mantissa * 10 + digit(*p);
                places++;
            }
    }
    if (!any)
        return text;
    /* Both operands are exact up to 2^53, so one division rounds correctly. */
    double magnitude = (double)mantissa / power_of_ten[places];
    if (huge || magnitude > FIO_NUMBER_LIMIT)
        magnitude = INFINITY;
    *value = negative ? -magnitude : magnitude;
    return p;
}
