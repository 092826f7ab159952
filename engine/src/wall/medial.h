/* The middle of narrow places: a region's chordal axis (Prasad 1997) and how wide it is there.
 *
 * Its points lie on the chords of the region's triangulation, moved to where both sides are equally
 * far, by the sides themselves and not by the points they were cut into: exact between straight
 * sides. Branches into corners that stick out of the circle at their root by less than 1.5 of its
 * radius are pruned; places narrower than the least width are cut off. */
#ifndef ISO_WALL_MEDIAL_H
#define ISO_WALL_MEDIAL_H

#include <stdbool.h>

#include <isoslice/planar.h>

#include "base/memory.h"

typedef struct iso_medial_point {
    double x, y, half; /* half: distance to the nearest sides; units */
} iso_medial_point;

typedef struct iso_medial_line {
    int32_t first, count; /* points */
    bool closed;
    bool blunt[2]; /* the place ends there rather than gets too narrow, first and last */
} iso_medial_line;

/* In the scratch's arena. */
typedef struct iso_medial {
    int32_t count, point_count;
    iso_medial_line *line;
    iso_medial_point *point;
} iso_medial;

/* `step` units at most between points that sides are cut into; `least` the half width from which on
 * a place counts. */
iso_status medial_axis(iso_medial *out, const iso_region *region, int32_t step, double least,
                       iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif
