/* Arcs: runs of a path's beads that lie on a circle, which G2 and G3 draw in one move. */
#ifndef ISOSLICE_ARC_H
#define ISOSLICE_ARC_H

#include <isoslice/path.h>
#include <isoslice/status.h>

struct iso_arena;

/* The beads from vertex `first` to vertex first + count of one path (its first vertex behind the
 * last one, if it is closed) as one arc. The vertices in between stay where they are. */
typedef struct iso_arc {
    int32_t path;
    int32_t first, count; /* vertex of the path, from 0; beads, at least 3 */
    iso_vec2 center;      /* units */
    double radius;        /* units */
    int32_t clockwise;    /* G2, else G3 */
} iso_arc;

typedef struct iso_arc_options {
    double tolerance;              /* units that an arc may be off the path's vertices and beads */
    double radius_min, radius_max; /* units */
} iso_arc_options;

/* 12.5 um; 0.2 mm to 1 m. */
ISO_API iso_arc_options iso_arc_defaults(void);

/* Find the arcs of paths, in the order of their paths and vertices; none overlap. Only beads of the
 * same width, area and role that stay on the layer's height share one. *arc is pushed to `scratch`.
 * Each arc makes less than a full turn, and begins and ends in vertices. O(n log n). */
ISO_API iso_status iso_paths_find_arcs(iso_arc **arc, int32_t *count, const iso_paths *paths,
                                       const iso_arc_options *options,
                                       struct iso_arena *scratch) ISO_MUST_CHECK;

#endif
