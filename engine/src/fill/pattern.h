/* Inside of iso_fill: what draws each kind of pattern. */
#ifndef ISO_FILL_PATTERN_H
#define ISO_FILL_PATTERN_H

#include <isoslice/fill.h>

#include "base/memory.h"
#include "fill/clip.h"

/* The bead's own spacing. */
static inline double iso_pattern_bead(const iso_fill_options *options) {
    return options->spacing * options->density;
}

/* Degrees between options->angle and the frame that a pattern of curves is drawn in. */
double iso_pattern_frame(iso_fill_pattern pattern);

/* Families of straight lines that cross each other: grid, triangles, stars, cubic. */
iso_status iso_pattern_lines(iso_paths *out, const iso_region *region,
                             const iso_fill_options *options, iso_arena *scratch) ISO_MUST_CHECK;

/* Successive insets of the region, closed, ranked from the outside in. */
iso_status iso_pattern_concentric(iso_paths *out, const iso_region *region,
                                  const iso_fill_options *options,
                                  iso_planar_scratch *planar) ISO_MUST_CHECK;

/* Curves over the box of the clip's region and some more. */
void iso_pattern_line(iso_clip *clip, const iso_fill_options *options);
void iso_pattern_honeycomb(iso_clip *clip, const iso_fill_options *options);
void iso_pattern_honeycomb_3d(iso_clip *clip, const iso_fill_options *options);
void iso_pattern_gyroid(iso_clip *clip, const iso_fill_options *options);
void iso_pattern_hilbert(iso_clip *clip, const iso_fill_options *options);
void iso_pattern_archimedean(iso_clip *clip, const iso_fill_options *options);
void iso_pattern_octagram(iso_clip *clip, const iso_fill_options *options);

#endif
