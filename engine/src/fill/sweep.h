/* The sweep: a direction as a pair of integers, and the lines that run that way.
 *
 * v(p) = 2 (p.y cosine - p.x sine) is exact for every iso_point: with |x|, |y| <= 2^24 and cosines
 * in 2^-30 it stays below 2^56. So the map into the sweep's frame is linear without any rounding, a
 * clean region stays clean, and since v is even and the level of each line odd, no vertex is ever
 * on a line. */
#ifndef ISO_FILL_SWEEP_H
#define ISO_FILL_SWEEP_H

#include <isoslice/fill.h>
#include <isoslice/geometry.h>

#define ISO_SWEEP_ONE ((int64_t)1 << 31) /* one unit of length in v */

typedef struct iso_sweep {
    int64_t cosine, sine; /* in 2^-30; sine >= 0 */
    int32_t along_x;      /* along a line, along_x x + along_y y grows; one of both is 0 */
    int32_t along_y;
    int64_t first, step; /* v of line 0, odd; between lines, even */
    int32_t count;       /* lines */
} iso_sweep;

/* The direction; no lines yet. Multiples of 45 degrees are exact. */
iso_sweep iso_sweep_of(double degrees);

static inline int64_t iso_sweep_v(const iso_sweep *sweep, iso_point p) {
    return 2 * (p.y * sweep->cosine - p.x * sweep->sine);
}

/* How far a part reaches in v, low < high, and whether an edge along the lines ends it there. */
typedef struct iso_extent {
    int64_t low, high;
    int low_flat, high_flat;
} iso_extent;

/* Lines every `spacing` from `phase` on, those within the extent. */
void iso_sweep_repeat(iso_sweep *sweep, int64_t spacing, int64_t phase, const iso_extent *extent);

/* Lines about `spacing` apart, spread evenly over the extent, half a gap from its ends. Flat ones
 * count as `margin` further out, so that nothing is left beside a line there; a line at a round end
 * or a corner would have next to no length. None lies outside the extent. */
void iso_sweep_fit(iso_sweep *sweep, int64_t spacing, int64_t margin, const iso_extent *extent);

/* One or the other, as the options have it. Returns the distance between fitted lines as a part of
 * the spacing asked for, which is their share of a line's usual volume; else 1. */
double iso_sweep_place(iso_sweep *sweep, const iso_fill_options *options, const iso_extent *extent);

#endif
