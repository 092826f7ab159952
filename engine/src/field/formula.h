/* What the expression of a field is made into: steps as in program.h, but each part that occurs
 * more than once done once, and squares, roots of sums of squares and the like known as what they
 * are, which makes their derivatives and bounds better. In x, y and z; derivatives go along from
 * step to step (forward mode). */
#ifndef ISO_FIELD_FORMULA_H
#define ISO_FIELD_FORMULA_H

#include <isoslice/geometry.h>

#include "field/expression.h"
#include "field/operation.h"

enum {
    FORMULA_VARIABLES = 3,   /* places below this are x, y, z */
    FORMULA_REGISTERS = 384, /* more than PROGRAM_REGISTERS: a step's result has one of its own */
    FORMULA_ROOM = 8192,     /* doubles that a run takes from the stack, but for a few */
    FORMULA_BLOCK = 256,     /* points at most that a step handles at once */
    FORMULA_CONSTANT = -1    /* operation of a step: the number itself */
};

typedef struct formula_step {
    int16_t operation;
    int16_t to; /* none of `from` */
    int16_t from[OPERATION_OPERANDS];
    uint8_t slopes; /* bit k: depends on variable k */
    double number;
} formula_step;

typedef struct iso_formula {
    formula_step *step; /* [count] */
    int32_t count;
    int32_t constants; /* the first steps: constants in registers that nothing else takes */
    int32_t registers;
    int16_t result; /* place */
    uint8_t slopes; /* of the result */
} iso_formula;

/* `expression` is of x, y and z. */
iso_status formula_make(iso_formula *made, const iso_expression *expression) ISO_MUST_CHECK;
void formula_free(iso_formula *formula);

/* value[count] and, unless NULL, gradient[count]. No slope is infinite or NaN: it is 0 then. */
void formula_evaluate(double *value, iso_vec3 *gradient, const iso_formula *formula,
                      const iso_vec3 *at, int64_t count);

/* With slopes by x, y, z or, `slopes` 0, without. */
void formula_enclose(enclosure *to, const iso_formula *formula, const interval box[3],
                     int32_t slopes);

#endif
