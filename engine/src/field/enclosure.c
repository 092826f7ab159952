#include "field/enclosure.h"

#include "base/series.h"

static const double series_error = 8e-15;

/* Slopes by the chain rule, from those of the operation by each operand. */
static void chain(enclosure *to, const interval *by, const enclosure *const *from, int32_t operands,
                  int32_t slopes) {
    for (int32_t c = 0; c < slopes; c++) {
        interval sum = interval_at(0);
        for (int32_t k = 0; k < operands; k++) {
            if (interval_is(from[k]->slope[c], 0))
                continue;
            interval part = interval_multiply(by[k], from[k]->slope[c]);
            sum = interval_is(sum, 0) ? part : interval_add(sum, part);
        }
        to->slope[c] = sum;
    }
}

static void flat(enclosure *to, int32_t slopes) {
    for (int32_t c = 0; c < slopes; c++)
        to->slope[c] = interval_at(0);
}

/* The value may jump: by whatever an operand isn't constant in there is no bound. */
static void jump(enclosure *to, const enclosure *const *from, int32_t operands, int32_t slopes) {
    for (int32_t c = 0; c < slopes; c++) {
        to->slope[c] = interval_at(0);
        for (int32_t k = 0; k < operands; k++)
            if (!interval_is(from[k]->slope[c], 0))
                to->slope[c] = interval_whole();
    }
}

static void nothing_known(enclosure *to, const enclosure *const *from, int32_t operands,
                          int32_t slopes) {
    to->value = interval_whole();
    jump(to, from, operands, slopes);
}

/* The result is one of two, not known which: continuous where it changes over. */
static void either(enclosure *to, const enclosure *a, const enclosure *b, int32_t slopes) {
    to->value = interval_hull(a->value, b->value);
    for (int32_t c = 0; c < slopes; c++)
        to->slope[c] = interval_hull(a->slope[c], b->slope[c]);
}

static interval grown(interval a, double error) {
    return interval_outward(a.low, a.high, error);
}

/* ---- operators ---- */

void enclose_negate(enclosure *to, const enclosure *const *from, int32_t slopes) {
    to->value = interval_negate(from[0]->value);
    for (int32_t c = 0; c < slopes; c++)
        to->slope[c] = interval_negate(from[0]->slope[c]);
}

void enclose_add(enclosure *to, const enclosure *const *from, int32_t slopes) {
    static const interval by[2] = {{1, 1}, {1, 1}};
    to->value = interval_add(from[0]->value, from[1]->value);
    chain(to, by, from, 2, slopes);
}

void enclose_subtract(enclosure *to, const enclosure *const *from, int32_t slopes) {
    static const interval by[2] = {{1, 1}, {-1, -1}};
    to->value = interval_subtract(from[0]->value, from[1]->value);
    chain(to, by, from, 2, slopes);
}

/* Infinity times zero is no number; in a slope it is nothing. What may not be a number stays so
 * when it is multiplied by zero. */
static bool has_no_product(interval a, interval b) {
    return (!interval_is_finite(a) && interval_has(b, 0)) ||
           (!interval_is_finite(b) && interval_has(a, 0));
}

void enclose_multiply(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, b = from[1]->value, by[2] = {b, a};
    if (has_no_product(a, b)) {
        nothing_known(to, from, 2, slopes);
        return;
    }
    to->value = interval_multiply(a, b);
    chain(to, by, from, 2, slopes);
}

void enclose_divide(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, b = from[1]->value;
    if (interval_has(b, 0) || !interval_is_finite(b)) {
        nothing_known(to, from, 2, slopes);
        return;
    }
    to->value = interval_divide(a, b);
    interval by[2] = {interval_divide(interval_at(1), b),
                      interval_negate(interval_divide(to->value, b))};
    chain(to, by, from, 2, slopes);
}

/* Whole powers: even ones fall up to zero, odd ones rise all the way; below zero both ends are
 * those of the inverse. */
static interval whole_power(interval a, double n) {
    if (n == 0)
        return interval_at(1);
    if (n < 0)
        return interval_has(a, 0) ? interval_whole()
                                  : interval_divide(interval_at(1), whole_power(a, -n));
    if (fmod(n, 2) == 0)
        a = interval_abs(a);
    interval c = interval_outward(series_power(a.low, n), series_power(a.high, n), series_error);
    c.low -= c.low < 0 ? 0x1p-900 : 0;
    c.high += c.high >= 0 && a.high > 0 ? 0x1p-900 : 0;
    return c;
}

