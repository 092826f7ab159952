/* Families of parallel lines at angles to each other, woven into one link: so that no two families
 * draw the same piece of boundary. */
#include <math.h>

#include "fill/hatch.h"
#include "fill/pattern.h"
#include "fill/weave.h"

enum { FAMILIES_MAX = 3 };

typedef struct family {
    double turn;  /* degrees against options->angle */
    double shift; /* units to the left */
} family;

/* A cube on its corner: its three families of planes stand at 120 degrees around the vertical, and
 * a horizontal cut moves across each by z / sqrt 2. With all lines in the directions 0, 60 and 120
 * degrees one of them goes the other way. */
static int find_families(family *families, const iso_fill_options *options) {
    double wide = FAMILIES_MAX * options->spacing, rise = options->z * sqrt(0.5);
    if (options->pattern == ISO_PATTERN_GRID) {
        families[0] = (family){0, 0};
        families[1] = (family){90, 0};
        return 2;
    }
    for (int f = 0; f < FAMILIES_MAX; f++)
        families[f] = (family){60 * f, 0};
    if (options->pattern == ISO_PATTERN_STARS)
        families[2].shift = wide / 2;
    if (options->pattern == ISO_PATTERN_CUBIC)
        for (int f = 0; f < FAMILIES_MAX; f++)
            families[f].shift = fmod(f == 1 ? -rise : rise, wide);
    return FAMILIES_MAX;
}

static void find_extent(iso_extent *extent, const iso_region *region, const iso_sweep *sweep) {
    *extent = (iso_extent){.low = INT64_MAX, .high = INT64_MIN};
    for (int32_t i = 0; i < region->first[region->count]; i++) {
        int64_t v = iso_sweep_v(sweep, region->point[i]);
        extent->low = v < extent->low ? v : extent->low;
        extent->high = v > extent->high ? v : extent->high;
    }
}

/* The lines of a family as a hatch of the whole region. */
static iso_status hatch_family(iso_hatch *hatch, const iso_fill_part *whole, const family *of,
                               const iso_fill_options *options, iso_arena *scratch) {
    enum { FRACTION = 256 }; /* as of iso_fill_rectilinear */
    int64_t scale = ISO_SWEEP_ONE / FRACTION;
    iso_sweep sweep = iso_sweep_of(options->angle + of->turn);
    iso_extent extent;
    iso_cut *room;
    find_extent(&extent, whole->region, &sweep);
    int64_t spacing = (int64_t)(options->spacing * FRACTION + 0.5) * scale;
    int64_t shift = (int64_t)floor(of->shift * FRACTION + 0.5) * scale;
    if (fmod(options->angle + of->turn, 360) >= 180) /* the sweep goes the other way */
        shift = -shift;
    iso_sweep_repeat(&sweep, spacing, iso_sweep_v(&sweep, options->origin) + shift, &extent);
    ISO_TRY(ISO_PUSH(room, scratch, whole->region->first[whole->region->count]));
    return iso_hatch_build(hatch, whole, &sweep, room, scratch);
}

static iso_status weave_families(iso_weave *weave, const iso_hatch *hatch, int count,
                                 const iso_region *region, iso_arena *scratch) {
    int64_t total = 0;
    for (int f = 0; f < count; f++)
        total += hatch[f].link.count;
    if (total > INT32_MAX / 4)
        return iso_fail(ISO_USAGE,
                        "fill: lines cross the contours %lld times, too often: use a "
                        "lower density",
                        (long long)total);
    *weave = (iso_weave){.region = region};
    ISO_TRY(ISO_PUSH(weave->crossing, scratch, total));
    for (int f = 0; f < count; f++) {
        memcpy(weave->crossing + weave->count, hatch[f].crossing,
               (size_t)hatch[f].link.count * sizeof *weave->crossing);
        weave->count += hatch[f].link.count;
    }
    return iso_weave_link(weave, scratch);
}

iso_status iso_pattern_lines(iso_paths *out, const iso_region *region,
                             const iso_fill_options *options, iso_arena *scratch) {
    family families[FAMILIES_MAX];
    iso_hatch hatch[FAMILIES_MAX];
    iso_weave weave;
    int32_t *member;
    int count = find_families(families, options);
    iso_fill_options wide = *options;
    wide.spacing *= count;
    ISO_TRY(ISO_PUSH(member, scratch, region->count));
    for (int32_t i = 0; i < region->count; i++)
        member[i] = i;
    iso_fill_part whole = {region, member, region->count};
    for (int f = 0; f < count; f++)
        ISO_TRY(hatch_family(&hatch[f], &whole, &families[f], &wide, scratch));
    ISO_TRY(weave_families(&weave, hatch, count, region, scratch));
#ifndef NDEBUG
    ISO_TRY(iso_weave_validate(&weave));
#endif
    return iso_weave_draw(out, &weave, options, scratch);
}
