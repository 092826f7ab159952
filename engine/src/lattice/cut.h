/* What is cut out of a lattice whatever its pattern. */
#ifndef ISO_LATTICE_CUT_H
#define ISO_LATTICE_CUT_H

#include <isoslice/lattice.h>

/* The run that has the voxel of a place in the part's frame, or the first one behind it; it may be
 * the one past the last. */
int64_t cut_find(const iso_lattice_cut *cut, iso_vec3 at);

/* Does this run end before the voxel of `at`? */
int cut_is_before(const iso_lattice_cut *cut, int64_t run, iso_vec3 at);

/* Is the voxel of `at` in this run? */
int cut_meets(const iso_lattice_cut *cut, int64_t run, iso_vec3 at);

#endif
