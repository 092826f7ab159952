#include "field/interval.h"

#include "base/series.h"

/* Of our series, and for a rounding or two around them: four times what they promise. */
static const double series_error = 8e-15;
static const double pi = 3.14159265358979323846;

static double product(double a, double b) {
    return a == 0 || b == 0 ? 0 : a * b;
}

/* Products may become subnormal, where an error has no relation to their size. */
static const double least_product = 0x1p-900;

interval interval_product(interval a, interval b) {
    if (a.low == a.high && interval_is_finite(a))
        return interval_scale(a.low, b);
    if (b.low == b.high && interval_is_finite(b))
        return interval_scale(b.low, a);
    double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, t = a.high * b.high;
    if (!interval_is_finite(a) || !interval_is_finite(b)) {
        p = product(a.low, b.low), q = product(a.low, b.high);
        r = product(a.high, b.low), t = product(a.high, b.high);
    }
    interval c = interval_rounded(least_of(least_of(p, q), least_of(r, t)) - least_product,
                                  most_of(most_of(p, q), most_of(r, t)) + least_product);
    bool positive = (a.low >= 0 && b.low >= 0) || (a.high <= 0 && b.high <= 0);
    bool negative = (a.low >= 0 && b.high <= 0) || (a.high <= 0 && b.low >= 0);
    if (positive && c.low < 0)
        c.low = 0;
    if (negative && c.high > 0)
        c.high = 0;
    return c;
}

/* One over an interval; at its end zero has the sign of the rest. */
static interval inverse(interval a) {
    if ((a.low < 0 && a.high > 0) || interval_is(a, 0))
        return interval_whole();
    if (a.low == 0)
        return (interval){interval_rounded(1 / a.high, 1 / a.high).low, HUGE_VAL};
    if (a.high == 0)
        return (interval){-HUGE_VAL, interval_rounded(1 / a.low, 1 / a.low).high};
    return interval_rounded(1 / a.high, 1 / a.low);
}

/* Twice rounded where a quotient is once: the ends lie outside of it all the same. */
interval interval_divide(interval a, interval b) {
    return interval_multiply(a, inverse(b));
}

interval interval_square(interval a) {
    interval size = interval_abs(a);
    return interval_rounded(size.low * size.low, size.high * size.high + least_product);
}

interval interval_sqrt(interval a) {
    return a.low < 0 ? interval_whole() : interval_rounded(sqrt(a.low), sqrt(a.high));
}

/* Is some first + k step in the interval, or might it be but for rounding? */
static bool meets(interval a, double first, double step) {
    double low = (a.low - first) / step, high = (a.high - first) / step;
    low -= 1e-14 * (1 + fabs(low));
    high += 1e-14 * (1 + fabs(high));
    return floor(high) >= low;
}

/* Angles that a double knows poorly, or a whole turn of them. */
static bool is_anywhere(interval a) {
    return !(a.low > -1e6 && a.high < 1e6 && a.high - a.low < 6.2);
}

/* Between a and b, but where the greatest or least value is met on the way. */
static interval wave_between(double a, double b, bool top, bool bottom) {
    interval c = interval_outward(least_of(a, b), most_of(a, b), series_error);
    return (interval){bottom || c.low < -1 ? -1 : c.low, top || c.high > 1 ? 1 : c.high};
}

void interval_sine_cosine(interval *sine, interval *cosine, interval a) {
    if (!interval_is_finite(a) || is_anywhere(a)) {
        *sine = *cosine = interval_is_finite(a) ? (interval){-1, 1} : interval_whole();
        return;
    }
    double s, t, c, d, turn = 2 * pi;
    series_sine_cosine(&s, &c, a.low);
    t = s, d = c;
    if (a.high > a.low)
        series_sine_cosine(&t, &d, a.high);
    *sine = wave_between(s, t, meets(a, 0.5 * pi, turn), meets(a, -0.5 * pi, turn));
    *cosine = wave_between(c, d, meets(a, 0, turn), meets(a, pi, turn));
}

/* Seen from outside, a box spans the angle between two of its corners. */
interval interval_angle(bool *jumps, interval y, interval x) {
    *jumps = x.low <= 0 && y.low <= 0 && y.high >= 0;
    if (!interval_is_finite(x) || !interval_is_finite(y))
        return interval_whole();
    if (*jumps)
        return interval_outward(-pi, pi, series_error);
    double p = series_arctangent2(y.low, x.low), q = series_arctangent2(y.low, x.high),
           r = series_arctangent2(y.high, x.low), s = series_arctangent2(y.high, x.high);
    return interval_outward(least_of(least_of(p, q), least_of(r, s)),
                            most_of(most_of(p, q), most_of(r, s)), series_error);
}

static inline double norm(double a, double b) {
    double square = a * a + b * b;
    return square > 1e-270 && square < 1e270 ? sqrt(square) : series_hypotenuse(a, b);
}

interval interval_norm(interval a, interval b) {
    interval s = interval_abs(a), t = interval_abs(b);
    interval c = interval_outward(norm(s.low, t.low), norm(s.high, t.high), 0x1p-50);
    return s.low == 0 && t.low == 0 ? (interval){0, c.high} : c;
}

/* At the end a of the interval: towards a's own sign it is largest where the rest is least. */
static double share(double a, interval rest, bool up) {
    double least = (a > 0) == up ? rest.low : rest.high;
    if (a == 0)
        return 0;
    if (fabs(a) >= HUGE_VAL || least == 0)
        return a > 0 ? 1 : -1;
    return least < HUGE_VAL ? a / norm(a, least) : 0;
}

interval interval_share(interval a, interval rest) {
    rest = interval_abs(rest);
    interval c = interval_outward(share(a.low, rest, false), share(a.high, rest, true), 0x1p-50);
    return interval_both(c, (interval){-1, 1});
}
