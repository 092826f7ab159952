/* The triangle that is nearest to a point. */
#ifndef ISO_SOLID_CLOSEST_H
#define ISO_SOLID_CLOSEST_H

#include <isoslice/geometry.h>
#include <isoslice/status.h>

typedef struct iso_closest iso_closest;

/* corner[3 count], numbers all; copied. */
iso_status closest_new(iso_closest **tree, const iso_vec3 *corner, int64_t count) ISO_MUST_CHECK;
void closest_free(iso_closest *tree);

/* Square of the distance from p to the nearest triangle, or `most` where that is less. *guess, from
 * the last call or 0, is tried first, and is then the nearest triangle if one was nearer than
 * `most`: points that are asked about one beside the other cost little. Exact but for rounding;
 * triangles may be as thin as they like. */
double closest_square(const iso_closest *tree, iso_vec3 p, double most, int32_t *guess);

/* The triangle's number, counted as they were given, that a guess, or one that closest_gather
 * found, stands for. */
int32_t closest_number(const iso_closest *tree, int32_t guess);

/* Triangles within `reach` of p: how many, or `most` + 1 where there are more than `most`. */
int closest_gather(int32_t *near, int most, const iso_closest *tree, iso_vec3 p, double reach);
/* closest_square among those. */
double closest_of_few(const iso_closest *tree, const int32_t *near, int count, iso_vec3 p,
                      double most);

#endif
