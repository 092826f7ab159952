/* The shadow of meshes: their convex hull seen from above. */
#include <isoslice/object.h>

#include <math.h>

#include "base/memory.h"
#include "planar/hull.h"
#include "planar/predicate.h"

typedef struct gatherer {
    iso_point *point;
    int64_t count, capacity;
    iso_point extreme[9]; /* in eight directions, later their hull */
    int32_t corners;
    bool *used; /* [vertex] of the mesh at hand */
    double top; /* mm; what is above it casts no shadow */
} gatherer;

static bool strictly_inside(const gatherer *g, iso_point p) {
    for (int32_t i = 0; i < g->corners; i++)
        if (orient2d(g->extreme[i], g->extreme[i + 1 == g->corners ? 0 : i + 1], p) <= 0)
            return false;
    return g->corners >= 3;
}

static inline iso_point point_of(const iso_vec3 *p) {
    return (iso_point){iso_units(p->x), iso_units(p->y)};
}

/* The farthest points of a mesh in eight directions: what is within them is not on the hull (Akl
 * and Toussaint, 1978). Of a scan only a few hundred points are left to be sorted. */
static void find_extremes(gatherer *g, const iso_mesh *mesh) {
    iso_point best[8];
    int64_t reach[8];
    for (int k = 0; k < 8; k++)
        reach[k] = INT64_MIN;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        if (!g->used[v])
            continue;
        iso_point p = point_of(&mesh->position[v]);
        const int64_t x = p.x, y = p.y, value[8] = {x, x + y, y, y - x, -x, -x - y, -y, x - y};
        for (int k = 0; k < 8; k++)
            if (value[k] > reach[k]) {
                reach[k] = value[k];
                best[k] = p;
            }
    }
    g->corners = hull_of(g->extreme, best, 8);
}

static iso_status add_point(gatherer *g, iso_point p) {
    if (strictly_inside(g, p))
        return ISO_OK;
    ISO_TRY(ISO_GROW(g->point, g->capacity, g->count + 1));
    g->point[g->count++] = p;
    return ISO_OK;
}

/* Where edges go up through the top. */
static iso_status gather_cuts(gatherer *g, const iso_mesh *mesh) {
    for (int64_t a = 0; a < 3 * (int64_t)mesh->triangle_count; a++) {
        const iso_vec3 *p = &mesh->position[mesh->origin[a]];
        const iso_vec3 *q = &mesh->position[mesh->origin[a % 3 == 2 ? a - 2 : a + 1]];
        if (!(p->z <= g->top && q->z > g->top))
            continue;
        double t = (g->top - p->z) / (q->z - p->z);
        iso_vec3 cut = {p->x + t * (q->x - p->x), p->y + t * (q->y - p->y), g->top};
        ISO_TRY(add_point(g, point_of(&cut)));
    }
    return ISO_OK;
}

static iso_status gather(gatherer *g, const iso_mesh *mesh) {
    ISO_TRY(ISO_ALLOCATE(g->used, mesh->vertex_count));
    memset(g->used, 0, (size_t)mesh->vertex_count * sizeof *g->used);
    for (int64_t a = 0; a < 3 * (int64_t)mesh->triangle_count; a++)
        g->used[mesh->origin[a]] = mesh->position[mesh->origin[a]].z <= g->top;
    find_extremes(g, mesh);
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        if (!g->used[v])
            continue;
        ISO_TRY(add_point(g, point_of(&mesh->position[v])));
    }
    if (mesh->max.z > g->top)
        ISO_TRY(gather_cuts(g, mesh));
    iso_release(g->used);
    g->used = NULL;
    return ISO_OK;
}

static iso_status gather_all(gatherer *g, const iso_mesh *mesh, int32_t count) {
    const double limit = (double)ISO_COORDINATE_MAX / ISO_UNITS_PER_MM - 1;
    for (int32_t i = 0; i < count; i++) {
        if (mesh[i].triangle_count == 0 || mesh[i].min.z > g->top)
            continue;
        iso_vec3 low = mesh[i].min, high = mesh[i].max;
        if (!(low.x >= -limit && low.y >= -limit && high.x <= limit && high.y <= limit))
            return iso_fail(ISO_OUTSIDE,
                            "the model reaches from (%.3f, %.3f) to (%.3f, %.3f) mm, beyond the "
                            "+-%.1f mm that can be sliced",
                            low.x, low.y, high.x, high.y, iso_mm(ISO_COORDINATE_MAX));
        ISO_TRY(gather(g, &mesh[i]));
    }
    return ISO_OK;
}

iso_status iso_meshes_hull(iso_region *hull, const iso_mesh *mesh, int32_t count) {
    return iso_meshes_hull_below(hull, mesh, count, INFINITY);
}

iso_status iso_meshes_hull_below(iso_region *hull, const iso_mesh *mesh, int32_t count, double z) {
    gatherer g = {.top = z};
    iso_point *corner = NULL;
    iso_region_clear(hull);
    iso_status status = gather_all(&g, mesh, count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(corner, g.count + 1);
    if (status == ISO_OK) {
        int32_t corners = hull_of(corner, g.point, (int32_t)g.count);
        if (corners >= 3)
            status = iso_region_add(hull, corner, corners);
    }
    iso_release(corner);
    iso_release(g.point);
    iso_release(g.used);
    return status;
}
