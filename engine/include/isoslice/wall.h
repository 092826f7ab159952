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
    int32_t thin_least; /* units; outlines too narrow for a loop get one bead from this width on,
                         * which may be as high as wide; 0: they get none */
    int32_t gap_least;  /* units; so do gaps between walls, from this width on; 0: none */
    iso_path like;      /* object, group and tool of the paths */
} iso_wall_options;

typedef struct iso_gap_options {
    int32_t height;
    int32_t least, most; /* units of width to fill: narrower places stay as they are; wider ones get
                          * no more than this */
    int32_t border;  /* units of a place's width that the beads on both sides of it take already */
    int32_t outline; /* nonzero: beads as wide as the place, whose round sides touch its edges; else
                      * beads that fill it, their width more than the place's (docs/flow.md) */
    int32_t step;    /* units; length of the pieces that curved sides are looked at in */
    double shortest; /* beads shorter than this many of their widths are left out */
    iso_path like;   /* role, object, group, tool and rank of the paths */
} iso_gap_options;

/* Append beads along the middles of narrow places, `gap`, a region; their widths follow the
 * place's. Rings give closed paths, all else open ones. On failure `paths` is as before. */
ISO_API iso_status iso_gap_fill(iso_paths *paths, const iso_region *gap,
                                const iso_gap_options *options,
                                iso_planar_scratch *scratch) ISO_MUST_CHECK;

/* Gaps to fill with a bead's height, from `least` units of width up to two spacings; beads of at
 * least 1.5 widths. */
ISO_API iso_gap_options iso_gap_defaults(const iso_bead *bead, int32_t least);

/* Set `left` to what of `region` no round brush of that radius reaches, given `reached`, where its
 * middle may go: `region` shrunk by the radius. */
ISO_API iso_status iso_gap_left(iso_region *left, const iso_region *region,
                                const iso_region *reached, int32_t radius,
                                iso_planar_scratch *scratch) ISO_MUST_CHECK;

typedef struct iso_gap_reach {
    int32_t distance; /* units by which `region` was shrunk to get `reached` */
    int32_t taken;    /* of those, units next to its contours that other beads cover */
} iso_gap_reach;

/* Fill what beads along `reached`, or lines within it, leave open in `region`. Costs next to
 * nothing where no place is narrow. */
ISO_API iso_status iso_gap_fill_left(iso_paths *paths, const iso_region *region,
                                     const iso_region *reached, const iso_gap_reach *reach,
                                     const iso_gap_options *options,
                                     iso_planar_scratch *scratch) ISO_MUST_CHECK;

/* Append the walls of `island` (a region) to `paths`, closed, outer ones counter-clockwise and
 * those around holes clockwise, ranked in printing order from rank 0 to count - 1; loops shorter
 * than their bead is wide are left out. Thin places get a bead of the outermost wall's rank, gaps
 * beads of rank count, before the fill. Set `inside` to where the fill may go. `scratch` as for the
 * planar operations. */
ISO_API iso_status iso_walls(iso_paths *paths, iso_region *inside, const iso_region *island,
                             const iso_wall_options *options,
                             iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif
