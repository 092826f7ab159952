/* Shells: which part of a layer's fill is seen from above or below and so has to be solid.
 *
 * A place is covered from above if every layer that the top shell counts holds it, so the shells
 * need the intersection of each run of so many layers. Runs of 2^k layers come from two of half the
 * length, and any run from two that overlap: one or two intersections a layer serve all of them,
 * above and below. */
#ifndef ISOSLICE_SHELL_H
#define ISOSLICE_SHELL_H

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
} iso_shell_neighbours;

typedef struct iso_shell_options {
    int32_t narrowest; /* units; strips of a shell narrower than this stay sparse */
    int32_t anchor;    /* units by which shells reach into the sparse fill around them */
} iso_shell_options;

typedef struct iso_shell {
    iso_region top;    /* nothing right above */
    iso_region solid;  /* the rest of the shells */
    iso_region sparse; /* covered on both sides */
    iso_region spare;  /* kept for its capacity alone */
} iso_shell;

/* Split `fill` into the three, disjoint regions; zero-initialise the shell, iso_shell_free at the
 * end. The outlines may be coarse ones: half of `narrowest` off does no harm. */
ISO_API iso_status iso_shell_split(iso_shell *shell, const iso_region *fill,
                                   const iso_shell_neighbours *around,
                                   const iso_shell_options *options,
                                   iso_planar_scratch *scratch) ISO_MUST_CHECK;
ISO_API void iso_shell_free(iso_shell *shell);

/* Runs are kept by level: level k of a layer is what it and the 2^k - 1 layers above it share;
 * level 0 is its outline. The level that serves shells of so many layers; 0 for one layer or none.
 */
ISO_API int32_t iso_shell_level(int32_t layers);

/* Level k of a layer from level k - 1 of it and of the layer 2^(k - 1) above. */
ISO_API iso_status iso_shell_widen(iso_region *out, const iso_region *low, const iso_region *high,
                                   iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif
