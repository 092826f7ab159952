/* Nesting outlines in a region, without turning them. */
#ifndef ISO_OBJECT_NEST_H
#define ISO_OBJECT_NEST_H

#include <isoslice/planar.h>

#include "base/memory.h"

typedef struct iso_nest_shape {
    const iso_point *hull; /* see hull.h; three corners at least */
    int32_t corners;
    const iso_region *outline; /* within the hull; NULL: the hull itself */
    int32_t copies;
} iso_nest_shape;

typedef struct iso_nest {
    const iso_nest_shape *shape; /* [shapes] */
    int32_t shapes;
    const iso_region *bed;
    int32_t distance; /* units between two outlines */
    iso_point target; /* the middle of all of them, if there is room */
} iso_nest;

/* Set by[] for all copies of the first shape, then of the next, and so on; *placed of them fit. If
 * not all do, *left is the shape whose turn it was, and by[] is of no use. */
iso_status nest_shapes(iso_point *by, int32_t *placed, int32_t *left, const iso_nest *nest,
                       iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif
