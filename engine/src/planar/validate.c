#include <isoslice/planar.h>

#include "base/sort.h"
#include "planar/predicate.h"
#include "planar/region.h"
#include "planar/trace.h"

static iso_status check_points(const iso_region *region) {
    for (int32_t c = 0; c < region->count; c++) {
        int32_t first = region->first[c], end = region->first[c + 1];
        if (end - first < 3)
            return iso_fail(ISO_BUG, "region: contour %d has %d points", (int)c,
                            (int)(end - first));
        for (int32_t i = first; i < end; i++)
            if (point_equal(region->point[i], region->point[i == first ? end - 1 : i - 1]))
                return iso_fail(ISO_BUG, "region: contour %d repeats point %d", (int)c,
                                (int)(i - first));
    }
    return ISO_OK;
}

static int32_t contour_of(const iso_region *region, int32_t point) {
    int32_t c = 0;
    while (region->first[c + 1] <= point)
        c++;
    return c;
}

/* Without repeated points slot i is the edge that ends in point i. */
static iso_status check_edges(const iso_region *region, const iso_edges *edges) {
    int32_t count = region->first[region->count];
    for (int32_t i = 0; i < count; i++)
        if (edges->flags[i] & EDGE_DEAD) {
            int32_t c = contour_of(region, i);
            return iso_fail(ISO_BUG,
                            "region: contour %d is crossed or touched within the edge that "
                            "ends in point %d",
                            (int)c, (int)(i - region->first[c]));
        }
    return ISO_OK;
}

static iso_status check_windings(const iso_arrangement *a) {
    for (int32_t c = 0; c < a->chain_count; c++) {
        iso_point p = a->point[a->chain_first[c]];
        if (a->multiplicity[c].of[0] != 1 && a->multiplicity[c].of[0] != -1)
            return iso_fail(ISO_BUG, "region: contours overlap along an edge at (%d, %d)", (int)p.x,
                            (int)p.y);
        for (int side = 0; side < 2; side++) {
            int32_t w = a->winding[a->face[2 * c + side]].of[0];
            if (w != 0 && w != 1)
                return iso_fail(ISO_BUG,
                                "region: winding %d beside the contour through (%d, %d): wrong way "
                                "round, or nested wrongly",
                                (int)w, (int)p.x, (int)p.y);
        }
    }
    return ISO_OK;
}

/* A contour by its least point and the one after it. */
typedef struct iso_contour_key {
    iso_point least, after;
    int32_t contour;
} iso_contour_key;

static bool key_less(const iso_contour_key *a, const iso_contour_key *b) {
    if (!point_equal(a->least, b->least))
        return point_less(a->least, b->least);
    return point_equal(a->after, b->after) ? a->contour < b->contour
                                           : point_less(a->after, b->after);
}
ISO_SORT(sort_keys, iso_contour_key, key_less)

static iso_status sorted_keys(iso_contour_key **key, const iso_region *region, iso_arena *arena) {
    ISO_TRY(ISO_PUSH(*key, arena, region->count));
    for (int32_t c = 0; c < region->count; c++) {
        const iso_point *p = region->point + region->first[c];
        int32_t n = region->first[c + 1] - region->first[c], least = 0;
        for (int32_t i = 1; i < n; i++)
            if (point_less(p[i], p[least]))
                least = i;
        (*key)[c] = (iso_contour_key){p[least], p[(least + 1) % n], c};
    }
    sort_keys(*key, region->count);
    return ISO_OK;
}

/* The contours, and who lies in whom, must be those that the arrangement shows. */
static iso_status check_nesting(const iso_region *region, const iso_region *traced,
                                iso_arena *arena) {
    iso_contour_key *is, *ought;
    int32_t *twin; /* of a traced contour in the region */
    if (region->count != traced->count)
        return iso_fail(ISO_BUG, "region: %d contours where there ought to be %d",
                        (int)region->count, (int)traced->count);
    ISO_TRY(sorted_keys(&is, region, arena));
    ISO_TRY(sorted_keys(&ought, traced, arena));
    ISO_TRY(ISO_PUSH(twin, arena, region->count));
    for (int32_t k = 0; k < region->count; k++) {
        int32_t c = is[k].contour, t = ought[k].contour;
        if (!point_equal(is[k].least, ought[k].least) ||
            !point_equal(is[k].after, ought[k].after) ||
            region->first[c + 1] - region->first[c] != traced->first[t + 1] - traced->first[t])
            return iso_fail(ISO_BUG, "region: contour %d is not simple", (int)c);
        twin[t] = c;
    }
    for (int32_t t = 0; t < traced->count; t++) {
        int32_t c = twin[t], parent = traced->parent[t] < 0 ? -1 : twin[traced->parent[t]];
        if (region->parent[c] != parent || parent >= c)
            return iso_fail(ISO_BUG, "region: contour %d names %d as its parent; it is %d", (int)c,
                            (int)region->parent[c], (int)parent);
    }
    return ISO_OK;
}

static bool is_inside(const iso_winding *w, const void *context) {
    return w->of[0] > 0;
}

static iso_status validate(const iso_region *region, iso_region *traced,
                           iso_planar_scratch *scratch) {
    iso_arrangement arrangement;
    int64_t collisions;
    scratch->edges.count = 0;
    ISO_TRY(check_points(region));
    ISO_TRY(edges_add(&scratch->edges, region, 0));
    ISO_TRY(arrange(&arrangement, &scratch->edges, &collisions, &scratch->room, &scratch->arena));
    ISO_TRY(check_edges(region, &scratch->edges));
    ISO_TRY(arrangement_validate(&arrangement));
    ISO_TRY(check_windings(&arrangement));
    iso_choice choice = {traced, is_inside, NULL};
    ISO_TRY(trace_region(&choice, &arrangement, &scratch->arena));
    return check_nesting(region, traced, &scratch->arena);
}

iso_status iso_region_validate(const iso_region *region, iso_planar_scratch *scratch) {
    if (region->count == 0)
        return ISO_OK;
    iso_arena_mark mark = iso_arena_get_mark(&scratch->arena);
    iso_region traced = {0};
    iso_status status = validate(region, &traced, scratch);
    iso_region_free(&traced);
    iso_arena_pop(&scratch->arena, mark);
    scratch->edges.count = 0;
    return status;
}
