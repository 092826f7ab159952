/* A grid over a region: which of its squares lie inside, which the boundary passes. */
#ifndef ISO_LATTICE_RASTER_H
#define ISO_LATTICE_RASTER_H

#include <isoslice/planar.h>

#include "base/memory.h"

enum { RASTER_OUTSIDE, RASTER_INSIDE, RASTER_BOUNDARY };

typedef struct raster {
    double x, y, step;     /* units: of node (0, 0), and between nodes */
    int32_t columns, rows; /* of nodes */
    uint8_t *square;       /* [(columns - 1) (rows - 1)] */
} raster;

/* Over the region's box and two squares more, node (0, 0) on a multiple of the step from `origin`
 * (units). Squares that come within `reach` units of the boundary count as on it. */
iso_status raster_make(raster *out, const iso_region *region, const double origin[2], double step,
                       double reach, iso_arena *scratch) ISO_MUST_CHECK;

/* Is a node the corner of a square that isn't outside? */
static inline int raster_meets(const raster *r, int32_t i, int32_t j) {
    int32_t squares = r->columns - 1;
    if (i <= 0 || j <= 0 || i >= r->columns - 1 || j >= r->rows - 1)
        return 0;
    const uint8_t *at = r->square + (int64_t)j * squares + i;
    return at[0] | at[-1] | at[-squares] | at[-squares - 1];
}

#endif
