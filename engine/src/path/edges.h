/* Edges in a uniform grid: which of them does a segment meet, which is nearest, is a point inside
 * of the closed contours among them? */
#ifndef ISO_PATH_EDGES_H
#define ISO_PATH_EDGES_H

#include <isoslice/geometry.h>

#include "base/memory.h"

typedef struct iso_path_edge {
    iso_point a, b;
    int32_t owner; /* whatever the caller wants to know it by */
} iso_path_edge;

typedef struct iso_edge_grid {
    const iso_path_edge *edge; /* [count], the caller's */
    int32_t count;
    int32_t *first; /* [columns * rows + 1] */
    int32_t *in;    /* [first[columns * rows]] edges of each cell */
    int32_t columns, rows, size;
    double inverse; /* 1 / size: cells are told by products, always the same ones */
    iso_point origin;
} iso_edge_grid;

/* All on scratch, until the caller pops it. About three cells' entries an edge. */
iso_status iso_edge_grid_build(iso_edge_grid *grid, const iso_path_edge *edge, int32_t count,
                               iso_arena *scratch) ISO_MUST_CHECK;

/* Does the segment meet an edge with begin <= owner < end? Edges that share an end with it don't
 * count. */
int iso_edge_grid_meets(const iso_edge_grid *grid, iso_point a, iso_point b, int32_t begin,
                        int32_t end);

/* Is one of the edges the segment itself, either way round? */
int iso_edge_grid_has(const iso_edge_grid *grid, iso_point a, iso_point b);

/* By even and odd, counting edges with begin <= owner < end, which are to be closed contours.
 * Points on the boundary are on either side. */
int iso_edge_grid_contains(const iso_edge_grid *grid, iso_point p, int32_t begin, int32_t end);

/* The edge nearest to p among those with begin <= owner < end, at most `reach` units away; -1 if
 * there is none. */
int32_t iso_edge_grid_nearest(const iso_edge_grid *grid, iso_point p, int32_t reach, int32_t begin,
                              int32_t end);

/* Of the segment a b, to whole units. */
iso_point iso_nearest_on_segment(iso_point p, iso_point a, iso_point b);
int64_t iso_distance_squared(iso_point a, iso_point b);

#endif
