#include "base/series.h"

#include <math.h>
#include <stdint.h>

static const double pi = 3.14159265358979323846, half_pi = 1.57079632679489661923;

/* The logarithm of 2 in parts: multiples of the first two by up to 2^11 are exact. */
static const double ln2_high = 0x1.62e42fee00000p-1, ln2_middle = 0x1.a39ef35600000p-33,
                    ln2_low = 0x1.93c7673007e5fp-65;

/* A number as a sum of two, the second below half the last bit of the first (Dekker 1971). */
typedef struct twin {
    double high, low;
} twin;

static twin twin_sum(double a, double b) { /* |a| >= |b| */
    double high = a + b;
    return (twin){high, b - (high - a)};
}

/* a b exactly, of numbers below 2^990. */
static twin twin_product(double a, double b) {
    const double split = 134217729; /* 2^27 + 1 */
    double p = a * split, q = b * split, a1 = p - (p - a), b1 = q - (q - b);
    double a2 = a - a1, b2 = b - b1, high = a * b;
    return (twin){high, a1 * b1 - high + a1 * b2 + a2 * b1 + a2 * b2};
}

static twin twin_multiply(twin a, twin b) {
    twin c = twin_product(a.high, b.high);
    return twin_sum(c.high, c.low + (a.high * b.low + a.low * b.high));
}

static twin twin_add(twin a, twin b) { /* |a| >= |b| */
    twin c = twin_sum(a.high, b.high);
    return twin_sum(c.high, c.low + (a.low + b.low));
}

/* ---- exponentials and logarithms ---- */

/* e^(x + low), low far below x. With x = k ln 2 + r and |r| <= ln 2 / 2, 14 terms leave 1e-18. */
static double exp_of_sum(double x, double low) {
    if (isnan(x))
        return x;
    if (x > 710)
        return HUGE_VAL;
    if (x < -746)
        return 0;
    double k = floor(x * 1.44269504088896340736 + 0.5);
    double r = x - k * ln2_high - k * ln2_middle - k * ln2_low + low, sum = 1;
    for (int i = 14; i > 2; i--)
        sum = 1 + sum * r * (1.0 / i);
    return ldexp(1 + (r + r * r * 0.5 * sum), (int)k);
}

double series_exp(double x) {
    return exp_of_sum(x, 0);
}

/* x = m 2^k with m next to 1; 0 < x < infinity. */
static double next_to_one(double x, int *k) {
    double m = frexp(x, k);
    if (m >= 0.70710678118654752440)
        return m;
    (*k)--;
    return 2 * m;
}

/* Where the logarithm is no finite number. */
static int has_no_log(double *value, double x) {
    if (x > 0 && x < HUGE_VAL)
        return 0;
    *value = x == 0 ? -HUGE_VAL : x < 0 ? (double)NAN : x;
    return 1;
}

/* ln m = 2 (s + s^3 / 3 + s^5 / 5 ...) with s = (m - 1) / (m + 1), |s| < 0.172: what is left out
 * after s^21 is below 1e-18 of s. This is the sum after s^3 / 3, over s. */
static double log_tail(double square) {
    double sum = 1.0 / 21;
    for (int i = 19; i >= 5; i -= 2)
        sum = sum * square + 1.0 / i;
    return sum * square * square;
}

double series_log(double x) {
    double value;
    int k;
    if (has_no_log(&value, x))
        return value;
    double m = next_to_one(x, &k), s = (m - 1) / (m + 1), square = s * s;
    double rest = 2 * s * (square / 3 + log_tail(square));
    return k * ln2_high + (2 * s + (rest + k * ln2_middle));
}

/* The same in doubled precision, for a power: there the error grows with the exponent. */
static twin twin_log(double x) {
    int k;
    double m = next_to_one(x, &k), below = m + 1;
    double s = (m - 1) / below;
    twin back = twin_product(s, below),
         sum_below = {below, m < 1 ? m - (below - 1) : 1 - (below - m)};
    double left = (m - 1) - back.high - back.low - s * sum_below.low;
    twin t = twin_sum(s, left / below), square = twin_multiply(t, t);
    const twin third = {1.0 / 3, 0x1.5555555555555p-56};
    twin cube = twin_multiply(twin_multiply(square, t), third);
    twin sum = twin_add(t, twin_sum(cube.high, cube.low + t.high * log_tail(square.high)));
    sum.high *= 2;
    sum.low *= 2;
    if (k == 0)
        return sum;
    twin whole = twin_sum(k * ln2_high, k * ln2_middle);
    whole.low += k * ln2_low;
    return twin_add(whole, sum);
}

/* ---- powers ---- */

static double whole_power(double base, int n) {
    int count = n < 0 ? -n : n, k;
    double m = next_to_one(fabs(base), &k);
    twin result = {1, 0}, square = {base < 0 ? -m : m, 0};
    for (int i = count; i > 0; i >>= 1) {
        if (i & 1)
            result = twin_multiply(result, square);
        square = twin_multiply(square, square);
    }
    if (n < 0) {
        double inverse = 1 / result.high;
        twin back = twin_product(inverse, result.high);
        result.high = inverse + inverse * (1 - back.high - back.low - inverse * result.low);
    }
    return ldexp(result.high, k * n);
}

static double small_power(double base, int n) {
    double square = base * base;
    switch (n) {
    case 0:
        return 1;
    case 1:
        return base;
    case 2:
        return square;
    case 3:
        return square * base;
    default:
        return square * square;
    }
}

/* Of zeros and infinities. */
static double power_of_extreme(double base, double exponent, int odd) {
    double size = (fabs(base) > 1) == (exponent > 0) ? HUGE_VAL : 0;
    return odd && signbit(base) ? -size : size;
}