/* Of a base above zero, monotone in either operand. */
static interval general_power(interval a, interval b) {
    double p = series_power(a.low, b.low), r = a.high > a.low ? series_power(a.high, b.low) : p;
    double q = p, s = r;
    if (b.high > b.low) {
        q = series_power(a.low, b.high);
        s = series_power(a.high, b.high);
    }
    return interval_outward(least_of(least_of(p, q), least_of(r, s)),
                            most_of(most_of(p, q), most_of(r, s)) + 0x1p-900, series_error);
}

static interval positive_log(interval a) {
    return a.low <= 0 ? interval_whole()
                      : interval_outward(series_log(a.low), series_log(a.high), series_error);
}

void enclose_power(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, b = from[1]->value;
    bool fixed = b.low == b.high, is_known = interval_is_finite(a) || b.low >= 0;
    if (fixed && is_known && floor(b.low) == b.low && fabs(b.low) <= 1024) {
        to->value = whole_power(a, b.low);
        interval by[2] = {interval_multiply(b, whole_power(a, b.low - 1)),
                          interval_multiply(to->value, positive_log(a))};
        chain(to, by, from, 2, slopes);
        return;
    }
    if (a.low < 0 || !interval_is_finite(a) || !interval_is_finite(b) ||
        (a.low == 0 && (!fixed || b.low < 0))) {
        nothing_known(to, from, 2, slopes);
        return;
    }
    to->value = general_power(a, b);
    interval less = {b.low - 1, b.high - 1};
    interval by[2] = {interval_multiply(b, a.low > 0 || b.low >= 1 ? general_power(a, less)
                                                                   : (interval){0, HUGE_VAL}),
                      interval_multiply(to->value, positive_log(a))};
    chain(to, by, from, 2, slopes);
}

static void decide(enclosure *to, const enclosure *const *from, bool always, bool never,
                   int32_t slopes) {
    to->value = always ? interval_at(1) : never ? interval_at(0) : (interval){0, 1};
    if (always || never)
        flat(to, slopes);
    else
        jump(to, from, 2, slopes);
}

/* What may not be a number decides nothing. */
static bool are_numbers(const enclosure *const *from) {
    return interval_is_finite(from[0]->value) && interval_is_finite(from[1]->value);
}

void enclose_less(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, b = from[1]->value;
    bool known = are_numbers(from);
    decide(to, from, known && a.high < b.low, known && a.low >= b.high, slopes);
}

void enclose_less_equal(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, b = from[1]->value;
    bool known = are_numbers(from);
    decide(to, from, known && a.high <= b.low, known && a.low > b.high, slopes);
}

void enclose_greater(enclosure *to, const enclosure *const *from, int32_t slopes) {
    const enclosure *const turned[2] = {from[1], from[0]};
    enclose_less(to, turned, slopes);
}

void enclose_greater_equal(enclosure *to, const enclosure *const *from, int32_t slopes) {
    const enclosure *const turned[2] = {from[1], from[0]};
    enclose_less_equal(to, turned, slopes);
}

void enclose_equal(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, b = from[1]->value;
    bool known = are_numbers(from);
    decide(to, from, known && interval_is(a, a.high) && interval_is(b, a.low),
           known && (a.high < b.low || a.low > b.high), slopes);
}

void enclose_unequal(enclosure *to, const enclosure *const *from, int32_t slopes) {
    enclosure equal;
    enclose_equal(&equal, from, slopes);
    *to = equal;
    to->value = (interval){1 - equal.value.high, 1 - equal.value.low};
}

void enclose_select(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value;
    if (interval_is(a, 0)) {
        *to = *from[2];
    } else if (!interval_has(a, 0)) {
        *to = *from[1];
    } else {
        enclosure jumps;
        either(to, from[1], from[2], slopes);
        jump(&jumps, from, 1, slopes); /* where only the condition changes over */
        for (int32_t c = 0; c < slopes; c++)
            if (!interval_is(jumps.slope[c], 0))
                to->slope[c] = interval_whole();
    }
}

void enclose_square(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, by = {2 * a.low, 2 * a.high};
    to->value = interval_square(a);
    chain(to, &by, from, 1, slopes);
}

void enclose_norm3(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, b = from[1]->value, c = from[2]->value;
    to->value = interval_norm(interval_norm(a, b), c);
    interval by[3] = {interval_share(a, interval_norm(b, c)),
                      interval_share(b, interval_norm(a, c)),
                      interval_share(c, interval_norm(a, b))};
    chain(to, by, from, 3, slopes);
}

