/* A drawing board of square pixels: what lies in a region, and how often beads cover it. Nothing of
 * the engine in it but its types. */
#ifndef TESTS_FILL_RASTER_H
#define TESTS_FILL_RASTER_H

#include <isoslice/path.h>
#include <isoslice/planar.h>

typedef struct raster {
    int width, height;
    double x, y, pixel;     /* of the lower left corner; size. Units */
    unsigned char *wanted;  /* in the region */
    unsigned char *covered; /* by a bead as wide as it says, with round ends */
    unsigned char *times; /* by how many pieces of beads as wide as area / height, cut off square */
} raster;

void raster_new(raster *r, const iso_region *region, double pixel);
void raster_draw(raster *r, const iso_paths *paths, double height);
void raster_free(raster *r);

/* Parts of the region's area: what no bead covers; what is drawn once too often or outside. */
double raster_under(const raster *r);
double raster_over(const raster *r);

#endif
