/* How far a surface that was made anew is from what it was made of. */
#ifndef ISO_SOLID_MISFIT_H
#define ISO_SOLID_MISFIT_H

#include <isoslice/mesh.h>

#include "solid/volume.h"

/* Voxels; what is further away than that is told apart by its side alone. */
#define MISFIT_REACH 3.0

/* `made` should run at the distance `half` from the corners of `soup`, which are looked at one by
 * one: the largest and the mean difference in mm. Corners deep inside, where the material of others
 * covers them, don't count; those far outside, which the new surface lost, count as MISFIT_REACH
 * voxels. `whole` is negative inside; NULL where nothing can be lost. */
iso_status misfit_measure(iso_mesh_defects *errors, const iso_mesh *made, const iso_mesh *soup,
                          const iso_volume *whole, double half, double voxel) ISO_MUST_CHECK;

#endif
