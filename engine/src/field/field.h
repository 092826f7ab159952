/* What a kind of field is made of. A new kind is one file with a table of these; what it needs
 * besides lies behind `iso_field` as its first member. */
#ifndef ISO_FIELD_FIELD_H
#define ISO_FIELD_FIELD_H

#include <isoslice/field.h>

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

#endif