double series_power(double base, double exponent) {
    if (exponent == 0 || base == 1)
        return 1;
    if (isnan(base) || isnan(exponent))
        return base + exponent;
    if (isinf(exponent))
        return fabs(base) == 1 ? 1 : (fabs(base) > 1) == (exponent > 0) ? HUGE_VAL : 0;
    int whole = floor(exponent) == exponent;
    int odd = whole && fabs(fmod(exponent, 2)) == 1;
    if (base == 0 || isinf(base))
        return power_of_extreme(base, exponent, odd);
    if (whole && base == -1)
        return odd ? -1 : 1;
    if (whole && exponent >= 0 && exponent <= 4)
        return small_power(base, (int)exponent);
    if (whole && fabs(exponent) <= 1024)
        return whole_power(base, (int)exponent);
    if (base < 0 && !whole)
        return (double)NAN;
    if (exponent == 0.5)
        return sqrt(base);
    twin log = twin_log(fabs(base));
    if (fabs(log.high * exponent) > 800 || fabs(exponent) > 1e290) /* without overflow on the way */
        return power_of_extreme(log.high > 0 ? copysign(HUGE_VAL, base) : copysign(0, base),
                                exponent, odd);
    twin product = twin_product(log.high, exponent);
    double size = exp_of_sum(product.high, product.low + log.low * exponent);
    return odd && base < 0 ? -size : size;
}

/* ---- angles ---- */

/* Multiples of a quarter turn off: radians = k pi / 2 + rest, |rest| <= pi / 4. In parts as above,
 * exact for k below 2^20; larger angles lose whole turns first, by a modulus that is off by less
 * than half the last bit of a double. */
static double quarter_turns(int *quarter, double radians) {
    const double high = 0x1.921fb54400000p+0, middle = 0x1.0b4611a600000p-34,
                 low = 0x1.3198a2e037073p-69;
    if (fabs(radians) > 1e6)
        radians = fmod(radians, 131072 * 2 * pi);
    double k = floor(radians * (1 / half_pi) + 0.5);
    *quarter = (int)k & 3;
    return radians - k * high - k * middle - k * low;
}

/* 9 terms leave less than 1e-18. */
static void first_octant(double *sine, double *cosine, double x) {
    double square = x * x, s = 1, c = 1;
    for (int i = 9; i > 0; i--)
        s = 1 - s * square * (1.0 / (2 * i * (2 * i + 1)));
    for (int i = 9; i > 1; i--)
        c = 1 - c * square * (1.0 / (2 * i * (2 * i - 1)));
    *sine = s * x;
    *cosine = 1 - c * square * 0.5;
}

void series_sine_cosine(double *sine, double *cosine, double radians) {
    if (!(fabs(radians) < HUGE_VAL)) {
        *sine = *cosine = (double)NAN;
        return;
    }
    int quarter;
    double s, c, rest = quarter_turns(&quarter, radians);
    first_octant(&s, &c, rest);
    double of_sine = quarter & 1 ? c : s, of_cosine = quarter & 1 ? s : c;
    *sine = quarter & 2 ? -of_sine : of_sine;
    *cosine = quarter == 1 || quarter == 2 ? -of_cosine : of_cosine;
}

double series_tangent(double radians) {
    double sine, cosine;
    series_sine_cosine(&sine, &cosine, radians);
    return sine / cosine;
}

/* For 0 <= x <= 1: atan x = atan c + atan((x - c) / (1 + x c)), c the nearest eighth; 8 terms of
 * the series for at most 1/16 leave 1e-20. */
static double up_to_one(double x) {
    static const double at[9] = {0,
                                 0.12435499454676143503135484,
                                 0.24497866312686415417208248,
                                 0.35877067027057222039592006,
                                 0.46364760900080611621425623,
                                 0.55859931534356243597150821,
                                 0.64350110879328438680280922,
                                 0.71882999962162450541701415,
                                 0.78539816339744830961566084};
    int nearest = (int)(x * 8 + 0.5);
    double c = nearest * 0.125, t = (x - c) / (1 + x * c), square = t * t, sum = 1.0 / 15;
    for (int i = 13; i >= 3; i -= 2)
        sum = 1.0 / i - sum * square;
    return at[nearest] + (t - t * square * sum);
}

double series_arctangent2(double y, double x) {
    if (isnan(x) || isnan(y))
        return x + y;
    double ax = fabs(x), ay = fabs(y), small = ax < ay ? ax : ay, large = ax < ay ? ay : ax;
    double slope = large == 0 ? 0 : isinf(small) ? 1 : small / large;
    double angle = up_to_one(slope);
    if (ay > ax)
        angle = half_pi - angle;
    if (signbit(x))
        angle = pi - angle;
    return copysign(angle, y);
}

double series_arctangent(double x) {
    return series_arctangent2(x, 1);
}

double series_arcsine(double x) {
    return series_arctangent2(x, sqrt((1 - x) * (1 + x)));
}

double series_arccosine(double x) {
    return 2 * series_arctangent2(sqrt(1 - x), sqrt(1 + x));
}

double series_hypotenuse(double x, double y) {
    double ax = fabs(x), ay = fabs(y), large = ax > ay ? ax : ay;
    if (isinf(ax) || isinf(ay))
        return HUGE_VAL;
    if (large > 1e140 || large < 1e-140) { /* squares would leave the range */
        if (!(large > 0))
            return ax + ay;
        return large * sqrt((x / large) * (x / large) + (y / large) * (y / large));
    }
    return sqrt(x * x + y * y);
}
