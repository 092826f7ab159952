/* Copies of one outline in even rows. */
#ifndef ISO_OBJECT_LATTICE_H
#define ISO_OBJECT_LATTICE_H

#include <isoslice/planar.h>

#include "base/memory.h"

typedef struct iso_lattice_space {
    const iso_point *apart; /* two copies may not differ by what is inside this hull; it is its own
                               mirror image about (0, 0), but for rounding */
    int32_t corners;
    const iso_region *inside; /* where copies may be */
    iso_point target;
} iso_lattice_space;

/* Find up to `most` places on a lattice, the ones nearest to the target where there are more. */
iso_status lattice_places(iso_point *place, int32_t *count, int32_t most,
                          const iso_lattice_space *space) ISO_MUST_CHECK;

#endif
