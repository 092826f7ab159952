/* The walk over a hatch: lines joined to runs, each bead as wide as what it has to fill. */
#ifndef ISO_FILL_ZIGZAG_H
#define ISO_FILL_ZIGZAG_H

#include "fill/flank.h"
#include "fill/hatch.h"

/* Draw all of the hatch. `flanks` may be empty. */
iso_status iso_zigzag_draw(iso_paths *out, const iso_hatch *hatch, iso_flanks *flanks,
                           const iso_fill_options *options, iso_arena *scratch) ISO_MUST_CHECK;

#endif
