/* Bounds of a field over boxes, as the refinement of a mesh looks at them. */
#ifndef ISO_SLICE_BOUNDS_H
#define ISO_SLICE_BOUNDS_H

#include <math.h>

#include <isoslice/field.h>
#include <isoslice/mesh.h>

#include "base/memory.h"

/* Over a box the gradient is within `spread` of `middle`, by component, and the value between low
 * and high. What is unknown is a number so large that it wins and so small that sums are finite. */
typedef struct bounds {
    iso_vec3 middle, spread;
    double low, high;
} bounds;

bounds bounds_over(const iso_field *field, iso_vec3 low, iso_vec3 high);

/* How far the slope along `way` may be from that of the middle gradient. */
static inline double bounds_spread(const bounds *b, iso_vec3 way) {
    return b->spread.x * fabs(way.x) + b->spread.y * fabs(way.y) + b->spread.z * fabs(way.z);
}

/* Where faces are many and small, a bound over some of them mostly does for each. Those of cells of
 * a grid are kept for a while, a few faces wide; they depend on the cell alone, so that it doesn't
 * matter which ones are still there. */
typedef struct bounds_cells {
    double size; /* mm; 0: there are none */
    struct bounds_cell *cell;
} bounds_cells;

iso_status bounds_cells_begin(bounds_cells *cells, const iso_mesh *mesh) ISO_MUST_CHECK;
void bounds_cells_free(bounds_cells *cells);

/* A bound that holds for the box and more, or NULL if the box is too large for cells. */
const bounds *bounds_cells_around(bounds_cells *cells, const iso_field *field, iso_vec3 low,
                                  iso_vec3 high);

#endif
