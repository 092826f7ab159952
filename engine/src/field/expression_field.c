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

/* By steps of intervals alone a bound is wide where parts of the expression move together. The
 * slopes know better: what only rises is least at an end, and what does neither is as far from its
 * middle as its steepest slope takes it.
 *
 * Returns how high the value gets in the box, or, for sign -1, how high its negative gets. Four
 * times its width at one point is more than what rounding does to it anywhere in the box. */
static double highest(const iso_formula *formula, const interval box[3], const interval slope[3],
                      double sign) {
    interval at[3];
    double reach = 0;
    for (int c = 0; c < 3; c++) {
        double low = sign > 0 ? slope[c].low : -slope[c].high;
        double high = sign > 0 ? slope[c].high : -slope[c].low;
        double size = box[c].high - box[c].low;
        at[c] = interval_at(low >= 0    ? box[c].high
                            : high <= 0 ? box[c].low
                                        : box[c].low + 0.5 * size);
        if (low < 0 && high > 0 && size > 0)
            reach += 0.5 * size * fmax(-low, high);
    }
    spread there;
    formula_spread(&there, formula, at, 0);
    interval value = sign > 0 ? there.value : interval_negate(there.value);
    double top = value.high + 4 * (value.high - value.low) + reach * (1 + 0x1p-48);
    return top < HUGE_VAL ? top : HUGE_VAL;
}

static void bound(iso_field_bound *bound, const iso_field *field, iso_vec3 low, iso_vec3 high) {
    const iso_formula *formula = formula_of(field);
    interval box[3];
    spread all;
    field_box(box, low, high);
    formula_spread(&all, formula, box, 3);
    if (interval_is_finite(all.value)) {
        interval narrow = {-highest(formula, box, all.slope, -1),
                           highest(formula, box, all.slope, 1)};
        all.value = interval_both(all.value, narrow);
    }
    field_bound_set(bound, all.value, all.slope);
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
