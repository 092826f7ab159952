/* Running what an expression was compiled to. */
#include "field/program.h"

#include "base/memory.h"

void expression_free(iso_expression *expression) {
    if (!expression)
        return;
    iso_release(expression->step);
    iso_release(expression);
}

bool expression_uses(const iso_expression *expression, int32_t variable) {
    return variable >= 0 && variable < PROGRAM_VARIABLES && (expression->used >> variable & 1);
}

static void fill(double *to, double number, int32_t count) {
    for (int32_t i = 0; i < count; i++)
        to[i] = number;
}

/* Values `first` and following, `count` of them, at most a block. The last step writes to `value`
 * itself: it has read the variables there by then. */
static void run_block(double *value, const iso_expression *expression, double **place,
                      int32_t count) {
    for (int64_t s = 0; s < expression->count; s++) {
        const iso_step *step = &expression->step[s];
        double *to = s == expression->count - 1 ? value : place[step->to];
        if (step->operation == PROGRAM_CONSTANT) {
            fill(to, step->number, count);
            continue;
        }
        const iso_operation *operation = operation_at(step->operation);
        const double *from[OPERATION_OPERANDS];
        for (int32_t k = 0; k < operation->operands; k++)
            from[k] = place[step->from[k]];
        operation->apply(to, from, count);
    }
    if (expression->count == 0)
        memmove(value, place[expression->result], (size_t)count * sizeof *value);
}

void expression_evaluate(double *value, const iso_expression *expression,
                         const double *const *variable, int64_t count) {
    double room[PROGRAM_ROOM], *place[PROGRAM_VARIABLES + PROGRAM_REGISTERS];
    int32_t registers = expression->registers, block = PROGRAM_BLOCK;
    if (registers * block > PROGRAM_ROOM)
        block = PROGRAM_ROOM / registers;
    for (int32_t i = 0; i < registers; i++)
        place[PROGRAM_VARIABLES + i] = room + (int64_t)i * block;
    for (int64_t first = 0; first < count; first += block) {
        int32_t n = count - first < block ? (int32_t)(count - first) : block;
        for (int32_t k = 0; k < PROGRAM_VARIABLES; k++) /* read only, whatever the type says */
            place[k] =
                expression->used >> k & 1 ? (double *)(uintptr_t)(variable[k] + first) : NULL;
        run_block(value + first, expression, place, n);
    }
}
