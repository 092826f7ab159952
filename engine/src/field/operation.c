#include "field/operation.h"

#include <math.h>
#include <string.h>

#include "base/series.h"

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
OPERATION2(apply_hypot, series_hypotenuse(a, b))

static void apply_ramp(double *to, const double *const *from, int32_t count) {
    for (int32_t i = 0; i < count; i++)
        to[i] = ramp(from[0][i], from[1][i], from[2][i], from[3][i], from[4][i]);
}

static const iso_operation table[] = {
    [OPERATION_NEGATE] = {NULL, 1, 0, apply_negate},
    [OPERATION_ADD] = {NULL, 2, 0, apply_add},
    [OPERATION_SUBTRACT] = {NULL, 2, 0, apply_subtract},
    [OPERATION_MULTIPLY] = {NULL, 2, 0, apply_multiply},
    [OPERATION_DIVIDE] = {NULL, 2, 0, apply_divide},
    [OPERATION_POWER] = {NULL, 2, 0, apply_power},
    [OPERATION_LESS] = {NULL, 2, 0, apply_less},
    [OPERATION_LESS_EQUAL] = {NULL, 2, 0, apply_less_equal},
    [OPERATION_GREATER] = {NULL, 2, 0, apply_greater},
    [OPERATION_GREATER_EQUAL] = {NULL, 2, 0, apply_greater_equal},
    [OPERATION_EQUAL] = {NULL, 2, 0, apply_equal},
    [OPERATION_UNEQUAL] = {NULL, 2, 0, apply_unequal},
    [OPERATION_SELECT] = {NULL, 3, 0, apply_select},
    {"abs", 1, 0, apply_abs},
    {"sqrt", 1, 0, apply_sqrt},
    {"min", 2, 1, apply_min},
    {"max", 2, 1, apply_max},
    {"clamp", 3, 0, apply_clamp},
    {"floor", 1, 0, apply_floor},
    {"ceil", 1, 0, apply_ceil},
    {"round", 1, 0, apply_round},
    {"mod", 2, 0, apply_mod},
    {"sin", 1, 0, apply_sin},
    {"cos", 1, 0, apply_cos},
    {"tan", 1, 0, apply_tan},
    {"asin", 1, 0, apply_asin},
    {"acos", 1, 0, apply_acos},
    {"atan", 1, 0, apply_atan},
    {"atan2", 2, 0, apply_atan2},
    {"exp", 1, 0, apply_exp},
    {"log", 1, 0, apply_log},
    {"hypot", 2, 0, apply_hypot},
    {"ramp", 5, 0, apply_ramp},
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
