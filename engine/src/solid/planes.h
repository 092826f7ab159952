/* Winding numbers of points in the planes of levels, as exact as those of isoslice/solid.h.
 *
 * A ray along x from such a point meets only triangles that its level meets. Those of each level
 * are listed, which slicing needs no less time for, and are dealt out to the points by their y: a
 * tree over all triangles would take longer to build than all this together. */
#ifndef ISO_SOLID_PLANES_H
#define ISO_SOLID_PLANES_H

#include <isoslice/slice.h>

#include "solid/grid.h"

/* mm that points may be above or below their level */
#define PLANES_UP_MAX 1e-5

/* Levels from `low` on and below `high`. */
typedef struct plane_range {
    int32_t low, high;
} plane_range;

typedef struct solid_planes {
    const iso_mesh *mesh; /* [count] */
    int32_t count, triangles;
    const iso_levels *levels;
    solid_grid grid;
    plane_range *range; /* [triangles] of each, numbered on from mesh to mesh */
    int64_t *first;     /* [levels + 1] */
    int32_t *list;      /* [first[levels]] triangles, level by level, ascending */
} solid_planes;

typedef struct plane_point {
    int32_t at[3];
    int32_t index;
} plane_point;

/* Meshes and levels are kept, and must be. */
iso_status planes_make(solid_planes *planes, const iso_mesh *mesh, int32_t count,
                       const iso_levels *levels) ISO_MUST_CHECK;
void planes_free(solid_planes *planes);

/* winding[i] of point[i], all in the plane of `level` or at most PLANES_UP_MAX off it. `scratch`
 * has room for `count`. Any number of threads at once. */
void planes_winding(int32_t *winding, const solid_planes *planes, int32_t level,
                    const iso_vec3 *point, int32_t count, plane_point *scratch);

#endif
