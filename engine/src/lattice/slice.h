/* One layer of a lattice: contours and beads within a region, never a mesh. */
#ifndef ISO_LATTICE_SLICE_H
#define ISO_LATTICE_SLICE_H

#include <isoslice/fill.h>
#include <isoslice/path.h>
#include <isoslice/planar.h>

#include "base/memory.h"
#include "lattice/lattice.h"

/* The material's section at height z (mm, of the meshes that the lattice was made with) within
 * `area`. Contoured on a grid by the up-crossing rule on squares (theta^4 = 1); rows are sampled no
 * further than the area reaches, and of a uniform lattice one period alone. `shift` is the region's
 * place against the meshes, units. */
typedef struct iso_lattice_slice {
    const iso_lattice *lattice;
    double z;        /* mm */
    iso_point shift; /* region = mesh + shift */
    double step;     /* mm of the grid; 0: what the cell and the bead ask for */
} iso_lattice_slice;

iso_status lattice_section(iso_region *out, const iso_region *area, const iso_lattice_slice *slice,
                           iso_arena *scratch, iso_planar_scratch *planar) ISO_MUST_CHECK;

/* Beads that fill the section: sheets thinner than about a bead and a half by one bead as wide as
 * the sheet is there, thicker ones by more; everything else by walls and lines. `fill` gives bead,
 * height of the layer, links, role; `region` is where the beads' middles may go, inset by margin.
 * Bead volume = section times height, but for what is thinner than a third of a bead, and gets that
 * much. Links along the region's boundary come on top: link_max 0 leaves them out. */
iso_status lattice_fill(iso_paths *out, const iso_region *region, const iso_lattice_slice *slice,
                        const iso_fill_options *fill, iso_arena *scratch,
                        iso_planar_scratch *planar) ISO_MUST_CHECK;

#endif
