/* What an expression's steps can do, in one table: an operator or a function is a row of it, with
 * all that is to be known about it. */
#ifndef ISO_FIELD_OPERATION_H
#define ISO_FIELD_OPERATION_H

#include <stdint.h>

#include "field/interval.h"

enum { OPERATION_OPERANDS = 5 };

/* What a value and its derivatives in some variables can be over a box. Derivatives hold wherever
 * there is one; where the value has a kink, all slopes between those beside it are in them, where
 * it jumps they are infinite. So the value changes by no more than they say. */
enum { ENCLOSURE_SLOPES = 3 };

typedef struct enclosure {
    interval value, slope[ENCLOSURE_SLOPES];
} enclosure;

/* to[i] = f(from[0][i], from[1][i] ...); `to` may be one of them. */
typedef void iso_operation_apply(double *to, const double *const *from, int32_t count);

/* slope[k][i] = the derivative by operand k there, of those k where slope[k] isn't NULL; `value` is
 * the result. Where there is none, one of those beside it; infinite only where the value rises
 * without bound. */
typedef void iso_operation_slope(double *const *slope, const double *const *from,
                                 const double *value, int32_t count);

/* Of a result from those of its operands: the slopes of all `slopes` first variables. */
typedef void iso_operation_enclose(enclosure *to, const enclosure *const *from, int32_t slopes);

typedef struct iso_operation {
    const char *name; /* of a function */
    int32_t operands;
    int32_t more; /* takes any larger number of them too, two by two from the left */
    iso_operation_apply *apply;
    iso_operation_enclose *enclose;
    iso_operation_slope *slope; /* NULL: it is `factor`, everywhere */
    double factor[2];
} iso_operation;

typedef enum iso_operator { /* the first rows of the table, not had by name */
                            OPERATION_NEGATE,
                            OPERATION_ADD,
                            OPERATION_SUBTRACT,
                            OPERATION_MULTIPLY,
                            OPERATION_DIVIDE,
                            OPERATION_POWER,
                            OPERATION_LESS,
                            OPERATION_LESS_EQUAL,
                            OPERATION_GREATER,
                            OPERATION_GREATER_EQUAL,
                            OPERATION_EQUAL,
                            OPERATION_UNEQUAL,
                            OPERATION_SELECT, /* ?: */
                            OPERATION_SQUARE,
                            OPERATION_NORM3, /* of three */
                            OPERATION_FUNCTIONS,
                            OPERATION_ABS = OPERATION_FUNCTIONS, /* those that are made of others */
                            OPERATION_SQRT,
                            OPERATION_HYPOT
} iso_operator;

const iso_operation *operation_at(int32_t index);

/* -1: there is none of this name. */
int32_t operation_find(const char *name, int32_t length);

#endif
