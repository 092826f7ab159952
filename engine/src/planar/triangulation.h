/* A constrained Delaunay triangulation as a closed double-link: the plane with one vertex at
 * infinity, whose triangles lie outside the convex hull.
 *
 * Dart 3 t + k runs from corner k of triangle t to the next one, the triangle on its left.
 *
 *     alpha(d)     next dart of the triangle; implicit
 *     opposite(d)  the neighbour's dart on the same edge; an involution that fixes none
 *     beta(d)      opposite(alpha^-1(d)): turns counter-clockwise about the vertex
 *     origin(d)    constant along beta; vertex_count stands for infinity
 *
 * fence, a projection of the edges, marks the contours; inside, one of the triangles, changes
 * exactly there. */
#ifndef ISO_PLANAR_TRIANGULATION_H
#define ISO_PLANAR_TRIANGULATION_H

#include <isoslice/planar.h>

#include "base/memory.h"

typedef struct iso_triangulation {
    int32_t vertex_count, triangle_count;
    iso_point *vertex;          /* each place once */
    int32_t *origin, *opposite; /* [3 triangle_count] */
    uint8_t *fence;             /* [3 triangle_count] */
    uint8_t *inside;            /* [triangle_count] */
} iso_triangulation;

static inline int32_t corner_next(int32_t dart) {
    return dart % 3 == 2 ? dart - 2 : dart + 1;
}

static inline int32_t corner_back(int32_t dart) {
    return dart % 3 == 0 ? dart + 2 : dart - 1;
}

/* Triangulate a region, in the arena. Exact: no rounding decides anything. A region without area
 * gives none. About n log n: points come in random rounds, each along a space-filling curve
 * (Amenta, Choi, Rote 2003), into the Delaunay triangulation (Bowyer, Watson 1981); contours that
 * are not edges by themselves are flipped in (Sloan 1993). */
iso_status triangulate(iso_triangulation *out, const iso_region *region,
                       iso_arena *arena) ISO_MUST_CHECK;

/* Every equation, the orientation of every triangle, and the empty circles across all edges but
 * fences. */
iso_status triangulation_validate(const iso_triangulation *triangulation) ISO_MUST_CHECK;

#endif
