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

/* Answers which island holds a point, in about the time that it takes to look at the few whose
 * boxes do. */
typedef struct iso_island_search {
    const iso_region *region;
    const iso_islands *islands;
    struct iso_island_box *box; /* [islands->count] from left to right */
} iso_island_search;

iso_status island_search_new(iso_island_search *search, const iso_region *region,
                             const iso_islands *islands, iso_arena *arena) ISO_MUST_CHECK;

/* The island that holds the point; -1 if none does. The caller knows that one holds it or all but
 * does, so that the only island whose box holds it is not looked at further. */
int32_t island_at(const iso_island_search *search, iso_point point);

#endif
