/* What structures of voxels share. */
#ifndef ISO_LATTICE_VOXEL_H
#define ISO_LATTICE_VOXEL_H

#include <stdint.h>

#include <isoslice/status.h>

/* By a bell curve along each axis of a cube that repeats, `size` a power of two; up to a factor.
 * sigma, in samples, from 0.3 to 4. */
iso_status voxel_blur(float *field, int32_t size, double sigma) ISO_MUST_CHECK;

#endif
