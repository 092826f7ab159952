/* Closing a cut: flat caps on the loops that it leaves. */
#ifndef ISO_OBJECT_CAP_H
#define ISO_OBJECT_CAP_H

#include <isoslice/mesh.h>

#include "base/memory.h"

/* A side of a loop, in the direction in which the cap's dart runs. */
typedef struct iso_cap_side {
    int32_t vertex; /* where it starts; the next side starts where it ends */
    int32_t dart;   /* of the surface, running against it: its opposite is wanted */
    iso_point at; /* of the vertex, in a view in which the cap's triangles are counter-clockwise */
} iso_cap_side;

/* A mesh that grows. */
typedef struct iso_growing_mesh {
    iso_mesh mesh;
    int64_t origin_capacity, opposite_capacity, position_capacity;
} iso_growing_mesh;

/* Add triangles between the loops, loop i being side[first[i]] .. side[first[i + 1] - 1], so that
 * every side's dart has its opposite. Outer loops run counter-clockwise, holes clockwise. Loops
 * that touch or, by rounding, cross are closed all the same. */
iso_status cap_loops(iso_growing_mesh *to, const iso_cap_side *side, const int32_t *first,
                     int32_t loops) ISO_MUST_CHECK;

#endif
