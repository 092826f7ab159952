/* The tools of a lattice's paths: each cell's material is another nozzle's. */
#ifndef ISO_LATTICE_TOOLS_H
#define ISO_LATTICE_TOOLS_H

#include "lattice/slice.h"

/* Give the paths from number `begin` on, whose vertices begin at `vertex_begin`, the tools of the
 * cells they run in. Where they pass from one material to the other they are cut in two, exactly at
 * the cells' border: no bead is lost or drawn twice. Pieces shorter than the bead is wide go with
 * what is before or behind them. Nothing happens if the lattice has but one material. On failure
 * there may be more paths than before. */
iso_status tools_choose(iso_paths *paths, int32_t begin, int32_t vertex_begin,
                        const iso_lattice_slice *slice, iso_arena *scratch) ISO_MUST_CHECK;

#endif
