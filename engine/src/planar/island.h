/* Islands: an outer contour and the holes in it. */
#ifndef ISO_PLANAR_ISLAND_H
#define ISO_PLANAR_ISLAND_H

#include <isoslice/planar.h>

#include "base/memory.h"

typedef struct iso_islands {
    int32_t count;
    int32_t *first;   /* [count + 1] */
    int32_t *contour; /* contours of each island, the outer one first */
} iso_islands;

/* The islands of a region, in the order of their outer contours; in the arena. */
iso_status islands_of(iso_islands *islands, const iso_region *region,
                      iso_arena *arena) ISO_MUST_CHECK;

/* Make `out` the island alone, a region of its own. */
iso_status island_copy(iso_region *out, const iso_region *region, const iso_islands *islands,
                       int32_t island) ISO_MUST_CHECK;

#endif
