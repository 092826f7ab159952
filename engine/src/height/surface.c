#include "height/surface.h"

#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "base/vector.h"

void surface_free(surface *s) {
    iso_release(s->origin);
    iso_release(s->position);
    closest_free(s->tree);
    *s = (surface){0};
}

static iso_status make_tree(surface *s) {
    iso_vec3 *corner;
    int64_t darts = 3 * (int64_t)s->triangle_count;
    ISO_TRY(ISO_ALLOCATE(corner, darts));
    for (int64_t a = 0; a < darts; a++)
        corner[a] = s->position[s->origin[a]];
    iso_status status = closest_new(&s->tree, corner, s->triangle_count);
    iso_release(corner);
    return status;
}

static iso_status copy(surface *s, const iso_mesh *mesh, int32_t count, iso_vec3 shift) {
    ISO_TRY(ISO_ALLOCATE(s->origin, 3 * (int64_t)s->triangle_count));
    ISO_TRY(ISO_ALLOCATE(s->position, s->vertex_count));
    int32_t *origin = s->origin, first = 0;
    for (int32_t i = 0; i < count; first += mesh[i++].vertex_count) {
        for (int32_t a = 0; a < 3 * mesh[i].triangle_count; a++)
            *origin++ = first + mesh[i].origin[a];
        for (int32_t v = 0; v < mesh[i].vertex_count; v++)
            s->position[first + v] = vec3_minus(mesh[i].position[v], shift);
    }
    return make_tree(s);
}

iso_status surface_new(surface *s, const iso_mesh *mesh, int32_t count, iso_vec3 shift) {
    int64_t triangles = 0, vertices = 0;
    *s = (surface){0};
    for (int32_t i = 0; i < count; i++) {
        triangles += mesh[i].triangle_count;
        vertices += mesh[i].vertex_count;
    }
    if (3 * triangles > INT32_MAX)
        return iso_fail(ISO_UNSLICEABLE, "more than %d triangles in one surface", INT32_MAX / 3);
    s->triangle_count = (int32_t)triangles;
    s->vertex_count = (int32_t)vertices;
    iso_status status = copy(s, mesh, count, shift);
    if (status != ISO_OK)
        surface_free(s);
    return status;
}

/* Of a side, from its start; 0 and 1 exactly at its ends. */
static double share_of_side(iso_vec3 from, iso_vec3 side) {
    double square = vec3_dot(side, side);
    return square > 0 ? fmin(fmax(vec3_dot(from, side) / square, 0), 1) : 0;
}

/* The nearest of the sides' points. */
static void nearest_of_sides(foot *f, const iso_vec3 corner[3], iso_vec3 p) {
    double best = INFINITY;
    for (int k = 0; k < 3; k++) {
        iso_vec3 a = corner[k], side = vec3_minus(corner[(k + 1) % 3], a);
        double share = share_of_side(vec3_minus(p, a), side);
        iso_vec3 at = share < 1 ? vec3_along(a, share, side) : corner[(k + 1) % 3];
        double distance = vec3_distance(p, at);
        if (distance < best) {
            best = distance;
            f->share[k] = 1 - share;
            f->share[(k + 1) % 3] = share;
            f->share[(k + 2) % 3] = 0;
            f->point = at;
        }
    }
}

void surface_nearest_of(foot *f, const surface *s, int32_t triangle, iso_vec3 p) {
    iso_vec3 corner[3];
    for (int k = 0; k < 3; k++)
        corner[k] = s->position[s->origin[3 * triangle + k]];
    f->triangle = triangle;
    iso_vec3 normal = surface_area(s, triangle);
    double square = vec3_dot(normal, normal);
    bool within = square > 0;
    for (int k = 0; k < 3 && within; k++) {
        iso_vec3 b = corner[(k + 1) % 3], c = corner[(k + 2) % 3];
        iso_vec3 part = vec3_cross(vec3_minus(c, b), vec3_minus(p, b));
        f->share[k] = vec3_dot(part, normal) / square;
        within = f->share[k] > 0;
    }
    if (!within) {
        nearest_of_sides(f, corner, p);
        return;
    }
    double above = vec3_dot(vec3_minus(p, corner[0]), normal) / square;
    f->point = vec3_along(p, -above, normal);
}

void surface_nearest(foot *f, const surface *s, iso_vec3 p, int32_t *guess) {
    closest_square(s->tree, p, INFINITY, guess);
    surface_nearest_of(f, s, closest_number(s->tree, *guess), p);
}

int surface_candidates(int32_t *triangle, surface_box *box, const surface *s, iso_vec3 low,
                       iso_vec3 high) {
    int32_t guess = 0;
    box->middle = vec3_between(low, high, 0.5);
    box->radius = vec3_distance(low, high) / 2 * (1 + 1e-9) + 1e-12;
    surface_nearest(&box->nearest, s, box->middle, &guess);
    box->distance = vec3_distance(box->nearest.point, box->middle);
    double reach = (box->distance + 2 * box->radius) * (1 + 1e-9);
    int count = closest_gather(triangle, SURFACE_MOST, s->tree, box->middle, reach);
    for (int i = 0; i < count && count <= SURFACE_MOST; i++)
        triangle[i] = closest_number(s->tree, triangle[i]);
    return count;
}

iso_vec3 surface_area(const surface *s, int32_t triangle) {
    const int32_t *v = s->origin + 3 * triangle;
    iso_vec3 a = s->position[v[0]];
    return vec3_cross(vec3_minus(s->position[v[1]], a), vec3_minus(s->position[v[2]], a));
}
