/* What an expression is compiled to: steps without branches, each from some places to one. Places
 * are the variables, then registers that hold a block of values each. */
#ifndef ISO_FIELD_PROGRAM_H
#define ISO_FIELD_PROGRAM_H

#include "field/expression.h"
#include "field/operation.h"

enum {
    PROGRAM_VARIABLES = 32, /* places below this are variables */
    PROGRAM_REGISTERS = 256,
    PROGRAM_ROOM = 8192, /* doubles that all registers share while running: 64 kB of the stack */
    PROGRAM_BLOCK = 256, /* values at most that a step handles at once: so they stay in the cache */
    PROGRAM_CONSTANT = -1 /* operation of a step: the number itself */
};

typedef struct iso_step {
    int16_t operation; /* index into the table of operations, or PROGRAM_CONSTANT */
    int16_t to;
    int16_t from[OPERATION_OPERANDS];
    double number;
} iso_step;

struct iso_expression {
    iso_step *step; /* [count] */
    int64_t count, capacity;
    int32_t registers;
    uint32_t used;  /* bit k: variable k */
    int16_t result; /* place */
};

#endif
