/* Series against the C library. */
#include "check.h"

#include <float.h>
#include <stdint.h>

#include "base/series.h"

static const double bound = 2e-15;

static uint64_t state = 88172645463325252u;

static double uniform(double low, double high) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return low + (high - low) * (double)(state >> 11) * 0x1p-53;
}

/* Of either sign, of any size from 2^low to 2^high. */
static double any(double low, double high) {
    double size = exp2(uniform(low, high));
    return uniform(0, 1) < 0.5 ? -size : size;
}

static double error_of(double expected, double actual) {
    if (expected == actual || (isnan(expected) && isnan(actual)))
        return 0;
    double error = fabs(actual - expected) / fmax(fabs(expected), DBL_MIN);
    return isnan(error) ? HUGE_VAL : error;
}

enum { TRIES = 200000 };

#define WORST(expected, actual)                                                                    \
    do {                                                                                           \
        double worst_error = error_of(expected, actual);                                           \
        worst = worst_error > worst ? worst_error : worst;                                         \
    } while (0)

static void test_exp(void) {
    double worst = 0;
    for (int i = 0; i < TRIES; i++) {
        double x = i & 1 ? uniform(-700, 709.7) : any(-60, 3);
        WORST(exp(x), series_exp(x));
    }
    CHECK_NEAR(0, worst, 4e-16);
    CHECK(series_exp(0) == 1);
    CHECK(series_exp(1000) == HUGE_VAL && series_exp(HUGE_VAL) == HUGE_VAL);
    CHECK(series_exp(-1000) == 0 && series_exp(-HUGE_VAL) == 0);
    CHECK(isnan(series_exp(NAN)));
    CHECK_NEAR(0, error_of(exp(709.78), series_exp(709.78)), bound);
    CHECK_NEAR(exp(-740), series_exp(-740), 1e-322);
}

static void test_log(void) {
    double worst = 0;
    for (int i = 0; i < TRIES; i++) {
        double x = i % 3 == 0   ? exp2(uniform(-1074, 1023.9))
                   : i % 3 == 1 ? uniform(0.4, 2.5)
                                : 1 + any(-52, -1.1);
        WORST(log(x), series_log(x));
    }
    CHECK_NEAR(0, worst, 6e-16);
    CHECK(series_log(1) == 0);
    CHECK(series_log(0) == -HUGE_VAL && series_log(HUGE_VAL) == HUGE_VAL);
    CHECK(isnan(series_log(-1)) && isnan(series_log(NAN)) && isnan(series_log(-HUGE_VAL)));
}

static void test_power(void) {
    double worst = 0, whole = 0;
    for (int i = 0; i < TRIES; i++) {
        double x = i & 1 ? exp2(uniform(-30, 30)) : 1 + any(-30, -2), y = any(-4, 4.5);
        WORST(pow(x, y), series_power(x, y));
    }
    CHECK_NEAR(0, worst, bound);
    for (int i = 0; i < TRIES; i++) {
        double x = any(-3, 3), n = floor(uniform(-300, 300));
        WORST(pow(x, n), series_power(x, n));
        whole = fmax(whole, error_of(pow(x, n), series_power(x, n)));
    }
    CHECK_NEAR(0, whole, 4e-16);
    for (int n = -1022; n <= 1023; n++) /* exact where that can be */
        CHECK(series_power(2, n) == ldexp(1, n));
    int64_t power = 1;
    for (int n = 0; n <= 33; n++, power *= 3) {
        CHECK(series_power(3, n) == (double)power);
        CHECK(series_power(-3, n) == (double)(n & 1 ? -power : power));
    }
    CHECK(series_power(2, 0.5) == sqrt(2));
    CHECK_NEAR(0, error_of(pow(1.5, 1500), series_power(1.5, 1500)), bound);
    CHECK_NEAR(0, error_of(pow(-1.01, 30001), series_power(-1.01, 30001)), bound);
}

/* Every pair of odd numbers, as C's pow has it. */
static void test_power_extremes(void) {
    const double value[] = {0.0,      -0.0,      1,    -1,    0.5,   -0.5,    2,
                            -2,       3,         -3,   1e9,   1e300, 1e301,   -1e301,
                            1e-300,   -1e-300,   1e18, 0.7,   2.5,   -2.5,    NAN,
                            HUGE_VAL, -HUGE_VAL, 1025, -1025, 7,     1.7e308, 5e-324};
    int count = (int)(sizeof value / sizeof *value);
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < count; k++) {
            double expected = pow(value[i], value[k]), actual = series_power(value[i], value[k]);
            if (!CHECK(error_of(expected, actual) <= bound ||
                       fabs(expected - actual) < 2 * DBL_MIN))
                fprintf(stderr, "%g ^ %g: %g not %g\n", value[i], value[k], actual, expected);
            CHECK(isnan(expected) || signbit(expected) == signbit(actual));
        }
    }
}

