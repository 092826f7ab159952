#include "field/formula.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* ---- over arrays ---- */

/* Where a run keeps what: arrays of a block each. */
typedef struct run {
    const iso_formula *formula;
    double *value[FORMULA_VARIABLES + FORMULA_REGISTERS];
    double *slope[OPERATION_OPERANDS]; /* of the step, by its operands */
    double *room;                      /* of registers' slopes, three each */
    double *ones;
    int32_t block, count;
} run;

static double *slope_of(const run *r, int32_t place, int32_t k) {
    if (place < FORMULA_VARIABLES)
        return r->ones;
    return r->room + ((int64_t)(place - FORMULA_VARIABLES) * 3 + k) * r->block;
}

static uint8_t dependence(const uint8_t *slopes, int32_t place) {
    return place < FORMULA_VARIABLES ? (uint8_t)(1 << place) : slopes[place];
}

/* An infinite slope of what doesn't change is none, as of the root of x^2 + y^2 at 0; nor is one
 * that doesn't matter. */
static inline double number_or_0(double slope) {
    return slope == slope ? slope : 0;
}

static void set_product(double *restrict to, const double *by, const double *slope, int32_t count) {
    for (int32_t i = 0; i < count; i++)
        to[i] = number_or_0(by[i] * slope[i]);
}

static void add_product(double *restrict to, const double *by, const double *slope, int32_t count) {
    for (int32_t i = 0; i < count; i++)
        to[i] += number_or_0(by[i] * slope[i]);
}

static void set_scaled(double *restrict to, double by, const double *slope, int32_t count) {
    for (int32_t i = 0; i < count; i++)
        to[i] = by == 0 ? 0 : by * slope[i];
}

static void add_scaled(double *restrict to, double by, const double *slope, int32_t count) {
    for (int32_t i = 0; i < count; i++)
        to[i] += by == 0 ? 0 : by * slope[i];
}

static void run_slopes(const run *r, const formula_step *step, const double *const *from,
                       const uint8_t *slopes) {
    const iso_operation *operation = operation_at(step->operation);
    if (operation->slope) {
        double *wanted[OPERATION_OPERANDS];
        for (int32_t k = 0; k < operation->operands; k++)
            wanted[k] = dependence(slopes, step->from[k]) ? r->slope[k] : NULL;
        operation->slope(wanted, from, r->value[step->to], r->count);
    }
    for (int32_t c = 0; c < 3; c++) {
        if (!(step->slopes >> c & 1))
            continue;
        double *to = slope_of(r, step->to, c);
        bool first = true;
        for (int32_t k = 0; k < operation->operands; k++) {
            if (!(dependence(slopes, step->from[k]) >> c & 1))
                continue;
            const double *slope = slope_of(r, step->from[k], c);
            if (operation->slope)
                (first ? set_product : add_product)(to, r->slope[k], slope, r->count);
            else
                (first ? set_scaled : add_scaled)(to, operation->factor[k], slope, r->count);
            first = false;
        }
    }
}

static void run_steps(const run *r, bool with_slopes, bool with_constants) {
    uint8_t slopes[FORMULA_VARIABLES + FORMULA_REGISTERS] = {0};
    const iso_formula *f = r->formula;
    for (int32_t s = with_constants ? 0 : f->constants; s < f->count; s++) {
        const formula_step *step = &f->step[s];
        double *to = r->value[step->to];
        slopes[step->to] = step->slopes;
        if (step->operation == FORMULA_CONSTANT) {
            int32_t count = s < f->constants ? r->block : r->count;
            for (int32_t i = 0; i < count; i++)
                to[i] = step->number;
            continue;
        }
        const iso_operation *operation = operation_at(step->operation);
        const double *from[OPERATION_OPERANDS];
        for (int32_t k = 0; k < operation->operands; k++)
            from[k] = r->value[step->from[k]];
        operation->apply(to, from, r->count);
        if (with_slopes && step->slopes)
            run_slopes(r, step, from, slopes);
    }
}

static void lay_out(run *r, double *room, bool with_slopes, int64_t count) {
    int32_t registers = r->formula->registers;
    int32_t arrays =
        FORMULA_VARIABLES + registers + (with_slopes ? 3 * registers + OPERATION_OPERANDS + 1 : 0);
    r->block = FORMULA_ROOM / arrays < FORMULA_BLOCK ? FORMULA_ROOM / arrays : FORMULA_BLOCK;
    if (count < r->block)
        r->block = (int32_t)count;
    for (int32_t k = 0; k < FORMULA_VARIABLES + registers; k++, room += r->block)
        r->value[k] = room;
    if (!with_slopes)
        return;
    for (int32_t k = 0; k < OPERATION_OPERANDS; k++, room += r->block)
        r->slope[k] = room;
    r->ones = room;
    r->room = room + r->block;
    for (int32_t i = 0; i < r->block; i++)
        r->ones[i] = 1;
}

static double finite(double slope) {
    return fabs(slope) < HUGE_VAL ? slope : 0;
}

static void take_slopes(iso_vec3 *gradient, const run *r) {
    const iso_formula *f = r->formula;
    static const double nothing[FORMULA_BLOCK];
    const double *by[3];
    for (int32_t c = 0; c < 3; c++)
        by[c] = f->slopes >> c & 1 ? slope_of(r, f->result, c) : nothing;
    for (int32_t i = 0; i < r->count; i++)
        gradient[i] = (iso_vec3){finite(by[0][i]), finite(by[1][i]), finite(by[2][i])};
}

void formula_evaluate(double *value, iso_vec3 *gradient, const iso_formula *formula,
                      const iso_vec3 *at, int64_t count) {
    double room[FORMULA_ROOM];
    run r = {.formula = formula};
    lay_out(&r, room, gradient != NULL, count);
    for (int64_t first = 0; first < count; first += r.block) {
        r.count = count - first < r.block ? (int32_t)(count - first) : r.block;
        for (int32_t i = 0; i < r.count; i++) {
            r.value[0][i] = at[first + i].x;
            r.value[1][i] = at[first + i].y;
            r.value[2][i] = at[first + i].z;
        }
        run_steps(&r, gradient != NULL, first == 0);
        const double *result = r.value[formula->result];
        for (int32_t i = 0; i < r.count; i++)
            value[first + i] = result[i];
        if (gradient)
            take_slopes(gradient + first, &r);
    }
}

/* ---- over a box ---- */

static void set_leaf(enclosure *to, interval value, int32_t variable) {
    to->value = value;
    for (int32_t c = 0; c < ENCLOSURE_SLOPES; c++)
        to->slope[c] = interval_at(c == variable ? 1 : 0);
}

void formula_enclose(enclosure *to, const iso_formula *formula, const interval box[3],
                     int32_t slopes) {
    enclosure place[FORMULA_VARIABLES + FORMULA_REGISTERS];
    for (int32_t k = 0; k < FORMULA_VARIABLES; k++)
        set_leaf(&place[k], box[k], k);
    for (int32_t s = 0; s < formula->count; s++) {
        const formula_step *step = &formula->step[s];
        if (step->operation == FORMULA_CONSTANT) {
            set_leaf(&place[step->to],
                     isnan(step->number) ? interval_whole() : interval_at(step->number), -1);
            continue;
        }
        const iso_operation *operation = operation_at(step->operation);
        const enclosure *from[OPERATION_OPERANDS];
        for (int32_t k = 0; k < operation->operands; k++)
            from[k] = &place[step->from[k]];
        operation->enclose(&place[step->to], from, slopes);
    }
    *to = place[formula->result];
}
