/* Fields of simple shapes. Where there is no gradient (a sphere's center, an axis) it is 0, or what
 * is left of it. */
#include "field/field.h"

#include <math.h>
#include <stddef.h>

#include "base/angle.h"
#include "base/memory.h"
#include "base/series.h"
#include "base/vector.h"

typedef struct shape_field {
    iso_field base;
    field_shape shape;
    double sine, cosine; /* of a cone's slope */
    double amplitude;    /* of a wave */
    iso_vec2 turn;       /* of a wave: radians a mm */
    iso_vec3 up;         /* of a fan: where its angles rise to at first */
} shape_field;

static const shape_field *shape_of(const iso_field *field) {
    return (const shape_field *)field;
}

/* Over what may be nothing. */
static inline double share(double a, double length) {
    return length > 0 ? a / length : 0;
}

/* ---- plane ---- */

static void plane_evaluate(double *value, iso_vec3 *gradient, const iso_field *field,
                           const iso_vec3 *at, int64_t count) {
    iso_vec3 n = shape_of(field)->shape.axis;
    for (int64_t i = 0; i < count; i++)
        value[i] = vec3_dot(n, at[i]);
    for (int64_t i = 0; gradient && i < count; i++)
        gradient[i] = n;
}

static void plane_bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low,
                        iso_vec3 high) {
    iso_vec3 n = shape_of(field)->shape.axis;
    interval box[3], gradient[3] = {interval_at(n.x), interval_at(n.y), interval_at(n.z)};
    field_box(box, low, high);
    interval value = interval_add(interval_scale(n.x, box[0]), interval_scale(n.y, box[1]));
    value = interval_add(value, interval_scale(n.z, box[2]));
    field_bound_set(bound, value, gradient);
}

/* ---- cylinder: an axis along x, y or z, which is made known to the compiler ---- */

static inline double across(iso_vec3 p, int axis, int which) {
    return which == 0 ? (axis == 0 ? p.y : p.x) : (axis == 2 ? p.y : p.z);
}

static inline iso_vec3 back(double a, double b, int axis) {
    return axis == 0 ? vec3(0, a, b) : axis == 1 ? vec3(a, 0, b) : vec3(a, b, 0);
}

static inline void along(double *value, iso_vec3 *gradient, const iso_field *field,
                         const iso_vec3 *at, int64_t count, int axis) {
    iso_vec3 center = shape_of(field)->shape.center;
    double from_a = across(center, axis, 0), from_b = across(center, axis, 1);
    for (int64_t i = 0; i < count; i++) {
        double a = across(at[i], axis, 0) - from_a, b = across(at[i], axis, 1) - from_b;
        double distance = sqrt(a * a + b * b);
        value[i] = distance;
        if (gradient)
            gradient[i] = back(share(a, distance), share(b, distance), axis);
    }
}

static int axis_of(const iso_field *field) {
    iso_vec3 axis = shape_of(field)->shape.axis;
    return axis.x != 0 ? 0 : axis.y != 0 ? 1 : 2;
}

static void cylinder_evaluate(double *value, iso_vec3 *gradient, const iso_field *field,
                              const iso_vec3 *at, int64_t count) {
    int axis = axis_of(field);
    if (axis == 0)
        along(value, gradient, field, at, count, 0);
    else if (axis == 1)
        along(value, gradient, field, at, count, 1);
    else
        along(value, gradient, field, at, count, 2);
}

static interval beside(double low, double high, double center) {
    return interval_subtract((interval){low, high}, interval_at(center));
}

static void cylinder_bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low,
                           iso_vec3 high) {
    iso_vec3 center = shape_of(field)->shape.center;
    int axis = axis_of(field), first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
    interval a = beside(across(low, axis, 0), across(high, axis, 0), across(center, axis, 0));
    interval b = beside(across(low, axis, 1), across(high, axis, 1), across(center, axis, 1));
    interval gradient[3] = {{0, 0}, {0, 0}, {0, 0}};
    gradient[first] = interval_share(a, b);
    gradient[second] = interval_share(b, a);
    field_bound_set(bound, interval_norm(a, b), gradient);
}

/* ---- cone: (z + tan(slope) rho) cos(slope), whose layers fall away outwards ---- */

static void cone_evaluate(double *value, iso_vec3 *gradient, const iso_field *field,
                          const iso_vec3 *at, int64_t count) {
    const shape_field *f = shape_of(field);
    iso_vec3 center = f->shape.center;
    double sine = f->sine, cosine = f->cosine;
    for (int64_t i = 0; i < count; i++) {
        double x = at[i].x - center.x, y = at[i].y - center.y, rho = sqrt(x * x + y * y);
        value[i] = at[i].z * cosine + rho * sine;
        if (gradient) {
            double outwards = share(sine, rho);
            gradient[i] = vec3(x * outwards, y * outwards, cosine);
        }
    }
}

