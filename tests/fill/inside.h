/* Where a point lies, by winding and distance in doubles: nothing of the engine in it. */
#ifndef TESTS_FILL_INSIDE_H
#define TESTS_FILL_INSIDE_H

#include <isoslice/planar.h>

/* In the region, or no further than `tolerance` units from its boundary. */
int is_inside(const iso_region *region, double x, double y, double tolerance);

#endif
