/* The caller's own field. */
#include "field/field.h"

#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "base/vector.h"

typedef struct function_field {
    iso_field base;
    iso_field_function *function;
    iso_field_function_bound *bound;
    double steepest;
    void *payload;
} function_field;

static void evaluate(double *value, iso_vec3 *gradient, const iso_field *field, const iso_vec3 *at,
                     int64_t count) {
    const function_field *f = (const function_field *)field;
    f->function(value, gradient, at, count, f->payload);
}

/* From the middle of the box to its corners. */
static void bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low, iso_vec3 high) {
    const function_field *f = (const function_field *)field;
    if (f->bound) {
        f->bound(bound, low, high, f->payload);
        return;
    }
    iso_vec3 middle = vec3_between(low, high, 0.5);
    double value, steepest = f->steepest * (1 + 0x1p-48);
    double reach = steepest * 0.5 * vec3_distance(low, high);
    f->function(&value, NULL, &middle, 1, f->payload);
    const interval slope = {-steepest, steepest}, gradient[3] = {slope, slope, slope};
    field_bound_set(bound, interval_outward(value - reach, value + reach, 0x1p-48), gradient);
}

static void free_function(iso_field *field) {
    iso_release(field);
}

static const field_operations operations = {ISO_FIELD_FUNCTION, evaluate, bound, free_function};

iso_status iso_field_from_function(iso_field **field, iso_field_function *function,
                                   iso_field_function_bound *bound_of, double steepest,
                                   void *payload) {
    *field = NULL;
    if (!bound_of && !(steepest >= 0))
        return iso_fail(ISO_USAGE, "a field rises by at least 0 a mm, not by %g", steepest);
    function_field *made;
    ISO_TRY(ISO_ALLOCATE(made, 1));
    *made = (function_field){{&operations}, function, bound_of, steepest, payload};
    *field = &made->base;
    return ISO_OK;
}
