#include "chart/chart.h"

#include <math.h>

#include "base/vector.h"
#include "chart/kind.h"

static const double pi = 3.14159265358979323846;

/* ---- making ---- */

/* A box around the part, as large again on each side: brims and travels leave it. */
static void bound_above(iso_field_bound *bound, const iso_field *field, const iso_vec3 box[2],
                        double z) {
    iso_vec3 more = vec3_minus(box[1], box[0]), low = vec3_minus(box[0], more);
    low.z = z;
    iso_field_bound_over(bound, field, low, vec3_plus(box[1], more));
}

/* Everywhere, nowhere, or from some height on: what is bent from a flat base isn't bent any more
 * there. A height that is a little too large costs a little time. */
static double find_even(const iso_field *field, const iso_vec3 box[2], double rise) {
    enum { STEPS = 32 };
    double height = box[1].z - box[0].z, even = HUGE_VAL;
    for (int k = STEPS; k >= -1; k--) {
        double z = k >= 0 ? box[0].z + height * k / STEPS : box[0].z - height;
        iso_field_bound bound;
        bound_above(&bound, field, box, z);
        if (!(bound.gradient_low.z > 0 &&
              bound.gradient_high.z - bound.gradient_low.z <= 1e-12 * rise))
            break;
        even = k >= 0 ? z : -HUGE_VAL;
    }
    return even;
}

/* Layers of planes and cones are convex along every line: two normals say it all. */
static bool is_convex(const iso_field *field) {
    iso_field_kind kind = iso_field_kind_of(field);
    return kind == ISO_FIELD_PLANE || kind == ISO_FIELD_CONE;
}

static void make_graph(chart *c, const iso_vec3 box[2]) {
    iso_field_bound bound;
    iso_vec3 gradient;
    bound_above(&bound, c->field, box, 2 * box[0].z - box[1].z);
    c->kind = CHART_GRAPH;
    c->middle = vec3_between(box[0], box[1], 0.5);
    c->stride = vec3_distance(box[0], box[1]) + 1;
    iso_field_evaluate(&c->value, &gradient, c->field, &c->middle, 1);
    c->rise = gradient.z > 0.01 ? gradient.z : 1;
    if (!isfinite(c->value))
        c->value = c->middle.z;
    c->rises = bound.gradient_low.z > 0;
    c->even_above = find_even(c->field, box, c->rise);
}

/* Any direction across the axis. */
static iso_vec3 across_of(iso_vec3 axis) {
    iso_vec3 least = fabs(axis.x) < fabs(axis.y)
                         ? (fabs(axis.x) < fabs(axis.z) ? vec3(1, 0, 0) : vec3(0, 0, 1))
                         : (fabs(axis.y) < fabs(axis.z) ? vec3(0, 1, 0) : vec3(0, 0, 1));
    return vec3_unit(vec3_cross(axis, least));
}

static void take_frame(chart *c) {
    field_shape shape = field_shape_of(c->field);
    c->center = shape.center;
    c->axis = shape.axis;
    if (!(vec3_length(c->axis) > 0.5))
        c->axis = vec3(0, 0, 1);
    iso_vec3 from = vec3_along(shape.from, -vec3_dot(shape.from, c->axis), c->axis);
    c->from = vec3_length(from) > 0.5 ? vec3_unit(from) : across_of(c->axis);
    c->across = vec3_cross(c->axis, c->from);
    c->radius = shape.radius;
}

/* Does the field rise from the chart's axis or center as the chart takes it to? Bent into a flat
 * base it doesn't. */
static bool is_round(const chart *c, const iso_vec3 box[2]) {
    for (int k = 0; k < 9; k++) {
        iso_vec3 at = vec3(box[k & 1].x, box[k >> 1 & 1].y, box[k >> 2 & 1].z), gradient;
        double value, r;
        if (k == 8)
            at = vec3_between(box[0], box[1], 0.37);
        iso_vec3 d = vec3_minus(at, c->center);
        if (c->kind == CHART_CYLINDER)
            d = vec3_along(d, -vec3_dot(d, c->axis), c->axis);
        r = vec3_length(d);
        iso_field_evaluate(&value, &gradient, c->field, &at, 1);
        if (c->kind != CHART_FAN && !(fabs(value - r) <= 1e-6 * (1 + r)))
            return false;
        double away = vec3_length(vec3_cross(d, c->axis));
        if (c->kind == CHART_FAN && away > 0.01 * c->radius &&
            !(fabs(vec3_length(gradient) * away - c->radius) <= 1e-6 * c->radius))
            return false;
    }
    return true;
}

