/* From an expression's steps to a formula's: a graph whose nodes are values, each one there once,
 * then its nodes in order with a register each for as long as it is needed. */
#include "field/formula.h"

#include <math.h>

#include "base/memory.h"
#include "field/program.h"

enum { NONE = -1, VARIABLE = -2 };

typedef struct node {
    int32_t operation; /* FORMULA_CONSTANT or VARIABLE too */
    int32_t from[OPERATION_OPERANDS];
    double number;
} node;

typedef struct graph {
    node *node; /* [count], operands before what is made of them */
    int32_t count;
    int32_t *table; /* [table_size] of nodes by what they are; NONE: free */
    int32_t table_size;
    bool shares; /* one node for the same value; constants stay in their registers */
} graph;

static bool same(const node *a, const node *b) {
    return a->operation == b->operation && !memcmp(a->from, b->from, sizeof a->from) &&
           !memcmp(&a->number, &b->number, sizeof a->number);
}

static uint32_t hash_of(const node *a) {
    uint64_t bits, hash = (uint64_t)(uint32_t)a->operation;
    memcpy(&bits, &a->number, sizeof bits);
    for (int k = 0; k < OPERATION_OPERANDS; k++)
        hash = (hash ^ (uint64_t)(uint32_t)a->from[k]) * 0x9e3779b97f4a7c15u;
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
    return (uint32_t)(hash >> 32);
}

/* The node, or one that is the same already. There is room for it. */
static int32_t add_node(graph *g, node made) {
    if (!g->shares) {
        g->node[g->count] = made;
        return g->count++;
    }
    uint32_t mask = (uint32_t)g->table_size - 1, slot = hash_of(&made) & mask;
    for (; g->table[slot] != NONE; slot = (slot + 1) & mask)
        if (same(&g->node[g->table[slot]], &made))
            return g->table[slot];
    g->table[slot] = g->count;
    g->node[g->count] = made;
    return g->count++;
}

static node node_of(int32_t operation) {
    node made = {.operation = operation};
    for (int k = 0; k < OPERATION_OPERANDS; k++)
        made.from[k] = NONE;
    return made;
}

static bool is(const graph *g, int32_t a, int32_t operation) {
    return g->node[a].operation == operation;
}

static bool is_number(const graph *g, int32_t a, double number) {
    return is(g, a, FORMULA_CONSTANT) && g->node[a].number == number;
}

/* The squares that a sum is of, 1 to `most`; 0: it isn't such a sum. Long ones aren't followed to
 * their end, which may be deeper than the stack. */
static int32_t squares_of(int32_t of[3], const graph *g, int32_t sum, int32_t most) {
    const node *top = &g->node[sum];
    if (top->operation == OPERATION_SQUARE) {
        of[0] = top->from[0];
        return 1;
    }
    if (top->operation != OPERATION_ADD || most < 2)
        return 0;
    int32_t left[3], right[3];
    const node *a = &g->node[top->from[0]], *b = &g->node[top->from[1]];
    bool deep = a->operation == OPERATION_ADD && b->operation == OPERATION_ADD;
    int32_t m = deep ? 0 : squares_of(left, g, top->from[0], most - 1);
    int32_t n = m == 0 ? 0 : squares_of(right, g, top->from[1], most - 1);
    if (m == 0 || n == 0 || m + n > most)
        return 0;
    for (int32_t i = 0; i < m; i++)
        of[i] = left[i];
    for (int32_t i = 0; i < n; i++)
        of[m + i] = right[i];
    return m + n;
}

/* a b = a^2 if they are the same; powers of 2, 1 and one half; sqrt(a^2 + b^2). */
static int32_t add_simplified(graph *g, node made) {
    int32_t a = made.from[0], b = made.from[1];
    if (made.operation == OPERATION_POWER && is_number(g, b, 1))
        return a;
    bool is_square = made.operation == OPERATION_MULTIPLY
                         ? a == b
                         : made.operation == OPERATION_POWER && is_number(g, b, 2);
    bool is_root = made.operation == OPERATION_POWER && is_number(g, b, 0.5);
    if (is_square || is_root) {
        made = node_of(is_square ? OPERATION_SQUARE : OPERATION_SQRT);
        made.from[0] = a;
    }
    int32_t of[3], squares = 0;
    if (made.operation == OPERATION_SQRT)
        squares = squares_of(of, g, a, 3);
    if (squares > 0) {
        made = node_of(squares == 1   ? OPERATION_ABS
                       : squares == 2 ? OPERATION_HYPOT
                                      : OPERATION_NORM3);
        for (int32_t i = 0; i < squares; i++)
            made.from[i] = of[i];
    }
    return add_node(g, made);
}

/* Returns the node of the result. */
static int32_t build(graph *g, const iso_expression *expression) {
    int32_t of[PROGRAM_VARIABLES + PROGRAM_REGISTERS]; /* what a place holds */
    for (int32_t k = 0; k < FORMULA_VARIABLES; k++) {
        node made = node_of(VARIABLE);
        made.number = k;
        of[k] = add_node(g, made);
    }
    for (int64_t s = 0; s < expression->count; s++) {
        const iso_step *step = &expression->step[s];
        if (step->operation == PROGRAM_CONSTANT) {
            node made = node_of(FORMULA_CONSTANT);
            made.number = step->number;
            of[step->to] = add_node(g, made);
            continue;
        }
        node made = node_of(step->operation);
        for (int32_t k = 0; k < operation_at(step->operation)->operands; k++)
            made.from[k] = of[step->from[k]];
        of[step->to] = add_simplified(g, made);
    }
    return of[expression->result];
}

