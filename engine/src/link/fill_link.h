/* The contour-filling multi-link (paper, 4.2): involutions r, s, g on E with projections q, p.
 *
 * Sweep lines cut the contours of a region in crossings, numbered line by line and along each line.
 * E is the set of darts: crossing c seen from below (d = 2c) or above (d = 2c + 1) its line. Then
 *     F(d) = d ^ 2    the other end of the line's piece inside the region
 *     S(d) = d ^ 1    the other side of the line
 *     B(d) = arc[d]   the other end of the boundary's arc that leaves c on this side
 * are the involutions {r, s} = {F, S} and g = B, with q the line and p the contour of a crossing.
 * F and S are arithmetic, so F^2 = S^2 = 1, FS = SF and qS = q need no storage and no check. */
#ifndef ISO_LINK_FILL_LINK_H
#define ISO_LINK_FILL_LINK_H

#include <stdint.h>

#include <isoslice/status.h>

#include "base/memory.h"

typedef struct iso_fill_link {
    int32_t count;         /* crossings, even; 2 count darts, count / 2 segments */
    int32_t line_count;    /* q < line_count */
    int32_t contour_count; /* p < contour_count */
    int32_t *arc;          /* B [2 count] */
    int32_t *line;         /* q [count], not decreasing */
    int32_t *contour;      /* p [count] */
} iso_fill_link;

static inline int32_t iso_fill_link_across(int32_t dart) { /* F */
    return dart ^ 2;
}

static inline int32_t iso_fill_link_other_side(int32_t dart) { /* S */
    return dart ^ 1;
}

/* z = SBF: draw the segment, follow the boundary, be ready to leave the next line on its far side.
 * A bijection; left alone it draws zigzags. */
static inline int32_t iso_fill_link_zigzag(const iso_fill_link *link, int32_t dart) {
    return iso_fill_link_other_side(link->arc[iso_fill_link_across(dart)]);
}

/* Between which lines the dart looks: strip i lies below line i. qB = q fails by design, the strip
 * is what F and B keep. */
static inline int32_t iso_fill_link_strip(const iso_fill_link *link, int32_t dart) {
    return link->line[dart >> 1] + (dart & 1);
}

/* ISO_BUG with the name of the broken equation and the first index where it fails. */
iso_status iso_fill_link_validate(const iso_fill_link *link) ISO_MUST_CHECK;

typedef struct iso_fill_census {
    int32_t segments, cells, parts, contours; /* contours that a line meets */
    int32_t regular, extrema, saddles;        /* cells of 4, 2, and 6 or more darts */
} iso_fill_census;

/* Orbits of <F, B> are cells of the strips, orbits of <F, S, B> connected parts of the region. Of a
 * plane region, cells - segments = sum over parts (1 - holes) = 2 parts - contours. */
iso_status iso_fill_link_count(iso_fill_census *census, const iso_fill_link *link,
                               iso_arena *scratch) ISO_MUST_CHECK;

static inline int iso_fill_census_is_plane(const iso_fill_census *census) {
    return census->cells - census->segments == 2 * census->parts - census->contours;
}

#endif
