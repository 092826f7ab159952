/* What a kind of field is made of. A new kind is one file with a table of these; what it needs
 * besides lies behind `iso_field` as its first member. */
#ifndef ISO_FIELD_FIELD_H
#define ISO_FIELD_FIELD_H

#include <stdbool.h>

#include <isoslice/field.h>

#include "field/interval.h"

typedef struct field_operations {
    iso_field_kind kind;
    void (*evaluate)(double *value, iso_vec3 *gradient, const iso_field *field, const iso_vec3 *at,
                     int64_t count);
    void (*bound)(iso_field_bound *bound, const iso_field *field, iso_vec3 low, iso_vec3 high);
    void (*free)(iso_field *field);
} field_operations;

struct iso_field {
    const field_operations *operations;
};

/* A box as intervals, and back. */
static inline void field_box(interval box[3], iso_vec3 low, iso_vec3 high) {
    box[0] = (interval){low.x, high.x};
    box[1] = (interval){low.y, high.y};
    box[2] = (interval){low.z, high.z};
}
void field_bound_set(iso_field_bound *bound, interval value, const interval gradient[3]);

/* What a value is at one point, for certain: about as wide as rounding makes it. */
typedef interval field_value_at(const void *context, iso_vec3 at);
/* Narrow a bound by its slopes: what only rises is greatest at an end, and what does neither is no
 * further from its middle than its steepest slope takes it. Costs two values. */
void field_bound_narrow(iso_field_bound *bound, field_value_at *value_at, const void *context,
                        iso_vec3 low, iso_vec3 high);

/* What charts ask of the kinds that have their own (chart/). */
typedef struct field_shape {
    iso_vec3 center; /* of a sphere, torus; a point of the axis else */
    iso_vec3 axis;   /* unit; of a cylinder, cone, torus, fan */
    iso_vec3 from;   /* unit, across the axis: where angles begin */
    double radius;   /* of a torus or fan */
    double slope;    /* of a cone: tangent of the angle its layers lie at */
} field_shape;

/* Of an analytic kind; of a blend, its curved part's. */
field_shape field_shape_of(const iso_field *field);

/* ---- the kinds ---- */

/* What each analytic kind needs: its shape, and besides */
typedef struct field_numbers {
    field_shape shape;
    double amplitude, length, direction; /* of a wave: mm, mm, degrees */
} field_numbers;

iso_status field_new_shape(iso_field **field, iso_field_kind kind,
                           const field_numbers *numbers) ISO_MUST_CHECK;
iso_status field_new_expression(iso_field **field, const char *text) ISO_MUST_CHECK;

/* Of an analytic kind, else NULL. */
const field_shape *field_own_shape(const iso_field *field);
/* The curved part of a blend; NULL: it is none. */
const iso_field *field_curved_part(const iso_field *field);

#endif
