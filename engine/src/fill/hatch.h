/* A hatch: the lines of a sweep cut by the contours of one part of a region, as a contour-filling
 * multi-link (link/fill_link.h) with its geometry. */
#ifndef ISO_FILL_HATCH_H
#define ISO_FILL_HATCH_H

#include <math.h>

#include <isoslice/planar.h>

#include "base/memory.h"
#include "fill/crossing.h"
#include "fill/sweep.h"
#include "link/fill_link.h"

/* One outer contour and the holes directly in it. */
typedef struct iso_fill_part {
    const iso_region *region;
    const int32_t *member; /* [count] contours, the outer one first */
    int32_t count;
} iso_fill_part;

typedef struct iso_hatch {
    iso_fill_link link; /* p = index into part.member */
    iso_crossing *crossing;
    iso_fill_part part;
} iso_hatch;

static inline double iso_hatch_distance(iso_point a, iso_point b) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
    return sqrt(dx * dx + dy * dy);
}

/* Of the part's outer contour. An end counts as flat if an edge longer than `flat` units lies
 * along it; 0 doesn't look. */
void iso_hatch_extent(iso_extent *extent, const iso_fill_part *part, const iso_sweep *sweep,
                      double flat);

/* An edge that crosses lines: its points, and how many lines lie below each. */
typedef struct iso_cut {
    int32_t from, to, level_from, level_to;
} iso_cut;

/* `room` is for as many cuts as the part has points. What the hatch holds is pushed to `scratch`
 * and lives until the caller pops it. */
iso_status iso_hatch_build(iso_hatch *hatch, const iso_fill_part *part, const iso_sweep *sweep,
                           iso_cut *room, iso_arena *scratch) ISO_MUST_CHECK;

/* The points of the boundary's arc from `dart` to its other end, both ends left out, to `point`
 * (room for the part's points). Returns how many, or -1 if the arc is longer than `longest`. */
int32_t iso_hatch_follow(iso_point *point, const iso_hatch *hatch, int32_t dart, double longest);

/* Follow the arc from `dart` for `length` units, or to its end if that is nearer: the points passed
 * and the one reached, to `point` (room for the part's points and one more). Returns how many.
 * `length` becomes what was followed. */
int32_t iso_hatch_follow_for(iso_point *point, const iso_hatch *hatch, int32_t dart,
                             double *length);

#endif
