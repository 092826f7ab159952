/* A weave: pieces of any curves within a region, as a contour-filling multi-link.
 *
 * A chain is a piece of a curve from where it enters the region to where it leaves it. Chain k has
 * the crossings 2k, where it enters, and 2k + 1; darts, F and S are those of link/fill_link.h with
 * the left side of the chain as the odd one. B joins neighbours along each contour, whichever curve
 * they belong to. So r^2 = s^2 = g^2 = 1, rs = sr and pg = p hold as for a hatch; only that g keeps
 * to a strip does not, since chains may cross each other.
 *
 * An end inside the region is loose: it stands for a contour of its own with B(2c) = 2c + 1. */
#ifndef ISO_FILL_WEAVE_H
#define ISO_FILL_WEAVE_H

#include "base/memory.h"
#include "fill/crossing.h"

typedef struct iso_weave_bead { /* of the piece of a chain that ends in a point */
    int32_t width, area;
} iso_weave_bead;

typedef struct iso_weave {
    const iso_region *region;
    int32_t count;          /* crossings, even */
    iso_crossing *crossing; /* .edge = 2 i + leaves, i = -1 for a loose end */
    int32_t *arc;           /* B [2 count] */
    int32_t *contour;       /* p [count]; region->count + c for a loose end */
    int32_t *inner_first;   /* [count / 2 + 1]; NULL: all chains are straight */
    iso_point *inner;       /* of chain k those from inner_first[k] on, in its direction */
    iso_weave_bead *bead;   /* of pieces that end in crossings [count], then inner points; NULL: all
                             * are as the options say */
} iso_weave;

/* Find B and p of crossings in any order. What the weave holds is pushed to `scratch`. */
iso_status iso_weave_link(iso_weave *weave, iso_arena *scratch) ISO_MUST_CHECK;

/* ISO_BUG with the name of the broken equation and the first index where it fails. */
iso_status iso_weave_validate(const iso_weave *weave) ISO_MUST_CHECK;

/* Append all chains, each once, joined by arcs no longer than options->link_max. Other ends run on
 * along an arc for options->anchor at most, but into nothing that is drawn there. */
iso_status iso_weave_draw(iso_paths *out, const iso_weave *weave, const iso_fill_options *options,
                          iso_arena *scratch) ISO_MUST_CHECK;

#endif