static bool make_round(chart *c, const iso_vec3 box[2], const double range[2]) {
    switch (iso_field_kind_of(c->field)) {
    case ISO_FIELD_CYLINDER:
        c->kind = CHART_CYLINDER;
        break;
    case ISO_FIELD_SPHERE:
        c->kind = CHART_SPHERE;
        break;
    case ISO_FIELD_FAN:
        c->kind = CHART_FAN;
        break;
    default:
        return false;
    }
    take_frame(c);
    if (!is_round(c, box))
        return false;
    if (c->kind == CHART_FAN)
        return true;
    c->radius = fmax(0.5 * (range[0] + range[1]), 1e-3);
    if (c->kind == CHART_CYLINDER) { /* copies a period apart are then alike to the unit */
        c->period = 2 * iso_mm(iso_units(pi * c->radius));
        c->radius = c->period / (2 * pi);
    }
    return true;
}

/* Somewhere in the part's box a graph must be possible; where exactly it must be, the curves will
 * tell. */
static iso_status check_box(const chart *c, const iso_vec3 box[2]) {
    enum { STEPS = 8 };
    iso_status status = ISO_OK;
    if (c->rises)
        return ISO_OK;
    for (int k = 0; k <= STEPS; k++)
        for (int j = 0; j <= STEPS; j++)
            for (int i = 0; i <= STEPS; i++) {
                iso_vec3 at = {box[0].x + (box[1].x - box[0].x) * i / STEPS,
                               box[0].y + (box[1].y - box[0].y) * j / STEPS,
                               box[0].z + (box[1].z - box[0].z) * k / STEPS};
                status = graph_check(c, &at, 1);
                if (status == ISO_OK)
                    return ISO_OK;
            }
    return status;
}

iso_status chart_new(chart **made, const iso_field *field, bool turns, const iso_vec3 box[2],
                     const double range[2]) {
    chart *c;
    *made = NULL;
    ISO_TRY(ISO_ALLOCATE(c, 1));
    *c = (chart){.field = field};
    if (!turns || !make_round(c, box, range)) {
        *c = (chart){.field = field};
        make_graph(c, box);
        iso_status status = check_box(c, box);
        if (status == ISO_OK && !is_convex(field))
            status = graph_reach(&c->reach, c, box, range);
        if (status != ISO_OK) {
            iso_release(c);
            return status;
        }
    }
    *made = c;
    return ISO_OK;
}

void chart_free(chart *map) {
    iso_release(map);
}

/* ---- asking ---- */

chart_kind chart_kind_of(const chart *map) {
    return map->kind;
}

const iso_field *chart_field(const chart *map) {
    return map->field;
}

double chart_period(const chart *map) {
    return map->period;
}

double chart_reach(const chart *map) {
    return map->reach;
}

/* The layer along the chord is taken for the cubic that has its slopes at the ends: of a bump the
 * height is at most a quarter of the larger slope, of a wave less. */
double chart_rise(const chart_point *a, const chart_point *b) {
    iso_vec3 chord = vec3_minus(b->at, a->at);
    double up = -vec3_dot(chord, a->normal), down = vec3_dot(chord, b->normal);
    double larger = fabs(up) > fabs(down) ? up : down;
    return larger * (up * down > 0 ? 0.25 : 4.0 / 27);
}

/* Lines of the equal-area map bend on the sphere the more, the farther down they are. */
double chart_swerve(const chart *map, const chart_point *point) {
    if (map->kind != CHART_SPHERE)
        return 0;
    double down = point->normal.z;
    return 3 * sqrt((1 - down) / fmax(1 + down, 1e-6));
}

void chart_down(iso_vec2 *flat, const chart *map, const iso_vec3 *at, int64_t count) {
    if (map->kind != CHART_GRAPH) {
        round_down(flat, map, at, count);
        return;
    }
    for (int64_t i = 0; i < count; i++)
        flat[i] = (iso_vec2){at[i].x, at[i].y};
}

iso_status chart_layer(chart_point *point, const chart *map, const iso_vec2 *flat,
                       const double layer[2], int64_t count) {
    return map->kind == CHART_GRAPH ? graph_lift(point, map, flat, layer, count)
                                    : round_lift(point, map, flat, layer, count);
}

iso_status chart_lift(chart_point *point, const chart *map, const iso_vec2 *flat, double r,
                      int64_t count) {
    double layer[2] = {r, 0};
    return chart_layer(point, map, flat, layer, count);
}
