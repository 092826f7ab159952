/* Distances along a model's own surface: at a point beside it, what the nearest point of it has. */
#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "base/vector.h"
#include "field/field.h"
#include "height/fields.h"
#include "height/surface.h"

typedef struct geodesic_field {
    iso_field field;
    surface surface;
    double *height;     /* [vertex_count] */
    iso_vec3 *gradient; /* [triangle_count] along the surface */
    double low, high;   /* of all */
} geodesic_field;

/* Linear in a triangle, and level across it. */
static iso_vec3 gradient_in(const geodesic_field *g, int32_t triangle) {
    const int32_t *v = g->surface.origin + 3 * triangle;
    iso_vec3 normal = surface_area(&g->surface, triangle), sum = {0, 0, 0};
    double square = vec3_dot(normal, normal);
    if (!(square > 0))
        return sum;
    for (int k = 0; k < 3; k++) {
        iso_vec3 across =
            vec3_minus(g->surface.position[v[(k + 2) % 3]], g->surface.position[v[(k + 1) % 3]]);
        sum = vec3_along(sum, g->height[v[k]] / square, vec3_cross(normal, across));
    }
    return sum;
}

static void evaluate(double *value, iso_vec3 *gradient, const iso_field *field, const iso_vec3 *at,
                     int64_t count) {
    const geodesic_field *g = (const geodesic_field *)field;
    int32_t guess = 0;
    for (int64_t i = 0; i < count; i++) {
        foot f;
        surface_nearest(&f, &g->surface, at[i], &guess);
        value[i] = 0;
        for (int k = 0; k < 3; k++)
            if (f.share[k] > 0)
                value[i] += f.share[k] * g->height[g->surface.origin[3 * f.triangle + k]];
        if (gradient)
            gradient[i] = g->gradient[f.triangle];
    }
}

static void widen(double *low, double *high, double x) {
    *low = fmin(*low, x);
    *high = fmax(*high, x);
}

/* Gradients are known where but one triangle is near: between two the nearest point may jump. */
static void bound(iso_field_bound *b, const iso_field *field, iso_vec3 low, iso_vec3 high) {
    const geodesic_field *g = (const geodesic_field *)field;
    int32_t triangle[SURFACE_MOST];
    surface_box box;
    int count = surface_candidates(triangle, &box, &g->surface, low, high);
    *b = (iso_field_bound){
        g->low, g->high, {-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
    if (count == 1)
        b->gradient_low = b->gradient_high = g->gradient[triangle[0]];
    if (count > 0 && count <= SURFACE_MOST) {
        b->low = INFINITY;
        b->high = -INFINITY;
        for (int i = 0; i < 3 * count; i++)
            widen(&b->low, &b->high, g->height[g->surface.origin[3 * triangle[i / 3] + i % 3]]);
    }
    double slack = 1e-12 * (1 + fabs(b->low) + fabs(b->high));
    b->low -= slack;
    b->high += slack;
}

static void release(iso_field *field) {
    geodesic_field *g = (geodesic_field *)field;
    surface_free(&g->surface);
    iso_release(g->height);
    iso_release(g->gradient);
    iso_release(g);
}

static const field_operations operations = {ISO_FIELD_GEODESIC, evaluate, bound, release};

static iso_status measure(geodesic_field *g, const iso_mesh *mesh, int32_t count) {
    double lowest = INFINITY;
    ISO_TRY(surface_new(&g->surface, mesh, count, vec3(0, 0, 0)));
    ISO_TRY(ISO_ALLOCATE(g->height, g->surface.vertex_count));
    ISO_TRY(ISO_ALLOCATE(g->gradient, g->surface.triangle_count));
    for (int32_t i = 0; i < count; i++)
        lowest = fmin(lowest, mesh[i].min.z);
    double *height = g->height;
    for (int32_t i = 0; i < count; height += mesh[i++].vertex_count)
        ISO_TRY(height_geodesic_rise(height, &mesh[i], lowest));
    g->low = INFINITY;
    g->high = -INFINITY;
    for (int32_t t = 0; t < g->surface.triangle_count; t++) {
        g->gradient[t] = gradient_in(g, t);
        for (int k = 0; k < 3; k++)
            widen(&g->low, &g->high, g->height[g->surface.origin[3 * t + k]]);
    }
    return ISO_OK;
}

iso_status height_new_geodesic(iso_field **field, const iso_mesh *mesh, int32_t count) {
    int64_t triangles = 0;
    *field = NULL;
    for (int32_t i = 0; i < count; i++)
        triangles += mesh[i].triangle_count;
    if (triangles == 0)
        return iso_fail(ISO_USAGE, "geodesic measures along a model, and there is none");
    geodesic_field *g;
    ISO_TRY(ISO_ALLOCATE(g, 1));
    *g = (geodesic_field){.field = {&operations}};
    iso_status status = measure(g, mesh, count);
    if (status != ISO_OK) {
        release(&g->field);
        return status;
    }
    *field = &g->field;
    return ISO_OK;
}

/* Where its first vertex is among those of the field, or -1. */
static int32_t find(const geodesic_field *g, const iso_mesh *mesh) {
    size_t size = (size_t)mesh->vertex_count * sizeof *mesh->position;
    for (int32_t first = 0; first <= g->surface.vertex_count - mesh->vertex_count; first++)
        if (memcmp(g->surface.position + first, mesh->position, size) == 0)
            return first;
    return -1;
}

void height_of_vertices(double *height, const iso_field *field, const iso_mesh *mesh) {
    if (iso_field_kind_of(field) == ISO_FIELD_GEODESIC) {
        const geodesic_field *g = (const geodesic_field *)field;
        int32_t first = find(g, mesh);
        if (first >= 0) {
            memcpy(height, g->height + first, (size_t)mesh->vertex_count * sizeof *height);
            return;
        }
    }
    iso_field_evaluate(height, NULL, field, mesh->position, mesh->vertex_count);
}
