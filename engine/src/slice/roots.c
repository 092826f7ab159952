/* Newton's method from the root of the parabola that the slopes at the ends tell of, between bounds
 * that close in: a step that leaves them, or gains too little, halves what is between. Points are
 * done by blocks, those that are there already left out. */
#include "slice/roots.h"

#include <math.h>
#include <stdbool.h>

#include "base/vector.h"

#define CLOSE 1e-7  /* mm, of F to the level; fields rise about 1 a mm */
#define NEAR 1e-3   /* of the edge: a Newton step this short is the last, without asking again */
#define TIGHT 1e-13 /* of the edge: there is nothing left between the bounds */

enum { STEPS_MAX = 80 };

typedef struct search {
    double low, high, t; /* of the edge: F <= level at low, > at high */
    double step;         /* between the bounds, two steps ago */
} search;

/* F(t) = F0 + t (F1 - F0) - t (1 - t) bend / 2: one step of Newton's from where it is linear. */
static double guess(const root_edge *e) {
    double rise = e->value[1] - e->value[0], bend = e->slope[1] - e->slope[0];
    double t = (e->level - e->value[0]) / rise;
    double better = t + 0.5 * t * (1 - t) * bend / (rise - 0.5 * (1 - 2 * t) * bend);
    return better > 0 && better < 1 ? better : t;
}

static double halve(search *s) {
    return 0.5 * (s->low + s->high);
}

/* Is the search over, with t where it shall be? */
static bool improve(search *s, const root_edge *e, double value, iso_vec3 gradient) {
    double off = value - e->level, slope = vec3_dot(gradient, vec3_minus(e->end[1], e->end[0]));
    double step = -off / slope, t = s->t + step, width = s->high - s->low;
    if (fabs(off) <= CLOSE * 1e-3)
        return true;
    if (off <= 0)
        s->low = s->t;
    else
        s->high = s->t;
    if (t > s->low && t < s->high && 2 * fabs(step) < s->step) {
        s->t = t;
        s->step = fabs(step);
        return fabs(step) <= NEAR * 1e-3 || (fabs(step) <= NEAR && fabs(off) <= 10 * CLOSE);
    }
    s->t = halve(s);
    s->step = width;
    return s->high - s->low <= TIGHT;
}

void roots_find(iso_vec3 *point, const iso_field *field, const root_edge *edge, int32_t count) {
    search state[ROOTS_BLOCK];
    int32_t open[ROOTS_BLOCK], left = count;
    iso_vec3 at[ROOTS_BLOCK], gradient[ROOTS_BLOCK];
    double value[ROOTS_BLOCK];
    for (int32_t i = 0; i < count; i++) {
        state[i] = (search){0, 1, guess(&edge[i]), 2};
        open[i] = i;
    }
    for (int round = 0; round < STEPS_MAX && left > 0; round++) {
        int32_t kept = 0;
        for (int32_t k = 0; k < left; k++)
            at[k] = vec3_between(edge[open[k]].end[0], edge[open[k]].end[1], state[open[k]].t);
        iso_field_evaluate(value, gradient, field, at, left);
        for (int32_t k = 0; k < left; k++)
            if (!improve(&state[open[k]], &edge[open[k]], value[k], gradient[k]))
                open[kept++] = open[k];
        left = kept;
    }
    for (int32_t i = 0; i < count; i++)
        point[i] = vec3_between(edge[i].end[0], edge[i].end[1], state[i].t);
}
