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
    double told;          /* a width may be off by so much, so that not every piece tells its own */
    double tolerance;     /* how far a bead's line may lie from the true one */
} sheet_bead;

sheet_bead sheet_bead_of(const iso_fill_options *fill);

enum { SHEET_LINES = 8 }; /* side by side at most */

/* The half thickness in mm up to which a sheet is drawn as so many lines; beyond that as more. */
double sheet_limit(const sheet_bead *bead, int lines);

/* Append the lines of sheets. Bit n of `left` tells that what takes n lines is left for other beads
 * to fill, SHEET_LINES + 1 what takes more. Clipped to `region`, which the samples were taken for;
 * links as in iso_weave_draw. */
iso_status sheet_draw(iso_paths *out, uint32_t *left, const iso_region *region,
                      const samples *taken, const iso_fill_options *fill,
                      iso_arena *scratch) ISO_MUST_CHECK;

#endif
