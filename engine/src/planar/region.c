#include "planar/region.h"

#include "planar/predicate.h"

void iso_region_free(iso_region *region) {
    iso_release(region->first);
    iso_release(region->point);
    iso_release(region->parent);
    *region = (iso_region){0};
}

void iso_region_clear(iso_region *region) {
    region->count = 0;
}

bool region_same(const iso_region *a, const iso_region *b) {
    if (a->count != b->count || a->count == 0)
        return a->count == b->count;
    return memcmp(a->first, b->first, (size_t)(a->count + 1) * sizeof *a->first) == 0 &&
           memcmp(a->point, b->point, (size_t)a->first[a->count] * sizeof *a->point) == 0;
}

/* first and parent share a capacity, counted in contours. */
iso_status region_reserve(iso_region *region, int64_t contours, int64_t points) {
    if (points > INT32_MAX || contours > INT32_MAX - 1)
        return iso_fail(ISO_OUTSIDE, "%lld points are more than a region can hold",
                        (long long)points);
    int64_t capacity = region->contour_capacity, parents = capacity;
    if (contours >= capacity) {
        ISO_TRY(ISO_GROW(region->first, capacity, contours + 1));
        ISO_TRY(ISO_GROW(region->parent, parents, contours + 1));
        region->contour_capacity = capacity;
    }
    ISO_TRY(ISO_GROW(region->point, region->point_capacity, points));
    if (region->count == 0)
        region->first[0] = 0;
    return ISO_OK;
}

iso_status iso_region_add(iso_region *region, const iso_point *point, int32_t count) {
    int64_t used = region->count ? region->first[region->count] : 0;
    ISO_TRY(region_reserve(region, (int64_t)region->count + 1, used + count));
    if (count > 0)
        memcpy(region->point + used, point, (size_t)count * sizeof *point);
    region->parent[region->count++] = -1;
    region->first[region->count] = (int32_t)(used + count);
    return ISO_OK;
}

/* Relative to the first point: terms fit in 2^51, 2^12 of them and more in an int64. */
int64_t contour_double_area(const iso_point *point, int32_t count) {
    int64_t sum = 0;
    for (int32_t i = 1; i + 1 < count; i++)
        sum += orient2d(point[0], point[i], point[i + 1]);
    return sum;
}

int64_t iso_region_double_area(const iso_region *region) {
    int64_t sum = 0;
    for (int32_t c = 0; c < region->count; c++)
        sum += contour_double_area(region->point + region->first[c],
                                   region->first[c + 1] - region->first[c]);
    return sum;
}

/* Winding by crossings of the ray to the right of the point; on the boundary the answer is 0 at
 * once. */
int iso_region_locate(const iso_region *region, iso_point point) {
    int winding = 0;
    for (int32_t c = 0; c < region->count; c++) {
        int32_t first = region->first[c], end = region->first[c + 1];
        if (first == end)
            continue;
        iso_point a = region->point[end - 1];
        for (int32_t i = first; i < end; i++) {
            iso_point b = region->point[i];
            if ((a.y <= point.y) != (b.y <= point.y)) {
                int64_t side = orient2d(a, b, point);
                if (side == 0)
                    return 0;
                if ((side > 0) == (b.y > a.y))
                    winding += b.y > a.y ? 1 : -1;
            } else if (box_holds(a, b, point) && orient2d(a, b, point) == 0) {
                return 0;
            }
            a = b;
        }
    }
    return winding != 0 ? 1 : -1;
}