static void test_sine_cosine(void) {
    double worst = 0, s, c;
    for (int i = 0; i < TRIES; i++) {
        double x = i % 3 == 0 ? uniform(-10, 10) : i % 3 == 1 ? any(-40, 19.9) : 0;
        if (i % 3 == 2) /* next to multiples of a quarter turn */
            x = (floor(uniform(-600000, 600000)) * 1.57079632679489661923) * (1 + any(-52, -30));
        series_sine_cosine(&s, &c, x);
        WORST(sin(x), s);
        WORST(cos(x), c);
        WORST(tan(x), series_tangent(x));
    }
    CHECK_NEAR(0, worst, 1e-15);
    series_sine_cosine(&s, &c, 0);
    CHECK(s == 0 && c == 1);
    series_sine_cosine(&s, &c, HUGE_VAL);
    CHECK(isnan(s) && isnan(c));
    series_sine_cosine(&s, &c, NAN);
    CHECK(isnan(s) && isnan(c));
    for (int i = 0; i < 1000; i++) { /* far out: as if the angle was off by half its last bit */
        double x = any(20, 40), slack = fabs(x) * 0x1p-53;
        series_sine_cosine(&s, &c, x);
        CHECK_NEAR(sin(x), s, slack);
        CHECK_NEAR(cos(x), c, slack);
        CHECK_NEAR(1, s * s + c * c, 1e-15);
    }
}

static void test_arcs(void) {
    double worst = 0;
    for (int i = 0; i < TRIES; i++) {
        double x = any(-40, 40), y = any(-40, 40), unit = i & 1 ? uniform(-1, 1) : any(-40, 0);
        double near = copysign(1 - exp2(uniform(-52, -2)), unit);
        WORST(atan2(y, x), series_arctangent2(y, x));
        WORST(atan(x), series_arctangent(x));
        WORST(asin(unit), series_arcsine(unit));
        WORST(acos(unit), series_arccosine(unit));
        WORST(asin(near), series_arcsine(near));
        WORST(acos(near), series_arccosine(near));
    }
    CHECK_NEAR(0, worst, 1e-15);
    CHECK(isnan(series_arcsine(1.1)) && isnan(series_arccosine(-1.1)));
    CHECK(isnan(series_arcsine(NAN)) && isnan(series_arccosine(NAN)));
    CHECK(series_arcsine(1) == asin(1) && series_arccosine(1) == 0);
    const double value[] = {0.0, -0.0, 1, -1, HUGE_VAL, -HUGE_VAL, NAN, 5e-324, 1e308};
    for (int i = 0; i < 81; i++) {
        double y = value[i / 9], x = value[i % 9], expected = atan2(y, x);
        CHECK(error_of(expected, series_arctangent2(y, x)) < bound);
        CHECK(isnan(expected) || signbit(expected) == signbit(series_arctangent2(y, x)));
    }
}

static void test_hypotenuse(void) {
    double worst = 0;
    for (int i = 0; i < TRIES; i++) {
        double low = i & 1 ? -1000 : -5, x = any(low, low + 10), y = any(low, low + 10);
        WORST(hypot(x, y), series_hypotenuse(x, y));
        x = any(1000, 1020), y = any(1000, 1020);
        WORST(hypot(x, y), series_hypotenuse(x, y));
    }
    CHECK_NEAR(0, worst, 6e-16);
    CHECK(series_hypotenuse(3, 4) == 5 && series_hypotenuse(0, 0) == 0);
    CHECK(series_hypotenuse(NAN, -HUGE_VAL) == HUGE_VAL && isnan(series_hypotenuse(NAN, 1)));
    CHECK(isnan(series_hypotenuse(1, NAN)) && isnan(series_hypotenuse(NAN, 0)));
}

int main(void) {
    RUN(test_exp);
    RUN(test_log);
    RUN(test_power);
    RUN(test_power_extremes);
    RUN(test_sine_cosine);
    RUN(test_arcs);
    RUN(test_hypotenuse);
    return check_verdict();
}
