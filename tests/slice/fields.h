/* Fields of the tests' own, with formulas and bounds that the engine has no part in. */
#ifndef TESTS_SLICE_FIELDS_H
#define TESTS_SLICE_FIELDS_H

#include <math.h>

#include "field/field.h"
#include "models/shapes.h"

typedef enum test_kind {
    TEST_PLANE,  /* a . p, a = center */
    TEST_ROUND,  /* distance from center, components weighed: 1 1 1 a sphere, 1 1 0 a cylinder */
    TEST_CONE,   /* z + slope * distance from the axis through center */
    TEST_WAVE,   /* z + slope * sin(2 pi x / length) */
    TEST_SADDLE, /* (x - cx) (y - cy) slope + z weigh.z */
    TEST_ROOT    /* sqrt(x - cx): no value on one side */
} test_kind;

typedef struct test_field {
    iso_field field;
    test_kind kind;
    iso_vec3 center, weigh;
    double slope, length;
} test_field;

static double test_value(const test_field *f, iso_vec3 p) {
    double x = p.x - f->center.x, y = p.y - f->center.y, z = p.z - f->center.z;
    switch (f->kind) {
    case TEST_PLANE:
        return f->center.x * p.x + f->center.y * p.y + f->center.z * p.z;
    case TEST_ROUND:
        return sqrt(f->weigh.x * x * x + f->weigh.y * y * y + f->weigh.z * z * z);
    case TEST_CONE:
        return p.z + f->slope * hypot(x, y);
    case TEST_WAVE:
        return p.z + f->slope * sin(2 * SHAPE_PI * p.x / f->length);
    case TEST_SADDLE:
        return x * y * f->slope + p.z * f->weigh.z;
    case TEST_ROOT:
        return sqrt(x);
    }
    return NAN;
}

static iso_vec3 test_gradient(const test_field *f, iso_vec3 p) {
    double x = p.x - f->center.x, y = p.y - f->center.y, z = p.z - f->center.z;
    double far = test_value(f, p), k = 2 * SHAPE_PI / f->length, across = hypot(x, y);
    switch (f->kind) {
    case TEST_PLANE:
        return f->center;
    case TEST_ROUND:
        return far > 0
                   ? (iso_vec3){f->weigh.x * x / far, f->weigh.y * y / far, f->weigh.z * z / far}
                   : (iso_vec3){0, 0, 0};
    case TEST_CONE:
        return across > 0 ? (iso_vec3){f->slope * x / across, f->slope * y / across, 1}
                          : (iso_vec3){0, 0, 1};
    case TEST_WAVE:
        return (iso_vec3){f->slope * k * cos(k * p.x), 0, 1};
    case TEST_SADDLE:
        return (iso_vec3){y * f->slope, x * f->slope, f->weigh.z};
    case TEST_ROOT:
        return (iso_vec3){0.5 / sqrt(x), 0, 0};
    }
    return (iso_vec3){NAN, NAN, NAN};
}

static void test_evaluate(double *value, iso_vec3 *gradient, const iso_field *field,
                          const iso_vec3 *at, int64_t count) {
    const test_field *f = (const test_field *)(const void *)field;
    for (int64_t i = 0; i < count; i++) {
        value[i] = test_value(f, at[i]);
        if (gradient)
            gradient[i] = test_gradient(f, at[i]);
    }
}

/* x from low to high, squared */
static void square(double out[2], double low, double high) {
    double a = low * low, b = high * high;
    out[0] = low <= 0 && high >= 0 ? 0 : a < b ? a : b;
    out[1] = a > b ? a : b;
}

/* w x / sqrt(w x^2 + s): rises with x, and falls or rises with s as x is above or below 0 */
static double part(double w, double x, double s_least, double s_most) {
    double s = x < 0 ? s_least : s_most, root = sqrt(w * x * x + s);
    return root > 0 ? w * x / root : 0;
}

