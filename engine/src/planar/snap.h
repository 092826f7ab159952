/* Snap rounding: split edges until they meet in common vertices only.
 *
 * Every endpoint and every crossing, rounded, makes its unit square a hot pixel; an edge that meets
 * a hot pixel is bent through its centre (Hobby, Practical segment intersection with finite
 * precision output, 1999). Rounds repeat on the new pieces until nothing changes, so that no vertex
 * lies in an edge and a second pass over a result finds nothing to do. */
#ifndef ISO_PLANAR_SNAP_H
#define ISO_PLANAR_SNAP_H

#include "planar/edges.h"
#include "planar/grid.h"

typedef struct iso_split {
    int32_t slot;
    iso_point at;
} iso_split;

/* Growable room for one round; reused. */
typedef struct iso_snap_room {
    iso_split *split;
    int64_t split_count, split_capacity;
    iso_point *crossing; /* new hot pixels */
    int64_t crossing_count, crossing_capacity;
} iso_snap_room;

void snap_room_free(iso_snap_room *room);

/* *collisions counts pairs of edges that met otherwise than as neighbours on a contour; 0 proves
 * the input clean. Vertices where edges meet are flagged EDGE_SHARED_START. */
iso_status snap_round(iso_edges *edges, int64_t *collisions, iso_snap_room *room,
                      iso_arena *arena) ISO_MUST_CHECK;

#endif
