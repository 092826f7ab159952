#include "field/operation.h"

#include <math.h>
#include <string.h>

#include "base/series.h"
#include "field/slope.h"
#include "field/enclosure.h"

/* A function of whole arrays from an expression in a, b ... of one value of each. */
#define OPERATION1(name, value)                                                                    \
    static void name(double *to, const double *const *from, int32_t count) {                       \
        const double *from_a = from[0];                                                            \
        for (int32_t i = 0; i < count; i++) {                                                      \
            double a = from_a[i];                                                                  \
            to[i] = value;                                                                         \
        }                                                                                          \
    }
#define OPERATION2(name, value)                                                                    \
    static void name(double *to, const double *const *from, int32_t count) {                       \
        const double *from_a = from[0], *from_b = from[1];                                         \
        for (int32_t i = 0; i < count; i++) {                                                      \
            double a = from_a[i], b = from_b[i];                                                   \
            to[i] = value;                                                                         \
        }                                                                                          \
    }
#define OPERATION3(name, value)                                                                    \
    static void name(double *to, const double *const *from, int32_t count) {                       \
        for (int32_t i = 0; i < count; i++) {                                                      \
            double a = from[0][i], b = from[1][i], c = from[2][i];                                 \
            to[i] = value;                                                                         \
        }                                                                                          \
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

/* NaN, wherever it stands, stays NaN. */
static double smaller(double a, double b) {
    return a < b || isnan(a) ? a : b;
}

static double larger(double a, double b) {
    return a > b || isnan(a) ? a : b;
}

/* The remainder has the divisor's sign. */
static double modulus(double a, double b) {
    double rest = fmod(a, b);
    if (rest != 0)
        return (rest < 0) == (b < 0) ? rest : rest + b;
    return copysign(rest, b);
}

static double ramp(double v, double from, double to, double a, double b) {
    if (from == to)
        return v < from ? a : v >= from ? b : v;
    double t = (v - from) / (to - from);
    return t <= 0 ? a : t >= 1 ? b : a + (b - a) * t;
}

/* ---- of arrays ---- */

OPERATION1(apply_negate, -a)
OPERATION2(apply_add, a + b)
OPERATION2(apply_subtract, a - b)
OPERATION2(apply_multiply, a *b)
OPERATION2(apply_divide, a / b)
OPERATION2(apply_power, series_power(a, b))
OPERATION2(apply_less, a < b)
OPERATION2(apply_less_equal, a <= b)
OPERATION2(apply_greater, a > b)
OPERATION2(apply_greater_equal, a >= b)
OPERATION2(apply_equal, a == b)
OPERATION2(apply_unequal, a != b)
OPERATION3(apply_select, a != 0 ? b : c)
OPERATION1(apply_square, a *a)
OPERATION3(apply_norm3, sqrt(a *a + b * b + c * c))
OPERATION1(apply_abs, fabs(a))
OPERATION1(apply_sqrt, sqrt(a))
OPERATION2(apply_min, smaller(a, b))
OPERATION2(apply_max, larger(a, b))
OPERATION3(apply_clamp, a<b ? b : a> c ? c : a)
OPERATION1(apply_floor, floor(a))
OPERATION1(apply_ceil, ceil(a))
OPERATION1(apply_round, round(a))
OPERATION2(apply_mod, modulus(a, b))
OPERATION1(apply_sin, sine(a))
OPERATION1(apply_cos, cosine(a))
OPERATION1(apply_tan, series_tangent(a))
OPERATION1(apply_asin, series_arcsine(a))
OPERATION1(apply_acos, series_arccosine(a))
OPERATION1(apply_atan, series_arctangent(a))
OPERATION2(apply_atan2, series_arctangent2(a, b))
OPERATION1(apply_exp, series_exp(a))
OPERATION1(apply_log, series_log(a))

/* As series_hypotenuse has it: that is for squares that leave the range, which are few, so that the
 * compiler makes vectors of the rest. */
static void apply_hypot(double *to, const double *const *from, int32_t count) {
    const double *a = from[0], *b = from[1];
    int32_t common = 0;
    for (int32_t i = 0; i < count; i++) {
        double square = a[i] * a[i] + b[i] * b[i];
        common += square > 1e-270 && square < 1e270;
    }
    if (common < count)
        for (int32_t i = 0; i < count; i++)
            to[i] = series_hypotenuse(a[i], b[i]);
    else
        for (int32_t i = 0; i < count; i++)
            to[i] = sqrt(a[i] * a[i] + b[i] * b[i]);
}

static void apply_ramp(double *to, const double *const *from, int32_t count) {
    for (int32_t i = 0; i < count; i++)
        to[i] = ramp(from[0][i], from[1][i], from[2][i], from[3][i], from[4][i]);
}

static const iso_operation table[] = {
    [OPERATION_NEGATE] = {NULL, 1, 0, apply_negate, enclose_negate, NULL, {-1}},
    [OPERATION_ADD] = {NULL, 2, 0, apply_add, enclose_add, NULL, {1, 1}},
    [OPERATION_SUBTRACT] = {NULL, 2, 0, apply_subtract, enclose_subtract, NULL, {1, -1}},
    [OPERATION_MULTIPLY] = {NULL, 2, 0, apply_multiply, enclose_multiply, slope_multiply, {0}},
    [OPERATION_DIVIDE] = {NULL, 2, 0, apply_divide, enclose_divide, slope_divide, {0}},
    [OPERATION_POWER] = {NULL, 2, 0, apply_power, enclose_power, slope_power, {0}},
    [OPERATION_LESS] = {NULL, 2, 0, apply_less, enclose_less, NULL, {0, 0}},
    [OPERATION_LESS_EQUAL] = {NULL, 2, 0, apply_less_equal, enclose_less_equal, NULL, {0, 0}},
    [OPERATION_GREATER] = {NULL, 2, 0, apply_greater, enclose_greater, NULL, {0, 0}},
    [OPERATION_GREATER_EQUAL] =
        {NULL, 2, 0, apply_greater_equal, enclose_greater_equal, NULL, {0, 0}},
    [OPERATION_EQUAL] = {NULL, 2, 0, apply_equal, enclose_equal, NULL, {0, 0}},
    [OPERATION_UNEQUAL] = {NULL, 2, 0, apply_unequal, enclose_unequal, NULL, {0, 0}},
    [OPERATION_SELECT] = {NULL, 3, 0, apply_select, enclose_select, slope_select, {0}},
    [OPERATION_SQUARE] = {NULL, 1, 0, apply_square, enclose_square, slope_square, {0}},
    [OPERATION_NORM3] = {NULL, 3, 0, apply_norm3, enclose_norm3, slope_norm3, {0}},
    [OPERATION_ABS] = {"abs", 1, 0, apply_abs, enclose_abs, slope_abs, {0}},
    [OPERATION_SQRT] = {"sqrt", 1, 0, apply_sqrt, enclose_sqrt, slope_sqrt, {0}},
    [OPERATION_HYPOT] = {"hypot", 2, 0, apply_hypot, enclose_hypot, slope_hypot, {0}},
    {"min", 2, 1, apply_min, enclose_min, slope_min, {0}},
    {"max", 2, 1, apply_max, enclose_max, slope_max, {0}},
    {"clamp", 3, 0, apply_clamp, enclose_clamp, slope_clamp, {0}},
    {"floor", 1, 0, apply_floor, enclose_floor, NULL, {0}},
    {"ceil", 1, 0, apply_ceil, enclose_ceil, NULL, {0}},
    {"round", 1, 0, apply_round, enclose_round, NULL, {0}},
    {"mod", 2, 0, apply_mod, enclose_mod, slope_mod, {0}},
    {"sin", 1, 0, apply_sin, enclose_sin, slope_sin, {0}},
    {"cos", 1, 0, apply_cos, enclose_cos, slope_cos, {0}},
    {"tan", 1, 0, apply_tan, enclose_tan, slope_tan, {0}},
    {"asin", 1, 0, apply_asin, enclose_asin, slope_asin, {0}},
    {"acos", 1, 0, apply_acos, enclose_acos, slope_acos, {0}},
    {"atan", 1, 0, apply_atan, enclose_atan, slope_atan, {0}},
    {"atan2", 2, 0, apply_atan2, enclose_atan2, slope_atan2, {0}},
    {"exp", 1, 0, apply_exp, enclose_exp, slope_exp, {0}},
    {"log", 1, 0, apply_log, enclose_log, slope_log, {0}},
    {"ramp", 5, 0, apply_ramp, enclose_ramp, slope_ramp, {0}},
};

const iso_operation *operation_at(int32_t index) {
    return &table[index];
}

int32_t operation_find(const char *name, int32_t length) {
    for (int32_t i = OPERATION_FUNCTIONS; i < (int32_t)(sizeof table / sizeof *table); i++)
        if (strlen(table[i].name) == (size_t)length && !memcmp(table[i].name, name, (size_t)length))
            return i;
    return -1;
}