/* ---- registers ---- */

typedef struct plan {
    int32_t *last;   /* [nodes] the last node that needs it; NONE: nothing does */
    int16_t *place;  /* [nodes] */
    uint8_t *slopes; /* [nodes] */
    int16_t free[FORMULA_REGISTERS];
    int32_t free_count, used;
} plan;

static void find_last(plan *p, const graph *g, int32_t result) {
    for (int32_t i = 0; i < g->count; i++)
        p->last[i] = NONE;
    p->last[result] = g->count;
    for (int32_t i = g->count - 1; i >= 0; i--)
        for (int32_t k = 0; p->last[i] != NONE && k < OPERATION_OPERANDS; k++)
            if (g->node[i].from[k] != NONE && p->last[g->node[i].from[k]] == NONE)
                p->last[g->node[i].from[k]] = i;
}

/* False: there are no more. */
static bool take_register(int16_t *place, plan *p) {
    if (p->free_count > 0)
        *place = p->free[--p->free_count];
    else if (p->used < FORMULA_REGISTERS)
        *place = (int16_t)(FORMULA_VARIABLES + p->used++);
    else
        return false;
    return true;
}

static bool place_node(iso_formula *out, plan *p, const graph *g, int32_t i) {
    const node *n = &g->node[i];
    formula_step *step = &out->step[out->count++];
    *step = (formula_step){.operation = (int16_t)n->operation, .number = n->number};
    if (!take_register(&p->place[i], p))
        return false;
    step->to = p->place[i];
    for (int32_t k = 0; k < OPERATION_OPERANDS && n->from[k] != NONE; k++) {
        int32_t from = n->from[k];
        step->from[k] = p->place[from];
        step->slopes |= p->slopes[from];
        bool stays = g->node[from].operation == VARIABLE ||
                     (g->shares && g->node[from].operation == FORMULA_CONSTANT);
        if (p->last[from] == i && !stays) {
            p->free[p->free_count++] = p->place[from];
            p->last[from] = NONE; /* it may be an operand twice */
        }
    }
    p->slopes[i] = step->slopes;
    return true;
}

/* Constants first, where they stay; then the rest. */
static bool place_nodes(iso_formula *out, plan *p, const graph *g, int32_t result) {
    find_last(p, g, result);
    for (int32_t i = 0; i < g->count; i++) {
        bool is_variable = g->node[i].operation == VARIABLE;
        p->place[i] = is_variable ? (int16_t)g->node[i].number : 0;
        p->slopes[i] = is_variable ? (uint8_t)(1 << (int)g->node[i].number) : 0;
    }
    for (int32_t pass = g->shares ? 0 : 1; pass < 2; pass++) {
        for (int32_t i = 0; i < g->count; i++) {
            bool is_constant = g->node[i].operation == FORMULA_CONSTANT;
            if (p->last[i] == NONE || g->node[i].operation == VARIABLE ||
                (g->shares && is_constant != (pass == 0)))
                continue;
            if (!place_node(out, p, g, i))
                return false;
        }
        if (pass == 0)
            out->constants = out->count;
    }
    out->registers = p->used;
    out->result = p->place[result];
    out->slopes = p->slopes[result];
    return true;
}

/* ---- all of it ---- */

/* False in *fits: too many values are needed at once. */
static iso_status try_to_make(iso_formula *made, bool *fits, const iso_expression *expression,
                              graph *g, iso_arena *arena) {
    int64_t most = FORMULA_VARIABLES + expression->count;
    for (g->table_size = 16; g->table_size < 2 * most;)
        g->table_size *= 2;
    plan *p;
    ISO_TRY(ISO_PUSH(p, arena, 1));
    *p = (plan){0};
    ISO_TRY(ISO_PUSH(g->node, arena, most));
    ISO_TRY(ISO_PUSH(g->table, arena, g->table_size));
    ISO_TRY(ISO_PUSH(p->last, arena, most));
    ISO_TRY(ISO_PUSH(p->place, arena, most));
    ISO_TRY(ISO_PUSH(p->slopes, arena, most));
    for (int32_t i = 0; i < g->table_size; i++)
        g->table[i] = NONE;
    iso_formula out = {0};
    ISO_TRY(ISO_ALLOCATE(out.step, most));
    *fits = place_nodes(&out, p, g, build(g, expression));
    if (*fits)
        *made = out;
    else
        formula_free(&out);
    return ISO_OK;
}

/* What is shared is kept longer. Without sharing, the registers of the expression itself are
 * enough. */
iso_status formula_make(iso_formula *made, const iso_expression *expression) {
    *made = (iso_formula){0};
    bool fits = false;
    iso_status status = ISO_OK;
    for (int32_t pass = 0; pass < 2 && !fits && status == ISO_OK; pass++) {
        iso_arena arena = {0};
        graph g = {.shares = pass == 0};
        status = try_to_make(made, &fits, expression, &g, &arena);
        iso_arena_free(&arena);
    }
    if (status == ISO_OK && !fits)
        return iso_fail(ISO_BAD_CONFIG, "column 1: the expression is nested too deeply");
    return status;
}

void formula_free(iso_formula *formula) {
    iso_release(formula->step);
    formula->step = NULL;
}