static void cone_bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low,
                       iso_vec3 high) {
    const shape_field *f = shape_of(field);
    interval x = beside(low.x, high.x, f->shape.center.x);
    interval y = beside(low.y, high.y, f->shape.center.y);
    interval gradient[3] = {interval_scale(f->sine, interval_share(x, y)),
                            interval_scale(f->sine, interval_share(y, x)), interval_at(f->cosine)};
    interval upright = interval_scale(f->cosine, (interval){low.z, high.z});
    interval value = interval_add(upright, interval_scale(f->sine, interval_norm(x, y)));
    field_bound_set(bound, value, gradient);
}

/* ---- sphere ---- */

static void sphere_evaluate(double *value, iso_vec3 *gradient, const iso_field *field,
                            const iso_vec3 *at, int64_t count) {
    iso_vec3 center = shape_of(field)->shape.center;
    for (int64_t i = 0; i < count; i++) {
        iso_vec3 p = vec3_minus(at[i], center);
        double distance = vec3_length(p);
        value[i] = distance;
        if (gradient)
            gradient[i] = vec3(share(p.x, distance), share(p.y, distance), share(p.z, distance));
    }
}

static void sphere_bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low,
                         iso_vec3 high) {
    iso_vec3 center = shape_of(field)->shape.center;
    interval x = beside(low.x, high.x, center.x), y = beside(low.y, high.y, center.y),
             z = beside(low.z, high.z, center.z);
    interval flat = interval_norm(x, y);
    interval gradient[3] = {interval_share(x, interval_norm(y, z)),
                            interval_share(y, interval_norm(x, z)), interval_share(z, flat)};
    field_bound_set(bound, interval_norm(flat, z), gradient);
}

/* ---- torus: around an upright axis ---- */

static void torus_evaluate(double *value, iso_vec3 *gradient, const iso_field *field,
                           const iso_vec3 *at, int64_t count) {
    const field_shape *shape = &shape_of(field)->shape;
    for (int64_t i = 0; i < count; i++) {
        iso_vec3 p = vec3_minus(at[i], shape->center);
        double rho = sqrt(p.x * p.x + p.y * p.y), outside = rho - shape->radius;
        double distance = sqrt(outside * outside + p.z * p.z);
        value[i] = distance;
        if (gradient) {
            double outwards = share(outside, distance);
            gradient[i] =
                vec3(share(p.x, rho) * outwards, share(p.y, rho) * outwards, share(p.z, distance));
        }
    }
}

static void torus_bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low,
                        iso_vec3 high) {
    const field_shape *shape = &shape_of(field)->shape;
    interval x = beside(low.x, high.x, shape->center.x), y = beside(low.y, high.y, shape->center.y);
    interval z = beside(low.z, high.z, shape->center.z);
    interval outside = interval_subtract(interval_norm(x, y), interval_at(shape->radius));
    interval outwards = interval_share(outside, z);
    interval gradient[3] = {interval_multiply(interval_share(x, y), outwards),
                            interval_multiply(interval_share(y, x), outwards),
                            interval_share(z, outside)};
    field_bound_set(bound, interval_norm(outside, z), gradient);
}

/* ---- wave: z and a sine along a direction ---- */

static void wave_evaluate(double *value, iso_vec3 *gradient, const iso_field *field,
                          const iso_vec3 *at, int64_t count) {
    const shape_field *f = shape_of(field);
    for (int64_t i = 0; i < count; i++) {
        double sine, cosine;
        series_sine_cosine(&sine, &cosine, f->turn.x * at[i].x + f->turn.y * at[i].y);
        value[i] = at[i].z + f->amplitude * sine;
        if (gradient)
            gradient[i] =
                vec3(f->amplitude * f->turn.x * cosine, f->amplitude * f->turn.y * cosine, 1);
    }
}

static void wave_bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low,
                       iso_vec3 high) {
    const shape_field *f = shape_of(field);
    interval x = interval_scale(f->turn.x, (interval){low.x, high.x});
    interval y = interval_scale(f->turn.y, (interval){low.y, high.y});
    interval sine, cosine;
    interval_sine_cosine(&sine, &cosine, interval_add(x, y));
    interval height = interval_scale(f->amplitude, sine);
    interval by_x = interval_rounded(f->amplitude * f->turn.x, f->amplitude * f->turn.x);
    interval by_y = interval_rounded(f->amplitude * f->turn.y, f->amplitude * f->turn.y);
    interval gradient[3] = {interval_multiply(by_x, cosine), interval_multiply(by_y, cosine),
                            interval_at(1)};
    field_bound_set(bound, interval_add((interval){low.z, high.z}, height), gradient);
}

