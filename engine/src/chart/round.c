/* Charts of layers around an axis or a point: formulas both ways. */
#include <math.h>

#include "base/series.h"
#include "base/vector.h"
#include "chart/kind.h"

/* ---- down ---- */

static iso_vec2 cylinder_down(const chart *c, iso_vec3 at) {
    iso_vec3 d = vec3_minus(at, c->center);
    double angle = series_arctangent2(vec3_dot(d, c->across), vec3_dot(d, c->from));
    double u = c->radius * angle, half = 0.5 * c->period;
    return (iso_vec2){u < half ? u : u - c->period, vec3_dot(d, c->axis)};
}

/* Lambert's azimuthal equal-area map, 1772: the distance from the middle is that in space, from the
 * point straight up. */
static iso_vec2 sphere_down(const chart *c, iso_vec3 at) {
    iso_vec3 d = vec3_unit(vec3_minus(at, c->center));
    double stretch = c->radius * sqrt(2 / fmax(1 + d.z, 1e-12));
    return (iso_vec2){stretch * d.x, stretch * d.y};
}

static iso_vec2 fan_down(const chart *c, iso_vec3 at) {
    iso_vec3 d = vec3_minus(at, c->center);
    double along = vec3_dot(d, c->axis);
    return (iso_vec2){along, vec3_length(vec3_along(d, -along, c->axis))};
}

void round_down(iso_vec2 *flat, const chart *map, const iso_vec3 *at, int64_t count) {
    for (int64_t i = 0; i < count; i++)
        flat[i] = map->kind == CHART_CYLINDER ? cylinder_down(map, at[i])
                  : map->kind == CHART_SPHERE ? sphere_down(map, at[i])
                                              : fan_down(map, at[i]);
}

/* ---- up ---- */

/* In the frame of axis, from and across. */
static iso_vec3 placed(const chart *c, double along, double from, double across) {
    iso_vec3 at = vec3_along(c->center, along, c->axis);
    return vec3_along(vec3_along(at, from, c->from), across, c->across);
}

/* `volume` of a cylinder or sphere is the same all over a layer: it is filled in by round_lift. */
static iso_status cylinder_lift(chart_point *point, const chart *c, iso_vec2 flat, double r) {
    double sine, cosine;
    series_sine_cosine(&sine, &cosine, flat.x / c->radius);
    point->at = placed(c, flat.y, r * cosine, r * sine);
    point->normal = vec3_along(vec3_times(c->from, cosine), sine, c->across);
    return ISO_OK;
}

static iso_status sphere_lift(chart_point *point, const chart *c, iso_vec2 flat, double r) {
    double x = flat.x / c->radius, y = flat.y / c->radius, q = x * x + y * y;
    if (!(q < 4))
        return iso_fail(ISO_OUTSIDE,
                        "a line of spherical layers leads past the point straight down from their "
                        "center (%.3f mm from the middle of the map, which ends at %.3f): choose a "
                        "center further below the object",
                        c->radius * sqrt(q), 2 * c->radius);
    double shrink = sqrt(1 - q / 4);
    point->normal = vec3(x * shrink, y * shrink, 1 - q / 2);
    point->at = vec3_along(c->center, r, point->normal);
    return ISO_OK;
}

static iso_status fan_lift(chart_point *point, const chart *c, iso_vec2 flat, double r,
                           const double turn[2]) {
    if (!(flat.y > 0))
        return iso_fail(ISO_OUTSIDE,
                        "a line of the layer %.3f of the fan crosses its axis, where all layers "
                        "meet: move the axis away from the object",
                        r);
    point->at = placed(c, flat.x, flat.y * turn[1], flat.y * turn[0]);
    point->normal = vec3_along(vec3_times(c->across, turn[1]), -turn[0], c->from);
    point->thickness = point->volume = flat.y / c->radius;
    return ISO_OK;
}

iso_status round_lift(chart_point *point, const chart *map, const iso_vec2 *flat,
                      const double layer[2], int64_t count) {
    double r = layer[0], below = r - layer[1], turn[2] = {0, 1}, volume = 1;
    if (map->kind == CHART_FAN)
        series_sine_cosine(&turn[0], &turn[1], r / map->radius);
    else if (!(below >= 0))
        return iso_fail(ISO_OUTSIDE, "layers around the middle begin at 0, not at %.3f mm", below);
    else if (map->kind == CHART_CYLINDER)
        volume = 0.5 * (r + below) / map->radius;
    else
        volume = (r * r + r * below + below * below) / (3 * map->radius * map->radius);
    for (int64_t i = 0; i < count; i++) {
        point[i].thickness = 1;
        point[i].volume = volume;
        if (map->kind == CHART_CYLINDER)
            ISO_TRY(cylinder_lift(&point[i], map, flat[i], r));
        else if (map->kind == CHART_SPHERE)
            ISO_TRY(sphere_lift(&point[i], map, flat[i], r));
        else
            ISO_TRY(fan_lift(&point[i], map, flat[i], r, turn));
    }
    return ISO_OK;
}
