/* Shells: which part of a layer's fill is seen from above or below and so has to be solid.
 *
 * A place is covered from above if every layer that the top shell counts holds it, so the shells
 * need the intersection of each run of so many layers. Runs of 2^k layers come from two of half the
 * length, and any run from two that overlap: one or two intersections a layer serve all of them,
 * above and below. */
#ifndef ISOSLICE_SHELL_H
#define ISOSLICE_SHELL_H

#include <isoslice/path.h>
#include <isoslice/planar.h>
#include <isoslice/status.h>

/* What covers a layer on one side. */
typedef struct iso_shell_side {
    int32_t layers;  /* of the shell on that side; 0: none, all counts as covered */
    int32_t missing; /* of those, layers beyond the top or the bed: nothing is covered */
    int32_t count;
    const iso_region *cover[2]; /* [count] a place is covered if all of them hold it */
} iso_shell_side;

typedef struct iso_shell_neighbours {
    const iso_region *own;  /* outline of the layer itself, coarse as the others; around its fill */
    const iso_region *next; /* outline of the layer right above; NULL: none */
    iso_shell_side above, below;
    const iso_region *beneath; /* of the layer right below, for bridges; NULL: the bed, or none */
} iso_shell_neighbours;

typedef struct iso_shell_options {
    int32_t narrowest;     /* units; strips of a shell narrower than this stay sparse */
    int32_t top_anchor;    /* units by which tops reach under the layer above */
    int32_t anchor;        /* units by which shells reach into the sparse fill around them */
    int32_t bridge_anchor; /* units by which bridges reach onto what carries them */
    int32_t bridge_least;  /* units; narrower strips over air are no bridges */
    int64_t sparse_least;  /* twice units^2; parts with less area to be sparse are solid */
    int32_t whole;         /* nonzero: nothing of the layer is sparse */
} iso_shell_options;

/* How much of a print is solid around its tops and bottoms. */
typedef struct iso_shell_depth {
    int32_t top_layers, bottom_layers;      /* 0: none, whatever the thickness */
    double top_thickness, bottom_thickness; /* mm; least */
    int32_t bridges;                        /* nonzero: layers look for bridges */
} iso_shell_depth;

typedef struct iso_shell {
    iso_region top;         /* nothing right above */
    iso_region bridge;      /* nothing right below, and some way onto what carries it */
    iso_region lid;         /* over the sparse fill of the layer below; iso_shell_find_lids */
    iso_region solid;       /* the rest of the shells */
    iso_region sparse;      /* covered on both sides */
    iso_region rest, spare; /* kept for their capacity alone */
} iso_shell;

/* Split `fill` into these, disjoint regions, without lids; zero-initialise the shell,
 * iso_shell_free at the end. The outlines may be coarse ones: half of `narrowest` off does no harm.
 */
ISO_API iso_status iso_shell_split(iso_shell *shell, const iso_region *fill,
                                   const iso_shell_neighbours *around,
                                   const iso_shell_options *options,
                                   iso_planar_scratch *scratch) ISO_MUST_CHECK;
ISO_API void iso_shell_free(iso_shell *shell);

/* Tell apart what of the solid part lies more than `least` units over the sparse fill of the layer
 * below, NULL for none: its beads hang from line to line as bridges do. They reach `anchor` units
 * further over what is solid, as far as it goes. */
ISO_API iso_status iso_shell_find_lids(iso_shell *shell, const iso_region *sparse_below,
                                       int32_t least, int32_t anchor,
                                       iso_planar_scratch *scratch) ISO_MUST_CHECK;

/* The direction, in degrees from 0 to 180, in which the lines of a bridge are best held: the most
 * of them at both ends, then at one, then over the least distance; `usual` if none is better.
 * `bridge` is one part of a region, `support` the outline of the layer below. */
ISO_API iso_status iso_bridge_angle(double *angle, const iso_region *bridge,
                                    const iso_region *support, double usual,
                                    iso_planar_scratch *scratch) ISO_MUST_CHECK;

typedef struct iso_overhang_options {
    int32_t reach;       /* units that a bead's middle may be out over air */
    int32_t shortest;    /* units; shorter pieces, and gaps between pieces, are not told apart */
    int32_t width, area; /* of the bead over air, units and units^2 */
} iso_overhang_options;

/* Give those pieces of the layer's walls that hang over air the role of overhangs, and their bead.
 * `support` is the outline of the layer below. On failure the paths may be split, but draw the
 * same. */
ISO_API iso_status iso_walls_find_overhangs(iso_paths *paths, const iso_region *support,
                                            const iso_overhang_options *options,
                                            iso_planar_scratch *scratch) ISO_MUST_CHECK;

/* Runs are kept by level: level k of a layer is what it and the 2^k - 1 layers above it share;
 * level 0 is its outline. The level that serves shells of so many layers; 0 for one layer or none.
 */
ISO_API int32_t iso_shell_level(int32_t layers);

/* Level k of a layer from level k - 1 of it and of the layer 2^(k - 1) above. */
ISO_API iso_status iso_shell_widen(iso_region *out, const iso_region *low, const iso_region *high,
                                   iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif
