/* What an expression's steps can do, in one table: an operator or a function is a row of it, with
 * all that is to be known about it. */
#ifndef ISO_FIELD_OPERATION_H
#define ISO_FIELD_OPERATION_H

#include <stdint.h>

enum { OPERATION_OPERANDS = 5 };

/* to[i] = f(from[0][i], from[1][i] ...); `to` may be one of them. */
typedef void iso_operation_apply(double *to, const double *const *from, int32_t count);

typedef struct iso_operation {
    const char *name; /* of a function */
    int32_t operands;
    int32_t more; /* takes any larger number of them too, two by two from the left */
    iso_operation_apply *apply;
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
                            OPERATION_FUNCTIONS
} iso_operator;

const iso_operation *operation_at(int32_t index);

/* -1: there is none of this name. */
int32_t operation_find(const char *name, int32_t length);

#endif
