/* Arithmetic of intervals: of all that a value can be, for certain. Ends are rounded outwards, so
 * that the true result and the one that doubles give both lie within.
 *
 * What isn't known is infinite. Finite ends also say that there is a value everywhere. Zero times
 * infinity is zero: what doesn't depend on something has no slope, however steep the rest. */
#ifndef ISO_FIELD_INTERVAL_H
#define ISO_FIELD_INTERVAL_H

#include <math.h>
#include <stdbool.h>

typedef struct interval {
    double low, high;
} interval;

/* What fmin and fmax are for numbers, without a call. */
static inline double least_of(double a, double b) {
    return a < b ? a : b;
}
static inline double most_of(double a, double b) {
    return a > b ? a : b;
}
static inline interval interval_whole(void) {
    return (interval){-HUGE_VAL, HUGE_VAL};
}
static inline interval interval_at(double a) {
    return (interval){a, a};
}
static inline bool interval_is(interval a, double b) {
    return a.low == b && a.high == b;
}
static inline bool interval_has(interval a, double b) {
    return a.low <= b && b <= a.high;
}
static inline bool interval_is_finite(interval a) {
    return a.low > -HUGE_VAL && a.high < HUGE_VAL;
}

/* From ends that are off by `error` of their size: 2^-53 by one rounding, twice that here. NaN at
 * an end, also of infinity less infinity, is all there is. */
static inline interval interval_outward(double low, double high, double error) {
    low -= fabs(low) * error;
    high += fabs(high) * error;
    return low <= high ? (interval){low, high} : interval_whole();
}
static inline interval interval_rounded(double low, double high) {
    return interval_outward(low, high, 0x1p-52);
}
static inline interval interval_hull(interval a, interval b) {
    return (interval){least_of(a.low, b.low), most_of(a.high, b.high)};
}
/* Both hold; where rounding keeps them apart, the first. */
static inline interval interval_both(interval a, interval b) {
    interval c = {most_of(a.low, b.low), least_of(a.high, b.high)};
    return c.low <= c.high ? c : a;
}
static inline interval interval_negate(interval a) {
    return (interval){-a.high, -a.low};
}
static inline interval interval_add(interval a, interval b) {
    return interval_rounded(a.low + b.low, a.high + b.high);
}
static inline interval interval_subtract(interval a, interval b) {
    return interval_rounded(a.low - b.high, a.high - b.low);
}
/* By a finite number. Products may become subnormal, where an error has no relation to their size:
 * so a little more than rounding. */
static inline interval interval_scale(double by, interval a) {
    const double least_product = 0x1p-900;
    if (by == 0)
        return (interval){0, 0};
    interval c = by > 0 ? (interval){by * a.low, by * a.high} : (interval){by * a.high, by * a.low};
    c = interval_rounded(c.low - least_product, c.high + least_product);
    return (interval){a.low == 0 && by > 0    ? 0
                      : a.high == 0 && by < 0 ? 0
                                              : c.low,
                      a.high == 0 && by > 0  ? 0
                      : a.low == 0 && by < 0 ? 0
                                             : c.high};
}
static inline interval interval_abs(interval a) {
    return a.low >= 0    ? a
           : a.high <= 0 ? interval_negate(a)
                         : (interval){0, most_of(-a.low, a.high)};
}

interval interval_product(interval a, interval b);
/* By one, as slopes often are, without a call. */
static inline interval interval_multiply(interval a, interval b) {
    return interval_is(a, 1) ? b : interval_is(b, 1) ? a : interval_product(a, b);
}
interval interval_divide(interval a, interval b);
interval interval_square(interval a);
interval interval_sqrt(interval a); /* all there is, if some of it has no root */
void interval_sine_cosine(interval *sine, interval *cosine, interval a);
/* The angle of (x, y) as series_arctangent2 has it; `jumps`: the points may lie on both sides of
 * where it turns over, or at the origin. */
interval interval_angle(bool *jumps, interval y, interval x);
/* sqrt(a^2 + b^2) */
interval interval_norm(interval a, interval b);
/* a / sqrt(a^2 + rest^2): within -1 and 1 also where both are zero. */
interval interval_share(interval a, interval rest);

#endif
