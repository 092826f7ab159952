#include <isoslice/fill.h>

int iso_fill_pattern_is_solid(iso_fill_pattern pattern) {
    switch (pattern) {
    case ISO_PATTERN_RECTILINEAR:
    case ISO_PATTERN_ALIGNED:
    case ISO_PATTERN_MONOTONIC:
    case ISO_PATTERN_CONCENTRIC:
    case ISO_PATTERN_HILBERT:
    case ISO_PATTERN_ARCHIMEDEAN:
    case ISO_PATTERN_OCTAGRAM:
        return 1;
    default:
        return 0;
    }
}

double iso_fill_pattern_turn(iso_fill_pattern pattern, int32_t index) {
    switch (pattern) {
    case ISO_PATTERN_RECTILINEAR:
    case ISO_PATTERN_MONOTONIC:
    case ISO_PATTERN_LINE:
        return 90 * (index & 1);
    case ISO_PATTERN_HONEYCOMB: /* the same cells, but other walls of theirs are doubled */
        return 60 * (index % 3);
    default:
        return 0;
    }
}

iso_status iso_fill(iso_paths *out, const iso_region *region, const iso_fill_options *options,
                    struct iso_arena *scratch, iso_planar_scratch *planar) {
    (void)planar;
    return iso_fill_rectilinear(out, region, options, scratch);
}
