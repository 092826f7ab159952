#include <isoslice/fill.h>

#include "fill/hatch.h"
#include "fill/zigzag.h"
#include "planar/predicate.h"

#ifndef NDEBUG
static iso_status check_hatch(const iso_hatch *hatch, iso_arena *scratch) {
    ISO_TRY(iso_fill_link_validate(&hatch->link));
    iso_fill_census census;
    ISO_TRY(iso_fill_link_count(&census, &hatch->link, scratch));
    if (!iso_fill_census_is_plane(&census))
        return iso_fail(ISO_BUG,
                        "fill: contour %d and its holes are no region: %d cells, %d "
                        "segments, %d parts, %d contours",
                        hatch->part.member[0], census.cells, census.segments, census.parts,
                        census.contours);
    return ISO_OK;
}
#endif

static int is_counter_clockwise(const iso_fill_part *part) {
    const iso_point *point = part->region->point;
    int32_t from = part->region->first[part->member[0]];
    int32_t to = part->region->first[part->member[0] + 1];
    int64_t twice = 0; /* no contour within the range of coordinates is larger than 2^53 */
    for (int32_t i = from + 1; i + 1 < to; i++)
        twice += orient2d(point[from], point[i], point[i + 1]);
    return twice >= 0;
}

static iso_status fill_part(iso_paths *out, const iso_fill_part *part, iso_sweep sweep,
                            const iso_fill_options *options, iso_cut *room, iso_arena *scratch) {
    iso_extent extent;
    iso_hatch_extent(&extent, part, &sweep, options->fit ? options->spacing : 0);
    if (extent.low >= extent.high)
        return ISO_OK;
    double share = iso_sweep_place(&sweep, options, &extent);
    if (sweep.count <= 0)
        return ISO_OK;
    iso_hatch hatch;
    ISO_TRY(iso_hatch_build(&hatch, part, &sweep, room, scratch));
    if (hatch.link.count && (hatch.crossing[0].edge & 1) && !is_counter_clockwise(part))
        return iso_fail(ISO_USAGE,
                        "fill: contour %d runs clockwise but lies in no other; clean the region "
                        "first",
                        part->member[0]);
#ifndef NDEBUG
    ISO_TRY(check_hatch(&hatch, scratch));
#endif
    double widened = options->width + (share - 1) * options->spacing;
    iso_flanks flanks = {.hatch = &hatch,
                         .sweep = &sweep,
                         .usual = {.width = (int32_t)(widened + 0.5),
                                   .area = (int32_t)(options->area * share + 0.5),
                                   .spacing = (int32_t)(options->spacing * share + 0.5)},
                         .nominal = options->width,
                         .margin = options->margin > 0 ? options->margin : 0};
    if (options->fit && !options->even)
        ISO_TRY(iso_flanks_find(&flanks, scratch));
    return iso_zigzag_draw(out, &hatch, &flanks, options, scratch);
}

/* part[i] = the outer contour whose part contour i belongs to. */
static void find_parts(int32_t *part, const iso_region *region) {
    for (int32_t i = 0; i < region->count; i++) {
        int32_t parent = region->parent[i];
        part[i] = parent >= 0 && part[parent] == parent ? parent : i;
    }
}

/* Contours sorted by part, each part's outer one first: parents come before their children. */
static void sort_members(int32_t *member, int32_t *first, const int32_t *part, int32_t count) {
    memset(first, 0, ((size_t)count + 1) * sizeof *first);
    for (int32_t i = 0; i < count; i++)
        first[part[i]]++;
    for (int32_t i = 0, sum = 0; i <= count; i++) {
        int32_t size = first[i];
        first[i] = sum;
        sum += size;
    }
    for (int32_t i = 0; i < count; i++)
        member[first[part[i]]++] = i;
    for (int32_t i = count; i > 0; i--)
        first[i] = first[i - 1];
    first[0] = 0;
}

static iso_status fill_region(iso_paths *out, const iso_region *region,
                              const iso_fill_options *options, iso_arena *scratch) {
    int32_t *outer, *member, *first, count = region->count;
    iso_cut *room;
    ISO_TRY(ISO_PUSH(outer, scratch, count));
    ISO_TRY(ISO_PUSH(member, scratch, count));
    ISO_TRY(ISO_PUSH(first, scratch, (int64_t)count + 1));
    ISO_TRY(ISO_PUSH(room, scratch, region->first[count]));
    find_parts(outer, region);
    sort_members(member, first, outer, count);
    iso_sweep sweep = iso_sweep_of(options->angle);
    iso_fill_options ranked = *options;
    for (int32_t i = 0; i < count; i++) {
        iso_fill_part part = {region, member + first[i], first[i + 1] - first[i]};
        if (part.count == 0)
            continue;
        iso_arena_mark mark = iso_arena_get_mark(scratch);
        int32_t before = out->count;
        ISO_TRY(fill_part(out, &part, sweep, &ranked, room, scratch));
        if (options->monotonic)
            ranked.like.rank += out->count - before;
        iso_arena_pop(scratch, mark);
    }
    return ISO_OK;
}

iso_status iso_fill_rectilinear(iso_paths *out, const iso_region *region,
                                const iso_fill_options *options, iso_arena *scratch) {
    ISO_TRY(iso_fill_options_validate(options));
    if (region->count == 0)
        return ISO_OK;
    iso_arena own = {0};
    scratch = scratch ? scratch : &own;
    int32_t count = out->count, vertex_count = out->vertex_count;
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    iso_status status = fill_region(out, region, options, scratch);
    iso_arena_pop(scratch, mark);
    iso_arena_free(&own);
    if (status != ISO_OK) {
        out->count = count;
        out->vertex_count = vertex_count;
    }
    return status;
}
