#include "planar/edges.h"

#include "planar/predicate.h"

void edges_free(iso_edges *edges) {
    iso_release(edges->from);
    iso_release(edges->to);
    iso_release(edges->successor);
    iso_release(edges->flags);
    *edges = (iso_edges){0};
}

/* All four arrays share one capacity: it is set when the last of them has grown. */
static iso_status edges_reserve(iso_edges *edges, int64_t needed) {
    if (needed <= edges->capacity)
        return ISO_OK;
    if (needed > INT32_MAX / 4)
        return iso_fail(ISO_OUTSIDE, "%lld edges are more than one arrangement can hold",
                        (long long)needed);
    int64_t from = edges->capacity, to = from, successor = from, flags = from;
    ISO_TRY(ISO_GROW(edges->from, from, needed));
    ISO_TRY(ISO_GROW(edges->to, to, needed));
    ISO_TRY(ISO_GROW(edges->successor, successor, needed));
    ISO_TRY(ISO_GROW(edges->flags, flags, needed));
    edges->capacity = from;
    return ISO_OK;
}

iso_status edges_push(iso_edges *edges, iso_point from, iso_point to, uint8_t flags) {
    ISO_TRY(edges_reserve(edges, (int64_t)edges->count + 1));
    int32_t slot = edges->count++;
    edges->from[slot] = from;
    edges->to[slot] = to;
    edges->flags[slot] = flags;
    return ISO_OK;
}

static iso_status out_of_range(int32_t contour, int32_t at, iso_point p, int32_t limit) {
    return iso_fail(ISO_OUTSIDE, "contour %d, point %d (%.4f, %.4f mm) is beyond +-%.1f mm",
                    (int)contour, (int)at, iso_mm(p.x), iso_mm(p.y), iso_mm(limit));
}

static iso_status add_within(iso_edges *edges, const iso_region *region, int operand,
                             int32_t limit) {
    int32_t points = region->count ? region->first[region->count] : 0;
    ISO_TRY(edges_reserve(edges, (int64_t)edges->count + points));
    for (int32_t c = 0; c < region->count; c++) {
        int32_t first = region->first[c], end = region->first[c + 1];
        if (first == end)
            continue;
        int32_t start = edges->count, slot = start;
        iso_point last = region->point[end - 1];
        for (int32_t i = first; i < end; i++) {
            iso_point p = region->point[i];
            if (p.x < -limit || p.x > limit || p.y < -limit || p.y > limit)
                return out_of_range(c, i - first, p, limit);
            if (point_equal(p, last))
                continue;
            edges->from[slot] = last;
            edges->to[slot] = p;
            edges->flags[slot] = (uint8_t)(operand << EDGE_OPERAND_SHIFT);
            edges->successor[slot] = slot + 1;
            slot++;
            last = p;
        }
        if (slot > start)
            edges->successor[slot - 1] = start;
        edges->count = slot;
    }
    return ISO_OK;
}

iso_status edges_add(iso_edges *edges, const iso_region *region, int operand) {
    return add_within(edges, region, operand, ISO_COORDINATE_MAX);
}

iso_status edges_add_raw(iso_edges *edges, const iso_region *raw) {
    return add_within(edges, raw, 0, 2 * ISO_COORDINATE_MAX);
}
