/* Exact answers about raw integer contours, the slow and obvious way. Nothing here calls the
 * kernel: the tests measure it against this. */
#ifndef TESTS_PLANAR_ORACLE_H
#define TESTS_PLANAR_ORACLE_H

#include <isoslice/planar.h>

__extension__ typedef __int128 wide;

static inline int sign_of(int64_t value) {
    return (value > 0) - (value < 0);
}

/* Twice the signed area of a, b, c; exact for |x|, |y| < 2^29. */
static inline int64_t turn(iso_point a, iso_point b, iso_point c) {
    return ((int64_t)b.x - a.x) * ((int64_t)c.y - a.y) -
           ((int64_t)b.y - a.y) * ((int64_t)c.x - a.x);
}

static inline int same_point(iso_point a, iso_point b) {
    return a.x == b.x && a.y == b.y;
}

/* Edge k of contour i runs from corner(…, k) to corner(…, k + 1). */
static inline int32_t corners(const iso_region *region, int32_t contour) {
    return region->first[contour + 1] - region->first[contour];
}

static inline iso_point corner(const iso_region *region, int32_t contour, int32_t k) {
    int32_t n = corners(region, contour);
    return region->point[region->first[contour] + (k + n) % n];
}

static inline int32_t point_count(const iso_region *region) {
    return region->count ? region->first[region->count] : 0;
}

/* Winding number of the contours around p. *on_edge, if asked for, says that p lies on an edge;
 * the winding number is then that of a point just beside p. */
int oracle_winding(const iso_region *contours, iso_point p, int *on_edge);

/* Is some edge within `radius` of p? Exact; radius < 2^26. */
int oracle_near(const iso_region *contours, iso_point p, int64_t radius);

int oracle_filled(iso_fill_rule rule, int winding);
int oracle_boolean(iso_boolean_kind kind, int in_a, int in_b);

long double oracle_perimeter(const iso_region *contours);

/* Area of the points that `inside` accepts, by cutting the plane into slabs between all vertices
 * and crossings: cubic, for at most some hundred edges. b may be NULL. */
typedef int oracle_inside(const void *context, int winding_a, int winding_b);
long double oracle_area(const iso_region *a, const iso_region *b, oracle_inside *inside,
                        const void *context);

/* NULL, or what is wrong with the region: crossing, overlap, orientation, nesting, range. All
 * pairs of edges are looked at. */
const char *oracle_region_fault(const iso_region *region);

/* Equal as sets of closed contours, wherever they start and in whatever order? */
int oracle_same(const iso_region *a, const iso_region *b);

/* Where the offset of the region must and must not be, leaving `slack` = 2 units at its boundary:
 * the region, one rectangle an edge and one join an opening corner, united (grow), or the same of
 * its complement (shrink). 1 must be inside, -1 must be outside, 0 either. */
int oracle_offset(const iso_region *region, const iso_offset_options *options, iso_point p);

#endif