/* ---- functions with kinks and jumps ---- */

void enclose_abs(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value;
    interval by = a.low > 0 ? interval_at(1) : a.high < 0 ? interval_at(-1) : (interval){-1, 1};
    to->value = interval_abs(a);
    chain(to, &by, from, 1, slopes);
}

void enclose_min(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, b = from[1]->value;
    if (!are_numbers(from)) {
        nothing_known(to, from, 2, slopes);
    } else if (a.high < b.low || b.high < a.low) {
        *to = *from[a.high < b.low ? 0 : 1];
    } else {
        either(to, from[0], from[1], slopes);
        to->value.high = least_of(a.high, b.high);
    }
}

void enclose_max(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, b = from[1]->value;
    if (!are_numbers(from)) {
        nothing_known(to, from, 2, slopes);
    } else if (a.low > b.high || b.low > a.high) {
        *to = *from[a.low > b.high ? 0 : 1];
    } else {
        either(to, from[0], from[1], slopes);
        to->value.low = most_of(a.low, b.low);
    }
}

/* Between ends in order it is min(max(v, low), high). */
void enclose_clamp(enclosure *to, const enclosure *const *from, int32_t slopes) {
    if (from[1]->value.high <= from[2]->value.low) {
        enclosure up;
        const enclosure *pair[2] = {from[0], from[1]};
        enclose_max(&up, pair, slopes);
        pair[0] = &up;
        pair[1] = from[2];
        enclose_min(to, pair, slopes);
        return;
    }
    jump(to, from, 3, slopes);
    to->value = interval_hull(from[0]->value, interval_hull(from[1]->value, from[2]->value));
}

static void steps(enclosure *to, const enclosure *const *from, double low, double high,
                  int32_t slopes) {
    to->value = low <= high ? (interval){low, high} : interval_whole();
    if (low == high)
        flat(to, slopes);
    else
        jump(to, from, 1, slopes);
}

void enclose_floor(enclosure *to, const enclosure *const *from, int32_t slopes) {
    steps(to, from, floor(from[0]->value.low), floor(from[0]->value.high), slopes);
}

void enclose_ceil(enclosure *to, const enclosure *const *from, int32_t slopes) {
    steps(to, from, ceil(from[0]->value.low), ceil(from[0]->value.high), slopes);
}

void enclose_round(enclosure *to, const enclosure *const *from, int32_t slopes) {
    steps(to, from, round(from[0]->value.low), round(from[0]->value.high), slopes);
}

/* a - b floor(a / b), as long as that is one number. */
void enclose_mod(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, b = from[1]->value;
    if (interval_has(b, 0) || !are_numbers(from)) {
        nothing_known(to, from, 2, slopes);
        return;
    }
    interval range = {b.low < 0 ? b.low : 0, b.high > 0 ? b.high : 0},
             times = interval_divide(a, b);
    double whole = floor(times.low);
    if (whole != floor(times.high)) {
        to->value = range;
        jump(to, from, 2, slopes);
        return;
    }
    interval by[2] = {interval_at(1), interval_at(-whole)};
    to->value =
        interval_both(range, interval_subtract(a, interval_multiply(b, interval_at(whole))));
    chain(to, by, from, 2, slopes);
}

/* With ends that may meet it may jump. Between, t is the share of the way from one to the other. */
void enclose_ramp(enclosure *to, const enclosure *const *from, int32_t slopes) {
    const enclosure *a = from[3], *b = from[4];
    interval length = interval_subtract(from[2]->value, from[1]->value);
    interval way = interval_subtract(from[0]->value, from[1]->value);
    either(to, a, b, slopes);
    if (interval_has(length, 0) || !interval_is_finite(length) || !interval_is_finite(way) ||
        !interval_is_finite(to->value)) {
        nothing_known(to, from, 5, slopes);
        return;
    }
    interval t = interval_divide(way, length), rise = interval_subtract(b->value, a->value);
    if (t.high <= 0 || t.low >= 1) {
        *to = t.high <= 0 ? *a : *b;
        return;
    }
    interval in = {t.low > 0 ? t.low : 0, t.high < 1 ? t.high : 1};
    interval rest = {1 - in.high, 1 - in.low}, slope = interval_divide(rise, length);
    interval by[5] = {slope, interval_negate(interval_multiply(slope, rest)),
                      interval_negate(interval_multiply(slope, in)), grown(rest, 0x1p-52), in};
    if (t.low <= 0 || t.high >= 1)
        for (int k = 0; k < 3; k++)
            by[k] = interval_hull(by[k], interval_at(0));
    to->value = interval_both(grown(to->value, 0x1p-50),
                              interval_add(a->value, interval_multiply(rise, in)));
    chain(to, by, from, 5, slopes);
}

