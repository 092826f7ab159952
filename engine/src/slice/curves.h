/* Slices by heights at the vertices of a mesh, or of what it was refined to. */
#ifndef ISO_SLICE_CURVES_H
#define ISO_SLICE_CURVES_H

#include <isoslice/slice.h>

#include "slice/roots.h"

typedef struct curves_mesh {
    int32_t triangle_count, vertex_count;
    const int32_t *origin, *opposite; /* [3 triangle_count] */
    const iso_vec3 *position;         /* [vertex_count] */
    const double *height;             /* [vertex_count] */
    const iso_field *field;           /* points are its roots on the edges; NULL: linear */
    const iso_vec3 *gradient;         /* [vertex_count], with `field` */
} curves_mesh;

iso_status curves_slice(iso_curves *curves, const curves_mesh *mesh, const double *level,
                        int32_t level_count) ISO_MUST_CHECK;

/* ISO_USAGE if they aren't finite and ascending. */
iso_status curves_check_levels(const double *level, int32_t count) ISO_MUST_CHECK;

#endif
