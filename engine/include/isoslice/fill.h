/* Fill: lines or curves over a region, joined along its boundary.
 *
 * The region is where the middles of the beads may go, so it is already inset by the caller; for a
 * solid fill by `margin` from the edge of what is to be full: half a spacing, or less, so that ends
 * bond with what is around. Lines end on its boundary, and a link between two lines follows it,
 * with just the flow that fills the margin. Beside a wall fitted lines are as wide as what is left.
 */
#ifndef ISOSLICE_FILL_H
#define ISOSLICE_FILL_H

#include <isoslice/geometry.h>
#include <isoslice/link.h>
#include <isoslice/path.h>
#include <isoslice/planar.h>
#include <isoslice/status.h>

struct iso_arena; /* the engine's scratch memory; NULL: the call has its own */

typedef enum iso_fill_pattern {
    ISO_PATTERN_RECTILINEAR,
    ISO_PATTERN_ALIGNED,
    ISO_PATTERN_MONOTONIC,
    ISO_PATTERN_GRID,
    ISO_PATTERN_TRIANGLES,
    ISO_PATTERN_STARS,
    ISO_PATTERN_CUBIC,
    ISO_PATTERN_LINE,
    ISO_PATTERN_CONCENTRIC,
    ISO_PATTERN_HONEYCOMB,
    ISO_PATTERN_HONEYCOMB_3D,
    ISO_PATTERN_GYROID,
    ISO_PATTERN_HILBERT,
    ISO_PATTERN_ARCHIMEDEAN,
    ISO_PATTERN_OCTAGRAM,
    ISO_PATTERN_MONOTONIC_LINES, /* as MONOTONIC, but no line is linked to another */
    ISO_PATTERN_COUNT,
    ISO_PATTERN_LATTICE = 100 /* and on: an iso_lattice_pattern; not of iso_fill */
} iso_fill_pattern;

typedef struct iso_fill_options {
    int32_t pattern;  /* iso_fill_pattern; iso_fill_rectilinear doesn't look at it */
    int32_t layer;    /* number of the layer, from 0; 3dhoneycomb takes turns */
    int32_t z;        /* units; height of the layer's middle above the bed, >= 0 */
    iso_point origin; /* the patterns' own; not of iso_fill_rectilinear, which has `phase` */
    double density;   /* of the fill, > 0 to 1; the bead's own spacing is spacing density */
    double spacing;   /* units between neighbouring lines, >= ISO_FILL_SPACING_MIN; kept to 1/256 */
    double angle;     /* degrees counter-clockwise from x, the direction of the lines */
    double phase;     /* units; line k is k spacing + phase to the left of the bed's origin */
    int32_t fit;      /* nonzero: no phase; every part's lines are spread over its extent, their
                       * spacing, flow and width changed (n lines: by about 1/2n at most) to fill it */
    int32_t width, area; /* of the bead, units and units^2 */
    int32_t even;        /* nonzero: but all lines stay as wide as each other, even beside a wall */
    int32_t margin;    /* units, with `fit`: from the region's edge to that of what is to be full */
    int32_t link_max;  /* units; longest piece of boundary that joins two lines; 0 = none;
                        * pieces that a widened line fills don't */
    int32_t anchor;    /* units; what is drawn of a longer one at the end of a path; 0 = none */
    int32_t monotonic; /* nonzero: lines one after another, each to the left of those before;
                        * the paths have ranks from like.rank on */
    int32_t deviation; /* units; a link goes straight if the boundary is nowhere further from it */
    int32_t shortest;  /* units; paths shorter than this are left out */
    iso_path like;     /* role, tool, speed class, object, group and rank of the paths */
} iso_fill_options;

/* Line spacing below this (10 um) is refused. */
#define ISO_FILL_SPACING_MIN 100

/* Lines bead.spacing / density apart, angle 0; fitted if density is 1; links up to 5 spacings,
 * deviation 100 (10 um), shortest half a bead; role solid infill at density 1, else internal. */
ISO_API iso_fill_options iso_fill_defaults(iso_bead bead, double density);

ISO_API iso_status iso_fill_options_validate(const iso_fill_options *options) ISO_MUST_CHECK;

/* Append the paths of options->pattern that fill `region` (clean contours, outer ones
 * counter-clockwise, with parents) to `out`. Patterns hang on `origin`, wherever the region is, so
 * that layers lie on each other. Vertices lie within a unit of the region; no piece of boundary is
 * drawn twice. `planar` as for the planar operations. Both scratches may be NULL. ISO_USAGE for
 * options or a region out of their range; on failure `out` is as before. */
ISO_API iso_status iso_fill(iso_paths *out, const iso_region *region,
                            const iso_fill_options *options, struct iso_arena *scratch,
                            iso_planar_scratch *planar) ISO_MUST_CHECK;

/* Can the pattern fill a layer without gaps? */
ISO_API int iso_fill_pattern_is_solid(iso_fill_pattern pattern);
/* Degrees by which layer `index` of it is turned. */
ISO_API double iso_fill_pattern_turn(iso_fill_pattern pattern, int32_t index);

/* Straight lines alone, whatever the pattern. Every piece of a sweep line inside the region is
 * drawn exactly once. Ends lie within a unit of the boundary, fitted ones without a link up to the
 * margin (two at grazing angles) beyond it. O(points + crossings), and sorting on each line.
 * ISO_USAGE for options or a region out of their range; on failure `out` is as before.
 */
ISO_API iso_status iso_fill_rectilinear(iso_paths *out, const iso_region *region,
                                        const iso_fill_options *options,
                                        struct iso_arena *scratch) ISO_MUST_CHECK;

/* The contour-filling multi-link of the whole region under one set of lines (fitted to all of it if
 * so asked): what the paths are walked on, for a look or a file. Free with iso_multilink_free. */
ISO_API iso_status iso_fill_to_link(iso_filling_link *out, const iso_region *region,
                                    const iso_fill_options *options,
                                    struct iso_arena *scratch) ISO_MUST_CHECK;

#endif
