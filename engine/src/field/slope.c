#include "field/slope.h"

#include <math.h>
#include <stddef.h>

#include "base/series.h"

/* Each derivative is wanted or not, so each has a loop of its own: short ones, that the compiler
 * makes vectors of. `a`, `b`, `c` are the operands' values, v is the result's. */
#define SLOPE(k, derivative)                                                                       \
    if (slope[k]) {                                                                                \
        double *restrict to = slope[k];                                                            \
        const double *from_a = from[0], *from_b = from[OPERANDS > 1],                              \
                     *from_c = from[OPERANDS - 1];                                                 \
        for (int32_t i = 0; i < count; i++) {                                                      \
            double a = from_a[i], b = from_b[i], c = from_c[i], v = value[i];                      \
            (void)a, (void)b, (void)c, (void)v;                                                    \
            to[i] = derivative;                                                                    \
        }                                                                                          \
    }
#define SLOPE_OF1(name, by_a)                                                                      \
    void name(double *const *slope, const double *const *from, const double *value,                \
              int32_t count) {                                                                     \
        enum { OPERANDS = 1 };                                                                     \
        SLOPE(0, by_a)                                                                             \
    }
#define SLOPE_OF2(name, by_a, by_b)                                                                \
    void name(double *const *slope, const double *const *from, const double *value,                \
              int32_t count) {                                                                     \
        enum { OPERANDS = 2 };                                                                     \
        SLOPE(0, by_a)                                                                             \
        SLOPE(1, by_b)                                                                             \
    }
#define SLOPE_OF3(name, by_a, by_b, by_c)                                                          \
    void name(double *const *slope, const double *const *from, const double *value,                \
              int32_t count) {                                                                     \
        enum { OPERANDS = 3 };                                                                     \
        SLOPE(0, by_a)                                                                             \
        SLOPE(1, by_b)                                                                             \
        SLOPE(2, by_c)                                                                             \
    }

/* ---- of single values ---- */

static double sine(double a) {
    double s, c;
    series_sine_cosine(&s, &c, a);
    return s;
}

static double cosine(double a) {
    double s, c;
    series_sine_cosine(&s, &c, a);
    return c;
}

/* Nothing over nothing, at the tip of a norm, is nothing. */
static double share(double a, double norm) {
    return norm > 0 ? a / norm : 0;
}

/* a / (a^2 + b^2) */
static double by_square(double a, double b) {
    double norm = series_hypotenuse(a, b);
    return norm > 0 ? a / norm / norm : 0;
}

/* ---- of arrays ---- */

SLOPE_OF2(slope_multiply, b, a)
SLOPE_OF2(slope_divide, 1 / b, -v / b)
SLOPE_OF2(slope_power, b == 0 ? 0 : b * series_power(a, b - 1), a == 0 ? 0 : v * series_log(a))
SLOPE_OF3(slope_select, 0, a != 0, a == 0)
SLOPE_OF1(slope_square, 2 * a)
SLOPE_OF3(slope_norm3, share(a, v), share(b, v), share(c, v))
SLOPE_OF1(slope_abs, a > 0 ? 1 : a < 0 ? -1 : 0)
SLOPE_OF1(slope_sqrt, 0.5 / v)
SLOPE_OF2(slope_min, a < b ? 1 : 0, a < b ? 0 : 1)
SLOPE_OF2(slope_max, a > b ? 1 : 0, a > b ? 0 : 1)
SLOPE_OF3(slope_clamp, a<b || a> c ? 0 : 1, a<b, a >= b && a> c)
SLOPE_OF2(slope_mod, 1, -floor(a / b))
SLOPE_OF1(slope_sin, cosine(a))
SLOPE_OF1(slope_cos, -sine(a))
SLOPE_OF1(slope_tan, 1 + v * v)
SLOPE_OF1(slope_asin, 1 / sqrt((1 - a) * (1 + a)))
SLOPE_OF1(slope_acos, -1 / sqrt((1 - a) * (1 + a)))
SLOPE_OF1(slope_atan, 1 / (1 + a * a))
SLOPE_OF2(slope_atan2, by_square(b, a), -by_square(a, b))
SLOPE_OF1(slope_exp, v)
SLOPE_OF1(slope_log, 1 / a)
SLOPE_OF2(slope_hypot, share(a, v), share(b, v))

/* ramp(v, from, to, a, b) by each of them: t is the share of the way. */
static void ramp_at(double to[5], const double v[5]) {
    double length = v[2] - v[1], t = (v[0] - v[1]) / length, rise = v[4] - v[3];
    bool below = length == 0 ? v[0] < v[1] : t <= 0, above = length == 0 ? !below : t >= 1;
    bool between = !below && !above;
    to[0] = between ? rise / length : 0;
    to[1] = between ? rise * (t - 1) / length : 0;
    to[2] = between ? -rise * t / length : 0;
    to[3] = below ? 1 : above ? 0 : 1 - t;
    to[4] = below ? 0 : above ? 1 : t;
}

void slope_ramp(double *const *slope, const double *const *from, const double *value,
                int32_t count) {
    for (int32_t i = 0; i < count; i++) {
        double v[5], to[5];
        for (int k = 0; k < 5; k++)
            v[k] = from[k][i];
        ramp_at(to, v);
        for (int k = 0; k < 5; k++)
            if (slope[k])
                slope[k][i] = to[k];
    }
}
