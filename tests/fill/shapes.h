/* Regions for the tests of fill, with sizes that are known. */
#ifndef TESTS_FILL_SHAPES_H
#define TESTS_FILL_SHAPES_H

#include <isoslice/planar.h>

typedef struct shape {
    const char *name;
    void (*make)(iso_region *region, double degrees); /* turned about the origin */
} shape;

extern const shape shapes[];
extern const int shape_count;

/* Append a contour of units; `parent` as in iso_region. Regions of the tests end in drop_region. */
void add_points(iso_region *region, const iso_point *point, int count, int parent);
void drop_region(iso_region *region);
double region_area(const iso_region *region); /* units^2 */

/* Append a contour in mm, turned. */
void add_contour(iso_region *region, const double (*point)[2], int count, double degrees,
                 int parent);
void add_circle(iso_region *region, double x, double y, double radius, int corners, double degrees,
                int parent);

/* A disc of 200 mm with 50 holes in it. */
void make_disc(iso_region *region);

#endif
