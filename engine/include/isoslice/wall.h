/* Walls: the perimeters of an island, and the area they leave for its fill.
 *
 * The outermost wall runs half its full width inside the outline, so that its rounded side touches
 * it; further ones follow at the beads' spacing, at which neighbours fill the layer exactly
 * (docs/flow.md). */
#ifndef ISOSLICE_WALL_H
#define ISOSLICE_WALL_H

#include <isoslice/path.h>
#include <isoslice/planar.h>
#include <isoslice/status.h>

typedef struct iso_wall_options {
    int32_t count; /* walls, outermost included; 0 leaves everything to the fill */
    iso_bead external, inner;
    int32_t external_first; /* nonzero: from the outermost in, else from the innermost out */
    int32_t small_length;   /* units; loops no longer than this are speed class 1 */
    int32_t fill_inset;     /* units from the walls' inner edge to the filled area; < 0 into them */
    int32_t arc_tolerance;  /* units; see iso_offset_options */
    iso_path like;          /* object, group and tool of the paths */
} iso_wall_options;

/* Append the walls of `island` (a region) to `paths`, closed, outer ones counter-clockwise and
 * those around holes clockwise, ranked in printing order from rank 0 to count - 1; loops shorter
 * than their bead is wide are left out. Set `inside` to where the fill may go. `scratch` as for the
 * planar operations. */
ISO_API iso_status iso_walls(iso_paths *paths, iso_region *inside, const iso_region *island,
                             const iso_wall_options *options,
                             iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif
