#include "fill/pattern.h"

#include "fill/sweep.h"

int iso_fill_pattern_is_solid(iso_fill_pattern pattern) {
    switch (pattern) {
    case ISO_PATTERN_RECTILINEAR:
    case ISO_PATTERN_ALIGNED:
    case ISO_PATTERN_MONOTONIC:
    case ISO_PATTERN_MONOTONIC_LINES:
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
    case ISO_PATTERN_MONOTONIC_LINES:
    case ISO_PATTERN_LINE:
        return 90 * (index & 1);
    case ISO_PATTERN_HONEYCOMB: /* the same cells, but other walls of theirs are drawn twice */
        return 120 * (index % 3);
    default:
        return 0;
    }
}

double iso_pattern_frame(iso_fill_pattern pattern) {
    switch (pattern) {
    case ISO_PATTERN_GYROID: /* what looks like its direction is a diagonal of its frame */
    case ISO_PATTERN_HONEYCOMB_3D:
        return -45;
    default:
        return 0;
    }
}

typedef void draw_curves(iso_clip *clip, const iso_fill_options *options);

static draw_curves *curves_of(iso_fill_pattern pattern) {
    switch (pattern) {
    case ISO_PATTERN_LINE:
        return iso_pattern_line;
    case ISO_PATTERN_HONEYCOMB:
        return iso_pattern_honeycomb;
    case ISO_PATTERN_HONEYCOMB_3D:
        return iso_pattern_honeycomb_3d;
    case ISO_PATTERN_GYROID:
        return iso_pattern_gyroid;
    case ISO_PATTERN_HILBERT:
        return iso_pattern_hilbert;
    case ISO_PATTERN_ARCHIMEDEAN:
        return iso_pattern_archimedean;
    default:
        return iso_pattern_octagram;
    }
}

/* A pattern that would have more than so many turns of a line is a mistake, not a print. */
#define TURNS_MAX 1e8

static iso_status check_size(const iso_clip *clip, const iso_fill_options *options) {
    double min[2], max[2];
    iso_clip_extent(min, max, clip);
    double turns = (max[0] - min[0]) / options->spacing * ((max[1] - min[1]) / options->spacing);
    if (turns <= TURNS_MAX)
        return ISO_OK;
    return iso_fail(ISO_USAGE, "fill: a spacing of %g mm is too fine for %g x %g mm",
                    options->spacing / ISO_UNITS_PER_MM, (max[0] - min[0]) / ISO_UNITS_PER_MM,
                    (max[1] - min[1]) / ISO_UNITS_PER_MM);
}

static iso_status fill_curves(iso_paths *out, const iso_region *region,
                              const iso_fill_options *options, iso_arena *scratch) {
    iso_clip clip;
    iso_weave weave;
    iso_fill_pattern pattern = (iso_fill_pattern)options->pattern;
    double angle = options->angle + iso_pattern_frame(pattern);
    ISO_TRY(iso_clip_begin(&clip, region, angle, options->origin, scratch));
    ISO_TRY(check_size(&clip, options));
    curves_of(pattern)(&clip, options);
    ISO_TRY(iso_clip_end(&weave, &clip));
#ifndef NDEBUG
    ISO_TRY(iso_weave_validate(&weave));
#endif
    return iso_weave_draw(out, &weave, options, scratch);
}

/* Straight lines, with line 0 through the origin. */
static iso_status fill_straight(iso_paths *out, const iso_region *region,
                                const iso_fill_options *options, iso_arena *scratch) {
    iso_fill_options placed = *options;
    iso_sweep sweep = iso_sweep_of(options->angle);
    placed.phase += (double)iso_sweep_v(&sweep, options->origin) / (double)ISO_SWEEP_ONE;
    placed.monotonic |= options->pattern == ISO_PATTERN_MONOTONIC;
    if (options->pattern == ISO_PATTERN_MONOTONIC_LINES) {
        placed.monotonic = 1;
        placed.link_max = placed.anchor = 0;
    }
    return iso_fill_rectilinear(out, region, &placed, scratch);
}

static iso_status fill_pattern(iso_paths *out, const iso_region *region,
                               const iso_fill_options *options, iso_arena *scratch,
                               iso_planar_scratch *planar) {
    iso_fill_pattern pattern = (iso_fill_pattern)options->pattern;
    if (options->density >= 1 && !iso_fill_pattern_is_solid(pattern))
        pattern = ISO_PATTERN_RECTILINEAR;
    switch (pattern) {
    case ISO_PATTERN_RECTILINEAR:
    case ISO_PATTERN_ALIGNED:
    case ISO_PATTERN_MONOTONIC:
    case ISO_PATTERN_MONOTONIC_LINES:
        return fill_straight(out, region, options, scratch);
    case ISO_PATTERN_GRID:
    case ISO_PATTERN_TRIANGLES:
    case ISO_PATTERN_STARS:
    case ISO_PATTERN_CUBIC:
        return iso_pattern_lines(out, region, options, scratch);
    case ISO_PATTERN_CONCENTRIC:
        return iso_pattern_concentric(out, region, options, planar);
    default:
        return fill_curves(out, region, options, scratch);
    }
}

/* Loops and links along the border are as wide as any bead, so those of a solid fill lie half a
 * spacing from what is around; hatches make do with less. */
static iso_status fill_solid(iso_paths *out, const iso_region *region,
                             const iso_fill_options *options, iso_arena *scratch,
                             iso_planar_scratch *planar) {
    iso_region inside = {0};
    iso_offset_options inset =
        iso_offset_defaults(options->margin - (int32_t)(options->spacing / 2 + 0.5));
    iso_status status = iso_offset(&inside, region, &inset, planar);
    if (status == ISO_OK && inside.count > 0)
        status = fill_pattern(out, &inside, options, scratch, planar);
    iso_region_free(&inside);
    return status;
}

static int has_wide_border(const iso_fill_options *options) {
    return options->density >= 1 && options->pattern >= ISO_PATTERN_CONCENTRIC &&
           options->pattern != ISO_PATTERN_MONOTONIC_LINES &&
           iso_fill_pattern_is_solid((iso_fill_pattern)options->pattern) &&
           options->margin < (int32_t)(options->spacing / 2);
}

static iso_status validate(const iso_fill_options *options) {
    ISO_TRY(iso_fill_options_validate(options));
    if (options->pattern < 0 || options->pattern >= ISO_PATTERN_COUNT)
        return iso_fail(ISO_USAGE, "fill: there is no pattern %d", options->pattern);
    if (!(options->density > 0 && options->density <= 1))
        return iso_fail(ISO_USAGE, "fill: a density of %g is out of range (above 0, to 1)",
                        options->density);
    if (options->z < 0)
        return iso_fail(ISO_USAGE, "fill: a height of %g mm is below the bed", iso_mm(options->z));
    return ISO_OK;
}

iso_status iso_fill(iso_paths *out, const iso_region *region, const iso_fill_options *options,
                    struct iso_arena *scratch, iso_planar_scratch *planar) {
    ISO_TRY(validate(options));
    if (region->count == 0 || region->first[region->count] == 0)
        return ISO_OK;
    iso_arena own = {0};
    scratch = scratch ? scratch : &own;
    iso_planar_scratch *own_planar = NULL;
    int32_t count = out->count, vertex_count = out->vertex_count;
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    iso_status status = ISO_OK;
    int wide = has_wide_border(options);
    if (!planar && (wide || options->pattern == ISO_PATTERN_CONCENTRIC))
        status = iso_planar_scratch_new(&own_planar);
    planar = planar ? planar : own_planar;
    if (status == ISO_OK)
        status = (wide ? fill_solid : fill_pattern)(out, region, options, scratch, planar);
    iso_arena_pop(scratch, mark);
    iso_arena_free(&own);
    iso_planar_scratch_free(own_planar);
    if (status != ISO_OK) {
        out->count = count;
        out->vertex_count = vertex_count;
    }
    return status;
}
