/* Sets of a curved layer's paths that have to be printed one after the other, so that the tool does
 * not touch islands that stand higher than the one it is at. */
#ifndef ISO_REACHABLE_H
#define ISO_REACHABLE_H

#include "clearance/clearance.h"
#include "curved.h"

typedef struct iso_sets {
    int32_t count;
    iso_paths *set; /* [count] in their order; of vertices that they share */
} iso_sets;

/* One set for each island (group), if any is to come before another; else a single one. The paths
 * are unordered, in the chart of a level whose top is at `r`; all is allocated from the arena. */
iso_status reachable_sets(iso_sets *sets, const iso_paths *paths, const iso_curved *curved,
                          double r, const clearance_tool *tool, iso_arena *arena) ISO_MUST_CHECK;

#endif
