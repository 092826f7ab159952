/* Slices by planes. Heights are the vertices' z, which the walk reads from the places that it
 * needs anyway (orbits.c has the rest). */
#include <isoslice/slice.h>

#include "base/memory.h"
#include "slice/orbits.h"
#include "slice/search.h"

typedef struct slicer {
    const iso_mesh *mesh;
    const iso_levels *levels;
    int32_t *lb;
    iso_vec2 *point;
} slicer;

static void find_levels(slicer *s) {
    double scale = levels_scale(s->levels->cut, s->levels->count);
    for (int32_t v = 0; v < s->mesh->vertex_count; v++)
        s->lb[v] = levels_first_at(s->levels->cut, s->levels->count, scale, s->mesh->position[v].z);
}

/* The point comes from the upward dart, low end to high, and no other dart computes it again. */
static inline iso_vec2 crossing(const iso_vec3 *low, const iso_vec3 *high, double z) {
    double t = (z - low->z) / (high->z - low->z);
    return (iso_vec2){low->x + t * (high->x - low->x), low->y + t * (high->y - low->y)};
}

/* In the neighbour the level enters through the downward opposite of the dart at hand and leaves
 * through the next dart or the one after. */
static int64_t walk(void *payload, orbits *o, int32_t start, int32_t level, int64_t at) {
    const slicer *s = payload;
    const int32_t *origin = s->mesh->origin, *opposite = s->mesh->opposite;
    const iso_vec3 *position = s->mesh->position;
    const iso_vec3 *low = &position[origin[start]];
    const iso_vec3 *high = &position[origin[iso_mesh_alpha(start)]];
    double z = s->levels->cut[level];
    int32_t a = start;
    do {
        orbits_pass(o, a);
        s->point[at++] = crossing(low, high, z);
        int32_t c = iso_mesh_alpha(opposite[a]), further = iso_mesh_alpha(c);
        const iso_vec3 *apex = &position[origin[further]];
        if (apex->z > z) {
            a = c;
            high = apex;
        } else {
            a = further;
            low = apex;
        }
    } while (a != start);
    return at;
}

static iso_status slice(slicer *s, orbits *o) {
    ISO_TRY(ISO_ALLOCATE(s->lb, s->mesh->vertex_count));
    if (o->level_count > 0)
        find_levels(s);
    o->lb = s->lb;
    ISO_TRY(orbits_prepare(o));
    iso_release(s->lb);
    s->lb = NULL;
    ISO_TRY(orbits_prepare_walk(o));
    ISO_TRY(ISO_ALLOCATE(s->point, o->crossing_count));
    for (int32_t i = 0; i < o->level_count; i++)
        ISO_TRY(orbits_walk_level(o, i, walk, s));
    return ISO_OK;
}

iso_status iso_slice_planar(iso_slices *slices, const iso_mesh *mesh, const iso_levels *levels) {
    slicer s = {.mesh = mesh, .levels = levels};
    orbits o = {.triangle_count = mesh->triangle_count,
                .level_count = levels->count,
                .origin = mesh->origin};
    *slices = (iso_slices){0};
    iso_status status = slice(&s, &o);
    iso_release(s.lb);
    orbits_release(&o);
    iso_slices out = {.level_count = o.level_count,
                      .contour_count = o.contour_count,
                      .crossing_count = o.crossing_count,
                      .level_first = o.level_first,
                      .contour_first = o.contour_first,
                      .point = s.point};
    if (status == ISO_OK)
        *slices = out;
    else
        iso_slices_free(&out);
    return status;
}
