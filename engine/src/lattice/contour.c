#include "lattice/contour.h"

#include <stdbool.h>

typedef struct tracer {
    contour *out;
    iso_arena *scratch;
    const contour_grid *grid;
    contour_row below, above;
    uint8_t *sign_below, *sign_above; /* [columns] is the value above 0? */
    int32_t *bottom, *top; /* [columns] crossings of the edges along the rows; -1: none */
    int32_t left, right;   /* of the square at hand; -1: none so far */
    int32_t i, j;
} tracer;

static iso_status add(tracer *t, int32_t *id, contour_crossing at) {
    contour *out = t->out;
    if (out->count % CONTOUR_BLOCK == 0)
        ISO_TRY(ISO_PUSH(out->block[out->count / CONTOUR_BLOCK], t->scratch, CONTOUR_BLOCK));
    *id = out->count++;
    *contour_at(out, *id) = at;
    return ISO_OK;
}

static double extra_between(const contour_row *p, int32_t i, const contour_row *q, int32_t k,
                            double t) {
    return p->extra ? p->extra[i] + t * (q->extra[k] - p->extra[i]) : 0;
}

/* The crossing of side k of the square at hand, made on first demand: from the lesser node to the
 * greater, whichever square asks. */
static iso_status side(tracer *t, int32_t **id, int k) {
    int32_t i = t->i;
    *id = k == 0 ? &t->bottom[i] : k == 1 ? &t->right : k == 2 ? &t->top[i] : &t->left;
    if (**id >= 0)
        return ISO_OK;
    contour_crossing at = {.square = -1, .next = -1};
    if (k == 0 || k == 2) {
        const contour_row *row = k == 0 ? &t->below : &t->above;
        double a = row->value[i], b = row->value[i + 1], part = a / (a - b);
        at.x = i + part;
        at.y = t->j + (k == 2);
        at.extra = extra_between(row, i, row, i + 1, part);
    } else {
        int32_t m = i + (k == 1);
        double a = t->below.value[m], b = t->above.value[m], part = a / (a - b);
        at.x = m;
        at.y = t->j + part;
        at.extra = extra_between(&t->below, m, &t->above, m, part);
    }
    return add(t, *id, at);
}

static iso_status join(tracer *t, int from, int to) {
    int32_t *a, *b;
    ISO_TRY(side(t, &a, from));
    ISO_TRY(side(t, &b, to));
    contour_crossing *in = contour_at(t->out, *a);
    in->next = *b;
    in->square = t->j * (t->grid->columns - 1) + t->i;
    contour_at(t->out, *b)->entered = 1;
    return ISO_OK;
}

/* Sides that rise and fall, by the corners above 0 (bit k: corner k). 5 and 10 have two of each. */
static const int8_t rises[16] = {-1, 3, 0, 3, 1, -1, 0, 3, 2, 2, -1, 2, 1, 1, 0, -1};
static const int8_t falls[16] = {-1, 0, 1, 1, 2, -1, 2, 2, 3, 0, -1, 1, 3, 0, 3, -1};

static iso_status trace_square(tracer *t, int corners) {
    int32_t i = t->i;
    if (corners != 5 && corners != 10)
        return join(t, rises[corners], falls[corners]);
    double sum =
        (t->below.value[i] + t->below.value[i + 1]) + (t->above.value[i] + t->above.value[i + 1]);
    int turn = sum <= 0 ? 1 : 3; /* around the corner above 0, or around the one below */
    int first = corners == 5 ? 1 : 0;
    ISO_TRY(join(t, first, (first + turn) % 4));
    return join(t, first + 2, (first + 2 + turn) % 4);
}

/* How many squares from i on surely have no crossing: eight at a time. */
static int32_t empty_run(const tracer *t, int32_t i) {
    int32_t from = i, last = t->grid->columns - 9;
    for (; i < last; i += 8) {
        uint64_t a, b, all = t->sign_below[i] ? 0x0101010101010101u : 0;
        memcpy(&a, t->sign_below + i, 8);
        memcpy(&b, t->sign_above + i, 8);
        if (a != all || b != all || t->sign_below[i + 8] != t->sign_below[i] ||
            t->sign_above[i + 8] != t->sign_below[i])
            break;
    }
    return i - from;
}

static iso_status trace_row(tracer *t) {
    const uint8_t *square = t->grid->square;
    int32_t squares = t->grid->columns - 1;
    for (int32_t i = 0; i <= squares; i++)
        t->top[i] = -1;
    t->left = -1;
    for (int32_t i = 0; i < squares; i++, t->left = t->right) {
        if (i % 8 == 0) {
            int32_t run = empty_run(t, i);
            i += run;
            if (run && i >= squares)
                break;
            if (run)
                t->left = -1;
        }
        int corners = t->sign_below[i] | t->sign_below[i + 1] << 1 | t->sign_above[i + 1] << 2 |
                      t->sign_above[i] << 3;
        t->right = -1;
        if (corners == 0 || corners == 15 || (square && !square[(int64_t)t->j * squares + i]))
            continue;
        t->i = i;
        ISO_TRY(trace_square(t, corners));
    }
    return ISO_OK;
}

static void read_row(tracer *t, int32_t j) {
    t->grid->row(&t->above, t->grid->context, j);
    for (int32_t i = 0; i < t->grid->columns; i++)
        t->sign_above[i] = t->above.value[i] > 0;
}

iso_status contour_trace(contour *out, const contour_grid *grid, iso_arena *scratch) {
    tracer t = {.out = out, .scratch = scratch, .grid = grid};
    int64_t columns = grid->columns, edges = 2 * columns * grid->rows;
    *out = (contour){0};
    if (edges > INT32_MAX / 2)
        return iso_fail(ISO_USAGE, "lattice: a grid of %d x %d samples is too fine", grid->columns,
                        grid->rows);
    ISO_TRY(ISO_PUSH(out->block, scratch, edges / CONTOUR_BLOCK + 1));
    ISO_TRY(ISO_PUSH(t.sign_below, scratch, columns));
    ISO_TRY(ISO_PUSH(t.sign_above, scratch, columns));
    ISO_TRY(ISO_PUSH(t.bottom, scratch, columns));
    ISO_TRY(ISO_PUSH(t.top, scratch, columns));
    for (int32_t i = 0; i < columns; i++)
        t.bottom[i] = t.top[i] = -1;
    for (int32_t j = 0; j < grid->rows; j++) {
        uint8_t *sign = t.sign_below;
        int32_t *edge = t.bottom;
        t.sign_below = t.sign_above;
        t.sign_above = sign;
        t.bottom = t.top;
        t.top = edge;
        t.below = t.above;
        read_row(&t, j);
        t.j = j - 1;
        if (j > 0)
            ISO_TRY(trace_row(&t));
    }
    return ISO_OK;
}

int32_t contour_start(contour *c, int *closed) {
    for (; c->pass < 2; c->pass++, c->cursor = 0)
        for (; c->cursor < c->count; c->cursor++) {
            const contour_crossing *at = contour_at(c, c->cursor);
            if (at->walked || (c->pass == 0 && at->entered))
                continue;
            *closed = c->pass;
            return c->cursor++;
        }
    return -1;
}
