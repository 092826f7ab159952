/* From the text of an expression to its steps. */
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "field/number.h"
#include "field/program.h"

enum {
    NESTING = 100, /* brackets, signs, powers and conditions within each other; bounds the stack */
    STEPS = 1 << 20
};

/* A part of the expression: a number as long as everything in it is one, then a place. */
typedef struct part {
    bool is_number;
    int16_t place;
    double number;
} part;

typedef struct parser {
    const char *text, *at;
    const char *const *name;
    int32_t names;
    int32_t depth, busy; /* registers that hold parts still to be used: the first ones */
    iso_expression *out;
} parser;

/* ---- messages ---- */

static iso_status fail_at(const parser *p, const char *at, const char *what) {
    return iso_fail(ISO_BAD_CONFIG, "column %d: %s", (int)(at - p->text) + 1, what);
}

static iso_status expected(const parser *p, const char *what) {
    char text[160];
    unsigned char c = (unsigned char)*p->at;
    if (c == 0)
        snprintf(text, sizeof text, "expected %s, not the end", what);
    else if (c >= ' ' && c < 127)
        snprintf(text, sizeof text, "expected %s, not '%c'", what, c);
    else
        snprintf(text, sizeof text, "expected %s, not a byte %d", what, c);
    return fail_at(p, p->at, text);
}

static iso_status unknown(const parser *p, const char *at, int32_t length, bool is_function) {
    char text[400];
    int used = snprintf(text, sizeof text, "there is no %s '%.*s'",
                        is_function ? "function" : "variable", length < 40 ? length : 40, at);
    for (int32_t i = 0; i < p->names && !is_function && used < (int)sizeof text; i++)
        used += snprintf(text + used, sizeof text - (size_t)used, "%s%s",
                         i == 0 ? "; there are pi, " : ", ", p->name[i]);
    return fail_at(p, at, text);
}

/* ---- steps ---- */

static iso_status add_step(parser *p, const iso_step *step) {
    iso_expression *out = p->out;
    if (out->count >= STEPS)
        return fail_at(p, p->at, "the expression is too long");
    ISO_TRY(ISO_GROW(out->step, out->capacity, out->count + 1));
    out->step[out->count++] = *step;
    return ISO_OK;
}

static iso_status next_register(int16_t *place, parser *p) {
    if (p->busy >= PROGRAM_REGISTERS)
        return fail_at(p, p->at, "the expression is nested too deeply");
    *place = (int16_t)(PROGRAM_VARIABLES + p->busy++);
    if (p->busy > p->out->registers)
        p->out->registers = p->busy;
    return ISO_OK;
}

static iso_status put_number(part *value, parser *p) {
    iso_step step = {.operation = PROGRAM_CONSTANT, .number = value->number};
    ISO_TRY(next_register(&step.to, p));
    ISO_TRY(add_step(p, &step));
    *value = (part){.place = step.to};
    return ISO_OK;
}

static void fold(part *value, const iso_operation *operation, const part *from) {
    const double *number[OPERATION_OPERANDS];
    for (int32_t i = 0; i < operation->operands; i++)
        number[i] = &from[i].number;
    double result;
    operation->apply(&result, number, 1);
    *value = (part){true, 0, result};
}

/* value = operation(from); the registers of its operands, which are the last ones that are busy,
 * become free and the first of them takes the result. */
static iso_status apply(part *value, parser *p, int32_t index, part *from) {
    const iso_operation *operation = operation_at(index);
    bool all_numbers = true;
    for (int32_t i = 0; i < operation->operands; i++)
        all_numbers = all_numbers && from[i].is_number;
    if (all_numbers) {
        fold(value, operation, from);
        return ISO_OK;
    }
    iso_step step = {.operation = (int16_t)index};
    int32_t lowest = p->busy + PROGRAM_VARIABLES;
    for (int32_t i = 0; i < operation->operands; i++) {
        if (from[i].is_number)
            ISO_TRY(put_number(&from[i], p));
        step.from[i] = from[i].place;
        if (from[i].place >= PROGRAM_VARIABLES && from[i].place < lowest)
            lowest = from[i].place;
    }
    p->busy = lowest - PROGRAM_VARIABLES;
    ISO_TRY(next_register(&step.to, p));
    ISO_TRY(add_step(p, &step));
    *value = (part){.place = step.to};
    return ISO_OK;
}

