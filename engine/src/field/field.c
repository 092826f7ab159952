/* What all fields have, whatever their kind. */
#include "field/field.h"

#include <math.h>
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

/* How high the value gets in the box, or, for sign -1, how high its negative gets: no rounding but
 * that of the value at one point, whose width is left in *width.
 *
 * The mean value theorem, which holds for kinks too as long as the slopes next to them are known.
 */
static double highest(double *width, field_value_at *value_at, const void *context,
                      const interval range[6], double sign) {
    double at[3], reach = 0;
    const interval *box = range, *slope = range + 3;
    for (int c = 0; c < 3; c++) {
        double low = sign > 0 ? slope[c].low : -slope[c].high;
        double high = sign > 0 ? slope[c].high : -slope[c].low;
        double size = box[c].high - box[c].low;
        at[c] = low >= 0 ? box[c].high : high <= 0 ? box[c].low : box[c].low + 0.5 * size;
        if (low < 0 && high > 0 && size > 0)
            reach += 0.5 * size * most_of(-low, high);
    }
    interval value = value_at(context, (iso_vec3){at[0], at[1], at[2]});
    *width = value.high - value.low;
    return (sign > 0 ? value.high : -value.low) + reach * (1 + 0x1p-48);
}

/* Values as doubles have them may be rounded more elsewhere in the box: by no more than a few times
 * what they are at the ones looked at, one of which is most often at its far end. */
void field_bound_narrow(iso_field_bound *bound, field_value_at *value_at, const void *context,
                        iso_vec3 low, iso_vec3 high) {
    interval value = {bound->low, bound->high}, range[6];
    if (!interval_is_finite(value))
        return;
    field_box(range, low, high);
    range[3] = (interval){bound->gradient_low.x, bound->gradient_high.x};
    range[4] = (interval){bound->gradient_low.y, bound->gradient_high.y};
    range[5] = (interval){bound->gradient_low.z, bound->gradient_high.z};
    double width[2], least = -highest(&width[0], value_at, context, range, -1);
    double most = highest(&width[1], value_at, context, range, 1);
    double spare = 4 * most_of(width[0], width[1]);
    if (!(least - spare > -HUGE_VAL && most + spare < HUGE_VAL))
        return;
    value = interval_both(value, (interval){least - spare, most + spare});
    bound->low = value.low;
    bound->high = value.high;
}