/* ---- fan: the radius times the angle around an axis ---- */

static void fan_evaluate(double *value, iso_vec3 *gradient, const iso_field *field,
                         const iso_vec3 *at, int64_t count) {
    const shape_field *f = shape_of(field);
    const field_shape *shape = &f->shape;
    for (int64_t i = 0; i < count; i++) {
        iso_vec3 p = vec3_minus(at[i], shape->center);
        double a = vec3_dot(p, shape->from), b = vec3_dot(p, f->up), square = a * a + b * b;
        value[i] = shape->radius * series_arctangent2(b, a);
        if (gradient) {
            double by_a = -shape->radius * share(b, square);
            double by_b = shape->radius * share(a, square);
            gradient[i] = vec3_along(vec3_times(shape->from, by_a), by_b, f->up);
        }
    }
}

/* `from` is along one axis or against it, `up` along another. */
static interval box_along(const interval box[3], iso_vec3 unit) {
    interval x = unit.x != 0 ? box[0] : unit.y != 0 ? box[1] : box[2];
    return unit.x + unit.y + unit.z < 0 ? interval_negate(x) : x;
}

static void add_along(interval gradient[3], iso_vec3 unit, interval by) {
    if (unit.x + unit.y + unit.z < 0)
        by = interval_negate(by);
    gradient[unit.x != 0 ? 0 : unit.y != 0 ? 1 : 2] = by;
}

static void fan_bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low, iso_vec3 high) {
    const shape_field *f = shape_of(field);
    iso_vec3 center = f->shape.center;
    interval box[3] = {beside(low.x, high.x, center.x), beside(low.y, high.y, center.y),
                       beside(low.z, high.z, center.z)};
    interval a = box_along(box, f->shape.from), b = box_along(box, f->up);
    interval radius = interval_at(f->shape.radius), gradient[3] = {{0, 0}, {0, 0}, {0, 0}};
    bool jumps;
    interval value = interval_multiply(radius, interval_angle(&jumps, b, a));
    interval steep = interval_divide(radius, interval_norm(a, b));
    interval by_a = interval_negate(interval_multiply(steep, interval_share(b, a)));
    interval by_b = interval_multiply(steep, interval_share(a, b));
    add_along(gradient, f->shape.from, jumps ? interval_whole() : by_a);
    add_along(gradient, f->up, jumps ? interval_whole() : by_b);
    field_bound_set(bound, value, gradient);
}

/* ---- all of them ---- */

static void free_shape(iso_field *field) {
    iso_release(field);
}

static const field_operations operations[] = {
    {ISO_FIELD_PLANE, plane_evaluate, plane_bound, free_shape},
    {ISO_FIELD_CYLINDER, cylinder_evaluate, cylinder_bound, free_shape},
    {ISO_FIELD_CONE, cone_evaluate, cone_bound, free_shape},
    {ISO_FIELD_SPHERE, sphere_evaluate, sphere_bound, free_shape},
    {ISO_FIELD_TORUS, torus_evaluate, torus_bound, free_shape},
    {ISO_FIELD_WAVE, wave_evaluate, wave_bound, free_shape},
    {ISO_FIELD_FAN, fan_evaluate, fan_bound, free_shape},
};
enum { SHAPES = sizeof operations / sizeof *operations };

const field_shape *field_own_shape(const iso_field *field) {
    bool is_shape = field->operations >= operations && field->operations < operations + SHAPES;
    return is_shape ? &shape_of(field)->shape : NULL;
}

static void set_wave(shape_field *f, const field_numbers *numbers) {
    double sine, cosine, turn = 2 * 3.14159265358979323846 / numbers->length;
    iso_sine_cosine(&sine, &cosine, numbers->direction);
    f->turn = (iso_vec2){turn * cosine, turn * sine};
}

iso_status field_new_shape(iso_field **field, iso_field_kind kind, const field_numbers *numbers) {
    *field = NULL;
    shape_field *made;
    ISO_TRY(ISO_ALLOCATE(made, 1));
    *made = (shape_field){.shape = numbers->shape, .amplitude = numbers->amplitude};
    for (int i = 0; i < SHAPES; i++)
        if (operations[i].kind == kind)
            made->base.operations = &operations[i];
    made->cosine = 1 / sqrt(1 + made->shape.slope * made->shape.slope);
    made->sine = made->shape.slope * made->cosine;
    if (kind == ISO_FIELD_WAVE)
        set_wave(made, numbers);
    made->up = vec3_cross(made->shape.axis, made->shape.from);
    *field = &made->base;
    return ISO_OK;
}