static void bound_round(iso_field_bound *b, const iso_vec3 weigh, iso_vec3 l, iso_vec3 h) {
    double w[3] = {weigh.x, weigh.y, weigh.z}, low[3] = {l.x, l.y, l.z}, high[3] = {h.x, h.y, h.z};
    double s[3][2], g[2][3], least = 0, most = 0;
    for (int k = 0; k < 3; k++) {
        square(s[k], low[k], high[k]);
        least += w[k] * s[k][0], most += w[k] * s[k][1];
    }
    for (int k = 0; k < 3; k++) {
        int m = (k + 1) % 3, n = (k + 2) % 3;
        double s0 = w[m] * s[m][0] + w[n] * s[n][0], s1 = w[m] * s[m][1] + w[n] * s[n][1];
        int zero = s0 == 0 && low[k] <= 0 && high[k] >= 0;
        g[0][k] = zero && low[k] == 0 ? 0 : part(w[k], low[k], s0, s1);
        g[1][k] = zero && high[k] == 0 ? 0 : -part(w[k], -high[k], s0, s1);
    }
    b->low = sqrt(least), b->high = sqrt(most);
    b->gradient_low = (iso_vec3){g[0][0], g[0][1], g[0][2]};
    b->gradient_high = (iso_vec3){g[1][0], g[1][1], g[1][2]};
}

static void test_bound(iso_field_bound *b, const iso_field *field, iso_vec3 low, iso_vec3 high) {
    const test_field *f = (const test_field *)(const void *)field;
    iso_vec3 c = f->center, l = {low.x - c.x, low.y - c.y, low.z - c.z};
    iso_vec3 h = {high.x - c.x, high.y - c.y, high.z - c.z};
    double s = f->slope, k = 2 * SHAPE_PI / f->length;
    *b = (iso_field_bound){-INFINITY, INFINITY, {0, 0, 0}, {0, 0, 0}};
    switch (f->kind) {
    case TEST_PLANE:
        b->gradient_low = b->gradient_high = c;
        break;
    case TEST_ROUND:
        bound_round(b, f->weigh, l, h);
        break;
    case TEST_CONE:
        bound_round(b, (iso_vec3){1, 1, 0}, l, h);
        b->low = low.z + s * b->low, b->high = high.z + s * b->high; /* s >= 0 */
        b->gradient_low = (iso_vec3){s * b->gradient_low.x, s * b->gradient_low.y, 1};
        b->gradient_high = (iso_vec3){s * b->gradient_high.x, s * b->gradient_high.y, 1};
        break;
    case TEST_WAVE: {
        double at = cos(k * 0.5 * (low.x + high.x)), width = 0.5 * k * (high.x - low.x);
        double from = fmax(-1, at - width), to = fmin(1, at + width);
        b->low = low.z - s, b->high = high.z + s;
        b->gradient_low = (iso_vec3){s * k * from, 0, 1};
        b->gradient_high = (iso_vec3){s * k * to, 0, 1};
        break;
    }
    case TEST_SADDLE:
        b->gradient_low = (iso_vec3){l.y * s, l.x * s, f->weigh.z};
        b->gradient_high = (iso_vec3){h.y * s, h.x * s, f->weigh.z};
        break;
    case TEST_ROOT:
        b->gradient_low = (iso_vec3){-INFINITY, 0, 0};
        b->gradient_high = (iso_vec3){INFINITY, 0, 0};
        break;
    }
}

static const field_operations test_operations = {ISO_FIELD_FUNCTION, test_evaluate, test_bound,
                                                 NULL};

static inline test_field test_plane(double x, double y, double z) {
    return (test_field){{&test_operations}, TEST_PLANE, {x, y, z}, {0, 0, 0}, 0, 1};
}
static inline test_field test_round(double x, double y, double z, iso_vec3 weigh) {
    return (test_field){{&test_operations}, TEST_ROUND, {x, y, z}, weigh, 0, 1};
}
static inline test_field test_cone(double x, double y, double slope) {
    return (test_field){{&test_operations}, TEST_CONE, {x, y, 0}, {0, 0, 0}, slope, 1};
}
static inline test_field test_wave(double amplitude, double length) {
    return (test_field){{&test_operations}, TEST_WAVE, {0, 0, 0}, {0, 0, 0}, amplitude, length};
}
static inline test_field test_saddle(double x, double y, double bend, double z) {
    return (test_field){{&test_operations}, TEST_SADDLE, {x, y, 0}, {0, 0, z}, bend, 1};
}
static inline test_field test_root(double x) {
    return (test_field){{&test_operations}, TEST_ROOT, {x, 0, 0}, {0, 0, 0}, 0, 1};
}

#endif
