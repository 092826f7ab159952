/* The chart in which u, v are x, y: a layer is a height over the bed. */
#include <math.h>

#include "base/vector.h"
#include "chart/kind.h"

enum {
    BLOCK = 128,      /* points at a time: what they need stays in the first cache */
    ROUNDS_MOST = 80, /* of the search for z; halving alone takes 50 */
    FAR_OFF = 10      /* strides: nothing that is printed is as far from the part's middle */
};

/* A step of Newton's is the last one if it is no longer than this, mm: its error goes with the
 * square. */
static const double last_step = 1e-6;

/* A block of searches for the z where F = r. Done ones are passed over. */
typedef struct search {
    int32_t count;                  /* under way */
    int32_t index[BLOCK];           /* of each of them */
    iso_vec3 at[BLOCK];             /* [count] where they are */
    double value[BLOCK];            /* [count] */
    iso_vec3 rising[BLOCK];         /* [count] gradients */
    double low[BLOCK], high[BLOCK]; /* by index: z known to lie below and above the layer */
} search;

/* Where to look next: Newton's step, or halves where that leaves what is known. */
static double next_z(const chart *map, search *s, int32_t k, double r) {
    int32_t i = s->index[k];
    double z = s->at[k].z, value = s->value[k], rise = s->rising[k].z;
    if (isnan(value)) /* back to where there is a value */
        return 0.5 * (z + map->middle.z);
    if (value < r)
        s->low[i] = z;
    else
        s->high[i] = z;
    double step = rise > 0 ? (r - value) / rise : (double)NAN;
    if (!(fabs(step) <= map->stride))
        step = value < r ? map->stride : -map->stride;
    double next = z + step;
    if (next > s->low[i] && next < s->high[i])
        return next;
    if (isinf(s->low[i]) || isinf(s->high[i]))
        return next;
    return fabs(step) <= last_step ? z : 0.5 * (s->low[i] + s->high[i]);
}

static void accept(chart_point *point, iso_vec3 at, iso_vec3 gradient) {
    double steepness = vec3_length(gradient);
    *point = (chart_point){.at = at,
                           .normal = vec3_times(gradient, 1 / steepness),
                           .thickness = 1 / steepness,
                           .volume = 1 / gradient.z};
}

/* Every search goes a step on; those that arrive become points. */
static void advance(chart_point *point, const chart *map, search *s, double r) {
    int32_t left = 0;
    iso_field_evaluate(s->value, s->rising, map->field, s->at, s->count);
    for (int32_t k = 0; k < s->count; k++) {
        double z = next_z(map, s, k, r);
        bool there = fabs(z - s->at[k].z) <= last_step && s->rising[k].z > 0 && !isnan(s->value[k]);
        s->at[k].z = z;
        if (there) {
            accept(&point[s->index[k]], s->at[k], s->rising[k]);
            continue;
        }
        s->index[left] = s->index[k];
        s->at[left++] = s->at[k];
    }
    s->count = left;
}

static iso_status no_layer(const search *s, double r) {
    return iso_fail(ISO_OUTSIDE,
                    "the field has no layer %.3f at x %.3f y %.3f mm (from the middle of the "
                    "object), or one that doesn't lie face up: choose a field that rises with z "
                    "around the object",
                    r, s->at[0].x, s->at[0].y);
}

static iso_status run_search(chart_point *point, const chart *map, search *s, double r) {
    for (int round = 0; s->count > 0; round++) {
        if (round == ROUNDS_MOST || fabs(s->at[0].z - map->middle.z) > FAR_OFF * map->stride)
            return no_layer(s, r);
        advance(point, map, s, r);
    }
    return ISO_OK;
}

/* Means over the layer are the values halfway down, but for what goes with the square of the
 * thickness. */
static void take_means(chart_point *point, const chart *map, double thickness, int32_t count) {
    iso_vec3 at[BLOCK], gradient[BLOCK];
    double value[BLOCK];
    int32_t index[BLOCK], n = 0;
    for (int32_t i = 0; i < count; i++) {
        double z = point[i].at.z - 0.5 * thickness * point[i].volume;
        if (z >= map->even_above)
            continue;
        at[n] = vec3(point[i].at.x, point[i].at.y, z);
        index[n++] = i;
    }
    if (n > 0)
        iso_field_evaluate(value, gradient, map->field, at, n);
    for (int32_t k = 0; k < n; k++) {
        if (!(gradient[k].z > 0))
            continue; /* beneath the part, where there needn't be layers: as it is above */
        point[index[k]].thickness = 1 / vec3_length(gradient[k]);
        point[index[k]].volume = 1 / gradient[k].z;
    }
}

/* F = rise z + something of x and y, above some height: one look is enough, wherever that is. What
 * turns out to lie lower is left to the search. */
static void lift_even(chart_point *point, const chart *map, search *s, const iso_vec2 *flat,
                      double r, int32_t count) {
    double start = isinf(map->even_above) ? map->middle.z : map->even_above;
    for (int32_t i = 0; i < count; i++)
        s->at[i] = vec3(flat[i].x, flat[i].y, start);
    iso_field_evaluate(s->value, s->rising, map->field, s->at, count);
    for (int32_t i = 0; i < count; i++) {
        iso_vec3 at = s->at[i];
        at.z += (r - s->value[i]) / s->rising[i].z;
        if (at.z >= map->even_above && fabs(at.z) < HUGE_VAL) {
            accept(&point[i], at, s->rising[i]);
            continue;
        }
        s->index[s->count++] = i;
    }
}

static iso_status lift_block(chart_point *point, const chart *map, const iso_vec2 *flat, double r,
                             double start, int32_t count) {
    search s = {.count = 0};
    if (map->even_above < HUGE_VAL)
        lift_even(point, map, &s, flat, r, count);
    else
        for (; s.count < count; s.count++)
            s.index[s.count] = s.count;
    for (int32_t k = 0; k < s.count; k++) {
        int32_t i = s.index[k];
        s.at[k] = vec3(flat[i].x, flat[i].y, start);
        s.low[i] = -HUGE_VAL;
        s.high[i] = HUGE_VAL;
    }
    return run_search(point, map, &s, r);
}

iso_status graph_lift(chart_point *point, const chart *map, const iso_vec2 *flat,
                      const double layer[2], int64_t count) {
    double start = map->middle.z + (layer[0] - map->value) / map->rise;
    for (int64_t i = 0; i < count; i += BLOCK) {
        int32_t here = (int32_t)(count - i < BLOCK ? count - i : BLOCK);
        ISO_TRY(lift_block(point + i, map, flat + i, layer[0], start, here));
        start = point[i + here - 1].at.z;
        if (layer[1] > 0)
            take_means(point + i, map, layer[1], here);
    }
    return ISO_OK;
}

iso_status graph_check(const chart *map, const iso_vec3 *at, int64_t count) {
    iso_vec3 gradient[BLOCK];
    double value[BLOCK];
    for (int64_t i = 0; i < count && !map->rises; i += BLOCK) {
        int32_t here = (int32_t)(count - i < BLOCK ? count - i : BLOCK);
        iso_field_evaluate(value, gradient, map->field, at + i, here);
        for (int32_t k = 0; k < here; k++)
            if (!(gradient[k].z > 0))
                return iso_fail(ISO_OUTSIDE,
                                "the field doesn't rise with z at x %.3f y %.3f z %.3f mm (from "
                                "the middle of the object and its foot), so that its layers don't "
                                "lie face up there: choose another field, or a machine that turns "
                                "the part (kinematics)",
                                at[i + k].x, at[i + k].y, at[i + k].z);
    }
    return ISO_OK;
}
