/* Fields with formulas short enough to be right at sight, for tests of what stands on fields. */
#ifndef TESTS_CHART_ANALYTIC_H
#define TESTS_CHART_ANALYTIC_H

#include <math.h>

#include "base/vector.h"
#include "field/field.h"

typedef struct analytic {
    iso_field base;
    field_operations operations;
    double a, b; /* of the formula */
    long calls, points;
} analytic;

static void analytic_bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low,
                           iso_vec3 high) {
    (void)field, (void)low, (void)high;
    *bound = (iso_field_bound){-HUGE_VAL, HUGE_VAL, vec3(-HUGE_VAL, -HUGE_VAL, -HUGE_VAL),
                               vec3(HUGE_VAL, HUGE_VAL, HUGE_VAL)};
}

static void analytic_bound_even(iso_field_bound *bound, const iso_field *field, iso_vec3 low,
                                iso_vec3 high) {
    analytic_bound(bound, field, low, high);
    bound->gradient_low.z = bound->gradient_high.z = 1;
}

static void analytic_free(iso_field *field) {
    (void)field;
}

#define ANALYTIC(name, value_of, gx, gy, gz)                                                       \
    static void name(double *value, iso_vec3 *gradient, const iso_field *field,                    \
                     const iso_vec3 *at, int64_t count) {                                          \
        analytic *self = (analytic *)field; /* the first member */                                 \
        double a = self->a, b = self->b;                                                           \
        self->calls++;                                                                             \
        self->points += (long)count;                                                               \
        for (int64_t i = 0; i < count; i++) {                                                      \
            double x = at[i].x, y = at[i].y, z = at[i].z;                                          \
            (void)x, (void)y, (void)z, (void)a, (void)b;                                           \
            double F = value_of;                                                                   \
            value[i] = F;                                                                          \
            if (gradient)                                                                          \
                gradient[i] = vec3(gx, gy, gz);                                                    \
        }                                                                                          \
    }

/* The tip of the cone is rounded a little: its slope is 0 there. */
ANALYTIC(cone, z + a * sqrt(x * x + y * y), a *x / fmax(sqrt(x * x + y * y), 1e-9),
         a *y / fmax(sqrt(x * x + y * y), 1e-9), 1)
ANALYTIC(wave, z + a * sin(x / b), a / b * cos(x / b), 0, 1)
ANALYTIC(tilted, (z + a * x) / sqrt(1 + a * a), a / sqrt(1 + a * a), 0, 1 / sqrt(1 + a * a))
/* Distance from a point at z = -a. */
ANALYTIC(sphere, sqrt(x *x + y * y + (z + a) * (z + a)), x / F, y / F, (z + a) / F)
/* Distance from the axis x at z = -a. */
ANALYTIC(cylinder, sqrt(y *y + (z + a) * (z + a)), 0, y / F, (z + a) / F)
/* b times the angle around the axis y at z = 0. */
ANALYTIC(fan, b *atan2(z, x), -b *z / (x * x + z * z), 0, b *x / (x * x + z * z))
/* z + a sin(z) bent: uneven in z. */
ANALYTIC(uneven, z *(1 + a * x * x) + b * y * y, 2 * a * x * z, 2 * b * y, 1 + a * x * x)
/* No value below the plane z = x - a. */
ANALYTIC(rooted, sqrt(z - x + a), -0.5 / F, 0, 0.5 / F)

static analytic analytic_field(iso_field_kind kind, double a, double b) {
    analytic f = {.a = a, .b = b};
    f.operations = (field_operations){.kind = kind, .free = analytic_free, .bound = analytic_bound};
    switch (kind) {
    case ISO_FIELD_CONE:
        f.operations.evaluate = cone;
        f.operations.bound = analytic_bound_even;
        break;
    case ISO_FIELD_WAVE:
        f.operations.evaluate = wave;
        f.operations.bound = analytic_bound_even;
        break;
    case ISO_FIELD_PLANE:
        f.operations.evaluate = tilted;
        break;
    case ISO_FIELD_SPHERE:
        f.operations.evaluate = sphere;
        break;
    case ISO_FIELD_CYLINDER:
        f.operations.evaluate = cylinder;
        break;
    case ISO_FIELD_FAN:
        f.operations.evaluate = fan;
        break;
    case ISO_FIELD_FUNCTION:
        f.operations.evaluate = uneven;
        break;
    default:
        f.operations.kind = ISO_FIELD_FUNCTION;
        f.operations.evaluate = rooted;
    }
    return f;
}

/* After it has its place. */
static iso_field *analytic_use(analytic *f) {
    f->base.operations = &f->operations;
    return &f->base;
}

#endif
