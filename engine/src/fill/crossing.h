/* Crossings of sweep lines with contours, and their exact order along a line. */
#ifndef ISO_FILL_CROSSING_H
#define ISO_FILL_CROSSING_H

#include <isoslice/planar.h>

#include "fill/sweep.h"

typedef struct iso_crossing {
    iso_point at;  /* rounded to nearest */
    int32_t edge;  /* 2 i + up: the edge from point i of the region to the next of its contour */
    int32_t order; /* its number along the contours */
} iso_crossing;

/* Sort the crossings of one line along it. `spare` has room for as many. */
void iso_crossing_sort(iso_crossing *crossing, int32_t count, iso_crossing *spare,
                       const iso_region *region, const iso_sweep *sweep);

#endif
