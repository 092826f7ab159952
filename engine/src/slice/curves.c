/* Slices by heights at the vertices: from a field, or any. */
#include "slice/curves.h"

#include "base/vector.h"
#include "slice/orbits.h"
#include "slice/search.h"

void iso_curves_free(iso_curves *curves) {
    iso_release(curves->level_first);
    iso_release(curves->contour_first);
    iso_release(curves->point);
    *curves = (iso_curves){0};
}

typedef struct slicer {
    const curves_mesh *mesh;
    const double *level;
    int32_t *lb;    /* [vertex] */
    int32_t *order; /* [crossing] darts as the contours run */
    iso_vec3 *point;
} slicer;

static void find_levels(slicer *s, int32_t count) {
    double scale = levels_scale(s->level, count);
    for (int32_t v = 0; v < s->mesh->vertex_count; v++)
        s->lb[v] = levels_first_at(s->level, count, scale, s->mesh->height[v]);
}

/* As planar slices are walked (planar.c), but that heights need no second look. */
static int64_t walk(void *payload, orbits *o, int32_t start, int32_t level, int64_t at) {
    const slicer *s = payload;
    const int32_t *origin = s->mesh->origin, *opposite = s->mesh->opposite;
    int32_t a = start;
    do {
        orbits_pass(o, a);
        s->order[at++] = a;
        int32_t c = iso_mesh_alpha(opposite[a]), further = iso_mesh_alpha(c);
        a = s->lb[origin[further]] > level ? c : further;
    } while (a != start);
    return at;
}

/* ---- points ---- */

static void place_linear(const slicer *s, const orbits *o) {
    const curves_mesh *m = s->mesh;
    for (int32_t level = 0; level < o->level_count; level++) {
        double r = s->level[level];
        for (int64_t i = o->first[level]; i < o->first[level + 1]; i++) {
            int32_t p = m->origin[s->order[i]], q = m->origin[iso_mesh_alpha(s->order[i])];
            double t = (r - m->height[p]) / (m->height[q] - m->height[p]);
            s->point[i] = vec3_between(m->position[p], m->position[q], t);
        }
    }
}

static root_edge edge_of(const curves_mesh *m, int32_t dart, double level) {
    int32_t p = m->origin[dart], q = m->origin[iso_mesh_alpha(dart)];
    iso_vec3 along = vec3_minus(m->position[q], m->position[p]);
    return (root_edge){{m->position[p], m->position[q]},
                       {m->height[p], m->height[q]},
                       {vec3_dot(m->gradient[p], along), vec3_dot(m->gradient[q], along)},
                       level};
}

static void place_roots(const slicer *s, const orbits *o) {
    root_edge edge[ROOTS_BLOCK];
    int32_t count = 0;
    int64_t done = 0;
    for (int32_t level = 0; level < o->level_count; level++)
        for (int64_t i = o->first[level]; i < o->first[level + 1]; i++) {
            edge[count++] = edge_of(s->mesh, s->order[i], s->level[level]);
            if (count == ROOTS_BLOCK || i + 1 == o->crossing_count) {
                roots_find(s->point + done, s->mesh->field, edge, count);
                done += count;
                count = 0;
            }
        }
}

/* ---- all of it ---- */

static iso_status slice(slicer *s, orbits *o) {
    ISO_TRY(ISO_ALLOCATE(s->lb, s->mesh->vertex_count));
    if (o->level_count > 0)
        find_levels(s, o->level_count);
    o->lb = s->lb;
    ISO_TRY(orbits_prepare(o));
    ISO_TRY(orbits_prepare_walk(o));
    ISO_TRY(ISO_ALLOCATE(s->order, o->crossing_count));
    for (int32_t i = 0; i < o->level_count; i++)
        ISO_TRY(orbits_walk_level(o, i, walk, s));
    ISO_TRY(ISO_ALLOCATE(s->point, o->crossing_count));
    if (s->mesh->field)
        place_roots(s, o);
    else
        place_linear(s, o);
    return ISO_OK;
}

iso_status curves_slice(iso_curves *curves, const curves_mesh *mesh, const double *level,
                        int32_t level_count) {
    slicer s = {.mesh = mesh, .level = level};
    orbits o = {
        .triangle_count = mesh->triangle_count, .level_count = level_count, .origin = mesh->origin};
    iso_status status = slice(&s, &o);
    iso_release(s.lb);
    iso_release(s.order);
    orbits_release(&o);
    iso_curves out = {.level_count = o.level_count,
                      .contour_count = o.contour_count,
                      .crossing_count = o.crossing_count,
                      .level_first = o.level_first,
                      .contour_first = o.contour_first,
                      .point = s.point};
    *curves = (iso_curves){0};
    if (status == ISO_OK)
        *curves = out;
    else
        iso_curves_free(&out);
    return status;
}

iso_status curves_check_levels(const double *level, int32_t count) {
    if (count < 0)
        return iso_fail(ISO_USAGE, "%d levels", count);
    for (int32_t i = 0; i < count; i++) {
        if (level[i] - level[i] != 0)
            return iso_fail(ISO_USAGE, "level %d is not finite", i);
        if (i > 0 && level[i] <= level[i - 1])
            return iso_fail(ISO_USAGE, "level %d (%g) is not above the one before (%g)", i,
                            level[i], level[i - 1]);
    }
    return ISO_OK;
}

iso_status iso_slice_heights(iso_curves *curves, const iso_mesh *mesh, const double *height,
                             const double *level, int32_t level_count) {
    *curves = (iso_curves){0};
    ISO_TRY(curves_check_levels(level, level_count));
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        if (height[v] - height[v] != 0)
            return iso_fail(ISO_UNSLICEABLE, "the height of vertex %d is not finite", v);
    curves_mesh view = {.triangle_count = mesh->triangle_count,
                        .vertex_count = mesh->vertex_count,
                        .origin = mesh->origin,
                        .opposite = mesh->opposite,
                        .position = mesh->position,
                        .height = height};
    return curves_slice(curves, &view, level, level_count);
}
