/* Rings around the part, and what becomes of them at a distance from it. */
#ifndef ISO_CHANNEL_RING_H
#define ISO_CHANNEL_RING_H

#include "channel/keep.h"
#include "channel/tower.h"

/* A closed ring on the surface; up[i] runs along the surface towards the next ring, so that
 * edge x up leads out of the part. */
typedef struct ring {
    iso_vec3 *point, *up; /* [count] */
    iso_vec3 *normal;     /* [count] out of the part, at the edge from a point on; NULL: see up */
    int32_t count;
} ring;

/* A level of a tower that all of its columns have, in the arena: its iso-slice, point by point. */
iso_status ring_of_tower(ring *r, const tower *t, double f, double reach,
                         iso_arena *arena) ISO_MUST_CHECK;

/* A contour of a mesh, with the normals of its triangles. In the arena. */
iso_status ring_of_contour(ring *r, const contours *all, int32_t contour, const iso_mesh *mesh,
                           iso_arena *arena) ISO_MUST_CHECK;

typedef struct ring_offset {
    double depth; /* mm */
    double step;  /* mm between points of what comes out */
    const part_space *part;
} ring_offset;

/* Push it off by the depth, around edges in arcs. Where that would come nearer to the part again
 * (depth times curvature is 1 or more, or another wall is in the way) it is cut short; *folds
 * counts the places. ISO_NOT_VERIFIED: nothing, or hardly anything, is left. */
iso_status ring_push_off(curve *out, int32_t *folds, const ring *r,
                         const ring_offset *offset) ISO_MUST_CHECK;

#endif
