/* Flat layers that bend into those of a field: z + s(z) (F - offset - z), where s goes from 0 to 1
 * with no kink at either end. */
#include "field/field.h"

#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "base/vector.h"

typedef struct blend_field {
    iso_field base;
    iso_field *curved;
    double offset, from, to;
} blend_field;

static const blend_field *blend_of(const iso_field *field) {
    return (const blend_field *)field;
}

/* How much of the curved field there is at z, and how fast it grows. */
static double share_at(double *growth, const blend_field *f, double z) {
    double t = (z - f->from) / (f->to - f->from);
    t = t > 0 ? t < 1 ? t : 1 : 0;
    *growth = 6 * t * (1 - t) / (f->to - f->from);
    return t * t * (3 - 2 * t);
}

static void blend(double *value, iso_vec3 *gradient, const blend_field *f, iso_vec3 at) {
    double growth, share = share_at(&growth, f, at.z), above = *value - f->offset - at.z;
    if (at.z <= f->from) {
        *value = at.z;
        if (gradient)
            *gradient = vec3(0, 0, 1);
        return;
    }
    *value = at.z >= f->to ? *value - f->offset : at.z + share * above;
    if (gradient && at.z < f->to) {
        *gradient = vec3_times(*gradient, share);
        gradient->z += 1 - share + (fabs(above) < HUGE_VAL ? growth * above : 0);
    }
}

static void evaluate(double *value, iso_vec3 *gradient, const iso_field *field, const iso_vec3 *at,
                     int64_t count) {
    const blend_field *f = blend_of(field);
    iso_field_evaluate(value, gradient, f->curved, at, count);
    for (int64_t i = 0; i < count; i++)
        blend(&value[i], gradient ? &gradient[i] : NULL, f, at[i]);
}

/* ---- bounds ---- */

typedef struct part {
    interval value, gradient[3];
} part;

static part part_of(const iso_field_bound *b) {
    return (part){{b->low, b->high},
                  {{b->gradient_low.x, b->gradient_high.x},
                   {b->gradient_low.y, b->gradient_high.y},
                   {b->gradient_low.z, b->gradient_high.z}}};
}

static part curved_part(const blend_field *f, iso_vec3 low, iso_vec3 high) {
    iso_field_bound bound;
    iso_field_bound_over(&bound, f->curved, low, high);
    part p = part_of(&bound);
    p.value = interval_subtract(p.value, interval_at(f->offset));
    return p;
}

/* How far the curved field is above z. The two go along with each other: what is known of the
 * difference's slopes narrows it. */
static interval above_at(const void *context, iso_vec3 at) {
    return interval_subtract(curved_part(context, at, at).value, interval_at(at.z));
}

static interval above_flat(const blend_field *f, const part *curved, iso_vec3 low, iso_vec3 high) {
    part wide = *curved;
    wide.value = interval_subtract(curved->value, (interval){low.z, high.z});
    wide.gradient[2] = interval_subtract(curved->gradient[2], interval_at(1));
    iso_field_bound bound;
    field_bound_set(&bound, wide.value, wide.gradient);
    field_bound_narrow(&bound, above_at, f, low, high);
    return (interval){bound.low, bound.high};
}

/* Both z between `from` and `to`. */
static part mixed_part(const blend_field *f, iso_vec3 low, iso_vec3 high) {
    double up, down, s0 = share_at(&up, f, low.z), s1 = share_at(&down, f, high.z);
    interval share = interval_both(interval_outward(s0, s1, 0x1p-46), (interval){0, 1});
    double middle = 0.5 * (f->from + f->to), least = up < down ? up : down,
           most = up < down ? down : up;
    if (low.z <= middle && high.z >= middle)
        most = 1.5 / (f->to - f->from);
    interval growth = interval_outward(least, most, 0x1p-46);
    growth.low = growth.low > 0x1p-46 * growth.high ? growth.low : 0;
    part curved = curved_part(f, low, high), p;
    interval above = above_flat(f, &curved, low, high);
    p.value = interval_add((interval){low.z, high.z}, interval_multiply(share, above));
    p.gradient[0] = interval_multiply(share, curved.gradient[0]);
    p.gradient[1] = interval_multiply(share, curved.gradient[1]);
    interval steeper = interval_subtract(curved.gradient[2], interval_at(1));
    p.gradient[2] = interval_add(interval_add(interval_at(1), interval_multiply(share, steeper)),
                                 interval_multiply(growth, above));
    return p;
}

static void join(part *to, part other) {
    to->value = interval_hull(to->value, other.value);
    for (int c = 0; c < 3; c++)
        to->gradient[c] = interval_hull(to->gradient[c], other.gradient[c]);
}

/* The box in up to three parts: flat, between and curved. */
static part part_over(const blend_field *f, iso_vec3 low, iso_vec3 high) {
    part all = {{HUGE_VAL, -HUGE_VAL},
                {{HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}}};
    if (low.z <= f->from)
        join(&all, (part){{low.z, fmin(high.z, f->from)}, {{0, 0}, {0, 0}, {1, 1}}});
    if (high.z > f->from && low.z < f->to)
        join(&all, mixed_part(f, vec3(low.x, low.y, fmax(low.z, f->from)),
                              vec3(high.x, high.y, fmin(high.z, f->to))));
    if (high.z >= f->to)
        join(&all, curved_part(f, vec3(low.x, low.y, fmax(low.z, f->to)), high));
    return all;
}

static interval value_at(const void *context, iso_vec3 at) {
    return part_over(context, at, at).value;
}

static void bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low, iso_vec3 high) {
    const blend_field *f = blend_of(field);
    part all = part_over(f, low, high);
    field_bound_set(bound, all.value, all.gradient);
    if (high.z > f->from && low.z < f->to)
        field_bound_narrow(bound, value_at, f, low, high);
}

/* ---- making ---- */

static void free_blend(iso_field *field) {
    iso_field_free(((blend_field *)field)->curved);
    iso_release(field);
}

static const field_operations operations = {ISO_FIELD_BLEND, evaluate, bound, free_blend};

const iso_field *field_curved_part(const iso_field *field) {
    return field->operations == &operations ? blend_of(field)->curved : NULL;
}

static iso_status make(iso_field **blended, iso_field *field, double offset, double from,
                       double to) {
    if (!(to > from) || !(to - from < HUGE_VAL) || !(fabs(offset) < HUGE_VAL))
        return iso_fail(ISO_USAGE,
                        "flat layers can't bend into curved ones, %g less, from z = %g to %g mm",
                        offset, from, to);
    blend_field *made;
    ISO_TRY(ISO_ALLOCATE(made, 1));
    *made = (blend_field){{&operations}, field, offset, from, to};
    *blended = &made->base;
    return ISO_OK;
}

iso_status iso_field_blend(iso_field **blended, iso_field *field, double offset, double from,
                           double to) {
    *blended = NULL;
    iso_status status = make(blended, field, offset, from, to);
    if (status != ISO_OK)
        iso_field_free(field);
    return status;
}
