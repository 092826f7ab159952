/* The true distance along a shape's side from its lower edge, by a front that marches over a fine
 * grid of triangles (Kimmel and Sethian 1998): nothing of the engine's is in it. */
#ifndef TESTS_CHANNEL_FRONT_H
#define TESTS_CHANNEL_FRONT_H

#include "shapes.h"

/* way[i + sides j] at shape_point(s, i, j), to be freed. */
double *march(const shape *s);

/* At a point of the side, between the grid's. */
double way_at(const shape *s, const double *way, iso_vec3 p);

#endif
