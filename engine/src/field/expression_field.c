/* The field of an expression in x, y and z. */
#include "field/field.h"

#include <stddef.h>

#include "base/memory.h"
#include "field/formula.h"

typedef struct expression_field {
    iso_field base;
    iso_formula formula;
} expression_field;

static const iso_formula *formula_of(const iso_field *field) {
    return &((const expression_field *)field)->formula;
}

static void evaluate(double *value, iso_vec3 *gradient, const iso_field *field, const iso_vec3 *at,
                     int64_t count) {
    formula_evaluate(value, gradient, formula_of(field), at, count);
}

static interval value_at(const void *context, iso_vec3 at) {
    interval box[3];
    enclosure there;
    field_box(box, at, at);
    formula_enclose(&there, context, box, 0);
    return there.value;
}

/* By steps of intervals alone a bound is wide where parts of the expression move together. */
static void bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low, iso_vec3 high) {
    interval box[3];
    enclosure all;
    field_box(box, low, high);
    formula_enclose(&all, formula_of(field), box, ENCLOSURE_SLOPES);
    for (int c = 0; c < ENCLOSURE_SLOPES; c++)
        if (!interval_is_finite(all.slope[c])) /* what is infinite is given as 0 */
            all.slope[c] = interval_hull(all.slope[c], interval_at(0));
    field_bound_set(bound, all.value, all.slope);
    field_bound_narrow(bound, value_at, formula_of(field), low, high);
}

static void free_field(iso_field *field) {
    formula_free(&((expression_field *)field)->formula);
    iso_release(field);
}

static const field_operations operations = {ISO_FIELD_EXPRESSION, evaluate, bound, free_field};

static bool is_just_z(const iso_formula *formula) {
    return formula->count == 0 && formula->result == 2;
}

iso_status field_new_expression(iso_field **field, const char *text) {
    static const char *const names[FORMULA_VARIABLES] = {"x", "y", "z"};
    *field = NULL;
    iso_expression *expression;
    ISO_TRY(expression_compile(&expression, text, names, FORMULA_VARIABLES));
    iso_formula formula;
    iso_status status = formula_make(&formula, expression);
    expression_free(expression);
    ISO_TRY(status);
    if (is_just_z(&formula)) {
        formula_free(&formula);
        const field_numbers numbers = {.shape = {.axis = {0, 0, 1}, .from = {1, 0, 0}}};
        return field_new_shape(field, ISO_FIELD_PLANE, &numbers);
    }
    expression_field *made = NULL;
    status = ISO_ALLOCATE(made, 1);
    if (status != ISO_OK) {
        formula_free(&formula);
        return status;
    }
    *made = (expression_field){{&operations}, formula};
    *field = &made->base;
    return ISO_OK;
}
