/* A quick look whether something narrow is left when a region is shrunk. */
#ifndef ISO_WALL_REACH_H
#define ISO_WALL_REACH_H

#include <stdbool.h>

#include <isoslice/planar.h>

#include "base/memory.h"

/* Sets *missed if a stretch of the region's contours lies more than about 1.4 radii from the
 * contours of `reached`, which is the region shrunk by the radius; right-angled corners don't
 * count. Stretches no longer than a radius or two may go unseen. Time goes with the contours'
 * length in radii. */
iso_status reach_misses(bool *missed, const iso_region *region, const iso_region *reached,
                        int32_t radius, double shortest, iso_arena *arena) ISO_MUST_CHECK;

#endif
