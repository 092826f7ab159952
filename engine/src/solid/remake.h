/* A new closed surface around what triangles enclose that need not fit together. */
#ifndef ISO_SOLID_REMAKE_H
#define ISO_SOLID_REMAKE_H

#include <isoslice/mesh.h>

/* Where the generalized winding number of the triangles of `soup` (its origin and position;
 * Jacobson et al., Robust inside-outside segmentation, 2013) is a half or more; or, if options->
 * sheet_thickness is not 0, within half of that of any triangle. The defects tell the voxel and the
 * error. ISO_UNSLICEABLE: nothing is enclosed. */
iso_status remake_surface(iso_mesh *mesh, const iso_mesh *soup,
                          const iso_mesh_options *options) ISO_MUST_CHECK;

#endif
