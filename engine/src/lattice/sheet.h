/* Sheets, drawn as lines along their middle. */
#ifndef ISO_LATTICE_SHEET_H
#define ISO_LATTICE_SHEET_H

#include "fill/clip.h"
#include "lattice/samples.h"

/* What a nozzle can lay down, in units; a bead's "net" width is its section over its height. */
typedef struct sheet_bead {
    double height, usual; /* usual: net width */
    double least, most;   /* net widths that are drawn: thinner ones get the least */
    double corners;       /* the full width is the net one and this: round sides */
    double tolerance;     /* how far a bead's line may lie from the true one */
} sheet_bead;

sheet_bead sheet_bead_of(const iso_fill_options *fill);

/* The half thickness in mm up to which sheets are drawn as lines: one, or several side by side. */
double sheet_limit(const sheet_bead *bead);

/* Append the lines of all that isn't thicker than the limit. Clipped to `region`, which the samples
 * were taken for; links as in iso_weave_draw. */
iso_status sheet_draw(iso_paths *out, const iso_region *region, const samples *taken,
                      const iso_fill_options *fill, iso_arena *scratch) ISO_MUST_CHECK;

#endif
