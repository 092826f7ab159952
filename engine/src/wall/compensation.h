/* Compensation: outlines moved against what a printer does to them. */
#ifndef ISO_WALL_COMPENSATION_H
#define ISO_WALL_COMPENSATION_H

#include <stdbool.h>

#include <isoslice/planar.h>

typedef struct iso_compensation {
    int32_t all;       /* units outwards; inwards if negative */
    int32_t holes;     /* units by which holes are widened besides; narrowed if negative */
    int32_t foot;      /* units inwards, but for places that would become narrower than a bead */
    int32_t narrowest; /* units: that bead */
} iso_compensation;

static inline bool compensates(const iso_compensation *c) {
    return c->all != 0 || c->holes != 0 || c->foot > 0;
}

/* Compensate `region` in place; `spare` is room for it, two regions. */
iso_status compensate(iso_region *region, iso_region *const spare[2],
                      const iso_compensation *compensation,
                      iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif
