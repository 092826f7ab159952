#include "slice/range.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/vector.h"

/* mm: what the range may be off. */
#define RANGE_EXACTNESS 0.005

typedef struct range_search {
    const iso_field *field;
    double low, high;
} range_search;

static void take(range_search *s, double value) {
    s->low = fmin(s->low, value);
    s->high = fmax(s->high, value);
}

/* Least and greatest of the slopes' products with a step. */
static void widen(double reach[2], const iso_field_bound *bound, iso_vec3 step) {
    const double low[3] = {bound->gradient_low.x, bound->gradient_low.y, bound->gradient_low.z};
    const double high[3] = {bound->gradient_high.x, bound->gradient_high.y, bound->gradient_high.z};
    const double along[3] = {step.x, step.y, step.z};
    double least = 0, greatest = 0;
    for (int k = 0; k < 3; k++) {
        if (along[k] == 0)
            continue; /* whatever the slope is */
        least += fmin(low[k] * along[k], high[k] * along[k]);
        greatest += fmax(low[k] * along[k], high[k] * along[k]);
    }
    reach[0] = fmin(reach[0], least);
    reach[1] = fmax(reach[1], greatest);
}

/* May the face hold less or more than what is known? From its middle each of its points is a mean
 * of the ways to the corners, and so is what the field gains there, at most. */
static bool may_widen(range_search *s, const iso_vec3 corner[3]) {
    iso_vec3 low = corner[0], high = corner[0];
    for (int k = 1; k < 3; k++) {
        low = vec3(fmin(low.x, corner[k].x), fmin(low.y, corner[k].y), fmin(low.z, corner[k].z));
        high =
            vec3(fmax(high.x, corner[k].x), fmax(high.y, corner[k].y), fmax(high.z, corner[k].z));
    }
    iso_field_bound bound;
    iso_field_bound_over(&bound, s->field, low, high);
    if (bound.low >= s->low - RANGE_EXACTNESS && bound.high <= s->high + RANGE_EXACTNESS)
        return false;
    iso_vec3 middle = vec3_times(vec3_plus(corner[0], vec3_plus(corner[1], corner[2])), 1.0 / 3);
    double value, reach[2] = {0, 0};
    iso_field_evaluate(&value, NULL, s->field, &middle, 1);
    take(s, value);
    for (int k = 0; k < 3; k++)
        widen(reach, &bound, vec3_minus(corner[k], middle));
    return !(value + reach[0] >= s->low - RANGE_EXACTNESS &&
             value + reach[1] <= s->high + RANGE_EXACTNESS);
}

/* Quarter the face for as long as it may. */
static void search_face(range_search *s, iso_vec3 a, iso_vec3 b, iso_vec3 c, int depth) {
    if (depth == 0 || !may_widen(s, (iso_vec3[3]){a, b, c}))
        return;
    iso_vec3 ab = vec3_between(a, b, 0.5), bc = vec3_between(b, c, 0.5),
             ca = vec3_between(c, a, 0.5);
    search_face(s, a, ab, ca, depth - 1);
    search_face(s, ab, b, bc, depth - 1);
    search_face(s, ca, bc, c, depth - 1);
    search_face(s, ab, bc, ca, depth - 1);
}

enum { RANGE_DEPTH = 12, RANGE_BLOCK = 256 };

static void search_vertices(range_search *s, const iso_mesh *mesh) {
    double value[RANGE_BLOCK];
    for (int32_t v = 0; v < mesh->vertex_count; v += RANGE_BLOCK) {
        int32_t count = mesh->vertex_count - v < RANGE_BLOCK ? mesh->vertex_count - v : RANGE_BLOCK;
        iso_field_evaluate(value, NULL, s->field, mesh->position + v, count);
        for (int32_t i = 0; i < count; i++)
            take(s, value[i]);
    }
}

static void search_mesh(range_search *s, const iso_mesh *mesh) {
    search_vertices(s, mesh);
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *v = mesh->origin + 3 * (int64_t)t;
        search_face(s, mesh->position[v[0]], mesh->position[v[1]], mesh->position[v[2]],
                    RANGE_DEPTH);
    }
}

iso_status field_range(double range[2], const iso_field *field, const iso_mesh *mesh,
                       int32_t count) {
    range_search search = {field, INFINITY, -INFINITY};
    for (int32_t i = 0; i < count; i++)
        search_mesh(&search, &mesh[i]);
    range[0] = search.low;
    range[1] = search.high;
    if (isfinite(search.low) && isfinite(search.high))
        return ISO_OK;
    return iso_fail(ISO_BAD_CONFIG, "field: it has no value on some of the model");
}
