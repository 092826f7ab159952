/* What is no sheet: islands of section, filled by an outline's bead and lines, or a dot. */
#ifndef ISO_LATTICE_BULK_H
#define ISO_LATTICE_BULK_H

#include <isoslice/fill.h>

#include "base/memory.h"

/* Append beads that hold the section's volume, island by island. */
iso_status bulk_draw(iso_paths *out, const iso_region *section, const iso_fill_options *fill,
                     iso_arena *scratch, iso_planar_scratch *planar) ISO_MUST_CHECK;

#endif
