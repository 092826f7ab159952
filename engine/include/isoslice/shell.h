/* Shells: which part of a layer's fill is seen from above or below and so has to be solid.
 *
 * One arrangement of the fill with the outlines of the layers around it answers for all of them: a
 * place is covered from above if every one of the layers that the shell counts holds it. */
#ifndef ISOSLICE_SHELL_H
#define ISOSLICE_SHELL_H

#include <isoslice/planar.h>
#include <isoslice/status.h>

/* The outlines around a layer, nearest first; coarse ones do, and cost less. Layers beyond the top
 * or the bed are not listed, and count as empty. */
typedef struct iso_shell_neighbours {
    const iso_region *const *above; /* [above_count], at most `top` */
    const iso_region *const *below; /* [below_count], at most `bottom` */
    int32_t above_count, below_count;
    int32_t top, bottom; /* layers of each shell; 0: none on that side */
} iso_shell_neighbours;

typedef struct iso_shell_options {
    int32_t narrowest; /* units; strips of a shell narrower than this stay sparse */
    int32_t anchor;    /* units by which shells reach into the sparse fill around them */
} iso_shell_options;

typedef struct iso_shell {
    iso_region top;    /* nothing right above */
    iso_region solid;  /* the rest of the shells */
    iso_region sparse; /* covered on both sides */
} iso_shell;

/* Split `fill` into the three, disjoint regions; zero-initialise the shell, iso_shell_free at the
 * end. */
ISO_API iso_status iso_shell_split(iso_shell *shell, const iso_region *fill,
                                   const iso_shell_neighbours *around,
                                   const iso_shell_options *options,
                                   iso_planar_scratch *scratch) ISO_MUST_CHECK;
ISO_API void iso_shell_free(iso_shell *shell);

#endif
