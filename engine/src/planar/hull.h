/* Convex polygons in units: counter-clockwise, no three corners on a line, the lowest of the
 * leftmost corners first. */
#ifndef ISO_PLANAR_HULL_H
#define ISO_PLANAR_HULL_H

#include <isoslice/planar.h>

#include "base/memory.h"

/* Sorts `point`; `out` holds count + 1. Returns how many corners the hull has: fewer than three if
 * all points are on a line. */
int32_t hull_of(iso_point *out, iso_point *point, int32_t count);

/* All differences of a point of a and a point of b, both with three corners at least; `out` holds
 * a_count + b_count. Returns how many corners there are. */
int32_t hull_difference(iso_point *out, const iso_point *a, int32_t a_count, const iso_point *b,
                        int32_t b_count);

/* Drop corners, outwards: what is left holds the hull and reaches beyond it by `tolerance` units at
 * most, less a unit of rounding. Returns how many corners there are. `point` holds count + 1,
 * `room` count. */
int32_t hull_thin(iso_point *point, int32_t count, int32_t tolerance, iso_point *room);

/* Twice the area. */
int64_t hull_double_area(const iso_point *point, int32_t count);

/* The smallest distance between two hulls in mm, 0 if they meet. */
double hull_distance(const iso_point *a, int32_t a_count, const iso_point *b, int32_t b_count);

#endif
