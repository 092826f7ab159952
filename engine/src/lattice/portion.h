/* How much of a section each bead is to hold: what is nearer to it than to any other. */
#ifndef ISO_LATTICE_PORTION_H
#define ISO_LATTICE_PORTION_H

#include "lattice/sheet.h"

/* Give the beads of the paths from `begin` on, which fill the section, areas and widths such that
 * each holds what of the section is nearest to it, as far as a nozzle can; straight pieces are cut
 * in two where that changes. So volumes are true wherever one looks, not only altogether. O(grid of
 * quarters of a bead, and its nodes near the beads). */
iso_status portion_out(iso_paths *paths, int32_t begin, const iso_region *section,
                       const sheet_bead *bead, iso_arena *scratch) ISO_MUST_CHECK;

#endif
