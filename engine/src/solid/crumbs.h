/* Where what triangles enclose is finer than the grid it is made anew on, no surface on that grid
 * can run where it should; but it can enclose as much. */
#ifndef ISO_SOLID_CRUMBS_H
#define ISO_SOLID_CRUMBS_H

#include <isoslice/geometry.h>

#include "solid/soup.h"
#include "solid/volume.h"

typedef struct crumbs_options {
    iso_vec3 min, max; /* of the triangles */
    double voxel;
} crumbs_options;

/* The value at which the surface of `made` is to be taken. It is 0, or, where the triangles hardly
 * fit together, that surface's mean chord is less than 16 voxels, and it encloses clearly more or
 * less than what winds by half or more: the one at which it encloses as much. */
iso_status crumbs_level(double *level, const iso_volume *made, const iso_soup *soup,
                        const crumbs_options *options) ISO_MUST_CHECK;

#endif
