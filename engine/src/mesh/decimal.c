#include "mesh/decimal.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The value is 0.d1 d2 d3 ... * 10^point, or as the fast path has it, mantissa * 10^exponent. */
enum {
    DIGITS = 128, /* a tie between two floats has at most 113 significant digits */
    LIMBS = 40    /* 1280 bits: 10^(DIGITS + 60) and room for shifts */
};

typedef struct decimal {
    uint8_t digit[DIGITS];
    int count;         /* significant digits kept */
    bool more;         /* a nonzero digit was cut off */
    int64_t exponent;  /* of ten, of the last digit kept */
    uint64_t mantissa; /* the digits as a number, if there are at most 19 */
    bool negative;
} decimal;

typedef struct big {
    uint32_t limb[LIMBS]; /* least significant first */
} big;

static void big_multiply_add(big *n, uint32_t factor, uint32_t addend) {
    uint64_t carry = addend;
    for (int i = 0; i < LIMBS; i++) {
        carry += (uint64_t)n->limb[i] * factor;
        n->limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
}

static void big_double(big *n) {
    big_multiply_add(n, 2, 0);
}

static int big_compare(const big *a, const big *b) {
    for (int i = LIMBS - 1; i >= 0; i--)
        if (a->limb[i] != b->limb[i])
            return a->limb[i] < b->limb[i] ? -1 : 1;
    return 0;
}

static void big_subtract(big *a, const big *b) {
    int64_t borrow = 0;
    for (int i = 0; i < LIMBS; i++) {
        borrow += (int64_t)a->limb[i] - b->limb[i];
        a->limb[i] = (uint32_t)borrow;
        borrow >>= 32;
    }
}

static float float_of(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Long division, bit by bit: slow, exact, and rare. */
static float divide(big *above, big *below, bool more) {
    int exponent = 0; /* of two: the value is above / below * 2^exponent */
    big twice = *below;
    big_double(&twice);
    while (big_compare(above, &twice) >= 0) {
        *below = twice;
        big_double(&twice);
        exponent++;
    }
    if (exponent > 127)
        return float_of(0x7f800000u);
    while (big_compare(above, below) < 0 && exponent > -149) {
        big_double(above);
        exponent--;
    }
    /* now the leading bit has weight 2^exponent, unless the value is subnormal */
    int bits = exponent >= -126 ? 24 : 150 + exponent;
    uint32_t fraction = 0;
    for (int i = 0; i < bits; i++) {
        bool one = big_compare(above, below) >= 0;
        if (one)
            big_subtract(above, below);
        fraction = 2 * fraction + one;
        big_double(above);
    }
    /* what remains, doubled once too often, against one half */
    int half = big_compare(above, below);
    bool up = half > 0 || (half == 0 && (more || fraction & 1));
    fraction += up;
    /* adding lets a carry run into the exponent, as it should */
    uint32_t biased = exponent >= -126 ? (uint32_t)(exponent + 126) : 0;
    return float_of((biased << 23) + fraction);
}

static float exact(const decimal *d) {
    if (d->count == 0 || d->exponent + d->count < -46)
        return 0;
    if (d->exponent + d->count > 40)
        return float_of(0x7f800000u);
    big above = {{0}}, below = {{1}};
    for (int i = 0; i < d->count; i++)
        big_multiply_add(&above, 10, d->digit[i]);
    for (int64_t e = d->exponent; e > 0; e--)
        big_multiply_add(&above, 10, 0);
    for (int64_t e = d->exponent; e < 0; e++)
        big_multiply_add(&below, 10, 0);
    return divide(&above, &below, d->more);
}

static const double power_of_ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                      1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                      1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* Two exact doubles make one correctly rounded operation; rounding that to float again is right
 * unless it fell on a tie between floats, which the exact value may have missed by little. */
static bool fast(float *value, const decimal *d) {
    if (d->count > 19 || d->more || d->mantissa > (1ull << 53) || d->exponent < -22 ||
        d->exponent > 22)
        return false;
    double wide = (double)d->mantissa;
    wide = d->exponent < 0 ? wide / power_of_ten[-d->exponent] : wide * power_of_ten[d->exponent];
    uint64_t bits;
    memcpy(&bits, &wide, sizeof bits);
    if ((bits & 0x1fffffff) == 0x10000000 || (wide < 1.2e-38 && wide > 0))
        return false;
    *value = (float)wide;
    return true;
}

static void add_digit(decimal *d, int digit, bool after_point) {
    if (d->count == 0 && digit == 0) {
        d->exponent -= after_point;
        return;
    }
    if (d->count == DIGITS) {
        d->more |= digit != 0;
        d->exponent += !after_point;
        return;
    }
    d->digit[d->count++] = (uint8_t)digit;
    if (d->count <= 19)
        d->mantissa = 10 * d->mantissa + (uint64_t)digit;
    d->exponent -= after_point;
}

static bool is_digit(const char *at, const char *end) {
    return at < end && *at >= '0' && *at <= '9';
}

/* The exponent after 'e', or `text` unmoved if there is none, as strtof does. */
static const char *parse_exponent(int64_t *exponent, const char *text, const char *end) {
    const char *at = text;
    if (at == end || (*at | 32) != 'e')
        return text;
    at++;
    bool negative = at < end && *at == '-';
    if (at < end && (*at == '-' || *at == '+'))
        at++;
    if (!is_digit(at, end))
        return text;
    int64_t value = 0;
    for (; is_digit(at, end); at++)
        if (value < 1000000)
            value = 10 * value + (*at - '0');
    *exponent += negative ? -value : value;
    return at;
}

static const char *parse_word(float *value, const char *text, const char *end) {
    static const struct {
        const char *name;
        uint32_t bits;
    } word[] = {{"infinity", 0x7f800000u}, {"inf", 0x7f800000u}, {"nan", 0x7fc00000u}};
    for (int w = 0; w < 3; w++) {
        const char *at = text, *name = word[w].name;
        while (*name && at < end && (*at | 32) == *name)
            at++, name++;
        if (!*name) {
            *value = float_of(word[w].bits);
            return at;
        }
    }
    return NULL;
}

const char *iso_decimal_parse(float *value, const char *text, const char *end) {
    const char *at = text;
    decimal d;
    d.count = 0, d.more = false, d.exponent = 0, d.mantissa = 0; /* the digits need no zeroing */
    d.negative = at < end && *at == '-';
    if (at < end && (*at == '-' || *at == '+'))
        at++;
    const char *first = at;
    int found = 0;
    for (; is_digit(at, end); at++, found++)
        add_digit(&d, *at - '0', false);
    if (at < end && *at == '.')
        for (at++; is_digit(at, end); at++, found++)
            add_digit(&d, *at - '0', true);
    if (found == 0) {
        at = parse_word(value, first, end);
    } else {
        at = parse_exponent(&d.exponent, at, end);
        if (!fast(value, &d))
            *value = exact(&d);
    }
    if (at && d.negative)
        *value = -*value;
    return at;
}
