#include <isoslice/skirt.h>

#include "base/memory.h"

/* The outlines that no other one is around. */
static iso_status filled(iso_region *out, const iso_region *region) {
    iso_region_clear(out);
    for (int32_t c = 0; c < region->count; c++)
        if (region->parent[c] < 0)
            ISO_TRY(iso_region_add(out, region->point + region->first[c],
                                   region->first[c + 1] - region->first[c]));
    return ISO_OK;
}

typedef struct brim {
    const iso_region *region;
    iso_region whole; /* its outermost outlines, filled */
    iso_region grown;
} brim;

/* Loops that come out of a hole of the whole region lie within its outermost outlines. */
static bool is_inner(const brim *b, int32_t contour) {
    return iso_region_locate(&b->whole, b->grown.point[b->grown.first[contour]]) > 0;
}

/* The innermost outline of the region that the loop lies within: a hole's loops are printed
 * together.
 */
static int32_t outline_around(const brim *b, int32_t contour) {
    const iso_region *region = b->region;
    iso_point at = b->grown.point[b->grown.first[contour]];
    for (int32_t c = region->count; c-- > 0;) {
        int32_t first[2] = {0, region->first[c + 1] - region->first[c]};
        iso_region one = {.count = 1, .first = first, .point = region->point + region->first[c]};
        if (iso_region_locate(&one, at) > 0)
            return c;
    }
    return -1;
}

static iso_status draw(iso_paths *paths, brim *b, const iso_brim_options *options,
                       iso_planar_scratch *scratch) {
    iso_path like = {
        .role = ISO_ROLE_SKIRT, .closed = 1, .object = -1, .group = -1, .rank = options->rank};
    ISO_TRY(filled(&b->whole, b->region));
    for (int32_t i = options->loops; i-- > 0; like.rank++) {
        iso_offset_options grown =
            iso_offset_defaults(options->distance + i * options->bead.spacing);
        grown.join = ISO_JOIN_ROUND;
        ISO_TRY(iso_offset(&b->grown, options->inner ? b->region : &b->whole, &grown, scratch));
        for (int32_t c = 0; c < b->grown.count; c++) {
            bool inner = is_inner(b, c);
            like.group = inner ? -2 - outline_around(b, c) : -1;
            if (inner ? options->inner : options->outer)
                ISO_TRY(iso_paths_add(paths, &like, b->grown.point + b->grown.first[c],
                                      b->grown.first[c + 1] - b->grown.first[c],
                                      options->bead.width, options->bead.area));
        }
    }
    return ISO_OK;
}

iso_status iso_brim(iso_paths *paths, const iso_region *region, const iso_brim_options *options,
                    iso_planar_scratch *scratch) {
    brim b = {.region = region};
    int32_t count = paths->count, vertices = paths->vertex_count;
    iso_status status = draw(paths, &b, options, scratch);
    if (status != ISO_OK) {
        paths->count = count;
        paths->vertex_count = vertices;
    }
    iso_region_free(&b.whole);
    iso_region_free(&b.grown);
    return status;
}
