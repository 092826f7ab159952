/* A fill's structure as a multi-link of the library's own kind, to be looked at or kept. */
#include <isoslice/fill.h>

#include "fill/hatch.h"

static iso_status hatch_all(iso_hatch *hatch, const iso_region *region,
                            const iso_fill_options *options, iso_arena *scratch) {
    int32_t *member;
    iso_cut *room;
    ISO_TRY(ISO_PUSH(member, scratch, region->count));
    ISO_TRY(ISO_PUSH(room, scratch, region->count ? region->first[region->count] : 0));
    iso_sweep sweep = iso_sweep_of(options->angle);
    iso_extent whole_extent = {.low = INT64_MAX, .high = INT64_MIN}, extent;
    for (int32_t i = 0; i < region->count; i++) {
        member[i] = i;
        iso_hatch_extent(&extent, &(iso_fill_part){region, member + i, 1}, &sweep,
                         options->spacing);
        if (extent.low < whole_extent.low) {
            whole_extent.low = extent.low;
            whole_extent.low_flat = extent.low_flat;
        }
        if (extent.high > whole_extent.high) {
            whole_extent.high = extent.high;
            whole_extent.high_flat = extent.high_flat;
        }
    }
    if (whole_extent.low < whole_extent.high)
        (void)iso_sweep_place(&sweep, options, &whole_extent);
    else
        sweep.step = 2; /* no lines */
    iso_fill_part whole = {region, member, region->count};
    return iso_hatch_build(hatch, &whole, &sweep, room, scratch);
}

iso_status iso_fill_to_link(iso_filling_link *out, const iso_region *region,
                            const iso_fill_options *options, iso_arena *scratch) {
    *out = (iso_filling_link){0};
    ISO_TRY(iso_fill_options_validate(options));
    iso_arena own = {0};
    scratch = scratch ? scratch : &own;
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    iso_hatch hatch;
    iso_status status = hatch_all(&hatch, region, options, scratch);
    if (status == ISO_OK)
        status = iso_filling_link_new(out, hatch.link.count, hatch.link.arc, hatch.link.line,
                                      hatch.link.contour);
    iso_arena_pop(scratch, mark);
    iso_arena_free(&own);
    return status;
}
