/* How wide pores and walls are: by spheres that fit into them (Hildebrand and Ruegsegger 1997). */
#ifndef ISO_LATTICE_SIZES_H
#define ISO_LATTICE_SIZES_H

#include "lattice/analysis.h"

typedef struct iso_sizes {
    double detail; /* mm between points; 0: nothing was found */
    double pore_largest, pore_mean, pore_d10, pore_d50, pore_d90;
    double wall_smallest, wall_mean;
    double surface;  /* mm^2 of pores in a mm^3 of the part */
    double material; /* its share there */
} iso_sizes;

enum { SIZES_CUBES_MOST = 8 };

/* Looks into so many cubes of the body at most, of two and a half cells each, one in each eighth of
 * its box: a lattice repeats, and its sizes change slowly. body->voxel doesn't
 * matter.
 */
iso_status body_sizes(iso_sizes *sizes, const iso_body *body, double cell, int32_t cubes,
                      iso_pool *pool) ISO_MUST_CHECK;

#endif
