/* A section: the contours of one layer, from doubles in mm to a region. */
#ifndef ISO_PLANAR_SECTION_H
#define ISO_PLANAR_SECTION_H

#include <isoslice/planar.h>
#include <isoslice/slice.h>

/* Append the contours of a level, rounded to units, to `raw`. ISO_OUTSIDE if they leave the
 * kernel's range. */
iso_status section_add(iso_region *raw, const iso_slices *slices, int32_t level) ISO_MUST_CHECK;

/* Signed area of the level's contours in mm^2, before rounding. */
double section_area(const iso_slices *slices, int32_t level);

#endif
