/* All levels at once, no search and no hash (paper, 5).
 *
 * lb(v) is the first level at or above vertex v; a dart crosses the levels lb(org) .. lb(dst) - 1
 * upwards. A difference array counts the crossings of every level, a second pass over the darts
 * deals them out to their levels in the order of the darts, and each level's orbits are walked from
 * there: the successor of a dart is one of two darts of the neighbouring triangle. O(n + K + M) for
 * n darts, K levels and M crossings. */
#include <isoslice/slice.h>

#include "base/memory.h"
#include "slice/search.h"

typedef struct slicer {
    const iso_mesh *mesh;
    const iso_levels *levels;
    int32_t *lb;      /* [vertex] first level at or above it */
    int64_t *first;   /* [level + 1] crossings of each level */
    int32_t *dart;    /* [crossing] level by level, ascending within one */
    uint64_t *passed; /* a bit a dart: walked already, on the level at hand */
    iso_slices out;
    int64_t contour_capacity;
} slicer;

static void find_levels(slicer *s) {
    double scale = levels_scale(s->levels);
    for (int32_t v = 0; v < s->mesh->vertex_count; v++)
        s->lb[v] = levels_first_at(s->levels, scale, s->mesh->position[v].z);
}

static void count_crossings(slicer *s) {
    const int32_t *origin = s->mesh->origin;
    int64_t *change = s->first + 1; /* change[i]: darts that begin to cross at level i, less ends */
    for (int32_t t = 0; t < s->mesh->triangle_count; t++) {
        int32_t l[4];
        for (int k = 0; k < 3; k++)
            l[k] = s->lb[origin[3 * t + k]];
        l[3] = l[0];
        if (l[0] == l[1] && l[1] == l[2])
            continue;
        for (int k = 0; k < 3; k++)
            if (l[k] < l[k + 1])
                change[l[k]]++, change[l[k + 1]]--;
    }
    for (int32_t i = 1; i < s->levels->count; i++)
        change[i] += change[i - 1];
    for (int32_t i = 1; i < s->levels->count; i++)
        change[i] += change[i - 1];
}

/* first[i] moves through its level and ends as the start of the next; shifting it back restores it.
 */
static void deal_darts(slicer *s) {
    const int32_t *origin = s->mesh->origin;
    for (int32_t t = 0; t < s->mesh->triangle_count; t++) {
        int32_t l[4];
        for (int k = 0; k < 3; k++)
            l[k] = s->lb[origin[3 * t + k]];
        l[3] = l[0];
        if (l[0] == l[1] && l[1] == l[2])
            continue;
        for (int k = 0; k < 3; k++)
            for (int32_t i = l[k]; i < l[k + 1]; i++)
                s->dart[s->first[i]++] = 3 * t + k;
    }
    for (int32_t i = s->levels->count; i > 0; i--)
        s->first[i] = s->first[i - 1];
    s->first[0] = 0;
}

/* The point comes from the upward dart, low end to high, and no other dart computes it again. */
static inline iso_vec2 crossing(const iso_vec3 *low, const iso_vec3 *high, double z) {
    double t = (z - low->z) / (high->z - low->z);
    return (iso_vec2){low->x + t * (high->x - low->x), low->y + t * (high->y - low->y)};
}

/* Walk the orbit of `start` on the level z. In the neighbour the level enters through the downward
 * opposite of the dart at hand and leaves through the next dart or the one after. */
static int64_t walk(slicer *s, int32_t start, double z, int64_t at) {
    const int32_t *origin = s->mesh->origin, *opposite = s->mesh->opposite;
    const iso_vec3 *position = s->mesh->position;
    const iso_vec3 *low = &position[origin[start]];
    const iso_vec3 *high = &position[origin[iso_mesh_alpha(start)]];
    int32_t a = start;
    do {
        s->passed[a >> 6] |= 1ull << (a & 63);
        s->out.point[at++] = crossing(low, high, z);
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

static iso_status walk_level(slicer *s, int32_t level) {
    int64_t begin = s->first[level], end = s->first[level + 1], at = begin;
    double z = s->levels->cut[level];
    for (int64_t q = begin; q < end && at < end; q++) {
        int32_t a = s->dart[q];
        if (s->passed[a >> 6] >> (a & 63) & 1)
            continue;
        at = walk(s, a, z, at);
        if (s->out.contour_count == INT32_MAX - 1)
            return iso_fail(ISO_UNSLICEABLE, "more than %d contours", INT32_MAX - 1);
        ISO_TRY(ISO_GROW(s->out.contour_first, s->contour_capacity, s->out.contour_count + 2));
        s->out.contour_first[++s->out.contour_count] = at;
    }
    for (int64_t q = begin; q < end; q++)
        s->passed[s->dart[q] >> 6] = 0;
    return ISO_OK;
}

static iso_status slice(slicer *s) {
    int32_t levels = s->levels->count;
    ISO_TRY(ISO_ALLOCATE(s->out.level_first, levels + 1));
    ISO_TRY(ISO_GROW(s->out.contour_first, s->contour_capacity, 1));
    ISO_TRY(ISO_ALLOCATE(s->first, (int64_t)levels + 2));
    ISO_TRY(ISO_ALLOCATE(s->lb, s->mesh->vertex_count));
    memset(s->first, 0, ((size_t)levels + 2) * sizeof *s->first);
    s->out.level_first[0] = 0;
    s->out.contour_first[0] = 0;
    s->out.level_count = levels;
    if (levels > 0) {
        find_levels(s);
        count_crossings(s);
    }
    s->out.crossing_count = s->first[levels];
    ISO_TRY(ISO_ALLOCATE(s->dart, s->out.crossing_count));
    if (levels > 0)
        deal_darts(s);
    iso_release(s->lb);
    s->lb = NULL;
    int64_t words = (3 * (int64_t)s->mesh->triangle_count + 63) / 64;
    ISO_TRY(ISO_ALLOCATE(s->passed, words));
    memset(s->passed, 0, (size_t)words * sizeof *s->passed);
    ISO_TRY(ISO_ALLOCATE(s->out.point, s->out.crossing_count));
    for (int32_t i = 0; i < levels; i++) {
        ISO_TRY(walk_level(s, i));
        s->out.level_first[i + 1] = s->out.contour_count;
    }
    return ISO_OK;
}

iso_status iso_slice_planar(iso_slices *slices, const iso_mesh *mesh, const iso_levels *levels) {
    slicer s = {.mesh = mesh, .levels = levels};
    *slices = (iso_slices){0};
    iso_status status = slice(&s);
    iso_release(s.lb);
    iso_release(s.first);
    iso_release(s.dart);
    iso_release(s.passed);
    if (status == ISO_OK)
        *slices = s.out;
    else
        iso_slices_free(&s.out);
    return status;
}
