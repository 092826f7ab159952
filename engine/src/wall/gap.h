/* Inside of gap fill for the wall module. */
#ifndef ISO_WALL_GAP_H
#define ISO_WALL_GAP_H

#include <isoslice/wall.h>

/* Leave out contours that no circle of that width fits into: corners' tips, most of all. What is
 * left has no parents and may hold holes of contours that are gone. */
void gap_drop_small(iso_region *region, double width);

#endif
