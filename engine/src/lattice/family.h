/* The families of lattices. Each fills cell->distance, which is there, of the size and repeat that
 * are there; cell_make does the rest. */
#ifndef ISO_LATTICE_FAMILY_H
#define ISO_LATTICE_FAMILY_H

#include "lattice/cell.h"

iso_status tpms_fill(iso_lattice_cell *cell, const iso_lattice_options *options) ISO_MUST_CHECK;
iso_status strut_fill(iso_lattice_cell *cell, const iso_lattice_options *options) ISO_MUST_CHECK;
iso_status foam_fill(iso_lattice_cell *cell, const iso_lattice_options *options) ISO_MUST_CHECK;
iso_status bone_fill(iso_lattice_cell *cell, const iso_lattice_options *options) ISO_MUST_CHECK;
iso_status voxel_cubic_fill(iso_lattice_cell *cell,
                            const iso_lattice_options *options) ISO_MUST_CHECK;

/* Chooses the repeat itself. */
iso_status voxel_random_fill(iso_lattice_cell *cell,
                             const iso_lattice_options *options) ISO_MUST_CHECK;

/* Chooses the size and allocates the table itself. */
iso_status voxel_file_fill(iso_lattice_cell *cell,
                           const iso_lattice_options *options) ISO_MUST_CHECK;

/* Level table and steepest of a filled cell. */
iso_status cell_measure(iso_lattice_cell *cell) ISO_MUST_CHECK;

#endif
