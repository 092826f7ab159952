/* Holes through the skin under a lattice, for powder or resin to run out. */
#ifndef ISO_LATTICE_DRAIN_H
#define ISO_LATTICE_DRAIN_H

#include <isoslice/planar.h>

typedef struct iso_drains {
    int32_t count;
    const double *at; /* [2 count] x, y in mm, from the middle of the part */
    double radius;    /* mm */
} iso_drains;

/* Take the holes out of a layer's outline; `spare` is room for it, two regions. */
iso_status drains_cut(iso_region *outline, iso_region *const spare[2], const iso_drains *drains,
                      iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif
