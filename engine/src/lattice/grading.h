/* What varies in a lattice: numbers that are expressions in the place. */
#ifndef ISO_LATTICE_GRADING_H
#define ISO_LATTICE_GRADING_H

#include <stdbool.h>
#include <stdint.h>

#include <isoslice/geometry.h>
#include <isoslice/status.h>

#include "field/expression.h"

enum { GRADING_BLOCK = 256 };

typedef enum iso_grading_variable {
    GRADING_X,
    GRADING_Y,
    GRADING_Z,
    GRADING_SKIN,
    GRADING_R,
    GRADING_GRID,
    GRADING_VARIABLES
} iso_grading_variable;

typedef struct iso_grading {
    iso_expression *expression; /* NULL: `value` everywhere */
    double value;
} iso_grading;

/* The message begins with the option's name. */
iso_status grading_make(iso_grading *grading, const char *text, const char *option) ISO_MUST_CHECK;
void grading_free(iso_grading *grading);

bool grading_uses(const iso_grading *grading, int32_t variable);
/* The one variable that it depends on; -1: none, -2: several. */
int32_t grading_only_variable(const iso_grading *grading);

/* `variable` is [GRADING_VARIABLES][count]; those that aren't used may be NULL. */
void grading_evaluate(double *value, const iso_grading *grading, const double *const *variable,
                      int64_t count);

#endif
