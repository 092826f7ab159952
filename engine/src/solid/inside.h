/* Which way round a triangle is passed by a ray along an axis, decided on integers. */
#ifndef ISO_SOLID_INSIDE_H
#define ISO_SOLID_INSIDE_H

#include <stdint.h>

/* Coordinates of one surface differ by at most this: products of two differences, and the
 * difference of two such, fit in int64. */
#define INSIDE_SPAN_MAX INT32_MAX

enum { INSIDE_DIRECTIONS = 6 }; /* +x -x +y -y +z -z */

/* What the triangle corner[9] adds to the winding number of `point` when it is seen along
 * `direction`: 1, 0 or -1. */
int inside_crossing(const int32_t corner[9], const int32_t point[3], int direction);

/* Whether the point is on the triangle, its edges and corners with it. */
int inside_touches(const int32_t corner[9], const int32_t point[3]);

#endif
