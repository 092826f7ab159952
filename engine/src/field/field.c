/* What all fields have, whatever their kind. */
#include "field/field.h"

#include <stddef.h>

void iso_field_free(iso_field *field) {
    if (field)
        field->operations->free(field);
}

iso_field_kind iso_field_kind_of(const iso_field *field) {
    return field->operations->kind;
}

int iso_field_is_z(const iso_field *field) {
    while (field_curved_part(field))
        field = field_curved_part(field);
    if (iso_field_kind_of(field) != ISO_FIELD_PLANE)
        return 0;
    iso_vec3 normal = field_own_shape(field)->axis;
    return normal.x == 0 && normal.y == 0 && normal.z == 1;
}

void iso_field_evaluate(double *value, iso_vec3 *gradient, const iso_field *field,
                        const iso_vec3 *at, int64_t count) {
    field->operations->evaluate(value, gradient, field, at, count);
}

void iso_field_bound_over(iso_field_bound *bound, const iso_field *field, iso_vec3 low,
                          iso_vec3 high) {
    field->operations->bound(bound, field, low, high);
}

field_shape field_shape_of(const iso_field *field) {
    while (field_curved_part(field))
        field = field_curved_part(field);
    const field_shape *shape = field_own_shape(field);
    return shape ? *shape : (field_shape){.axis = {0, 0, 1}, .from = {1, 0, 0}};
}

void field_bound_set(iso_field_bound *bound, interval value, const interval gradient[3]) {
    *bound = (iso_field_bound){
        value.low,
        value.high,
        {gradient[0].low, gradient[1].low, gradient[2].low},
        {gradient[0].high, gradient[1].high, gradient[2].high},
    };
}

static double steepest(double low, double high) {
    return -low > high ? -low : high;
}

/* The mean value theorem, which holds for kinks too as long as slopes at them are bounded by those
 * beside. */
void field_bound_narrow(iso_field_bound *bound, interval middle, iso_vec3 low, iso_vec3 high) {
    if (!(bound->low > -HUGE_VAL && bound->high < HUGE_VAL))
        return;
    double reach = (high.x - low.x) * steepest(bound->gradient_low.x, bound->gradient_high.x) +
                   (high.y - low.y) * steepest(bound->gradient_low.y, bound->gradient_high.y) +
                   (high.z - low.z) * steepest(bound->gradient_low.z, bound->gradient_high.z);
    reach *= 0.5 * (1 + 0x1p-48);
    interval both = interval_both((interval){bound->low, bound->high},
                                  interval_rounded(middle.low - reach, middle.high + reach));
    bound->low = both.low;
    bound->high = both.high;
}
