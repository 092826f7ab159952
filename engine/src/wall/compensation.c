#include "wall/compensation.h"

#include "planar/region.h"

static void swap(iso_region *a, iso_region *b) {
    iso_region t = *a;
    *a = *b;
    *b = t;
}

static iso_status move_all(iso_region *region, iso_region *spare, int32_t distance,
                           iso_planar_scratch *scratch) {
    iso_offset_options offset = iso_offset_defaults(distance);
    ISO_TRY(iso_offset(spare, region, &offset, scratch));
    swap(region, spare);
    return ISO_OK;
}

/* The holes as areas of their own, whatever stands in them. */
static iso_status gather_holes(iso_region *out, const iso_region *region) {
    iso_region_clear(out);
    for (int32_t c = 0; c < region->count; c++) {
        int32_t from = region->first[c], count = region->first[c + 1] - from;
        if (contour_double_area(region->point + from, count) > 0)
            continue;
        ISO_TRY(iso_region_add(out, region->point + from, count));
        iso_point *point = out->point + out->first[out->count - 1];
        for (int32_t i = 0, j = count - 1; i < j; i++, j--) {
            iso_point p = point[i];
            point[i] = point[j];
            point[j] = p;
        }
    }
    return ISO_OK;
}

/* A ring along each hole is taken away, or filled in; an island in the hole stays. */
static iso_status move_holes(iso_region *region, iso_region *const spare[2], int32_t distance,
                             iso_planar_scratch *scratch) {
    iso_region *hole = spare[0], *moved = spare[1];
    iso_offset_options offset = iso_offset_defaults(distance);
    iso_region ring = {0};
    ISO_TRY(gather_holes(hole, region));
    if (hole->count == 0)
        return ISO_OK;
    ISO_TRY(iso_offset(moved, hole, &offset, scratch));
    iso_status status = iso_boolean(&ring, ISO_EXCLUSIVE, hole, moved, scratch);
    if (status == ISO_OK)
        status =
            iso_boolean(moved, distance > 0 ? ISO_DIFFERENCE : ISO_UNION, region, &ring, scratch);
    iso_region_free(&ring);
    ISO_TRY(status);
    swap(region, moved);
    return ISO_OK;
}

/* What is left of places that a bead still fits into; narrower ones stay as they are. */
static iso_status shrink_foot(iso_region *region, iso_region *const spare[2],
                              const iso_compensation *c, iso_planar_scratch *scratch) {
    iso_offset_options inner = iso_offset_defaults(-(c->foot + c->narrowest / 2));
    iso_offset_options back = iso_offset_defaults(c->foot + c->narrowest / 2);
    iso_offset_options shrink = iso_offset_defaults(-c->foot);
    iso_region narrow = {0};
    back.mitre_limit = 3;
    iso_status status = iso_offset(spare[0], region, &inner, scratch);
    if (status == ISO_OK)
        status = iso_offset(spare[1], spare[0], &back, scratch);
    if (status == ISO_OK)
        status = iso_boolean(&narrow, ISO_DIFFERENCE, region, spare[1], scratch);
    if (status == ISO_OK)
        status = iso_offset(spare[0], region, &shrink, scratch);
    if (status == ISO_OK)
        status = iso_boolean(spare[1], ISO_UNION, spare[0], &narrow, scratch);
    iso_region_free(&narrow);
    ISO_TRY(status);
    swap(region, spare[1]);
    return ISO_OK;
}

iso_status compensate(iso_region *region, iso_region *const spare[2], const iso_compensation *c,
                      iso_planar_scratch *scratch) {
    if (c->all != 0 && region->count > 0)
        ISO_TRY(move_all(region, spare[0], c->all, scratch));
    if (c->holes != 0 && region->count > 0)
        ISO_TRY(move_holes(region, spare, c->holes, scratch));
    if (c->foot > 0 && region->count > 0)
        ISO_TRY(shrink_foot(region, spare, c, scratch));
    return ISO_OK;
}
