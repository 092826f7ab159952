#include "lattice/grading.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

static const char *const names[GRADING_VARIABLES] = {
    [GRADING_X] = "x",       [GRADING_Y] = "y", [GRADING_Z] = "z",
    [GRADING_SKIN] = "skin", [GRADING_R] = "r", [GRADING_GRID] = "grid"};

iso_status grading_make(iso_grading *grading, const char *text, const char *option) {
    *grading = (iso_grading){0};
    iso_status status =
        expression_compile(&grading->expression, text ? text : "", names, GRADING_VARIABLES);
    if (status == ISO_BAD_CONFIG)
        return iso_fail(status, "%s, %s%s", option, iso_error_message(),
                        text && strchr(text, '%') ? "; numbers stand there without a unit" : "");
    ISO_TRY(status);
    if (grading_only_variable(grading) != -1)
        return ISO_OK;
    expression_evaluate(&grading->value, grading->expression, NULL, 1);
    grading_free(grading);
    if (!isfinite(grading->value))
        return iso_fail(ISO_BAD_CONFIG, "%s is no number: %s", option, text);
    return ISO_OK;
}

void grading_free(iso_grading *grading) {
    expression_free(grading->expression);
    grading->expression = NULL;
}

bool grading_uses(const iso_grading *grading, int32_t variable) {
    return grading->expression && expression_uses(grading->expression, variable);
}

int32_t grading_only_variable(const iso_grading *grading) {
    int32_t only = -1;
    for (int32_t k = 0; k < GRADING_VARIABLES; k++)
        if (grading_uses(grading, k))
            only = only == -1 ? k : -2;
    return only;
}

void grading_evaluate(double *value, const iso_grading *grading, const double *const *variable,
                      int64_t count) {
    if (grading->expression) {
        expression_evaluate(value, grading->expression, variable, count);
        return;
    }
    for (int64_t i = 0; i < count; i++)
        value[i] = grading->value;
}
