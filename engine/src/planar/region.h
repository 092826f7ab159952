/* Inside of iso_region for the planar module. */
#ifndef ISO_PLANAR_REGION_H
#define ISO_PLANAR_REGION_H

#include <stdbool.h>

#include <isoslice/planar.h>

#include "base/memory.h"

/* Room for this many contours and points in all; first[0] = 0 afterwards. */
iso_status region_reserve(iso_region *region, int64_t contours, int64_t points) ISO_MUST_CHECK;

/* Do both have the same contours, point by point? */
bool region_same(const iso_region *a, const iso_region *b);

/* Twice the signed area of one contour. */
int64_t contour_double_area(const iso_point *point, int32_t count);

#endif