/* ---- smooth functions ---- */

void enclose_sqrt(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval by = interval_divide(interval_at(0.5), interval_sqrt(from[0]->value));
    to->value = interval_sqrt(from[0]->value);
    chain(to, &by, from, 1, slopes);
}

void enclose_sin(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval cosine;
    interval_sine_cosine(&to->value, &cosine, from[0]->value);
    chain(to, &cosine, from, 1, slopes);
}

void enclose_cos(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval sine;
    interval_sine_cosine(&sine, &to->value, from[0]->value);
    sine = interval_negate(sine);
    chain(to, &sine, from, 1, slopes);
}

/* Where the cosine has one sign it rises. */
void enclose_tan(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, sine, cosine;
    interval_sine_cosine(&sine, &cosine, a);
    if (!(a.high - a.low < 3) || interval_has(cosine, 0) || !interval_is_finite(cosine)) {
        nothing_known(to, from, 1, slopes);
        return;
    }
    to->value = interval_outward(series_tangent(a.low), series_tangent(a.high), 2 * series_error);
    interval by = interval_add(interval_at(1), interval_square(to->value));
    chain(to, &by, from, 1, slopes);
}

/* 1 / sqrt(1 - a^2): how asin and acos rise and fall. */
static interval steepness(interval a) {
    interval least = interval_subtract(interval_at(1), interval_square(a));
    if (least.low < 0)
        least.low = 0;
    return interval_divide(interval_at(1), interval_sqrt(least));
}

static bool is_sine(interval a) {
    return a.low >= -1 && a.high <= 1;
}

void enclose_asin(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value;
    if (!is_sine(a)) {
        nothing_known(to, from, 1, slopes);
        return;
    }
    interval by = steepness(a);
    to->value = interval_outward(series_arcsine(a.low), series_arcsine(a.high), series_error);
    chain(to, &by, from, 1, slopes);
}

void enclose_acos(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value;
    if (!is_sine(a)) {
        nothing_known(to, from, 1, slopes);
        return;
    }
    interval by = interval_negate(steepness(a));
    to->value = interval_outward(series_arccosine(a.high), series_arccosine(a.low), series_error);
    chain(to, &by, from, 1, slopes);
}

void enclose_atan(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value;
    if (!interval_is_finite(a)) {
        nothing_known(to, from, 1, slopes);
        return;
    }
    interval by = interval_divide(interval_at(1), interval_add(interval_at(1), interval_square(a)));
    to->value = interval_outward(series_arctangent(a.low), series_arctangent(a.high), series_error);
    chain(to, &by, from, 1, slopes);
}

void enclose_atan2(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval y = from[0]->value, x = from[1]->value, norm = interval_norm(x, y);
    bool jumps;
    to->value = interval_angle(&jumps, y, x);
    if (jumps) {
        jump(to, from, 2, slopes);
        return;
    }
    interval by[2] = {interval_divide(interval_share(x, y), norm),
                      interval_negate(interval_divide(interval_share(y, x), norm))};
    chain(to, by, from, 2, slopes);
}

void enclose_exp(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value;
    if (!interval_is_finite(a)) {
        nothing_known(to, from, 1, slopes);
        return;
    }
    to->value = interval_outward(series_exp(a.low), series_exp(a.high) + 0x1p-900, series_error);
    if (to->value.low < 0)
        to->value.low = 0;
    interval by = to->value;
    chain(to, &by, from, 1, slopes);
}

void enclose_log(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value;
    if (a.low <= 0) {
        nothing_known(to, from, 1, slopes);
        return;
    }
    interval by = interval_divide(interval_at(1), a);
    to->value = positive_log(a);
    chain(to, &by, from, 1, slopes);
}

void enclose_hypot(enclosure *to, const enclosure *const *from, int32_t slopes) {
    interval a = from[0]->value, b = from[1]->value;
    interval by[2] = {interval_share(a, b), interval_share(b, a)};
    to->value = interval_norm(a, b);
    chain(to, by, from, 2, slopes);
}
