/* Layers that merge where the field crowds them: a fan's towards its axis.
 *
 * The part is laid out in 2^k-fold steps: `count` equal steps of F, fine enough where layers are
 * thickest; where they are thin, 2 of them are printed as one layer, or 4, 8 ... up to 2^doublings.
 * Blocks of 2^k steps end at multiples of 2^k, so that at each place they follow each other without
 * gaps. A block is printed as one where its thickness is at most `thickest`, and that of the block
 * of twice its steps that it is a part of isn't: so every bead is between half of `thickest`,
 * about, and `thickest`.
 *
 *     steps   1 2 3 4 5 6 7 8
 *     thick   | | | | | | | |      every step by itself
 *             |   |   |   |        pairs
 *     thin            |            fours
 *
 * Paths are planned once a step, as if no blocks were. What a block prints is what was planned for
 * the step below its middle (spread_source), with the sections of all its steps, at its top. So at
 * step `top` (from 1) the layers printed are, for each k from 0 to spread_most(top): the paths
 * planned for step spread_source(top, k), cut to where the block is printed (spread_paths), lifted
 * with r the top of step `top` and a thickness of 2^k steps. */
#ifndef ISO_CHART_SPREAD_H
#define ISO_CHART_SPREAD_H

#include "chart/chart.h"

typedef struct spread {
    const chart *chart;
    double low, step;  /* F where the first step begins, and of each step */
    int32_t count;     /* steps: a multiple of 2^doublings */
    int32_t doublings; /* 0: every step is a layer everywhere */
    double thickest;   /* mm */
} spread;

typedef struct spread_options {
    double low, high;   /* F: of the part */
    double height;      /* mm: thickness to keep to where possible */
    double least, most; /* mm: of any bead; most is at least twice `least`, or there is no way */
} spread_options;

/* How many steps, and whether any merge: from the thickness that the field has at places of the
 * part, at[count]. No doublings, and steps of `height` as far as they fit in a whole number of
 * times, where all of the part may be printed so. ISO_OUTSIDE, naming a place: layers spread by
 * more than the limits can be kept for. */
iso_status spread_plan(spread *plan, const chart *chart, const iso_vec3 *at, int64_t count,
                       const spread_options *options) ISO_MUST_CHECK;

/* The most doublings of a block that ends with step `top`, from 1 to count. */
int32_t spread_most(const spread *plan, int32_t top);

/* The step, from 1, whose paths a block of 2^k steps prints that ends with step `top`. */
int32_t spread_source(int32_t top, int32_t k);

/* Of the paths of step spread_source(top, k) those pieces, cut exactly, where the block that ends
 * with step `top` is printed as one, with sections 2^k times as large. Closed paths that are cut
 * become open ones. For paths that aren't ordered yet. Replaces what `out` held. */
iso_status spread_paths(iso_paths *out, const iso_paths *paths, const spread *plan,
                        const int32_t block[2], iso_arena *scratch) ISO_MUST_CHECK;

/* The test itself: whole[i]: is the block printed as one at flat[i]? `block` is top and k. */
iso_status spread_holds(bool *whole, const spread *plan, const int32_t block[2],
                        const iso_vec2 *flat, int64_t count, iso_arena *scratch) ISO_MUST_CHECK;

#endif