/* ---- tokens ---- */

static void skip_blanks(parser *p) {
    while (*p->at == ' ' || *p->at == '\t' || *p->at == '\n' || *p->at == '\r')
        p->at++;
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

static bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool take(parser *p, char c) {
    if (*p->at != c)
        return false;
    p->at++;
    skip_blanks(p);
    return true;
}

static iso_status enter(parser *p) {
    if (p->depth >= NESTING)
        return fail_at(p, p->at, "brackets, powers and conditions are nested deeper than 100");
    p->depth++;
    return ISO_OK;
}

static iso_status read_number(part *value, parser *p) {
    *value = (part){.is_number = true};
    if (!number_read(&value->number, &p->at))
        return expected(p, "digits of the exponent");
    if (is_letter(*p->at) || *p->at == '.')
        return expected(p, "an operator behind the number");
    skip_blanks(p);
    return ISO_OK;
}

/* ---- grammar ---- */

static iso_status read_condition(part *value, parser *p);

/* (a, b ...) behind the name of a function. */
static iso_status read_call(part *value, parser *p, int32_t index, const char *at) {
    const iso_operation *operation = operation_at(index);
    part from[OPERATION_OPERANDS];
    int32_t count = 0;
    char text[120];
    do {
        if (count == operation->operands) {
            ISO_TRY(apply(&from[0], p, index, from));
            count = 1;
        }
        ISO_TRY(read_condition(&from[count++], p));
    } while ((count < operation->operands || operation->more) && take(p, ','));
    if (count == operation->operands && take(p, ')'))
        return apply(value, p, index, from);
    if (*p->at != ',' && *p->at != ')')
        return expected(p, "an operator, ',' or ')'");
    snprintf(text, sizeof text, "%s takes %d value%s%s", operation->name, (int)operation->operands,
             operation->operands > 1 ? "s" : "", operation->more ? " or more" : "");
    return fail_at(p, at, text);
}

static iso_status read_name(part *value, parser *p) {
    const char *at = p->at;
    while (is_letter(*p->at) || is_digit(*p->at))
        p->at++;
    int32_t length = (int32_t)(p->at - at);
    skip_blanks(p);
    if (*p->at == '(') {
        int32_t index = operation_find(at, length);
        if (index < 0)
            return unknown(p, at, length, true);
        take(p, '(');
        return read_call(value, p, index, at);
    }
    for (int32_t i = 0; i < p->names; i++) {
        if (strlen(p->name[i]) == (size_t)length && !memcmp(p->name[i], at, (size_t)length)) {
            *value = (part){.place = (int16_t)i};
            p->out->used |= (uint32_t)1 << i;
            return ISO_OK;
        }
    }
    if (length == 2 && !memcmp(at, "pi", 2)) {
        *value = (part){true, 0, 3.14159265358979323846};
        return ISO_OK;
    }
    if (operation_find(at, length) >= 0)
        return expected(p, "'(' behind the name of a function");
    return unknown(p, at, length, false);
}

static iso_status read_value(part *value, parser *p) {
    if (number_begins(p->at))
        return read_number(value, p);
    if (is_letter(*p->at))
        return read_name(value, p);
    if (!take(p, '('))
        return expected(p, "a number, a name or '('");
    ISO_TRY(read_condition(value, p));
    return take(p, ')') ? ISO_OK : expected(p, "an operator or ')'");
}

/* Signs bind less than powers: -2 ^ 2 = -4, and 2 ^ -1 = 0.5. */
static iso_status read_signed(part *value, parser *p) {
    part from[2];
    ISO_TRY(enter(p));
    if (take(p, '-')) {
        ISO_TRY(read_signed(&from[0], p));
        ISO_TRY(apply(value, p, OPERATION_NEGATE, from));
    } else if (take(p, '+')) {
        ISO_TRY(read_signed(value, p));
    } else {
        ISO_TRY(read_value(value, p));
        if (take(p, '^')) {
            from[0] = *value;
            ISO_TRY(read_signed(&from[1], p));
            ISO_TRY(apply(value, p, OPERATION_POWER, from));
        }
    }
    p->depth--;
    return ISO_OK;
}

/* Operators between two values, longer spellings first. */
static const struct {
    char text[3];
    int8_t length, strength, operation;
} binary[] = {
    {"<=", 2, 1, OPERATION_LESS_EQUAL}, {">=", 2, 1, OPERATION_GREATER_EQUAL},
    {"==", 2, 1, OPERATION_EQUAL},      {"!=", 2, 1, OPERATION_UNEQUAL},
    {"<", 1, 1, OPERATION_LESS},        {">", 1, 1, OPERATION_GREATER},
    {"+", 1, 2, OPERATION_ADD},         {"-", 1, 2, OPERATION_SUBTRACT},
    {"*", 1, 3, OPERATION_MULTIPLY},    {"/", 1, 3, OPERATION_DIVIDE},
};

static int32_t find_binary(const parser *p) {
    for (int32_t i = 0; i < (int32_t)(sizeof binary / sizeof *binary); i++)
        if (!strncmp(p->at, binary[i].text, (size_t)binary[i].length))
            return i;
    return -1;
}

/* Values and operators of at least this strength. */
static iso_status read_binary(part *value, parser *p, int32_t strength) {
    ISO_TRY(read_signed(value, p));
    bool compared = false;
    for (int32_t i; (i = find_binary(p)) >= 0 && binary[i].strength >= strength;) {
        if (binary[i].strength == 1 && compared)
            return fail_at(p, p->at, "a comparison that is compared again needs brackets");
        compared = binary[i].strength == 1;
        part from[2] = {*value};
        p->at += binary[i].length;
        skip_blanks(p);
        ISO_TRY(read_binary(&from[1], p, binary[i].strength + 1));
        ISO_TRY(apply(value, p, binary[i].operation, from));
    }
    return ISO_OK;
}

static iso_status read_condition(part *value, parser *p) {
    part from[3];
    ISO_TRY(enter(p));
    ISO_TRY(read_binary(value, p, 1));
    if (take(p, '?')) {
        from[0] = *value;
        ISO_TRY(read_condition(&from[1], p));
        if (!take(p, ':'))
            return expected(p, "an operator or ':'");
        ISO_TRY(read_condition(&from[2], p));
        ISO_TRY(apply(value, p, OPERATION_SELECT, from));
    }
    p->depth--;
    return ISO_OK;
}

static iso_status read_all(parser *p) {
    part value;
    skip_blanks(p);
    ISO_TRY(read_condition(&value, p));
    if (*p->at)
        return expected(p, "an operator or the end");
    if (value.is_number)
        ISO_TRY(put_number(&value, p));
    p->out->result = value.place;
    return ISO_OK;
}

iso_status expression_compile(iso_expression **expression, const char *text,
                              const char *const *name, int32_t count) {
    *expression = NULL;
    if (count < 0 || count > PROGRAM_VARIABLES)
        return iso_fail(ISO_BUG, "an expression of %d variables", (int)count);
    iso_expression *out;
    ISO_TRY(ISO_ALLOCATE(out, 1));
    *out = (iso_expression){0};
    parser p = {.text = text, .at = text, .name = name, .names = count, .out = out};
    iso_status status = read_all(&p);
    if (status == ISO_OK)
        *expression = out;
    else
        expression_free(out);
    return status;
}
